"""The empty place: its spaces side by side in one plan, their walls as lines to put things along, and the openings.

What the spaces look like is in `building` and `outdoors`; what stands in them in `layout`.
"""

from collections import deque
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.design import OUTDOOR_KINDS, Light, Zone
from flymirage_core.scene.keys import rng as seeded
from flymirage_core.worldgen.truth import Unplaced

Float = NDArray[np.float64]
Enclosure = Literal["wall", "facade", "fence", "parapet", "open"]

THICKNESS = 0.24
"""Metres of wall between two spaces."""
DOORWAY_WIDTH, DOORWAY_HEIGHT = (1.3, 1.8), (2.2, 2.5)
GATE_WIDTH, GATE_HEIGHT = (2.6, 3.6), (2.8, 3.4)
"""Of doorways between large spaces."""
LARGE = frozenset({"hall", "industrial_floor", "tunnel", "street", "yard", "courtyard", "rooftop"})
DOOR_WIDTH, DOOR_HEIGHT = 1.0, 2.1
SILL, LINTEL = 0.95, 2.25
"""Of windows in rooms; larger spaces have them higher up."""
LEAST_OVERLAP = 2.2
"""Metres that two spaces must lie side by side to be joined."""
SHORTEST, LONGEST = 2.4, 42.0
"""Metres: a space's sides are kept within it."""
HEIGHTS = {"open": (3.0, 14.0), "closed": (2.5, 9.0)}
FENCE_HEIGHT, PARAPET_HEIGHT = 2.2, 1.1
TRIES = 60


@dataclass(frozen=True)
class Opening:
    """In a wall from ``left`` to ``right`` and ``bottom`` to ``top`` metres; a doorway leads on, a door is shut."""

    kind: Literal["window", "door", "doorway"]
    left: float
    right: float
    bottom: float
    top: float


@dataclass(frozen=True, eq=False)
class Wall:
    """A wall as a line: ``origin`` (2,) is its left end seen from inside; ``along`` and ``inward`` (2,) are units."""

    origin: Float
    along: Float
    inward: Float
    length: float
    height: float
    enclosure: Enclosure
    openings: tuple[Opening, ...] = ()

    @property
    def yaw(self) -> float:
        """Turn of an object whose back is to this wall (its +y points inward)."""
        return float(np.arctan2(-self.inward[0], self.inward[1]))

    def at(self, along: float, depth: float) -> Float:
        """(2,) the spot ``along`` metres from the left end and ``depth`` metres into the space."""
        return self.origin + along * self.along + depth * self.inward


@dataclass(frozen=True, eq=False)
class Space:
    """A zone at its place: the plan rectangle from ``low`` to ``high`` (2,), its walls (south, east, north, west)."""

    zone: Zone
    low: Float
    high: Float
    height: float
    walls: tuple[Wall, ...]

    @property
    def open_air(self) -> bool:
        return self.zone.kind in OUTDOOR_KINDS

    @property
    def middle(self) -> Float:
        return (self.low + self.high) / 2

    @property
    def size(self) -> Float:
        """(2,) metres along x and y."""
        return self.high - self.low


@dataclass(frozen=True, eq=False)
class Place:
    """All spaces of a scene; the main one's middle is the origin, floors lie at z = 0."""

    scene: str
    spaces: tuple[Space, ...]
    light: Light
    seed: int
    unplaced: tuple[Unplaced, ...]  # zones for which there is no room beside those that they connect to

    @property
    def open_air(self) -> bool:
        """True if any part of it lies under the sky."""
        return any(s.open_air for s in self.spaces)

    @property
    def bounds(self) -> Float:
        """(2, 3) lowest and highest corner of all spaces."""
        low, high = np.min([s.low for s in self.spaces], axis=0), np.max([s.high for s in self.spaces], axis=0)
        return np.array([[*low, 0.0], [*high, max(s.height for s in self.spaces)]])

    def space(self, zone: str) -> Space | None:
        """The space of a zone's name, the main one's for ""; None if it could not be placed."""
        return next((s for s in self.spaces if zone in ("", s.zone.name)), None)


def place_for(description: SceneDescription) -> Place:
    """The place of a description: its zones put side by side as they connect, with doorways, doors and windows."""
    rng = seeded(description.scene, "place")
    plans = _plans(description.zones, rng)
    openings: dict[tuple[str, int], list[Opening]] = {}
    names = list(plans)
    for i, one in enumerate(names):
        for other in names[i + 1 :]:
            zones = plans[one].zone, plans[other].zone
            if other in zones[0].connects_to or one in zones[1].connects_to:
                _join(plans[one], plans[other], openings, rng)
    for name, space in plans.items():
        _add_doors_and_windows(space, openings, list(plans.values()), rng)
        walls = [replace(w, openings=tuple(openings.get((name, n), ()))) for n, w in enumerate(space.walls)]
        plans[name] = replace(space, walls=tuple(walls))
    missing = [
        Unplaced(z.name, 1, "no free side of a zone that it connects to")
        for z in description.zones
        if z.name not in plans
    ]
    seed = int(seeded(description.scene, "shell").integers(1 << 16))
    return Place(description.scene, tuple(plans.values()), description.light, seed, tuple(missing))


