"""What is seen past open-air spaces: more ground, more houses, trees, hills, up to the dome of the sky.

Drones do not get there; it is there so that no view ends in nothing.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.catalogue import KINDS
from flymirage_core.worldgen.facades import HOUSE_WIDTH, PLASTERS, Look, gables, glass
from flymirage_core.worldgen.finishes import dressed, finish
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.noise import fractal
from flymirage_core.worldgen.outdoors import flat
from flymirage_core.worldgen.parts import Finish, box, paint
from flymirage_core.worldgen.place import Place, Space, Wall
from flymirage_core.worldgen.structure import Structure, against, pierced, placed
from flymirage_core.worldgen.surfaces import Part, Patch

Float = NDArray[np.float64]

BEYOND = 46.0
"""Metres from the origin to the sky dome; all that is seen lies within it."""
HILLS = 40.0
RINGS = (2.5, 5.0, 8.0, 14.0, 60.0)
"""Metres: widths of the frames of ground."""
ROW_BEYOND = 20.0
"""Metres by which the houses of a street go on past its ends."""
DROP = 14.0
"""Metres from a roof down to the street."""


def beyond(place: Place, daylight: float, rng: np.random.Generator) -> list[Structure]:
    """What is seen past the spaces: more ground, more houses, trees, hills. Drones do not get there."""
    main = next(s for s in place.spaces if s.open_air)
    look = Look(place.seed, daylight)
    floor = -DROP if main.zone.kind == "rooftop" else -0.02
    ground = (
        finish(main.zone, "ground", look.seed)
        if main.zone.kind in ("yard", "street")
        else dressed("grey", "asphalt", 1)
    )
    hidden = main.zone.kind in ("street", "courtyard")  # behind facades
    parts = _ring(place, replace(ground, detail=6.0 if hidden else 1.6, wear=0.0), floor)
    parts.append(_hills(place, look, floor))
    things = [Structure(parts)]
    if main.zone.kind == "street":
        things += _street_goes_on(main, look, rng)
    else:
        things += _city(place, main, look, rng, floor)
    return things


def _ring(place: Place, material: Material, z: float) -> list[Part]:
    """Ground round the spaces' bounds out to the dome, in frames one round the other, cut coarser outwards."""
    low, high = place.bounds[0, :2], place.bounds[1, :2]
    parts = []
    for out in RINGS:
        outer = np.minimum(low, np.maximum(low - out, -BEYOND)), np.maximum(high, np.minimum(high + out, BEYOND))
        (x0, y0), (x1, y1), (u0, v0), (u1, v1) = *outer, low, high
        corners = [((x0, y0), (x1, v0)), ((x0, v1), (x1, y1)), ((x0, v0), (u0, v1)), ((u1, v0), (x1, v1))]
        parts += [
            flat(np.array(a), np.array(b), z, material) for a, b in corners if min(b[0] - a[0], b[1] - a[1]) > 0.01
        ]
        low, high = outer
    if z < -1:
        parts.append(flat(place.bounds[0, :2], place.bounds[1, :2], z, material))
    return parts


def _hills(place: Place, look: Look, floor: float) -> Part:
    """A wavy band of woods and hills all round, before the dome."""
    angle = np.linspace(0, 2 * np.pi, 97)
    shape = fractal(np.stack([np.cos(angle), np.sin(angle)], 1) * 3.0, look.seed)
    top = 3.2 + 2.6 * shape
    rows = np.array([0.0, 0.55, 1.0])
    grid = np.zeros((3, 97, 3))
    radius = HILLS + 3.5 * rows[:, None]
    grid[..., 0], grid[..., 1] = radius * np.cos(angle), radius * np.sin(angle)
    grid[..., 2] = floor + rows[:, None] * (top - min(floor, 0.0) * 0.4)
    return Part(Patch(grid), Material((0.12, 0.17, 0.11), "leaf", seed=look.seed))


def _street_goes_on(street: Space, look: Look, rng: np.random.Generator) -> list[Structure]:
    """More houses on both sides past the street's ends, and one that closes the view."""
    along, across = int(np.argmax(street.size)), int(np.argmin(street.size))
    things = []
    for sign in (-1, 1):
        end = street.high[along] if sign > 0 else street.low[along]
        low, high = street.low.copy(), street.high.copy()
        low[along], high[along] = sorted((end, end + sign * ROW_BEYOND))
        things.append(Structure([flat(low, high, 0.0, replace(finish(street.zone, "ground", look.seed), detail=1.4))]))
        for side in (-1, 1):
            face = street.high[across] if side > 0 else street.low[across]
            a, b = np.empty(2), np.empty(2)
            a[across] = b[across] = face
            a[along], b[along] = end, end + sign * ROW_BEYOND
            things += _far_houses(_line(a, b, street.middle, street.height), look, rng)
        a, b = np.empty(2), np.empty(2)
        a[along] = b[along] = end + sign * ROW_BEYOND
        a[across], b[across] = street.low[across] - 6, street.high[across] + 6
        things += _far_houses(_line(a, b, street.middle, street.height * 1.1), look, rng)
    return things


