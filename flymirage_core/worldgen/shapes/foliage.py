"""What plants are made of: greens, petals, fronds, branches, boulders beside them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.worldgen.forms import circle, crown, loft, pipe, sweep
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.noise import fractal
from flymirage_core.worldgen.parts import Finish, paint
from flymirage_core.worldgen.surfaces import Leaves, Part, Vector

BARK = paint("walnut brown", "bark", detail=0.8)
PETALS = ("red", "yellow", "pink", "lavender", "coral", "white", "orange", "plum")
GREENS = ("forest green", "green", "moss green", "olive")


def greenery(f: Finish) -> Material:
    """This scene's green for plants whose main material is their pot."""
    return paint(GREENS[f.chosen(len(GREENS))], "leaf", seed=f.seed % 991)


def leafy(f: Finish, blobs: Sequence[tuple[Vector, Vector]], leaf: tuple[float, float], count: int) -> list[Part]:
    return crown(greenery(f), blobs, leaf, count, f.generator())


def flowers(f: Finish, x: float, y: float, low: float, tall: float, count: int) -> list[Part]:
    """Heads of petals over an area of half sizes (x, y), from ``low`` up to ``low + tall``: one part."""
    rng = f.generator()
    spots = rng.uniform(-1, 1, (count, 3)) * [x, y, tall / 2] + [0, 0, low + tall / 2]
    angle = np.tile(np.arange(5) * 2 * np.pi / 5, count)
    out = np.stack([np.cos(angle), np.sin(angle), np.full(len(angle), 0.35)], 1)
    centres = np.repeat(spots, 5, axis=0) + 0.035 * out
    side = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], 1)
    petal = paint(PETALS[f.chosen(len(PETALS))], "leaf", seed=f.seed % 991)
    return [Part(Leaves(centres, 0.04 * out, 0.03 * side), petal)]


def fronds(
    material: Material, count: int, length: float, droop: float, top: float, rng: np.random.Generator, rise: float = 0.5
) -> list[Part]:
    """Feathered leaves that arch out from (0, 0, top): palms and ferns. One part for the leaflets."""
    centres, lengths, widths, ribs = [], [], [], []
    for k in range(count):
        a, up = k * 2.4 + rng.uniform(-0.2, 0.2), rise * rng.uniform(0.3, 1.3)
        t = np.linspace(0, 1, 11)
        arch = np.stack([t * np.cos(a), t * np.sin(a), up * t - droop * t**2.2], 1) * length * rng.uniform(
            0.8, 1.05
        ) + [0, 0, top]
        ribs.append(pipe(material.shaded(0.7), arch[::2], 0.008 + 0.006 * length))
        along = np.gradient(arch, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        side = np.cross(along, [0, 0, 1.0])
        for i in range(1, 11):
            for s in (-1, 1):
                reach = 0.24 * length * np.sin(np.pi * (0.12 + 0.86 * t[i])) + 0.02
                tip = side[i] * s + along[i] * 0.7 + [0, 0, -0.25]
                tip /= np.linalg.norm(tip)
                centres.append(arch[i] + tip * reach / 2)
                lengths.append(tip * reach / 2)
                widths.append(np.cross(tip, [0.2, 0.1, 1.0]) * 0.035 * length**0.5)
    return [Part(Leaves(np.array(centres), np.array(lengths), np.array(widths)), material), *ribs[:8]]


def branch(start: ArrayLike, end: ArrayLike, radius: float, rng: np.random.Generator) -> Part:
    a, b = np.asarray(start, float), np.asarray(end, float)
    t = np.linspace(0, 1, 6)[:, None]
    path = a + t * (b - a) + rng.normal(0, 0.05, (6, 3)) * np.linalg.norm(b - a) * (t * (1 - t)) * 2
    return sweep(BARK, circle(radius, 8), path, np.linspace(1, 0.35, 6))


def lump(material: Material, seed: int, rough: float) -> Part:
    """A boulder: a ball pushed in and out by noise, flat below."""
    v, a = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 12), np.arange(20) * 2 * np.pi / 20
    ball = np.stack([np.cos(v)[:, None] * np.cos(a), np.cos(v)[:, None] * np.sin(a), np.sin(v)[:, None] + 0 * a], 2)
    push = 1 + rough * fractal(ball.reshape(-1, 3) * 1.3 + seed % 89, seed % 991).reshape(12, 20, 1) * 2
    points = ball * push
    points[..., 2] = np.maximum(points[..., 2], -0.45)
    return loft(material, points, False)