def _plans(zones: tuple[Zone, ...], rng: np.random.Generator) -> dict[str, Space]:
    """Where each zone goes: breadth first from the main one, each against a free side of one that it connects to."""
    plans = {zones[0].name: _space(zones[0], -_plan_size(zones[0]) / 2)}
    waiting = deque(zones[1:])
    for _ in range(len(zones) ** 2):
        if not waiting:
            break
        zone = waiting.popleft()
        neighbours = [p for p in plans.values() if p.zone.name in zone.connects_to or zone.name in p.zone.connects_to]
        alone = not any(zone.name in z.connects_to or z.name in zone.connects_to for z in zones)
        spot = _beside(zone, neighbours or (list(plans.values())[:1] if alone else []), plans, rng)
        if spot is not None:
            plans[zone.name] = spot
        else:
            waiting.append(zone)
    return plans


def _plan_size(zone: Zone) -> Float:
    return np.asarray(np.clip(np.array(zone.dimensions[:2]), SHORTEST, LONGEST))


def _space(zone: Zone, low: Float, turned: bool = False) -> Space:
    size = _plan_size(zone)[::-1] if turned else _plan_size(zone)
    shortest, tallest = HEIGHTS["open" if zone.kind in OUTDOOR_KINDS else "closed"]
    height = float(np.clip(zone.dimensions[2], shortest, tallest))
    high = low + size
    corners = np.array([[high[0], low[1]], high, [low[0], high[1]], low])  # left ends, seen from inside: S, E, N, W
    inward = np.array([[0, 1], [-1, 0], [0, -1], [1, 0]], float)
    walls = []
    for number, (corner, normal) in enumerate(zip(corners, inward, strict=True)):
        along = np.array([-normal[1], normal[0]])
        enclosure = _enclosure(zone, number, size)
        tall = {"fence": FENCE_HEIGHT, "parapet": PARAPET_HEIGHT, "open": 0.0}.get(enclosure, height)
        walls.append(Wall(corner, along, normal, float(size[0] if normal[0] == 0 else size[1]), tall, enclosure))
    return Space(zone, low, high, height, tuple(walls))


def _enclosure(zone: Zone, number: int, size: Float) -> Enclosure:
    """What closes side ``number`` (S, E, N, W) of a space."""
    if zone.kind == "street":
        return "facade" if (number % 2 == 0) == (size[0] >= size[1]) else "open"
    if zone.kind == "yard":
        return "facade" if number == 2 else "fence"
    if zone.kind == "rooftop":
        return "parapet"
    return "facade" if zone.kind == "courtyard" else "wall"


def _beside(zone: Zone, neighbours: list[Space], plans: dict[str, Space], rng: np.random.Generator) -> Space | None:
    """The zone against a side of a neighbour, slid to where it meets no other space; None if there is no such spot."""
    for _ in range(TRIES if neighbours else 0):
        host = neighbours[int(rng.integers(len(neighbours)))]
        axis, sign, turned = int(rng.integers(2)), int(rng.integers(2)), bool(rng.integers(2))
        size = _plan_size(zone)[::-1] if turned else _plan_size(zone)
        low = np.empty(2)
        low[axis] = host.high[axis] + THICKNESS if sign else host.low[axis] - THICKNESS - size[axis]
        other = 1 - axis
        first, last = host.low[other] - size[other] + LEAST_OVERLAP, host.high[other] - LEAST_OVERLAP
        low[other] = rng.uniform(min(first, last), max(first, last))
        if min(size[other], host.size[other]) < LEAST_OVERLAP:
            low[other] = host.middle[other] - size[other] / 2
        low = np.round(low, 3)
        high = low + size + THICKNESS - 1e-3
        if all((low - THICKNESS + 1e-3 >= p.high).any() or (high <= p.low).any() for p in plans.values()):
            return _space(zone, low, turned)
    return None


