"""Machine tools, conveyors, storage of a works.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    bolts,
    circle,
    pipe,
    placed,
    rounded_ring,
    sweep,
    tapered,
    wheel,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, turned
from flymirage_core.worldgen.shapes.fittings import gauge, handwheel
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, IRON, DARK = paint("silver", "brushed"), paint("charcoal", "metal"), paint("black")


def lathe(size: Vector, f: Finish) -> list[Part]:
    base = [tapered(f.main, [(0.5, 0.6, 0), (0.45, 0.5, 0.55)], (s * 0.7, 0, 0), 0.02) for s in (-1, 1)]
    bed = [
        box(f.main, (2.0, 0.45, 0.2), (0, 0, 0.55), 0.02),
        *(box(STEEL, (1.4, 0.05, 0.05), (0.2, t * 0.12, 0.75)) for t in (-1, 1)),
    ]
    head = box(f.main, (0.5, 0.5, 0.5), (-0.72, 0, 0.75), 0.04)
    chuck = placed(
        turned(STEEL, [(0, 0), (0.15, 0), (0.15, 0.1), (0.06, 0.12), (0.06, 0.18), (0, 0.18)]), (-0.47, 0, 1.02), LYING
    )
    work = pipe(paint("bronze", "brushed"), [(-0.35, 0, 1.02), (0.4, 0, 1.02)], 0.04)
    tail = [
        box(f.main, (0.3, 0.25, 0.3), (0.72, 0, 0.78), 0.03),
        pipe(STEEL, [(0.4, 0, 1.02), (0.9, 0, 1.02)], 0.05),
        *handwheel(STEEL, 0.1, (0.92, 0, 1.02), LYING),
    ]
    slide = [
        box(f.second, (0.4, 0.5, 0.12), (0.1, 0.05, 0.78), 0.02),
        box(f.second, (0.16, 0.3, 0.12), (0.1, 0.12, 0.9), 0.01),
        *handwheel(STEEL, 0.09, (0.1, 0.34, 0.82), FACING),
    ]
    dials = [
        *gauge((-0.82, 0.26, 1.1), 0.05),
        *(cylinder(paint(c, emission=0.4), 0.02, 0.03, (u, 0.2, 1.25)) for c, u in (("red", -0.8), ("green", -0.65))),
    ]
    lamp = [
        pipe(DARK, [(-0.6, -0.2, 1.25), (-0.3, -0.15, 1.55), (-0.1, 0.05, 1.4)], 0.015, 0.1),
        ellipsoid(paint("cream", emission=0.6), (0.07, 0.07, 0.05), (-0.1, 0.05, 1.38)),
    ]
    return [*base, *bed, head, chuck, work, *tail, *slide, *dials, *lamp, box(f.second, (1.7, 0.5, 0.03), (0, 0, 0.5))]


def drill_press(size: Vector, f: Finish) -> list[Part]:
    base = tapered(f.main, [(0.5, 0.7, 0), (0.46, 0.66, 0.1)], radius=0.04)
    column = cylinder(STEEL, 0.05, 1.55, (0, -0.2, 0.1))
    table = [
        turned(f.main, [(0, 0.8), (0.22, 0.8), (0.22, 0.85), (0, 0.85)], (0, 0.08, 0)),
        box(f.main, (0.12, 0.2, 0.08), (0, -0.14, 0.78)),
    ]
    head = tapered(f.main, [(0.26, 0.55, 1.3), (0.3, 0.62, 1.42), (0.3, 0.62, 1.6)], radius=0.05)
    cover = tapered(f.main.shaded(0.85), [(0.36, 0.74, 1.6), (0.36, 0.74, 1.72), (0.26, 0.6, 1.78)], radius=0.12)
    motor = cylinder(IRON, 0.11, 0.3, (0, -0.38, 1.28))
    chuck = turned(
        STEEL,
        [(0.0, 0.92), (0.012, 0.93), (0.012, 1.06), (0.035, 1.08), (0.045, 1.2), (0.03, 1.22), (0.03, 1.32)],
        (0, 0.12, 0),
    )
    arms = [
        p
        for a in (0.3, 2.4, 4.5)
        for p in (
            pipe(STEEL, [(0.16, 0.05, 1.45), (0.18, 0.05 + 0.2 * np.cos(a), 1.45 + 0.2 * np.sin(a))], 0.01),
            ellipsoid(DARK, (0.025,) * 3, (0.18, 0.05 + 0.21 * np.cos(a), 1.45 + 0.21 * np.sin(a))),
        )
    ]
    return [
        base,
        column,
        *table,
        head,
        cover,
        motor,
        chuck,
        *arms,
        box(paint("red", emission=0.3), (0.04, 0.02, 0.04), (0, 0.315, 1.5)),
    ]


def robot_arm(size: Vector, f: Finish) -> list[Part]:
    """Six axes, reaching forward; the style poses it."""
    sweepback = (0.25, 0.0, -0.2)[f.chosen(3)]
    shoulder, elbow = np.array([0, 0.0, 0.75]), np.array([0, -sweepback, 1.55])
    wrist = np.add(elbow, (0, 0.75, 0.1))
    base = [
        turned(IRON, [(0, 0), (0.36, 0), (0.36, 0.08), (0.28, 0.1), (0.28, 0.3), (0, 0.3)]),
        turned(f.main, [(0.27, 0.3), (0.27, 0.5), (0.2, 0.6), (0, 0.62)]),
    ]
    joints = [pipe(IRON, [(-0.2, *p[1:]), (0.2, *p[1:])], r) for p, r in ((shoulder, 0.17), (elbow, 0.14))]
    upper = sweep(f.main, rounded_ring(0.2, 0.24, 0.06), [shoulder, elbow], [1.1, 0.85])
    fore = sweep(
        f.main, circle(0.1, 12), [np.add(elbow, (0, -0.18, 0)), np.add(elbow, (0, 0.15, 0.02)), wrist], [1.2, 1.0, 0.62]
    )
    yoke = box(f.main, (0.3, 0.3, 0.36), (0, 0, 0.55), 0.06)
    hand = [
        ellipsoid(IRON, (0.08,) * 3, tuple(wrist)),
        pipe(STEEL, [wrist, np.add(wrist, (0, 0.08, -0.16))], 0.045),
        box(STEEL, (0.2, 0.06, 0.03), tuple(np.add(wrist, (0, 0.09, -0.2)))),
    ]
    fingers = [box(IRON, (0.02, 0.05, 0.14), tuple(np.add(wrist, (s * 0.08, 0.1, -0.34)))) for s in (-1, 1)]
    hose = pipe(
        DARK,
        [np.add(elbow, (0.1, -0.2, 0.05)), np.add(elbow, (0.16, 0.2, 0.2)), np.add(wrist, (0.08, -0.1, 0.05))],
        0.02,
        0.2,
    )
    return [*base, yoke, *joints, upper, fore, *hand, *fingers, hose, *bolts(IRON, 0.32, 8, 0.02, 0.08)]


def conveyor(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    rails = [box(f.main, (x, 0.05, 0.14), (0, s * 0.32, 0.68), 0.008) for s in (-1, 1)]
    belt = [
        box(DARK, (x - 0.08, 0.58, 0.05), (0, 0, 0.74), 0.02),
        *(pipe(IRON, [(s * (x / 2 - 0.06), -0.3, 0.75), (s * (x / 2 - 0.06), 0.3, 0.75)], 0.055) for s in (-1, 1)),
    ]
    rollers = [
        pipe(STEEL, [(u, -0.29, 0.68), (u, 0.29, 0.68)], 0.025) for u in np.arange(-x / 2 + 0.25, x / 2 - 0.2, 0.25)
    ]
    legs = [box(f.main, (0.06, 0.06, 0.68), (u, s * 0.3, 0)) for u in (-x * 0.4, 0, x * 0.4) for s in (-1, 1)]
    ties = [box(f.main, (0.05, 0.6, 0.05), (u, 0, 0.25)) for u in (-x * 0.4, 0, x * 0.4)]
    rng = f.generator()
    cartons = [
        box(
            paint("tan", "paper", seed=i),
            (rng.uniform(0.25, 0.4), rng.uniform(0.3, 0.42), rng.uniform(0.16, 0.3)),
            (-x * 0.36 + i * x * 0.24, 0, 0.79),
            0.008,
        )
        for i in range(4)
        if rng.random() < 0.8
    ]
    motor = box(f.second, (0.3, 0.2, 0.22), (x * 0.32, 0.4, 0.5), 0.04)
    return [*rails, *belt, *rollers, *legs, *ties, *cartons, motor]


def mine_cart(size: Vector, f: Finish) -> list[Part]:
    tub = tapered(
        f.main,
        [(0.5, 0.9, 0.32), (0.86, 1.4, 0.95), (0.9, 1.46, 0.95), (0.9, 1.46, 1.0), (0.78, 1.3, 1.0), (0.7, 1.2, 0.85)],
        radius=0.03,
    )
    ore = [ellipsoid(paint("slate grey", "gravel"), (0.32, 0.55, 0.16), (0, 0, 0.94))]
    bands = [box(IRON, (0.03, 0.06, 0.62), (s * 0.36, y, 0.36), 0.0) for s in (-1, 1) for y in (-0.35, 0.35)]
    chassis = [box(IRON, (0.08, 1.3, 0.1), (s * 0.22, 0, 0.22)) for s in (-1, 1)]
    wheels = [p for s in (-1, 1) for y in (-0.38, 0.38) for p in wheel(IRON, f.second, 0.17, 0.08, (s * 0.33, y, 0.17))]
    return [tub, *ore, *bands, *chassis, *wheels, pipe(IRON, [(0, 0.6, 0.27), (0, 0.75, 0.27)], 0.03)]


def engine_block(size: Vector, f: Finish) -> list[Part]:
    block = tapered(f.main, [(0.6, 0.34, 0.1), (0.7, 0.44, 0.24), (0.7, 0.44, 0.45)], radius=0.03)
    banks = [
        placed(box(f.main.shaded(1.15), (0.68, 0.2, 0.14), (0, 0, 0)), (0, s * 0.16, 0.44), _roll(-s * 0.5))
        for s in (-1, 1)
    ]
    covers = [
        placed(box(f.second, (0.62, 0.15, 0.06), (0, 0, 0.14), 0.02), (0, s * 0.16, 0.44), _roll(-s * 0.5))
        for s in (-1, 1)
    ]
    intake = [
        box(STEEL, (0.4, 0.16, 0.1), (0, 0, 0.52), 0.03),
        turned(DARK, [(0.14, 0.62), (0.16, 0.63), (0.16, 0.7), (0, 0.71)]),
    ]
    pulleys = [
        placed(turned(IRON, [(0, 0), (r, 0), (0.9 * r, 0.02), (r, 0.04), (0, 0.04)]), (0.36, v, z), LYING)
        for v, z, r in ((0, 0.25, 0.11), (0.12, 0.42, 0.07), (-0.13, 0.4, 0.08))
    ]
    exhaust = [
        pipe(paint("rust", "rust"), [(u, s * 0.28, 0.4), (u, s * 0.34, 0.34), (-0.3, s * 0.34, 0.26)], 0.03, 0.05)
        for u in (-0.2, 0.0, 0.2)
        for s in (-1, 1)
    ]
    return [
        block,
        *banks,
        *covers,
        *intake,
        *pulleys,
        *exhaust,
        box(IRON, (0.5, 0.5, 0.1)),
        *bolts(IRON, 0.2, 8, 0.015, 0.45),
    ]


def _roll(angle: float) -> Float:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]])


def pallet_rack(size: Vector, f: Finish) -> list[Part]:
    """Tall storage for pallets: painted uprights, orange beams, loads."""
    x, y, z = size
    rng = f.generator()
    posts = [
        box(f.main, (0.09, 0.09, z), (s * (x / 2 - 0.045), t * (y / 2 - 0.045), 0)) for s in (-1, 1) for t in (-1, 1)
    ]
    lattice = [
        pipe(
            f.main,
            [(s * (x / 2 - 0.045), t * (y / 2 - 0.06), h), (s * (x / 2 - 0.045), -t * (y / 2 - 0.06), h + 0.55)],
            0.015,
        )
        for s in (-1, 1)
        for i, h in enumerate(np.arange(0.1, z - 0.6, 0.55))
        for t in ((-1) ** i,)
    ]
    beam = paint("orange", "enamel")
    parts = [*posts, *lattice]
    levels = np.linspace(0.0, z - 1.0, max(2, round(z / 1.2)))
    for base in levels:
        if base > 0:
            parts += [box(beam, (x - 0.18, 0.05, 0.12), (0, t * (y / 2 - 0.045), base - 0.12)) for t in (-1, 1)]
        for u in (-x / 4, x / 4):
            if rng.random() < 0.85:
                parts += _load(rng, (u, 0.0, float(base)), x / 2 - 0.25, y - 0.12)
    return parts


def _load(rng: np.random.Generator, base: Vector, x: float, y: float) -> list[Part]:
    u, v, b = base
    deck = [box(paint("tan", "wood"), (x, 0.12, 0.025), (u, v + t * (y / 2 - 0.06), b + 0.1)) for t in (-1, 0, 1)]
    deck += [box(paint("tan", "wood").shaded(0.8), (0.1, y, 0.1), (u + t * (x / 2 - 0.05), v, b)) for t in (-1, 0, 1)]
    kind, high = int(rng.integers(3)), float(rng.uniform(0.45, 0.75))
    if kind == 0:
        colour = str(rng.choice(["tan", "caramel", "sand"]))
        return [
            *deck,
            *(
                box(
                    paint(colour, "paper", seed=i + j),
                    (x / 2 - 0.03, y / 2 - 0.03, high / 2 - 0.01),
                    (u + s * x / 4, v + t * y / 4, b + 0.13 + j * high / 2),
                    0.01,
                )
                for i, s in enumerate((-1, 1))
                for t in (-1, 1)
                for j in (0, 1)
            ),
        ]
    if kind == 1:
        return [
            *deck,
            *(
                turned(
                    paint(str(rng.choice(["blue", "green", "red"])), "enamel"),
                    [(0, 0), (0.22, 0), (0.22, 0.6), (0, 0.6)],
                    (u + s * x / 4, v + t * y / 4, b + 0.13),
                )
                for s in (-1, 1)
                for t in (-1, 1)
            ),
        ]
    return [*deck, box(replace(paint("chalk", "fabric")), (x - 0.06, y - 0.06, high), (u, v, b + 0.13), 0.06)]
