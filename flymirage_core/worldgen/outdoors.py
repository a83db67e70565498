"""Open-air spaces: ground, facades of houses, fences, and what hangs overhead. What lies beyond is in `backdrop`."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.finishes import dressed, finish
from flymirage_core.worldgen.footprints import Solid
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, paint, tube
from flymirage_core.worldgen.place import Opening, Place, Space, Wall
from flymirage_core.worldgen.structure import (
    Structure,
    against,
    bar,
    door,
    doorway,
    pierced,
    placed,
    railing,
    window,
)
from flymirage_core.worldgen.surfaces import Part, Sheet

Float = NDArray[np.float64]

HOUSE_WIDTH = (6.5, 10.5)
"""Metres of one house in a row."""
PLASTERS = ("cream", "sand", "blush", "beige", "light grey", "terracotta", "powder blue", "ochre", "sage", "tan")
DOORS = ("forest green", "burgundy", "navy", "walnut brown", "charcoal", "teal")
GLASS = (0.045, 0.055, 0.07)
"""Linear albedo of window panes seen from outside; what they mirror is added as a glow."""
MIRRORED = 9.0
"""Radiance that a pane mirrors by day, as a multiple of its albedo."""
LIT_SHARE = 0.35
"""Of the windows that are lit at night."""
SIDEWALK = 1.7
HOUSE_DEPTH = 6.0


@dataclass(frozen=True)
class Look:
    """What all open-air building needs to know: the seed, and the sky's brightness (1 by day, about 0 at night)."""

    seed: int
    daylight: float


def outdoor(space: Space, place: Place, daylight: float, rng: np.random.Generator) -> list[Structure]:
    """All of an open-air space but what lies beyond it."""
    look = Look(place.seed + 31 * place.spaces.index(space), daylight)
    things = [Structure(_ground(space, look))]
    for wall in space.walls:
        if wall.enclosure == "facade":
            things += _row_of_houses(space, wall, look, rng)
        elif wall.enclosure in ("fence", "parapet"):
            things.append(_barrier(space, wall, look))
    things += _overhead(space, rng)
    return things


def _ground(space: Space, look: Look) -> list[Part]:
    material = finish(space.zone, "ground", look.seed)
    if space.zone.kind != "street":
        return [flat(space.low, space.high, 0.0, material)]
    across = int(np.argmin(space.size))
    paving = dressed("light grey", "paving slabs", look.seed + 1)
    parts = []
    bounds = [space.low[across], space.low[across] + SIDEWALK, space.high[across] - SIDEWALK, space.high[across]]
    for i, (a, b) in enumerate(pairwise(bounds)):
        low, high = space.low.copy(), space.high.copy()
        low[across], high[across] = a, b
        parts.append(flat(low, high, 0.0, material if i == 1 else paving))
    along = 1 - across
    for edge in bounds[1:3]:
        low, high = space.low.copy(), space.high.copy()
        low[across], high[across] = edge - 0.09, edge + 0.09
        parts.append(flat(low, high, 0.008, paint("light grey", "concrete")))
    if space.size[across] > 7:
        for start in np.arange(space.low[along] + 0.8, space.high[along] - 1.5, 3.0):
            low, high = space.middle.copy(), space.middle.copy()
            low[along], high[along] = start, start + 1.4
            low[across], high[across] = space.middle[across] - 0.06, space.middle[across] + 0.06
            parts.append(flat(low, high, 0.006, paint("white", "plaster")))
    return parts


def flat(low: Float, high: Float, z: float, material: Material) -> Part:
    x, y = high - low
    return Part(Sheet((float(low[0]), float(low[1]), z), (float(x), 0.0, 0.0), (0.0, float(y), 0.0)), material)


