"""Pieces that buildings are made of: walls with holes, windows, doors, doorways, beams, pipes, galleries.

All in world coordinates. A `Structure` is the parts of one such thing and the boxes that it takes up.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.worldgen.footprints import Solid
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, paint, picture
from flymirage_core.worldgen.place import THICKNESS, Opening, Wall
from flymirage_core.worldgen.surfaces import Part, Sheet, Vector, upright

Float = NDArray[np.float64]

REVEAL = 0.12
"""Metres from a wall's face to its windows' panes."""
SKIRTING = 0.09
RAIL_HEIGHT = 1.0
DECK = 0.16
"""Metres: thickness of a gallery's floor."""


@dataclass(frozen=True, eq=False)
class Structure:
    """One thing of the building: its parts (world frame), the boxes that it fills, and those that stay clear for it."""

    parts: list[Part]
    solids: tuple[Solid, ...] = ()
    clear: tuple[Solid, ...] = ()
    shines: bool = True  # as a lamp, if it glows; not so a window pane, whose light is counted with the sky's


def placed(parts: list[Part], spot: ArrayLike, yaw: float) -> list[Part]:
    """Parts of object coordinates turned by ``yaw`` and moved to ``spot`` (3,)."""
    turn, where = upright(yaw), np.asarray(spot, float)
    return [replace(p, offset=tuple(turn @ np.asarray(p.offset) + where), rotation=turn @ p.rotation) for p in parts]


def against(wall: Wall, parts: list[Part], along: float, bottom: float = 0.0) -> list[Part]:
    """Parts made with their back at y = 0, put on a wall."""
    return placed(parts, (*wall.at(along, 0.0), bottom), wall.yaw)


def pierced(
    wall: Wall,
    material: Material,
    holes: list[Opening],
    span: tuple[float, float],
    low: float,
    high: float,
    below: Material | None = None,
) -> list[Part]:
    """The wall's face between ``span`` along it and ``low`` to ``high``, less its holes; under them of ``below``."""
    parts: list[Part] = []
    cuts = sorted({span[0], span[1], *(float(np.clip(x, *span)) for h in holes for x in (h.left, h.right))})
    for left, right in pairwise(cuts):
        if right - left < 1e-6:
            continue
        middle, start = (left + right) / 2, low
        column = sorted((h for h in holes if h.left < middle < h.right), key=lambda h: h.bottom)
        for bottom, top in [*((h.bottom, h.top) for h in column), (high, high)]:
            bottom = min(bottom, high)
            if bottom - start > 1e-3:
                corner = (*wall.at(left, 0.0), start)
                along = (*(wall.along * (right - left)), 0.0)
                face = below if below and top != high else material
                parts.append(Part(Sheet(corner, along, (0.0, 0.0, bottom - start)), face))
            start = max(start, top)
    return parts


def skirting(wall: Wall, colour: str) -> list[Part]:
    """A board along the wall's foot, with gaps at its doors."""
    parts, start = [], 0.0
    gaps = sorted((o.left, o.right) for o in wall.openings if o.bottom < 0.01)
    for left, right in [*gaps, (wall.length, wall.length)]:
        if left - start > 0.1:
            board = box(paint(colour), (left - start, 0.02, SKIRTING), (0, 0.01, 0))
            parts += against(wall, [board], (left + start) / 2)
        start = right
    return parts


def window(wall: Wall, w: Opening, pane: Material, frame: Material, reveal: Material) -> Structure:
    """A window behind the wall's face: jambs, pane, frame with bars, sill."""
    width, height, bar = w.right - w.left, w.top - w.bottom, 0.06
    parts = [picture(pane, width, height, (0, -REVEAL, 0))]
    parts += _jambs(reveal, width, height, REVEAL)
    bars = 2 if width > 1.15 else 1
    for i in range(bars + 1):
        parts.append(box(frame, (bar, 0.05, height), ((i / bars - 0.5) * (width - bar), -REVEAL + 0.03, 0)))
    crossings = (0.0, height - bar, *((height * 0.62,) if height > 1.4 else ()))
    parts += [box(frame, (width, 0.045, bar), (0, -REVEAL + 0.03, h)) for h in crossings]
    parts.append(box(frame, (width + 0.12, REVEAL + 0.08, 0.04), (0, (0.08 - REVEAL) / 2, -0.03), 0.008))
    middle = (w.left + w.right) / 2
    x, y = wall.at(middle, 0.25)
    clear = Solid(float(x), float(y), width, 0.5, w.bottom, w.top, wall.yaw)
    return Structure(against(wall, parts, middle, w.bottom), clear=(clear,), shines=False)


def _jambs(material: Material, width: float, height: float, depth: float) -> list[Part]:
    """The four faces of a hole of ``depth`` behind y = 0."""
    x = width / 2
    return [
        Part(Sheet((-x, -depth, 0.0), (0.0, depth, 0.0), (0.0, 0.0, height)), material),
        Part(Sheet((x, 0.0, 0.0), (0.0, -depth, 0.0), (0.0, 0.0, height)), material),
        Part(Sheet((-x, -depth, height), (0.0, depth, 0.0), (width, 0.0, 0.0)), material),
        Part(Sheet((-x, -depth, 0.0), (width, 0.0, 0.0), (0.0, depth, 0.0)), material),
    ]


