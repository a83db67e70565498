"""Kitchens, bathrooms, hearths.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    circle,
    loft,
    mirrored,
    patterned,
    pipe,
    placed,
    rounded_ring,
    sign,
    spun,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, four_legs, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, DARK, WHITE = paint("silver", "brushed"), paint("black"), paint("white")
GLASS = replace(paint("powder blue", "glass"), opacity=0.35)


def stove(size: Vector, f: Finish) -> list[Part]:
    body = [box(f.main, (0.6, 0.58, 0.85), (0, -0.01, 0.04), 0.01), box(DARK, (0.56, 0.5, 0.04))]
    glass = [
        box(DARK, (0.46, 0.015, 0.3), (0, 0.285, 0.3), 0.006),
        pipe(STEEL, [(-0.22, 0.33, 0.66), (0.22, 0.33, 0.66)], 0.012),
        *(box(STEEL, (0.02, 0.05, 0.02), (s * 0.2, 0.305, 0.65)) for s in (-1, 1)),
    ]
    knobs = [
        placed(turned(DARK, [(0, 0), (0.022, 0), (0.018, 0.03), (0, 0.03)]), (u, 0.28, 0.8), FACING)
        for u in np.linspace(-0.22, 0.22, 5)
    ]
    top = [box(paint("charcoal"), (0.58, 0.54, 0.012), (0, 0, 0.89), 0.004)]
    rings = [
        p
        for u in (-0.14, 0.14)
        for v in (-0.12, 0.13)
        for p in (
            cylinder(DARK, 0.05, 0.012, (u, v, 0.9)),
            *(placed(q, (u, v, 0.92)) for q in spun(box(DARK, (0.2, 0.012, 0.012)), 2, 0.78)),
        )
    ]
    return [
        *body,
        *glass,
        *knobs,
        *top,
        *rings,
        box(f.main, (0.6, 0.03, 0.1), (0, -0.28, 0.89), 0.01),
        box(f.main.shaded(0.9), (0.56, 0.015, 0.16), (0, 0.285, 0.08), 0.005),
    ]


def sink_unit(size: Vector, f: Finish) -> list[Part]:
    body = [
        box(f.main, (1.2, 0.54, 0.76), (0, -0.02, 0.1)),
        box(DARK, (1.1, 0.46, 0.1), (0, -0.03, 0)),
        box(paint("light grey", "stone"), (1.22, 0.6, 0.04), (0, 0, 0.86), 0.01),
    ]
    doors = [
        p
        for s in (-1, 1)
        for p in (
            box(f.main.shaded(1.1), (0.56, 0.02, 0.68), (s * 0.29, 0.255, 0.14), 0.005),
            box(STEEL, (0.02, 0.025, 0.14), (s * 0.06, 0.27, 0.6)),
        )
    ]
    bowl = [
        tapered(STEEL, [(0.5, 0.4, 0.895), (0.52, 0.42, 0.908)], (-0.2, 0.0, 0), 0.06),
        box(paint("slate grey"), (0.44, 0.34, 0.004), (-0.2, 0.0, 0.906), 0.001),
        *(box(STEEL, (0.42, 0.012, 0.008), (0.35, v, 0.9)) for v in np.linspace(-0.16, 0.16, 7)),
    ]
    tap = [
        pipe(STEEL, [(-0.2, -0.24, 0.9), (-0.2, -0.24, 1.16), (-0.2, -0.04, 1.16), (-0.2, -0.04, 1.08)], 0.014, 0.08),
        *(cylinder(STEEL, 0.02, 0.07, (-0.2 + s * 0.1, -0.24, 0.9)) for s in (-1, 1)),
    ]
    plates = [
        placed(
            turned(WHITE, [(0, 0), (0.1, 0.004), (0.11, 0.014), (0, 0.012)]),
            (0.3 + 0.05 * i, 0.0, 1.01),
            np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        )
        for i in range(4)
    ]
    return [*body, *doors, *bowl, *tap, *plates]


def washing_machine(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.6, 0.56, 0.83), (0, -0.01, 0.02), 0.015)
    rim = placed(turned(STEEL, [(0.2, 0.0), (0.2, 0.03), (0.15, 0.045), (0.15, 0.0)]), (0, 0.27, 0.42), FACING)
    glass = placed(
        turned(paint("charcoal", "glass"), [(0.15, 0.015), (0.1, 0.0), (0, -0.01)]), (0, 0.275, 0.42), FACING
    )
    panel = [
        box(f.main.shaded(0.9), (0.58, 0.02, 0.12), (0, 0.27, 0.7), 0.004),
        placed(turned(STEEL, [(0, 0), (0.035, 0), (0.03, 0.03), (0, 0.03)]), (0.06, 0.28, 0.76), FACING),
        box(paint("teal", "screen", 0.5, 0.3), (0.12, 0.01, 0.05), (0.2, 0.278, 0.735)),
        box(f.main.shaded(0.8), (0.18, 0.012, 0.08), (-0.18, 0.278, 0.72), 0.004),
    ]
    return [body, rim, glass, *panel, box(DARK, (0.56, 0.5, 0.03))]


def oven(size: Vector, f: Finish) -> list[Part]:
    """A baker's deck oven: three doors over each other on legs."""
    body = [box(f.main, (0.9, 0.72, 1.25), (0, -0.02, 0.35), 0.015), *four_legs(STEEL, (0.9, 0.74), 0.35, 0.06)]
    decks = [
        p
        for i in range(3)
        for p in (
            box(DARK, (0.6, 0.02, 0.22), (-0.06, 0.345, 0.46 + 0.38 * i), 0.01),
            box(paint("orange", emission=0.35), (0.5, 0.012, 0.13), (-0.06, 0.358, 0.5 + 0.38 * i), 0.004),
            pipe(STEEL, [(-0.34, 0.39, 0.71 + 0.38 * i), (0.22, 0.39, 0.71 + 0.38 * i)], 0.014),
            box(paint("charcoal", "buttons", detail=0.3), (0.14, 0.012, 0.22), (0.35, 0.346, 0.46 + 0.38 * i)),
        )
    ]
    return [*body, *decks, cylinder(STEEL, 0.08, 0.14, (0.2, -0.2, 1.6))]


