"""Indoor spaces: floor, walls, ceiling or vault, windows and doors, and what hangs under their roofs by their kind."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.finishes import finish
from flymirage_core.worldgen.footprints import Solid
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, paint, tube
from flymirage_core.worldgen.place import Place, Space, Wall
from flymirage_core.worldgen.structure import (
    Structure,
    bar,
    beside_wall,
    door,
    doorway,
    gallery,
    pierced,
    placed,
    skirting,
    window,
)
from flymirage_core.worldgen.surfaces import Part, Patch, Sheet

Float = NDArray[np.float64]

DOOR_COLOURS = ("walnut brown", "chalk", "oak brown", "slate grey", "honey brown")
VAULT_SPRING = 0.62
"""Height at which a tunnel's vault begins, as a share of its crown's."""
SKYLIGHT = (1.6, 2.4)
FITTING_PITCH = 4.2
"""Metres between the lamps that belong to the building."""
PANE_GLOW = 1.5
"""Radiance of the picture in a window by day, as a share of its albedo: exposed for the room, not for the sky."""
UNDER_ROOF = {"industrial_floor", "hall", "tunnel"}


def indoor(space: Space, place: Place, daylight: float, rng: np.random.Generator) -> list[Structure]:
    """All of an indoor space. ``daylight`` is the sky's brightness, 1 by day."""
    seed = place.seed + 17 * place.spaces.index(space)
    floor, wall = finish(space.zone, "floor", seed), finish(space.zone, "walls", seed + 1)
    x, y, z = *space.size, space.height
    shell = [Part(Sheet((*space.low, 0.0), (x, 0.0, 0.0), (0.0, y, 0.0)), floor)]
    trim = paint("white") if space.zone.kind in ("room", "gallery", "corridor") else paint("slate grey")
    structures = []
    for number, line in enumerate(space.walls):
        holes = [o for o in line.openings if o.kind != "door"]
        shell += pierced(line, wall, holes, (0.0, line.length), 0.0, z)
        if space.zone.kind in ("room", "gallery", "corridor"):
            shell += skirting(line, "white")
        for opening in line.openings:
            if opening.kind == "window":
                structures.append(window(line, opening, pane(daylight, seed + number), trim, wall.shaded(1.02)))
            elif opening.kind == "door":
                leaf = paint(DOOR_COLOURS[(seed + number) % len(DOOR_COLOURS)], "wood", seed=seed + number)
                structures.append(door(line, opening, leaf))
            else:
                structures.append(doorway(line, opening, floor, wall, trim))
    shell += _roof(space, place, daylight, seed)
    return [Structure(shell, shines=False), *structures, *_under_the_roof(space, rng), *_fittings(space, place)]


def pane(daylight: float, seed: int) -> Material:
    """What a window shows, as bright as the day is."""
    return Material((0.9, 0.9, 0.9), "sky", emission=max(PANE_GLOW * daylight, 0.012), detail=1.0, seed=seed)


def ceiling_at(space: Space, spot: Float) -> float:
    """Metres: clear height over a spot (2,) of an indoor space."""
    if space.zone.kind != "tunnel":
        return space.height
    across = int(np.argmin(space.size))
    off = abs(spot[across] - space.middle[across]) / (space.size[across] / 2)
    spring = VAULT_SPRING * space.height
    return float(spring + (space.height - spring) * np.sqrt(max(1 - off * off, 0.0)))


def skylights(space: Space, place: Place) -> list[tuple[Float, Float]]:
    """Plan rectangles (low, high) of the roof's windows."""
    wanted = "skylights" in place.light.sources and space.zone.kind in ("hall", "gallery", "industrial_floor", "room")
    if not wanted:
        return []
    along = int(np.argmax(space.size))
    count = max(1, int(space.size[along] / 4.5))
    size = np.array(SKYLIGHT if along == 1 else SKYLIGHT[::-1]) * min(1.0, float(space.size.min()) / 5)
    spots = []
    for i in range(count):
        middle = space.middle.copy()
        middle[along] = space.low[along] + space.size[along] * (i + 0.5) / count
        spots.append((middle - size / 2, middle + size / 2))
    return spots


