"""Gardens, markets and squares: stalls, fountains, statues, fences.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    cable,
    cloth,
    group,
    pipe,
    placed,
    plate,
    rounded_path,
    sign,
    skin,
    spun,
    tapered,
    two_sided,
)
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.shapes.foliage import flowers, leafy
from flymirage_core.worldgen.surfaces import Part, Vector


def market_stall(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    wood = paint("honey brown", "wood", seed=f.seed)
    posts = [box(wood, (0.07, 0.07, 2.5 if t < 0 else 2.1), (s * 1.05, t * 0.75, 0)) for s in (-1, 1) for t in (-1, 1)]
    stripes = replace(f.main, texture="stripes", ink=paint("chalk").colour, detail=0.6)
    u = np.linspace(-1.2, 1.2, 13)
    line = [np.column_stack([u, np.full(13, y), z - 0.04 * np.sin(np.pi * (u + 1.2) / 0.4) ** 2])
            for y, z in ((-0.95, 2.62), (0.0, 2.42), (1.0, 2.12), (1.02, 1.92))]  # fmt: skip
    roof = skin(stripes, line)
    table = [box(wood, (2.1, 1.1, 0.05), (0, 0.1, 0.8)), box(wood.shaded(0.8), (2.1, 0.03, 0.7), (0, 0.63, 0.1))]
    goods = []
    for i in range(4):
        for j in range(2):
            at = (-0.76 + 0.5 * i, -0.12 + 0.46 * j, 0.85 + 0.06 * (1 - j))
            goods.append(tapered(wood.shaded(1.15), [(0.4, 0.36, 0), (0.44, 0.4, 0.12)], at, 0.01))
            fruit = paint(
                str(rng.choice(["orange", "red", "mustard", "green", "burgundy", "yellow", "moss green"])), seed=i
            )
            spots = [(a, b) for a in (-0.13, 0, 0.13) for b in (-0.11, 0.0, 0.11)]
            goods += [ellipsoid(fruit, (0.075, 0.07, 0.07), (at[0] + a, at[1] + b, at[2] + 0.14)) for a, b in spots]
    return [*posts, *roof, *table, *goods, sign("FRESH FRUIT", 1.5, 0.22, (0, 0.66, 0.4), "chalk", "forest green")]


def planter(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    tub = tapered(
        f.main, [(x * 0.86, y * 0.86, 0), (x, y, z * 0.55), (x, y, z * 0.6), (x * 0.9, y * 0.9, z * 0.6)], radius=0.03
    )
    soil = box(paint("chocolate", "soil"), (x * 0.9, y * 0.9, 0.02), (0, 0, z * 0.55))
    green = leafy(f, [((x * 0.48, y * 0.48, z * 0.22), (0, 0, z * 0.76))], (0.13, 0.06), int(160 * x))
    return [tub, soil, *green, *flowers(f, x * 0.4, y * 0.4, z * 0.78, z * 0.2, int(26 * x))]


def fountain(size: Vector, f: Finish) -> list[Part]:
    water = replace(paint("turquoise", "water"), opacity=0.85)
    rim = turned(f.main, [(1.5, 0), (1.5, 0.5), (1.56, 0.52), (1.56, 0.6), (1.34, 0.6), (1.34, 0.3), (0, 0.3)])
    pool = turned(water, [(1.36, 0.48), (0, 0.48)])
    stem = turned(
        f.main, [(0.42, 0.4), (0.4, 0.55), *smooth([(0.22, 0.62), (0.3, 0.95), (0.16, 1.2), (0.2, 1.32)], 10)]
    )
    bowl = turned(
        f.main, [*smooth([(0.2, 1.3), (0.55, 1.38), (0.78, 1.56)], 8), (0.82, 1.6), (0.74, 1.6), (0.4, 1.45), (0, 1.42)]
    )
    small = turned(
        f.main, [(0.1, 1.4), (0.13, 1.8), *smooth([(0.1, 1.9), (0.3, 1.96), (0.4, 2.08)], 6), (0.36, 2.1), (0, 2.0)]
    )
    top = turned(f.main, smooth([(0.08, 2.0), (0.12, 2.15), (0.04, 2.28), (0.07, 2.36), (0, 2.44)], 10))
    spray = paint("white", "glass", emission=0.15)
    spray = replace(spray, opacity=0.35)
    jets = spun(pipe(spray, [(0.38, 0, 2.08), (0.55, 0, 1.98), (0.66, 0, 1.62)], 0.014, 0.12), 8)
    jets += spun(pipe(spray, [(0.78, 0, 1.6), (1.0, 0, 1.4), (1.14, 0, 0.5)], 0.02, 0.2), 10)
    return [rim, pool, stem, bowl, small, top, turned(water, [(0.74, 1.57), (0, 1.57)]), *jets]


def statue(size: Vector, f: Finish) -> list[Part]:
    """A draped figure on a plinth."""
    plinth = tapered(
        f.second,
        [(0.9, 0.9, 0), (0.9, 0.9, 0.12), (0.74, 0.74, 0.16), (0.7, 0.7, 0.9), (0.84, 0.84, 0.96), (0.84, 0.84, 1.04)],
        radius=0.01,
    )
    lean = 0.06 * (f.chosen(3) - 1)
    form = smooth([(0.3, 1.04), (0.25, 1.35), (0.2, 1.8), (0.24, 2.15), (0.26, 2.36), (0.09, 2.5), (0.07, 2.58)], 18)
    robe = turned(f.main, form, scale=(1.0, 0.72))
    folds = [
        pipe(
            f.main,
            [(0.27 * np.cos(a), 0.2 * np.sin(a), 1.04), (0.17 * np.cos(a + 0.2), 0.13 * np.sin(a + 0.2), 1.9)],
            0.03,
        )
        for a in np.arange(9) * 0.7
    ]
    head = ellipsoid(f.main, (0.1, 0.115, 0.14), (lean, 0.02, 2.7))
    hair = ellipsoid(f.main.shaded(0.9), (0.115, 0.115, 0.13), (lean, -0.03, 2.74))
    up = 2.9 if f.chosen(2) else 1.9
    arm = pipe(f.main, [(0.22, 0, 2.4), (0.36, 0.06, 2.1), (0.3, 0.3, up)], 0.055, 0.1)
    other = pipe(f.main, [(-0.22, 0, 2.4), (-0.34, 0.04, 2.08), (-0.12, 0.24, 1.95)], 0.055, 0.1)
    return [
        plinth,
        robe,
        *folds,
        head,
        hair,
        arm,
        other,
        sign("A.D. 1871", 0.4, 0.16, (0, 0.368, 0.5), "bronze", "black"),
    ]


def flagpole(size: Vector, f: Finish) -> list[Part]:
    pole = turned(
        paint("silver", "brushed"),
        [(0, 0), (0.16, 0), (0.14, 0.1), (0.05, 0.14), (0.03, 6.0), (0.05, 6.02), (0.05, 6.08), (0, 6.12)],
    )
    stripes = replace(f.main, texture="stripes", ink=paint("chalk").colour)
    flag = group(two_sided(cloth(stripes, 1.2, 1.0, (0, 0, 0), 0.5, 0.16)), (0.62, 0, 4.75))
    return [pole, *flag, cable(paint("chalk"), (0.05, 0, 0.9), (0.04, 0, 5.9), 0.0, 0.008)]


def fence_panel(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    if f.main.texture == "wood":
        count = max(6, round(x / 0.16))
        tops = [(0.06, z - 0.07), (0.0, z), (-0.06, z - 0.07)]
        boards = [
            plate(
                f.main.shaded(0.9 + 0.05 * (i % 4)),
                [(-0.06, 0.04), (0.06, 0.04), *tops],
                0.022,
                ((i + 0.5) * x / count - x / 2, 0.03, 0),
            )
            for i in range(count)
        ]
        rails = [box(f.main.shaded(0.8), (x, 0.04, 0.09), (0, 0, h)) for h in (0.2 * z, 0.75 * z)]
        return [
            *boards,
            *rails,
            *(box(f.main.shaded(0.8), (0.09, 0.09, z), (s * (x / 2 - 0.045), -0.02, 0)) for s in (-1, 1)),
        ]
    bars = [
        pipe(f.main, [(u, 0, 0.06), (u, 0, z - 0.06)], 0.012)
        for u in np.linspace(-x / 2 + 0.06, x / 2 - 0.06, round(x / 0.13))
    ]
    spikes = [
        turned(f.main, [(0.022, z - 0.08), (0.012, z - 0.03), (0, z)], (u, 0, 0))
        for u in np.linspace(-x / 2 + 0.06, x / 2 - 0.06, round(x / 0.13))
    ]
    rails = [box(f.main, (x, 0.03, 0.04), (0, 0, h)) for h in (0.12, z - 0.2)]
    return [*bars, *spikes, *rails, *(box(f.main, (0.06, 0.06, z), (s * (x / 2 - 0.03), 0, 0)) for s in (-1, 1))]


def picnic_table(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    tops = [box(f.main, (x, 0.13, 0.04), (0, v, 0.72), 0.008) for v in np.linspace(-0.28, 0.28, 5)]
    seats = [box(f.main, (x, 0.13, 0.04), (0, s * v, 0.43), 0.008) for s in (-1, 1) for v in (0.62, 0.76)]
    legs = [
        pipe(f.main.shaded(0.8), [(s * x * 0.36, t * 0.66, 0), (s * x * 0.36, t * 0.2, 0.72)], 0.045)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    return [
        *tops,
        *seats,
        *legs,
        *(box(f.main.shaded(0.8), (0.05, 1.6, 0.09), (s * x * 0.36, 0, 0.36)) for s in (-1, 1)),
    ]


def parasol(size: Vector, f: Finish) -> list[Part]:
    angle = np.linspace(0, -2 * np.pi, 25)
    rows = []
    for r, z in ((0.0, 2.5), (0.5, 2.38), (1.0, 2.2), (1.45, 1.98), (1.46, 1.84)):
        sag = 0.05 * r * np.abs(np.sin(4 * angle))
        rows.append(np.column_stack([(r - sag) * np.cos(angle), (r - sag) * np.sin(angle), np.full(25, z) - 0.3 * sag]))
    skins = skin(f.main, rows[::-1])
    pole = turned(
        f.second, [(0, 0), (0.3, 0), (0.3, 0.05), (0.06, 0.1), (0.025, 0.12), (0.025, 2.52), (0.04, 2.58), (0, 2.62)]
    )
    ribs = spun(pipe(f.second, [(0, 0, 1.95), (0.8, 0, 2.26)], 0.01), 8)
    return [*skins, pole, *ribs]


def tent(size: Vector, f: Finish) -> list[Part]:
    """A pavilion: four posts under a peaked roof with a hanging edge."""
    posts = [
        pipe(paint("silver", "brushed"), [(s * 1.42, t * 1.42, 0), (s * 1.42, t * 1.42, 2.2)], 0.03)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    ring = np.array([(1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0), (1, 1)], float)
    rows = [
        np.column_stack([ring * r, np.full(9, z)])
        for r, z in ((1.5, 1.95), (1.5, 2.2), (0.8, 2.55), (0.3, 2.95), (0.02, 3.2))
    ]
    return [*posts, *skin(f.main, np.array(rows)[::-1, ::-1])]


def arbour(size: Vector, f: Finish) -> list[Part]:
    """A garden arch with lattice sides and climbing leaves."""
    arch = rounded_path([(-0.65, 0, 0), (-0.65, 0, 2.2), (0.65, 0, 2.2), (0.65, 0, 0)], 0.6)
    parts = [placed(pipe(f.main, arch, 0.03), (0, s * 0.35, 0)) for s in (-1, 1)]
    parts += [
        pipe(f.main, [(*a[:1], -0.35, a[2]), (*a[:1], 0.35, a[2])], 0.015) for a in np.array(rounded_path(arch, 0))[::1]
    ]
    parts += [
        pipe(f.main, [(s * 0.65, -0.35, h), (s * 0.65, 0.35, h)], 0.014)
        for s in (-1, 1)
        for h in np.arange(0.25, 1.9, 0.3)
    ]
    blobs = [
        ((0.2, 0.4, 0.5), (-0.66, 0, 0.9)),
        ((0.2, 0.38, 0.4), (-0.6, 0, 1.75)),
        ((0.5, 0.4, 0.2), (-0.1, 0, 2.25)),
    ]
    return [*parts, *leafy(f, blobs, (0.1, 0.06), 420)]
