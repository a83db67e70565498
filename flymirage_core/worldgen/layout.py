"""Where everything stands: a description's objects placed in its room, honouring its words, never through each other.

Large things first: along the walls, then groups in the open, then what stands on them and hangs on walls and ceiling.
Each is tried at seeded random spots; the first that is free is taken. What finds no spot is reported, not squeezed in.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.design import PlannedObject
from flymirage_core.scene.keys import rng as seeded
from flymirage_core.worldgen.catalogue import Kind, kind_of
from flymirage_core.worldgen.footprints import Occupied, Solid
from flymirage_core.worldgen.room import Room, room_for
from flymirage_core.worldgen.truth import PlacedObject, Unplaced, WorldTruth

CHAIR_SPACE = 0.5
"""Metres kept free round a table in the open, on top of the walkway."""
FREE_BALL = 1.05
"""Metres round c that stay empty."""
WALL_GAP = 0.03
"""Between furniture and its wall, and between a picture's back and the wall's face."""
SIDE_GAP = 0.14
"""Between neighbours along a wall."""
PASSAGE = 1.0
"""Between tall groups in the open: a drone's corridor at any height."""
WALKWAY = 0.6
"""Between a low group in the open and anything else; half of it where there is no room for more."""
TALL = 1.0
"""Metres; higher things need a `PASSAGE` round them unless they stand at a wall."""
TABLE_GAP = 0.05
"""Between a chair and its table, and between things on a table."""
PICTURE_GAP = 0.12
FRONT_OF_PICTURE = 0.35
"""Nothing stands this close before a thing on the wall."""
LOW_HANGING = 1.95
"""Nothing hangs lower than this, except over a table."""
TRIES = 250
"""Random spots that are tried for one object or group."""


@dataclass
class Layout:
    """The room being furnished."""

    room: Room
    scene: str
    centre: tuple[float, float, float]
    objects: list[PlacedObject] = field(default_factory=list)
    occupied: Occupied = field(default_factory=Occupied)
    kept_clear: Occupied = field(default_factory=Occupied)  # before windows and doors
    missing: dict[tuple[str, str], int] = field(default_factory=dict)
    anchored: dict[int, int] = field(default_factory=dict)  # chairs already round each anchor

    def fits(self, solid: Solid, gap: float) -> bool:
        """Inside the room, out of the free ball, and ``gap`` metres away from everything (in plan)."""
        x, y, z = self.room.dimensions
        reach = solid.reach
        inside = abs(solid.x) + reach[0] <= x / 2 and abs(solid.y) + reach[1] <= y / 2 and solid.top <= z + 1e-6
        return inside and solid.distance_to(self.centre) >= FREE_BALL and not self.occupied.hits(solid, gap)

    def fits_clear(self, solid: Solid, gap: float) -> bool:
        """`fits`, and not before a window or door either."""
        return self.fits(solid, gap) and not self.kept_clear.hits(solid, 0.0)

    def put(self, planned: PlannedObject, solid: Solid, seed: int, support: int = -1) -> int:
        """Record an object; returns its id."""
        number = len(self.objects)
        self.objects.append(
            PlacedObject(
                number,
                planned.noun,
                planned.colour,
                planned.material,
                planned.placement,
                (round(solid.x, 4), round(solid.y, 4), round((solid.bottom + solid.top) / 2, 4)),
                (round(solid.width, 4), round(solid.depth, 4), round(solid.top - solid.bottom, 4)),
                round(solid.yaw, 5),
                support,
                seed,
            )
        )
        if not kind_of(planned.noun).flat:
            self.occupied.add(solid)
        return number

    def miss(self, noun: str, reason: str, count: int = 1) -> None:
        self.missing[noun, reason] = self.missing.get((noun, reason), 0) + count


