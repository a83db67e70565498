"""Small things of desks and shelves.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    cable,
    circle,
    hoop,
    hull,
    loft,
    mirrored,
    patterned,
    pipe,
    placed,
    plate,
    sign,
    tapered,
    wheel,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, smooth, turned
from flymirage_core.worldgen.shapes.foliage import BARK, greenery
from flymirage_core.worldgen.surfaces import Float, Leaves, Part, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")
BACK_TILT = np.array([[1.0, 0, 0], [0, 0.96, 0.28], [0, -0.28, 0.96]]).T


def desk_lamp(size: Vector, f: Finish) -> list[Part]:
    base = turned(f.main, [(0, 0), (0.09, 0), (0.085, 0.015), (0.02, 0.025), (0, 0.025)])
    arms = [
        pipe(f.main, [(0, 0, 0.02), (0, -0.12, 0.25)], 0.008),
        pipe(f.main, [(0, -0.12, 0.25), (0, 0.1, 0.45)], 0.008),
        ellipsoid(STEEL, (0.014,) * 3, (0, -0.12, 0.25)),
    ]
    tilt = np.array([[1.0, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]])
    shade = placed(
        turned(f.main, smooth([(0.07, -0.09), (0.06, -0.03), (0.022, 0.0), (0, 0.02)], 6)), (0, 0.12, 0.45), tilt
    )
    bulb = placed(ellipsoid(paint("cream", emission=2.0), (0.035, 0.035, 0.03), (0, 0, -0.07)), (0, 0.12, 0.45), tilt)
    return [base, *arms, shade, bulb]


def keyboard(size: Vector, f: Finish) -> list[Part]:
    keys = [
        box(
            f.main.shaded(1.25),
            (0.024, 0.022, 0.008),
            (-0.195 + 0.03 * i + 0.006 * (j % 2), -0.052 + 0.027 * j, 0.018),
            0.002,
        )
        for i in range(14)
        for j in range(5)
        if not (j == 4 and 3 < i < 9)
    ]
    return [
        tapered(f.main, [(0.44, 0.15, 0), (0.43, 0.145, 0.018)], radius=0.008),
        *keys,
        box(f.main.shaded(1.25), (0.15, 0.022, 0.008), (-0.02, 0.056, 0.018), 0.002),
    ]


def telephone(size: Vector, f: Finish) -> list[Part]:
    body = tapered(f.main, [(0.2, 0.2, 0), (0.19, 0.18, 0.03), (0.13, 0.08, 0.085)], radius=0.02, lean=(0, 0, -0.03))
    dial = placed(
        turned(STEEL, [(0.055, 0), (0.05, 0.008), (0.02, 0.008), (0, 0.01)]),
        (0, 0.04, 0.055),
        np.array([[1.0, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]]),
    )
    holes = [
        placed(
            placed(cylinder(DARK, 0.007, 0.002), (0.036 * np.cos(a), 0.036 * np.sin(a), 0.008)),
            (0, 0.04, 0.055),
            np.array([[1.0, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]]),
        )
        for a in np.arange(10) * 0.56
    ]
    handset = [
        pipe(f.main, [(-0.1, -0.04, 0.1), (-0.07, -0.04, 0.125), (0.07, -0.04, 0.125), (0.1, -0.04, 0.1)], 0.016, 0.03),
        *mirrored(turned(f.main, [(0, 0.07), (0.03, 0.072), (0.026, 0.1), (0, 0.11)], (0.1, -0.04, 0))),
    ]
    return [body, dial, *holes, *handset, cable(DARK, (-0.1, -0.02, 0.075), (-0.09, 0.06, 0.01), 0.02, 0.004)]


def radio(size: Vector, f: Finish) -> list[Part]:
    body = tapered(f.main, [(0.32, 0.13, 0), (0.32, 0.13, 0.2)], radius=0.03)
    front = [
        box(patterned("cream", "grille", "chestnut", 0.25), (0.16, 0.006, 0.14), (-0.06, 0.066, 0.03), 0.002),
        picture(replace(paint("cream", "dial", 0.25, 0.2), ink=(0.02, 0.02, 0.02)), 0.08, 0.08, (0.09, 0.068, 0.09)),
        *(
            placed(turned(BRASS, [(0, 0), (0.018, 0), (0.015, 0.018), (0, 0.018)]), (u, 0.065, 0.045), FACING)
            for u in (0.06, 0.115)
        ),
    ]
    return [
        body,
        *front,
        pipe(f.second, [(-0.13, 0, 0.2), (-0.13, 0, 0.24), (0.13, 0, 0.24), (0.13, 0, 0.2)], 0.008, 0.03),
        pipe(STEEL, [(0.14, -0.05, 0.2), (0.16, -0.05, 0.34)], 0.003),
    ]


def record_player(size: Vector, f: Finish) -> list[Part]:
    plinth_ = [
        box(f.main, (0.42, 0.36, 0.09), (0, 0, 0.015), 0.008),
        *(cylinder(DARK, 0.02, 0.02, (s * 0.17, t * 0.14, 0)) for s in (-1, 1) for t in (-1, 1)),
    ]
    disc = [
        turned(STEEL, [(0, 0.105), (0.15, 0.105), (0.15, 0.118), (0, 0.118)], (-0.04, 0, 0)),
        turned(DARK, [(0.147, 0.12), (0.05, 0.122)], (-0.04, 0, 0)),
        turned(paint(("red", "orange", "blue")[f.chosen(3)]), [(0.05, 0.122), (0, 0.122)], (-0.04, 0, 0)),
    ]
    arm = [
        cylinder(STEEL, 0.025, 0.05, (0.16, -0.12, 0.105)),
        pipe(STEEL, [(0.16, -0.12, 0.145), (0.15, 0.04, 0.145), (0.07, 0.1, 0.13)], 0.005, 0.04),
        box(DARK, (0.02, 0.035, 0.012), (0.06, 0.105, 0.122)),
    ]
    lid = [
        placed(
            box(replace(paint("powder blue", "glass"), opacity=0.3), (0.42, 0.34, 0.004)),
            (0, -0.2, 0.26),
            np.array([[1.0, 0, 0], [0, 0.35, 0.94], [0, -0.94, 0.35]]),
        )
    ]
    return [*plinth_, *disc, *arm, *lid]


def typewriter(size: Vector, f: Finish) -> list[Part]:
    body = hull(
        f.main,
        [
            (-0.16, 0.3, 0, 0.16),
            (-0.1, 0.34, 0, 0.17),
            (0.02, 0.34, 0, 0.13),
            (0.06, 0.34, 0, 0.06),
            (0.18, 0.32, 0, 0.04),
        ],
        0.03,
    )
    keys = [
        cylinder(DARK, 0.011, 0.012, (-0.115 + 0.0255 * i + 0.006 * j, 0.14 - 0.028 * j, 0.05 + 0.014 * j))
        for i in range(10)
        for j in range(4)
    ]
    roller = [
        pipe(DARK, [(-0.17, -0.09, 0.185), (0.17, -0.09, 0.185)], 0.022),
        *(pipe(STEEL, [(s * 0.17, -0.09, 0.185), (s * 0.2, -0.09, 0.185)], 0.016) for s in (-1, 1)),
        pipe(STEEL, [(-0.19, -0.08, 0.19), (-0.21, 0.0, 0.21)], 0.006),
    ]
    paper = box(paint("ivory", "page", detail=0.4), (0.2, 0.004, 0.16), (0, -0.1, 0.18), 0, 0.2)
    return [body, *keys, *roller, paper, box(DARK, (0.2, 0.03, 0.03), (0, -0.02, 0.14), 0.01)]


def picture_frame(size: Vector, f: Finish) -> list[Part]:
    rim = [box(f.main, (0.22, 0.016, 0.022), (0, 0, z), 0.004) for z in (0, 0.258)] + [
        *mirrored(box(f.main, (0.022, 0.016, 0.28), (0.099, 0, 0), 0.004))
    ]
    rest = [
        box(paint("chalk"), (0.19, 0.006, 0.25), (0, -0.003, 0.015)),
        picture(
            paint("white", "landscape" if f.seed % 2 else "painting", 0, 0.3, f.seed % 97),
            0.14,
            0.19,
            (0, 0.003, 0.045),
        ),
    ]
    return [
        *(placed(p, (0, 0.03, 0), BACK_TILT.T) for p in (*rim, *rest)),
        pipe(f.second, [(0, -0.06, 0), (0, -0.02, 0.2)], 0.008),
    ]


def microscope(size: Vector, f: Finish) -> list[Part]:
    base = [
        tapered(f.main, [(0.2, 0.24, 0), (0.18, 0.22, 0.03)], radius=0.03),
        box(DARK, (0.14, 0.14, 0.012), (0, 0.02, 0.15)),
        tapered(f.main, [(0.06, 0.05, 0.03), (0.05, 0.05, 0.26)], (0, -0.08, 0), 0.015),
    ]
    arm = pipe(f.main, [(0, -0.08, 0.24), (0, -0.07, 0.31), (0, 0.02, 0.31)], 0.022, 0.04)
    tube = [
        pipe(f.main, [(0, 0.02, 0.31), (0, -0.0, 0.31), (0, 0.06, 0.39)], 0.02),
        pipe(DARK, [(0, 0.06, 0.39), (0, 0.075, 0.415)], 0.018),
        turned(
            STEEL, [(0.006, 0.18), (0.012, 0.185), (0.014, 0.23), (0.024, 0.24), (0.024, 0.29), (0, 0.29)], (0, 0.02, 0)
        ),
    ]
    knobs = [
        *(pipe(STEEL, [(s * 0.02, -0.08, 0.1), (s * 0.055, -0.08, 0.1)], 0.022) for s in (-1, 1)),
        cylinder(paint("cream", emission=0.8), 0.02, 0.03, (0, 0.03, 0.03)),
    ]
    return [*base, arm, *tube, *knobs]


def flask(size: Vector, f: Finish) -> list[Part]:
    liquid = paint(("teal", "orange", "plum", "green")[f.generator().integers(4)], "water")
    glass = replace(f.main if f.main.texture == "glass" else paint("powder blue", "glass"), opacity=0.4)
    return [
        turned(
            glass, smooth([(0.075, 0), (0.08, 0.012), (0.07, 0.06), (0.028, 0.16), (0.025, 0.24), (0.03, 0.25)], 14)
        ),
        turned(replace(liquid, opacity=0.9), [(0, 0.003), (0.073, 0.003), (0.077, 0.012), (0.057, 0.085), (0, 0.085)]),
    ]


def bust(size: Vector, f: Finish) -> list[Part]:
    foot = turned(f.main, [(0, 0), (0.1, 0), (0.1, 0.02), (0.05, 0.04), (0.04, 0.09), (0.07, 0.1), (0, 0.1)])

    def ring(w: float, d: float, z: float, y: float = 0.0) -> Float:
        c = circle(0.5, 18)
        return np.column_stack([c[:, 0] * w, c[:, 1] * d + y, np.full(18, z)])

    chest = loft(
        f.main,
        np.array(
            [
                ring(0.1, 0.08, 0.1),
                ring(0.26, 0.15, 0.17),
                ring(0.29, 0.15, 0.21, -0.005),
                ring(0.2, 0.12, 0.245, -0.01),
                ring(0.09, 0.09, 0.27, -0.01),
                ring(0.085, 0.09, 0.31),
            ]
        ),
    )
    head = [
        ellipsoid(f.main, (0.062, 0.078, 0.085), (0, 0.005, 0.37)),
        ellipsoid(f.main, (0.045, 0.04, 0.035), (0, 0.045, 0.325)),
        tapered(f.main, [(0.022, 0.03, 0), (0.012, 0.012, 0.045)], (0, 0.08, 0.345), 0.005),
    ]
    hair = [
        ellipsoid(
            f.main.shaded(0.92),
            (0.024,) * 3,
            (0.06 * np.cos(a) * np.cos(b), -0.012 + 0.07 * np.sin(a) * np.cos(b), 0.385 + 0.062 * np.sin(b)),
        )
        for b in (0.35, 0.85)
        for a in np.arange(9) * 0.7
        if np.sin(a) < 0.55
    ] + [ellipsoid(f.main.shaded(0.92), (0.04, 0.05, 0.03), (0, -0.01, 0.44))]
    return [foot, chest, *head, *hair, *mirrored(ellipsoid(f.main, (0.01, 0.018, 0.024), (0.062, -0.005, 0.365)))]


def toy_car(size: Vector, f: Finish) -> list[Part]:
    body = [
        placed(
            hull(
                f.main,
                [
                    (-0.14, 0.1, 0.025, 0.06),
                    (-0.12, 0.13, 0.02, 0.075),
                    (0.06, 0.13, 0.02, 0.07),
                    (0.14, 0.1, 0.025, 0.055),
                ],
                0.02,
            ),
            (0, 0, 0),
            np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        ),
        placed(
            hull(
                paint("powder blue", "glass"),
                [(-0.1, 0.09, 0.06, 0.08), (-0.07, 0.1, 0.06, 0.118), (0.0, 0.1, 0.06, 0.118), (0.05, 0.1, 0.06, 0.07)],
                0.015,
            ),
            (0, 0, 0),
            np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        ),
    ]
    wheels = [
        placed(p, rotation=np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]))
        for s in (-1, 1)
        for y in (-0.085, 0.085)
        for p in wheel(DARK, paint("yellow"), 0.032, 0.02, (s * 0.062, y, 0.032))
    ]
    return [
        *body,
        *wheels,
        *(ellipsoid(paint("yellow", emission=0.4), (0.008, 0.012, 0.012), (0.138, s * 0.035, 0.045)) for s in (-1, 1)),
    ]


def dollhouse(size: Vector, f: Finish) -> list[Part]:
    walls = [box(f.main, (0.56, 0.3, 0.36), (0, 0, 0.02)), plate(f.main, [(-0.28, 0.38), (0.28, 0.38), (0, 0.58)], 0.3)]
    roof = [
        placed(
            box(paint("brick red", "shingles", detail=0.5), (0.4, 0.36, 0.02)),
            (s * 0.155, 0, 0.475),
            np.array([[0.81, 0, s * 0.58], [0, 1, 0], [-s * 0.58, 0, 0.81]]),
        )
        for s in (-1, 1)
    ]
    windows = [
        p
        for u in (-0.17, 0.17)
        for z in (0.06, 0.23)
        for p in (
            box(WHITE, (0.12, 0.008, 0.11), (u, 0.152, z)),
            *(
                box(paint("powder blue", emission=0.15), (0.046, 0.012, 0.09), (u + s * 0.027, 0.152, z + 0.01))
                for s in (-1, 1)
            ),
            *(box(f.second, (0.03, 0.012, 0.11), (u + s * 0.078, 0.152, z)) for s in (-1, 1)),
        )
    ]
    door = [
        box(paint("navy"), (0.09, 0.012, 0.15), (0, 0.152, 0.02)),
        ellipsoid(BRASS, (0.006,) * 3, (0.03, 0.16, 0.09)),
        plate(
            paint("powder blue", emission=0.15),
            [(0.04 * np.cos(a), 0.04 * np.sin(a)) for a in np.arange(12) * 0.5236],
            0.012,
            (0, 0.152, 0.46),
        ),
    ]
    return [
        *walls,
        *roof,
        *windows,
        *door,
        box(paint("moss green", "grass"), (0.6, 0.36, 0.02)),
        box(paint("brick red", "bricks"), (0.05, 0.05, 0.16), (0.16, -0.05, 0.44)),
        box(WHITE, (0.56, 0.31, 0.012), (0, 0, 0.2)),
    ]


def trophy(size: Vector, f: Finish) -> list[Part]:
    base = box(paint("black", "marble"), (0.12, 0.12, 0.06), (0, 0, 0), 0.006)
    cup = turned(
        f.main,
        [
            *smooth([(0.045, 0.06), (0.02, 0.08), (0.012, 0.14), (0.03, 0.17), (0.07, 0.24), (0.075, 0.33)], 14),
            (0.08, 0.335),
            (0.07, 0.335),
            (0.05, 0.22),
            (0, 0.2),
        ],
    )
    ears = mirrored(pipe(f.main, [(0.07, 0, 0.31), (0.105, 0, 0.31), (0.1, 0, 0.23), (0.05, 0, 0.2)], 0.007, 0.03))
    return [
        base,
        cup,
        ears[0],
        pipe(f.main, [(-0.07, 0, 0.31), (-0.105, 0, 0.31), (-0.1, 0, 0.23), (-0.05, 0, 0.2)], 0.007, 0.03),
        sign("WINNER", 0.09, 0.03, (0, 0.062, 0.015), "brass"),
    ]


def potted_orchid(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    pot = turned(f.main, [(0, 0), (0.055, 0), (0.07, 0.11), (0.062, 0.11), (0.055, 0.095), (0, 0.095)])
    green = greenery(f)
    stems, centres, lengths, widths = [], [], [], []
    for turn, high in ((0.3, 0.46), (2.6, 0.4)):
        out = np.array([np.cos(turn), np.sin(turn), 0.0])
        path = [
            (0, 0, 0.09),
            tuple(out * 0.02 + [0, 0, 0.7 * high]),
            tuple(out * 0.07 + [0, 0, high]),
            tuple(out * 0.13 + [0, 0, high - 0.04]),
        ]
        stems.append(pipe(green.shaded(0.8), path, 0.004, 0.05))
        for k in range(5):
            spot = out * (0.03 + 0.024 * k) + [0, 0, high - 0.03 * abs(k - 1.5)]
            for b in np.arange(5) * 1.2566:
                petal = np.array([np.cos(b), 0.25, np.sin(b)]) * 0.026
                centres.append(spot + petal * 0.8 + rng.normal(0, 0.003, 3))
                lengths.append(petal)
                widths.append(np.cross(petal, [0.0, 1.0, 0.0]) * 0.75)
    bloom = paint(("pink", "white", "lavender")[f.chosen(3)], "plain", seed=f.seed % 97)
    flowers = Part(Leaves(np.array(centres), np.array(lengths), np.array(widths)), bloom)
    a = np.arange(5) * 1.35
    out = np.stack([np.cos(a), np.sin(a), 0 * a + 0.35], 1)
    leaves = Part(
        Leaves(out * 0.07 + [0, 0, 0.1], out * 0.08, np.stack([-np.sin(a), np.cos(a), 0 * a], 1) * 0.032), green
    )
    return [
        pot,
        turned(paint("chocolate", "soil"), [(0.058, 0.098), (0, 0.1)]),
        *stems,
        flowers,
        leaves,
        *(pipe(BARK, [(0, 0.01, 0.09), (0.01, 0.01, 0.4)], 0.003),),
    ]


def fan(size: Vector, f: Finish) -> list[Part]:
    base = [
        turned(f.main, [(0, 0), (0.1, 0), (0.09, 0.02), (0.025, 0.035), (0.02, 0.2), (0, 0.2)]),
        pipe(f.main, [(0, -0.1, 0.27), (0, 0.0, 0.27)], 0.045),
    ]
    guard = [
        placed(hoop(STEEL, r, 0.003), (0, y, 0.27), FACING)
        for r, y in ((0.15, 0.02), (0.15, 0.0), (0.15, 0.05), (0.1, 0.06), (0.05, 0.065), (0.1, -0.01))
    ]
    wires = [
        placed(
            pipe(STEEL, [(0.02, 0, 0.065), (0.1, 0, 0.06), (0.15, 0, 0.03)], 0.0018), (0, 0, 0.27), FACING @ _spin(a)
        )
        for a in np.arange(20) * 0.314
    ]
    blades = [
        placed(
            plate(f.main.shaded(0.8), [(0.0, -0.03), (0.1, -0.06), (0.14, 0.0), (0.11, 0.05), (0.0, 0.02)], 0.004),
            (0, 0.025, 0.27),
            _about_y(a),
        )
        for a in (0, 2.09, 4.19)
    ]
    return [
        *base,
        *guard,
        *wires,
        *blades,
        placed(turned(f.main, [(0.03, 0), (0.02, 0.03), (0, 0.032)]), (0, 0.03, 0.27), FACING),
    ]


def _spin(angle: float) -> Float:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def _about_y(angle: float) -> Float:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1.0, 0], [-s, 0, c]])
