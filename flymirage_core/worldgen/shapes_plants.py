"""Trees, bushes, plants in pots, rocks and logs. Sizes are nominal, `fitted` makes them exact."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.worldgen.forms import circle, crown, loft, pipe, placed, skin, sweep, tapered
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.noise import fractal
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Leaves, Part, Vector, upright

GREENS = ("forest green", "green", "moss green", "olive")
PETALS = ("red", "yellow", "pink", "lavender", "coral", "white", "orange", "plum")
BARK = paint("walnut brown", "bark", detail=0.8)


def greenery(f: Finish) -> Material:
    """This scene's green for plants whose main material is their pot."""
    return paint(GREENS[f.chosen(len(GREENS))], "leaf", seed=f.seed % 991)


def leafy(f: Finish, blobs: Sequence[tuple[Vector, Vector]], leaf: tuple[float, float], count: int) -> list[Part]:
    return crown(greenery(f), blobs, leaf, count, f.generator())


def flowers(f: Finish, x: float, y: float, low: float, tall: float, count: int) -> list[Part]:
    """Heads of petals over an area of half sizes (x, y), from ``low`` up to ``low + tall``: one part."""
    rng = f.generator()
    spots = rng.uniform(-1, 1, (count, 3)) * [x, y, tall / 2] + [0, 0, low + tall / 2]
    angle = np.tile(np.arange(5) * 2 * np.pi / 5, count)
    out = np.stack([np.cos(angle), np.sin(angle), np.full(len(angle), 0.35)], 1)
    centres = np.repeat(spots, 5, axis=0) + 0.035 * out
    side = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], 1)
    petal = paint(PETALS[f.chosen(len(PETALS))], "leaf", seed=f.seed % 991)
    return [Part(Leaves(centres, 0.04 * out, 0.03 * side), petal)]


def _branch(start: ArrayLike, end: ArrayLike, radius: float, rng: np.random.Generator) -> Part:
    a, b = np.asarray(start, float), np.asarray(end, float)
    t = np.linspace(0, 1, 6)[:, None]
    path = a + t * (b - a) + rng.normal(0, 0.05, (6, 3)) * np.linalg.norm(b - a) * (t * (1 - t)) * 2
    return sweep(BARK, circle(radius, 8), path, np.linspace(1, 0.35, 6))


def _trunk(height: float, radius: float, rng: np.random.Generator) -> Part:
    z = np.array([0.0, 0.04, 0.12, 0.3, 0.6, 0.85, 1.0]) * height
    path = np.column_stack([rng.normal(0, 0.02, (7, 2)) * height * 0.5 * (z[:, None] > 0), z])
    return sweep(BARK, circle(radius), path, [1.7, 1.25, 1.0, 0.9, 0.75, 0.6, 0.4])


def tree(size: Vector, f: Finish) -> list[Part]:
    """A broad-leaved tree: forked branches that carry a head of several round masses."""
    rng = f.generator()
    leaf = replace(f.main, texture="leaf")
    blobs: list[tuple[Vector, Vector]] = [((1.35, 1.35, 1.15), (0.0, 0.0, 4.3))]
    parts = [_trunk(3.6, 0.16, rng)]
    for k in range(7):
        a = k * 0.9 + rng.uniform(-0.2, 0.2)
        reach, high = rng.uniform(0.9, 1.45), rng.uniform(2.9, 4.4)
        spot = (reach * np.cos(a), reach * np.sin(a), high)
        r = rng.uniform(0.75, 1.05)
        blobs.append(((r, r, 0.8 * r), spot))
        parts.append(_branch((0, 0, 1.7 + 0.14 * k), spot, 0.06, rng))
    return [*parts, *crown(leaf, blobs, (0.3, 0.2), 2600, rng)]


def birch(size: Vector, f: Finish) -> list[Part]:
    """Slender white stems and an airy, hanging head."""
    rng = f.generator()
    bark = replace(paint("chalk", "bark"), wear=0.9, seed=f.seed % 97)
    parts = [
        sweep(bark, circle(0.09), [(x, y, 0), (1.3 * x, 1.2 * y, 2.4), (1.8 * x, 1.7 * y, 5.6)], [1.2, 0.85, 0.25])
        for x, y in ((0.0, 0.0), (0.28, 0.16), (-0.26, 0.2))
    ]
    blobs: list[tuple[Vector, Vector]] = []
    for k in range(22):
        a, z = 2.4 * k + rng.uniform(-0.3, 0.3), 1.9 + 0.19 * k
        r = 1.0 - 0.03 * k
        blobs.append(((0.55 * r + 0.1, 0.55 * r + 0.1, 0.75), (0.6 * r * np.cos(a), 0.6 * r * np.sin(a), z)))
        parts.append(_branch((0, 0, z - 0.5), blobs[-1][1], 0.025, rng))
    return [*parts, *crown(replace(f.main, texture="leaf").shaded(1.2), blobs, (0.15, 0.1), 3000, rng, 0.0)]


