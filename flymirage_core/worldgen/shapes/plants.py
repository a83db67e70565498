"""Plants in pots, beds and water; leaves, petals and fronds.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import circle, crown, pipe, placed, skin, sweep, tapered
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.shapes.foliage import BARK, branch, flowers, fronds, greenery, leafy, lump
from flymirage_core.worldgen.surfaces import Leaves, Part, Vector, upright


def topiary(size: Vector, f: Finish) -> list[Part]:
    tub = tapered(f.main, [(0.4, 0.4, 0), (0.5, 0.5, 0.4), (0.54, 0.54, 0.4), (0.54, 0.54, 0.46)], radius=0.02)
    balls: list[tuple[Vector, Vector]] = [((r, r, r), (0, 0, z)) for r, z in ((0.36, 0.95), (0.27, 1.52), (0.18, 1.95))]
    return [
        tub,
        pipe(BARK, [(0, 0, 0.4), (0, 0, 1.9)], 0.03),
        *crown(greenery(f), balls, (0.08, 0.05), 1500, f.generator(), 0.9),
    ]


def flower_bed(size: Vector, f: Finish) -> list[Part]:
    x, y, _ = size
    rim = [box(f.main, (x, 0.1, 0.16), (0, s * (y / 2 - 0.05), 0), 0.02) for s in (-1, 1)]
    rim += [box(f.main, (0.1, y - 0.2, 0.16), (s * (x / 2 - 0.05), 0, 0), 0.02) for s in (-1, 1)]
    soil = box(paint("chocolate", "soil"), (x - 0.2, y - 0.2, 0.12))
    blobs: list[tuple[Vector, Vector]] = [
        ((0.22, 0.22, 0.12), (u, v, 0.2))
        for u in np.arange(-x / 2 + 0.3, x / 2 - 0.2, 0.3)
        for v in np.arange(-y / 2 + 0.3, y / 2 - 0.2, 0.3)
    ]
    low = leafy(f, blobs, (0.12, 0.05), int(420 * x * y))
    return [*rim, soil, *low, *flowers(f, x / 2 - 0.2, y / 2 - 0.2, 0.26, 0.16, int(60 * x * y))]


def fern(size: Vector, f: Finish) -> list[Part]:
    return [*_pot(f, 0.2, 0.28), *fronds(greenery(f), 22, 0.6, 0.75, 0.28, f.generator(), 0.9)]


def _pot(f: Finish, radius: float, height: float) -> list[Part]:
    form = [
        (0, 0),
        (0.72 * radius, 0),
        (0.95 * radius, 0.8 * height),
        (1.05 * radius, 0.8 * height),
        (1.05 * radius, height),
        (0.9 * radius, height),
        (0.88 * radius, 0.9 * height),
    ]
    if f.chosen(2):
        form = [
            (0, 0),
            *smooth(
                [(0.55 * radius, 0.0), (radius, 0.45 * height), (0.9 * radius, 0.93 * height), (0.92 * radius, height)],
                8,
            ),
            (0.8 * radius, height),
            (0.8 * radius, 0.9 * height),
        ]
    return [
        turned(f.main, form),
        turned(paint("chocolate", "soil"), [(0.88 * radius, 0.9 * height), (0, 0.92 * height)]),
    ]


def potted_palm(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    stems = [
        pipe(BARK, [(0.05 * np.cos(a), 0.05 * np.sin(a), 0.3), (0.12 * np.cos(a), 0.12 * np.sin(a), 0.95)], 0.022)
        for a in (0, 2.1, 4.2)
    ]
    return [*_pot(f, 0.24, 0.38), *stems, *fronds(greenery(f), 18, 0.85, 0.7, 0.9, rng, 0.95)]


def cactus(size: Vector, f: Finish) -> list[Part]:
    green = replace(paint("sage", "leaf"), seed=f.seed % 97).shaded(0.8)
    a = 2 * np.pi * np.arange(32) / 32
    star = np.stack([np.cos(a), np.sin(a)], 1) * (0.1 * (1 + 0.13 * np.cos(8 * a)))[:, None]
    body = sweep(
        green, star, [(0, 0, 0.25), (0, 0, 0.5), (0, 0, 1.0), (0, 0, 1.12), (0, 0, 1.18)], [0.8, 1, 1, 0.75, 0.3]
    )
    arms = [
        sweep(
            green,
            star * 0.62,
            [
                (0, 0, h),
                (s * 0.2, 0, h + 0.02),
                (s * 0.26, 0, h + 0.1),
                (s * 0.26, 0, h + 0.34),
                (s * 0.26, 0, h + 0.4),
            ],
            [1, 1, 1, 1, 0.4],
        )
        for s, h in ((-1, 0.55), (1, 0.68))
    ]
    return [*_pot(f, 0.2, 0.3), body, *arms]


def snake_plant(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    green = greenery(f)
    blades = []
    for k in range(13):
        a, lean, tall, w = k * 2.4, rng.uniform(0.02, 0.14), rng.uniform(0.5, 0.85), rng.uniform(0.03, 0.04)
        t = np.array([0.0, 0.35, 0.7, 0.9, 1.0])
        spine = np.stack([(0.05 + lean * t**2) * np.cos(a), (0.05 + lean * t**2) * np.sin(a), 0.25 + tall * t], 1)
        side = np.array([-np.sin(a + 0.5), np.cos(a + 0.5), 0.0])
        half = np.array([0.7, 1.0, 0.9, 0.5, 0.02])[:, None] * w
        blades += skin(green, [spine - side * half, spine + side * half])
    return [*_pot(f, 0.17, 0.28), *blades]


def bamboo(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    x = 0.9
    tub = [
        tapered(
            f.main, [(x, 0.36, 0), (x + 0.04, 0.4, 0.42), (x - 0.04, 0.32, 0.42), (x - 0.04, 0.32, 0.38)], radius=0.01
        )
    ]
    canes = []
    for u in np.linspace(-0.36, 0.36, 9):
        lean, tall = rng.uniform(-0.08, 0.08, 2), rng.uniform(1.3, 1.9)
        path = [(u + lean[0] * t, lean[1] * t, 0.38 + tall * t) for t in np.linspace(0, 1, 6)]
        canes.append(pipe(paint("sage").shaded(0.9), path, 0.013))
    blobs: list[tuple[Vector, Vector]] = [
        ((0.3, 0.25, 0.4), (u, 0, z)) for u, z in ((-0.25, 1.5), (0.2, 1.75), (0.0, 2.05), (0.3, 1.25))
    ]
    return [*tub, *canes, *crown(greenery(f), blobs, (0.2, 0.035), 420, rng, 0.0)]


def tall_grass(size: Vector, f: Finish) -> list[Part]:
    """A tuft of blades that arch outwards."""
    rng = f.generator()
    count = 260
    a, out, tall = rng.uniform(0, 6.28, count), rng.uniform(0.02, 0.4, count), rng.uniform(0.4, 0.95, count)
    base = 0.08 * rng.normal(size=(count, 2))
    centres, lengths = [], []
    for low, high in ((0.0, 0.5), (0.45, 0.85), (0.8, 1.0)):
        ends = [
            np.stack(
                [base[:, 0] + np.cos(a) * out * t**2, base[:, 1] + np.sin(a) * out * t**2, tall * (t - 0.25 * t**3)], 1
            )
            for t in (low, high)
        ]
        centres.append((ends[0] + ends[1]) / 2)
        lengths.append((ends[1] - ends[0]) / 2)
    side = np.stack([-np.sin(a), np.cos(a), 0 * a], 1) * 0.009
    return [
        Part(
            Leaves(np.concatenate(centres), np.concatenate(lengths), np.tile(side, (3, 1))),
            replace(f.main, texture="leaf"),
        )
    ]


def bonsai(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    tray = tapered(f.main, [(0.36, 0.24, 0), (0.42, 0.3, 0.07), (0.38, 0.26, 0.07), (0.38, 0.26, 0.06)], radius=0.03)
    trunk = sweep(
        BARK, circle(0.025), [(0, 0, 0.06), (0.05, 0, 0.15), (-0.02, 0.02, 0.24), (0.04, 0, 0.34)], [1.4, 1.0, 0.8, 0.5]
    )
    pads: list[tuple[Vector, Vector]] = [
        ((0.12, 0.11, 0.05), (0.14, 0, 0.26)),
        ((0.1, 0.1, 0.05), (-0.13, 0.03, 0.31)),
        ((0.13, 0.12, 0.06), (0.03, 0, 0.4)),
    ]
    limbs = [branch((0.01, 0, 0.22), spot, 0.012, rng) for _, spot in pads]
    return [tray, trunk, *limbs, *crown(greenery(f), pads, (0.03, 0.02), 700, rng, 0.85)]


def ivy(size: Vector, f: Finish) -> list[Part]:
    """Climbing leaves on a wall: thin, ragged."""
    x, y, z = size
    rng = f.generator()
    green = replace(f.main, texture="leaf")
    stems = [
        pipe(
            BARK,
            [
                (u * x, -y / 2 + 0.02, 0),
                (u * x * 0.8 + rng.normal(0, 0.1), -y / 2 + 0.02, z * 0.5),
                (u * x * 1.1, -y / 2 + 0.02, z * rng.uniform(0.7, 0.98)),
            ],
            0.012,
        )
        for u in (-0.3, -0.1, 0.15, 0.35)
    ]
    count = int(330 * x * z)
    spot = np.stack(
        [rng.uniform(-0.5, 0.5, count) * x, rng.uniform(-0.5, 0.5, count) * y, z * rng.beta(1.0, 1.3, count)], 1
    )
    droop = np.tile([0.0, 0.15, -1.0], (count, 1)) + rng.normal(0, 0.4, (count, 3))
    droop *= 0.05 / np.linalg.norm(droop, axis=1, keepdims=True)
    side = np.cross(droop, np.array([0.0, 1.0, 0.2]) + rng.normal(0, 0.3, (count, 3)))
    side *= 0.04 / np.linalg.norm(side, axis=1, keepdims=True)
    return [*stems, Part(Leaves(spot, droop, side), green)]


def lily_pond(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    stones = [
        placed(
            lump(f.main.shaded(rng.uniform(0.8, 1.15)), f.seed + k, 0.2),
            (1.15 * np.cos(a), 0.8 * np.sin(a), 0.06),
            upright(a) * np.array([0.2, 0.17, 0.14]),
        )
        for k, a in enumerate(np.arange(17) * 2 * np.pi / 17)
    ]
    water = turned(replace(paint("teal", "water"), opacity=0.9), [(1.15, 0.06), (0, 0.06)], scale=(1.0, 0.7))
    pads = [
        turned(paint("moss green", "leaf"), [(0.14, 0.075), (0, 0.08)], (u, v, 0))
        for u, v in rng.uniform(-0.6, 0.6, (8, 2)) * [1, 0.7]
    ]
    blooms = [ellipsoid(paint("pink"), (0.06, 0.06, 0.05), (u, v, 0.11)) for u, v in rng.uniform(-0.5, 0.5, (3, 2))]
    return [*stones, water, *pads, *blooms]