def bathtub(size: Vector, f: Finish) -> list[Part]:
    rows = ((0.56, 1.4, 0.06), (0.7, 1.58, 0.4), (0.78, 1.7, 0.56), (0.78, 1.7, 0.6))
    outer = [np.column_stack([rounded_ring(a, b, 0.32, 6), np.full(24, z)]) for a, b, z in rows]
    inner = [
        np.column_stack([rounded_ring(a - 0.12, b - 0.14, 0.28, 6), np.full(24, z)])
        for a, b, z in (rows[3], rows[1], (0.6, 1.4, 0.16))
    ]
    shell = loft(f.main, np.array([*outer, *inner]), True)
    feet = [
        ellipsoid(paint("brass", "metal"), (0.05, 0.06, 0.06), (s * 0.24, t * 0.55, 0.06))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    tap = [
        pipe(STEEL, [(0, -0.82, 0.58), (0, -0.82, 0.78), (0, -0.66, 0.78), (0, -0.66, 0.72)], 0.018, 0.07),
        *(ellipsoid(STEEL, (0.03,) * 3, (s * 0.1, -0.8, 0.64)) for s in (-1, 1)),
    ]
    return [
        shell,
        *feet,
        *tap,
        *(
            [
                tapered(
                    replace(paint("sky blue", "water"), opacity=0.8), [(0.6, 1.5, 0.4), (0.6, 1.5, 0.405)], radius=0.28
                )
            ]
            if f.chosen(2)
            else []
        ),
    ]


def toilet(size: Vector, f: Finish) -> list[Part]:
    def oval(w: float, d: float, z: float, y: float) -> Float:
        c = circle(0.5, 20)
        return np.column_stack([c[:, 0] * w, c[:, 1] * d + y, np.full(20, z)])

    bowl = loft(
        f.main,
        np.array(
            [
                oval(0.22, 0.34, 0, -0.02),
                oval(0.2, 0.32, 0.15, 0.0),
                oval(0.34, 0.5, 0.36, 0.06),
                oval(0.36, 0.52, 0.4, 0.06),
                oval(0.26, 0.4, 0.4, 0.07),
                oval(0.2, 0.3, 0.3, 0.06),
            ]
        ),
    )
    seat = loft(
        f.main.shaded(1.05),
        np.array(
            [
                oval(0.38, 0.5, 0.4, 0.07),
                oval(0.38, 0.5, 0.43, 0.07),
                oval(0.24, 0.34, 0.43, 0.08),
                oval(0.24, 0.34, 0.4, 0.08),
            ]
        ),
        False,
    )
    lid = loft(
        f.main.shaded(1.05),
        np.array([oval(0.37, 0.05, 0.43, -0.17), oval(0.38, 0.06, 0.6, -0.19), oval(0.28, 0.04, 0.78, -0.2)]),
    )
    tank = [
        tapered(
            f.main, [(0.34, 0.15, 0.38), (0.38, 0.17, 0.74), (0.4, 0.19, 0.74), (0.4, 0.19, 0.78)], (0, -0.28, 0), 0.03
        ),
        cylinder(STEEL, 0.025, 0.012, (0, -0.28, 0.78)),
    ]
    return [bowl, seat, lid, *tank]


def washbasin(size: Vector, f: Finish) -> list[Part]:
    rows = (
        (0.3, 0.24, 0.66),
        (0.5, 0.4, 0.76),
        (0.6, 0.48, 0.84),
        (0.6, 0.48, 0.88),
        (0.5, 0.36, 0.88),
        (0.42, 0.28, 0.8),
        (0.1, 0.08, 0.76),
    )
    basin = loft(f.main, np.array([np.column_stack([rounded_ring(a, b, 0.12, 5), np.full(20, z)]) for a, b, z in rows]))
    foot = turned(f.main, smooth([(0.11, 0), (0.1, 0.1), (0.075, 0.4), (0.12, 0.68)], 8), (0, -0.05, 0))
    tap = [
        pipe(STEEL, [(0, -0.19, 0.87), (0, -0.19, 1.02), (0, -0.06, 1.02), (0, -0.06, 0.98)], 0.014, 0.05),
        *(cylinder(STEEL, 0.018, 0.06, (s * 0.1, -0.19, 0.88)) for s in (-1, 1)),
    ]
    return [basin, foot, *tap]


def shower_cabin(size: Vector, f: Finish) -> list[Part]:
    pane = replace(f.main if f.main.texture == "glass" else GLASS, opacity=0.3)
    tray = [
        box(WHITE, (0.95, 0.95, 0.12), (0, 0, 0), 0.03),
        box(paint("light grey"), (0.8, 0.8, 0.006), (0, 0, 0.118)),
        cylinder(STEEL, 0.05, 0.008, (0, 0, 0.123)),
    ]
    frame = [
        pipe(STEEL, [(s * 0.46, t * 0.46, 0.1), (s * 0.46, t * 0.46, 2.05)], 0.018) for s in (-1, 1) for t in (-1, 1)
    ] + [
        p
        for z in (0.13, 2.03)
        for p in (
            *mirrored(box(STEEL, (0.03, 0.92, 0.03), (0.46, 0, z))),
            box(STEEL, (0.92, 0.03, 0.03), (0, 0.46, z)),
            box(STEEL, (0.92, 0.03, 0.03), (0, -0.46, z)),
        )
    ]
    walls = [
        *mirrored(box(pane, (0.01, 0.88, 1.88), (0.46, 0, 0.15))),
        box(pane, (0.42, 0.01, 1.88), (-0.23, 0.46, 0.15)),
        box(pane, (0.42, 0.01, 1.88), (0.23, 0.47, 0.15)),
        box(paint("chalk", "small tiles"), (0.9, 0.02, 1.88), (0, -0.46, 0.15)),
    ]
    head = [
        pipe(STEEL, [(0, -0.44, 1.0), (0, -0.42, 1.95), (0, -0.15, 1.98)], 0.014, 0.08),
        turned(STEEL, [(0.11, 1.93), (0.1, 1.95), (0, 1.97)], (0, -0.15, 0)),
        box(STEEL, (0.2, 0.05, 0.05), (0, -0.43, 1.05), 0.01),
        pipe(STEEL, [(0.06, 0.5, 0.95), (0.06, 0.5, 1.25)], 0.012),
    ]
    return [*tray, *frame, *walls, *head]


def radiator(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    count = max(6, round(x / 0.075))
    columns = [
        p
        for i in range(count)
        for p in (box(f.main, (x / count * 0.62, y * 0.9, z - 0.1), ((i + 0.5) * x / count - x / 2, 0, 0.07), 0.018),)
    ]
    bars = [pipe(f.main, [(-x / 2 + 0.03, 0, h), (x / 2 - 0.03, 0, h)], 0.022) for h in (0.13, z - 0.09)]
    feet = [box(f.main, (0.04, y, 0.1), (s * (x / 2 - 0.1), 0, 0), 0.01) for s in (-1, 1)]
    return [
        *columns,
        *bars,
        *feet,
        placed(turned(WHITE, [(0, 0), (0.025, 0), (0.025, 0.06), (0, 0.06)]), (x / 2 - 0.02, 0, 0.1)),
    ]


def fireplace(size: Vector, f: Finish) -> list[Part]:
    inside = [
        box(paint("charcoal", "bricks"), (0.86, 0.04, 0.8), (0, -0.2, 0.05)),
        *mirrored(box(paint("charcoal", "bricks"), (0.04, 0.36, 0.8), (0.43, -0.02, 0.05))),
    ]
    jambs = [
        p
        for s in (-1, 1)
        for p in (
            box(f.main, (0.3, 0.4, 1.05), (s * 0.58, -0.03, 0), 0.01),
            tapered(f.main.shaded(1.05), [(0.24, 0.06, 0.12), (0.2, 0.05, 0.95)], (s * 0.58, 0.18, 0), 0.008),
            box(f.main, (0.34, 0.46, 0.12), (s * 0.58, 0, 0), 0.01),
        )
    ]
    lintel = [
        box(f.main, (0.9, 0.4, 0.24), (0, -0.03, 0.82), 0.008),
        box(f.main.shaded(1.05), (0.4, 0.05, 0.14), (0, 0.18, 0.86), 0.01),
    ]
    shelf = [
        tapered(f.main, [(1.3, 0.42, 1.04), (1.5, 0.5, 1.12), (1.52, 0.52, 1.12), (1.52, 0.52, 1.18)], (0, 0, 0), 0.01)
    ]
    logs = [
        pipe(
            paint("walnut brown", "bark"),
            [(-0.26, 0.02 + 0.07 * i, 0.14 + 0.04 * i), (0.26, -0.04 + 0.08 * i, 0.16)],
            0.05,
        )
        for i in range(3)
    ]
    fire = [
        turned(paint(c, emission=e), smooth([(0, 0.16), (r, 0.2), (0.6 * r, 0.3), (0, h)], 6), (u, 0.02, 0))
        for c, e, r, h, u in (
            ("orange", 2.5, 0.09, 0.5, -0.06),
            ("yellow", 3.0, 0.06, 0.42, 0.07),
            ("orange", 2.0, 0.05, 0.36, -0.17),
        )
    ]
    return [
        *inside,
        *jambs,
        *lintel,
        *shelf,
        *logs,
        *fire,
        box(f.main.shaded(0.7), (1.5, 0.5, 0.05), (0, 0, 0)),
        *(pipe(DARK, [(u, 0.17, 0.06), (u, 0.17, 0.2)], 0.01) for u in np.linspace(-0.35, 0.35, 8)),
        pipe(DARK, [(-0.37, 0.17, 0.2), (0.37, 0.17, 0.2)], 0.012),
    ]


def chest_freezer(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    body = box(f.main, (x, y, z - 0.14), (0, 0, 0.06), 0.03)
    lids = [
        box(GLASS, (x / 2 - 0.03, y - 0.1, 0.02), (s * x / 4, 0, z - 0.06 + 0.015 * (s > 0)), 0.006) for s in (-1, 1)
    ]
    rim = [box(paint("slate grey"), (x, 0.06, 0.07), (0, s * (y / 2 - 0.03), z - 0.08), 0.02) for s in (-1, 1)] + [
        box(paint("slate grey"), (0.06, y, 0.07), (s * (x / 2 - 0.03), 0, z - 0.08), 0.02) for s in (-1, 1)
    ]
    goods = [
        box(replace(paint("white", "labels", 0.1, 0.4, f.seed % 97)), (x - 0.12, y - 0.12, 0.03), (0, 0, z - 0.14))
    ]
    return [
        body,
        *lids,
        *rim,
        *goods,
        box(DARK, (x - 0.06, y - 0.06, 0.06)),
        sign("ICE CREAM", x * 0.5, 0.2, (0, y / 2 + 0.002, z * 0.45), "chalk", "blue"),
        box(patterned("slate grey", "grille"), (0.3, 0.01, 0.14), (-x / 2 + 0.2, y / 2 + 0.002, 0.1)),
    ]
