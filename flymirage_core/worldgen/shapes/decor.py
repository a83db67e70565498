"""Lamps, plants, vessels, electronics, what hangs on walls and ceilings. Builders fill their size; +y is the front."""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import (
    Finish,
    box,
    cylinder,
    ellipsoid,
    foliage,
    paint,
    picture,
    smooth,
    tube,
    turned,
)
from flymirage_core.worldgen.surfaces import Part, Sheet, Vector

GLOW = 0.9
"""Emission of a lampshade."""
LEAF_GREENS = ("forest green", "green", "moss green", "olive")


def _shade(f: Finish) -> Material:
    r, g, b = f.main.colour
    warm = (0.5 + 0.5 * r, 0.44 + 0.5 * g, 0.34 + 0.5 * b)
    return Material(tuple(min(c, 0.95) for c in warm), "fabric", emission=GLOW, seed=f.seed)  # type: ignore[arg-type]


def floor_lamp(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    base = turned(f.second, [(0, 0), (r * 0.75, 0), (r * 0.72, 0.025), (0.02, 0.035), (0.016, z - 0.32), (0, z - 0.32)])
    return [base, turned(_shade(f), [(0, z - 0.3), (r, z - 0.3), (r * 0.72, z), (0, z)])]


def table_lamp(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    foot = turned(
        f.main, smooth([(0, 0), (r * 0.55, 0), (r * 0.6, z * 0.15), (r * 0.2, z * 0.4), (r * 0.12, z * 0.55)])
    )
    return [foot, turned(_shade(f), [(0, z * 0.52), (r, z * 0.52), (r * 0.65, z), (0, z)])]


def pendant_lamp(size: Vector, f: Finish) -> list[Part]:
    """Fills its whole height with cord and shade: it hangs from the ceiling."""
    x, _, z = size
    r, shade = x / 2, min(0.3, z * 0.5)
    dome = turned(f.main, smooth([(r, 0.0), (r * 0.9, shade * 0.45), (r * 0.35, shade * 0.85), (0.0, shade)], 10))
    bulb = turned(paint("cream", emission=2.0), [(0, 0.01), (r * 0.95, 0.012)])
    return [
        dome,
        bulb,
        cylinder(f.second, 0.008, z - shade, (0, 0, shade)),
        cylinder(f.second, 0.05, 0.03, (0, 0, z - 0.03)),
    ]


def ceiling_panel(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    glow = turned(paint("white", emission=1.6), [(0, 0), (0.5, 0)], (0, 0, 0), (x * 0.9, y * 0.9))
    return [box(f.second, (x, y, z - 0.005), (0, 0, 0.005)), glow]


def vase(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    rng = f.generator()
    forms = (
        [(0, 0), (r * 0.6, 0), (r, z * 0.35), (r * 0.55, z * 0.75), (r * 0.4, z * 0.9), (r * 0.55, z)],
        [(0, 0), (r * 0.5, 0), (r * 0.75, z * 0.3), (r, z * 0.68), (r * 0.6, z * 0.93), (r * 0.65, z)],
        [(0, 0), (r * 0.9, 0), (r, z * 0.25), (r * 0.45, z * 0.5), (r * 0.35, z * 0.85), (r * 0.5, z)],
    )
    form = smooth(forms[int(rng.integers(len(forms)))])
    return [turned(f.main, form), turned(f.main.shaded(0.3), [(form[-1][0], z - 0.005), (0, z - 0.02)])]


def _facing(part: Part, offset: Vector) -> Part:
    """A lathed part laid so that its axis points to the front, +y."""
    return Part(part.surface, part.material, offset, np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))


def monitor(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    screen = Material((0.5, 0.5, 0.5), "screen", emission=0.6, detail=0.75, seed=f.seed)
    panel = box(f.second, (x, 0.04, z * 0.78), (0, 0, z * 0.22), 0.008)
    stand = [box(f.second, (x * 0.4, y, 0.02)), box(f.second, (0.06, 0.04, z * 0.3), (0, -0.03, 0.02))]
    return [panel, picture(screen, x - 0.03, z * 0.78 - 0.03, (0, 0.024, z * 0.22 + 0.015)), *stand]


def laptop(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    screen = Material((0.5, 0.5, 0.5), "screen", emission=0.6, detail=0.5, seed=f.seed)
    return [
        box(f.main, (x, y, 0.02)),
        box(paint("charcoal"), (x - 0.05, y * 0.5, 0.004), (0, 0.0, 0.02)),
        box(f.main, (x, 0.012, z - 0.02), (0, -y / 2 + 0.008, 0.02)),
        picture(screen, x - 0.03, z - 0.05, (0, -y / 2 + 0.018, 0.035)),
    ]


def kettle(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x * 0.4
    body = turned(f.main, smooth([(0, 0), (r, 0), (r, z * 0.3), (r * 0.7, z * 0.7), (r * 0.3, z * 0.8), (0, z * 0.82)]))
    handle = tube(
        f.second,
        [(-r * 0.6, 0, z * 0.7), (-r * 0.5, 0, z * 0.98), (r * 0.5, 0, z * 0.98), (r * 0.6, 0, z * 0.7)],
        0.012,
    )
    return [body, *handle, *tube(f.main, [(r * 0.7, 0, z * 0.45), (x / 2 - 0.015, 0, z * 0.7)], 0.02)]


def candle_holder(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    foot = turned(
        f.main, smooth([(0, 0), (r, 0), (r * 0.3, z * 0.12), (r * 0.3, z * 0.5), (r * 0.7, z * 0.55), (0, z * 0.56)])
    )
    return [
        foot,
        cylinder(paint("ivory"), r * 0.42, z * 0.42, (0, 0, z * 0.55)),
        ellipsoid(paint("yellow", emission=4.0), (0.012, 0.012, 0.02), (0, 0, z - 0.02)),
    ]


def painting(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    canvas = Material((0.5, 0.5, 0.5), "painting", detail=0.75, seed=f.seed)
    return [
        *_frame(f.main, x, y, z),
        box(paint("chalk"), (x - 0.05, 0.01, z - 0.05), (0, 0, 0.025)),
        picture(canvas, x - 0.14, z - 0.14, (0, 0.008, 0.07)),
    ]


def poster(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    sheet = Material((0.5, 0.5, 0.5), "painting", detail=0.75, seed=f.seed)
    return [
        box(paint("white"), (x, y, z)),
        picture(sheet, x - 0.04, z - 0.2, (0, y / 2 + 0.003, 0.17)),
        box(f.main, (x - 0.1, 0.004, 0.09), (0, y / 2 + 0.002, 0.05)),
    ]


def notice_board(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    cork = Material((0.5, 0.5, 0.5), "notes", detail=0.75, seed=f.seed)
    return [*_frame(f.main, x, y, z), picture(cork, x - 0.06, z - 0.06, (0, 0.0, 0.03))]


def mirror(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    glass = Material((0.42, 0.47, 0.5), "metal", seed=f.seed)
    return [*_frame(f.main, x, y, z), picture(glass, x - 0.06, z - 0.06, (0, 0.0, 0.03))]


def television(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    screen = Material((0.5, 0.5, 0.5), "painting", emission=0.5, detail=0.7, seed=f.seed)
    return [
        box(paint("black"), (x, y - 0.005, z), (0, -0.0025, 0), 0.006),
        picture(screen, x - 0.04, z - 0.05, (0, y / 2 - 0.002, 0.03)),
    ]


def _frame(material: Material, x: float, y: float, z: float) -> list[Part]:
    bar = 0.04
    sides = [box(material, (bar, y, z), (s * (x / 2 - bar / 2), 0, 0), 0.006) for s in (-1, 1)]
    return [*sides, *(box(material, (x - 2 * bar, y, bar), (0, 0, b), 0.006) for b in (0.0, z - bar))]


def wall_shelf(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    parts = [box(f.main, (x, y, 0.035), (0, 0, 0.1), 0.004)]
    parts += [box(f.second, (0.03, y * 0.7, 0.1), (s * x * 0.35, -y * 0.14, 0)) for s in (-1, 1)]
    for i, u in enumerate(np.linspace(-x / 2 + 0.12, x / 2 - 0.12, 3)):
        item = paint(str(rng.choice(["rust", "teal", "cream", "mustard", "navy", "sage", "plum"])), seed=i)
        h = (z - 0.135) * rng.uniform(0.6, 0.95)
        parts.append(turned(item, [(0, 0), (0.05, 0), (0.07, h * 0.4), (0.035, h), (0, h)], (float(u), 0.0, 0.135)))
    parts.append(box(paint("burgundy"), (0.05, y * 0.6, z - 0.14), (0.0 + x * 0.2, 0, 0.135)))
    return parts


def sconce(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    r = min(x, y) / 2
    return [
        box(f.second, (x * 0.5, 0.03, z * 0.5), (0, -y / 2 + 0.015, z * 0.1)),
        turned(_shade(f), [(0, z * 0.3), (r * 0.7, z * 0.3), (r, z), (0, z)]),
        *tube(f.second, [(0, -y / 2 + 0.02, z * 0.35), (0, 0, z * 0.32)], 0.015),
    ]


def hanging_plant(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    bottom = 0.06
    pot = turned(
        f.main, smooth([(0, bottom), (x * 0.2, bottom), (x * 0.3, bottom + 0.2), (x * 0.26, bottom + 0.24)], 8)
    )
    green = paint(str(rng.choice(LEAF_GREENS)), "leaf", seed=f.seed)
    leaves = foliage(green, (x / 2, y / 2, 0.3), (0, 0, 0.3), (0.16, 0.06), 90, rng)
    cords = [
        p
        for a in (0.0, 2.1, 4.2)
        for p in tube(f.second, [(x * 0.28 * np.cos(a), x * 0.28 * np.sin(a), bottom + 0.24), (0, 0, z)], 0.006)
    ]
    return [pot, leaves, *cords]


def rug(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    weave = replace(f.main, texture="rug", stretch=1.0, detail=0.7)
    pile = Part(Sheet((-x / 2 + 0.05, -y / 2, z), (x - 0.1, 0.0, 0.0), (0.0, y, 0.0)), weave)
    fringe = [
        box(f.main.shaded(1.4), (0.05, 0.012, z * 0.5), (s * (x / 2 - 0.025), v, 0))
        for s in (-1, 1)
        for v in np.linspace(-y / 2 + 0.01, y / 2 - 0.01, int(y / 0.05))
    ]
    return [pile, *fringe]


def coat_rack(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    pole = turned(f.main, [(0, 0), (r, 0), (r * 0.9, 0.03), (0.025, 0.05), (0.022, z), (0, z)])
    hooks = [
        p
        for k in range(4)
        for p in tube(
            f.main, [(0, 0, z - 0.22), (r * 0.8 * np.cos(k * 1.57), r * 0.8 * np.sin(k * 1.57), z - 0.1)], 0.014
        )
    ]
    coat = turned(
        f.second,
        smooth([(r * 0.6, 0), (r * 0.66, 0.3), (r * 0.5, 0.75), (0.03, 0.85)]),
        (r * 0.34, 0, z - 1.02),
        (1.0, 0.6),
    )
    return [pole, *hooks, coat]
