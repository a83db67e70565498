"""Small things of kitchens, counters and workbenches.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    bolts,
    circle,
    hoop,
    loft,
    mirrored,
    patterned,
    pipe,
    placed,
    rounded_ring,
    sign,
    spun,
    sweep,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, smooth, turned
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")
WOOD = paint("walnut brown", "wood")
BACK_TILT = np.array([[1.0, 0, 0], [0, 0.96, 0.28], [0, -0.28, 0.96]]).T


def toaster(size: Vector, f: Finish) -> list[Part]:
    body = tapered(
        f.main, [(0.28, 0.17, 0.015), (0.29, 0.18, 0.06), (0.28, 0.16, 0.18), (0.25, 0.13, 0.195)], radius=0.05
    )
    slots = [box(DARK, (0.2, 0.028, 0.004), (0, v, 0.194)) for v in (-0.03, 0.03)]
    bread = [
        tapered(paint("caramel", "soil"), [(0.12, 0.016, 0.12), (0.13, 0.018, 0.23)], (0, v, 0), 0.01)
        for v in (-0.03, 0.03)
    ]
    return [
        body,
        *slots,
        *bread,
        box(DARK, (0.012, 0.05, 0.02), (0.148, 0, 0.13), 0.004),
        box(DARK, (0.26, 0.15, 0.02)),
        placed(turned(DARK, [(0, 0), (0.014, 0), (0.012, 0.015), (0, 0.015)]), (0.142, 0.04, 0.07), LYING),
    ]


def coffee_machine(size: Vector, f: Finish) -> list[Part]:
    body = [
        tapered(f.main, [(0.32, 0.16, 0), (0.32, 0.16, 0.42)], (0, -0.1, 0), 0.03),
        tapered(f.main, [(0.32, 0.34, 0.28), (0.32, 0.34, 0.4), (0.3, 0.3, 0.42)], radius=0.03),
        box(f.main, (0.32, 0.36, 0.05), (0, 0, 0), 0.015),
    ]
    grid = box(patterned("silver", "grille", "black", 0.3), (0.26, 0.16, 0.006), (0, 0.08, 0.05))
    group_ = [
        p
        for s in (-0.07, 0.07)
        for p in (
            turned(STEEL, [(0, 0.22), (0.03, 0.22), (0.035, 0.28), (0, 0.28)], (s, 0.08, 0)),
            pipe(DARK, [(s, 0.1, 0.245), (s, 0.22, 0.235)], 0.011),
            turned(WHITE, [(0, 0.058), (0.022, 0.058), (0.034, 0.115), (0.03, 0.115), (0, 0.1)], (s, 0.08, 0)),
        )
    ]
    face = [
        *(
            placed(cylinder(paint(c, emission=0.5), 0.01, 0.01), (u, 0.168, 0.35), FACING)
            for c, u in (("red", 0.1), ("green", 0.13))
        ),
        pipe(STEEL, [(0.14, 0.15, 0.3), (0.15, 0.18, 0.14)], 0.006),
        *(
            turned(WHITE, [(0, 0.42), (0.025, 0.42), (0.034, 0.465), (0.03, 0.465), (0, 0.44)], (u, -0.05, 0))
            for u in (-0.1, -0.03, 0.04)
        ),
    ]
    return [*body, grid, *group_, *face]


def teapot(size: Vector, f: Finish) -> list[Part]:
    body = turned(f.main, smooth([(0, 0), (0.05, 0), (0.085, 0.05), (0.08, 0.09), (0.05, 0.125), (0.045, 0.13)], 12))
    lid = turned(
        f.main,
        [
            *smooth([(0.048, 0.13), (0.035, 0.148), (0.012, 0.153)], 5),
            (0.008, 0.158),
            (0.016, 0.17),
            (0.01, 0.18),
            (0, 0.182),
        ],
    )
    spout = sweep(f.main, circle(1.0, 10), rounded_spout(), [0.022, 0.018, 0.013, 0.012])
    handle = pipe(f.main, [(-0.07, 0, 0.11), (-0.13, 0, 0.115), (-0.13, 0, 0.045), (-0.078, 0, 0.04)], 0.008, 0.03)
    return [body, lid, spout, handle]


def rounded_spout() -> list[Vector]:
    return [(0.07, 0, 0.045), (0.1, 0, 0.06), (0.115, 0, 0.1), (0.135, 0, 0.13)]


def mug(size: Vector, f: Finish) -> list[Part]:
    body = turned(f.main, [(0, 0), (0.036, 0), (0.04, 0.004), (0.042, 0.095), (0.038, 0.095), (0.037, 0.08)])
    drink = turned(paint("chocolate"), [(0.038, 0.08), (0, 0.08)])
    return [
        body,
        drink,
        pipe(f.main, [(0.039, 0, 0.08), (0.068, 0, 0.078), (0.066, 0, 0.03), (0.039, 0, 0.022)], 0.005, 0.02),
    ]


def plate_stack(size: Vector, f: Finish) -> list[Part]:
    form = [(0, 0), (0.07, 0), (0.08, 0.006), (0.13, 0.02), (0.13, 0.024), (0.08, 0.011), (0, 0.009)]
    plates = [turned(f.main.shaded(0.94 + 0.06 * (i % 2)), form, (0.002 * (i % 3), 0, 0.014 * i)) for i in range(6)]
    return [
        *plates,
        turned(
            f.main, [*smooth([(0.03, 0.085), (0.06, 0.1), (0.075, 0.13)], 5), (0.072, 0.132), (0.055, 0.11), (0, 0.1)]
        ),
    ]


def jar(size: Vector, f: Finish) -> list[Part]:
    body = turned(f.main, smooth([(0, 0), (0.055, 0), (0.07, 0.03), (0.07, 0.14), (0.05, 0.17), (0.048, 0.18)], 12))
    lid = turned(f.second, [(0.052, 0.175), (0.054, 0.2), (0.045, 0.206), (0.012, 0.208), (0.016, 0.22), (0, 0.222)])
    words = ("TEA", "SUGAR", "RICE", "FLOUR", "SALT")[f.generator().integers(5)]
    return [body, lid, sign(words, 0.07, 0.05, (0, 0.071, 0.07), "chalk")]


def tray(size: Vector, f: Finish) -> list[Part]:
    base = [
        box(f.main, (0.42, 0.3, 0.01)),
        *(box(f.main, (0.42, 0.012, 0.04), (0, s * 0.144, 0.006), 0.004) for s in (-1, 1)),
        *mirrored(box(f.main, (0.012, 0.28, 0.05), (0.204, 0, 0.006), 0.004)),
    ]
    cups = [
        p
        for u, v in ((-0.1, 0.04), (0.08, -0.05))
        for p in (
            turned(WHITE, [(0, 0.012), (0.05, 0.014), (0.052, 0.02), (0, 0.016)], (u, v, 0)),
            turned(WHITE, [(0, 0.018), (0.02, 0.018), (0.035, 0.06), (0.032, 0.06), (0, 0.045)], (u, v, 0)),
        )
    ]
    return [*base, *cups]


def cake_stand(size: Vector, f: Finish) -> list[Part]:
    foot = turned(
        f.main,
        [*smooth([(0.08, 0), (0.05, 0.015), (0.018, 0.05), (0.02, 0.09)], 8), (0.15, 0.1), (0.152, 0.112), (0, 0.108)],
    )
    cake = [
        turned(
            paint(("blush", "cream", "chocolate")[f.chosen(3)]),
            [(0, 0.11), (0.11, 0.11), (0.112, 0.18), (0.104, 0.19), (0, 0.19)],
        ),
        hoop(paint("white"), 0.104, 0.012, (0, 0, 0.19)),
        *spun(ellipsoid(paint("red"), (0.014,) * 3, (0.085, 0, 0.2)), 8),
        hoop(paint("white"), 0.113, 0.009, (0, 0, 0.118)),
    ]
    return [foot, *cake]


def bread_basket(size: Vector, f: Finish) -> list[Part]:
    rows = [
        np.column_stack([rounded_ring(w, d, 0.06, 4), np.full(16, z)])
        for w, d, z in ((0.3, 0.2, 0), (0.38, 0.28, 0.08), (0.4, 0.3, 0.085), (0.36, 0.26, 0.085), (0.3, 0.2, 0.03))
    ]
    weave = replace(f.main, texture="wicker", detail=0.6)
    crust = paint("caramel", "soil", seed=f.seed % 97)
    loaves = [
        sweep(
            crust,
            circle(1.0, 10),
            [(-0.14, v, z), (-0.1, v, z + 0.01), (0.1, v, z + 0.01), (0.14, v, z)],
            [0.012, 0.04, 0.04, 0.012],
        )
        for v, z in ((-0.07, 0.075), (0.02, 0.08), (0.09, 0.07))
    ]
    rolls = [ellipsoid(crust.shaded(1.15), (0.05, 0.045, 0.035), (u, 0.0, 0.125)) for u in (-0.07, 0.06)]
    return [loft(weave, np.array(rows)), *loaves, *rolls]


def cash_register(size: Vector, f: Finish) -> list[Part]:
    drawer = [
        box(f.main, (0.38, 0.38, 0.1), (0, -0.01, 0), 0.008),
        box(f.main.shaded(1.15), (0.36, 0.02, 0.08), (0, 0.185, 0.01), 0.006),
    ]
    top = tapered(f.main, [(0.36, 0.34, 0.1), (0.32, 0.16, 0.2)], (0, 0, 0), 0.02, lean=(0.0, -0.09))
    keys = placed(
        box(patterned("chalk", "buttons", "slate grey", 0.2), (0.26, 0.16, 0.006)),
        (0.02, 0.05, 0.155),
        np.array([[1.0, 0, 0], [0, 0.86, 0.51], [0, -0.51, 0.86]]),
    )
    display = [
        box(DARK, (0.24, 0.03, 0.1), (0, -0.12, 0.22), 0.008),
        sign("12.50", 0.2, 0.07, (0, -0.104, 0.235), "black", "green", 0.8),
        cylinder(STEEL, 0.012, 0.06, (0, -0.12, 0.18)),
    ]
    return [*drawer, top, keys, *display, box(WHITE, (0.06, 0.004, 0.06), (-0.12, -0.05, 0.21))]


def weighing_scale(size: Vector, f: Finish) -> list[Part]:
    body = tapered(f.main, [(0.3, 0.3, 0), (0.28, 0.26, 0.06), (0.14, 0.1, 0.26)], radius=0.03, lean=(0, 0, -0.02))
    dial = [
        placed(
            turned(STEEL, [(0.085, 0), (0.09, 0.01), (0.08, 0.012)]),
            (0, 0.08, 0.14),
            FACING @ np.array([[1.0, 0, 0], [0, 0.9, 0.4], [0, -0.4, 0.9]]).T,
        ),
        placed(
            picture(replace(paint("chalk", "dial", 0.1, 0.25), ink=(0.02, 0.02, 0.02)), 0.13, 0.13, (0, 0, -0.065)),
            (0, 0.092, 0.145),
            BACK_TILT.T,
        ),
    ]
    pan = [
        turned(STEEL, [(0.03, 0.28), (0.16, 0.29), (0.17, 0.32), (0.16, 0.315), (0, 0.3)]),
        cylinder(STEEL, 0.03, 0.04, (0, 0, 0.25)),
    ]
    return [body, *dial, *pan]


def sewing_machine(size: Vector, f: Finish) -> list[Part]:
    base = box(WOOD, (0.42, 0.2, 0.05), (0, 0, 0), 0.01)
    body = [
        tapered(f.main, [(0.1, 0.1, 0.05), (0.085, 0.085, 0.22)], (0.13, 0, 0), 0.03),
        sweep(
            f.main,
            rounded_ring(0.085, 0.1, 0.035),
            [(0.175, 0, 0.25), (0.0, 0, 0.25), (-0.14, 0, 0.245), (-0.185, 0, 0.24)],
            [1, 0.85, 1, 0.9],
        ),
        tapered(f.main, [(0.05, 0.06, 0.16), (0.07, 0.08, 0.24)], (-0.15, 0, 0), 0.02),
    ]
    wheel_ = [
        placed(turned(STEEL, [(0, 0), (0.06, 0), (0.065, 0.012), (0.06, 0.025), (0, 0.025)]), (0.175, 0, 0.25), LYING)
    ]
    rest = [
        pipe(STEEL, [(-0.15, 0.01, 0.16), (-0.15, 0.01, 0.06)], 0.005),
        box(STEEL, (0.14, 0.1, 0.004), (-0.14, 0, 0.05)),
        turned(paint("red"), [(0, 0.3), (0.014, 0.3), (0.01, 0.335), (0, 0.335)], (0.05, 0, 0)),
        box(paint("denim blue", "fabric"), (0.2, 0.16, 0.006), (-0.12, 0.02, 0.056)),
    ]
    return [base, *body, *wheel_, *rest, sign("SINGLET", 0.12, 0.025, (0.02, 0.048, 0.24), "black", "brass")]


def vice(size: Vector, f: Finish) -> list[Part]:
    base = [
        turned(f.main, [(0, 0), (0.11, 0), (0.11, 0.02), (0.07, 0.03), (0.06, 0.06), (0, 0.06)]),
        tapered(f.main, [(0.1, 0.2, 0.05), (0.12, 0.22, 0.12)], (0, -0.04, 0), 0.02),
    ]
    jaws = [
        tapered(f.main, [(0.12, 0.1, 0.1), (0.14, 0.07, 0.2)], (0, -0.07, 0), 0.01),
        tapered(f.main, [(0.12, 0.06, 0.1), (0.14, 0.06, 0.2)], (0, 0.06, 0), 0.01),
        *(box(STEEL, (0.14, 0.014, 0.04), (0, y, 0.165)) for y in (-0.028, 0.024)),
    ]
    screw = [
        pipe(STEEL, [(0, 0.0, 0.11), (0, 0.2, 0.11)], 0.018),
        pipe(STEEL, [(-0.11, 0.19, 0.11), (0.11, 0.19, 0.11)], 0.008),
        *mirrored(ellipsoid(STEEL, (0.013,) * 3, (0.11, 0.19, 0.11))),
    ]
    return [*base, *jaws, *screw, *bolts(STEEL, 0.09, 4, 0.012, 0.02)]