def _line(a: Float, b: Float, towards: Float, height: float) -> Wall:
    """A wall from ``a`` to ``b`` (2,) that looks towards a point."""
    length = float(np.hypot(*(b - a)))
    along = (b - a) / length
    inward = np.array([along[1], -along[0]])
    if inward @ (towards - (a + b) / 2) < 0:
        a, along, inward = b, -along, -inward
    return Wall(a, along, inward, length, height, "facade")


def _far_houses(wall: Wall, look: Look, rng: np.random.Generator, colour: str = "") -> list[Structure]:
    """Facades with panes on their face, seen from afar only; all alike if a ``colour`` is given."""
    parts: list[Part] = []
    start = 0.0
    while start < wall.length - 0.5:
        end = min(start + float(rng.uniform(*HOUSE_WIDTH)), wall.length)
        height = wall.height * (1.0 if colour else float(rng.uniform(0.85, 1.25)))
        material = replace(dressed(colour or str(rng.choice(PLASTERS)), "plaster", look.seed), detail=2.2)
        parts += pierced(wall, material, [], (start, end), 0.0, height)
        if not colour:
            parts += gables(wall, (start, end), height, material)
        parts += against(wall, [box(paint("chalk"), (end - start, 0.3, 0.2))], (start + end) / 2, height)
        columns = max(1, int((end - start) / 2.2))
        for storey in range(max(1, int(height / 3.1))):
            for i in range(columns):
                middle = start + (i + 0.5) * (end - start) / columns
                parts += against(
                    wall,
                    [box(glass(look, rng), (1.1, 0.03, 1.4)), box(paint("chalk"), (1.3, 0.05, 0.08), (0, 0, -0.08))],
                    middle,
                    storey * 3.1 + 1.0,
                )
        start = end
    return [Structure(parts, shines=False)]


def _city(place: Place, main: Space, look: Look, rng: np.random.Generator, floor: float) -> list[Structure]:
    """Houses and trees at some distance all round; beyond a courtyard's facades nothing but what towers over them."""
    if main.zone.kind == "courtyard":
        return []
    low, high = place.bounds[0, :2], place.bounds[1, :2]
    things = []
    for i in range(11 if main.zone.kind == "rooftop" else 6):
        angle = (i + float(rng.uniform(-0.3, 0.3))) * 2 * np.pi / (11 if main.zone.kind == "rooftop" else 6)
        reach = np.hypot(*(high - low)) / 2 + float(rng.uniform(5, 13))
        spot = min(reach, 33.0) * np.array([np.cos(angle), np.sin(angle)])
        size = rng.uniform(7, 12, 2)
        tall = (
            float(rng.uniform(5, 10))
            - (floor if floor < -1 else 0.0)
            + (float(rng.uniform(-8, 4)) if floor < -1 else 0.0)
        )
        things += _tower(spot, size, max(tall, 4.0), floor, look, rng)
    if main.zone.kind == "yard" and "tree" in KINDS:
        kind = KINDS["tree"]
        for _ in range(9):
            angle = float(rng.uniform(0, 2 * np.pi))
            spot = (np.hypot(*(high - low)) / 2 + float(rng.uniform(2.0, 4.5))) * np.array(
                [np.cos(angle), np.sin(angle)]
            )
            if ((spot > low - 2.2) & (spot < high + 2.2)).all():
                continue
            made = kind.build(
                kind.largest,
                Finish(paint("forest green", "leaf"), paint("walnut brown", "bark"), int(rng.integers(1 << 30))),
            )
            things.append(Structure(placed(made, (*spot, floor), angle)))
    return things


def _tower(
    spot: Float, size: Float, height: float, floor: float, look: Look, rng: np.random.Generator
) -> list[Structure]:
    """A detached house seen from outside: four far facades and a flat roof."""
    low, high = spot - size / 2, spot + size / 2
    corners = [low, np.array([high[0], low[1]]), high, np.array([low[0], high[1]])]
    parts: list[Part] = []
    colour = str(rng.choice(PLASTERS))
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        wall = _line(a, b, (a + b) / 2 + ((a + b) / 2 - spot), height)
        parts += [
            replace(p, offset=(p.offset[0], p.offset[1], p.offset[2] + floor))
            for t in _far_houses(wall, look, rng, colour)
            for p in t.parts
        ]
    parts.append(flat(low, high, floor + height, paint("grey", "concrete")))
    return [Structure(parts, shines=False)]