def _join(one: Space, other: Space, openings: dict[tuple[str, int], list[Opening]], rng: np.random.Generator) -> None:
    """A doorway where two spaces lie side by side, the same hole in both walls; nothing where they do not."""
    for number in range(4):
        axis = 1 - number % 2  # the wall's normal: S and N y, E and W x
        face = one.low[axis] if number in (0, 3) else one.high[axis]
        opposite = other.high[axis] if number in (0, 3) else other.low[axis]
        along = 1 - axis
        first, last = max(one.low[along], other.low[along]) + 0.15, min(one.high[along], other.high[along]) - 0.15
        if abs(abs(face - opposite) - THICKNESS) > 0.01 or last - first < 1.0:
            continue
        large = one.zone.kind in LARGE and other.zone.kind in LARGE
        width = min(float(rng.uniform(*(GATE_WIDTH if large else DOORWAY_WIDTH))), last - first)
        top = min(float(rng.uniform(*(GATE_HEIGHT if large else DOORWAY_HEIGHT))), one.height - 0.2, other.height - 0.2)
        middle = float(np.clip(rng.uniform(first, last), first + width / 2, last - width / 2))
        for space, side in ((one, number), (other, (number + 2) % 4)):
            wall = space.walls[side]
            end = np.array([middle, middle]) - wall.origin
            spot = float(end[along] * wall.along[along])
            hole = Opening("doorway", spot - width / 2, spot + width / 2, 0.0, top)
            openings.setdefault((space.zone.name, side), []).append(hole)
        return


def _add_doors_and_windows(
    space: Space, openings: dict[tuple[str, int], list[Opening]], spaces: list[Space], rng: np.random.Generator
) -> None:
    """Shut doors where no doorway leads on, then as many windows as the zone has in its free outer walls."""
    sides = [n for n, w in enumerate(space.walls) if w.enclosure in ("wall", "facade")]
    taken = {n: openings.setdefault((space.zone.name, n), []) for n in sides}
    doors = 2 if space.open_air else max(0, int(rng.integers(1, 3)) - sum(map(len, taken.values())))
    for number in rng.permutation(sides)[:doors]:
        length = space.walls[number].length
        left = float(rng.uniform(0.5, max(length - DOOR_WIDTH - 0.5, 0.51)))
        door = Opening("door", left, left + DOOR_WIDTH, 0.0, DOOR_HEIGHT)
        if length > DOOR_WIDTH + 1.0 and _is_free(door, taken[number], 0.3):
            taken[number].append(door)
    outer = [n for n in sides if not _has_neighbour(space, n, spaces)]
    wanted, order = space.zone.windows, rng.permutation(outer)
    if not space.open_air and len(order) > 2:
        order = order[:2]  # light from two sides leaves walls to stand things at
    for window, number in _window_spots(space, [int(n) for n in order], wanted, rng):
        if _is_free(window, taken[number], 0.25):
            taken[number].append(window)


def _window_spots(space: Space, sides: list[int], wanted: int, rng: np.random.Generator) -> list[tuple[Opening, int]]:
    """Windows in even rows, storey by storey outdoors, shared among the sides by their length."""
    total = sum(space.walls[n].length for n in sides)
    result: list[tuple[Opening, int]] = []
    for number in sides:
        wall = space.walls[number]
        width = float(rng.uniform(1.05, 1.5) if space.open_air else rng.uniform(1.25, 1.9))
        rows = _rows(space, wall)
        share = int(np.ceil(wanted * wall.length / max(total, 1e-9) / len(rows)))
        count = min(max(share, 1) if wanted else 0, int((wall.length - 0.6) / (width + 0.5)))
        for i in range(count):
            middle = wall.length * (i + 0.5) / count
            if len(rows) == 1 and not space.open_air:
                middle += float(rng.uniform(-0.25, 0.25)) * (wall.length / count - width - 0.4)
            result += [(Opening("window", middle - width / 2, middle + width / 2, b, t), number) for b, t in rows]
    return result


def _rows(space: Space, wall: Wall) -> list[tuple[float, float]]:
    """Bottom and top of each row of windows."""
    if space.open_air:
        storeys = max(1, int(wall.height / 3.1))
        return [(wall.height * s / storeys + 1.0, wall.height * s / storeys + 2.45) for s in range(storeys)]
    if space.height > 4.2:
        return [(max(2.2, space.height * 0.42), space.height - 0.7)]
    return [(SILL, min(LINTEL, space.height - 0.3))]


def _is_free(new: Opening, taken: list[Opening], gap: float) -> bool:
    apart = (
        new.right + gap <= o.left or o.right + gap <= new.left or new.bottom >= o.top + gap or o.bottom >= new.top + gap
        for o in taken
    )
    return all(apart)


def _has_neighbour(space: Space, number: int, spaces: list[Space]) -> bool:
    """Whether another space lies behind a wall."""
    wall = space.walls[number]
    grow = 0.5 * np.abs(wall.inward)
    low = np.minimum(wall.origin, wall.at(wall.length, 0.0)) - grow
    high = np.maximum(wall.origin, wall.at(wall.length, 0.0)) + grow
    return any(
        s is not space and s.zone.name != space.zone.name and (low < s.high).all() and (high > s.low).all()
        for s in spaces
    )
