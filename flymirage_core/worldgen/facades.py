"""Street fronts of houses: storeys, mouldings, windows with what is behind them, doors, shop fronts, weathering."""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.finishes import dressed, finish
from flymirage_core.worldgen.footprints import Solid
from flymirage_core.worldgen.forms import patterned, sign
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, paint, tube
from flymirage_core.worldgen.place import Opening, Space, Wall
from flymirage_core.worldgen.structure import Structure, against, door, doorway, pierced, railing, window
from flymirage_core.worldgen.surfaces import Part, Sheet

Float = NDArray[np.float64]

HOUSE_WIDTH: Final = (6.5, 10.5)
"""Metres of one house in a row."""
PLASTERS: Final = ("cream", "sand", "blush", "beige", "light grey", "terracotta", "powder blue", "ochre", "sage", "tan")
DOORS: Final = ("forest green", "burgundy", "navy", "walnut brown", "charcoal", "teal")
SHUTTERS: Final = ("forest green", "slate grey", "denim blue", "oak brown", "sage", "burgundy", "chalk")
TRIMS: Final = ("white", "chalk", "light grey", "sand")
FRAMES: Final = ("white", "white", "chalk", "charcoal", "walnut brown")
TRADES: Final = (
    "BAKERY",
    "BOOKS",
    "FLORIST",
    "CAFE LUNA",
    "OPTICIAN",
    "TAILOR",
    "ANTIQUES",
    "PHARMACY",
    "GROCER",
    "SHOES",
)
GLASS: Final = (0.9, 0.94, 1.0)
"""Tint of panes seen from outside; how much each place of one shows is in the texture "interior"."""
MIRRORED: Final = 3.6
"""Radiance of a pane by day, as a multiple of its albedo: the sky that it mirrors, and daylight behind it."""
LIT_SHARE: Final = 0.35
"""Of the windows that are lit at night."""
HOUSE_DEPTH: Final = 6.0
"""Metres."""
STOREY: Final = 3.1
"""Metres from floor to floor."""
SHOP_HEIGHT: Final = 2.62
"""Metres up to a shop front's fascia."""


@dataclass(frozen=True)
class Look:
    """What all open-air building needs to know: the seed, and the sky's brightness (1 by day, about 0 at night)."""

    seed: int
    daylight: float


@dataclass(frozen=True)
class Front:
    """How one house looks."""

    wall: Material
    base: float  # metres: height of the plinth
    trim: Material
    frame: Material
    shutters: Material | None
    shop: Material | None
    surround: str  # of its windows: "none", "band", "lintel", "hood"
    corners: bool  # dressed stones up both edges
    dentils: bool

    @staticmethod
    def drawn(material: Material, shops: bool, rng: np.random.Generator) -> "Front":
        """One of very many fronts in a wall ``material``; ``shops``: some houses have a shop on the ground floor."""

        def maybe(share: float) -> bool:
            return bool(rng.uniform() < share)

        return Front(
            replace(
                material, wear=max(material.wear, float(rng.uniform(0.15, 0.4))), stain=float(rng.uniform(0.2, 0.6))
            ),
            float(rng.uniform(0.35, 0.9)),
            replace(paint(str(rng.choice(TRIMS)), "stone"), wear=0.25),
            paint(str(rng.choice(FRAMES))),
            patterned(str(rng.choice(SHUTTERS)), "louvres", "charcoal") if maybe(0.45) else None,
            paint(str(rng.choice(DOORS)), "wood", seed=material.seed) if shops and maybe(0.55) else None,
            str(rng.choice(["none", "band", "lintel", "hood"])),
            maybe(0.35),
            maybe(0.5),
        )


def row_of_houses(space: Space, wall: Wall, look: Look, rng: np.random.Generator) -> list[Structure]:
    """The facades along a wall: houses of several widths, heights and colours, with the wall's windows and doors."""
    base = finish(space.zone, "facades", look.seed)
    things: list[Structure] = []
    start, number = 0.0, 0
    while start < wall.length - 0.5:
        end = start + float(rng.uniform(*HOUSE_WIDTH))
        if wall.length - end < HOUSE_WIDTH[0] * 0.7:
            end = wall.length
        height = wall.height * float(rng.uniform(0.92, 1.2))
        material = base if number % 2 == 0 else dressed(str(rng.choice(PLASTERS)), "plaster", 0)
        material = replace(material, seed=look.seed + number).shaded(float(rng.uniform(0.85, 1.1)))
        front = Front.drawn(material, space.zone.kind == "street", rng)
        things += _house(wall, (start, end), height, front, look, rng)
        start, number = end, number + 1
    return things


