"""Sites and roofs: masts, dishes, catwalks, cranes, air handlers, containers.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    cable,
    frame_of,
    group,
    hoop,
    hull,
    patterned,
    pipe,
    placed,
    sign,
    skin,
    spun,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.shapes.fittings import DARK, HAZARD, IRON, STEEL
from flymirage_core.worldgen.surfaces import Part, Vector


def antenna_mast(size: Vector, f: Finish) -> list[Part]:
    """A lattice mast with aerials and a dish."""
    corner = [(0.3, -0.2), (-0.3, -0.2), (0.0, 0.34)]
    at = [
        np.array([[u * k, v * k, z] for u, v in corner])
        for z, k in zip(np.linspace(0, 3.4, 9), np.linspace(1, 0.35, 9), strict=True)
    ]
    legs = [pipe(f.main, [level[i] for level in at], 0.02) for i in range(3)]
    braces = [pipe(f.main, [a[i], b[(i + 1) % 3]], 0.009) for a, b in pairwise(at) for i in range(3)]
    rings = [pipe(f.main, [*level, level[0]], 0.009) for level in at[1:]]
    top = [
        pipe(f.main, [(0, 0, 3.3), (0, 0, 4.0)], 0.018),
        *(
            box(paint("chalk"), (0.09, 0.05, 0.6), (0.16 * np.cos(a), 0.16 * np.sin(a), 3.1), 0.02)
            for a in (0.5, 2.6, 4.7)
        ),
    ]
    dish = [
        placed(turned(paint("white"), smooth([(0, 0), (0.12, 0.02), (0.22, 0.08)], 5)), (0, 0.2, 2.4), FACING),
        ellipsoid(paint("red", emission=1.5), (0.04,) * 3, (0, 0, 3.97)),
    ]
    return [*legs, *braces, *rings, *top, *dish, box(paint("light grey", "concrete"), (0.8, 0.8, 0.1))]


def satellite_dish(size: Vector, f: Finish) -> list[Part]:
    tilt = np.array([[1.0, 0, 0], [0, 0.5, 0.866], [0, -0.866, 0.5]])
    form = [(0, 0), *((r, 0.55 * r * r) for r in np.linspace(0.08, 0.42, 6))]
    inside = placed(turned(f.main, [*form[::-1]]), (0, 0.05, 0.6), tilt)
    outside = placed(turned(f.main.shaded(0.85), form), (0, 0.045, 0.595), tilt)
    tip = np.array([0, 0.05, 0.6]) + tilt @ np.array([0, 0, 0.42])
    arm = [
        pipe(IRON, [np.array([0, 0.05, 0.6]) + tilt @ np.array([0, 0.4, 0.1]), tip], 0.014),
        placed(cylinder(DARK, 0.04, 0.1), tip, tilt),
    ]
    stand = [
        pipe(STEEL, [(0, -0.1, 0), (0, -0.1, 0.5), (0, 0.02, 0.6)], 0.025, 0.06),
        turned(IRON, [(0, 0), (0.2, 0), (0.2, 0.02), (0, 0.02)], (0, -0.1, 0)),
    ]
    return [inside, outside, *arm, *stand]


def catwalk(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    deck = z - 1.1
    grate = box(patterned("light grey", "grille", "charcoal", 0.4), (x, y - 0.06, 0.04), (0, 0, deck - 0.04))
    beams = [box(f.main, (x, 0.06, 0.16), (0, s * (y / 2 - 0.03), deck - 0.18)) for s in (-1, 1)]
    posts = [
        box(f.main, (0.09, 0.09, deck - 0.1), (s * (x / 2 - 0.2), t * (y / 2 - 0.08), 0))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    rails = [
        pipe(f.main, [(-x / 2, t * (y / 2 - 0.03), deck + h), (x / 2, t * (y / 2 - 0.03), deck + h)], 0.02)
        for t in (-1, 1)
        for h in (0.55, 1.08)
    ]
    rails += [
        pipe(f.main, [(u, t * (y / 2 - 0.03), deck), (u, t * (y / 2 - 0.03), deck + 1.08)], 0.018)
        for t in (-1, 1)
        for u in np.linspace(-x / 2 + 0.03, x / 2 - 0.03, max(3, round(x / 0.8)))
    ]
    braces = [
        pipe(
            f.main,
            [(s * (x / 2 - 0.2), t * (y / 2 - 0.08), deck - 0.7), (s * (x / 2 - 0.8), t * (y / 2 - 0.08), deck - 0.1)],
            0.025,
        )
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    toe = [box(HAZARD, (x, 0.012, 0.1), (0, s * (y / 2 - 0.01), deck)) for s in (-1, 1)]
    return [grate, *beams, *posts, *rails, *braces, *toe]


def gantry_crane(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size

    def i_beam(length: float, high: float) -> list[Part]:
        return [box(f.main, (length, 0.26, 0.03), (0, 0, h)) for h in (0.0, high - 0.03)] + [
            box(f.main, (length, 0.03, high), (0, 0, 0))
        ]

    bridge = group(i_beam(x, 0.36), (0, 0, z - 0.36))
    legs = [
        pipe(f.main, [(s * (x / 2 - 0.25), t * 0.7, 0.15), (s * (x / 2 - 0.35), t * 0.14, z - 0.36)], 0.06)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    feet = [box(f.main, (0.2, 1.6, 0.14), (s * (x / 2 - 0.25), 0, 0.1), 0.02) for s in (-1, 1)]
    wheels = [
        pipe(DARK, [(s * (x / 2 - 0.25) - 0.04, t * 0.66, 0.08), (s * (x / 2 - 0.25) + 0.04, t * 0.66, 0.08)], 0.08)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    u = (-0.3, 0.1, 0.4)[f.chosen(3)]
    trolley = [
        box(paint("red", "enamel"), (0.4, 0.36, 0.26), (u, 0, z - 0.66), 0.03),
        cable(DARK, (u, 0, z - 0.66), (u, 0, 1.5), 0.0, 0.012),
    ]
    hook = [
        box(HAZARD, (0.16, 0.1, 0.2), (u, 0, 1.35), 0.02),
        pipe(IRON, [(u, 0, 1.36), (u, 0, 1.26), (u + 0.07, 0, 1.2), (u, 0, 1.12), (u - 0.07, 0, 1.2)], 0.02, 0.06),
    ]
    return [
        *bridge,
        *legs,
        *feet,
        *wheels,
        *trolley,
        *hook,
        sign("SWL 2 t", 0.6, 0.24, (-x * 0.28, 0.02, z - 0.3), "yellow"),
    ]


def vent_unit(size: Vector, f: Finish) -> list[Part]:
    """A rooftop air handler: louvred body, a fan on top, a bent duct."""
    body = box(f.main, (1.5, 0.9, 0.85), (0, 0, 0.12), 0.015)
    louvres = [
        box(patterned("light grey", "grille", "charcoal", 0.4), (0.6, 0.012, 0.55), (s * 0.36, 0.455, 0.28))
        for s in (-1, 1)
    ]
    top = [
        turned(f.second, [(0.34, 0.97), (0.34, 1.1), (0.3, 1.1), (0.3, 1.0), (0, 1.0)], (-0.3, 0, 0)),
        *(placed(p, (-0.3, 0, 1.05)) for p in spun(box(DARK, (0.28, 0.1, 0.012), (0.15, 0, 0)), 5)),
        *(hoop(STEEL, r, 0.006, (-0.3, 0, 1.1)) for r in (0.1, 0.2, 0.3)),
    ]
    duct = hull(STEEL, [(0.0, 0.4, 0.9, 1.28), (-0.5, 0.4, 0.9, 1.28)], 0.02)
    bend = [placed(duct, (0.42, 0.1, 0)), box(STEEL, (0.46, 0.05, 0.44), (0.42, -0.4, 0.87))]
    feet = [box(IRON, (0.1, 0.9, 0.12), (s * 0.6, 0, 0)) for s in (-1, 1)]
    return [
        body,
        *louvres,
        *top,
        *bend,
        *feet,
        *(box(f.main.shaded(0.8), (0.02, 0.92, 0.86), (u, 0, 0.12)) for u in (0.0,)),
    ]


def air_conditioner(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.95, 0.4, 0.72), (0, 0, 0.08), 0.02)
    ring = placed(
        turned(f.main.shaded(0.9), [(0.3, 0.0), (0.31, 0.03), (0.27, 0.03), (0.27, 0.0)]), (-0.12, 0.2, 0.45), FACING
    )
    dark = placed(turned(DARK, [(0.27, 0.004), (0, 0.004)]), (-0.12, 0.2, 0.45), FACING)
    grid = [placed(hoop(STEEL, r, 0.005), (-0.12, 0.225, 0.45), FACING) for r in (0.07, 0.14, 0.21)]
    bars = [
        placed(
            pipe(STEEL, [(0, 0, 0), (0.28, 0, 0)], 0.004),
            (-0.12, 0.225, 0.45),
            FACING @ np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]),
        )
        for a in np.arange(10) * 0.628
    ]
    blades = [
        placed(
            box(IRON, (0.22, 0.08, 0.01), (0.13, 0, 0)),
            (-0.12, 0.208, 0.45),
            FACING @ np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]),
        )
        for a in np.arange(4) * 1.57
    ]
    feet = [box(IRON, (0.06, 0.45, 0.08), (s * 0.35, 0, 0)) for s in (-1, 1)]
    return [
        body,
        ring,
        dark,
        *blades,
        *grid,
        *bars,
        *feet,
        box(patterned("light grey", "grille", "charcoal", 0.4), (0.2, 0.01, 0.4), (0.34, 0.203, 0.25)),
    ]


def work_light(size: Vector, f: Finish) -> list[Part]:
    legs = spun(pipe(f.main, [(0, 0, 0.75), (0.3, 0, 0.0)], 0.014), 3, 0.5)
    pole = pipe(f.main, [(0, 0, 0.4), (0, 0, 1.6)], 0.018)
    bar = pipe(f.main, [(-0.26, 0, 1.6), (0.26, 0, 1.6)], 0.016)
    lamps = [
        p
        for s in (-1, 1)
        for p in (
            box(f.main, (0.26, 0.1, 0.2), (s * 0.17, 0.04, 1.6), 0.02),
            box(paint("white", emission=2.2), (0.22, 0.012, 0.16), (s * 0.17, 0.093, 1.62)),
        )
    ]
    cage = [box(DARK, (0.006, 0.01, 0.18), (s * 0.17 + u, 0.105, 1.61)) for s in (-1, 1) for u in (-0.06, 0, 0.06)]
    return [*legs, pole, bar, *lamps, *cage]


def shipping_container(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    u = np.linspace(-y / 2 + 0.1, y / 2 - 0.1, int(y / 0.14) * 2 + 1)
    wave = np.where(np.arange(len(u)) % 4 < 2, 0.0, 0.035)
    steel = replace(f.main, texture="rust" if f.main.texture == "rust" else "enamel")
    sides = [
        placed(
            skin(
                steel,
                [
                    np.column_stack([s * (x / 2 - 0.05 + wave - 0.035), u[::-s], np.full(len(u), h)])
                    for h in (z - 0.12, 0.15)
                ],
            )[k]
        )
        for s in (-1, 1)
        for k in (0, 1)
    ]
    frame = frame_of(steel.shaded(0.85), (x, y, z), 0.12)
    doors = [box(steel, (x / 2 - 0.14, 0.05, z - 0.3), (s * (x / 4 - 0.05), y / 2 - 0.06, 0.15)) for s in (-1, 1)]
    rods = [
        pipe(STEEL, [(v, y / 2 - 0.02, 0.12), (v, y / 2 - 0.02, z - 0.12)], 0.018) for v in (-0.85, -0.3, 0.3, 0.85)
    ]
    grips = [box(STEEL, (0.2, 0.03, 0.05), (v, y / 2 - 0.01, 1.1)) for v in (-0.75, -0.2, 0.2, 0.75)]
    rest = [
        box(steel, (x - 0.2, 0.05, z - 0.2), (0, -y / 2 + 0.05, 0.1)),
        box(steel.shaded(1.05), (x - 0.2, y - 0.2, 0.03), (0, 0, z - 0.05)),
        box(IRON, (x - 0.2, y - 0.2, 0.05), (0, 0, 0.06)),
    ]
    name = [sign("FMLU 204817", 0.9, 0.16, (0.55, y / 2 - 0.03, z - 0.5), "white", "black")]
    return [*sides, *frame, *doors, *rods, *grips, *rest, *name]
