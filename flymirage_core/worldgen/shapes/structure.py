"""Stairs, decks, frames, and the gear of works and sites.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    cloth,
    frame_of,
    mirrored,
    patterned,
    pipe,
    placed,
    sign,
    skin,
    two_sided,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, paint, turned
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK = paint("silver", "brushed"), paint("black")


def ladder(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rails = [
        pipe(f.main, [(s * (x / 2 - 0.03), y / 2 - 0.03, 0), (s * (x / 2 - 0.03), -y / 2 + 0.03, z)], 0.026)
        for s in (-1, 1)
    ]
    rungs = [
        pipe(
            f.main,
            [(-x / 2 + 0.03, (y / 2 - 0.03) * (1 - 2 * h / z), h), (x / 2 - 0.03, (y / 2 - 0.03) * (1 - 2 * h / z), h)],
            0.015,
        )
        for h in np.arange(0.28, z - 0.1, 0.28)
    ]
    return [*rails, *rungs, *(box(DARK, (0.06, 0.08, 0.05), (s * (x / 2 - 0.03), y / 2 - 0.04, 0)) for s in (-1, 1))]


def pallet(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = [
        box(f.main.shaded(0.92 + 0.05 * (i % 3)), (x, y / 7 - 0.02, 0.02), (0, (i - 3) * y / 7, z - 0.02), 0.003)
        for i in range(7)
    ]
    blocks = [
        box(f.main.shaded(0.85), (0.13, 0.1, z - 0.06), (u * (x / 2 - 0.07), v * (y / 2 - 0.06), 0.02))
        for u in (-1, 0, 1)
        for v in (-1, 0, 1)
    ]
    return [
        *top,
        *blocks,
        *(box(f.main, (x, 0.1, 0.02), (0, v * (y / 2 - 0.06), 0)) for v in (-1, 0, 1)),
        *(box(f.main, (0.12, y, 0.02), (u * (x / 2 - 0.07), 0, z - 0.04)) for u in (-1, 0, 1)),
    ]


def _flight(f: Finish, x: float, y: float, z: float) -> list[Part]:
    """Open steps that rise from the front (+y) to the back, with strings and handrails."""
    count = max(4, round(z / 0.18))
    tread = patterned("light grey", "grille", "charcoal", 0.4) if f.main.texture != "wood" else f.main
    steps = [
        box(tread, (x - 0.1, y / count + 0.03, 0.035), (0, y / 2 - (i + 0.5) * y / count, (i + 1) * z / count - 0.035))
        for i in range(count)
    ]
    ends = [(y / 2, 0.0), (-y / 2, z)]
    strings = []
    for s in (-1, 1):
        u = s * (x / 2 - 0.02)
        outline = [(u, ends[0][0], 0.0), (u, ends[0][0] - 0.25, 0.0), (u, ends[1][0], z - 0.3), (u, ends[1][0], z)]
        strings += [
            p
            for shift in (-0.015, 0.015)
            for p in skin(
                f.main,
                [[(a + shift, b, c) for a, b, c in outline[:2]], [(a + shift, b, c) for a, b, c in outline[3:1:-1]]],
            )
        ]
        rail = [
            (u, y / 2 - 0.05, 0.05),
            (u, y / 2 - 0.05, 0.95),
            (u, -y / 2 + 0.03, z + 0.92),
            (u, -y / 2 + 0.03, z - 0.02),
        ]
        strings.append(pipe(f.main, rail, 0.02, 0.08))
        strings += [
            pipe(f.main, [(u, y / 2 - t * y, t * z), (u, y / 2 - t * y, t * z + 0.92)], 0.012)
            for t in np.linspace(0.1, 0.95, max(4, count // 2))
        ]
        strings.append(pipe(f.main, [(u, y / 2 - 0.05, 0.5), (u, -y / 2 + 0.03, z + 0.47)], 0.01))
    return [*steps, *strings]


def staircase(size: Vector, f: Finish) -> list[Part]:
    return _flight(f, size[0], size[1], size[2] - 0.92)


def mezzanine(size: Vector, f: Finish) -> list[Part]:
    """A platform on posts with a rail, and a ladder up to it."""
    x, y, z = size
    deck = z - 1.05
    floor = [
        box(paint("oak brown", "planks"), (x, y, 0.06), (0, 0, deck - 0.06)),
        *(box(f.main, (x, 0.1, 0.2), (0, s * (y / 2 - 0.05), deck - 0.26)) for s in (-1, 1)),
        *(
            box(f.main, (0.08, y - 0.2, 0.14), (u, 0, deck - 0.2))
            for u in np.linspace(-x / 2 + 0.05, x / 2 - 0.05, max(3, round(x)))
        ),
    ]
    posts = [
        box(f.main, (0.12, 0.12, deck - 0.2), (s * (x / 2 - 0.1), t * (y / 2 - 0.1), 0))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    runs = [
        [
            (-x / 2 + 0.03, -y / 2, deck),
            (-x / 2 + 0.03, y / 2 - 0.03, deck),
            (x / 2 - 0.03, y / 2 - 0.03, deck),
            (x / 2 - 0.03, -y / 2, deck),
        ]
    ]
    rails = [
        pipe(f.main, [(a, b, c + h) for a, b, c in runs[0]], w) for h, w in ((1.03, 0.022), (0.7, 0.012), (0.38, 0.012))
    ]
    uprights = [
        pipe(f.main, [(u, y / 2 - 0.03, deck), (u, y / 2 - 0.03, z - 0.02)], 0.016)
        for u in np.linspace(-x / 2 + 0.03, x / 2 - 0.03, max(4, round(x)))
    ]
    steps = [placed(p, (x * 0.28, y / 2 - 0.3, 0)) for p in ladder((0.55, 0.5, deck + 0.3), f)]
    return [*floor, *posts, *rails, *uprights, *steps]


def stage(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(replace(f.main, texture="planks"), (x, y, 0.05), (0, 0, z - 0.05), 0.008)
    skirt = [
        *two_sided(cloth(paint("charcoal", "velvet"), x, z - 0.05, (0, y / 2 - 0.03, 0), 0.14, 0.04)),
        *mirrored(box(paint("charcoal", "velvet"), (0.02, y - 0.06, z - 0.05), (x / 2 - 0.02, 0, 0))),
    ]
    steps = [
        box(f.main.shaded(0.85), (0.9, 0.25, z * h), (-x * 0.35, y / 2 + 0.12 + 0.25 * i, 0), 0.006)
        for i, h in enumerate((0.66, 0.33))
    ]
    lights = [
        p
        for u in np.linspace(-x * 0.2, x * 0.45, 4)
        for p in (
            box(DARK, (0.16, 0.14, 0.1), (u, y / 2 - 0.1, z), 0.02),
            box(paint("cream", emission=1.2), (0.12, 0.012, 0.06), (u, y / 2 - 0.175, z + 0.02)),
        )
    ]
    return [top, *skirt, *steps, *lights, box(STEEL, (x, 0.02, 0.04), (0, y / 2, z - 0.05))]


def steel_drum(size: Vector, f: Finish) -> list[Part]:
    ribs = [(0.0, 0.0), (0.285, 0.0), (0.295, 0.015), (0.285, 0.03)]
    for h in (0.3, 0.6):
        ribs += [(0.285, h - 0.02), (0.3, h), (0.285, h + 0.02)]
    body = turned(f.main, [*ribs, (0.285, 0.87), (0.298, 0.885), (0.285, 0.9), (0.275, 0.88), (0, 0.88)])
    bungs = [cylinder(STEEL, r, 0.02, (u, 0.06, 0.875)) for u, r in ((0.17, 0.035), (-0.17, 0.022))]
    label = (
        ("TOXIC", "yellow", "black"),
        ("FLAMMABLE", "red", "white"),
        ("OIL", "chalk", "black"),
        ("CORROSIVE", "chalk", "black"),
    )[f.chosen(4)]
    return [body, *bungs, sign(label[0], 0.26, 0.16, (0, 0.291, 0.37), label[1], label[2])]


def welding_curtain(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    frame = [
        *mirrored(pipe(DARK, [(x / 2 - 0.03, 0, 0.06), (x / 2 - 0.03, 0, z)], 0.018)),
        pipe(DARK, [(-x / 2 + 0.03, 0, z - 0.02), (x / 2 - 0.03, 0, z - 0.02)], 0.018),
        *mirrored(pipe(DARK, [(x / 2 - 0.03, -y / 2, 0.04), (x / 2 - 0.03, y / 2, 0.04)], 0.02)),
    ]
    sheet = replace(paint(("orange", "olive")[f.chosen(2)], "velvet"), opacity=0.85)
    strips = [
        p
        for u in np.linspace(-x / 2 + 0.2, x / 2 - 0.2, 5)
        for p in two_sided(cloth(sheet, x / 5 + 0.04, z - 0.2, (u, 0.02 * (round(u * 5) % 2), 0.12), 0.3, 0.02), 0.9)
    ]
    return [*frame, *strips, sign("WELDING", 0.5, 0.16, (0, 0.05, z * 0.6), "yellow")]


def loom(size: Vector, f: Finish) -> list[Part]:
    frame = frame_of(f.main, (1.7, 1.3, 1.2), 0.09)
    top = [box(f.main, (0.09, 0.09, 0.4), (s * 0.8, -0.1, 1.2)) for s in (-1, 1)] + [
        box(f.main, (1.7, 0.1, 0.1), (0, -0.1, 1.5), 0.01)
    ]
    beams = [pipe(f.main.shaded(0.85), [(-0.8, y, z), (0.8, y, z)], 0.07) for y, z in ((0.6, 0.8), (-0.6, 0.9))]
    warp = [
        pipe(paint("ivory"), [(u, 0.62, 0.87), (u, 0.0, 0.92), (u, -0.6, 0.97)], 0.004)
        for u in np.linspace(-0.6, 0.6, 34)
    ]
    cloth_ = [
        box(
            replace(
                paint(("burgundy", "teal", "mustard")[f.chosen(3)], "stripes"), ink=paint("cream").colour, detail=0.5
            ),
            (1.24, 0.42, 0.012),
            (0, 0.38, 0.88),
        ),
        pipe(paint("burgundy", "fabric"), [(-0.62, 0.6, 0.8), (0.62, 0.6, 0.8)], 0.085),
    ]
    heddles = [box(f.main, (1.4, 0.03, 0.04), (0, y, z)) for y in (-0.05, -0.14) for z in (0.72, 1.12)] + [
        pipe(STEEL, [(u, y, 0.74), (u, y, 1.14)], 0.003) for y in (-0.05, -0.14) for u in np.linspace(-0.6, 0.6, 24)
    ]
    bench = [
        box(f.main, (1.2, 0.28, 0.05), (0, 0.9, 0.48), 0.01),
        *mirrored(box(f.main, (0.06, 0.26, 0.48), (0.5, 0.9, 0))),
    ]
    return [*frame, *top, *beams, *warp, *cloth_, *heddles, *bench]


def street_sign(size: Vector, f: Finish) -> list[Part]:
    pole = turned(f.main, [(0, 0), (0.05, 0), (0.05, 0.04), (0.028, 0.06), (0.028, 2.55), (0.04, 2.57), (0, 2.62)])
    names = ("ELM STREET", "MILL LANE", "HARBOUR RD", "STATION RD", "QUEEN ST", "ORCHARD AVE")
    one = [
        box(paint("forest green"), (0.6, 0.02, 0.15), (0, 0.035, 2.3), 0.005),
        sign(names[f.seed % 6], 0.58, 0.14, (0, 0.048, 2.305), "forest green", "white"),
        placed(
            sign(names[f.seed % 6], 0.58, 0.14, (0, -0.02, 2.305), "forest green", "white"),
            rotation=np.diag([-1.0, -1.0, 1.0]),
        ),
    ]
    return [pole, *one]


def scaffolding(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    at = np.linspace(-x / 2 + 0.04, x / 2 - 0.04, max(2, round(x / 1.6) + 1))
    posts = [pipe(f.main, [(u, s * (y / 2 - 0.05), 0), (u, s * (y / 2 - 0.05), z)], 0.024) for u in at for s in (-1, 1)]
    levels = np.arange(1.9, z - 0.3, 1.9) if z > 2.4 else np.array([z - 1.0])
    decks, rails = [], []
    for h in levels:
        decks += [
            box(
                paint("honey brown", "wood").shaded(0.85 + 0.06 * i),
                (x - 0.02, y / 4 - 0.02, 0.04),
                (0, (i - 1.5) * (y - 0.1) / 4, h),
                0.004,
            )
            for i in range(4)
        ]
        rails += [
            pipe(f.main, [(-x / 2, s * (y / 2 - 0.05), h + up), (x / 2, s * (y / 2 - 0.05), h + up)], 0.022)
            for s in (-1, 1)
            for up in (-0.03, 0.5, 1.0)
            if h + up < z
        ]
        rails += [pipe(f.main, [(u, -y / 2, h - 0.03), (u, y / 2, h - 0.03)], 0.022) for u in at]
    braces = [
        pipe(f.main, [(a, y / 2 - 0.05, 0.1), (b, y / 2 - 0.05, float(levels[0]))], 0.02)
        for a, b in ((at[0], at[1]), (at[-1], at[-2]))
    ]
    feet = [box(DARK, (0.14, 0.14, 0.02), (u, s * (y / 2 - 0.07), 0)) for u in at for s in (-1, 1)]
    net = (
        [
            placed(replace(p, material=replace(p.material, opacity=0.35)), (0, -y / 2 + 0.02, 0.3))
            for p in two_sided(cloth(paint("forest green", "fabric"), x, z - 0.4, (0, 0, 0), 0.5, 0.03))
        ]
        if f.chosen(2)
        else []
    )
    return [*posts, *decks, *rails, *braces, *feet, *net]