def lay_out(description: SceneDescription) -> tuple[Room, WorldTruth]:
    """Furnish the room of a description. All randomness comes from the scene's key."""
    room = room_for(description)
    rng = seeded(description.scene, "layout")
    height = min(1.5, room.dimensions[2] - 1.2)
    centre = (
        round(rng.uniform(-0.3, 0.3), 3),
        round(rng.uniform(-0.3, 0.3), 3),
        round(height + rng.uniform(-0.1, 0.1), 3),
    )
    layout = Layout(room, description.scene, centre)
    _keep_openings_clear(layout)
    by_placement = {p: [o for o in description.objects if o.placement == p] for p in PLACERS}
    for placement, place in PLACERS.items():
        for planned in sorted(by_placement[placement], key=_footprint, reverse=True):
            kind = kind_of(planned.noun)
            set_size = kind.size(rng, room.dimensions[2])
            place(layout, planned, kind, set_size, rng)
    unplaced = tuple(Unplaced(noun, count, reason) for (noun, reason), count in layout.missing.items())
    return room, WorldTruth(description.scene, room.dimensions, centre, tuple(layout.objects), unplaced)


def _footprint(planned: PlannedObject) -> float:
    """Floor area and height: what is placed first. Rugs come last, when it is known what stands on them."""
    kind = kind_of(planned.noun)
    x, y, z = kind.largest
    return 0.0 if kind.flat else x * y * (1 + z)


def _keep_openings_clear(layout: Layout) -> None:
    """Nobody puts a wardrobe before a window or anything before a door."""
    for opening, depth in [(w, 0.5) for w in layout.room.windows] + [(d, 1.1) for d in layout.room.doors]:
        wall = layout.room.walls[opening.wall]
        x, y = wall.at((opening.left + opening.right) / 2, depth / 2)
        width = opening.right - opening.left
        layout.kept_clear.add(Solid(float(x), float(y), width, depth, opening.bottom, opening.top, wall.yaw))


def _seed(rng: np.random.Generator) -> int:
    return int(rng.integers(1 << 31))