def _row_of_houses(space: Space, wall: Wall, look: Look, rng: np.random.Generator) -> list[Structure]:
    """The facades along a wall: houses of several widths, heights and colours, with the wall's windows and doors."""
    base = finish(space.zone, "facades", look.seed)
    things: list[Structure] = []
    start, number = 0.0, 0
    while start < wall.length - 0.5:
        end = start + float(rng.uniform(*HOUSE_WIDTH))
        if wall.length - end < HOUSE_WIDTH[0] * 0.7:
            end = wall.length
        height = wall.height * float(rng.uniform(0.92, 1.2))
        material = (
            base if number % 2 == 0 else replace(base, colour=dressed(str(rng.choice(PLASTERS)), "plaster", 0).colour)
        )
        material = replace(material, seed=look.seed + number).shaded(float(rng.uniform(0.9, 1.1)))
        things += _house(wall, (start, end), height, material, look, rng)
        start, number = end, number + 1
    return things


def _house(
    wall: Wall, span: tuple[float, float], height: float, material: Material, look: Look, rng: np.random.Generator
) -> list[Structure]:
    trim = paint(str(rng.choice(["white", "chalk", "light grey", "charcoal"])))
    middle = (span[0] + span[1]) / 2
    own = [o for o in wall.openings if span[0] <= (o.left + o.right) / 2 < span[1]]
    own = [replace(o, left=max(o.left, span[0] + 0.1), right=min(o.right, span[1] - 0.1)) for o in own]
    holes = [o for o in own if o.kind != "door"]
    plinth = replace(material.shaded(0.6), seed=material.seed + 1)
    base = 0.55
    parts = pierced(wall, plinth, holes, span, 0.0, base) + pierced(wall, material, holes, span, base, height)
    width = span[1] - span[0]
    parts += against(
        wall,
        [box(trim, (width, 0.34, 0.14), (0, 0.0, 0)), box(trim.shaded(0.8), (width, 0.2, 0.1), (0, 0.0, -0.1))],
        middle,
        height,
    )
    for storey in np.arange(3.1, height - 1.5, 3.1):
        parts += against(wall, [box(trim, (width, 0.1, 0.1), (0, 0.02, 0))], middle, float(storey))
    parts += gables(wall, span, height, material)
    things = [Structure(parts)]
    leaf = paint(str(rng.choice(DOORS)), "wood", seed=look.seed)
    for o in own:
        if o.kind == "window":
            things.append(window(wall, o, glass(look, rng), trim, material.shaded(0.9)))
        elif o.kind == "door":
            things.append(door(wall, o, leaf))
            if rng.uniform() < 0.5:
                things.append(_awning(wall, o, rng))
        else:
            things.append(doorway(wall, o, paint("grey", "concrete"), material.shaded(0.9), trim))
    things += _balconies(wall, [o for o in own if o.kind == "window" and o.bottom > 3.0], rng)
    return things


def gables(wall: Wall, span: tuple[float, float], height: float, material: Material) -> list[Part]:
    """A house's sides and roof behind its facade: seen where its neighbour is lower, and from above."""
    plain = replace(material.shaded(0.85), detail=3.0)
    (x0, y0), (x1, y1) = wall.at(span[0], 0.0), wall.at(span[1], 0.0)
    back = (*(-HOUSE_DEPTH * wall.inward), 0.0)
    forth = (*(HOUSE_DEPTH * wall.inward), 0.0)
    base = max(height - 4.0, 0.0)
    up = (0.0, 0.0, height - base)
    bx, by, _ = back
    roof = replace(dressed("terracotta", "shingle", material.seed), detail=3.0)
    ridge = (bx, by, 1.6)
    return [
        Part(Sheet((x0 + bx, y0 + by, base), forth, up), plain),
        Part(Sheet((x1, y1, base), back, up), plain),
        Part(Sheet((x0, y0, height), (x1 - x0, y1 - y0, 0.0), ridge), roof),
    ]


