"""Shops and cloakrooms.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    cable,
    circle,
    cloth,
    hull,
    loft,
    mirrored,
    pipe,
    placed,
    rounded_ring,
    sign,
    sweep,
    tapered,
    two_sided,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, DARK, WHITE = paint("silver", "brushed"), paint("black"), paint("white")
BRASS = paint("brass", "brushed")
CLOTHES = ("navy", "rust", "cream", "burgundy", "sage", "charcoal", "mustard", "denim blue", "blush", "chalk")


def shop_shelf(size: Vector, f: Finish) -> list[Part]:
    """A shop's double shelf with rows of goods."""
    x, y, z = size
    back = [
        box(f.main, (x, 0.04, z - 0.05), (0, -y / 2 + 0.03, 0.05)),
        *mirrored(box(f.main, (0.03, y * 0.7, z), (x / 2 - 0.015, -y * 0.1, 0))),
    ]
    parts = [*back, box(f.main, (x, y, 0.14), (0, 0, 0), 0.005)]
    rng = f.generator()
    for i, base in enumerate(np.linspace(0.14, z - 0.4, 4)):
        deep = y - 0.06 if i == 0 else y * 0.72
        parts.append(box(f.main, (x - 0.04, deep, 0.025), (0, -y / 2 + deep / 2 + 0.04, base)))
        parts.append(box(paint("red"), (x - 0.04, 0.008, 0.04), (0, -y / 2 + deep + 0.045, base - 0.01)))
        u = -x / 2 + 0.05
        while u < x / 2 - 0.16:
            w, h = rng.uniform(0.09, 0.2), rng.uniform(0.16, min(0.3, z / 6))
            colour = str(rng.choice(["red", "yellow", "teal", "cream", "green", "orange", "blue", "plum", "chalk"]))
            if rng.random() < 0.5:
                parts.append(
                    box(
                        paint(colour),
                        (w - 0.015, deep * 0.75, h),
                        (u + w / 2, -y / 2 + deep / 2 + 0.05, base + 0.025),
                        0.006,
                    )
                )
                parts.append(
                    box(
                        paint("chalk"),
                        (w * 0.6, 0.004, h * 0.4),
                        (u + w / 2, -y / 2 + deep * 0.875 + 0.053, base + 0.025 + h * 0.3),
                    )
                )
            else:
                parts += [
                    turned(
                        paint(colour),
                        [(0, 0), (0.038, 0), (0.038, h * 0.6), (0.015, h * 0.85), (0.015, h), (0, h)],
                        (u + w / 2, -y / 2 + deep * q + 0.03, base + 0.025),
                    )
                    for q in (0.35, 0.75)
                ]
            u += w
    return parts


