"""Sculpture, globes, bowls, books and plants in pots: what makes a room somebody's.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import FACING, crown, hoop, loft, pipe, placed, rounded_ring, sweep, tapered
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.shapes.foliage import BARK, fronds, greenery
from flymirage_core.worldgen.surfaces import Part, Vector

COVERS = ("burgundy", "navy", "forest green", "rust", "chalk", "mustard", "charcoal", "teal")


def sculpture(size: Vector, f: Finish) -> list[Part]:
    """A twisted ribbon, a pierced ring or a bird-like column on a plinth."""
    plinth = tapered(
        f.second,
        [
            (0.42, 0.42, 0),
            (0.42, 0.42, 0.06),
            (0.36, 0.36, 0.09),
            (0.36, 0.36, 0.56),
            (0.4, 0.4, 0.58),
            (0.4, 0.4, 0.62),
        ],
        radius=0.01,
    )
    design = f.chosen(3)
    if design == 0:
        t = np.linspace(0, 1, 28)
        path = np.stack([0.16 * np.sin(4.4 * t) * (1 - 0.4 * t), 0.12 * np.cos(4.4 * t) * (1 - t), 0.62 + 0.75 * t], 1)
        return [plinth, sweep(f.main, rounded_ring(0.16, 0.05, 0.02), path, np.linspace(1.2, 0.25, 28))]
    if design == 1:
        a = np.linspace(0, 2 * np.pi, 33)
        path = np.stack([0.2 * np.cos(a), 0.04 * np.sin(2 * a), 0.98 + 0.26 * np.sin(a)], 1)
        return [
            plinth,
            sweep(f.main, rounded_ring(0.13, 0.1, 0.05), path, 1 + 0.35 * np.sin(a - 0.7)),
            turned(f.main, [(0.09, 0.62), (0.05, 0.72), (0, 0.73)]),
        ]
    form = [(0.1, 0.62), (0.06, 0.72), (0.13, 0.95), (0.09, 1.2), (0.035, 1.35), (0.055, 1.46), (0.02, 1.52), (0, 1.53)]
    wing = sweep(
        f.main,
        rounded_ring(0.04, 0.2, 0.02),
        [(0.05, 0, 0.85), (0.16, -0.04, 1.05), (0.2, -0.1, 1.25)],
        [1.2, 0.8, 0.15],
    )
    return [
        plinth,
        turned(f.main, smooth(form, 26), scale=(1.0, 0.8)),
        wing,
        placed(wing, rotation=np.diag([-1.0, 1.0, 1.0])),
    ]


def fruit_bowl(size: Vector, f: Finish) -> list[Part]:
    bowl = turned(
        f.main,
        [*smooth([(0.06, 0), (0.05, 0.015), (0.12, 0.05), (0.16, 0.1)], 10), (0.153, 0.1), (0.11, 0.055), (0, 0.035)],
    )
    rng = f.generator()
    fruit = []
    for k in range(9):
        ring = 0.085 if k < 6 else 0.035
        spot = (ring * np.cos(k * 1.05), ring * np.sin(k * 1.05), 0.09 if k < 6 else 0.135)
        colour = str(rng.choice(["orange", "red", "moss green", "yellow", "burgundy"]))
        fruit += [
            ellipsoid(paint(colour), (0.04, 0.04, 0.037), spot),
            pipe(BARK, [(*spot[:2], spot[2] + 0.032), (spot[0] + 0.004, spot[1], spot[2] + 0.048)], 0.003),
        ]
    return [bowl, *fruit]


def book_stack(size: Vector, f: Finish) -> list[Part]:
    """Closed books: covers with pale page blocks between them, no two quite straight."""
    x, y, z = size
    rng = f.generator()
    count = max(3, round(z / 0.04))
    high = z / count
    parts = []
    for i in range(count):
        w, d = (x, y) if i == 0 else (x - rng.uniform(0.0, 0.06), y - rng.uniform(0.0, 0.05))
        cover = f.main if i % 3 == 0 else paint(str(rng.choice(COVERS)), seed=i)
        pages = box(paint("ivory", "stripes"), (w - 0.012, d - 0.016, high - 0.008), (0.004, 0, 0.004))
        pages = replace(pages, material=paint("ivory"))
        boards = [box(cover, (w, d, 0.004), (0, 0, h)) for h in (0.0, high - 0.004)]
        spine = box(cover, (w, 0.006, high), (0, d / 2 - 0.003, 0), 0.002)
        label = box(paint("brass"), (w * 0.3, 0.002, high * 0.3), (0, d / 2 + 0.001, high * 0.35))
        yaw = float(rng.uniform(-0.12, 0.12)) * (i > 0)
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        parts += [placed(p, (0, 0, i * high), turn) for p in (pages, *boards, spine, label)]
    return parts


def globe(size: Vector, f: Finish) -> list[Part]:
    foot = turned(
        f.second,
        [(0, 0), *smooth([(0.09, 0), (0.085, 0.012), (0.03, 0.025), (0.014, 0.05), (0.018, 0.08)], 8), (0, 0.08)],
    )
    tilt = np.array([[0.92, 0, 0.4], [0, 1, 0], [-0.4, 0, 0.92]])
    world = replace(f.main, texture="map", detail=0.6)
    ball = placed(ellipsoid(world, (0.14, 0.14, 0.14), (0, 0, 0)), (0, 0, 0.24), tilt)
    arc = [(0.155 * np.cos(a), 0, 0.24 + 0.155 * np.sin(a)) for a in np.linspace(-1.16 - np.pi / 2 + 0.4, 1.16, 15)]
    return [
        foot,
        ball,
        pipe(paint("brass", "brushed"), arc, 0.006),
        *(ellipsoid(paint("brass", "brushed"), (0.012,) * 3, p) for p in (arc[-1], arc[0])),
    ]


def _pot(f: Finish, radius: float, height: float) -> list[Part]:
    form = [
        (0, 0),
        (0.74 * radius, 0),
        (0.94 * radius, 0.82 * height),
        (1.04 * radius, 0.82 * height),
        (1.04 * radius, height),
        (0.9 * radius, height),
        (0.88 * radius, 0.88 * height),
    ]
    if f.chosen(2):
        form = [
            (0, 0),
            *smooth([(0.6 * radius, 0.0), (radius, 0.4 * height), (0.94 * radius, height)], 8),
            (0.84 * radius, height),
            (0.82 * radius, 0.88 * height),
        ]
    return [
        turned(f.main, form),
        turned(paint("chocolate", "soil"), [(0.87 * radius, 0.88 * height), (0, 0.9 * height)]),
    ]


def potted_plant(size: Vector, f: Finish) -> list[Part]:
    """A weeping fig or rubber plant: a thin stem and a head of leaves, or an arching tuft."""
    rng = f.generator()
    x, _, z = size
    high = min(0.36, 0.3 * z)
    pot = _pot(f, 0.3 * x, high)
    green = greenery(f)
    if f.chosen(3) == 2:
        return [*pot, *fronds(green, 16, x * 0.48, 1.2, high * 0.9, rng, 3.4)]
    stems = [
        sweep(
            BARK,
            rounded_ring(0.024, 0.024, 0.01),
            [
                (0, 0, high * 0.9),
                (0.04 * np.cos(a), 0.04 * np.sin(a), 0.5 * z),
                (0.1 * np.cos(a), 0.1 * np.sin(a), 0.75 * z),
            ],
        )
        for a in (0.4, 2.5, 4.6)
    ]
    blobs: list[tuple[Vector, Vector]] = [((0.34 * x, 0.34 * x, 0.2 * z), (0, 0, 0.74 * z))]
    blobs += [
        ((0.22 * x, 0.22 * x, 0.13 * z), (0.24 * x * np.cos(a), 0.24 * x * np.sin(a), (0.58 + 0.07 * k) * z))
        for k, a in enumerate((0.4, 2.5, 4.6))
    ]
    return [*pot, *stems, *crown(green, blobs, (0.13, 0.06), 620, rng, 0.35)]


def small_plant(size: Vector, f: Finish) -> list[Part]:
    """A succulent rosette, a trailing bush or a little fern."""
    rng = f.generator()
    pot = _pot(f, 0.09, 0.13)
    green = greenery(f)
    design = f.chosen(3)
    if design == 0:
        blades = []
        for k in range(24):
            a, lift = k * 2.4, 0.25 + 0.75 * k / 24
            out = np.array([np.cos(a), np.sin(a), 0.0])
            spine = [
                out * 0.02 + [0, 0, 0.12],
                out * (0.1 - 0.06 * lift) + [0, 0, 0.13 + 0.07 * lift],
                out * (0.17 - 0.12 * lift) + [0, 0, 0.14 + 0.16 * lift],
            ]
            blades.append(sweep(green, rounded_ring(0.045, 0.012, 0.005), spine, [0.6, 1.0, 0.08]))
        return [*pot, *blades]
    if design == 1:
        blobs: list[tuple[Vector, Vector]] = [
            ((0.13, 0.13, 0.1), (0, 0, 0.22)),
            ((0.06, 0.06, 0.08), (0.1, 0.03, 0.13)),
            ((0.06, 0.06, 0.07), (-0.08, 0.07, 0.14)),
        ]
        return [*pot, *crown(green, blobs, (0.05, 0.035), 420, rng, 0.7)]
    return [*pot, *fronds(green, 16, 0.13, 1.1, 0.12, rng, 3.0)]


def mantel_clock(size: Vector, f: Finish) -> list[Part]:
    arch = np.array(
        [
            (0.12, 0.0),
            (0.12, 0.2),
            *((0.12 * np.cos(a), 0.2 + 0.1 * np.sin(a)) for a in np.linspace(0.2, np.pi - 0.2, 9)),
            (-0.12, 0.2),
            (-0.12, 0.0),
        ]
    )
    rings = [np.column_stack([arch[::-1, 0], np.full(len(arch), y), arch[::-1, 1]]) for y in (-0.05, 0.05)]
    body = [
        loft(f.main, np.array(rings)),
        tapered(f.main.shaded(0.85), [(0.3, 0.13, -0.03), (0.3, 0.13, -0.01), (0.26, 0.11, 0.0)], radius=0.006),
    ]
    return [*body, *dial(0.085, (0.0, 0.052, 0.19))]


def wall_clock(size: Vector, f: Finish) -> list[Part]:
    rim = placed(
        turned(f.main, [(0, 0), (0.2, 0), (0.2, 0.03), (0.185, 0.045), (0.17, 0.045), (0.168, 0.022)]),
        (0, 0, 0.2),
        FACING,
    )
    return [rim, *dial(0.17, (0.0, 0.024, 0.2))]


def dial(radius: float, centre: Vector) -> list[Part]:
    """A clock's face with twelve marks and two hands."""
    x, y, z = centre
    dark = paint("black")
    marks = []
    for k in range(12):
        a = k * np.pi / 6
        c, s = np.cos(a), np.sin(a)
        turn = np.array([[c, 0, s], [0, 1.0, 0], [-s, 0, c]])
        marks.append(
            placed(box(dark, (0.05 * radius, 0.003, 0.14 * radius), (0, 0, 0.78 * radius)), (x, y + 0.004, z), turn)
        )
    hands = [
        pipe(dark, [(x, y + 0.007, z), (x + r * np.sin(a), y + 0.007, z + r * np.cos(a))], w)
        for a, r, w in ((5.3, 0.5 * radius, 0.03 * radius), (0.9, 0.72 * radius, 0.022 * radius))
    ]
    return [
        placed(turned(paint("chalk"), [(radius, 0), (0, 0.002)]), centre, FACING),
        *marks,
        *hands,
        placed(hoop(paint("brass", "brushed"), radius, 0.04 * radius), centre, FACING),
    ]