def _roof(space: Space, place: Place, daylight: float, seed: int) -> list[Part]:
    if space.zone.kind == "tunnel":
        return [_vault(space, finish(space.zone, "walls", seed + 1))]
    material = finish(space.zone, "ceiling", seed + 2)
    z, lights = space.height, skylights(space, place)
    parts = []
    along = int(np.argmax(space.size))
    low, high = space.low.copy(), space.high.copy()
    for a, b in lights:
        for piece_low, piece_high in _frame(a, b, low, high, along):
            parts.append(_ceiling(piece_low, piece_high, z, material))
        parts.append(_ceiling(a, b, z + 0.2, replace(pane(daylight, seed), texture="plain", colour=(0.75, 0.85, 1.0))))
        parts += _shaft(a, b, z, material)
        low[along] = b[along]
    parts.append(_ceiling(low, high, z, material))
    return parts


def _frame(a: Float, b: Float, low: Float, high: Float, along: int) -> list[tuple[Float, Float]]:
    """The ceiling before and at both sides of a hole from ``a`` to ``b``."""
    other = 1 - along
    before, left, right = (low.copy(), high.copy()), (low.copy(), high.copy()), (low.copy(), high.copy())
    before[1][along] = a[along]
    for side in (left, right):
        side[0][along], side[1][along] = a[along], b[along]
    left[1][other], right[0][other] = a[other], b[other]
    return [before, left, right]


def _ceiling(low: Float, high: Float, z: float, material: Material) -> Part:
    x, y = high - low
    return Part(Sheet((low[0], high[1], z), (x, 0.0, 0.0), (0.0, -y, 0.0)), material)


def _shaft(a: Float, b: Float, z: float, material: Material) -> list[Part]:
    x, y = b - a
    up = (0.0, 0.0, 0.2)
    return [
        Part(Sheet((b[0], a[1], z), (-x, 0.0, 0.0), up), material),
        Part(Sheet((a[0], b[1], z), (x, 0.0, 0.0), up), material),
        Part(Sheet((a[0], a[1], z), (0.0, y, 0.0), up), material),
        Part(Sheet((b[0], b[1], z), (0.0, -y, 0.0), up), material),
    ]


def _vault(space: Space, material: Material) -> Part:
    """Half an ellipse over the shorter side, swept along the longer one; seen from below."""
    along, across = int(np.argmax(space.size)), int(np.argmin(space.size))
    spring = VAULT_SPRING * space.height
    angle = np.linspace(0.0, np.pi, 25)
    grid = np.zeros((25, 2, 3))
    grid[:, :, across] = (space.middle[across] + np.cos(angle) * space.size[across] / 2)[:, None]
    grid[:, :, 2] = (spring + np.sin(angle) * (space.height - spring))[:, None]
    grid[:, :, along] = (space.low[along], space.high[along])
    flip = along == 0
    return Part(Patch(grid[:, ::-1] if flip else grid), material)


def _under_the_roof(space: Space, rng: np.random.Generator) -> list[Structure]:
    """Beams, trusses, pipes, ducts, cable trays and galleries, by the kind of space."""
    kind, z = space.zone.kind, space.height
    things: list[Structure] = []
    if kind == "room" and z > 2.9 and rng.uniform() < 0.45:
        things += _beams(space, paint("walnut brown", "wood"), 0.16, 0.2, 2.4)
    if kind in ("hall", "industrial_floor"):
        steel = paint(str(rng.choice(["charcoal", "slate grey", "light grey", "forest green"])), "enamel")
        things += _beams(space, steel, 0.2, 0.3, 3.6)
        free = [w for w in space.walls if not any(o.kind == "window" for o in w.openings)]
        if z >= 4.6 and free:
            floor = paint("charcoal", "metal") if kind == "industrial_floor" else paint("oak brown", "wood")
            things.append(gallery(free[int(rng.integers(len(free)))], 2.2, 2.75, floor, steel))
    if kind in ("industrial_floor", "tunnel", "corridor"):
        things += _pipes(space, rng)
    if kind == "industrial_floor":
        things.append(_duct(space, rng))
    return things


def _beams(space: Space, material: Material, width: float, height: float, pitch: float) -> list[Structure]:
    along = int(np.argmax(space.size))
    count = max(1, int(space.size[along] / pitch))
    beams = []
    for i in range(count):
        start, end = np.array([*space.low, space.height - height]), np.array([*space.high, space.height - height])
        start[along] = end[along] = space.low[along] + space.size[along] * (i + 0.5 + 0.25) / (count + 0.5)
        beams.append(bar(material, start, end, width, height))
    return beams


