"""Yards, playgrounds, roofs and quays.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from flymirage_core.worldgen.forms import (
    cloth,
    hoop,
    pipe,
    placed,
    skin,
    tapered,
    two_sided,
    wheel,
)
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, turned
from flymirage_core.worldgen.shapes.foliage import leafy
from flymirage_core.worldgen.shapes.structure import pallet
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK = paint("silver", "brushed"), paint("black")


def pergola(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    posts = [
        box(f.main, (0.12, 0.12, z - 0.2), (s * (x / 2 - 0.3), t * (y / 2 - 0.3), 0), 0.008)
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    beams = [box(f.main, (x, 0.07, 0.18), (0, t * (y / 2 - 0.3), z - 0.3), 0.01) for t in (-1, 1)]
    rafters = [
        box(f.main.shaded(0.95), (0.05, y, 0.13), (u, 0, z - 0.14), 0.006)
        for u in np.linspace(-x / 2 + 0.1, x / 2 - 0.1, max(6, round(x / 0.36)))
    ]
    braces = [
        pipe(
            f.main,
            [(s * (x / 2 - 0.3), t * (y / 2 - 0.3), z - 0.75), (s * (x / 2 - 0.75), t * (y / 2 - 0.3), z - 0.3)],
            0.035,
        )
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    vine = leafy(
        f,
        [
            ((0.7, 0.5, 0.12), (-x * 0.2, 0.2, z - 0.05)),
            ((0.2, 0.2, 0.6), (-x / 2 + 0.3, y / 2 - 0.3, z * 0.5)),
            ((0.5, 0.4, 0.1), (x * 0.22, -0.4, z - 0.05)),
        ],
        (0.11, 0.07),
        420,
    )
    return [*posts, *beams, *rafters, *braces, *vine]


def swing(size: Vector, f: Finish) -> list[Part]:
    legs = [pipe(f.main, [(s * 1.15, t * 0.65, 0), (s * 1.0, 0, 2.15)], 0.035) for s in (-1, 1) for t in (-1, 1)]
    seats = []
    for u, y in ((-0.45, 0.0), (0.45, 0.12)):
        seats += [
            box(paint(("red", "blue", "green")[f.chosen(3)]), (0.46, 0.18, 0.03), (u, y, 0.5), 0.012),
            *(pipe(STEEL, [(u + s * 0.2, y, 0.52), (u + s * 0.2, 0, 2.13)], 0.007) for s in (-1, 1)),
        ]
    return [
        *legs,
        pipe(f.main, [(-1.05, 0, 2.15), (1.05, 0, 2.15)], 0.04),
        *seats,
        *(pipe(f.main, [(s * 1.1, -0.35, 0.99), (s * 1.1, 0.35, 0.99)], 0.02) for s in (-1, 1)),
    ]


def slide(size: Vector, f: Finish) -> list[Part]:
    path = np.array([(1.3, 0.12), (0.9, 0.2), (0.2, 0.75), (-0.5, 1.35), (-0.8, 1.42)])
    chute = [np.array([(u, y, z + 0.16 * abs(u / 0.26) ** 4) for u in np.linspace(-0.26, 0.26, 9)]) for y, z in path]
    bed = skin(f.main, chute)
    rims = [pipe(f.main.shaded(0.85), [c[i] for c in chute], 0.03) for i in (0, -1)]
    frame = [
        pipe(
            STEEL,
            [(s * 0.28, -1.35, 0), (s * 0.28, -0.85, 1.42), (s * 0.28, -0.85, 1.95), (s * 0.28, -0.45, 1.6)],
            0.022,
            0.08,
        )
        for s in (-1, 1)
    ]
    rungs = [
        box(paint("slate grey"), (0.56, 0.12, 0.025), (0, -1.35 + 0.5 * t, 1.42 * t))
        for t in (0.15, 0.32, 0.49, 0.66, 0.83)
    ]
    legs = [pipe(STEEL, [(s * 0.26, 0.2, 0.72), (s * 0.3, 0.2, 0)], 0.022) for s in (-1, 1)]
    return [*bed, *rims, *frame, *rungs, *legs, box(paint("slate grey"), (0.56, 0.4, 0.03), (0, -0.75, 1.38))]


def climbing_frame(size: Vector, f: Finish) -> list[Part]:
    """A dome of triangles."""
    rows = []
    for k, (r, z) in enumerate(((1.1, 0.0), (1.0, 0.75), (0.72, 1.4), (0.32, 1.85))):
        turn = k * np.pi / 10
        rows.append(np.array([(r * np.cos(a), r * np.sin(a), z) for a in turn + np.arange(10) * 2 * np.pi / 10]))
    colours = [f.main, paint("yellow", "enamel"), paint("blue", "enamel")]
    bars = []
    for k, (low, high) in enumerate(pairwise(rows)):
        for i in range(10):
            bars += [
                pipe(colours[k % 3], [low[i], high[i]], 0.022),
                pipe(colours[(k + 1) % 3], [low[(i + 1) % 10], high[i]], 0.022),
                pipe(colours[(k + 2) % 3], [high[i], high[(i + 1) % 10]], 0.022),
            ]
    joints = [ellipsoid(DARK, (0.04,) * 3, tuple(p)) for row in rows[1:] for p in row]
    return [*bars, *joints]


def brick_pile(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    parts = []
    for layer in range(8):
        for i in range(4):
            for j in range(3):
                if layer > 5 and rng.random() < 0.25 * (layer - 5) + 0.1:
                    continue
                u, v = (i - 1.5) * 0.255 + rng.normal(0, 0.006), (j - 1) * 0.27 + rng.normal(0, 0.006)
                size_ = (0.24, 0.115, 0.072)
                for s in (-1, 1):
                    parts.append(
                        box(
                            f.main.shaded(rng.uniform(0.75, 1.2)),
                            size_,
                            (u, v + s * 0.062, 0.14 + layer * 0.076),
                            0.004,
                        )
                    )
    return [*parts, *pallet((1.05, 0.85, 0.14), replace(f, main=paint("tan", "wood")))]


def clothesline(size: Vector, f: Finish) -> list[Part]:
    posts = [
        p
        for s in (-1, 1)
        for p in (
            pipe(STEEL, [(s * 1.2, 0, 0), (s * 1.2, 0, 1.85)], 0.025),
            pipe(STEEL, [(s * 1.2, -0.5, 1.85), (s * 1.2, 0.5, 1.85)], 0.02),
        )
    ]
    lines = [pipe(paint("chalk"), [(-1.2, y, 1.85), (0, y, 1.78), (1.2, y, 1.85)], 0.005) for y in (-0.45, 0.0, 0.45)]
    tints = ("chalk", "coral", "powder blue", "mustard", "sage", "burgundy", "denim blue")
    wash = [
        p
        for k, (u, y, w, h) in enumerate(
            (
                (-0.75, 0.45, 0.6, 0.75),
                (0.0, 0.45, 0.5, 0.6),
                (0.65, 0.45, 0.45, 0.7),
                (-0.5, 0.0, 0.9, 1.2),
                (0.55, 0.0, 0.7, 0.9),
                (-0.2, -0.45, 0.5, 0.6),
                (0.5, -0.45, 0.6, 0.8),
            )
        )
        for p in two_sided(
            cloth(f.main if k == 3 else paint(tints[(k + f.seed) % 7], "fabric"), w, h, (u, y, 1.8 - h), 0.35, 0.08)
        )
    ]
    return [*posts, *lines, *wash]


def chimney(size: Vector, f: Finish) -> list[Part]:
    bricks = replace(f.main, texture="bricks", detail=0.8)
    stack = [
        box(bricks, (0.7, 0.7, 1.5)),
        box(bricks.shaded(0.85), (0.8, 0.8, 0.16), (0, 0, 1.4)),
        box(paint("light grey", "concrete"), (0.78, 0.78, 0.06), (0, 0, 1.56), 0.01),
    ]
    pots = [
        turned(
            paint("terracotta", "stone"),
            [(0.13, 1.6), (0.11, 1.65), (0.1, 1.9), (0.13, 1.93), (0.12, 2.0), (0.09, 2.0), (0.08, 1.9), (0, 1.85)],
            (s * 0.18, 0, 0),
        )
        for s in (-1, 1)
    ]
    return [*stack, *pots, box(paint("slate grey", "metal"), (0.8, 0.8, 0.1), (0, 0, 0), 0.01)]


def boat(size: Vector, f: Finish) -> list[Part]:
    """A fishing boat on trestles, with a wheelhouse."""
    rings = []
    for t in np.linspace(0, 1, 11):
        half = 0.78 * (0.8 + 0.2 * min(t / 0.3, 1.0)) * (1 - max(0.0, (t - 0.5) / 0.5) ** 2.3) + 0.004
        top = 0.75 + 0.3 * t**2.5
        keel = 0.12 + 0.5 * max(0.0, (t - 0.75) / 0.25) ** 2
        rings.append(
            [
                (half * np.cos(a), -2.05 + 4.1 * t, keel + (top - keel) * (1 - np.sin(a) ** 0.8))
                for a in np.linspace(0, np.pi, 11)
            ]
        )
    grid = np.array(rings)
    deck = skin(paint("honey brown", "planks"), [np.linspace(r[-1], r[0], 5) - [0, 0, 0.14] for r in grid])
    transom = skin(f.main, [grid[0], np.array([(u, y, 0.75) for u, y, _ in grid[0]])])
    house = [
        tapered(paint("chalk"), [(0.8, 0.9, 0.7), (0.74, 0.8, 1.35)], (0, -0.5, 0), 0.06),
        box(f.second, (0.9, 1.0, 0.05), (0, -0.5, 1.35), 0.02),
        *(box(paint("charcoal", "glass"), (0.5, 0.02, 0.22), (0, -0.5 + s * 0.415, 1.05)) for s in (-1, 1)),
        *(box(paint("charcoal", "glass"), (0.02, 0.5, 0.22), (s * 0.385, -0.5, 1.05)) for s in (-1, 1)),
    ]
    line = [pipe(paint("chalk"), grid[:, i], 0.04) for i in (0, -1)]
    gear = [
        placed(hoop(paint("orange"), 0.16, 0.04), (0.41, -0.5, 0.95), np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])),
        pipe(STEEL, [(0, -0.85, 1.3), (0, -0.85, 1.9)], 0.02),
        pipe(STEEL, [(0, 1.6, 0.9), (0, 1.6, 1.2)], 0.04),
    ]
    rests = [tapered(paint("tan", "wood"), [(1.2, 0.16, 0), (0.7, 0.14, 0.3)], (0, y, 0), 0.01) for y in (-1.2, 0.8)]
    return [*skin(f.main, grid[:, ::-1], 0.7), *deck, *transom, *house, *line, *gear, *rests]


def luggage_cart(size: Vector, f: Finish) -> list[Part]:
    """An airport trailer: a flat bed with bags under a roof."""
    rng = f.generator()
    bed = [
        box(f.main, (1.4, 2.4, 0.1), (0, -0.2, 0.4), 0.02),
        *(box(f.main, (0.06, 0.06, 0.85), (s * 0.66, -0.2 + t * 1.14, 0.5)) for s in (-1, 1) for t in (-1, 1)),
        box(f.main, (1.44, 2.46, 0.05), (0, -0.2, 1.28), 0.02),
    ]
    wheels = [p for s in (-1, 1) for y in (-0.95, 0.55) for p in wheel(DARK, STEEL, 0.2, 0.14, (s * 0.6, y, 0.2))]
    tow = [pipe(DARK, [(0, 1.0, 0.42), (0, 1.45, 0.2)], 0.03), placed(hoop(DARK, 0.05, 0.018), (0, 1.48, 0.18))]
    bags = []
    for u in (-0.42, 0.05, 0.45):
        for y in np.arange(-1.1, 0.8, 0.52):
            h = float(rng.uniform(0.4, 0.7))
            colour = str(rng.choice(["navy", "black", "burgundy", "teal", "slate grey", "rust", "forest green"]))
            bags += [
                box(paint(colour, "fabric"), (0.38, 0.46, h), (u, y, 0.5), 0.06),
                box(DARK, (0.14, 0.03, 0.03), (u, y, 0.5 + h), 0.01),
            ]
    return [*bed, *wheels, *tow, *bags]