def _house(
    wall: Wall, span: tuple[float, float], height: float, front: Front, look: Look, rng: np.random.Generator
) -> list[Structure]:
    own = [o for o in wall.openings if span[0] <= (o.left + o.right) / 2 < span[1]]
    own = [replace(o, left=max(o.left, span[0] + 0.1), right=min(o.right, span[1] - 0.1)) for o in own]
    holes = [o for o in own if o.kind != "door"]
    parts = _face(wall, span, height, front, holes) + _mouldings(wall, span, height, front)
    parts += gables(wall, span, height, front.wall)
    if front.shop:
        parts += _shop_front(wall, span, front, own, rng)
    things = [Structure(parts, shines=False)]
    leaf = paint(str(rng.choice(DOORS)), "wood", seed=look.seed)
    for o in own:
        if o.kind == "window":
            things.append(window(wall, o, glass(look, rng), front.frame, front.wall.shaded(0.9)))
            if not (front.shop and o.bottom < SHOP_HEIGHT):
                things.append(Structure(_dressing(wall, o, front, _room(o, own, span))))
        elif o.kind == "door":
            things.append(door(wall, o, leaf))
            things.append(Structure(_porch(wall, o, front)))
            if rng.uniform() < 0.5:
                things.append(_awning(wall, o, rng))
        else:
            things.append(doorway(wall, o, paint("grey", "concrete"), front.wall.shaded(0.9), front.trim))
    things += _balconies(wall, [o for o in own if o.kind == "window" and o.bottom > 3.0], rng)
    return things


def _face(wall: Wall, span: tuple[float, float], height: float, front: Front, holes: list[Opening]) -> list[Part]:
    """Plinth, ground floor and upper storeys, with the marks that rain leaves under cornice and sills."""
    plinth = replace(front.wall.shaded(0.55), stain=0.0, wear=0.5, seed=front.wall.seed + 1)
    below = replace(front.wall, stain=min(front.wall.stain + 0.35, 1.0))
    parts = pierced(wall, plinth, holes, span, 0.0, front.base)
    if front.shop:
        parts += pierced(wall, front.shop, holes, span, front.base, SHOP_HEIGHT)
        return parts + pierced(wall, front.wall, holes, span, SHOP_HEIGHT, height, below)
    return parts + pierced(wall, front.wall, holes, span, front.base, height, below)


def _mouldings(wall: Wall, span: tuple[float, float], height: float, front: Front) -> list[Part]:
    """What stands out of the face: plinth's edge, string courses, corner stones, cornice, gutter and downpipe."""
    width, middle = span[1] - span[0], (span[0] + span[1]) / 2
    trim = front.trim
    parts = [
        box(trim, (width, 0.34, 0.14), (0, 0.0, height)),
        box(trim.shaded(0.85), (width, 0.2, 0.1), (0, 0.0, height - 0.1)),
        box(trim, (width, 0.08, 0.16), (0, 0.02, height - 0.42)),
        box(trim.shaded(0.8), (width, 0.08, 0.07), (0, 0.02, front.base - 0.03)),
    ]
    for storey in np.arange(STOREY, height - 1.5, STOREY):
        parts += [
            box(trim, (width, 0.1, 0.1), (0, 0.02, storey)),
            box(trim.shaded(0.9), (width, 0.07, 0.07), (0, 0.02, storey - 0.07)),
        ]
    if front.dentils:
        count = int(width / 0.32)
        parts += [
            box(trim, (0.13, 0.16, 0.12), ((i + 0.5) * width / count - width / 2, 0.08, height - 0.22))
            for i in range(count)
        ]
    if front.corners:
        for i, z in enumerate(np.arange(front.base, height - 0.5, 0.36)):
            long = 0.46 if i % 2 else 0.3
            tone = trim.shaded(0.88 + 0.05 * (i * 7 % 5))
            parts += [box(tone, (long, 0.09, 0.33), (s * (width - long) / 2, 0.0, z), 0.015) for s in (-1, 1)]
    metal = paint("slate grey", "enamel")
    x, y = width / 2 - 0.14, 0.1
    parts += tube(metal, [(-width / 2, 0.22, height + 0.1), (width / 2, 0.22, height + 0.1)], 0.06)
    parts += tube(metal, [(x, 0.22, height + 0.08), (x, y, height - 0.55), (x, y, 0.18), (x, y + 0.1, 0.06)], 0.04)
    parts += [box(metal, (0.13, 0.1, 0.04), (x, 0.05, z)) for z in np.arange(1.2, height - 0.8, 1.9)]
    return against(wall, parts, middle)


