"""Music, games, sport.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    circle,
    hoop,
    hull,
    mirrored,
    patterned,
    pipe,
    placed,
    plate,
    rounded_ring,
    sign,
    spun,
    sweep,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, smooth, turned
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, DARK, WHITE = paint("silver", "brushed"), paint("black"), paint("white")
BRASS = paint("brass", "brushed")


def arcade_machine(size: Vector, f: Finish) -> list[Part]:
    outline = [
        (0.36, 0.0),
        (0.36, 0.78),
        (0.4, 0.95),
        (0.12, 1.05),
        (-0.02, 1.42),
        (0.24, 1.55),
        (0.24, 1.75),
        (-0.38, 1.75),
        (-0.38, 0.0),
    ]
    points = np.array(outline)
    body = sweep(paint("charcoal"), points, [(-0.31, 0, 0), (0.31, 0, 0)])
    sides = [
        sweep(f.main, points * 1.0, [(s * 0.31, 0, 0), (s * 0.345, 0, 0)])
        if s > 0
        else sweep(f.main, points, [(-0.345, 0, 0), (-0.31, 0, 0)])
        for s in (-1, 1)
    ]
    tilt = np.array([[1.0, 0, 0], [0, 0.935, 0.354], [0, -0.354, 0.935]])
    screen = placed(
        picture(paint("teal", "painting", 0.9, 0.4, f.seed % 97), 0.5, 0.34, (0, 0, 0)), (0, 0.115, 1.07), tilt
    )
    head = [
        sign(
            ("SPACE RUN", "PIXEL KART", "STAR BLAST")[f.chosen(3)],
            0.58,
            0.16,
            (0, 0.245, 1.57),
            "burgundy",
            "yellow",
            0.9,
        )
    ]
    stick = [
        pipe(STEEL, [(-0.16, 0.28, 1.0), (-0.16, 0.28, 1.08)], 0.008),
        ellipsoid(paint("red"), (0.022,) * 3, (-0.16, 0.28, 1.09)),
        *(
            cylinder(paint(c), 0.018, 0.02, (u, 0.27, 0.998))
            for c, u in (("yellow", 0.02), ("blue", 0.09), ("green", 0.16))
        ),
    ]
    door = [
        box(DARK, (0.24, 0.01, 0.3), (0, 0.362, 0.3), 0.004),
        *(box(paint("red", emission=1.0), (0.03, 0.01, 0.05), (u, 0.37, 0.5)) for u in (-0.05, 0.05)),
    ]
    return [body, *sides, screen, *head, *stick, *door]


def jukebox(size: Vector, f: Finish) -> list[Part]:
    arch = [(0.4 * np.cos(a), 1.0 + 0.4 * np.sin(a)) for a in np.linspace(0, np.pi, 13)]
    body = plate(f.main, [(-0.4, 0.06), (0.4, 0.06), *arch], 0.5)
    glow = [
        placed(
            sweep(
                paint(c, emission=1.3),
                circle(w, 8),
                [(r * 0.4 * np.cos(a), 0.26, 1.0 + r * 0.4 * np.sin(a)) for a in np.linspace(0, np.pi, 15)],
            )
        )
        for c, r, w in (("orange", 0.9, 0.035), ("yellow", 0.7, 0.025), ("coral", 0.54, 0.02))
    ]
    glow += [
        pipe(paint(c, emission=1.3), [(s * u, 0.26, 0.12), (s * u, 0.26, 1.0)], w)
        for s in (-1, 1)
        for c, u, w in (("orange", 0.36, 0.035), ("yellow", 0.28, 0.025))
    ]
    panel = [
        box(paint("chalk", "labels", 0.4, 0.35, f.seed % 97), (0.36, 0.02, 0.24), (0, 0.255, 0.98), 0.004),
        box(patterned("brass", "grille", "burgundy", 0.3), (0.46, 0.02, 0.5), (0, 0.255, 0.16)),
        box(STEEL, (0.5, 0.12, 0.08), (0, 0.26, 0.74), 0.03),
        box(patterned("chalk", "buttons", "red", 0.2), (0.4, 0.01, 0.05), (0, 0.322, 0.755)),
    ]
    return [body, *glow, *panel, box(DARK, (0.7, 0.5, 0.07))]


def piano(size: Vector, f: Finish) -> list[Part]:
    """An upright piano."""
    body = [box(f.main, (1.5, 0.34, 1.17), (0, -0.12, 0), 0.008), box(f.main, (1.54, 0.4, 0.03), (0, -0.1, 1.17), 0.01)]
    bed = [
        box(f.main, (1.5, 0.3, 0.1), (0, 0.16, 0.6), 0.008),
        *mirrored(box(f.main, (0.06, 0.3, 0.2), (0.72, 0.16, 0.6), 0.02)),
        *mirrored(turned(f.main, smooth([(0.045, 0), (0.03, 0.06), (0.05, 0.35), (0.04, 0.6)], 8), (0.68, 0.24, 0))),
    ]
    keys = [box(WHITE, (1.34, 0.14, 0.02), (0, 0.22, 0.7)), box(f.main, (1.38, 0.02, 0.06), (0, 0.145, 0.7))]
    keys += [
        box(DARK, (0.013, 0.085, 0.014), (-0.66 + 0.0258 * i, 0.19, 0.72)) for i in range(52) if i % 7 not in (2, 6)
    ]
    keys += [box(paint("grey"), (0.002, 0.14, 0.003), (-0.673 + 0.0258 * i, 0.22, 0.7185)) for i in range(0, 53, 2)]
    desk = [
        box(f.main.shaded(1.25), (1.1, 0.02, 0.32), (0, 0.055, 0.8), 0.004),
        box(f.main, (1.0, 0.05, 0.02), (0, 0.08, 0.82)),
        box(paint("ivory", "page"), (0.44, 0.008, 0.28), (0, 0.085, 0.84), 0, 0.1),
    ]
    pedals = [box(BRASS, (0.05, 0.14, 0.012), (u, 0.1, 0.05), 0.004) for u in (-0.09, 0, 0.09)]
    return [*body, *bed, *keys, *desk, *pedals, box(f.main.shaded(0.85), (1.36, 0.02, 0.44), (0, 0.06, 0.08))]


def _drum(f: Finish, radius: float, deep: float, centre: Vector, axis: Float | None = None) -> list[Part]:
    shell = turned(f.main, [(0, 0), (radius, 0), (radius, deep), (0, deep)])
    head = turned(paint("ivory"), [(0.96 * radius, deep + 0.003), (0, deep + 0.004)])
    rims = [hoop(STEEL, radius, 0.012, (0, 0, h)) for h in (0.01, deep - 0.01)]
    return [
        placed(p, centre, axis)
        for p in (
            shell,
            head,
            *rims,
            *spun(pipe(STEEL, [(radius + 0.01, 0, 0.02), (radius + 0.01, 0, deep - 0.02)], 0.006), 8),
        )
    ]


def drum_kit(size: Vector, f: Finish) -> list[Part]:
    parts = _drum(f, 0.3, 0.42, (0, -0.15, 0.31), FACING)
    parts += (
        _drum(f, 0.17, 0.22, (-0.2, 0.0, 0.66))
        + _drum(f, 0.18, 0.24, (0.2, 0.0, 0.66))
        + _drum(f, 0.22, 0.36, (0.6, -0.35, 0.22))
        + _drum(f, 0.18, 0.14, (-0.5, -0.4, 0.5))
    )
    for u, v, z, r in ((-0.65, 0.1, 1.05, 0.24), (0.62, 0.12, 1.15, 0.26), (-0.75, -0.35, 0.85, 0.18)):
        parts += [
            turned(BRASS, [(r, z), (0.06, z + 0.015), (0.03, z + 0.04), (0, z + 0.04)], (u, v, 0)),
            turned(BRASS, [(0, z + 0.03), (0.03, z + 0.03), (r, z - 0.006)][::-1], (u, v, 0)),
            pipe(STEEL, [(u, v, 0.2), (u, v, z + 0.05)], 0.01),
        ]
        parts += [placed(p, (u, v, 0)) for p in spun(pipe(STEEL, [(0, 0, 0.35), (0.18, 0, 0)], 0.008), 3)]
    stool = [
        turned(paint("black", "leather"), smooth([(0, 0.45), (0.16, 0.46), (0.17, 0.51), (0, 0.53)], 6), (0, -0.7, 0)),
        pipe(STEEL, [(0, -0.7, 0), (0, -0.7, 0.46)], 0.02),
    ]
    return [*parts, *stool, *(pipe(STEEL, [(s * 0.5, -0.4, 0.5), (s * 0.5, -0.4, 0)], 0.012) for s in (-1,))]


def guitar(size: Vector, f: Finish) -> list[Part]:
    """An acoustic guitar, leaning on its stand."""
    outline = np.array(
        [
            (0.19, -0.2),
            (0.13, -0.3),
            (0.0, -0.32),
            (-0.13, -0.3),
            (-0.19, -0.2),
            (-0.17, -0.08),
            (-0.12, 0.0),
            (-0.14, 0.1),
            (-0.1, 0.17),
            (0, 0.18),
            (0.1, 0.17),
            (0.14, 0.1),
            (0.12, 0.0),
            (0.17, -0.08),
        ]
    )
    rim = plate(f.second.shaded(1.2), outline[::-1], 0.09, (0, -0.006, 0.36))
    top = plate(f.main, outline[::-1] * 0.985, 0.1, (0, 0, 0.36))
    hole = placed(turned(DARK, [(0.05, 0.0), (0, 0.002)]), (0, 0.051, 0.38), FACING)
    neck = [
        box(paint("chocolate", "wood"), (0.055, 0.02, 0.5), (0, 0.045, 0.46), 0.004),
        box(paint("chocolate", "wood"), (0.08, 0.02, 0.14), (0, 0.04, 0.94), 0.01),
        box(paint("chocolate", "wood"), (0.14, 0.02, 0.03), (0, 0.058, 0.17), 0.006),
    ]
    strings = [
        pipe(STEEL, [(0.008 * (i - 2.5), 0.07, 0.19), (0.007 * (i - 2.5), 0.062, 1.0)], 0.0012) for i in range(6)
    ]
    pegs = [
        ellipsoid(STEEL, (0.018, 0.008, 0.01), (s * 0.05, 0.04, 0.96 + 0.035 * i)) for s in (-1, 1) for i in range(3)
    ]
    lean = np.array([[1.0, 0, 0], [0, 0.97, -0.22], [0, 0.22, 0.97]]).T
    stand = [pipe(DARK, [(s * 0.16, 0.16, 0), (s * 0.1, 0.1, 0.1), (s * 0.04, -0.06, 0.5)], 0.01) for s in (-1, 1)] + [
        pipe(DARK, [(0, -0.22, 0), (0, -0.06, 0.5)], 0.01)
    ]
    return [*(placed(p, (0, 0.04, 0.02), lean) for p in (rim, top, hole, *neck, *strings, *pegs)), *stand]


def speaker(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.4, 0.38, 1.08), (0, -0.01, 0.02), 0.015)
    cones = [
        p
        for z, r in ((0.3, 0.15), (0.62, 0.12), (0.9, 0.05))
        for p in (
            placed(turned(STEEL, [(r, 0), (r * 1.12, 0.0), (r * 1.12, 0.012), (r, 0.012)]), (0, 0.18, z), FACING),
            placed(turned(paint("charcoal"), [(r, 0.012), (0.4 * r, -0.03), (0, -0.02)]), (0, 0.18, z), FACING),
            placed(turned(DARK, [(0.35 * r, -0.015), (0, 0.01)]), (0, 0.18, z), FACING),
        )
    ]
    return [
        body,
        *cones,
        box(DARK, (0.36, 0.34, 0.03)),
        sign("SONUS", 0.12, 0.03, (0, 0.183, 0.08), "charcoal", "white"),
    ]


def music_stand(size: Vector, f: Finish) -> list[Part]:
    legs = [
        *spun(pipe(f.main, [(0, 0, 0.25), (0.24, 0, 0)], 0.01), 3, 0.5),
        pipe(f.main, [(0, 0, 0.15), (0, 0, 0.95)], 0.013),
    ]
    desk = [
        box(f.main, (0.5, 0.012, 0.3), (0, 0.0, 0.9), 0.004, 0.35),
        box(f.main, (0.5, 0.06, 0.012), (0, 0.03, 0.9)),
        box(paint("ivory", "page", detail=0.4), (0.42, 0.006, 0.27), (0, 0.012, 0.91), 0, 0.35),
    ]
    return [*legs, *desk]


def easel(size: Vector, f: Finish) -> list[Part]:
    legs = [pipe(f.main, [(s * 0.28, 0.1, 0), (s * 0.04, -0.12, 1.68)], 0.02) for s in (-1, 1)] + [
        pipe(f.main, [(0, -0.55, 0), (0, -0.1, 1.5)], 0.02)
    ]
    tray = [box(f.main, (0.56, 0.1, 0.03), (0, 0.07, 0.62)), box(f.main, (0.3, 0.04, 0.05), (0, -0.04, 1.0))]
    canvas = [
        box(paint("ivory", "fabric"), (0.6, 0.025, 0.76), (0, 0.045, 0.65), 0, 0.13),
        placed(
            picture(paint("white", "landscape", 0, 0.5, f.seed % 97), 0.58, 0.74, (0, 0, 0)),
            (0, 0.062, 0.66),
            np.array([[1.0, 0, 0], [0, 0.99, -0.13], [0, 0.13, 0.99]]),
        ),
    ]
    return [*legs, *tray, *canvas]


def treadmill(size: Vector, f: Finish) -> list[Part]:
    deck = [
        box(f.main, (0.8, 1.75, 0.14), (0, 0, 0.03), 0.04),
        box(paint("charcoal", "fabric"), (0.5, 1.5, 0.012), (0, 0.06, 0.17)),
        *mirrored(box(STEEL, (0.12, 1.6, 0.02), (0.33, 0.05, 0.165), 0.008)),
    ]
    hood = hull(
        f.main,
        [(-0.88, 0.6, 0.05, 0.2), (-0.8, 0.7, 0.04, 0.28), (-0.55, 0.66, 0.1, 0.26), (-0.4, 0.5, 0.14, 0.18)],
        0.05,
    )
    posts = [
        pipe(STEEL, [(s * 0.38, -0.62, 0.15), (s * 0.38, -0.7, 1.15), (s * 0.38, -0.2, 0.95)], 0.026, 0.12)
        for s in (-1, 1)
    ]
    console = [
        box(f.main, (0.84, 0.16, 0.22), (0, -0.68, 1.12), 0.04, 0.35),
        placed(
            picture(paint("teal", "screen", 0.8, 0.35), 0.4, 0.16, (0, 0, 0)),
            (0, -0.59, 1.15),
            np.array([[1.0, 0, 0], [0, 0.93, -0.36], [0, 0.36, 0.93]]),
        ),
    ]
    return [*deck, hood, *posts, *console]


def exercise_bike(size: Vector, f: Finish) -> list[Part]:
    base = [pipe(f.main, [(-0.24, y, 0.04), (0.24, y, 0.04)], 0.03) for y in (-0.48, 0.48)] + [
        pipe(f.main, [(0, -0.48, 0.05), (0, 0.48, 0.05)], 0.035),
        pipe(f.main, [(0, -0.05, 0.3), (0, 0.48, 0.05)], 0.03),
    ]
    wheel_ = [
        placed(
            turned(STEEL, [(0, -0.02), (0.2, -0.02), (0.24, -0.03), (0.24, 0.03), (0.2, 0.02), (0, 0.02)]),
            (0, 0.3, 0.34),
            LYING,
        ),
        hull(f.main.shaded(0.8), [(-0.14, 0.06, 0.24, 0.42), (0.1, 0.09, 0.2, 0.5), (0.3, 0.09, 0.26, 0.44)], 0.03),
    ]
    posts = [
        pipe(f.main, [(0, 0.0, 0.3), (0, -0.22, 0.85)], 0.028),
        pipe(f.main, [(0, 0.2, 0.3), (0, 0.34, 1.08)], 0.028),
    ]
    seat = tapered(paint("black", "leather"), [(0.12, 0.26, 0), (0.2, 0.28, 0.06)], (0, -0.25, 0.86), 0.06)
    bars = [pipe(DARK, [(s * 0.2, 0.1, 1.2), (s * 0.2, 0.3, 1.12), (0, 0.36, 1.08)], 0.016, 0.06) for s in (-1, 1)]
    rest = [
        box(paint("teal", "screen", 0.6, 0.3), (0.18, 0.03, 0.12), (0, 0.38, 1.12), 0.01),
        *(box(DARK, (0.1, 0.08, 0.025), (s * 0.12, 0.02 + s * 0.12, 0.3 - s * 0.1)) for s in (-1, 1)),
        *(pipe(STEEL, [(s * 0.06, 0.02, 0.3), (s * 0.08, 0.02 + s * 0.12, 0.3 - s * 0.1)], 0.012) for s in (-1, 1)),
    ]
    return [*base, *wheel_, *posts, seat, *bars, *rest]


def weight_bench(size: Vector, f: Finish) -> list[Part]:
    pad = [box(f.main, (0.28, 1.1, 0.08), (0, 0.12, 0.38), 0.03)]
    frame = [
        pipe(STEEL, [(0, -0.4, 0.34), (0, 0.6, 0.34)], 0.03),
        pipe(STEEL, [(-0.22, 0.55, 0.03), (0.22, 0.55, 0.03)], 0.025),
        pipe(STEEL, [(0, 0.55, 0.03), (0, 0.55, 0.36)], 0.028),
    ]
    rack = [pipe(STEEL, [(s * 0.33, -0.45, 0), (s * 0.33, -0.45, 1.0)], 0.028) for s in (-1, 1)] + [
        pipe(STEEL, [(-0.33, -0.45, 0.3), (0.33, -0.45, 0.3)], 0.025)
    ]
    bar = [pipe(STEEL, [(-0.7, -0.4, 1.0), (0.7, -0.4, 1.0)], 0.014)]
    discs = [
        placed(
            turned(paint("charcoal", "metal"), [(0, -0.02), (r, -0.02), (r, 0.02), (0, 0.02)]),
            (s * u, -0.4, 1.0),
            LYING,
        )
        for s in (-1, 1)
        for u, r in ((0.5, 0.21), (0.55, 0.21), (0.6, 0.14))
    ]
    return [*pad, *frame, *rack, *bar, *discs]


def gym_mat(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    return [
        box(f.main.shaded(1.0 if i % 2 else 0.9), (x, y / 3 - 0.006, z), (0, (i - 1) * y / 3, 0), 0.02)
        for i in range(3)
    ]


def rocking_horse(size: Vector, f: Finish) -> list[Part]:
    runners = [
        pipe(
            paint("honey brown", "wood"),
            [(s * 0.14, 0.45 * np.cos(a), 0.45 - 0.43 * np.sin(a) * 1.0) for a in np.linspace(0.45, np.pi - 0.45, 9)],
            0.022,
        )
        for s in (-1, 1)
    ]
    body = hull(
        f.main,
        [(-0.28, 0.1, 0.42, 0.54), (-0.2, 0.2, 0.38, 0.58), (0.12, 0.2, 0.38, 0.57), (0.24, 0.12, 0.42, 0.55)],
        0.09,
    )
    neck = sweep(
        f.main, rounded_ring(0.11, 0.17, 0.05), [(0, 0.18, 0.48), (0, 0.28, 0.68), (0, 0.31, 0.8)], [1.15, 0.9, 0.7]
    )
    head = hull(f.main, [(0.24, 0.1, 0.72, 0.86), (0.34, 0.12, 0.7, 0.85), (0.48, 0.08, 0.66, 0.74)], 0.035)
    legs = [pipe(f.main, [(s * 0.08, y, 0.44), (s * 0.13, 1.5 * y, 0.1)], 0.032) for s in (-1, 1) for y in (-0.2, 0.18)]
    hair = [
        pipe(paint("cream", "fabric"), [(0, 0.2, 0.9), (0, 0.18, 0.72), (0, 0.12, 0.6)], 0.03, 0.08),
        pipe(paint("cream", "fabric"), [(0, -0.27, 0.54), (0, -0.4, 0.5), (0, -0.44, 0.3)], 0.03, 0.08),
    ]
    saddle = [
        hull(
            paint("red", "leather"),
            [(-0.14, 0.22, 0.46, 0.6), (0.0, 0.22, 0.46, 0.595), (0.08, 0.22, 0.46, 0.61)],
            0.09,
        ),
        *mirrored(ellipsoid(DARK, (0.012,) * 3, (0.058, 0.34, 0.8))),
        pipe(DARK, [(-0.14, 0.28, 0.7), (0.14, 0.28, 0.7)], 0.014),
    ]
    return [*runners, body, neck, head, *legs, *hair, *saddle]