def wine_rack(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    parts = [
        *mirrored(box(f.main, (0.03, y, z), (x / 2 - 0.015, 0, 0))),
        box(f.main, (x, y, 0.03), (0, 0, z - 0.03)),
        box(f.main, (x, y, 0.03)),
    ]
    rng = f.generator()
    for row in np.arange(0.1, z - 0.12, 0.15):
        parts += [box(f.main, (x - 0.06, 0.03, 0.02), (0, t * y * 0.38, row - 0.03)) for t in (-1, 1)]
        for u in np.arange(-x / 2 + 0.1, x / 2 - 0.06, 0.13):
            if rng.random() < 0.8:
                glass = paint(str(rng.choice(["forest green", "black", "olive", "burgundy"])))
                form = [(0, -0.14), (0.038, -0.14), (0.038, 0.05), (0.014, 0.1), (0.014, 0.16), (0, 0.16)]
                parts.append(placed(turned(glass, form), (float(u), 0.0, float(row) + 0.028), FACING))
    return parts


def shoe_rack(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    parts = [*mirrored(box(f.main, (0.025, y, z), (x / 2 - 0.012, 0, 0)))]
    rng = f.generator()
    for base in (0.08, z * 0.5, z - 0.03):
        parts += [
            box(f.main, (x - 0.05, 0.05, 0.018), (0, v, base)) for v in np.linspace(-y / 2 + 0.04, y / 2 - 0.04, 4)
        ]
        if base < z - 0.05:
            for u in np.arange(-x / 2 + 0.12, x / 2 - 0.08, 0.22):
                shoe = paint(str(rng.choice(["black", "chestnut", "white", "navy", "red", "tan"])), "leather")
                for s in (-0.045, 0.045):
                    parts.append(
                        hull(
                            shoe,
                            [
                                (-0.12, 0.06, 0, 0.09),
                                (-0.05, 0.07, 0, 0.1),
                                (0.03, 0.08, 0, 0.05),
                                (0.1, 0.08, 0, 0.035),
                                (0.13, 0.05, 0, 0.03),
                            ],
                            0.02,
                        )
                    )
                    parts[-1] = placed(parts[-1], (float(u) + s, 0.0, base + 0.02))
    return parts


def clothes_rail(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    frame = [
        pipe(
            f.main,
            [(s * (x / 2 - 0.05), t * 0.24, 0.05), (s * (x / 2 - 0.05), 0, 0.14), (s * (x / 2 - 0.05), 0, z)],
            0.016,
        )
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    rail = pipe(f.main, [(-x / 2 + 0.02, 0, z - 0.01), (x / 2 - 0.02, 0, z - 0.01)], 0.016)
    rng = f.generator()
    coats = []
    for u in np.arange(-x / 2 + 0.16, x / 2 - 0.1, 0.085):
        length = rng.uniform(0.62, 1.05)
        rows = [(0.03, 0.08, z - 0.12), (0.045, 0.42, z - 0.2), (0.05, 0.4, z - 0.5), (0.06, 0.44, z - 0.12 - length)]
        fabric = paint(str(rng.choice(CLOTHES)), "fabric", seed=int(rng.integers(99)))
        coats.append(
            placed(
                loft(
                    fabric,
                    np.array([np.column_stack([rounded_ring(a, b, 0.015), np.full(12, h)]) for a, b, h in rows[::-1]]),
                ),
                (float(u), 0, 0),
            )
        )
        coats.append(pipe(STEEL, [(float(u), 0, z - 0.12), (float(u), 0, z + 0.005)], 0.004))
    return [*frame, rail, *coats]


def newspaper_rack(size: Vector, f: Finish) -> list[Part]:
    sides = [
        pipe(f.main, [(s * 0.28, 0.18, 0), (s * 0.28, -0.16, 1.2), (s * 0.28, -0.18, 0)], 0.014, 0.04) for s in (-1, 1)
    ]
    parts = [*sides]
    for i in range(4):
        z, y = 0.12 + 0.27 * i, 0.13 - 0.075 * i
        parts += [
            pipe(f.main, [(-0.28, y + 0.04, z), (0.28, y + 0.04, z)], 0.01),
            pipe(f.main, [(-0.28, y + 0.03, z + 0.08), (0.28, y + 0.03, z + 0.08)], 0.008),
        ]
        words = ("DAILY|NEWS", "THE|TIMES", "SPORT", "WORLD", "CITY|POST", "STYLE", "MUSIC", "TRAVEL")
        for u, k in ((-0.14, 2 * i), (0.14, 2 * i + 1)):
            ground = ("chalk", "coral", "powder blue", "mustard")[(k + f.seed) % 4]
            parts += [
                box(paint("chalk"), (0.25, 0.02, 0.27), (u, y, z), 0, 0.28),
                placed(
                    sign(words[k], 0.25, 0.27, (0, 0, 0), ground),
                    (u, y + 0.014, z),
                    np.array([[1.0, 0, 0], [0, 0.96, -0.28], [0, 0.28, 0.96]]),
                ),
            ]
    return parts


def mannequin(size: Vector, f: Finish) -> list[Part]:
    def ring(w: float, d: float, z: float, y: float = 0.0) -> Float:
        c = circle(0.5, 16)
        return np.column_stack([c[:, 0] * w, c[:, 1] * d + y, np.full(16, z)])

    skin_colour = f.main
    legs = [
        sweep(
            skin_colour,
            circle(0.5, 10),
            [(s * 0.08, 0, 0.04), (s * 0.085, -0.01, 0.25), (s * 0.08, 0, 0.48), (s * 0.09, 0, 0.85)],
            [0.075, 0.11, 0.1, 0.17],
        )
        for s in (-1, 1)
    ]
    dress = paint(CLOTHES[f.chosen(len(CLOTHES))], "fabric", seed=f.seed % 97)
    torso = loft(
        dress,
        np.array(
            [
                ring(0.46, 0.36, 0.62),
                ring(0.38, 0.28, 0.85),
                ring(0.26, 0.18, 1.08),
                ring(0.33, 0.22, 1.28, 0.01),
                ring(0.38, 0.18, 1.4),
                ring(0.14, 0.12, 1.47),
            ]
        ),
    )
    neck = [
        cylinder(skin_colour, 0.05, 0.12, (0, 0, 1.44)),
        ellipsoid(skin_colour, (0.075, 0.095, 0.12), (0, 0.01, 1.66)),
    ]
    arms = [
        sweep(
            skin_colour,
            circle(0.5, 8),
            [(s * 0.18, 0, 1.38), (s * 0.24, -0.02, 1.12), (s * 0.22, 0.08, 0.88)],
            [0.09, 0.075, 0.055],
        )
        for s in (-1, 1)
    ]
    feet = [ellipsoid(skin_colour, (0.045, 0.1, 0.035), (s * 0.08, 0.05, 0.045)) for s in (-1, 1)]
    return [*legs, torso, *neck, *arms, *feet, turned(STEEL, [(0, 0), (0.2, 0), (0.19, 0.012), (0, 0.014)])]


def plinth(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    return [
        tapered(
            f.main,
            [
                (x, y, 0),
                (x, y, 0.1),
                (x - 0.06, y - 0.06, 0.13),
                (x - 0.08, y - 0.08, z - 0.12),
                (x - 0.02, y - 0.02, z - 0.08),
                (x, y, z - 0.05),
                (x, y, z),
            ],
            radius=0.006,
        ),
        box(BRASS, (0.14, 0.006, 0.07), (0, y / 2 - 0.037, z * 0.62)),
    ]


def rope_barrier(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    posts = [
        turned(
            f.main,
            [
                (0, 0),
                (0.16, 0),
                (0.15, 0.02),
                (0.03, 0.04),
                (0.022, 0.9),
                (0.04, 0.92),
                *smooth([(0.04, 0.95), (0.035, 1.0), (0, 1.02)], 4),
            ],
            (s * (x / 2 - 0.16), 0, 0),
        )
        for s in (-1, 1)
    ]
    rope = cable(
        paint(("burgundy", "navy", "emerald")[f.chosen(3)], "velvet"),
        (-x / 2 + 0.18, 0, 0.88),
        (x / 2 - 0.18, 0, 0.88),
        0.26,
        0.02,
    )
    return [*posts, rope, *(ellipsoid(f.main, (0.03, 0.025, 0.03), (s * (x / 2 - 0.2), 0, 0.88)) for s in (-1, 1))]


def flag(size: Vector, f: Finish) -> list[Part]:
    pole = turned(
        BRASS, [(0, 0), (0.18, 0), (0.17, 0.03), (0.04, 0.06), (0.016, 0.1), (0.016, 2.3), (0.03, 2.32), (0, 2.4)]
    )
    stripes = replace(f.main, texture="stripes", ink=paint("chalk").colour)
    drape = two_sided(cloth(stripes, 0.5, 1.3, (0.16, 0.02, 0.95), 0.17, 0.2))
    return [pole, *drape]
