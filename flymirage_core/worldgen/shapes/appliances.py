"""Machines of offices, kitchens and plant rooms.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

import numpy as np

from flymirage_core.worldgen.forms import FACING, LYING, hoop, hull, loft, patterned, pipe, placed, sign, tapered
from flymirage_core.worldgen.parts import Finish, box, cylinder, paint, picture, smooth, turned
from flymirage_core.worldgen.shapes.fittings import DARK, HAZARD, IRON, STEEL, flange, gauge
from flymirage_core.worldgen.surfaces import Part, Vector


def printer(size: Vector, f: Finish) -> list[Part]:
    body = [
        tapered(f.main, [(0.44, 0.36, 0.02), (0.46, 0.38, 0.08), (0.46, 0.38, 0.17), (0.42, 0.32, 0.2)], radius=0.03),
        box(DARK, (0.4, 0.32, 0.02)),
    ]
    lid = [
        tapered(f.second, [(0.42, 0.3, 0.2), (0.4, 0.28, 0.235)], (0, -0.03, 0), 0.02),
        box(paint("chalk"), (0.21, 0.16, 0.004), (0, -0.2, 0.24), 0, 0.5),
    ]
    out = [
        box(DARK, (0.3, 0.02, 0.05), (0, 0.185, 0.1), 0.006),
        box(f.main.shaded(0.85), (0.28, 0.14, 0.012), (0, 0.24, 0.085), 0.004),
        box(paint("white", "page", detail=0.4), (0.21, 0.15, 0.004), (0, 0.235, 0.099)),
    ]
    panel = [
        picture(paint("teal", "screen", 0.5, 0.3), 0.08, 0.035, (0.14, 0.192, 0.14)),
        *(
            box(paint(c, emission=0.4), (0.012, 0.006, 0.012), (-0.17 + 0.03 * i, 0.19, 0.15))
            for i, c in enumerate(("green", "orange", "white"))
        ),
    ]
    return [*body, *lid, *out, *panel, box(f.main.shaded(0.9), (0.38, 0.01, 0.045), (0, 0.186, 0.03), 0.003)]


def microwave(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.5, 0.34, 0.28), (0, 0, 0.012), 0.012)
    door = [
        box(DARK, (0.36, 0.012, 0.24), (-0.055, 0.17, 0.03), 0.005),
        box(paint("charcoal", "grille"), (0.27, 0.006, 0.16), (-0.07, 0.177, 0.07)),
        pipe(STEEL, [(0.105, 0.175, 0.06), (0.105, 0.2, 0.07), (0.105, 0.2, 0.23), (0.105, 0.175, 0.24)], 0.007, 0.01),
    ]
    panel = [
        box(f.main.shaded(0.8), (0.1, 0.01, 0.24), (0.18, 0.17, 0.03), 0.003),
        sign("12:45", 0.075, 0.03, (0.18, 0.177, 0.225), "black", "green", 0.8),
        box(patterned("slate grey", "buttons", "chalk", 0.2), (0.08, 0.006, 0.1), (0.18, 0.174, 0.11)),
        placed(turned(STEEL, [(0, 0), (0.022, 0), (0.02, 0.018), (0, 0.018)]), (0.18, 0.173, 0.065), FACING),
    ]
    return [
        body,
        *door,
        *panel,
        *(cylinder(DARK, 0.015, 0.014, (s * 0.2, t * 0.13, 0)) for s in (-1, 1) for t in (-1, 1)),
    ]


def machine(size: Vector, f: Finish) -> list[Part]:
    """A milling centre: an enclosed cell with a window, a console on an arm, coolant tank and a signal tower."""
    body = [
        tapered(f.main, [(1.5, 0.9, 0.1), (1.5, 0.9, 0.5), (1.5, 0.9, 1.25)], radius=0.03),
        box(IRON, (1.4, 0.8, 0.1)),
        box(f.main.shaded(0.8), (0.5, 0.85, 0.16), (-0.4, -0.02, 1.25), 0.03),
    ]
    window = [
        box(f.main.shaded(1.12), (0.9, 0.03, 0.85), (-0.12, 0.45, 0.36), 0.01),
        box(paint("charcoal", "glass"), (0.62, 0.012, 0.46), (-0.12, 0.468, 0.62), 0.01),
        pipe(STEEL, [(0.25, 0.47, 0.5), (0.25, 0.51, 0.52), (0.25, 0.51, 0.8), (0.25, 0.47, 0.82)], 0.014, 0.02),
    ]
    console = [
        pipe(STEEL, [(0.5, 0.4, 1.2), (0.5, 0.58, 1.2), (0.5, 0.58, 1.0)], 0.025, 0.05),
        box(f.second, (0.3, 0.1, 0.42), (0.52, 0.58, 0.62), 0.02),
        picture(paint("teal", "screen", 0.7, 0.3, f.seed % 97), 0.24, 0.17, (0.52, 0.635, 0.84)),
        box(patterned("slate grey", "buttons", "charcoal", 0.25), (0.24, 0.01, 0.16), (0.52, 0.632, 0.65)),
    ]
    tower = [
        pipe(STEEL, [(-0.6, 0.2, 1.4), (-0.6, 0.2, 1.5)], 0.014),
        *(
            cylinder(paint(c, emission=0.9), 0.03, 0.05, (-0.6, 0.2, 1.48 + 0.05 * i))
            for i, c in enumerate(("green", "orange", "red"))
        ),
    ]
    rest = [
        box(patterned("light grey", "grille", "charcoal", 0.4), (0.012, 0.5, 0.3), (0.752, -0.1, 0.3)),
        box(IRON, (0.9, 0.3, 0.16), (-0.12, 0.5, 0.0), 0.02),
        sign("MX-400", 0.4, 0.1, (-0.45, 0.462, 1.1), "chalk", "navy"),
        box(HAZARD, (1.5, 0.012, 0.06), (0, 0.452, 0.12)),
    ]
    return [*body, *window, *console, *tower, *rest]


def generator(size: Vector, f: Finish) -> list[Part]:
    """A diesel set in its hood."""
    skid = [box(IRON, (1.3, 0.08, 0.12), (0, s * 0.3, 0)) for s in (-1, 1)] + [
        box(f.second, (1.3, 0.7, 0.06), (0, 0, 0.1))
    ]
    hood = tapered(f.main, [(1.28, 0.7, 0.16), (1.28, 0.7, 0.8), (1.2, 0.62, 0.9)], radius=0.05)
    doors = [
        p
        for u in (-0.32, 0.28)
        for p in (
            box(f.main.shaded(1.08), (0.54, 0.015, 0.52), (u, 0.35, 0.22), 0.006),
            box(patterned("charcoal", "grille", "black", 0.3), (0.36, 0.006, 0.2), (u, 0.362, 0.26)),
            box(DARK, (0.03, 0.03, 0.09), (u + 0.22, 0.362, 0.5), 0.006),
        )
    ]
    panel = [
        box(DARK, (0.24, 0.01, 0.16), (0.28, 0.36, 0.56), 0.004),
        *gauge((0.22, 0.37, 0.64), 0.045),
        *gauge((0.34, 0.37, 0.64), 0.045),
    ]
    stack = [
        pipe(STEEL, [(-0.4, -0.1, 0.88), (-0.4, -0.1, 1.08), (-0.28, -0.1, 1.12)], 0.04, 0.06),
        turned(DARK, [(0.05, 0.88), (0.06, 0.9), (0.06, 0.93), (0, 0.93)], (0.3, 0.1, 0)),
    ]
    eyes = [placed(hoop(STEEL, 0.05, 0.014), (u, 0, 0.93), FACING) for u in (0.0,)]
    return [*skid, hood, *doors, *panel, *stack, *eyes, sign("60 kVA", 0.3, 0.1, (-0.32, 0.36, 0.6), "chalk", "black")]


def pump(size: Vector, f: Finish) -> list[Part]:
    """A centrifugal pump with its motor on one frame."""
    frame = [box(IRON, (1.1, 0.06, 0.1), (0, s * 0.2, 0)) for s in (-1, 1)] + [
        box(IRON, (0.08, 0.46, 0.1), (u, 0, 0)) for u in (-0.4, 0.1, 0.45)
    ]
    motor = [
        placed(
            turned(f.main, [(0, -0.28), (0.12, -0.28), (0.16, -0.25), (0.16, 0.2), (0.12, 0.24), (0, 0.24)]),
            (-0.25, 0, 0.32),
            LYING,
        ),
        *(placed(hoop(f.main.shaded(0.85), 0.165, 0.008), (u, 0, 0.32), LYING) for u in np.linspace(-0.45, -0.1, 9)),
        box(f.main, (0.16, 0.12, 0.1), (-0.28, 0, 0.47), 0.01),
        placed(
            turned(DARK, [(0.16, -0.02), (0.17, 0), (0.17, 0.06), (0.12, 0.07), (0, 0.07)]),
            (-0.54, 0, 0.32),
            -LYING @ np.diag([1.0, -1.0, 1.0]),
        ),
        *(box(IRON, (0.1, 0.3, 0.18), (u, 0, 0.08)) for u in (-0.4, -0.12)),
    ]
    coupling = [
        placed(hoop(paint("yellow", "enamel"), 0.09, 0.01, tall=0.16), (0.08, 0, 0.32), LYING),
        pipe(STEEL, [(-0.02, 0, 0.32), (0.2, 0, 0.32)], 0.025),
        box(IRON, (0.2, 0.12, 0.12), (0.18, 0, 0.1)),
    ]
    volute = [
        placed(
            turned(f.second, smooth([(0.06, -0.09), (0.2, -0.08), (0.24, 0.0), (0.2, 0.08), (0.1, 0.1)], 12)),
            (0.34, 0, 0.34),
            LYING,
        ),
        *(placed(p, (0.46, 0, 0.34), LYING) for p in flange(f.second, 0.09, (0, 0, 0.02))),
    ]
    riser = [
        pipe(f.second, [(0.34, 0.08, 0.5), (0.34, 0.08, 0.78)], 0.075),
        *flange(f.second, 0.075, (0.34, 0.08, 0.78)),
    ]
    return [*frame, *motor, *coupling, *volute, *riser, *gauge((0.34, 0.18, 0.66), 0.05)]


def column(size: Vector, f: Finish) -> list[Part]:
    """A fluted column with base and capital, or a plain round pier."""
    x, _, z = size
    r = x / 2
    ends = [box(f.main.shaded(0.95), (x, x, 0.08), (0, 0, h), 0.006) for h in (0.0, z - 0.08)]
    base = [
        turned(
            f.main, smooth([(0.98 * r, 0.08), (0.94 * r, 0.14), (0.86 * r, 0.18), (0.9 * r, 0.22), (0.8 * r, 0.26)], 10)
        )
    ]
    top = [
        turned(
            f.main,
            smooth(
                [
                    (0.72 * r, z - 0.26),
                    (0.78 * r, z - 0.2),
                    (0.76 * r, z - 0.18),
                    (0.94 * r, z - 0.1),
                    (0.96 * r, z - 0.08),
                ],
                10,
            ),
        )
    ]
    if f.chosen(2):
        return [turned(f.main, [(0.8 * r, 0.24), (0.76 * r, 0.6 * z), (0.7 * r, z - 0.24)]), *base, *top, *ends]
    a = np.arange(48) * 2 * np.pi / 48
    ring = (0.8 * r * (1 - 0.06 * (np.cos(16 * a) > 0.2)))[:, None] * np.stack([np.cos(a), np.sin(a)], 1)
    levels = ((1.0, 0.24), (0.95, 0.4 * z), (0.88, z - 0.24))
    shaft = loft(f.main, [np.column_stack([k * ring, np.full(len(ring), h)]) for k, h in levels], False)
    return [shaft, *base, *top, *ends]


def helmet(size: Vector, f: Finish) -> list[Part]:
    """A hard hat: a ribbed shell, a peak, a strap."""
    shell = turned(
        f.main, smooth([(0.115, 0.03), (0.114, 0.08), (0.09, 0.14), (0.04, 0.168), (0, 0.172)], 12), scale=(1.0, 1.22)
    )
    rim = turned(
        f.main.shaded(0.95), [(0.113, 0.022), (0.128, 0.022), (0.128, 0.034), (0.113, 0.036)], scale=(1.0, 1.2)
    )
    ribs = [
        pipe(
            f.main.shaded(1.05),
            [
                (
                    u,
                    0.135 * np.cos(a) * np.sqrt(max(1 - (u / 0.12) ** 2, 0.1)),
                    0.045 + 0.125 * np.sin(a) * (1 - 2.5 * abs(u)),
                )
                for a in np.linspace(0.15, np.pi - 0.15, 9)
            ],
            0.009,
        )
        for u in (-0.035, 0.0, 0.035)
    ]
    peak = hull(f.main, [(0.08, 0.18, 0.02, 0.032), (0.16, 0.15, 0.014, 0.026), (0.185, 0.09, 0.01, 0.02)], 0.004)
    return [
        shell,
        rim,
        *ribs,
        peak,
        pipe(DARK, [(-0.1, 0, 0.03), (-0.06, 0.05, 0.0), (0.06, 0.05, 0.0), (0.1, 0, 0.03)], 0.005, 0.02),
    ]
