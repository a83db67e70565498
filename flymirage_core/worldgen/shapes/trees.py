"""Trees, bushes, hedges; logs and rocks.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import circle, crown, pipe, placed, sweep, tapered
from flymirage_core.worldgen.parts import Finish, box, paint, turned
from flymirage_core.worldgen.shapes.foliage import BARK, branch, flowers, fronds, lump
from flymirage_core.worldgen.surfaces import Leaves, Part, Vector, vector


def _trunk(height: float, radius: float, rng: np.random.Generator) -> Part:
    z = np.array([0.0, 0.04, 0.12, 0.3, 0.6, 0.85, 1.0]) * height
    path = np.column_stack([rng.normal(0, 0.02, (7, 2)) * height * 0.5 * (z[:, None] > 0), z])
    return sweep(BARK, circle(radius), path, [1.7, 1.25, 1.0, 0.9, 0.75, 0.6, 0.4])


def tree(size: Vector, f: Finish) -> list[Part]:
    """A broad-leaved tree: a trunk that forks into boughs, and clumps of leaves between which the sky shows."""
    rng = f.generator()
    leaf = replace(f.main, texture="leaf", seed=f.seed % 991)
    k = np.arange(30)
    up, turn = 1 - (k + 0.5) / 18, 2.4 * k + rng.uniform(-0.4, 0.4, 30)  # more of them above than below
    flat = np.sqrt(1 - np.clip(up, -0.66, 1) ** 2)
    out = np.stack([flat * np.cos(turn), flat * np.sin(turn), np.clip(up, -0.66, 1)], 1)
    spots = out * [1.75, 1.75, 1.3] * rng.uniform(0.6, 1.0, (30, 1)) + [0.0, 0.0, 3.9]
    tones = rng.permutation(30) % 3
    parts = [_trunk(3.3, 0.17, rng)]
    boughs = spots[rng.permutation(30)[:7]]
    parts += [branch((0, 0, 1.5 + 0.2 * i), end, 0.075, rng) for i, end in enumerate(boughs)]
    for spot in spots:
        near = boughs[np.argmin(np.linalg.norm(boughs - spot, axis=1))]
        if np.linalg.norm(near - spot) > 0.1:
            parts.append(branch(0.45 * near + [0, 0, 1.3], spot, 0.03, rng))
    for tone, (shade, warm) in enumerate(((1.1, 1.0), (1.6, 1.15), (2.1, 1.35))):
        blobs = [
            (vector(r * np.array([1.0, 1.0, 0.72])), vector(spot))
            for r, spot in zip(rng.uniform(0.5, 0.78, 30)[tones == tone], spots[tones == tone], strict=True)
        ]
        r, g, b = leaf.colour
        parts += crown(replace(leaf, colour=(r * warm, g, b)).shaded(shade), blobs, (0.26, 0.16), 1150, rng, 0.5)
    return parts


def birch(size: Vector, f: Finish) -> list[Part]:
    """Slender white stems and an airy, hanging head."""
    rng = f.generator()
    bark = replace(paint("chalk", "bark"), wear=0.9, seed=f.seed % 97)
    parts = [
        sweep(bark, circle(0.09), [(x, y, 0), (1.3 * x, 1.2 * y, 2.4), (1.8 * x, 1.7 * y, 5.6)], [1.2, 0.85, 0.25])
        for x, y in ((0.0, 0.0), (0.28, 0.16), (-0.26, 0.2))
    ]
    blobs: list[tuple[Vector, Vector]] = []
    for k in range(22):
        a, z = 2.4 * k + rng.uniform(-0.3, 0.3), 1.9 + 0.19 * k
        r = 1.0 - 0.03 * k
        blobs.append(((0.55 * r + 0.1, 0.55 * r + 0.1, 0.75), (0.6 * r * np.cos(a), 0.6 * r * np.sin(a), z)))
        parts.append(branch((0, 0, z - 0.5), blobs[-1][1], 0.025, rng))
    return [*parts, *crown(replace(f.main, texture="leaf").shaded(1.2), blobs, (0.15, 0.1), 3000, rng, 0.0)]


def conifer(size: Vector, f: Finish) -> list[Part]:
    """Whorls of drooping boughs, wide below and narrow at the top."""
    rng = f.generator()
    needles = replace(f.main, texture="leaf").shaded(0.8)
    centres, lengths, widths = [], [], []
    for level in np.linspace(0.0, 1.0, 17):
        reach, z = 1.5 * (1 - level) ** 0.85 + 0.07, 0.75 + 4.9 * level
        for a in np.linspace(0, 2 * np.pi, max(5, int(16 * (1 - level) + 4)), endpoint=False) + rng.uniform(0, 1):
            out = np.array([np.cos(a), np.sin(a), -0.32 + 0.35 * level])
            side = np.array([-np.sin(a), np.cos(a), 0.0])
            for share in np.arange(0.35, 1.0, 0.16):
                at = out * reach * share * rng.uniform(0.9, 1.06) + [0, 0, z]
                for s in (-1, 1):
                    tip = out * 0.8 + s * side * 0.75 + [0, 0, rng.uniform(-0.2, 0.15)]
                    centres.append(at + tip * 0.1)
                    lengths.append(tip * 0.17)
                    widths.append(np.cross(tip, [0.1, 0.1, 1.0]) * 0.062)
    boughs = Part(Leaves(np.array(centres), np.array(lengths), np.array(widths)), needles)
    core = turned(needles.shaded(0.4), [(0, 0.9), (0.6, 0.95), (0.32, 2.6), (0.02, 5.3)])
    return [_trunk(5.4, 0.13, rng), core, boughs]


def cypress(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    blobs: list[tuple[Vector, Vector]] = [
        ((r, r, 0.75), (0, 0, z))
        for r, z in ((0.36, 0.9), (0.46, 1.6), (0.44, 2.4), (0.36, 3.2), (0.24, 3.9), (0.12, 4.5))
    ]
    return [
        _trunk(1.2, 0.1, rng),
        *crown(replace(f.main, texture="leaf").shaded(0.75), blobs, (0.24, 0.08), 1500, rng, 0.85),
    ]


def palm(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    bend = rng.uniform(-0.5, 0.5)
    z = np.linspace(0, 4.2, 15)
    path = np.column_stack([bend * (z / 4.2) ** 2, 0 * z, z])
    rings = 1 + 0.12 * (np.arange(15) % 2)
    trunk = sweep(replace(BARK, colour=paint("taupe").colour), circle(0.15), path, rings * np.linspace(1.15, 0.8, 15))
    head = fronds(replace(f.main, texture="leaf"), 16, 1.9, 0.95, 0.0, rng, 0.75)
    return [trunk, *(placed(p, path[-1]) for p in head)]


def bush(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    blobs: list[tuple[Vector, Vector]] = [((0.5, 0.5, 0.45), (0, 0, 0.48))]
    blobs += [
        ((0.34, 0.34, 0.3), (0.34 * np.cos(a), 0.34 * np.sin(a), rng.uniform(0.3, 0.55))) for a in np.arange(6) * 1.05
    ]
    parts = crown(replace(f.main, texture="leaf"), blobs, (0.13, 0.08), 1300, rng, 0.8)
    return [*parts, *(flowers(f, 0.42, 0.42, 0.55, 0.4, 40) if f.chosen(2) else [])]


def hedge(size: Vector, f: Finish) -> list[Part]:
    """Clipped: leaves on the faces of a box."""
    x, y, z = size
    rng = f.generator()
    green = replace(f.main, texture="leaf")
    area = np.array([x * z, x * z, y * z, y * z, x * y])
    face = rng.choice(5, size=int(420 * area.sum()), p=area / area.sum())
    normal = np.array([[0, 1, 0], [0, -1, 0], [1, 0, 0], [-1, 0, 0], [0, 0, 1.0]])[face]
    inside = rng.uniform(-0.5, 0.5, (len(face), 3)) * [x, y, z]
    at = np.where(normal != 0, normal * np.array([x, y, z]) / 2, inside) * rng.uniform(0.95, 1.0, (len(face), 1)) + [
        0,
        0,
        z / 2,
    ]
    facing = normal + rng.normal(0, 0.45, (len(face), 3))
    lengths = np.cross(facing, rng.normal(size=(len(face), 3)))
    lengths *= 0.05 / np.linalg.norm(lengths, axis=1, keepdims=True)
    widths = np.cross(facing, lengths)
    widths *= 0.032 / np.linalg.norm(widths, axis=1, keepdims=True)
    return [
        box(green.shaded(0.45), (x - 0.09, y - 0.09, z - 0.05), (0, 0, 0.0), 0.05),
        Part(Leaves(at, lengths, widths), green),
    ]


def rock(size: Vector, f: Finish) -> list[Part]:
    return [lump(f.main, f.seed, 0.22)]


def stump(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    a = 2 * np.pi * np.arange(20) / 20
    ring = np.stack([np.cos(a), np.sin(a)], 1)
    bumps = 1 + 0.08 * rng.normal(size=20) + 0.12 * np.cos(5 * a)
    body = sweep(
        replace(BARK, seed=f.seed % 97),
        ring * (0.25 * bumps)[:, None],
        [(0, 0, 0), (0, 0, 0.06), (0, 0, 0.2), (0, 0, 0.42)],
        [1.5, 1.2, 1.0, 0.95],
    )
    return [body, turned(paint("tan", "wood"), [(0.2, 0.424), (0, 0.424)])]


def log_pile(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    parts = []
    for row in range(4):
        for i in range(7 - row):
            r, shift = rng.uniform(0.085, 0.105), rng.uniform(-0.04, 0.04)
            u, z = (i - (6 - row) / 2) * 0.21, 0.105 + row * 0.18
            parts.append(
                pipe(replace(BARK, seed=int(rng.integers(99))), [(u, -0.5 + shift, z), (u, 0.5 + shift, z)], r)
            )
            end = turned(paint("tan", "wood").shaded(rng.uniform(0.85, 1.15)), [(r * 0.9, 0), (0, 0.004)])
            parts.append(placed(end, (u, 0.5 + shift, z), np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])))
    return parts


def hay_bale(size: Vector, f: Finish) -> list[Part]:
    straw = paint("mustard", "bark", seed=f.seed % 97)
    body = placed(
        tapered(straw, [(0.5, 0.46, 0), (0.5, 0.46, 1.0)], radius=0.06),
        (-0.5, 0, 0.23),
        np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
    )
    return [body, *(box(paint("chocolate"), (0.015, 0.47, 0.51), (u, 0, -0.02), 0.01) for u in (-0.22, 0.22))]
