"""Bicycles, barrows, boats: what is ridden, pushed and rowed.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    cushion,
    hoop,
    hull,
    mirrored,
    pipe,
    placed,
    rounded_ring,
    skin,
    tapered,
    wheel,
)
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, turned
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, DARK = paint("silver", "brushed"), paint("black")
TYRE, RIM = paint("black"), paint("silver", "brushed")
GLASS = replace(paint("charcoal", "glass"), opacity=0.92)
DARK = paint("black")


def motorcycle(size: Vector, f: Finish) -> list[Part]:
    rear, front = (0, -0.68, 0.32), (0, 0.72, 0.32)
    wheels = [p for c in (rear, front) for p in wheel(DARK, STEEL, 0.32, 0.13, c)]
    tank = hull(
        f.main,
        [(-0.12, 0.16, 0.72, 0.86), (0.05, 0.3, 0.68, 0.95), (0.28, 0.28, 0.7, 0.96), (0.4, 0.14, 0.76, 0.9)],
        0.08,
    )
    seat = tapered(
        paint("black", "leather"), [(0.24, 0.72, 0), (0.28, 0.74, 0.06), (0.2, 0.66, 0.11)], (0, -0.42, 0.7), 0.1
    )
    engine = [
        box(STEEL, (0.34, 0.3, 0.26), (0, 0.08, 0.3), 0.05),
        *(box(paint("charcoal"), (0.3, 0.26, 0.012), (0, 0.1, 0.58 + 0.03 * i)) for i in range(4)),
        pipe(STEEL, [(-0.24, 0.08, 0.4), (0.24, 0.08, 0.4)], 0.12),
    ]
    frame = [
        pipe(DARK, [(0, 0.42, 0.9), (0, 0.36, 0.5), (0, 0.1, 0.26), (0, -0.3, 0.3), (0, -0.68, 0.34)], 0.028, 0.1),
        pipe(DARK, [(0, 0.42, 0.86), (0, -0.3, 0.7), (0, -0.75, 0.72)], 0.025),
    ]
    fork = [pipe(STEEL, [(s * 0.09, 0.4, 0.95), (s * 0.09, 0.72, 0.32)], 0.022) for s in (-1, 1)] + [
        pipe(STEEL, [(s * 0.1, -0.66, 0.34), (s * 0.12, -0.5, 0.68)], 0.026) for s in (-1, 1)
    ]
    bars = [
        pipe(DARK, [(-0.38, 0.2, 1.04), (-0.2, 0.36, 1.06), (0.2, 0.36, 1.06), (0.38, 0.2, 1.04)], 0.016, 0.1),
        ellipsoid(f.main, (0.1, 0.08, 0.1), (0, 0.5, 0.92)),
        ellipsoid(paint("cream", emission=0.8), (0.08, 0.03, 0.08), (0, 0.565, 0.92)),
    ]
    exhaust = [pipe(STEEL, [(0.12, 0.22, 0.45), (0.2, 0.1, 0.25), (0.2, -0.3, 0.25), (0.21, -0.95, 0.38)], 0.045, 0.1)]
    guards = [
        pipe(f.main, [(0, c[1] + 0.36 * np.cos(a), 0.32 + 0.36 * np.sin(a)) for a in np.linspace(0.5, 2.5, 9)], 0.07)
        for c in (rear, front)
    ]
    return [
        *wheels,
        tank,
        seat,
        *engine,
        *frame,
        *fork,
        *bars,
        *exhaust,
        *guards,
        ellipsoid(paint("red", emission=0.6), (0.06, 0.03, 0.04), (0, -0.86, 0.72)),
        *mirrored(ellipsoid(DARK, (0.05, 0.012, 0.035), (0.3, 0.3, 1.18))),
    ]


def _spoked(radius: float, centre: Vector, tyre: Material, width: float = 0.035) -> list[Part]:
    """A bicycle wheel in the plane of y and z."""
    turn = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    ring = hoop(tyre, radius - width / 2, width / 2)
    rim = hoop(RIM, radius - width - 0.008, 0.008)
    spokes = [
        pipe(RIM, [(0, 0, 0), ((radius - width) * np.cos(a), (radius - width) * np.sin(a), 0)], 0.0025)
        for a in np.arange(14) * 2 * np.pi / 14
    ]
    return [placed(p, centre, turn) for p in (ring, rim, *spokes, cylinder(RIM, 0.025, 0.06, (0, 0, -0.03)))]


def bicycle(size: Vector, f: Finish) -> list[Part]:
    hub, bottom, seat, head = (0, -0.52, 0.34), (0, -0.1, 0.29), (0, -0.24, 0.78), (0, 0.36, 0.82)
    bars = [(bottom, seat), (bottom, (0, 0.38, 0.72)), (seat, head), (hub, bottom), (hub, seat)]
    frame = [pipe(f.main, [a, b], 0.018) for a, b in bars]
    fork = [pipe(f.main, [(0, 0.34, 0.92), (0, 0.4, 0.7), (0, 0.54, 0.34)], 0.016, 0.1)]
    handle = pipe(DARK, [(-0.28, 0.22, 0.98), (-0.14, 0.38, 1.0), (0.14, 0.38, 1.0), (0.28, 0.22, 0.98)], 0.014, 0.1)
    stem = [pipe(RIM, [(0, 0.34, 0.9), (0, 0.37, 1.0)], 0.014), pipe(RIM, [seat, (0, -0.27, 0.92)], 0.014)]
    saddle = tapered(paint("black", "leather"), [(0.1, 0.24, 0), (0.14, 0.27, 0.05)], (0, -0.28, 0.92), 0.05)
    crank = [
        placed(
            turned(RIM, [(0, 0), (0.09, 0), (0.09, 0.008), (0, 0.008)]),
            (0.03, -0.1, 0.29),
            np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        )
    ]
    crank += [pipe(RIM, [(s * 0.05, -0.1, 0.29), (s * 0.05, -0.1 + s * 0.12, 0.29 - s * 0.11)], 0.01) for s in (-1, 1)]
    pedals = [box(DARK, (0.09, 0.07, 0.02), (s * 0.1, -0.1 + s * 0.12, 0.28 - s * 0.11)) for s in (-1, 1)]
    guard = [
        pipe(DARK, [(0.03, -0.1, 0.375), (0.03, -0.52, 0.37)], 0.008),
        pipe(DARK, [(0.03, -0.1, 0.2), (0.03, -0.52, 0.31)], 0.006),
    ]
    return [
        *frame,
        *fork,
        handle,
        *stem,
        saddle,
        *crank,
        *pedals,
        *guard,
        *_spoked(0.34, hub, TYRE),
        *_spoked(0.34, (0, 0.54, 0.34), TYRE),
    ]


def scooter(size: Vector, f: Finish) -> list[Part]:
    """A motor scooter."""
    tail = hull(
        f.main,
        [(-0.75, 0.14, 0.55, 0.68), (-0.6, 0.34, 0.38, 0.74), (-0.2, 0.36, 0.3, 0.72), (0.02, 0.24, 0.28, 0.5)],
        0.1,
    )
    deck = hull(f.main, [(-0.1, 0.34, 0.2, 0.3), (0.4, 0.34, 0.2, 0.28)], 0.03)
    shield = tapered(
        f.main, [(0.4, 0.06, 0), (0.44, 0.07, 0.3), (0.26, 0.08, 0.68)], (0, 0.42, 0.22), 0.03, (0.06, 0.0, -0.1)
    )
    nose = hull(f.main, [(0.3, 0.1, 0.92, 0.98), (0.36, 0.2, 0.88, 1.04), (0.44, 0.16, 0.9, 1.0)], 0.05)
    lamp = ellipsoid(paint("white", emission=0.6), (0.075, 0.04, 0.075), (0, 0.44, 0.95))
    seat = tapered(
        paint("chocolate", "leather"), [(0.28, 0.7, 0), (0.3, 0.72, 0.05), (0.22, 0.62, 0.1)], (0, -0.34, 0.72), 0.1
    )
    handle = pipe(DARK, [(-0.34, 0.28, 0.98), (0, 0.36, 0.98), (0.34, 0.28, 0.98)], 0.018, 0.1)
    fender = hull(f.main, [(0.28, 0.1, 0.28, 0.36), (0.5, 0.15, 0.34, 0.46), (0.72, 0.1, 0.26, 0.34)], 0.05)
    wheels = [p for y in (-0.52, 0.52) for p in wheel(TYRE, RIM, 0.22, 0.1, (0, y, 0.22))]
    mirrors = mirrored(ellipsoid(RIM, (0.06, 0.015, 0.045), (0.26, 0.3, 1.14)))
    mirrors += mirrored(pipe(RIM, [(0.22, 0.3, 1.0), (0.26, 0.3, 1.12)], 0.006))
    return [
        tail,
        deck,
        shield,
        nose,
        lamp,
        seat,
        handle,
        fender,
        *wheels,
        *mirrors,
        pipe(f.main, [(0, 0.36, 0.9), (0, 0.5, 0.3)], 0.03),
    ]


def _boat_rings(length: float, beam: float, depth: float, inset: float = 0.0) -> Float:
    rings = []
    for t in np.linspace(0, 1, 11):
        half = (beam / 2 - inset) * (0.78 + 0.22 * min(t / 0.3, 1.0)) * (1 - max(0.0, (t - 0.55) / 0.45) ** 2.2) + 0.004
        keel = inset + depth * 0.55 * max(0.0, (t - 0.7) / 0.3) ** 2
        top = depth * (1 + 0.3 * t**3)
        angle = np.linspace(0, np.pi, 11)
        arc = [
            (half * np.cos(a) * (1 if np.sin(a) < 0.3 else 0.97), keel + (top - keel) * (1 - np.sin(a) ** 0.7))
            for a in angle
        ]
        y = -length / 2 + inset + (length - 2 * inset) * t
        rings.append([(u, y, z) for u, z in arc])
    return np.array(rings)


def rowing_boat(size: Vector, f: Finish) -> list[Part]:
    outer, inner = _boat_rings(3.4, 1.35, 0.5), _boat_rings(3.4, 1.35, 0.5, 0.04)
    shell = skin(f.main, outer[:, ::-1]) + skin(f.main.shaded(0.7), inner)
    transom = skin(f.main.shaded(0.9), [outer[0], np.array([(u, y, 0.5) for u, y, _ in outer[0]])])
    rail = [pipe(f.second, outer[:, i], 0.025) for i in (0, -1)]
    seats = [box(f.second, (w, 0.26, 0.035), (0, y, 0.3)) for w, y in ((1.05, -1.2), (1.2, -0.2), (1.0, 0.75))]
    oars = [pipe(paint("honey brown", "wood"), [(s * 0.5, -1.0, 0.46), (s * 0.62, 1.0, 0.52)], 0.022) for s in (-1, 1)]
    blades = [box(paint("honey brown", "wood"), (0.13, 0.5, 0.02), (s * 0.63, 1.15, 0.52), 0.008) for s in (-1, 1)]
    return [*shell, *transom, *rail, *seats, *oars, *blades]


def motor_boat(size: Vector, f: Finish) -> list[Part]:
    rings = _boat_rings(5.2, 2.0, 0.85)
    deck = [np.array([(u * 0.98, y, z - 0.02) for u, y, z in (r[0], r[-1])]) for r in rings]
    top = skin(paint("chalk"), [np.linspace(a[1], a[0], 5) for a in deck])
    cabin = hull(
        paint("chalk"),
        [(-0.4, 1.3, 0.8, 1.35), (0.5, 1.3, 0.85, 1.4), (1.2, 0.9, 0.9, 1.1), (1.6, 0.4, 0.95, 1.0)],
        0.1,
    )
    screen = box(GLASS, (1.2, 0.04, 0.4), (0, 0.62, 1.28), 0.01, 0.5)
    rail = [pipe(RIM, [(s * 0.85, 0.0, 1.2), (s * 0.6, 1.6, 1.25), (0, 2.5, 1.35)], 0.018, 0.3) for s in (-1, 1)]
    motor = [
        box(paint("charcoal"), (0.4, 0.4, 0.6), (0, -2.7, 0.75), 0.08),
        box(paint("charcoal"), (0.12, 0.2, 0.7), (0, -2.75, 0.05), 0.03),
    ]
    well = [
        box(paint("oak brown", "wood"), (1.4, 1.7, 0.05), (0, -1.5, 0.82)),
        *(cushion(paint("cream", "leather"), (0.55, 0.5, 0.2), (s * 0.35, -0.8, 0.9)) for s in (-1, 1)),
    ]
    return [
        *skin(f.main, rings[:, ::-1]),
        *top,
        cabin,
        screen,
        *rail,
        *motor,
        *well,
        *(pipe(f.second, rings[:, i], 0.04) for i in (0, -1)),
    ]


def wheelbarrow(size: Vector, f: Finish) -> list[Part]:
    rows = [rounded_ring(w, d, 0.1, 4) for w, d in ((0.36, 0.4), (0.62, 0.85))]
    tub = [
        np.column_stack([r[:, 0], r[:, 1] + s, np.full(len(r), z)])
        for r, z, s in zip(rows, (0.3, 0.58), (0.1, 0.05), strict=True)
    ]
    bowl = skin(f.main, [np.vstack([t, t[:1]])[::-1] for t in tub])
    bowl.append(box(f.main.shaded(0.7), (0.36, 0.4, 0.012), (0, 0.1, 0.3), 0.004))
    bars = [
        pipe(f.second, [(s * 0.28, -0.85, 0.58), (s * 0.24, -0.3, 0.32), (s * 0.1, 0.55, 0.2)], 0.018, 0.15)
        for s in (-1, 1)
    ]
    legs = [pipe(f.second, [(s * 0.24, -0.3, 0.32), (s * 0.24, -0.32, 0.0)], 0.016) for s in (-1, 1)]
    grips = [pipe(DARK, [(s * 0.28, -0.85, 0.58), (s * 0.275, -0.72, 0.55)], 0.024) for s in (-1, 1)]
    return [*bowl, *bars, *legs, *grips, *wheel(TYRE, RIM, 0.19, 0.09, (0, 0.58, 0.19))]


def shopping_cart(size: Vector, f: Finish) -> list[Part]:
    wire = paint("silver", "brushed")
    low, high = (
        np.column_stack([rounded_ring(0.4, 0.6, 0.04), np.full(12, 0.42)]),
        np.column_stack([rounded_ring(0.56, 0.86, 0.05), np.full(12, 0.9)]),
    )
    rings = [pipe(wire, np.vstack([a, a[:1]]), 0.006) for a in (low + t * (high - low) for t in np.linspace(0, 1, 6))]
    sides = [
        pipe(wire, [a, b], 0.004) for t in np.linspace(0, 0.93, 15) for a, b in [(_along(low, t), _along(high, t))]
    ]
    floor = [pipe(wire, [(u, -0.3, 0.42), (u, 0.3, 0.42)], 0.004) for u in np.linspace(-0.18, 0.18, 6)]
    frame = [
        pipe(
            wire,
            [(s * 0.26, -0.48, 0.98), (s * 0.24, -0.36, 0.14), (s * 0.2, 0.38, 0.14), (s * 0.2, 0.3, 0.42)],
            0.012,
            0.06,
        )
        for s in (-1, 1)
    ]
    handle = pipe(f.main, [(-0.27, -0.48, 0.98), (0.27, -0.48, 0.98)], 0.02)
    wheels = [p for s in (-1, 1) for y in (-0.33, 0.34) for p in wheel(TYRE, RIM, 0.06, 0.03, (s * 0.21, y, 0.06))]
    return [*rings, *sides, *floor, *frame, handle, *wheels]


def _along(ring: Float, share: float) -> Float:
    closed = np.vstack([ring, ring[:1]])
    at = share * len(ring)
    i = int(at)
    return np.asarray(closed[i] + (at - i) * (closed[i + 1] - closed[i]))


def hand_truck(size: Vector, f: Finish) -> list[Part]:
    rails = [
        pipe(f.main, [(s * 0.18, 0, 0.06), (s * 0.18, -0.06, 1.0), (s * 0.1, -0.14, 1.22)], 0.016, 0.1) for s in (-1, 1)
    ]
    rungs = [pipe(f.main, [(-0.18, -0.06 * h, h), (0.18, -0.06 * h, h)], 0.013) for h in (0.15, 0.45, 0.75, 1.0)]
    grip = pipe(DARK, [(-0.1, -0.14, 1.22), (0.1, -0.14, 1.22)], 0.018)
    wheels = [p for s in (-1, 1) for p in wheel(TYRE, RIM, 0.12, 0.06, (s * 0.24, -0.1, 0.12))]
    return [
        *rails,
        *rungs,
        grip,
        *wheels,
        box(f.second, (0.42, 0.26, 0.015), (0, 0.13, 0.02)),
        pipe(RIM, [(-0.24, -0.1, 0.12), (0.24, -0.1, 0.12)], 0.012),
    ]


def pallet_jack(size: Vector, f: Finish) -> list[Part]:
    forks = [box(f.main, (0.16, 1.1, 0.06), (s * 0.2, 0.2, 0.08), 0.015) for s in (-1, 1)]
    head = tapered(f.main, [(0.56, 0.2, 0.08), (0.5, 0.18, 0.4)], (0, -0.42, 0), 0.03)
    handle = [
        pipe(f.main, [(0, -0.5, 0.3), (0, -0.78, 1.1)], 0.022),
        *(
            pipe(
                DARK,
                [
                    (-0.16, -0.78, 1.1),
                    (-0.12, -0.84, 1.24),
                    (0.12, -0.84, 1.24),
                    (0.16, -0.78, 1.1),
                    (-0.16, -0.78, 1.1),
                ],
                0.016,
                0.04,
            ),
        ),
    ]
    wheels = [p for u in (-0.07, 0.07) for p in wheel(TYRE, RIM, 0.1, 0.06, (u, -0.56, 0.1))]
    rollers = [pipe(TYRE, [(s * 0.2 - 0.05, 0.66, 0.05), (s * 0.2 + 0.05, 0.66, 0.05)], 0.045) for s in (-1, 1)]
    return [*forks, head, *handle, *wheels, *rollers, cylinder(RIM, 0.05, 0.4, (0, -0.5, 0.18))]


def wheelchair(size: Vector, f: Finish) -> list[Part]:
    seat = [
        cushion(f.main, (0.44, 0.44, 0.09), (0, 0, 0.48)),
        cushion(f.main, (0.44, 0.46, 0.07), (0, -0.22, 0.54), 1.45),
    ]
    frame = [
        pipe(RIM, [(s * 0.23, -0.24, 0.3), (s * 0.23, -0.24, 0.92), (s * 0.23, -0.36, 0.95)], 0.013, 0.05)
        for s in (-1, 1)
    ]
    frame += [
        pipe(RIM, [(s * 0.23, -0.24, 0.48), (s * 0.23, 0.24, 0.48), (s * 0.2, 0.4, 0.14)], 0.013, 0.06) for s in (-1, 1)
    ]
    arms = [
        p
        for s in (-1, 1)
        for p in (
            box(DARK, (0.05, 0.3, 0.03), (s * 0.25, 0, 0.72), 0.01),
            pipe(RIM, [(s * 0.24, 0.12, 0.48), (s * 0.24, 0.12, 0.72)], 0.01),
        )
    ]
    big = [
        p
        for s in (-1, 1)
        for p in (*_spoked(0.3, (s * 0.3, -0.14, 0.3), TYRE), *(_spoked(0.26, (s * 0.34, -0.14, 0.3), RIM, 0.015)[:1]))
    ]
    small = [p for s in (-1, 1) for p in wheel(TYRE, RIM, 0.08, 0.035, (s * 0.22, 0.24, 0.08))]
    return [
        *seat,
        *frame,
        *arms,
        *big,
        *small,
        *(box(DARK, (0.16, 0.2, 0.015), (s * 0.11, 0.42, 0.1), 0.005) for s in (-1, 1)),
    ]


def canoe(size: Vector, f: Finish) -> list[Part]:
    rings = []
    for t in np.linspace(-1, 1, 13):
        half, up = 0.42 * (1 - abs(t) ** 2.3) + 0.004, 0.14 * t**4
        rings.append(
            [
                (half * np.cos(a), 2.2 * t, up * 2 + 0.36 * (1 - np.sin(a) ** 0.8) + 0.0)
                for a in np.linspace(0, np.pi, 9)
            ]
        )
    grid = np.array(rings)
    seats = [box(f.second, (0.6, 0.2, 0.025), (0, y, 0.24)) for y in (-1.0, 0.9)]
    return [*skin(f.main, grid[:, ::-1], 0.6), *(pipe(f.second, grid[:, i], 0.018) for i in (0, -1)), *seats]


def stroller(size: Vector, f: Finish) -> list[Part]:
    angle = np.linspace(0.1, np.pi * 0.62, 6)
    hood = [
        np.array(
            [
                (0.22 * np.cos(b), -0.16 - 0.3 * np.cos(a) * np.sin(b) + 0.1, 0.68 + 0.3 * np.sin(a) * np.sin(b))
                for b in np.linspace(0, np.pi, 9)
            ]
        )
        for a in angle
    ]
    cot = hull(
        f.main,
        [(-0.38, 0.34, 0.5, 0.7), (-0.3, 0.44, 0.42, 0.72), (0.3, 0.44, 0.42, 0.7), (0.42, 0.34, 0.5, 0.68)],
        0.1,
    )
    frame = [
        pipe(RIM, [(s * 0.22, -0.55, 1.02), (s * 0.22, 0.1, 0.42), (s * 0.22, 0.4, 0.14)], 0.012) for s in (-1, 1)
    ] + [pipe(RIM, [(s * 0.22, 0.25, 0.46), (s * 0.22, -0.35, 0.14)], 0.012) for s in (-1, 1)]
    wheels = [
        p for s in (-1, 1) for y, r in ((-0.35, 0.15), (0.4, 0.12)) for p in wheel(TYRE, RIM, r, 0.04, (s * 0.25, y, r))
    ]
    return [
        cot,
        *skin(f.main.shaded(0.8), hood),
        *frame,
        *wheels,
        pipe(DARK, [(-0.22, -0.55, 1.02), (0.22, -0.55, 1.02)], 0.016),
        box(f.second, (0.3, 0.4, 0.02), (0, 0, 0.2)),
    ]