def conifer(size: Vector, f: Finish) -> list[Part]:
    """Whorls of drooping boughs, wide below and narrow at the top."""
    rng = f.generator()
    needles = replace(f.main, texture="leaf").shaded(0.8)
    centres, lengths, widths = [], [], []
    for level in np.linspace(0.0, 1.0, 17):
        reach, z = 1.5 * (1 - level) ** 0.85 + 0.07, 0.75 + 4.9 * level
        for a in np.linspace(0, 2 * np.pi, max(5, int(16 * (1 - level) + 4)), endpoint=False) + rng.uniform(0, 1):
            out = np.array([np.cos(a), np.sin(a), -0.32 + 0.35 * level])
            side = np.array([-np.sin(a), np.cos(a), 0.0])
            for share in np.arange(0.35, 1.0, 0.16):
                at = out * reach * share * rng.uniform(0.9, 1.06) + [0, 0, z]
                for s in (-1, 1):
                    tip = out * 0.8 + s * side * 0.75 + [0, 0, rng.uniform(-0.2, 0.15)]
                    centres.append(at + tip * 0.1)
                    lengths.append(tip * 0.17)
                    widths.append(np.cross(tip, [0.1, 0.1, 1.0]) * 0.062)
    boughs = Part(Leaves(np.array(centres), np.array(lengths), np.array(widths)), needles)
    core = turned(needles.shaded(0.4), [(0, 0.9), (0.6, 0.95), (0.32, 2.6), (0.02, 5.3)])
    return [_trunk(5.4, 0.13, rng), core, boughs]