def door(wall: Wall, d: Opening, leaf: Material) -> Structure:
    """A shut door on the wall's face: leaf with panels, frame, handle."""
    width, height = d.right - d.left, d.top
    frame = paint("white") if max(leaf.colour) < 0.6 else paint("light grey")
    parts = [box(leaf, (width - 0.14, 0.04, height - 0.08), (0, 0.02, 0.01))]
    parts += [box(leaf.shaded(0.85), (width - 0.4, 0.012, h), (0, 0.045, b)) for b, h in ((0.2, 0.7), (1.1, 0.75))]
    parts += [box(frame, (0.08, 0.06, height), (s * (width - 0.08) / 2, 0.03, 0)) for s in (-1, 1)]
    parts += [
        box(frame, (width, 0.06, 0.08), (0, 0.03, height - 0.08)),
        box(paint("silver", "metal"), (0.13, 0.04, 0.025), (width / 2 - 0.18, 0.07, 1.0), 0.008),
    ]
    middle = (d.left + d.right) / 2
    x, y = wall.at(middle, 0.55)
    clear = Solid(float(x), float(y), width, 1.1, 0.0, height, wall.yaw)
    return Structure(against(wall, parts, middle), clear=(clear,))


def doorway(wall: Wall, d: Opening, floor: Material, reveal: Material, frame: Material) -> Structure:
    """Half of a way through to the next space: the hole's faces as deep as half of the wall, floor, and a frame."""
    width, height, depth = d.right - d.left, d.top, THICKNESS / 2
    parts = [
        replace(p, material=floor if i == 3 else reveal) for i, p in enumerate(_jambs(reveal, width, height, depth))
    ]
    parts += [box(frame, (0.09, 0.04, height + 0.09), (s * (width + 0.09) / 2, 0.02, 0)) for s in (-1, 1)]
    parts.append(box(frame, (width, 0.04, 0.09), (0, 0.02, height)))
    middle = (d.left + d.right) / 2
    x, y = wall.at(middle, 0.6)
    clear = Solid(float(x), float(y), width + 0.1, 1.4, 0.0, height, wall.yaw)
    return Structure(against(wall, parts, middle), clear=(clear,))


def bar(material: Material, start: ArrayLike, end: ArrayLike, width: float, height: float) -> Structure:
    """A level beam from ``start`` to ``end`` (3,), which are the middles of its underside's ends."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.hypot(*(b - a)[:2]))
    yaw = float(np.arctan2(b[1] - a[1], b[0] - a[0]))
    x, y, z = (a + b) / 2
    solid = Solid(float(x), float(y), length, width, float(z), float(z) + height, yaw)
    return Structure(placed([box(material, (length, width, height))], (x, y, z), yaw), (solid,))


def railing(material: Material, start: ArrayLike, end: ArrayLike, base: float) -> list[Part]:
    """Posts and three rails from ``start`` to ``end`` (2,), standing at height ``base``."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length, yaw = float(np.hypot(*(b - a))), float(np.arctan2(b[1] - a[1], b[0] - a[0]))
    posts = max(2, int(length / 1.3) + 1)
    parts: list[Part] = [
        box(material, (0.045, 0.045, RAIL_HEIGHT), (x, 0, 0)) for x in np.linspace(-0.5, 0.5, posts) * length
    ]
    parts += [box(material, (length, 0.05, 0.04), (0, 0, h)) for h in (0.3, 0.62, RAIL_HEIGHT - 0.04)]
    return placed(parts, (*((a + b) / 2), base), yaw)


def gallery(wall: Wall, depth: float, height: float, floor: Material, steel: Material) -> Structure:
    """A mezzanine along the whole of a wall: deck, posts, railing, and a ladder up to it."""
    deck = box(floor, (wall.length, depth, DECK), (0, depth / 2, -DECK))
    edge = box(steel, (wall.length, 0.08, DECK + 0.08), (0, depth + 0.04, -DECK - 0.06))
    count = max(2, int(wall.length / 3.4) + 1)
    spots = np.linspace(-0.5, 0.5, count) * (wall.length - 0.4)
    posts = [box(steel, (0.12, 0.12, height - DECK), (x, depth - 0.08, -height)) for x in spots]
    parts = against(wall, [deck, edge, *posts], wall.length / 2, height)
    parts += railing(steel, wall.at(0.05, depth), wall.at(wall.length - 0.05, depth), height)
    solids = [
        _along(wall, wall.length / 2, depth / 2, wall.length, depth + 0.16, height - DECK - 0.06, height + RAIL_HEIGHT)
    ]
    for x in spots:
        solids.append(_along(wall, wall.length / 2 + x, depth - 0.08, 0.16, 0.16, 0.0, height))
    middle = wall.length * 0.5 + float(spots[0] + spots[1]) / 2
    rungs = [box(steel, (0.5, 0.035, 0.035), (0, 0.0, h)) for h in np.arange(0.3, height, 0.3)]
    rungs += [box(steel, (0.05, 0.06, height + 0.9), (s * 0.27, 0.0, 0.0)) for s in (-1, 1)]
    parts += placed(rungs, (*wall.at(middle, depth + 0.18), 0.0), wall.yaw)
    solids.append(_along(wall, middle, depth + 0.18, 0.64, 0.12, 0.0, height + 0.9))
    return Structure(parts, tuple(solids))


def _along(wall: Wall, along: float, depth: float, width: float, deep: float, bottom: float, top: float) -> Solid:
    x, y = wall.at(along, depth)
    return Solid(float(x), float(y), width, deep, bottom, top, wall.yaw)


def beside_wall(parts: list[Part], wall: Wall, depth: float, size: Vector, bottom: float) -> Structure:
    """Parts that run along a wall in a box of ``size`` (along, into the space, up), from ``bottom`` up."""
    return Structure(parts, (_along(wall, size[0] / 2, depth, size[0], size[1], bottom, bottom + size[2]),))