def _room(o: Opening, own: list[Opening], span: tuple[float, float]) -> float:
    """Metres of face beside an opening before the next one, or twice what is left to the house's edge."""
    level = [p for p in own if p is not o and p.bottom < o.top + 0.3 and p.top > o.bottom - 0.3]
    gaps = [max(p.left - o.right, o.left - p.right) for p in level]
    return min([*gaps, 2 * (o.left - span[0]) - 0.5, 2 * (span[1] - o.right) - 0.5])


def _dressing(wall: Wall, o: Opening, front: Front, room: float) -> list[Part]:
    """What surrounds a window: shutters if there is room for them, a band, a lintel, or a hood on brackets."""
    width, height = o.right - o.left, o.top - o.bottom
    trim, parts = front.trim, []
    if front.shutters and room > width + 0.12:
        for s in (-1, 1):
            x = s * (width * 0.75 + 0.03)
            parts += [
                box(front.shutters, (width / 2 - 0.02, 0.04, height), (x, 0.02, 0.0)),
                *(
                    box(front.shutters.shaded(1.1), (width / 2 - 0.02, 0.055, 0.07), (x, 0.025, z))
                    for z in (0, height - 0.07)
                ),
                *(
                    box(front.shutters.shaded(1.1), (0.06, 0.055, height), (x + t * (width / 4 - 0.04), 0.025, 0))
                    for t in (-1, 1)
                ),
            ]
    elif front.surround in ("band", "hood") and room > 0.5:
        parts += [box(trim, (0.14, 0.07, height), (s * (width / 2 + 0.07), 0.02, 0.0)) for s in (-1, 1)]
        parts.append(box(trim, (width + 0.28, 0.07, 0.16), (0, 0.02, height)))
    if front.surround == "lintel":
        parts.append(box(trim, (width + 0.3, 0.08, 0.2), (0, 0.02, height)))
        parts.append(box(trim.shaded(1.05), (0.2, 0.12, 0.28), (0, 0.03, height - 0.02), 0.02))
    if front.surround == "hood":
        parts.append(box(trim, (width + 0.44, 0.26, 0.07), (0, 0.1, height + 0.2)))
        parts += [box(trim, (0.1, 0.14, 0.16), (s * (width / 2 + 0.1), 0.06, height + 0.05), 0.02) for s in (-1, 1)]
    if front.surround != "none":
        parts += [box(trim, (0.1, 0.1, 0.1), (s * (width / 2 - 0.05), 0.04, -0.13), 0.015) for s in (-1, 1)]
    return against(wall, parts, (o.left + o.right) / 2, o.bottom)


def _porch(wall: Wall, o: Opening, front: Front) -> list[Part]:
    """A step before a door, posts beside it and an entablature over it."""
    width, trim = o.right - o.left, front.trim
    parts = [box(paint("light grey", "concrete"), (width + 0.3, 0.34, 0.06), (0, 0.17, 0), 0.01)]
    parts += [box(trim, (0.15, 0.09, o.top + 0.02), (s * (width / 2 + 0.08), 0.03, 0)) for s in (-1, 1)]
    parts += [
        box(trim, (0.21, 0.12, h), (s * (width / 2 + 0.08), 0.03, z))
        for s in (-1, 1)
        for z, h in ((0, 0.25), (o.top - 0.06, 0.1))
    ]
    parts += [
        box(trim, (width + 0.36, 0.12, 0.2), (0, 0.03, o.top + 0.02)),
        box(trim.shaded(1.05), (width + 0.5, 0.28, 0.06), (0, 0.1, o.top + 0.22)),
    ]
    return against(wall, parts, (o.left + o.right) / 2)


