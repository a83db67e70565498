"""Words for building things out of parts: boxes, turned and bent shapes, cushions, pictures, foliage."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.worldgen.colours import linear_rgb
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.surfaces import Block, Leaves, Part, Patch, Sheet, Vector, tilted, upright, vector

AROUND = 24
"""Sides of a turned shape's grid."""


@dataclass(frozen=True)
class Finish:
    """The materials of one object: its main one, and a second one for legs and frames.

    ``seed`` draws what differs between two of a kind (their books, leaves); ``style`` what all of a kind in one scene
    share (the chairs' backs).
    """

    main: Material
    second: Material
    seed: int
    style: int = 0

    def generator(self) -> np.random.Generator:
        return np.random.default_rng(self.seed)

    def chosen(self, count: int) -> int:
        """Which of ``count`` designs this scene's things of the kind have."""
        return int(np.random.default_rng(self.style).integers(count))


def paint(colour: str, texture: str = "plain", emission: float = 0.0, detail: float = 1.0, seed: int = 0) -> Material:
    """A material of a named colour."""
    return Material(linear_rgb(colour), texture, emission=emission, detail=detail, seed=seed)


def box(
    material: Material, size: Vector, base: ArrayLike = (0.0, 0.0, 0.0), radius: float = 0.0, pitch: float = 0.0
) -> Part:
    """A box of ``size`` standing with its bottom's centre at ``base``; ``pitch`` leans its top towards -y, radians."""
    turn = tilted(pitch)
    offset = np.asarray(base) + turn @ np.array([0.0, 0.0, size[2] / 2])
    return Part(Block(size, radius), material, vector(offset), turn)


def turned(
    material: Material,
    profile: Sequence[tuple[float, float]],
    base: ArrayLike = (0.0, 0.0, 0.0),
    scale: tuple[float, float] = (1.0, 1.0),
) -> Part:
    """A lathed shape: (radius, height) points from the bottom up; outside is away from z where the profile rises."""
    radius, height = np.asarray(profile, float).T
    angle = -np.linspace(0.0, 2 * np.pi, AROUND + 1)
    ring = np.stack([np.cos(angle) * scale[0], np.sin(angle) * scale[1], 0 * angle], 1)  # (A, 3)
    return Part(
        Patch(radius[:, None, None] * ring + height[:, None, None] * np.array([0.0, 0.0, 1.0])), material, vector(base)
    )


def cylinder(material: Material, radius: float, height: float, base: ArrayLike = (0.0, 0.0, 0.0)) -> Part:
    return turned(material, [(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)], base)


def ellipsoid(material: Material, radii: ArrayLike, centre: ArrayLike) -> Part:
    angle = np.linspace(-np.pi / 2, np.pi / 2, 13)
    x, y, z = vector(radii)
    profile = [(float(np.cos(t)) * x, float(np.sin(t)) * z) for t in angle]
    return turned(material, profile, centre, (1.0, y / x))


def smooth(points: Sequence[tuple[float, float]], steps: int = 16) -> list[tuple[float, float]]:
    """A rounded profile through (radius, height) points: Catmull-Rom by chord length."""
    p = np.asarray(points, float)
    knots = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
    slope = np.gradient(p, knots, axis=0)
    t = np.linspace(0, knots[-1], steps + 1)
    i = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(p) - 2)
    h = (knots[i + 1] - knots[i])[:, None]
    s = (t - knots[i])[:, None] / h
    curve = (
        (2 * s**3 - 3 * s**2 + 1) * p[i]
        + (s**3 - 2 * s**2 + s) * h * slope[i]
        + (-2 * s**3 + 3 * s**2) * p[i + 1]
        + (s**3 - s**2) * h * slope[i + 1]
    )
    limit = float(p[:, 0].max())
    return [(float(np.clip(r, 0.0, limit)), float(np.clip(z, p[0, 1], p[:, 1].max()))) for r, z in curve]


def tube(material: Material, points: ArrayLike, radius: float) -> list[Part]:
    """A round bar or pipe along a polyline (P, 3)."""
    path = np.asarray(points, float)
    parts = []
    for a, b in pairwise(path):
        axis = b - a
        length = float(np.linalg.norm(axis))
        z = axis / length
        x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
        x /= np.linalg.norm(x)
        rotation = np.stack([x, np.cross(z, x), z], axis=1)
        parts.append(Part(cylinder(material, radius, length).surface, material, vector(a), rotation))
    return parts


def picture(material: Material, width: float, height: float, base: Vector) -> Part:
    """An upright rectangle that faces +y, its bottom's middle at ``base``; seen from there u runs left to right."""
    x, y, z = base
    return Part(Sheet((x + width / 2, y, z), (-width, 0.0, 0.0), (0.0, 0.0, height)), material)


def four_legs(
    material: Material, size: tuple[float, float], height: float, thick: float, inset: float = 0.03
) -> list[Part]:
    """Square legs under the corners of a (x, y) rectangle."""
    x, y = size[0] / 2 - inset - thick / 2, size[1] / 2 - inset - thick / 2
    return [box(material, (thick, thick, height), (sx * x, sy * y, 0.0)) for sx in (-1, 1) for sy in (-1, 1)]


def foliage(
    material: Material, radii: Vector, centre: Vector, leaf: tuple[float, float], count: int, rng: np.random.Generator
) -> Part:
    """Leaves of (length, width) on the outside of an ellipsoid, pointing outwards and drooping a little."""
    direction = rng.normal(size=(count, 3))
    direction[:, 2] = np.abs(direction[:, 2]) * 0.9 - 0.25
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    centres = direction * np.asarray(radii) * rng.uniform(0.45, 1.0, (count, 1))
    lengths = direction + [0.0, 0.0, 0.35] + 0.35 * rng.normal(size=(count, 3))
    lengths *= leaf[0] / 2 / np.linalg.norm(lengths, axis=1, keepdims=True)
    side = np.cross(lengths, [0.0, 0.0, 1.0]) + 1e-6
    widths = side * (leaf[1] / 2 / np.linalg.norm(side, axis=1, keepdims=True))
    for axis in range(3):  # spread or draw in the crown so that its leaves' tips just fill the radii
        tip = np.abs(lengths[:, axis]) + np.abs(widths[:, axis])
        spread = max((radii[axis] - float(tip.max())) / float(np.abs(centres[:, axis]).max()), 0.1)
        centres[:, axis] *= spread
    return Part(Leaves(centres + np.asarray(centre), lengths, widths), material)


def turned_about(part: Part, yaw: float) -> Part:
    """The same part, turned by ``yaw`` radians about its object's z axis."""
    turn = upright(yaw)
    return Part(part.surface, part.material, vector(turn @ np.asarray(part.offset)), turn @ part.rotation)
