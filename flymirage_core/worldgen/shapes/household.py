"""Tables, seats and beds beyond the plain ones.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

import numpy as np

from flymirage_core.worldgen.forms import (
    cushion,
    hoop,
    loft,
    mirrored,
    pipe,
    placed,
    rounded_path,
    rounded_ring,
    spun,
    sweep,
    tapered,
    wheel,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, four_legs, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK, WHITE = paint("silver", "brushed"), paint("black"), paint("white")
LINEN = paint("ivory", "fabric")


def kitchen_island(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(paint("light grey", "marble", seed=f.seed % 97), (x, y, 0.05), (0, 0, z - 0.05), 0.01)
    body = [
        box(f.main, (x - 0.1, y * 0.66, z - 0.15), (0, y * 0.12, 0.1)),
        box(DARK, (x - 0.2, y * 0.6, 0.1), (0, y * 0.1, 0)),
    ]
    doors = [
        p
        for i in range(4)
        for p in (
            box(
                f.main.shaded(1.1), (x / 4 - 0.05, 0.02, z - 0.24), ((i - 1.5) * (x / 4 - 0.02), y * 0.45, 0.14), 0.005
            ),
            box(STEEL, (0.14, 0.025, 0.02), ((i - 1.5) * (x / 4 - 0.02), y * 0.46 + 0.01, z - 0.17)),
        )
    ]
    tap = [
        pipe(
            STEEL,
            [(x * 0.2, -0.05, z), (x * 0.2, -0.05, z + 0.28), (x * 0.2, 0.12, z + 0.28), (x * 0.2, 0.12, z + 0.2)],
            0.014,
            0.08,
        )
    ]
    sink = [
        box(paint("slate grey"), (0.5, 0.36, 0.006), (x * 0.2, 0.16, z), 0.002),
        *mirrored(box(f.main, (0.07, 0.07, z - 0.05), (x / 2 - 0.08, -y / 2 + 0.1, 0))),
    ]
    return [top, *body, *doors, *tap, *sink]


def garden_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    slats = [
        box(f.main.shaded(0.94 + 0.04 * (i % 3)), (x, y / 7 - 0.012, 0.03), (0, (i - 3) * y / 7, z - 0.03), 0.005)
        for i in range(7)
    ]
    legs = [
        pipe(f.second, [(s * (x / 2 - 0.1), -y / 2 + 0.05, 0), (s * (x / 2 - 0.1), y / 2 - 0.1, z - 0.03)], 0.02)
        for s in (-1, 1)
    ]
    legs += [
        pipe(f.second, [(s * (x / 2 - 0.13), y / 2 - 0.05, 0), (s * (x / 2 - 0.13), -y / 2 + 0.1, z - 0.03)], 0.02)
        for s in (-1, 1)
    ]
    return [*slats, *legs, box(f.second, (x - 0.2, 0.03, 0.03), (0, 0, z * 0.5))]


def school_desk(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = [
        box(f.main, (x, y, 0.025), (0, 0, z - 0.025), 0.01),
        box(f.second, (x - 0.1, y - 0.08, 0.02), (0, 0, z - 0.15)),
    ]
    back = box(f.second, (x - 0.1, 0.015, 0.13), (0, -y / 2 + 0.05, z - 0.15))
    frames = [
        p
        for s in (-1, 1)
        for p in (
            pipe(
                STEEL,
                [
                    (s * (x / 2 - 0.06), -y / 2 + 0.06, 0.02),
                    (s * (x / 2 - 0.06), -y / 2 + 0.06, z - 0.03),
                    (s * (x / 2 - 0.06), y / 2 - 0.06, z - 0.03),
                    (s * (x / 2 - 0.06), y / 2 - 0.06, 0.02),
                ],
                0.015,
                0.06,
            ),
        )
    ]
    items = [
        box(paint("navy"), (0.18, 0.24, 0.02), (-0.15, 0.02, z)),
        box(paint("chalk"), (0.2, 0.28, 0.006), (0.14, 0.03, z)),
        pipe(paint("yellow"), [(0.2, -0.1, z + 0.012), (0.2, 0.1, z + 0.012)], 0.005),
    ]
    return [
        *top,
        back,
        *frames,
        *items,
        pipe(STEEL, [(-x / 2 + 0.06, -y / 2 + 0.06, 0.15), (x / 2 - 0.06, -y / 2 + 0.06, 0.15)], 0.012),
    ]


def pool_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    felt = box(paint("emerald", "fabric"), (x - 0.2, y - 0.2, 0.02), (0, 0, z - 0.06))
    rails = [box(f.main, (x, 0.13, 0.12), (0, s * (y / 2 - 0.065), z - 0.12), 0.03) for s in (-1, 1)] + [
        box(f.main, (0.13, y - 0.2, 0.12), (s * (x / 2 - 0.065), 0, z - 0.12), 0.03) for s in (-1, 1)
    ]
    rails += [
        box(paint("emerald", "fabric").shaded(0.8), (x - 0.3, 0.05, 0.05), (0, s * (y / 2 - 0.15), z - 0.05), 0.015)
        for s in (-1, 1)
    ]
    pockets = [
        cylinder(DARK, 0.065, 0.012, (u * (x / 2 - 0.12), s * (y / 2 - 0.12), z - 0.01))
        for u in (-1, 0, 1)
        for s in (-1, 1)
    ]
    legs = [
        turned(
            f.main,
            smooth([(0.09, 0), (0.06, 0.1), (0.1, 0.35), (0.07, 0.5), (0.1, z - 0.2)], 10),
            (s * (x / 2 - 0.25), t * (y / 2 - 0.2), 0),
        )
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    skirt = box(f.main.shaded(0.8), (x - 0.12, y - 0.12, 0.18), (0, 0, z - 0.3), 0.02)
    colours = ("red", "yellow", "blue", "orange", "plum", "green", "burgundy", "black", "mustard", "coral")
    balls = [
        ellipsoid(paint(c), (0.032,) * 3, (0.3 + 0.058 * row, 0.067 * (k - row / 2), z - 0.01))
        for (row, k), c in zip(((r, k) for r in range(4) for k in range(r + 1)), colours, strict=True)
    ]
    cue = pipe(paint("honey brown", "wood"), [(-0.9, -0.2, z + 0.012), (0.1, 0.05, z + 0.012)], 0.012)
    return [felt, *rails, *pockets, *legs, skirt, *balls, ellipsoid(WHITE, (0.032,) * 3, (-0.45, 0.02, z - 0.01)), cue]


def operating_table(size: Vector, f: Finish) -> list[Part]:
    pads = [
        cushion(paint("slate grey", "leather"), (0.56, w, 0.12), (0, y, 0.84))
        for w, y in ((0.75, 0.48), (0.72, -0.24), (0.38, -0.8))
    ]
    base = [
        tapered(f.main, [(0.5, 0.9, 0), (0.5, 0.9, 0.08), (0.3, 0.34, 0.12), (0.26, 0.28, 0.5)], radius=0.05),
        box(STEEL, (0.2, 0.2, 0.3), (0, 0, 0.5)),
        box(f.main, (0.5, 1.7, 0.05), (0, 0, 0.79), 0.01),
    ]
    rails = [pipe(STEEL, [(s * 0.29, -0.85, 0.82), (s * 0.29, 0.85, 0.82)], 0.014) for s in (-1, 1)]
    arms = [cushion(paint("slate grey", "leather"), (0.5, 0.14, 0.07), (s * 0.52, -0.35, 0.88)) for s in (-1, 1)]
    return [*pads, *base, *rails, *arms]


def packing_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(paint("tan", "wood"), (x, y, 0.04), (0, 0, z - 0.04), 0.004)
    legs = four_legs(f.main, (x, y), z - 0.04, 0.05, 0.01)
    shelf = box(f.main, (x - 0.1, y - 0.1, 0.03), (0, 0, 0.2))
    roll = [
        placed(
            turned(paint("caramel", "paper"), [(0, -0.35), (0.1, -0.35), (0.1, 0.35), (0, 0.35)]),
            (-x / 4, -0.1, 0.36),
            np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        )
    ]
    boxes = [
        box(paint("caramel", "paper", seed=3), (0.4, 0.4, 0.3), (x / 4, 0, 0.23), 0.006),
        box(paint("tan", "paper"), (0.3, 0.25, 0.006), (0.1, 0.1, z)),
    ]
    return [top, *legs, shelf, *roll, *boxes, box(f.main, (x - 0.1, 0.03, 0.1), (0, -y / 2 + 0.05, z - 0.16))]


def bar_stool(size: Vector, f: Finish) -> list[Part]:
    seat = [turned(f.main, smooth([(0.0, 0.72), (0.16, 0.72), (0.19, 0.75), (0.17, 0.78), (0, 0.775)], 8))]
    if f.chosen(2):
        foot = [
            turned(STEEL, [(0, 0), (0.2, 0), (0.19, 0.02), (0.03, 0.04), (0.025, 0.72), (0, 0.72)]),
            hoop(STEEL, 0.15, 0.01, (0, 0, 0.26)),
            *spun(pipe(STEEL, [(0, 0, 0.26), (0.15, 0, 0.26)], 0.008), 2),
        ]
    else:
        foot = [
            *spun(pipe(f.second, [(0.19, 0, 0), (0.11, 0, 0.73)], 0.016), 4, 0.78),
            hoop(f.second, 0.16, 0.01, (0, 0, 0.28)),
        ]
    back = [
        sweep(
            f.main,
            rounded_ring(0.02, 0.12, 0.008),
            [(0.17 * np.cos(a), 0.17 * np.sin(a), 0.93) for a in np.linspace(np.pi + 0.3, 2 * np.pi - 0.3, 9)],
        )
    ]
    return [
        *seat,
        *foot,
        *back,
        *(pipe(f.second, [(s * 0.1, -0.12, 0.75), (s * 0.11, -0.145, 0.95)], 0.01) for s in (-1, 1)),
    ]


def garden_chair(size: Vector, f: Finish) -> list[Part]:
    seat = [box(f.main, (0.5, 0.07, 0.02), (0, v, 0.42), 0.005) for v in np.linspace(-0.18, 0.2, 5)]
    back = [box(f.main, (0.46, 0.02, 0.07), (0, -0.235 - 0.07 * i * 0.3, 0.5 + 0.09 * i), 0.005, 0.2) for i in range(4)]
    sides = [
        pipe(f.second, line, 0.016, 0.05)
        for s in (-1, 1)
        for line in (
            [(s * 0.24, 0.24, 0), (s * 0.24, -0.16, 0.44), (s * 0.24, -0.32, 0.88)],
            [(s * 0.24, -0.26, 0), (s * 0.24, 0.2, 0.42), (s * 0.26, 0.24, 0.62), (s * 0.26, -0.24, 0.64)],
        )
    ]
    return [*seat, *back, *sides]


def pew(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    outline = [
        (0.28, 0),
        (0.28, 0.1),
        (0.2, 0.5),
        (0.26, 0.62),
        (0.18, 0.68),
        (-0.1, 0.6),
        (-0.22, 0.95),
        (-0.3, 0.95),
        (-0.28, 0),
    ]
    ends = [
        placed(
            loft(
                f.main,
                [
                    np.column_stack([np.full(9, u), [a for a, _ in outline], [b for _, b in outline]])
                    for u in (-0.03, 0.03)
                ],
            ),
            (s * (x / 2 - 0.03), 0, 0),
        )
        for s in (-1, 1)
    ]
    back = [
        box(f.main, (x - 0.06, 0.025, 0.48), (0, -0.2, 0.44), 0, 0.12),
        box(f.main, (x - 0.06, 0.06, 0.05), (0, -0.265, 0.9), 0.012),
    ]
    books = [box(paint("burgundy"), (0.12, 0.04, 0.17), (u, -0.31, 0.6)) for u in (-x * 0.3, -x * 0.1, x * 0.2)]
    return [
        *ends,
        *back,
        box(f.main, (x - 0.06, 0.4, 0.035), (0, 0.02, 0.42), 0.01),
        box(f.main, (x - 0.06, 0.04, 0.1), (0, -0.33, 0.55)),
        *books,
        box(f.main.shaded(0.85), (x - 0.06, 0.02, 0.3), (0, 0.1, 0.08)),
    ]


def bunk_bed(size: Vector, f: Finish) -> list[Part]:
    posts = [box(f.main, (0.06, 0.06, 1.65), (s * 0.46, t * 0.98, 0)) for s in (-1, 1) for t in (-1, 1)]
    parts = [*posts]
    for z in (0.3, 1.2):
        parts += [box(f.main, (0.04, 1.96, 0.12), (s * 0.46, 0, z)) for s in (-1, 1)] + [
            box(f.main, (0.9, 0.04, h), (0, t * 0.98, z)) for t, h in ((-1, 0.4), (1, 0.3))
        ]
        parts += [
            box(LINEN, (0.86, 1.9, 0.16), (0, 0, z + 0.06), 0.05),
            box(
                paint(("denim blue", "sage", "rust")[f.chosen(3)], "fabric"),
                (0.88, 1.25, 0.08),
                (0, 0.28, z + 0.18),
                0.035,
            ),
            cushion(LINEN, (0.62, 0.38, 0.14), (0, -0.72, z + 0.2)),
        ]
    ladder = [pipe(f.main, [(0.5, 0.55 + u, 0), (0.5, 0.55 + u, 1.55)], 0.018) for u in (0, 0.34)] + [
        pipe(f.main, [(0.5, 0.55, z), (0.5, 0.89, z)], 0.014) for z in np.arange(0.25, 1.5, 0.27)
    ]
    rail = [pipe(f.main, [(0.47, -0.95, z), (0.47, 0.5, z)], 0.016) for z in (1.45, 1.58)]
    return [*parts, *ladder, *rail]


def hospital_bed(size: Vector, f: Finish) -> list[Part]:
    base = [
        box(f.main, (0.7, 1.7, 0.1), (0, 0, 0.24), 0.02),
        *(pipe(STEEL, [(s * 0.3, y, 0.34), (s * 0.3, y + 0.2, 0.5)], 0.03) for s in (-1, 1) for y in (-0.6, 0.4)),
    ]
    casters = [p for s in (-1, 1) for t in (-1, 1) for p in wheel(DARK, STEEL, 0.08, 0.04, (s * 0.34, t * 0.78, 0.08))]
    flat = [
        box(LINEN, (0.86, 1.2, 0.14), (0, 0.34, 0.55), 0.05),
        placed(
            box(LINEN, (0.86, 0.8, 0.14), (0, 0, 0), 0.05),
            (0, -0.6, 0.68),
            np.array([[1.0, 0, 0], [0, 0.87, 0.5], [0, -0.5, 0.87]]),
        ),
    ]
    cover = [
        box(paint("powder blue", "fabric"), (0.9, 1.0, 0.08), (0, 0.44, 0.65), 0.035),
        placed(
            cushion(LINEN, (0.6, 0.38, 0.13)), (0, -0.78, 0.9), np.array([[1.0, 0, 0], [0, 0.87, 0.5], [0, -0.5, 0.87]])
        ),
    ]
    boards = [
        tapered(f.main, [(0.92, 0.05, 0.45), (0.92, 0.05, 0.9), (0.7, 0.05, 1.0)], (0, t * 1.02, 0), 0.02)
        for t in (-1, 1)
    ]
    rails = [
        p
        for s in (-1, 1)
        for p in (
            pipe(
                STEEL,
                rounded_path(
                    [(s * 0.47, -0.75, 0.6), (s * 0.47, -0.75, 0.92), (s * 0.47, 0.15, 0.92), (s * 0.47, 0.15, 0.6)],
                    0.08,
                ),
                0.014,
            ),
            *(pipe(STEEL, [(s * 0.47, y, 0.6), (s * 0.47, y, 0.92)], 0.008) for y in (-0.5, -0.3, -0.1)),
        )
    ]
    return [*base, *casters, *flat, *cover, *boards, *rails]


def crib(size: Vector, f: Finish) -> list[Part]:
    ends = [
        p
        for t in (-1, 1)
        for p in (
            box(f.main, (0.68, 0.03, 0.07), (0, t * 0.63, 0.93), 0.01),
            box(f.main, (0.68, 0.03, 0.06), (0, t * 0.63, 0.3)),
        )
    ]
    bars = [
        pipe(f.main, [(s * 0.33, y, 0.33), (s * 0.33, y, 0.94)], 0.01)
        for s in (-1, 1)
        for y in np.linspace(-0.56, 0.56, 12)
    ] + [
        pipe(f.main, [(u, t * 0.63, 0.33), (u, t * 0.63, 0.94)], 0.01)
        for t in (-1, 1)
        for u in np.linspace(-0.26, 0.26, 6)
    ]
    rails = [
        box(f.main, (0.03, 1.26, h), (s * 0.33, 0, z), 0.008) for s in (-1, 1) for z, h in ((0.93, 0.05), (0.3, 0.05))
    ]
    posts = [
        turned(f.main, [(0.025, 0), (0.03, 0.95), (0.022, 0.98), (0.03, 1.0), (0, 1.03)], (s * 0.33, t * 0.63, 0))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    bedding = [
        box(LINEN, (0.6, 1.2, 0.1), (0, 0, 0.36), 0.03),
        box(paint(("mint", "blush", "powder blue")[f.chosen(3)], "fabric"), (0.58, 0.7, 0.06), (0, 0.2, 0.44), 0.025),
        ellipsoid(paint("caramel", "fabric"), (0.09, 0.09, 0.11), (0.1, -0.35, 0.56)),
        ellipsoid(paint("caramel", "fabric"), (0.07,) * 3, (0.1, -0.35, 0.7)),
    ]
    return [*ends, *bars, *rails, *posts, *bedding]


def sun_lounger(size: Vector, f: Finish) -> list[Part]:
    slats = [box(f.main, (0.62, 0.07, 0.025), (0, v, 0.28), 0.005) for v in np.linspace(-0.25, 0.9, 13)]
    back = [
        placed(
            box(f.main, (0.62, 0.07, 0.025), (0, -v, 0), 0.005),
            (0, -0.32, 0.29),
            np.array([[1.0, 0, 0], [0, 0.82, 0.57], [0, -0.57, 0.82]]),
        )
        for v in np.linspace(0, 0.62, 7)
    ]
    frame = [box(f.second, (0.04, 1.85, 0.06), (s * 0.32, 0.0, 0.23), 0.01) for s in (-1, 1)] + [
        box(f.second, (0.05, 0.05, 0.25), (s * 0.3, y, 0)) for s in (-1, 1) for y in (-0.75, 0.75)
    ]
    pad = [
        box(paint(("cream", "teal", "coral")[f.chosen(3)], "fabric"), (0.56, 1.2, 0.06), (0, 0.32, 0.305), 0.028),
        placed(
            box(paint(("cream", "teal", "coral")[f.chosen(3)], "fabric"), (0.56, 0.62, 0.06), (0, -0.31, 0.02), 0.028),
            (0, -0.3, 0.31),
            np.array([[1.0, 0, 0], [0, 0.82, 0.57], [0, -0.57, 0.82]]),
        ),
    ]
    return [*slats, *back, *frame, *pad]


def massage_table(size: Vector, f: Finish) -> list[Part]:
    top = [box(f.main, (0.72, 1.6, 0.1), (0, 0.1, 0.6), 0.04), placed(hoop(f.main, 0.12, 0.045), (0, -0.85, 0.66))]
    legs = [
        pipe(paint("honey brown", "wood"), [(s * 0.3, t * 0.62, 0), (s * 0.3, t * 0.5, 0.6)], 0.025)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    braces = [pipe(STEEL, [(s * 0.3, 0.55, 0.35), (s * 0.3, -0.55, 0.35)], 0.006) for s in (-1, 1)]
    towel = [box(paint("chalk", "fabric"), (0.5, 0.3, 0.1), (0, 0.6, 0.7), 0.04)]
    return [
        *top,
        *legs,
        *braces,
        *towel,
        *(box(paint("honey brown", "wood"), (0.6, 0.03, 0.06), (0, t * 0.55, 0.32)) for t in (-1, 1)),
    ]
