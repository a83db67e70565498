"""Process plant: vessels, exchangers, boilers, pipework.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    hoop,
    patterned,
    pipe,
    placed,
    rounded_ring,
    sign,
    spun,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, smooth, turned
from flymirage_core.worldgen.shapes.fittings import flange, gauge, handwheel
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, IRON, DARK = paint("silver", "brushed"), paint("charcoal", "metal"), paint("black")


def pressure_vessel(size: Vector, f: Finish) -> list[Part]:
    dome = [
        (0, 0.45),
        *smooth([(0.3, 0.48), (0.5, 0.6), (0.56, 0.8)], 5),
        (0.56, 2.4),
        *smooth([(0.56, 2.4), (0.5, 2.6), (0.3, 2.72), (0.1, 2.75)], 5),
        (0, 2.75),
    ]
    legs = spun(box(f.second, (0.08, 0.08, 0.75), (0.46, 0, 0)), 4, 0.78)
    man = [
        placed(
            turned(f.main, [(0.0, 0.0), (0.2, 0.0), (0.2, 0.1), (0.25, 0.1), (0.25, 0.15), (0, 0.17)]),
            (0, 0.5, 1.3),
            FACING,
        )
    ]
    top = [cylinder(f.main, 0.09, 0.2, (0, 0, 2.75)), *flange(f.main, 0.09, (0, 0, 2.95))]
    side = [
        pipe(f.second, [(0.4, 0, 2.5), (0.75, 0, 2.5), (0.75, 0, 0.2)], 0.045, 0.12),
        *flange(f.second, 0.045, (0.75, 0, 1.2)),
    ]
    seams = [hoop(f.main.shaded(0.85), 0.56, 0.012, (0, 0, z)) for z in (0.85, 1.6, 2.35)]
    return [
        turned(f.main, dome),
        *legs,
        *man,
        *top,
        *side,
        *seams,
        *gauge((-0.2, 0.58, 2.0)),
        sign("T-204", 0.3, 0.16, (0.05, 0.575, 1.75), "chalk"),
    ]


def heat_exchanger(size: Vector, f: Finish) -> list[Part]:
    shell = pipe(f.main, [(-0.9, 0, 0.75), (0.9, 0, 0.75)], 0.3)
    ends = [
        placed(
            turned(
                f.second,
                [(0.3, 0), (0.38, 0), (0.38, 0.08), (0.3, 0.08), *smooth([(0.3, 0.1), (0.24, 0.25), (0, 0.3)], 5)],
            ),
            (s * 0.88, 0, 0.75),
            LYING if s > 0 else np.diag([-1.0, -1.0, 1.0]) @ LYING,
        )
        for s in (-1, 1)
    ]
    saddles = [tapered(f.second, [(0.16, 0.6, 0), (0.16, 0.5, 0.5)], (s * 0.55, 0, 0), 0.01) for s in (-1, 1)]
    nozzles = [
        p
        for u, low in ((-0.65, False), (0.65, True))
        for p in (cylinder(f.main, 0.09, 0.25, (u, 0, 0.98)), *flange(f.main, 0.09, (u, 0, 1.2)))
    ]
    bands = [placed(hoop(f.main.shaded(0.8), 0.305, 0.012), (u, 0, 0.75), LYING) for u in (-0.45, 0, 0.45)]
    return [shell, *ends, *saddles, *nozzles, *bands, sign("E-101", 0.3, 0.14, (0, 0.312, 0.7), "chalk")]


def boiler(size: Vector, f: Finish) -> list[Part]:
    shell = placed(
        turned(f.main, [(0, -0.75), (0.55, -0.75), (0.58, -0.7), (0.58, 0.72), (0, 0.72)]), (0, 0, 0.85), FACING
    )
    door = placed(turned(f.second, [(0, 0), (0.42, 0), (0.42, 0.05), (0.3, 0.08), (0, 0.1)]), (0, 0.72, 0.85), FACING)
    burner = [
        placed(
            turned(paint("red", "enamel"), [(0, 0), (0.17, 0), (0.17, 0.22), (0.1, 0.28), (0, 0.28)]),
            (0, 0.8, 0.75),
            FACING,
        )
    ]
    stack = [cylinder(STEEL, 0.13, 0.8, (0, -0.4, 1.4)), hoop(STEEL, 0.14, 0.02, (0, -0.4, 1.75))]
    skid = [box(f.second, (0.12, 1.5, 0.3), (s * 0.4, 0, 0)) for s in (-1, 1)]
    top = [
        pipe(f.second, [(0.25, 0.2, 1.35), (0.25, 0.2, 1.75), (0.62, 0.2, 1.75), (0.62, 0.2, 0.1)], 0.04, 0.1),
        *handwheel(paint("red"), 0.1, (0.25, 0.2, 1.9)),
    ]
    panel = box(paint("light grey", "enamel"), (0.3, 0.2, 0.5), (-0.55, 0.5, 1.1), 0.02)
    return [shell, door, *burner, *stack, *skid, *top, panel, *gauge((-0.2, 0.75, 1.25)), *gauge((0.2, 0.75, 1.25))]


def compressor(size: Vector, f: Finish) -> list[Part]:
    vessel = placed(
        turned(
            f.main,
            [
                (0, -0.65),
                *smooth([(0.12, -0.64), (0.26, -0.52)], 4),
                (0.26, 0.52),
                *smooth([(0.26, 0.52), (0.12, 0.64)], 4),
                (0, 0.65),
            ],
        ),
        (0, 0, 0.4),
        LYING,
    )
    feet = [box(f.second, (0.06, 0.4, 0.2), (s * 0.4, 0, 0)) for s in (-1, 1)]
    plate = box(f.second, (1.0, 0.42, 0.03), (0, 0, 0.65))
    motor = placed(
        turned(IRON, [(0, -0.2), (0.13, -0.2), (0.15, -0.16), (0.15, 0.16), (0.13, 0.2), (0, 0.2)]),
        (-0.3, 0, 0.84),
        FACING,
    )
    fins = [placed(hoop(IRON, 0.155, 0.006), (-0.3, y, 0.84), FACING) for y in np.linspace(-0.14, 0.14, 6)]
    head = [
        box(f.main.shaded(0.8), (0.2, 0.2, 0.24), (0.25, 0, 0.68), 0.02),
        *(box(IRON, (0.24, 0.24, 0.012), (0.25, 0, 0.9 + 0.03 * i)) for i in range(5)),
    ]
    belt = [
        placed(turned(DARK, [(0.2, 0), (0.22, 0), (0.22, 0.04), (0.2, 0.04)]), (u, 0.22, 0.84), FACING) for u in (0.22,)
    ]
    guard = [box(patterned("charcoal", "grille", "black", 0.4), (0.82, 0.05, 0.36), (0, 0.26, 0.68), 0.02)]
    line = [pipe(STEEL, [(0.35, 0, 1.0), (0.5, 0, 1.0), (0.5, 0, 0.6)], 0.02, 0.06)]
    return [vessel, *feet, plate, motor, *fins, *head, *belt, *guard, *line, *gauge((0.5, 0.1, 0.78), 0.05)]


def valve_station(size: Vector, f: Finish) -> list[Part]:
    runs = [pipe(f.main, [(-0.7, 0, z), (0.7, 0, z)], 0.07) for z in (0.45, 0.95)]
    risers = [pipe(f.main, [(u, 0, 0), (u, 0, 0.95)], 0.055) for u in (-0.5, 0.5)]
    parts = [*runs, *risers]
    for u, z in ((-0.2, 0.45), (0.25, 0.95), (0.0, 0.95)):
        parts += [
            ellipsoid(f.second, (0.12, 0.12, 0.12), (u, 0, z)),
            pipe(STEEL, [(u, 0.05, z), (u, 0.22, z)], 0.02),
            *handwheel(paint("red", "enamel"), 0.12, (u, 0.22, z), FACING),
        ]
        parts += [p for s in (-1, 1) for p in flange(f.second, 0.07, (u + s * 0.13, 0, z), LYING)]
    legs = [box(IRON, (0.06, 0.3, 0.38), (u, 0, 0)) for u in (-0.62, 0.62)]
    return [*parts, *legs, *gauge((-0.35, 0.1, 1.12)), pipe(STEEL, [(-0.35, 0.05, 0.95), (-0.35, 0.08, 1.08)], 0.012)]


def centrifuge(size: Vector, f: Finish) -> list[Part]:
    body = turned(f.main, [(0, 0.1), (0.42, 0.1), (0.46, 0.16), (0.46, 0.8), (0.42, 0.86), (0.42, 0.9), (0, 0.9)])
    lid = turned(
        f.main.shaded(1.1),
        [(0.46, 0.88), *smooth([(0.46, 0.92), (0.36, 1.04), (0.14, 1.1)], 6), (0.08, 1.12), (0, 1.12)],
    )
    feet = spun(turned(IRON, [(0, 0), (0.07, 0), (0.05, 0.05), (0.04, 0.14), (0, 0.14)], (0.34, 0, 0)), 4, 0.78)
    clamps = spun(box(IRON, (0.06, 0.05, 0.12), (0.48, 0, 0.82), 0.01), 6)
    panel = [
        box(paint("charcoal"), (0.34, 0.1, 0.26), (0, 0.46, 0.48), 0.02, 0.2),
        picture(replace(paint("teal", "screen", 0.6, 0.3)), 0.2, 0.12, (0, 0.5, 0.56)),
    ]
    pipes = [pipe(STEEL, [(0.1, 0, 1.08), (0.1, 0, 1.2), (0.4, -0.2, 1.2), (0.48, -0.24, 0.5)], 0.025, 0.08)]
    return [
        body,
        lid,
        *feet,
        *clamps,
        *panel,
        *pipes,
        hoop(STEEL, 0.465, 0.015, (0, 0, 0.5)),
        sign("CAUTION|ROTOR", 0.28, 0.16, (0, 0.465, 0.22), "yellow"),
    ]


def mixing_vat(size: Vector, f: Finish) -> list[Part]:
    shell = turned(
        f.main, [(0.1, 0.35), (0.58, 0.5), (0.58, 1.2), (0.62, 1.2), (0.62, 1.24), (0.54, 1.24), (0.54, 1.05)]
    )
    liquid = turned(paint(("olive", "cream", "burgundy")[f.chosen(3)], "water"), [(0.54, 1.08), (0, 1.08)])
    legs = spun(pipe(f.main, [(0.5, 0, 0), (0.5, 0, 0.7)], 0.035), 4, 0.78)
    bridge = [
        box(f.second, (1.2, 0.14, 0.08), (0, 0, 1.24)),
        cylinder(f.second, 0.11, 0.3, (0, 0, 1.3)),
        cylinder(STEEL, 0.025, 0.5, (0, 0, 0.8)),
    ]
    outlet = [
        pipe(f.main, [(0, 0, 0.36), (0, 0, 0.2), (0, 0.4, 0.2)], 0.045, 0.08),
        *handwheel(paint("red"), 0.07, (0, 0.25, 0.32)),
    ]
    bands = [hoop(f.main.shaded(0.85), 0.585, 0.012, (0, 0, z)) for z in (0.6, 0.95)]
    return [shell, liquid, *legs, *bridge, *outlet, *bands]


def hopper(size: Vector, f: Finish) -> list[Part]:
    body = tapered(
        f.main,
        [
            (0.26, 0.26, 0.75),
            (1.2, 1.2, 1.6),
            (1.2, 1.2, 2.1),
            (1.3, 1.3, 2.1),
            (1.3, 1.3, 2.16),
            (1.12, 1.12, 2.16),
            (1.0, 1.0, 1.7),
        ],
        radius=0.02,
    )
    legs = [box(f.second, (0.09, 0.09, 1.7), (s * 0.55, t * 0.55, 0)) for s in (-1, 1) for t in (-1, 1)]
    braces = [
        pipe(f.second, [(s * 0.55, t * 0.55, 0.2), (-s * 0.55, t * 0.55, 1.0)], 0.025) for s in (-1, 1) for t in (-1, 1)
    ]
    grain = ellipsoid(paint("mustard", "gravel"), (0.55, 0.55, 0.3), (0, 0, 1.86))
    gate = [box(IRON, (0.4, 0.4, 0.08), (0, 0, 0.68)), pipe(IRON, [(0.15, 0, 0.72), (0.5, 0, 0.72)], 0.02)]
    return [body, *legs, *braces, grain, *gate]


def liquid_tote(size: Vector, f: Finish) -> list[Part]:
    """A plastic tank in a wire cage on a pallet."""
    tank = tapered(
        replace(f.main, opacity=0.97),
        [(1.08, 0.88, 0.16), (1.1, 0.9, 0.2), (1.1, 0.9, 0.98), (0.9, 0.7, 1.04)],
        radius=0.12,
    )
    cap = turned(paint("red"), [(0, 1.02), (0.12, 1.02), (0.12, 1.1), (0, 1.1)])
    bars = [
        pipe(STEEL, np.vstack([r, r[:1]]), 0.01)
        for r in (np.column_stack([rounded_ring(1.16, 0.96, 0.08), np.full(12, z)]) for z in np.linspace(0.2, 0.98, 6))
    ]
    bars += [
        pipe(STEEL, [(u, s * 0.48, 0.14), (u, s * 0.48, 0.98)], 0.01)
        for u in np.linspace(-0.48, 0.48, 7)
        for s in (-1, 1)
    ]
    bars += [
        pipe(STEEL, [(s * 0.58, v, 0.14), (s * 0.58, v, 0.98)], 0.01)
        for v in np.linspace(-0.36, 0.36, 5)
        for s in (-1, 1)
    ]
    pallet = [box(IRON, (1.2, 0.12, 0.04), (0, v, 0.1)) for v in (-0.42, 0, 0.42)] + [
        box(IRON, (0.1, 1.0, 0.1), (u, 0, 0)) for u in (-0.52, 0, 0.52)
    ]
    tap = [pipe(DARK, [(0, 0.4, 0.24), (0, 0.54, 0.24)], 0.04), box(paint("blue"), (0.12, 0.03, 0.03), (0, 0.53, 0.29))]
    return [tank, cap, *bars, *pallet, *tap, sign("1000 L", 0.3, 0.22, (-0.2, 0.492, 0.55), "chalk")]
