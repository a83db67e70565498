"""What hangs on walls inside: boards, cloths, signs, small gear. The back is at -y.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    cloth,
    crown,
    hoop,
    hull,
    mirrored,
    patterned,
    pipe,
    placed,
    plate,
    sign,
    skin,
    tapered,
    two_sided,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, turned
from flymirage_core.worldgen.shapes.foliage import greenery
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")


def _board(f: Finish, size: Vector, face: Part) -> list[Part]:
    x, y, z = size
    rim = [box(f.second, (x, y, 0.05), (0, 0, h), 0.006) for h in (0, z - 0.05)] + [
        *mirrored(box(f.second, (0.05, y, z), (x / 2 - 0.025, 0, 0), 0.006))
    ]
    return [*rim, face, box(f.second, (x * 0.8, 0.09, 0.02), (0, y / 2 + 0.02, 0), 0.004)]


def blackboard(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    lines = ("E = m c2|F = m a|v = s / t", "HOMEWORK|page 27|ex. 3 to 9", "MENU|soup 4.50|pie 6.00", "a2 + b2|= c2")[
        f.seed % 4
    ]
    face = sign(lines, x - 0.1, z - 0.1, (0, 0.012, 0.05), "forest green" if f.chosen(2) else "charcoal", "chalk")
    return [
        *_board(f, (x, 0.04, z), face),
        box(WHITE, (0.06, 0.012, 0.012), (0.2, 0.05, 0.02)),
        box(paint("chalk", "fabric"), (0.12, 0.05, 0.03), (-0.3, 0.05, 0.02), 0.01),
    ]


def whiteboard(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    words = ("SPRINT 12|plan|build|ship", "IDEAS|1 map|2 test|3 fly", "Q3 GOALS|cost|speed", "TO DO|call|write|check")[
        f.seed % 4
    ]
    face = sign(words, x - 0.08, z - 0.08, (0, 0.012, 0.04), "white", ("blue", "red", "forest green")[f.seed % 3])
    pens = [
        box(paint(c), (0.12, 0.018, 0.018), (0.2 + 0.16 * i, 0.05, 0.02), 0.006)
        for i, c in enumerate(("red", "blue", "green"))
    ]
    return [*_board(replace(f, second=STEEL), (x, 0.04, z), face), *pens]


def projection_screen(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    case = box(f.second, (x, 0.1, 0.1), (0, 0, z - 0.1), 0.03)
    face = picture(
        paint("white", "screen" if f.seed % 2 else "landscape", 0.45, 0.6, f.seed % 97),
        x - 0.2,
        z - 0.28,
        (0, 0.008, 0.12),
    )
    return [
        case,
        box(WHITE, (x - 0.06, 0.01, z - 0.1), (0, 0, 0.03)),
        face,
        pipe(f.second, [(-x / 2 + 0.02, 0, 0.02), (x / 2 - 0.02, 0, 0.02)], 0.02),
    ]


def curtain(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    rod = [
        pipe(BRASS, [(-x / 2, 0, z - 0.04), (x / 2, 0, z - 0.04)], 0.018),
        *mirrored(ellipsoid(BRASS, (0.035,) * 3, (x / 2, 0, z - 0.04))),
    ]
    halves = [
        p for s in (-1, 1) for p in two_sided(cloth(f.main, x * 0.42, z - 0.08, (s * x * 0.27, 0, 0), 0.11, 0.12))
    ]
    ties = [box(f.main.shaded(0.7), (x * 0.44, 0.14, 0.06), (s * x * 0.27, 0, z * 0.42), 0.025) for s in (-1, 1)]
    return [*rod, *halves, *(ties if f.chosen(2) else [])]


def tapestry(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    weave = replace(f.main, texture="rug", detail=0.6, stretch=1.0)
    return [
        pipe(BRASS, [(-x / 2, 0, z - 0.02), (x / 2, 0, z - 0.02)], 0.015),
        picture(weave, x - 0.06, z - 0.12, (0, 0.012, 0.08)),
        box(f.main.shaded(0.6), (x - 0.06, 0.012, z - 0.12), (0, 0.003, 0.08)),
        *(
            box(f.main.shaded(1.2), (0.012, 0.01, 0.08), (u, 0.006, 0))
            for u in np.linspace(-x / 2 + 0.05, x / 2 - 0.05, 22)
        ),
    ]


def towel_rail(size: Vector, f: Finish) -> list[Part]:
    bars = [
        *mirrored(pipe(f.main, [(0.28, 0, 0), (0.28, 0, 0.9)], 0.016)),
        *(
            pipe(f.main, [(-0.28, 0, z), (0.28, 0, z)], 0.01)
            for z in (0.06, 0.14, 0.22, 0.36, 0.44, 0.52, 0.66, 0.74, 0.82)
        ),
    ]
    towel = paint(("teal", "coral", "ivory", "sage")[f.chosen(4)], "carpet")
    return [
        *bars,
        box(towel, (0.4, 0.05, 0.5), (0.02, 0.01, 0.3), 0.022),
        box(towel.shaded(0.75), (0.4, 0.052, 0.05), (0.02, 0.01, 0.36), 0.02),
        *(pipe(f.main, [(s * 0.28, 0, z), (s * 0.28, -0.06, z)], 0.012) for s in (-1, 1) for z in (0.1, 0.8)),
    ]


def cooker_hood(size: Vector, f: Finish) -> list[Part]:
    return [
        tapered(
            f.main,
            [(0.7, 0.5, 0), (0.7, 0.5, 0.06), (0.26, 0.26, 0.3), (0.24, 0.24, 0.7)],
            radius=0.01,
            lean=(0, 0, -0.1, -0.11),
        ),
        box(patterned("silver", "grille", "black", 0.3), (0.6, 0.4, 0.006), (0, 0, -0.004)),
        *(box(DARK, (0.03, 0.008, 0.02), (u, 0.251, 0.02)) for u in (-0.06, 0, 0.06)),
    ]


def dartboard(size: Vector, f: Finish) -> list[Part]:
    def wedge(a: float, r0: float, r1: float, colour: str) -> Part:
        t = np.linspace(a - 0.157, a + 0.157, 4)
        inner, outer = ([(r * np.cos(b), 0.0, r * np.sin(b)) for b in t] for r in (r0, r1))
        return skin(paint(colour), [outer, inner])[0]

    parts = [placed(turned(DARK, [(0, 0), (0.23, 0), (0.23, 0.035), (0, 0.036)]), (0, -0.02, 0.23), FACING)]
    for k in range(20):
        a, even = k * np.pi / 10, k % 2 == 0
        for r0, r1, one, two in (
            (0.016, 0.1, "black", "cream"),
            (0.1, 0.11, "red", "green"),
            (0.11, 0.165, "black", "cream"),
            (0.165, 0.176, "red", "green"),
        ):
            parts.append(placed(wedge(a, r0, r1, one if even else two), (0, 0.019, 0.23)))
    darts = [
        p
        for u, z in ((0.05, 0.28), (-0.04, 0.2))
        for p in (
            pipe(BRASS, [(u, 0.02, z), (u, 0.08, z)], 0.005),
            pipe(paint("red"), [(u, 0.08, z), (u, 0.12, z)], 0.008),
        )
    ]
    return [
        *parts,
        placed(turned(paint("red"), [(0.016, 0.021), (0, 0.022)]), (0, 0.0, 0.23), FACING),
        placed(hoop(STEEL, 0.178, 0.004), (0, 0.02, 0.23), FACING),
        *darts,
    ]


def warning_sign(size: Vector, f: Finish) -> list[Part]:
    """Enamelled plates: triangles and squares with legible words."""
    words = (
        "DANGER|HIGH|VOLTAGE",
        "RADIATION|RISK",
        "TOXIC|CHEMICALS",
        "NO ENTRY",
        "HARD HAT|AREA",
        "HOT|SURFACE",
        "LASER|IN USE",
    )[f.seed % 7]
    if f.seed % 3 == 0:
        triangle = [(-0.22, 0.02), (0.22, 0.02), (0, 0.42)]
        inner = [(0.82 * u, 0.03 + 0.06 + 0.78 * (v - 0.02)) for u, v in triangle]
        mark = [
            box(DARK, (0.035, 0.006, 0.14), (0, 0.02, 0.17), 0.002),
            ellipsoid(DARK, (0.022, 0.003, 0.022), (0, 0.022, 0.13)),
        ]
        return [plate(DARK, triangle, 0.02), plate(paint("yellow"), inner, 0.024, (0, 0.004, 0)), *mark]
    ground, ink = (("yellow", "black"), ("red", "white"), ("orange", "black"))[
        f.seed % 2 + (1 if f.seed % 5 == 0 else 0)
    ]
    return [
        box(paint(ink), (0.45, 0.02, 0.45), (0, 0, 0), 0.006),
        sign(words, 0.42, 0.42, (0, 0.0115, 0.015), ground, ink),
        box(patterned("yellow", "hazard"), (0.42, 0.004, 0.05), (0, 0.012, 0.015)),
    ]


def emergency_light(size: Vector, f: Finish) -> list[Part]:
    body = box(WHITE, (0.36, 0.08, 0.1), (0, -0.02, 0), 0.015)
    heads = [
        p
        for s in (-1, 1)
        for p in (
            placed(
                turned(WHITE, [(0, -0.04), (0.04, -0.035), (0.055, 0.02), (0.05, 0.02)]), (s * 0.1, 0.02, 0.15), FACING
            ),
            placed(turned(paint("cream", emission=1.8), [(0.05, 0.016), (0, 0.02)]), (s * 0.1, 0.02, 0.15), FACING),
        )
    ]
    return [
        body,
        *heads,
        box(paint("green", emission=1.0), (0.02, 0.004, 0.01), (0.13, 0.021, 0.05)),
        *mirrored(cylinder(WHITE, 0.012, 0.05, (0.1, 0, 0.08))),
    ]


def security_camera(size: Vector, f: Finish) -> list[Part]:
    plate_ = placed(turned(f.main, [(0, 0), (0.06, 0), (0.055, 0.02), (0, 0.02)]), (0, -0.17, 0.14), FACING)
    arm = pipe(f.main, [(0, -0.15, 0.14), (0, -0.08, 0.14), (0, -0.05, 0.09)], 0.014, 0.03)
    body = hull(
        f.main,
        [(-0.12, 0.07, 0.02, 0.09), (-0.1, 0.09, 0.01, 0.1), (0.1, 0.09, 0.0, 0.1), (0.14, 0.1, 0.02, 0.11)],
        0.03,
    )
    lens = placed(turned(DARK, [(0.034, 0), (0.03, 0.012), (0.018, 0.01), (0, 0.0)]), (0, 0.12, 0.05), FACING)
    return [
        plate_,
        arm,
        body,
        lens,
        ellipsoid(paint("red", emission=2), (0.005,) * 3, (0.025, 0.142, 0.085)),
        box(f.main, (0.11, 0.25, 0.008), (0, 0.03, 0.112), 0.003),
    ]


def first_aid_cabinet(size: Vector, f: Finish) -> list[Part]:
    return [
        box(WHITE, (0.4, 0.14, 0.5), (0, -0.01, 0), 0.015),
        box(WHITE.shaded(1.05), (0.37, 0.02, 0.47), (0, 0.062, 0.015), 0.006),
        *(
            box(paint("green"), s, (0, 0.075, b), 0.002)
            for s, b in (((0.06, 0.006, 0.2), 0.2), ((0.2, 0.006, 0.06), 0.27))
        ),
        sign("FIRST AID", 0.26, 0.06, (0, 0.0735, 0.1), "white", "green"),
        box(STEEL, (0.02, 0.02, 0.06), (0.16, 0.075, 0.24)),
    ]


def tool_board(size: Vector, f: Finish) -> list[Part]:
    parts = [box(f.main, (1.4, 0.03, 0.9), (0, -0.03, 0), 0.005)]
    red, steel = paint("red"), STEEL
    for u, length in zip(np.linspace(-0.6, -0.1, 6), (0.16, 0.18, 0.2, 0.22, 0.25, 0.28), strict=True):
        parts += [
            pipe(steel, [(u, 0, 0.8 - length), (u, 0, 0.8)], 0.011),
            placed(hoop(steel, 0.02, 0.007), (u, 0, 0.81), FACING),
            placed(hoop(steel, 0.02, 0.007), (u, 0, 0.79 - length), FACING),
        ]
    for u, colour in zip(np.linspace(0.1, 0.6, 5), ("red", "yellow", "blue", "green", "orange"), strict=True):
        parts += [
            pipe(paint(colour), [(u, 0, 0.7), (u, 0, 0.81)], 0.017),
            pipe(steel, [(u, 0, 0.55), (u, 0, 0.7)], 0.005),
        ]
    parts += [
        pipe(paint("honey brown", "wood"), [(-0.5, 0, 0.08), (-0.5, 0, 0.36)], 0.014),
        box(DARK, (0.15, 0.045, 0.05), (-0.5, 0, 0.36), 0.008),
    ]
    saw = [(0.0, 0.0), (0.42, 0.02), (0.42, 0.05), (0.0, 0.13)]
    parts += [
        plate(steel, [(a - 0.2, b) for a, b in saw], 0.006, (0.0, 0, 0.2)),
        box(paint("honey brown", "wood"), (0.12, 0.03, 0.14), (-0.25, 0, 0.2), 0.03),
    ]
    parts += [
        plate(red, [(0.0, 0.0), (0.07, -0.02), (0.1, 0.14), (0.06, 0.16)], 0.02, (0.38, 0, 0.15)),
        plate(red, [(0.1, -0.02), (0.17, 0.0), (0.11, 0.16), (0.07, 0.14)], 0.02, (0.38, 0, 0.15)),
        box(steel, (0.05, 0.02, 0.08), (0.465, 0, 0.3)),
    ]
    return [
        *parts,
        placed(hoop(paint("orange"), 0.09, 0.014), (0.2, 0, 0.28), FACING),
        placed(hoop(paint("orange"), 0.075, 0.014), (0.2, 0.01, 0.28), FACING),
    ]


def wall_planter(size: Vector, f: Finish) -> list[Part]:
    pot = [
        hull(f.main, [(-0.12, 0.6, 0.12, 0.28), (0.0, 0.62, 0.02, 0.28), (0.1, 0.56, 0.08, 0.28)], 0.06),
        box(f.second, (0.66, 0.012, 0.4), (0, -0.12, 0.05)),
    ]
    rng = f.generator()
    green = crown(
        greenery(f),
        [
            ((0.3, 0.11, 0.12), (0, 0.0, 0.36)),
            ((0.12, 0.1, 0.2), (-0.22, 0.08, 0.2)),
            ((0.12, 0.1, 0.16), (0.2, 0.09, 0.22)),
        ],
        (0.09, 0.045),
        220,
        rng,
        0.4,
    )
    return [*pot, *green]


def coat_hooks(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    board = box(f.main, (x, 0.02, 0.12), (0, -0.05, z - 0.12), 0.006)
    hooks = [
        p
        for u in np.linspace(-x / 2 + 0.1, x / 2 - 0.1, 5)
        for p in (
            pipe(BRASS, [(u, -0.04, z - 0.06), (u, 0.03, z - 0.09), (u, 0.05, z - 0.03)], 0.008, 0.03),
            ellipsoid(BRASS, (0.014,) * 3, (u, 0.05, z - 0.025)),
        )
    ]
    hat = [
        turned(
            paint(("tan", "charcoal", "burgundy")[f.chosen(3)], "fabric"),
            [(0.13, 0.02), (0.07, 0.03), (0.065, 0.1), (0.03, 0.115), (0, 0.11)],
        )
    ]
    return [
        board,
        *hooks,
        *(placed(p, (x * 0.2, 0.0, z - 0.2), FACING @ np.diag([0.7, 0.7, 0.5])) for p in hat),
        *two_sided(cloth(paint("rust", "fabric"), 0.12, z - 0.06, (-x * 0.2, 0.03, 0), 0.05, 0.03)),
    ]