def cypress(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    blobs: list[tuple[Vector, Vector]] = [
        ((r, r, 0.75), (0, 0, z))
        for r, z in ((0.36, 0.9), (0.46, 1.6), (0.44, 2.4), (0.36, 3.2), (0.24, 3.9), (0.12, 4.5))
    ]
    return [
        _trunk(1.2, 0.1, rng),
        *crown(replace(f.main, texture="leaf").shaded(0.75), blobs, (0.24, 0.08), 1500, rng, 0.85),
    ]


def fronds(
    material: Material, count: int, length: float, droop: float, top: float, rng: np.random.Generator, rise: float = 0.5
) -> list[Part]:
    """Feathered leaves that arch out from (0, 0, top): palms and ferns. One part for the leaflets."""
    centres, lengths, widths, ribs = [], [], [], []
    for k in range(count):
        a, up = k * 2.4 + rng.uniform(-0.2, 0.2), rise * rng.uniform(0.3, 1.3)
        t = np.linspace(0, 1, 11)
        arch = np.stack([t * np.cos(a), t * np.sin(a), up * t - droop * t**2.2], 1) * length * rng.uniform(
            0.8, 1.05
        ) + [0, 0, top]
        ribs.append(pipe(material.shaded(0.7), arch[::2], 0.008 + 0.006 * length))
        along = np.gradient(arch, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        side = np.cross(along, [0, 0, 1.0])
        for i in range(1, 11):
            for s in (-1, 1):
                reach = 0.24 * length * np.sin(np.pi * (0.12 + 0.86 * t[i])) + 0.02
                tip = side[i] * s + along[i] * 0.7 + [0, 0, -0.25]
                tip /= np.linalg.norm(tip)
                centres.append(arch[i] + tip * reach / 2)
                lengths.append(tip * reach / 2)
                widths.append(np.cross(tip, [0.2, 0.1, 1.0]) * 0.035 * length**0.5)
    return [Part(Leaves(np.array(centres), np.array(lengths), np.array(widths)), material), *ribs[:8]]


def palm(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    bend = rng.uniform(-0.5, 0.5)
    z = np.linspace(0, 4.2, 15)
    path = np.column_stack([bend * (z / 4.2) ** 2, 0 * z, z])
    rings = 1 + 0.12 * (np.arange(15) % 2)
    trunk = sweep(replace(BARK, colour=paint("taupe").colour), circle(0.15), path, rings * np.linspace(1.15, 0.8, 15))
    head = fronds(replace(f.main, texture="leaf"), 16, 1.9, 0.95, 0.0, rng, 0.75)
    return [trunk, *(placed(p, path[-1]) for p in head)]


def bush(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    blobs: list[tuple[Vector, Vector]] = [((0.5, 0.5, 0.45), (0, 0, 0.48))]
    blobs += [
        ((0.34, 0.34, 0.3), (0.34 * np.cos(a), 0.34 * np.sin(a), rng.uniform(0.3, 0.55))) for a in np.arange(6) * 1.05
    ]
    parts = crown(replace(f.main, texture="leaf"), blobs, (0.13, 0.08), 1300, rng, 0.8)
    return [*parts, *(flowers(f, 0.42, 0.42, 0.55, 0.4, 40) if f.chosen(2) else [])]


def hedge(size: Vector, f: Finish) -> list[Part]:
    """Clipped: leaves on the faces of a box."""
    x, y, z = size
    rng = f.generator()
    green = replace(f.main, texture="leaf")
    area = np.array([x * z, x * z, y * z, y * z, x * y])
    face = rng.choice(5, size=int(420 * area.sum()), p=area / area.sum())
    normal = np.array([[0, 1, 0], [0, -1, 0], [1, 0, 0], [-1, 0, 0], [0, 0, 1.0]])[face]
    inside = rng.uniform(-0.5, 0.5, (len(face), 3)) * [x, y, z]
    at = np.where(normal != 0, normal * np.array([x, y, z]) / 2, inside) * rng.uniform(0.95, 1.0, (len(face), 1)) + [
        0,
        0,
        z / 2,
    ]
    facing = normal + rng.normal(0, 0.45, (len(face), 3))
    lengths = np.cross(facing, rng.normal(size=(len(face), 3)))
    lengths *= 0.05 / np.linalg.norm(lengths, axis=1, keepdims=True)
    widths = np.cross(facing, lengths)
    widths *= 0.032 / np.linalg.norm(widths, axis=1, keepdims=True)
    return [
        box(green.shaded(0.45), (x - 0.09, y - 0.09, z - 0.05), (0, 0, 0.0), 0.05),
        Part(Leaves(at, lengths, widths), green),
    ]


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
    limbs = [_branch((0.01, 0, 0.22), spot, 0.012, rng) for _, spot in pads]
    return [tray, trunk, *limbs, *crown(greenery(f), pads, (0.03, 0.02), 700, rng, 0.85)]


def rock(size: Vector, f: Finish) -> list[Part]:
    return [_lump(f.main, f.seed, 0.22)]


def _lump(material: Material, seed: int, rough: float) -> Part:
    """A boulder: a ball pushed in and out by noise, flat below."""
    v, a = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 12), np.arange(20) * 2 * np.pi / 20
    ball = np.stack([np.cos(v)[:, None] * np.cos(a), np.cos(v)[:, None] * np.sin(a), np.sin(v)[:, None] + 0 * a], 2)
    push = 1 + rough * fractal(ball.reshape(-1, 3) * 1.3 + seed % 89, seed % 991).reshape(12, 20, 1) * 2
    points = ball * push
    points[..., 2] = np.maximum(points[..., 2], -0.45)
    return loft(material, points, False)


def stump(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    a = 2 * np.pi * np.arange(20) / 20
    ring = np.stack([np.cos(a), np.sin(a)], 1)
    bumps = 1 + 0.08 * rng.normal(size=20) + 0.12 * np.cos(5 * a)
    body = sweep(
        replace(BARK, seed=f.seed % 97),
        ring * (0.25 * bumps)[:, None],
        [(0, 0, 0), (0, 0, 0.06), (0, 0, 0.2), (0, 0, 0.42)],
        [1.5, 1.2, 1.0, 0.95],
    )
    return [body, turned(paint("tan", "wood"), [(0.2, 0.424), (0, 0.424)])]


def log_pile(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    parts = []
    for row in range(4):
        for i in range(7 - row):
            r, shift = rng.uniform(0.085, 0.105), rng.uniform(-0.04, 0.04)
            u, z = (i - (6 - row) / 2) * 0.21, 0.105 + row * 0.18
            parts.append(
                pipe(replace(BARK, seed=int(rng.integers(99))), [(u, -0.5 + shift, z), (u, 0.5 + shift, z)], r)
            )
            end = turned(paint("tan", "wood").shaded(rng.uniform(0.85, 1.15)), [(r * 0.9, 0), (0, 0.004)])
            parts.append(placed(end, (u, 0.5 + shift, z), np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])))
    return parts


def hay_bale(size: Vector, f: Finish) -> list[Part]:
    straw = paint("mustard", "bark", seed=f.seed % 97)
    body = placed(
        tapered(straw, [(0.5, 0.46, 0), (0.5, 0.46, 1.0)], radius=0.06),
        (-0.5, 0, 0.23),
        np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
    )
    return [body, *(box(paint("chocolate"), (0.015, 0.47, 0.51), (u, 0, -0.02), 0.01) for u in (-0.22, 0.22))]


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
            _lump(f.main.shaded(rng.uniform(0.8, 1.15)), f.seed + k, 0.2),
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