def _shop_front(
    wall: Wall, span: tuple[float, float], front: Front, own: list[Opening], rng: np.random.Generator
) -> list[Part]:
    """A fascia with the shop's trade on it, pilasters, and panels under the windows."""
    assert front.shop is not None
    width, middle, shop = span[1] - span[0], (span[0] + span[1]) / 2, front.shop
    dark = sum(shop.colour) < 0.9
    ground, ink = ("charcoal", "cream") if dark else ("chalk", "black")
    parts = [
        box(shop, (width - 0.2, 0.1, 0.46), (0, 0.05, SHOP_HEIGHT - 0.1), 0.01),
        box(shop.shaded(1.15), (width - 0.1, 0.3, 0.07), (0, 0.12, SHOP_HEIGHT + 0.36), 0.01),
        box(shop.shaded(0.8), (width - 0.16, 0.16, 0.06), (0, 0.06, SHOP_HEIGHT - 0.15), 0.01),
        sign(str(rng.choice(TRADES)), min(width * 0.6, 4.2), 0.36, (0, 0.104, SHOP_HEIGHT - 0.05), ground, ink),
    ]
    for s in (-1, 1):
        parts += [
            box(shop.shaded(1.1), (0.28, 0.12, SHOP_HEIGHT - 0.2), (s * (width / 2 - 0.24), 0.05, 0)),
            box(shop.shaded(0.85), (0.34, 0.17, 0.3), (s * (width / 2 - 0.24), 0.05, 0)),
        ]
    for o in own:
        if o.kind == "window" and o.bottom < SHOP_HEIGHT:
            x, w = -((o.left + o.right) / 2 - middle), o.right - o.left
            parts += [
                box(shop.shaded(1.1), (w + 0.16, 0.08, 0.1), (x, 0.02, o.top)),
                box(shop.shaded(0.8), (w * 0.84, 0.05, o.bottom - 0.5), (x, 0.02, 0.36), 0.02),
                *(
                    box(shop.shaded(1.1), (0.08, 0.08, o.top - o.bottom), (x + t * (w / 2 + 0.04), 0.02, o.bottom))
                    for t in (-1, 1)
                ),
            ]
    return against(wall, parts, middle)


def gables(wall: Wall, span: tuple[float, float], height: float, material: Material) -> list[Part]:
    """A house's sides, roof and chimney behind its facade: seen where its neighbour is lower, and from above."""
    plain = replace(material.shaded(0.85), detail=3.0)
    (x0, y0), (x1, y1) = wall.at(span[0], 0.0), wall.at(span[1], 0.0)
    back = (*(-HOUSE_DEPTH * wall.inward), 0.0)
    forth = (*(HOUSE_DEPTH * wall.inward), 0.0)
    base = max(height - 4.0, 0.0)
    up = (0.0, 0.0, height - base)
    bx, by, _ = back
    roof = replace(dressed("terracotta", "shingle", material.seed), detail=3.0)
    ridge = (bx, by, 1.6)
    bricks = replace(dressed("brick red", "brick", material.seed), detail=2.5)
    chimney = [
        box(bricks, (0.9, 0.6, 2.0), (0, -2.4, 0)),
        box(paint("light grey", "concrete"), (1.05, 0.75, 0.12), (0, -2.4, 2.0)),
    ]
    chimney += [box(paint("terracotta"), (0.2, 0.2, 0.35), (s * 0.24, -2.4, 2.12), 0.05) for s in (-1, 1)]
    at = span[0] + (0.18 + 0.64 * (material.seed % 7) / 6) * (span[1] - span[0])
    return [
        Part(Sheet((x0 + bx, y0 + by, base), forth, up), plain),
        Part(Sheet((x1, y1, base), back, up), plain),
        Part(Sheet((x0, y0, height), (x1 - x0, y1 - y0, 0.0), ridge), roof),
        *against(wall, chimney, at, height),
    ]


def glass(look: Look, rng: np.random.Generator) -> Material:
    """A pane seen from outside: it mirrors the sky by day, before a dark room; at night some are lit from within."""
    seed = int(rng.integers(1 << 20))
    if look.daylight < 0.1 and rng.uniform() < LIT_SHARE:
        return Material((2.2, 1.6, 0.9), "interior", emission=float(rng.uniform(0.5, 1.0)), detail=0.8, seed=seed)
    return Material(
        GLASS, "interior", emission=MIRRORED * look.daylight * float(rng.uniform(0.7, 1.2)), detail=0.8, seed=seed
    )


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