def glass(look: Look, rng: np.random.Generator) -> Material:
    """A pane seen from outside: it mirrors the sky by day; at night some are lit from within."""
    if look.daylight < 0.1 and rng.uniform() < LIT_SHARE:
        return Material((0.9, 0.66, 0.36), "plain", emission=float(rng.uniform(0.35, 0.8)))
    return Material(GLASS, "plain", emission=MIRRORED * look.daylight * float(rng.uniform(0.5, 1.3)))


def _awning(wall: Wall, o: Opening, rng: np.random.Generator) -> Structure:
    """A striped roof of cloth over a door, on two struts."""
    width, depth = o.right - o.left + 1.1, 1.1
    cloth = Material(dressed(str(rng.choice(DOORS)), "canvas", 0).colour, "stripes", ink=(0.75, 0.72, 0.66))
    sheet = Part(Sheet((-width / 2, 0.03, 0.5), (width, 0.0, 0.0), (0.0, depth, -0.45)), cloth)
    flap = Part(Sheet((width / 2, depth + 0.03, -0.12), (-width, 0.0, 0.0), (0.0, 0.0, 0.17)), cloth)
    under = Part(
        Sheet((-width / 2, depth + 0.03, 0.04), (width, 0.0, 0.0), (0.0, -depth, 0.45)), paint("beige", "fabric")
    )
    parts = [sheet, flap, under]
    for s in (-1, 1):
        parts += tube(
            paint("charcoal", "metal"), [(s * width / 2.1, 0.03, -0.1), (s * width / 2.1, depth, 0.03)], 0.015
        )
    middle = float(
        np.clip((o.left + o.right) / 2, width / 2 + 0.1, max(wall.length - width / 2 - 0.1, width / 2 + 0.11))
    )
    x, y = wall.at(middle, depth / 2)
    solid = Solid(float(x), float(y), width, depth + 0.1, 2.35, 3.05, wall.yaw)
    return Structure(against(wall, parts, middle, 2.45), (solid,))


def _balconies(wall: Wall, windows: list[Opening], rng: np.random.Generator) -> list[Structure]:
    """Before some of the upper windows."""
    things = []
    for o in windows:
        if rng.uniform() > 0.22:
            continue
        width, depth = o.right - o.left + 0.5, 0.85
        middle = (o.left + o.right) / 2
        steel, slab = paint("charcoal", "metal"), paint("light grey", "concrete")
        parts = against(wall, [box(slab, (width, depth, 0.14), (0, depth / 2, -0.14))], middle, o.bottom - 0.1)
        corners = [
            wall.at(middle - width / 2, 0.03),
            wall.at(middle - width / 2, depth),
            wall.at(middle + width / 2, depth),
            wall.at(middle + width / 2, 0.03),
        ]
        for a, b in pairwise(corners):
            parts += railing(steel, a, b, o.bottom - 0.1)
        x, y = wall.at(middle, depth / 2)
        things.append(
            Structure(parts, (Solid(float(x), float(y), width, depth, o.bottom - 0.25, o.bottom + 0.95, wall.yaw),))
        )
    return things


def _barrier(space: Space, wall: Wall, look: Look) -> Structure:
    """A fence of boards or sheet metal between posts; a roof's parapet with its coping."""
    middle = wall.length / 2
    if wall.enclosure == "parapet":
        face = finish(space.zone, "facades", look.seed)
        parts = [
            box(face, (wall.length + 0.5, 0.25, wall.height), (0, -0.125, 0)),
            box(paint("light grey", "concrete"), (wall.length + 0.6, 0.36, 0.08), (0, -0.125, wall.height)),
        ]
        return Structure(against(wall, parts, middle))
    metal = (look.seed + int(wall.length)) % 2
    skin = (
        dressed("slate grey", "corrugated steel", look.seed)
        if metal
        else replace(paint("oak brown", "wood"), stretch=2.0, wear=0.3)
    )
    posts = paint("charcoal", "metal") if metal else paint("walnut brown", "wood")
    parts = [box(posts, (0.1, 0.1, wall.height + 0.08), (x, -0.1, 0)) for x in np.arange(-middle, middle + 0.1, 2.5)]
    if metal:
        parts.append(box(skin, (wall.length, 0.04, wall.height - 0.1), (0, -0.03, 0.06)))
    else:
        count = max(1, int(wall.length / 0.36))
        width = wall.length / count
        parts += [
            box(
                skin.shaded(0.85 + 0.3 * ((i * 7919) % 13) / 13),
                (width, 0.03, wall.height - 0.15 + 0.05 * ((i * 31) % 3)),
                ((i + 0.5) * width - middle, -0.03, 0.04),
            )
            for i in range(count)
        ]
    parts += [box(posts, (wall.length, 0.05, 0.09), (0, 0.0, h)) for h in (0.45, wall.height - 0.5)]
    return Structure(against(wall, parts, middle))