def _pipes(space: Space, rng: np.random.Generator) -> list[Structure]:
    """Two to four pipes and a cable tray along a long wall, under the ceiling but above the doors."""
    long = [w for w in space.walls if w.length > max(space.size) - 0.1]
    wall = long[int(rng.integers(len(long)))]
    top = (VAULT_SPRING if space.zone.kind == "tunnel" else 1.0) * space.height - 0.12
    above = [o.top for o in wall.openings if o.kind != "window"]
    things = []
    height = top - 0.12
    for _ in range(int(rng.integers(2, 5))):
        radius = float(rng.choice([0.05, 0.07, 0.1]))
        if height - radius < max([2.0, *above]) + 0.1:
            break
        colour = str(rng.choice(["light grey", "ochre", "forest green", "brick red", "silver", "sky blue"]))
        ends = [(*wall.at(s, 0.06 + radius), height) for s in (0.02, wall.length - 0.02)]
        parts = tube(paint(colour, "enamel"), ends, radius)
        clamps = [(s, radius) for s in np.arange(0.8, wall.length, 2.4)]
        parts += [p for s, r in clamps for p in _clamp(wall, float(s), height, r)]
        things.append(
            beside_wall(
                parts, wall, 0.06 + radius, (wall.length, 2 * radius + 0.06, 2 * radius + 0.06), height - radius - 0.03
            )
        )
        height -= 2 * radius + 0.09
    return things


def _clamp(wall: Wall, along: float, height: float, radius: float) -> list[Part]:
    ring = box(paint("charcoal", "metal"), (0.05, 2 * radius + 0.07, 2 * radius + 0.03), (0, 0, -radius - 0.015))
    return placed([ring], (*wall.at(along, 0.05 + radius), height), wall.yaw)


def _duct(space: Space, rng: np.random.Generator) -> Structure:
    """A round air duct along the space, hung under the beams."""
    along, across = int(np.argmax(space.size)), int(np.argmin(space.size))
    radius, z = 0.24, space.height - 0.62
    start, end = np.array([*space.low, z]), np.array([*space.high, z])
    start[across] = end[across] = space.middle[across] + float(rng.choice([-0.28, 0.28])) * space.size[across]
    parts = tube(paint("silver", "brushed"), [start, end], radius)
    yaw = 0.0 if along == 0 else np.pi / 2
    for s in np.arange(1.2, space.size[along], 2.4):
        spot = start.copy()
        spot[along] += s
        parts += placed(
            [box(paint("grey", "metal"), (0.06, 2 * radius + 0.04, 0.62 + radius), (0, 0, -radius))], spot, yaw
        )
    middle = (start + end) / 2

    size = float(space.size[along])
    return Structure(parts, (Solid(float(middle[0]), float(middle[1]), size, 0.56, z - 0.3, space.height, yaw),))


def _fittings(space: Space, place: Place) -> list[Structure]:
    """Lamps of the building itself: in tunnels, corridors and works always, elsewhere where no daylight comes in."""
    lit = any(o.kind == "window" for w in space.walls for o in w.openings) and place.light.time_of_day != "night"
    artificial = bool({"ceiling_lamps", "work_lights", "neon"} & set(place.light.sources))
    if (
        space.zone.kind not in ("tunnel", "corridor", "industrial_floor")
        and (lit or skylights(space, place))
        and not artificial
    ):
        return []
    along, across = int(np.argmax(space.size)), int(np.argmin(space.size))
    rows = 1 if space.size[across] < 6 else 2
    count = max(1, int(space.size[along] / FITTING_PITCH))
    warm = "neon" not in place.light.sources
    glow = Material((0.9, 0.84, 0.7) if warm else (0.8, 0.88, 0.9), "plain", emission=1.6)
    yaw = 0.0 if along == 0 else np.pi / 2
    things = []
    for i in range(count):
        for row in range(rows):
            spot = np.empty(2)
            spot[along] = space.low[along] + space.size[along] * (i + 0.5) / count
            spot[across] = space.low[across] + space.size[across] * (row + 0.5) / rows
            z = ceiling_at(space, spot) - (
                0.45 if space.zone.kind in UNDER_ROOF and space.zone.kind != "tunnel" else 0.0
            )
            body = [
                box(paint("white", "metal"), (1.25, 0.16, 0.05), (0, 0, -0.06)),
                box(glow, (1.18, 0.11, 0.03), (0, 0, -0.085)),
            ]
            if z < space.height - 0.1:
                body += [box(paint("charcoal"), (0.02, 0.02, space.height - z), (s * 0.5, 0, 0)) for s in (-1, 1)]

            solid = Solid(float(spot[0]), float(spot[1]), 1.25, 0.16, z - 0.1, space.height, yaw)
            things.append(Structure(placed(body, (*spot, z), yaw), (solid,)))
    return things