def _place_against_wall(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    for _ in range(planned.count):
        x, y, z = size
        solid = _first(layout, _spots_along_walls(layout.room, x, y, 0.0, z, rng), SIDE_GAP)
        if solid is None:
            layout.miss(planned.noun, "no free stretch of wall")
        else:
            layout.put(planned, solid, _seed(rng))


def _spots_along_walls(
    room: Room, width: float, depth: float, bottom: float, height: float, rng: np.random.Generator
) -> Iterator[Solid]:
    for _ in range(TRIES):
        wall = room.walls[int(rng.integers(len(room.walls)))]
        along = rng.uniform(width / 2 + 0.1, max(wall.length - width / 2 - 0.1, width / 2 + 0.11))
        x, y = wall.at(along, WALL_GAP + depth / 2)
        yield Solid(float(x), float(y), width, depth, bottom, bottom + height, wall.yaw)


def _first(layout: Layout, spots: Iterator[Solid], gap: float) -> Solid | None:
    return next((s for s in spots if layout.fits_clear(s, gap)), None)


def _place_in_row(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    """Side by side, as many in one row as find room: four, else three, two, one."""
    left = planned.count
    while left > 0:
        for count in range(min(left, 4), 0, -1):
            pitch = size[0] + SIDE_GAP
            row = (count * pitch - SIDE_GAP, size[1], size[2])
            spots = _spots_in_the_open(layout, row, rng) if count > 1 else _spots_anywhere(layout, row, rng)
            solid = _first(layout, spots, PASSAGE if size[2] > TALL else WALKWAY)
            if solid is not None:
                for i in range(count):
                    shift = (i - (count - 1) / 2) * pitch
                    layout.put(planned, solid.shifted(shift, 0.0, size[0], size[1]), _seed(rng))
                left -= count
                break
        else:
            layout.miss(planned.noun, "no free floor for a row", left)
            return


def _spots_in_the_open(layout: Layout, size: tuple[float, float, float], rng: np.random.Generator) -> Iterator[Solid]:
    """Anywhere on the floor, square to the walls."""
    x, y, _ = layout.room.dimensions
    for _ in range(TRIES):
        yaw = float(rng.integers(4)) * np.pi / 2
        spot = rng.uniform(-0.5, 0.5, 2) * (x - 0.3, y - 0.3)
        yield Solid(float(spot[0]), float(spot[1]), size[0], size[1], 0.0, size[2], yaw)


def _spots_anywhere(layout: Layout, size: tuple[float, float, float], rng: np.random.Generator) -> Iterator[Solid]:
    """For things that stand alone: tall ones near the walls, low ones anywhere."""
    for solid in _spots_in_the_open(layout, size, rng):
        if size[2] <= TALL:
            yield solid
            continue
        wall = layout.room.walls[int(rng.integers(len(layout.room.walls)))]
        x, y = wall.at(rng.uniform(0.1, 0.9) * wall.length, max(size[:2]) / 2 + rng.uniform(0.05, 0.35))
        yield Solid(float(x), float(y), size[0], size[1], 0.0, size[2], wall.yaw)


def _place_on_floor(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    """Large things in the open with a passage round them; small ones wherever there is a gap; rugs under things."""
    if kind.flat:
        _spread_rugs(layout, planned, size, rng)
        return
    for _ in range(planned.count):
        own = size if kind.top else kind.size(rng, layout.room.dimensions[2])
        small = max(own[:2]) < 0.9 or kind.full_height
        if kind.full_height:
            spots, gap = _spots_in_the_open(layout, own, rng), PASSAGE
        elif small:
            spots, gap = _spots_anywhere(layout, own, rng), SIDE_GAP if own[2] < TALL else 0.2
        else:
            spots, gap = _spots_in_the_open(layout, own, rng), PASSAGE if own[2] > TALL else WALKWAY
            if 0.6 <= own[2] <= TALL:  # a table: keep its chairs' places free as well
                gap += CHAIR_SPACE
        solid = _first(layout, spots, gap)
        if solid is None and own[2] <= TALL:
            solid = _first(layout, _spots_in_the_open(layout, own, rng), max(gap / 2, SIDE_GAP))
        if solid is None:
            layout.miss(planned.noun, "no free floor")
        else:
            layout.put(planned, solid, _seed(rng))


def _spread_rugs(
    layout: Layout, planned: PlannedObject, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    """Centred under the named things, else under c; a rug takes nobody's place."""
    below = [o for o in layout.objects if planned.relative_to and o.noun == planned.relative_to]
    spots = [(o.centre[0], o.centre[1], o.yaw) for o in below] + [(*layout.centre[:2], 0.0)]
    x, y, _ = layout.room.dimensions
    for i in range(planned.count):
        u, v, yaw = spots[min(i, len(spots) - 1)]
        solid = Solid(u, v, size[0], size[1], 0.0, size[2], yaw)
        limit = np.array([x, y]) / 2 - solid.reach - 0.05
        u, v = np.clip([u, v], -limit, limit)
        layout.put(planned, Solid(float(u), float(v), size[0], size[1], 0.0, size[2], yaw), _seed(rng))


def _place_around(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    """On the sides of what it belongs to, facing it, evenly shared among all of its kind."""
    left = planned.count
    anchors = [o for o in layout.objects if o.noun == planned.relative_to]
    for anchor in sorted(anchors, key=lambda o: layout.anchored.get(o.object_id, 0)):
        share = int(np.ceil(left / max(1, len(anchors) - anchors.index(anchor))))
        for solid in _seats(anchor, size, share, rng):
            if share == 0 or left == 0:
                break
            if layout.fits_clear(solid, TABLE_GAP * 0.9):
                layout.put(planned, solid, _seed(rng))
                layout.anchored[anchor.object_id] = layout.anchored.get(anchor.object_id, 0) + 1
                share, left = share - 1, left - 1
    if left:
        layout.miss(planned.noun, f"no free place at a {planned.relative_to}", left)


def _seats(
    anchor: PlacedObject, size: tuple[float, float, float], wanted: int, rng: np.random.Generator
) -> Iterator[Solid]:
    """Places round an anchor for ``wanted`` seats: its long sides first, then its ends."""
    for side in range(4):
        turn = (0, 2, 1, 3)[side] * np.pi / 2
        length = anchor.size[0] if side < 2 else anchor.size[1]
        reach = (anchor.size[1] if side < 2 else anchor.size[0]) / 2
        count = max(1, min(int(length / (size[0] + 0.12)), (wanted + 1) // 2))
        for i in range(count):
            shift = (i + 0.5) * length / count - length / 2
            distance = reach + size[1] / 2 + TABLE_GAP + 0.03 + rng.uniform(0.0, 0.08)
            local = np.array(
                [shift * np.cos(turn) - distance * np.sin(turn), shift * np.sin(turn) + distance * np.cos(turn)]
            )
            x, y = np.asarray(anchor.centre[:2]) + local @ anchor.axes
            yaw = anchor.yaw + turn + np.pi + rng.uniform(-0.1, 0.1)
            yield Solid(float(x), float(y), size[0], size[1], 0.0, size[2], yaw)


def _place_on_surface(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    """On top of what the description names, else of anything that has a top; fullest spread first."""
    for _ in range(planned.count):
        own = kind.size(rng, layout.room.dimensions[2])
        supports = [o for o in layout.objects if _top_share(o) > 0 and planned.relative_to in ("", o.noun)]
        supports.sort(
            key=lambda o: sum(1 for p in layout.objects if p.support == o.object_id) / (o.size[0] * o.size[1])
        )
        for support in supports:
            solid = next((s for s in _spots_on(support, own, rng) if layout.fits(s, TABLE_GAP)), None)
            if solid is not None:
                layout.put(planned, solid, _seed(rng), support.object_id)
                break
        else:
            layout.miss(planned.noun, f"no free place on a {planned.relative_to or 'surface'}")


def _top_share(placed: PlacedObject) -> float:
    return kind_of(placed.noun).top


def _spots_on(support: PlacedObject, size: tuple[float, float, float], rng: np.random.Generator) -> Iterator[Solid]:
    """On the support, facing its front; things stand back from it, out of the way."""
    room = np.asarray(support.size[:2]) - size[:2] - 0.04
    if (room < 0).any():
        return
    base = support.bottom + support.size[2] * _top_share(support)
    for _ in range(TRIES // 4):
        local = rng.uniform(-0.5, 0.5, 2) * room
        x, y = np.asarray(support.centre[:2]) + local @ support.axes
        yield Solid(float(x), float(y), size[0], size[1], base, base + size[2], support.yaw)


def _place_on_wall(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    for _ in range(planned.count):
        x, y, z = kind.size(rng, layout.room.dimensions[2])
        for _ in range(TRIES):
            bottom = float(np.clip(rng.normal(1.62, 0.12) - z / 2, 0.9, layout.room.dimensions[2] - z - 0.2))
            solid = next(_spots_along_walls(layout.room, x, y, bottom, z, rng))
            front = solid.shifted(0.0, FRONT_OF_PICTURE / 2, x, y + FRONT_OF_PICTURE)
            if layout.fits_clear(solid, PICTURE_GAP) and not layout.occupied.hits(front, 0.0):
                back = solid.shifted(0.0, -WALL_GAP, x, y)  # flat on the wall
                layout.put(planned, back, _seed(rng))
                break
        else:
            layout.miss(planned.noun, "no free stretch of wall")


def _place_hanging(
    layout: Layout, planned: PlannedObject, kind: Kind, size: tuple[float, float, float], rng: np.random.Generator
) -> None:
    """From the ceiling; over the things that are named, or spread over the room."""
    x, y, height = layout.room.dimensions
    own = (size[0], size[1], min(size[2], height - LOW_HANGING)) if size[2] > 0.2 else size
    over = [o for o in layout.objects if planned.relative_to and o.noun == planned.relative_to]
    for number in range(planned.count):
        spots = [np.asarray(o.centre[:2]) for o in over[number:]]
        spots += [rng.uniform(-0.42, 0.42, 2) * (x, y) for _ in range(TRIES)]
        solids = (Solid(float(s[0]), float(s[1]), own[0], own[1], height - own[2], height, 0.0) for s in spots)
        solid = _first(layout, solids, 0.3)
        if solid is None:
            layout.miss(planned.noun, "no free ceiling")
        else:
            layout.put(planned, solid, _seed(rng))


PLACERS = {
    "against_wall": _place_against_wall,
    "in_row": _place_in_row,
    "on_floor": _place_on_floor,
    "facing": _place_on_floor,
    "beside": _place_on_floor,
    "around": _place_around,
    "on_surface": _place_on_surface,
    "on_wall": _place_on_wall,
    "hanging": _place_hanging,
}
"""In the order in which a room is furnished."""