def _overhead(space: Space, rng: np.random.Generator) -> list[Structure]:
    """Cables and strings of lights across streets and courtyards, a pipe bridge over yards."""
    along, across = int(np.argmax(space.size)), int(np.argmin(space.size))
    things = []
    if space.zone.kind in ("street", "courtyard"):
        for _ in range(int(rng.integers(2, 4))):
            start, end = np.empty(3), np.empty(3)
            start[across], end[across] = space.low[across], space.high[across]
            start[along], end[along] = space.low[along] + rng.uniform(0.15, 0.85, 2) * space.size[along]
            start[2], end[2] = rng.uniform(3.6, min(5.2, space.height - 0.3), 2) if space.height > 4 else (2.7, 2.8)
            t = np.linspace(0, 1, 9)
            line = start + t[:, None] * (end - start)
            line[:, 2] -= 0.5 * 4 * t * (1 - t) * min(1.0, space.size[across] / 8)
            parts = tube(paint("black"), line, 0.014)
            bulb = Material((0.95, 0.8, 0.55), "plain", emission=1.2)
            parts += [box(bulb, (0.07, 0.07, 0.1), tuple(p - [0, 0, 0.12])) for p in line[1:-1]]
            things.append(Structure(parts, _under(line)))
    if space.zone.kind == "yard" and space.size[across] > 6:
        z = 3.9
        steel = paint("slate grey", "enamel")
        at = space.low[along] + space.size[along] * float(rng.uniform(0.25, 0.75))
        start, end = np.array([*space.low, z]), np.array([*space.high, z])
        start[along] = end[along] = at
        things.append(bar(steel, start, end, 0.5, 0.16))
        for offset, radius in ((-0.14, 0.1), (0.12, 0.07)):
            a, b = start.copy(), end.copy()
            a[2] = b[2] = z + 0.16 + radius
            a[along] += offset
            b[along] += offset
            colour = str(rng.choice(["light grey", "ochre", "silver", "brick red"]))
            things.append(Structure(tube(paint(colour, "enamel"), [a, b], radius)))
        for share in (0.02, 0.5, 0.98):
            spot = start[:2] + share * (end - start)[:2]
            things.append(
                Structure(
                    placed([box(steel, (0.2, 0.2, z))], (*spot, 0.0), 0.0),
                    (Solid(float(spot[0]), float(spot[1]), 0.24, 0.24, 0.0, z, 0.0),),
                )
            )
    return things


def _under(line: Float) -> tuple[Solid, ...]:
    """Boxes round the pieces of a hanging line, with its bulbs."""
    solids = []
    for a, b in pairwise(line):
        x, y, _ = (a + b) / 2
        length, yaw = float(np.hypot(*(b - a)[:2])), float(np.arctan2(b[1] - a[1], b[0] - a[0]))
        solids.append(
            Solid(float(x), float(y), length, 0.1, float(min(a[2], b[2])) - 0.14, float(max(a[2], b[2])) + 0.02, yaw)
        )
    return tuple(solids)
