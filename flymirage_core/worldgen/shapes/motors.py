"""Cars, vans, lorries, aircraft.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    cushion,
    hoop,
    hull,
    loft,
    patterned,
    pipe,
    placed,
    sign,
    struts,
    wheel,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint
from flymirage_core.worldgen.surfaces import Float, Part, Vector

TYRE, RIM = paint("black"), paint("silver", "brushed")
GLASS = replace(paint("charcoal", "glass"), opacity=0.92)
DARK = paint("black")
Station = tuple[float, float, float, float]


def car(size: Vector, f: Finish) -> list[Part]:
    """A saloon or a hatchback, as the style says."""
    hatch = f.chosen(2)
    body: list[Station] = [
        (-2.15, 1.3, 0.45, 0.72), (-2.1, 1.55, 0.32, 0.85), (-1.6, 1.72, 0.26, 0.93), (-0.6, 1.76, 0.24, 0.93),
        (0.7, 1.76, 0.24, 0.92), (1.3, 1.72, 0.26, 0.84), (1.9, 1.6, 0.3, 0.74), (2.12, 1.3, 0.38, 0.62),
    ]  # fmt: skip
    rear = -1.95 if hatch else -1.5
    cabin = _cabin([(rear, 1.4, 0.9), (rear + 0.4, 1.12, 1.38), (0.25, 1.12, 1.4), (1.05, 1.42, 0.88)])
    roof = hull(
        f.main,
        [
            (rear + 0.36, 1.1, 1.35, 1.37),
            (rear + 0.5, 1.16, 1.35, 1.42),
            (0.1, 1.16, 1.37, 1.44),
            (0.3, 1.06, 1.36, 1.39),
        ],
        0.02,
    )
    return [
        hull(f.main, body, 0.16),
        *cabin,
        roof,
        *_pillars(f, rear, 0.25),
        *_car_trim(2.1),
        *_four_wheels(0.78, 1.32, 0.32),
    ]


def taxi(size: Vector, f: Finish) -> list[Part]:
    lamp = box(paint("cream", emission=0.5), (0.5, 0.16, 0.14), (0, -0.5, 1.43), 0.03)
    checks = [
        box(patterned("black", "checks", "white", 0.4), (0.012, 2.4, 0.12), (s * 0.885, -0.1, 0.66)) for s in (-1, 1)
    ]
    return [*car(size, f), lamp, sign("TAXI", 0.4, 0.1, (0, -0.415, 1.45), "cream", "black", 0.5), *checks]


def _cabin(line: list[tuple[float, float, float]]) -> list[Part]:
    """The glass house: (y, width at its top, height) along the roof line, standing on a belt 1.5 m wide."""
    rings = []
    for y, width, top in line:
        half, low = width / 2, 0.82
        belt = 0.74
        rings.append([(half, y, top), (-half, y, top), (-belt, y * 1.02, low), (belt, y * 1.02, low)])
    return [loft(GLASS, np.array(rings)[:, ::-1])]


def _pillars(f: Finish, rear: float, front: float) -> list[Part]:
    bars = []
    for s in (-1, 1):
        bars.append(pipe(f.main, [(s * 0.735, 1.08, 0.88), (s * 0.56, front, 1.39)], 0.03))
        bars.append(pipe(f.main, [(s * 0.75, (rear + front) / 2, 0.88), (s * 0.575, (rear + front) / 2, 1.4)], 0.028))
        bars.append(pipe(f.main, [(s * 0.735, rear, 0.9), (s * 0.56, rear + 0.4, 1.37)], 0.05))
        bars.append(pipe(f.main, [(s * 0.57, rear + 0.4, 1.38), (s * 0.57, front, 1.4)], 0.03))
    return bars


def _car_trim(nose: float) -> list[Part]:
    lamps = [box(paint("white", emission=0.5), (0.34, 0.1, 0.12), (s * 0.58, nose - 0.13, 0.56), 0.04) for s in (-1, 1)]
    tails = [box(paint("red", emission=0.4), (0.3, 0.08, 0.12), (s * 0.6, -nose + 0.06, 0.66), 0.03) for s in (-1, 1)]
    mirrors = [box(DARK, (0.16, 0.1, 0.11), (s * 0.94, 0.72, 0.9), 0.03) for s in (-1, 1)]
    grille = [box(patterned("charcoal", "grille"), (0.7, 0.06, 0.16), (0, nose - 0.04, 0.42), 0.02)]
    plates = [
        sign("FM 2026", 0.44, 0.1, (0, nose + 0.03, 0.32), "white"),
        box(paint("white"), (0.44, 0.02, 0.1), (0, -nose - 0.03, 0.5)),
    ]
    seams = [box(DARK, (0.012, 0.012, 0.5), (s * 0.88, y, 0.36)) for s in (-1, 1) for y in (-0.75, 0.1, 0.95)]
    handles = [box(RIM, (0.03, 0.16, 0.03), (s * 0.885, y, 0.78), 0.01) for s in (-1, 1) for y in (-0.6, 0.25)]
    return [*lamps, *tails, *mirrors, *grille, *plates, *seams, *handles]


def _four_wheels(x: float, y: float, radius: float, width: float = 0.2) -> list[Part]:
    parts = []
    for s in (-1, 1):
        for t in (-1, 1):
            parts.append(
                pipe(
                    DARK,
                    [(s * x, t * y, radius + 0.02), (s * (x + width / 2 - 0.01), t * y, radius + 0.02)],
                    radius * 1.17,
                )
            )
            parts += wheel(TYRE, RIM, radius, width, (s * (x + 0.02), t * y, radius))
    return parts


def van(size: Vector, f: Finish) -> list[Part]:
    body: list[Station] = [
        (-2.4, 1.78, 0.42, 2.1), (-2.35, 1.86, 0.34, 2.22), (0.9, 1.9, 0.3, 2.26), (1.25, 1.86, 0.3, 2.1),
        (1.78, 1.8, 0.3, 1.25), (2.3, 1.7, 0.32, 1.02), (2.45, 1.5, 0.4, 0.8),
    ]  # fmt: skip
    low, high = ((0.82, 1.76, 1.3), (0.72, 1.3, 2.03)), ((0.82, 1.84, 1.3), (0.72, 1.36, 2.05))
    rings = [[(w0, y0, z0), (-w0, y0, z0), (-w1, y1, z1), (w1, y1, z1)] for (w0, y0, z0), (w1, y1, z1) in (low, high)]
    wind = loft(GLASS, np.array(rings)[:, ::-1])
    windows = [box(GLASS, (0.03, 0.8, 0.55), (s * 0.935, 0.95, 1.35), 0.01) for s in (-1, 1)]
    name = [
        placed(
            sign(("BAKERY", "EXPRESS", "ELECTRIC", "FLOWERS")[f.chosen(4)], 1.6, 0.4, (0, 0, 0), "chalk", "navy"),
            (s * 0.965, -1.0, 1.3),
            _sideways(s),
        )
        for s in (-1, 1)
    ]
    rear = [box(GLASS, (0.6, 0.03, 0.5), (s * 0.42, -2.4, 1.45)) for s in (-1, 1)]
    trim = [p for p in _car_trim(2.42) if p.offset[2] < 0.85]
    return [hull(f.main, body, 0.14), wind, *windows, *name, *rear, *trim, *_four_wheels(0.84, 1.5, 0.35)]


def _sideways(side: int) -> Float:
    """Turns what faces +y to face +x or -x."""
    return np.array([[0.0, side, 0], [-side, 0, 0], [0, 0, 1.0]])


def pickup(size: Vector, f: Finish) -> list[Part]:
    body: list[Station] = [
        (-2.5, 1.7, 0.5, 0.8),
        (-0.4, 1.78, 0.4, 0.82),
        (1.3, 1.78, 0.4, 1.02),
        (2.2, 1.7, 0.42, 0.98),
        (2.45, 1.45, 0.5, 0.86),
    ]
    cab = _cabin([(-0.55, 1.3, 1.55), (-0.45, 1.3, 1.6), (0.45, 1.3, 1.6), (1.15, 1.5, 1.0)])
    roof = hull(f.main, [(-0.56, 1.34, 1.56, 1.64), (0.4, 1.34, 1.58, 1.66), (0.52, 1.2, 1.56, 1.6)], 0.03)
    back = box(f.main, (1.5, 0.08, 0.8), (0, -0.55, 0.8), 0.02)
    sides = [box(f.main, (0.08, 1.95, 0.42), (s * 0.84, -1.5, 0.74), 0.03) for s in (-1, 1)]
    gate = box(f.main, (1.7, 0.08, 0.42), (0, -2.46, 0.74), 0.03)
    return [
        hull(f.main, body, 0.12),
        *cab,
        roof,
        back,
        *sides,
        gate,
        *_car_trim(2.4),
        *_four_wheels(0.8, 1.55, 0.38, 0.24),
    ]


def lorry(size: Vector, f: Finish) -> list[Part]:
    cargo = [
        box(
            f.second.shaded(1.0) if f.chosen(2) else paint("chalk", "corrugated"), (2.4, 4.6, 2.4), (0, -1.2, 1.0), 0.03
        )
    ]
    cargo += [box(paint("silver", "brushed"), (2.44, 0.08, 2.44), (0, y, 0.98)) for y in (-3.48, 1.08)]
    cab = hull(
        f.main,
        [
            (1.3, 2.3, 0.6, 2.9),
            (1.5, 2.34, 0.5, 3.0),
            (2.6, 2.34, 0.5, 2.85),
            (3.0, 2.3, 0.5, 1.75),
            (3.15, 2.2, 0.5, 1.2),
        ],
        0.12,
    )
    screen = box(GLASS, (2.0, 0.06, 1.0), (0, 2.87, 1.72), 0.02, 0.38)
    windows = [box(GLASS, (0.04, 0.8, 0.75), (s * 1.165, 2.1, 1.75), 0.02) for s in (-1, 1)]
    lamps = [box(paint("white", emission=0.5), (0.36, 0.06, 0.2), (s * 0.8, 3.12, 0.8), 0.03) for s in (-1, 1)]
    grille = box(patterned("charcoal", "grille"), (1.1, 0.05, 0.5), (0, 3.13, 0.7), 0.02)
    wheels = [p for s in (-1, 1) for y in (-2.7, -1.75, 2.2) for p in wheel(TYRE, RIM, 0.48, 0.34, (s * 1.0, y, 0.48))]
    return [*cargo, cab, screen, *windows, *lamps, grille, box(DARK, (1.0, 6.3, 0.25), (0, -0.2, 0.6)), *wheels]


def bus(size: Vector, f: Finish) -> list[Part]:
    body = hull(
        f.main,
        [
            (-4.4, 2.3, 0.4, 2.95),
            (-4.3, 2.46, 0.34, 3.05),
            (4.1, 2.46, 0.34, 3.05),
            (4.35, 2.4, 0.36, 2.9),
            (4.42, 2.3, 0.4, 2.6),
        ],
        0.18,
    )
    sides = [
        box(GLASS, (0.04, 1.2, 0.95), (s * 1.235, y, 1.55), 0.03) for s in (-1, 1) for y in np.linspace(-3.6, 2.3, 5)
    ]
    doors = [box(GLASS, (0.05, 1.0, 2.0), (1.235, y, 0.5), 0.03) for y in (3.5, -0.65)]
    band = [box(paint("chalk"), (0.02, 8.4, 0.18), (s * 1.235, 0, 1.2)) for s in (-1, 1)]
    front = [
        box(GLASS, (2.1, 0.06, 1.3), (0, 4.38, 1.25), 0.05),
        sign("12 HARBOUR", 1.6, 0.3, (0, 4.44, 2.6), "black", "orange", 0.6),
    ]
    lamps = [box(paint("white", emission=0.5), (0.4, 0.06, 0.18), (s * 0.85, 4.42, 0.75), 0.04) for s in (-1, 1)]
    return [body, *sides, *doors, *band, *front, *lamps, *_four_wheels(1.08, 2.7, 0.48, 0.3)]


def forklift(size: Vector, f: Finish) -> list[Part]:
    body = hull(
        f.main,
        [
            (-1.15, 1.0, 0.4, 0.85),
            (-1.05, 1.1, 0.28, 1.05),
            (-0.5, 1.12, 0.25, 1.08),
            (-0.3, 1.12, 0.25, 0.62),
            (0.55, 1.1, 0.25, 0.6),
            (0.75, 1.05, 0.3, 0.55),
        ],
        0.1,
    )
    weight = hull(paint("charcoal"), [(-1.3, 0.9, 0.4, 0.8), (-1.1, 1.08, 0.3, 0.98), (-0.95, 1.08, 0.3, 0.9)], 0.12)
    guard = [
        pipe(
            DARK,
            [(s * 0.48, -0.7, 1.05), (s * 0.46, -0.55, 2.1), (s * 0.46, 0.4, 2.12), (s * 0.48, 0.72, 0.6)],
            0.035,
            0.12,
        )
        for s in (-1, 1)
    ]
    guard += [box(DARK, (0.92, 0.05, 0.04), (0, y, 2.08)) for y in np.linspace(-0.5, 0.35, 5)]
    seat = [
        cushion(paint("black", "leather"), (0.5, 0.48, 0.12), (0, -0.3, 1.06)),
        cushion(paint("black", "leather"), (0.5, 0.5, 0.12), (0, -0.55, 1.1), 1.3),
    ]
    mast = [box(DARK, (0.1, 0.12, 2.0), (s * 0.34, 0.95, 0.1)) for s in (-1, 1)] + [
        box(DARK, (0.7, 0.08, 0.08), (0, 0.95, h)) for h in (0.4, 1.3, 2.02)
    ]
    forks = [box(paint("slate grey", "metal"), (0.12, 1.05, 0.04), (s * 0.26, 1.55, 0.1)) for s in (-1, 1)] + [
        box(paint("slate grey", "metal"), (0.12, 0.05, 0.55), (s * 0.26, 1.05, 0.1)) for s in (-1, 1)
    ]
    rest = [box(DARK, (0.9, 0.04, 0.05), (0, 1.03, h)) for h in (0.35, 0.6, 0.85)]
    wheels = [
        p
        for s in (-1, 1)
        for y, r in ((0.45, 0.32), (-0.75, 0.25))
        for p in wheel(TYRE, paint("chalk"), r, 0.22, (s * 0.5, y, r))
    ]
    lamp = cylinder(paint("orange", emission=1.0), 0.05, 0.1, (0.3, -0.4, 2.12))
    column = [pipe(DARK, [(0, 0.5, 0.6), (0, 0.2, 1.2)], 0.03), placed(hoop(DARK, 0.16, 0.015), (0, 0.18, 1.22))]
    return [body, weight, *guard, *seat, *mast, *forks, *rest, *wheels, lamp, *column]


def aircraft(size: Vector, f: Finish) -> list[Part]:
    """A small propeller aeroplane, high-winged."""
    stations = [
        (-3.3, 0.16, 0.95, 1.15),
        (-2.6, 0.34, 0.85, 1.28),
        (-0.8, 0.9, 0.55, 1.55),
        (0.3, 1.05, 0.5, 1.7),
        (1.0, 1.0, 0.5, 1.45),
        (1.9, 0.8, 0.6, 1.2),
        (2.25, 0.5, 0.72, 1.1),
    ]
    wing = [
        np.array([(u, 0.75, 1.74), (u, 0.35, 1.84), (u, -0.55, 1.74), (u, 0.2, 1.70)])
        for u in (-4.6, -4.4, 0, 4.4, 4.6)
    ]
    tail = [np.array([(u, -2.6, 1.12), (u, -2.8, 1.16), (u, -3.3, 1.12), (u, -2.9, 1.09)]) for u in (-1.5, 0, 1.5)]
    fin = [
        np.array([(0.04, y0, z), (-0.04, y0, z), (-0.04, y1, z), (0.04, y1, z)])
        for z, y0, y1 in ((1.1, -2.3, -3.3), (2.1, -3.05, -3.5))
    ]
    glass = hull(GLASS, [(-0.4, 0.8, 1.3, 1.72), (0.4, 1.06, 1.25, 1.73), (1.05, 0.96, 1.2, 1.4)], 0.1)
    legs = [pipe(RIM, [(s * 0.4, 0.3, 0.6), (s * 1.0, 0.3, 0.2)], 0.035) for s in (-1, 1)] + [
        pipe(RIM, [(0, 1.8, 0.6), (0, 1.9, 0.2)], 0.03)
    ]
    wheels = [p for u, y in ((-1.05, 0.3), (1.05, 0.3), (0, 1.9)) for p in wheel(TYRE, RIM, 0.2, 0.13, (u, y, 0.2))]
    prop = [box(DARK, (0.12, 0.03, 1.9), (0, 2.38, 0.0)), ellipsoid(f.second, (0.14, 0.24, 0.14), (0, 2.35, 0.92))]
    stays = struts(f.main, [(-2.2, 0.3, 1.72), (-0.48, 0.3, 0.75)], 0.03) + struts(
        f.main, [(2.2, 0.3, 1.72), (0.48, 0.3, 0.75)], 0.03
    )
    stripe = hull(
        f.second,
        [
            (-2.6, 0.36, 1.02, 1.1),
            (-0.8, 0.92, 1.0, 1.12),
            (0.3, 1.07, 0.98, 1.12),
            (1.0, 1.02, 0.96, 1.1),
            (1.9, 0.82, 0.94, 1.04),
        ],
        0.02,
    )
    return [
        hull(f.main, stations, 0.2),
        *(loft(f.main, np.array(w)[:, ::-1]) for w in (wing, tail)),
        loft(f.main, fin),
        glass,
        *legs,
        *wheels,
        *prop,
        *stays,
        stripe,
    ]
