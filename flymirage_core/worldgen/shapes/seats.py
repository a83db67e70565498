"""Chairs and tables in several designs, of which a scene has one; stuffed stools.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

import numpy as np

from flymirage_core.worldgen.forms import group, hoop, pipe, placed, rounded_ring, sweep, tapered, wheel
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import Finish, box, four_legs, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Part, Vector

DARK, STEEL = paint("black"), paint("silver", "brushed")


def chair(size: Vector, f: Finish) -> list[Part]:
    """Slatted, ladder-backed, spindle-backed or bent from tube."""
    x, y, z = size
    design = f.chosen(4)
    seat_height = 0.46
    if design == 3:
        return _tube_chair(size, f)
    turned_leg = [(0.02, 0.0), (0.014, 0.03), (0.024, 0.14), (0.016, 0.2), (0.022, 0.38), (0.018, seat_height)]
    spots = [(s, t) for s in (-1, 1) for t in (-1, 1)]
    if design == 2:
        form = smooth(turned_leg, 12)
        legs = [turned(f.second, form, (s * (x / 2 - 0.04), t * (y / 2 - 0.04), 0)) for s, t in spots]
    else:
        feet, knees = (x / 2 - 0.025, y / 2 - 0.025, 0.0), (x / 2 - 0.05, y / 2 - 0.05, seat_height)
        legs = [pipe(f.second, [(s * u, t * v, h) for u, v, h in (feet, knees)], 0.02) for s, t in spots]
    seat = tapered(
        f.main,
        [
            (x - 0.06, y - 0.06, seat_height - 0.03),
            (x, y, seat_height - 0.01),
            (x - 0.02, y - 0.02, seat_height + 0.012),
        ],
        radius=0.06,
    )
    lean = 0.06
    posts = [
        pipe(
            f.second,
            [(s * (x / 2 - 0.045), -y / 2 + 0.05, seat_height), (s * (x / 2 - 0.03), -y / 2 + 0.03 - lean, z)],
            0.017,
        )
        for s in (-1, 1)
    ]
    rails = _back(f, design, x, y, seat_height, z, lean)
    stretchers = [
        pipe(f.second, [(s * (x / 2 - 0.04), -y / 2 + 0.05, 0.18), (s * (x / 2 - 0.04), y / 2 - 0.05, 0.18)], 0.011)
        for s in (-1, 1)
    ]
    return [
        *legs,
        seat,
        *posts,
        *rails,
        *stretchers,
        pipe(f.second, [(-x / 2 + 0.04, 0, 0.18), (x / 2 - 0.04, 0, 0.18)], 0.011),
    ]


def _back(f: Finish, design: int, x: float, y: float, low: float, high: float, lean: float) -> list[Part]:
    def at(t: float) -> tuple[float, float]:
        return -y / 2 + 0.05 - (0.02 + lean) * t, low + (high - low) * t

    def bowed(t: float, tall: float) -> Part:
        v, h = at(t)
        path = [(u, v - 0.03 * (1 - (2 * u / x) ** 2), h) for u in np.linspace(-x / 2 + 0.03, x / 2 - 0.03, 7)]
        return sweep(f.main, rounded_ring(0.016, tall, 0.006), path)

    if design == 0:
        return [bowed(t, 0.07) for t in (0.38, 0.64, 0.9)]
    if design == 1:
        return [bowed(0.9, 0.13), bowed(0.45, 0.03)]
    spindles = []
    for u in np.linspace(-x * 0.34, x * 0.34, 6):
        (v0, h0), (v1, h1) = at(0.0), at(0.92)
        spindles.append(pipe(f.second, [(float(u), v0, h0), (1.05 * float(u), v1 - 0.02, h1)], 0.008))
    return [bowed(0.95, 0.06), *spindles]


def _tube_chair(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    frame = [
        pipe(
            STEEL,
            [
                (s * (x / 2 - 0.02), -y / 2 + 0.02, 0.012),
                (s * (x / 2 - 0.02), y / 2 - 0.03, 0.012),
                (s * (x / 2 - 0.02), y / 2 - 0.06, 0.45),
                (s * (x / 2 - 0.02), -y / 2 + 0.08, 0.44),
                (s * (x / 2 - 0.02), -y / 2 - 0.02, z),
            ],
            0.012,
            0.07,
        )
        for s in (-1, 1)
    ]
    back = [
        sweep(
            f.main,
            rounded_ring(0.02, 0.2, 0.008),
            [
                (u, -y / 2 - 0.02 - 0.03 * (1 - (2 * u / x) ** 2), z - 0.13)
                for u in np.linspace(-x / 2 + 0.02, x / 2 - 0.02, 7)
            ],
        )
    ]
    seat = tapered(
        f.main, [(x - 0.06, y - 0.1, 0.44), (x - 0.02, y - 0.06, 0.46), (x - 0.05, y - 0.1, 0.475)], radius=0.05
    )
    return [
        *frame,
        *back,
        seat,
        pipe(STEEL, [(-x / 2 + 0.02, -y / 2 + 0.02, 0.012), (x / 2 - 0.02, -y / 2 + 0.02, 0.012)], 0.012),
    ]


def office_chair(size: Vector, f: Finish) -> list[Part]:
    spokes = [
        p
        for k in range(5)
        for p in group(
            [
                sweep(DARK, rounded_ring(0.04, 0.03, 0.01), [(0, 0.02, 0.1), (0, 0.28, 0.065)]),
                *wheel(DARK, STEEL, 0.03, 0.045, (0, 0.28, 0.03)),
            ],
            yaw=k * 2 * np.pi / 5,
        )
    ]
    post = [
        turned(STEEL, [(0.03, 0.08), (0.03, 0.25), (0.018, 0.26), (0.018, 0.42)]),
        box(DARK, (0.22, 0.26, 0.04), (0, 0, 0.4), 0.015),
    ]
    seat = tapered(
        f.main, [(0.44, 0.42, 0.43), (0.5, 0.48, 0.46), (0.5, 0.48, 0.5), (0.44, 0.42, 0.525)], (0, 0.02, 0), 0.1
    )
    spine = pipe(DARK, [(0, -0.1, 0.41), (0, -0.27, 0.45), (0, -0.29, 0.75)], 0.022, 0.1)
    bow = np.array(
        [
            [
                (u, -0.25 - 0.05 * (1 - (u / 0.23) ** 2) - 0.06 * t**2, 0.58 + 0.46 * t)
                for u in np.linspace(-0.23, 0.23, 9)
            ]
            for t in np.linspace(0, 1, 6)
        ]
    )
    front = [sweep(f.main, rounded_ring(0.05, 0.09, 0.02), row) for row in bow]
    arms = [
        p
        for s in (-1, 1)
        for p in (
            pipe(DARK, [(s * 0.2, 0, 0.44), (s * 0.29, -0.02, 0.46), (s * 0.29, -0.02, 0.66)], 0.015, 0.05),
            box(DARK, (0.07, 0.26, 0.03), (s * 0.29, 0.02, 0.66), 0.012),
        )
    ]
    return [*spokes, *post, seat, spine, *front, *arms]


def pouf(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    body = turned(
        f.main, smooth([(0, 0), (r * 0.8, 0.0), (r, z * 0.3), (r, z * 0.7), (r * 0.8, z), (0, z - 0.015)], 18)
    )
    seams = [
        placed(
            sweep(
                f.main.shaded(0.7),
                rounded_ring(0.012, 0.012, 0.004),
                [
                    (1.005 * r * np.cos(t) * c, 1.005 * r * np.cos(t) * s, z / 2 + 1.0 * z / 2 * np.sin(t))
                    for t in np.linspace(-1.1, 1.4, 11)
                ],
            )
        )
        for c, s in ((np.cos(a), np.sin(a)) for a in np.arange(8) * np.pi / 4)
    ]
    return [
        body,
        *seams,
        hoop(f.second, r * 0.97, 0.008, (0, 0, z * 0.12)),
        turned(f.second, [(0.04, z - 0.012), (0.03, z + 0.004), (0, z + 0.006)]),
    ]


def legs_of(f: Finish, size: tuple[float, float], height: float, material: Material) -> list[Part]:
    """Square, tapered or turned legs, or two trestles: as the scene's style says."""
    x, y = size
    spots = [(s * (x / 2 - 0.08), t * (y / 2 - 0.08)) for s in (-1, 1) for t in (-1, 1)]
    design = f.chosen(4)
    if design == 0:
        return four_legs(material, size, height, 0.06)
    if design == 1:
        return [tapered(material, [(0.032, 0.032, 0.0), (0.06, 0.06, height)], (u, v, 0), 0.008) for u, v in spots]
    if design == 2:
        form = [
            (0.022, 0),
            (0.03, 0.04),
            (0.02, 0.08),
            (0.036, 0.3 * height),
            (0.028, 0.6 * height),
            (0.042, 0.8 * height),
            (0.04, height),
        ]
        return [turned(material, smooth(form, 16), (u, v, 0)) for u, v in spots]
    trestles = [
        pipe(material, [(s * (x / 2 - 0.25), t * (y / 2 - 0.05), 0), (s * (x / 2 - 0.25), t * 0.08, height)], 0.03)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    return [
        *trestles,
        box(material, (x - 0.5, 0.04, 0.07), (0, 0, height * 0.45)),
        *(box(material, (0.06, y - 0.1, 0.06), (s * (x / 2 - 0.25), 0, height - 0.06)) for s in (-1, 1)),
    ]


def table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(f.main, (x, y, 0.04), (0, 0, z - 0.04), 0.018 if f.chosen(2) else 0.005)
    apron = [] if f.chosen(4) == 3 else [box(f.second, (x - 0.18, y - 0.18, 0.08), (0, 0, z - 0.12))]
    return [top, *apron, *legs_of(f, (x, y), z - 0.04, f.second)]
