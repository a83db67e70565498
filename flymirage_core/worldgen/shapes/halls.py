"""Halls, wards and observatories.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    cable,
    circle,
    cloth,
    frame_of,
    group,
    loft,
    mirrored,
    pipe,
    placed,
    plate,
    rounded_ring,
    spun,
    sweep,
    tapered,
    two_sided,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, turned
from flymirage_core.worldgen.shapes.foliage import fronds
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK, WHITE = paint("silver", "brushed"), paint("black"), paint("white")
BRASS = paint("brass", "brushed")


def aquarium(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    stand = [
        box(paint("charcoal", "wood"), (1.2, 0.45, 0.6), (0, 0, 0), 0.01),
        *(box(paint("charcoal", "wood").shaded(1.4), (0.55, 0.012, 0.5), (s * 0.29, 0.226, 0.05)) for s in (-1, 1)),
        box(DARK, (1.22, 0.47, 0.05), (0, 0, 1.25), 0.01),
    ]
    water = box(replace(paint("turquoise", "water", 0.15), opacity=0.4), (1.18, 0.43, 0.58), (0, 0, 0.62))
    bed = [
        box(paint("sand", "gravel"), (1.16, 0.41, 0.07), (0, 0, 0.61)),
        *(ellipsoid(paint("slate grey", "stone"), (0.1, 0.08, 0.07), (u, -0.05, 0.7)) for u in (-0.35, 0.2)),
    ]
    weeds = [
        placed(p, (u, v, 0.0))
        for u, v in ((-0.45, 0.05), (0.05, -0.05), (0.42, 0.0))
        for p in fronds(paint("green", "leaf"), 5, 0.22, 0.1, 0.68, rng, 2.0)
    ]
    fish = [p for k in range(7) for p in _fish(rng, ("orange", "yellow", "blue", "coral")[k % 4])]
    corners = frame_of(STEEL, (1.2, 0.45, 0.65), 0.012, (0, 0, 0.6))
    return [*stand, *bed, *weeds, *fish, water, *corners]


def _fish(rng: np.random.Generator, colour: str) -> list[Part]:
    spot = np.array([rng.uniform(-0.5, 0.5), rng.uniform(-0.12, 0.16), rng.uniform(0.8, 1.12)])
    side = 1 if rng.random() < 0.5 else -1
    tone = paint(colour, emission=0.1)
    return [
        ellipsoid(tone, (0.045, 0.012, 0.02), tuple(spot)),
        plate(tone, [(-0.02, -0.018), (0.02, 0.0), (-0.02, 0.018)], 0.006, tuple(spot - [side * 0.055, 0, 0])),
    ]


def lectern(size: Vector, f: Finish) -> list[Part]:
    column = [tapered(f.main, [(0.5, 0.42, 0), (0.5, 0.42, 0.06), (0.34, 0.28, 0.1), (0.3, 0.24, 0.95)], radius=0.01)]
    slope = [
        placed(
            box(f.main, (0.6, 0.46, 0.04), (0, 0, 0), 0.008),
            (0, 0, 1.02),
            np.array([[1.0, 0, 0], [0, 0.94, -0.34], [0, 0.34, 0.94]]),
        )
    ]
    book = [
        placed(
            box(paint("ivory", "page", detail=0.4), (0.4, 0.28, 0.03), (0, 0, 0.04), 0.008),
            (0, 0, 1.02),
            np.array([[1.0, 0, 0], [0, 0.94, -0.34], [0, 0.34, 0.94]]),
        )
    ]
    mic = [
        pipe(DARK, [(0.2, 0.18, 1.1), (0.16, 0.16, 1.3), (0.08, -0.02, 1.36)], 0.006, 0.1),
        ellipsoid(DARK, (0.018,) * 3, (0.08, -0.03, 1.36)),
    ]
    return [*column, *slope, *book, *mic, box(f.second, (0.2, 0.012, 0.3), (0, 0.14, 0.5), 0.004)]


def altar(size: Vector, f: Finish) -> list[Part]:
    stone = [
        box(f.main, (1.8, 0.8, 0.1), (0, 0, 0.9), 0.015),
        box(f.main.shaded(0.92), (1.5, 0.62, 0.8), (0, 0, 0.1), 0.01),
        box(f.main, (1.7, 0.75, 0.1), (0, 0, 0), 0.01),
    ]
    pillars = [
        turned(f.main.shaded(1.05), [(0.07, 0.1), (0.05, 0.16), (0.05, 0.82), (0.08, 0.9)], (s * u, 0.33, 0))
        for s in (-1, 1)
        for u in (0.25, 0.68)
    ]
    linen = [
        *two_sided(cloth(paint("white", "fabric"), 0.6, 0.5, (0, 0.41, 0.5), 0.6, 0.01)),
        box(paint("white", "fabric"), (0.6, 0.81, 0.008), (0, 0, 1.0)),
    ]
    arcs = [
        plate(
            f.main.shaded(0.75),
            [(-0.15, 0), (0.15, 0), *((0.15 * np.cos(a), 0.35 + 0.15 * np.sin(a)) for a in np.linspace(0, np.pi, 7))],
            0.02,
            (u, 0.31, 0.22),
        )
        for u in (-0.46, 0, 0.46)
    ]
    return [*stone, *pillars, *linen, *arcs]


def drip_stand(size: Vector, f: Finish) -> list[Part]:
    feet = spun(pipe(f.main, [(0, 0, 0.12), (0.24, 0, 0.06)], 0.014), 5)
    wheels = spun(ellipsoid(DARK, (0.03, 0.02, 0.03), (0.24, 0, 0.03)), 5)
    hooks = [pipe(f.main, [(s * 0.02, 0, 1.86), (s * 0.14, 0, 1.9), (s * 0.17, 0, 1.84)], 0.008, 0.03) for s in (-1, 1)]
    bags = [
        placed(
            loft(
                replace(paint("chalk", "glass"), opacity=0.8),
                np.array(
                    [
                        np.column_stack([rounded_ring(w, d, 0.02), np.full(12, z)])
                        for w, d, z in ((0.05, 0.03, 1.52), (0.12, 0.06, 1.58), (0.13, 0.03, 1.8))
                    ]
                ),
            ),
            (s * 0.16, 0, 0),
        )
        for s in (-1, 1)
    ]
    tube = cable(replace(paint("chalk"), opacity=0.8), (0.16, 0, 1.52), (0.03, 0.05, 1.1), 0.25, 0.005)
    pump = box(paint("slate grey"), (0.16, 0.12, 0.22), (0.0, 0.06, 1.05), 0.02)
    return [*feet, *wheels, pipe(f.main, [(0, 0, 0.08), (0, 0, 1.88)], 0.014), *hooks, *bags, tube, pump]


def privacy_screen(size: Vector, f: Finish) -> list[Part]:
    parts = []
    for k, (u, yaw) in enumerate(((-0.5, 0.25), (0.0, -0.25), (0.5, 0.25))):
        panel = [
            *two_sided(cloth(f.main, 0.48, 1.4, (0, 0, 0.2), 0.16, 0.03)),
            *mirrored(pipe(STEEL, [(0.25, 0, 0.05), (0.25, 0, 1.72)], 0.012)),
            *(pipe(STEEL, [(-0.25, 0, z), (0.25, 0, z)], 0.01) for z in (0.18, 1.66)),
            *mirrored(ellipsoid(DARK, (0.02, 0.03, 0.03), (0.25, 0, 0.03))),
        ]
        parts += group(panel, (u, 0.0 * k, 0), yaw)
    return parts


def telescope(size: Vector, f: Finish) -> list[Part]:
    legs = [
        *spun(pipe(paint("honey brown", "wood"), [(0.05, 0, 0.95), (0.42, 0, 0)], 0.022), 3, 0.5),
        *spun(pipe(BRASS, [(0.03, 0, 0.45), (0.24, 0, 0.45)], 0.008), 3, 0.5),
        cylinder(BRASS, 0.07, 0.12, (0, 0, 0.93)),
    ]
    a, b = np.array([0, -0.4, 0.88]), np.array([0, 0.45, 1.42])
    at = [a + t * (b - a) for t in (0.0, 0.12, 0.13, 0.35, 0.36, 0.86, 0.87, 1.0)]
    tube = sweep(f.main, circle(0.07, 16), at, [0.3, 0.3, 0.5, 0.5, 0.75, 0.75, 0.92, 0.92])
    lens = [
        pipe(DARK, [b + 0.002 * (b - a), b + 0.004 * (b - a)], 0.055),
        pipe(DARK, [np.add(a, (0, -0.06, -0.035)), a], 0.028),
        pipe(f.main, [np.add(a, (0.09, 0.2, 0.18)), np.add(a, (0.09, 0.5, 0.37))], 0.02),
    ]
    return [*legs, tube, *lens, pipe(BRASS, [(0, 0, 1.0), (0, 0.02, 1.16)], 0.035)]
