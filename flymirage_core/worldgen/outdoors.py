"""Open-air spaces: ground, facades of houses, fences, and what hangs overhead. What lies beyond is in `backdrop`."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.facades import Look, row_of_houses
from flymirage_core.worldgen.finishes import dressed, finish
from flymirage_core.worldgen.footprints import Solid
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, paint, tube
from flymirage_core.worldgen.place import Place, Space, Wall
from flymirage_core.worldgen.structure import Structure, against, bar, placed
from flymirage_core.worldgen.surfaces import Part, Sheet

Float = NDArray[np.float64]

SIDEWALK = 1.7


def outdoor(space: Space, place: Place, daylight: float, rng: np.random.Generator) -> list[Structure]:
    """All of an open-air space but what lies beyond it."""
    look = Look(place.seed + 31 * place.spaces.index(space), daylight)
    things = [Structure(_ground(space, look))]
    for wall in space.walls:
        if wall.enclosure == "facade":
            things += row_of_houses(space, wall, look, rng)
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
