"""What stands in streets and squares.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    bolts,
    group,
    hoop,
    mirrored,
    patterned,
    pipe,
    placed,
    plate,
    rounded_path,
    ruled,
    sign,
    spun,
    sweep,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Float, Part, Vector

IRON = paint("charcoal", "metal")
STREETS = ("STATION", "CENTRE", "HARBOUR", "MARKET", "PARK", "MUSEUM", "TOWN HALL", "MILL LANE")


def park_bench(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    slats = [box(f.main, (x, 0.075, 0.035), (0, v, 0.42), 0.01) for v in (-0.14, -0.05, 0.04, 0.13, 0.22)]
    backs = [box(f.main, (x, 0.03, 0.085), (0, -0.2 - 0.09 * (h - 0.5), h), 0.01, 0.1) for h in (0.52, 0.64, 0.76)]
    side = rounded_path([(0, 0.27, 0), (0, 0.2, 0.4), (0, -0.17, 0.4), (0, -0.26, 0.86)], 0.08)
    rear = rounded_path([(0, -0.3, 0), (0, -0.16, 0.22), (0, -0.17, 0.42)], 0.06)
    arm = rounded_path([(0, -0.2, 0.62), (0, 0.2, 0.64), (0, 0.25, 0.58), (0, 0.2, 0.4)], 0.06)
    frames = [p for line in (side, rear, arm) for p in mirrored(placed(pipe(f.second, line, 0.022), (x * 0.42, 0, 0)))]
    return [*slats, *backs, *frames]


def street_lamp(size: Vector, f: Finish) -> list[Part]:
    glow = paint("cream", emission=1.6)
    foot = turned(
        f.main,
        [(0, 0), (0.2, 0), (0.2, 0.06), (0.13, 0.12), (0.12, 0.7), (0.09, 0.75), (0.06, 0.9), (0.045, 4.0), (0, 4.0)],
    )
    if f.chosen(2):  # a lantern on top
        cage = turned(f.main, [(0.05, 3.9), (0.14, 4.0), (0.15, 4.05), (0, 4.06)])
        glass = turned(glow, [(0.12, 4.05), (0.2, 4.5), (0, 4.5)])
        roof = turned(f.main, smooth([(0.25, 4.48), (0.2, 4.58), (0.05, 4.74), (0.02, 4.86), (0, 4.88)], 8))
        bars = spun(pipe(f.main, [(0.125, 0, 4.05), (0.205, 0, 4.5)], 0.012), 6)
        return [
            foot,
            cage,
            glass,
            roof,
            *bars,
            hoop(f.main, 0.09, 0.02, (0, 0, 2.6)),
            hoop(f.main, 0.08, 0.02, (0, 0, 3.4)),
        ]
    arm = pipe(f.main, [(0, 0, 3.9), (0, 0, 4.75), (0, 0.4, 4.85)], 0.04, 0.3)
    head = tapered(f.main, [(0.2, 0.5, 0.0), (0.24, 0.56, 0.05), (0.12, 0.4, 0.11)], (0, 0.5, 4.8), 0.05)
    return [foot, arm, head, box(glow, (0.16, 0.42, 0.02), (0, 0.5, 4.785))]


def traffic_light(size: Vector, f: Finish) -> list[Part]:
    pole = turned(IRON, [(0, 0), (0.16, 0), (0.15, 0.05), (0.06, 0.1), (0.05, 3.3), (0, 3.3)])
    case = box(f.main, (0.3, 0.2, 0.95), (0, 0.14, 2.3), 0.04)
    parts = [pole, case]
    for i, (colour, lit) in enumerate((("green", 0.1), ("mustard", 0.1), ("red", 2.0))):
        z = 2.47 + 0.29 * i
        lamp = ellipsoid(paint(colour, emission=lit), (0.095, 0.03, 0.095), (0, 0.245, z))
        hood = [(0.12 * np.cos(a), 0.12 * np.sin(a)) for a in np.linspace(-0.4, np.pi + 0.4, 9)]
        rows = [[(u, y, z + v) for u, v in hood] for y in (0.24, 0.4)]
        parts += [lamp, ruled(IRON, rows[0], rows[1]), ruled(IRON, rows[1], rows[0])]
    return [*parts, box(paint("charcoal"), (0.22, 0.12, 0.34), (0, 0.1, 1.75), 0.03)]


def hydrant(size: Vector, f: Finish) -> list[Part]:
    body = turned(
        f.main,
        [(0, 0), (0.17, 0), (0.17, 0.04), (0.11, 0.05), (0.1, 0.48), (0.135, 0.49), (0.135, 0.54), (0.12, 0.55),
         *smooth([(0.115, 0.56), (0.1, 0.66), (0.05, 0.72), (0.03, 0.73)], 6), (0.03, 0.78), (0, 0.78)],
    )  # fmt: skip
    cap = [(0, 0.0), (0.05, 0.0), (0.05, 0.06), (0.065, 0.06), (0.065, 0.1), (0.03, 0.12), (0.03, 0.15), (0, 0.15)]
    side = placed(turned(f.main, cap), (0.08, 0, 0.42), np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]))
    left = placed(turned(f.main, cap), (-0.08, 0, 0.42), np.array([[0.0, 0, -1], [1, 0, 0], [0, -1, 0]]))
    front = placed(
        turned(f.main, [(r * 1.35, h) for r, h in cap]), (0, 0.08, 0.36), np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    )
    return [body, side, left, front, *bolts(f.second, 0.15, 8, 0.014, 0.035)]


def mailbox(size: Vector, f: Finish) -> list[Part]:
    if f.chosen(2):  # a pillar box
        body = turned(
            f.main,
            [
                (0, 0),
                (0.25, 0),
                (0.25, 0.12),
                (0.22, 0.14),
                (0.22, 1.2),
                (0.26, 1.22),
                (0.26, 1.3),
                (0.2, 1.38),
                (0, 1.42),
            ],
        )
        return [
            body,
            box(IRON, (0.24, 0.02, 0.03), (0, 0.225, 1.08)),
            box(paint("white"), (0.16, 0.02, 0.2), (0, 0.22, 0.75)),
            box(f.main.shaded(0.8), (0.26, 0.02, 0.5), (0, 0.215, 0.2)),
        ]
    top = [(0.28 * np.cos(a), 1.0 + 0.26 * np.sin(a)) for a in np.linspace(0, np.pi, 13)]
    body = plate(f.main, [(-0.28, 0.2), (0.28, 0.2), *top], 0.5)
    legs = [box(IRON, (0.05, 0.05, 0.22), (s * 0.22, t * 0.2, 0)) for s in (-1, 1) for t in (-1, 1)]
    return [
        body, *legs, box(f.main.shaded(1.15), (0.4, 0.05, 0.1), (0, 0.25, 1.0), 0.02),
        box(IRON, (0.34, 0.03, 0.025), (0, 0.265, 1.04)), sign("POST", 0.34, 0.14, (0, 0.256, 0.62), "white", "navy"),
    ]  # fmt: skip


def bollard(size: Vector, f: Finish) -> list[Part]:
    band = turned(paint("white", emission=0.1), [(0.082, 0.7), (0.084, 0.72), (0.084, 0.8), (0.082, 0.82)])
    form = [
        (0, 0),
        (0.11, 0),
        (0.11, 0.05),
        (0.08, 0.08),
        (0.075, 0.86),
        (0.095, 0.88),
        (0.095, 0.92),
        (0.06, 0.97),
        (0, 1.0),
    ]
    return [turned(f.main, form), band]


def litter_bin(size: Vector, f: Finish) -> list[Part]:
    slats = spun(box(f.main, (0.09, 0.02, 0.62), (0, 0.24, 0.1), 0.006), 14)
    inner = turned(paint("charcoal"), [(0, 0.06), (0.22, 0.06), (0.22, 0.72), (0.2, 0.72), (0.2, 0.3), (0, 0.3)])
    hood = turned(f.second, smooth([(0.27, 0.9), (0.24, 0.98), (0.1, 1.05), (0, 1.06)], 8))
    posts = spun(box(f.second, (0.03, 0.03, 0.9), (0, 0.24, 0)), 4, 0.4)
    return [
        *slats,
        inner,
        hood,
        *posts,
        hoop(f.second, 0.25, 0.012, (0, 0, 0.2), 0.04),
        hoop(f.second, 0.25, 0.012, (0, 0, 0.66), 0.04),
    ]


def bus_stop(size: Vector, f: Finish) -> list[Part]:
    glass = replace(paint("powder blue", "glass"), opacity=0.3)
    posts = [box(f.main, (0.08, 0.08, 2.4), (u, v, 0)) for u in (-1.7, 0, 1.7) for v in (-0.6,)]
    posts += [box(f.main, (0.08, 0.08, 2.4), (s * 1.7, 0.45, 0)) for s in (-1, 1)]
    roof = tapered(f.main, [(3.7, 1.6, 2.4), (3.7, 1.6, 2.46), (3.5, 1.4, 2.52)], radius=0.1)
    panes = [box(glass, (1.6, 0.02, 1.8), (s * 0.85, -0.6, 0.35)) for s in (-1, 1)]
    panes.append(box(glass, (0.02, 1.0, 1.8), (-1.7, -0.08, 0.35)))
    poster = [box(f.main, (0.1, 1.1, 1.9), (1.7, -0.08, 0.3), 0.02)]
    poster += [
        box(replace(paint("white", "landscape", 0.35, 0.6, f.seed)), (0.012, 0.95, 1.6), (u, -0.08, 0.42))
        for u in (1.642, 1.758)
    ]
    seat = [box(paint("oak brown", "wood"), (2.2, 0.3, 0.04), (-0.2, -0.4, 0.46), 0.01)]
    seat += [box(f.main, (0.05, 0.25, 0.46), (u, -0.4, 0)) for u in (-1.1, 0.7)]
    name = sign(STREETS[f.chosen(len(STREETS))], 2.2, 0.26, (0, 0.81, 2.12), "white", "navy", 0.2)
    return [*posts, roof, *panes, *poster, *seat, box(f.main, (2.3, 0.03, 0.3), (0, 0.79, 2.1)), name]


def phone_booth(size: Vector, f: Finish) -> list[Part]:
    glass = replace(paint("powder blue", "glass"), opacity=0.35)
    posts = [box(f.main, (0.09, 0.09, 2.2), (s * 0.4, t * 0.4, 0)) for s in (-1, 1) for t in (-1, 1)]
    roof = tapered(f.main, [(0.92, 0.92, 2.2), (0.96, 0.96, 2.24), (0.9, 0.9, 2.42), (0.6, 0.6, 2.52)], radius=0.06)
    parts = [*posts, roof, box(f.main, (0.92, 0.92, 0.1))]
    side = [box(glass, (0.72, 0.015, 1.8), (0, 0.4, 0.35)), box(f.main, (0.72, 0.05, 0.28), (0, 0.4, 0.1))]
    side += [box(f.main, (0.72, 0.03, 0.03), (0, 0.41, z)) for z in np.linspace(0.38, 2.1, 7)]
    side += [box(f.main, (0.025, 0.03, 1.8), (u, 0.41, 0.35)) for u in (-0.17, 0.17)]
    for k in range(4):
        parts += group(side, yaw=k * np.pi / 2)
        parts.append(placed(sign("TELEPHONE", 0.66, 0.13, (0, 0.466, 2.24), "white", "black", 0.3), rotation=_turn(k)))
    return [*parts, box(paint("black"), (0.25, 0.14, 0.5), (0, -0.3, 1.1), 0.02)]


def _turn(quarter: int) -> Float:
    c, s = np.cos(quarter * np.pi / 2), np.sin(quarter * np.pi / 2)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def kiosk(size: Vector, f: Finish) -> list[Part]:
    body = tapered(f.main, [(2.2, 1.8, 0.0), (2.2, 1.8, 2.3)], radius=0.25)
    roof = tapered(f.second, [(2.6, 2.2, 2.3), (2.66, 2.26, 2.36), (2.6, 2.2, 2.46), (1.2, 0.8, 2.8)], radius=0.3)
    hatch = [
        box(paint("charcoal"), (1.5, 0.04, 0.95), (0, 0.9, 1.05)),
        box(f.second, (1.8, 0.35, 0.05), (0, 1.0, 0.98), 0.01),
    ]
    shelf = box(replace(paint("white", "labels", 0.15, 0.4, f.seed)), (1.4, 0.03, 0.6), (0, 0.915, 1.3))
    racks = box(paint("white", "labels", 0.0, 0.4, f.seed + 1), (1.7, 0.06, 0.6), (0, 0.92, 0.3))
    awning = ruled(
        patterned("burgundy", "stripes", "chalk"),
        [(-0.95, 1.5, 2.0), (0.95, 1.5, 2.0)],
        [(-0.95, 0.92, 2.2), (0.95, 0.92, 2.2)],
    )
    name = sign(
        ("NEWS", "COFFEE", "TICKETS", "FLOWERS")[f.chosen(4)], 1.6, 0.3, (0, 1.135, 2.28), "cream", "burgundy", 0.3
    )
    return [body, roof, *hatch, shelf, racks, awning, box(f.second, (1.7, 0.1, 0.34), (0, 1.08, 2.26)), name]


def parking_meter(size: Vector, f: Finish) -> list[Part]:
    pole = turned(IRON, [(0, 0), (0.1, 0), (0.1, 0.02), (0.035, 0.04), (0.03, 1.0), (0, 1.0)])
    head = tapered(
        f.main, [(0.18, 0.13, 0), (0.24, 0.16, 0.08), (0.24, 0.16, 0.26), (0.14, 0.12, 0.36)], (0, 0, 1.0), 0.05
    )
    return [
        pole,
        head,
        box(paint("sky blue", "screen", 0.4, 0.5), (0.15, 0.01, 0.09), (0, 0.081, 1.18)),
        box(IRON, (0.1, 0.02, 0.03), (0, 0.08, 1.1)),
    ]


def road_sign(size: Vector, f: Finish) -> list[Part]:
    pole = turned(paint("silver", "brushed"), [(0, 0), (0.03, 0), (0.03, 2.35), (0, 2.36)])
    words, ground, ink = (("STOP", "red", "white"), ("ONE WAY", "blue", "white"), ("SLOW", "yellow", "black"))[
        f.chosen(3)
    ]
    sides, r = (8, 0.4) if words == "STOP" else (24, 0.36)
    turn = np.pi / sides
    outline = [(r * np.cos(a), r * np.sin(a)) for a in turn + 2 * np.pi * np.arange(sides) / sides]
    rim = plate(paint("white"), outline, 0.02, (0, 0.045, 2.1))
    face = plate(paint(ground), [(0.92 * u, 0.92 * v) for u, v in outline], 0.03, (0, 0.055, 2.1))
    return [pole, rim, face, sign(words, 0.54, 0.26, (0, 0.08, 1.97), ground, ink)]


def concrete_barrier(size: Vector, f: Finish) -> list[Part]:
    section = [(0.3, 0), (0.3, 0.08), (0.17, 0.33), (0.09, 0.9), (-0.09, 0.9), (-0.17, 0.33), (-0.3, 0.08), (-0.3, 0)]
    body = sweep(f.main, section, [(-1.0, 0, 0), (1.0, 0, 0)])
    return [
        body,
        *(
            box(patterned("yellow", "hazard", "black"), (0.3, 0.01, 0.2), (s * 0.7, 0.135, 0.55), 0, 0.14)
            for s in (-1, 1)
        ),
    ]


def barricade(size: Vector, f: Finish) -> list[Part]:
    stripes = patterned("red", "hazard", "white")
    boards = [box(stripes, (1.5, 0.03, 0.2), (0, 0.1 - 0.1 * i, 0.85 - 0.32 * i), 0.005) for i in range(2)]
    legs = [pipe(f.second, [(s * 0.62, t * 0.32, 0), (s * 0.62, 0, 1.1)], 0.022) for s in (-1, 1) for t in (-1, 1)]
    lamps = [ellipsoid(paint("orange", emission=1.2), (0.07, 0.05, 0.07), (s * 0.55, 0.0, 1.14)) for s in (-1, 1)]
    return [*boards, *legs, *lamps]


def bicycle_rack(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    hoops = [
        pipe(f.main, [(u, -0.35, 0), (u, -0.35, 0.78), (u, 0.35, 0.78), (u, 0.35, 0)], 0.025, 0.25)
        for u in np.linspace(-x / 2 + 0.1, x / 2 - 0.1, max(3, round(x / 0.55)))
    ]
    return [*hoops, *(box(f.main, (x, 0.07, 0.02), (0, v, 0)) for v in (-0.35, 0.35))]


def wheelie_bin(size: Vector, f: Finish) -> list[Part]:
    body = tapered(f.main, [(0.46, 0.5, 0.08), (0.56, 0.66, 0.95), (0.6, 0.7, 0.95), (0.6, 0.7, 1.0)], radius=0.05)
    lid = tapered(f.main.shaded(0.75), [(0.6, 0.74, 1.0), (0.6, 0.74, 1.03), (0.5, 0.5, 1.1)], (0, 0.02, 0), 0.05)
    wheels = [pipe(IRON, [(s * 0.24, -0.28, 0.11), (s * 0.3, -0.28, 0.11)], 0.11) for s in (-1, 1)]
    return [
        body,
        lid,
        *wheels,
        pipe(IRON, [(-0.25, -0.4, 1.0), (0.25, -0.4, 1.0)], 0.02),
        sign("RECYCLE", 0.36, 0.12, (0, 0.32, 0.7), "white", "forest green"),
    ]


def dumpster(size: Vector, f: Finish) -> list[Part]:
    body = tapered(f.main, [(1.9, 1.1, 0.14), (2.1, 1.4, 1.15), (2.16, 1.46, 1.15), (2.16, 1.46, 1.22)], radius=0.03)
    ribs = [
        box(f.main.shaded(0.85), (0.07, 0.05, 0.98), (u, 0.6, 0.16), 0, -0.14) for u in (-0.85, -0.42, 0.0, 0.42, 0.85)
    ]
    lids = [box(paint("charcoal"), (1.02, 1.4, 0.04), (s * 0.53, -0.06, 1.24 + 0.03), 0.02, 0) for s in (-1, 1)]
    pockets = [box(f.main.shaded(0.7), (0.1, 1.0, 0.16), (s * 1.05, 0, 0.8)) for s in (-1, 1)]
    wheels = [
        pipe(IRON, [(s * 0.75 - 0.03, t * 0.4, 0.08), (s * 0.75 + 0.03, t * 0.4, 0.08)], 0.08)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    return [body, *ribs, *lids, *pockets, *wheels, sign("WASTE", 0.7, 0.24, (0.0, 0.735, 0.66), "white", "black")]
