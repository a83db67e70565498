"""The surfaces that things are made of, and cutting them into surfels: small flat pieces that become Gaussians.

A `Part` is a surface with a material. Everything is metres; a part's coordinates are those of its object: origin at the
centre of the footprint, z up from its base, +y the front.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.worldgen.materials import Material, albedo

Float = NDArray[np.float64]
Vector = tuple[float, float, float]

EDGE_CELLS = (0.25, 0.5)
"""Widths of a patch's outermost cells as shares of the spacing: narrow, so that silhouettes are crisp."""
MIN_AROUND = 6
"""Fewest surfels round a lathed ring."""


@dataclass(frozen=True, eq=False)
class Surfels:
    """N flat rectangles: centre, the two edge vectors (full lengths), the outward normal, and how they look."""

    points: Float  # (N, 3)
    along: Float  # (N, 3) edge vector u
    across: Float  # (N, 3) edge vector v
    normals: Float  # (N, 3) unit, outward
    albedo: Float  # (N, 3) linear
    emission: Float  # (N,) radiance given off, as a multiple of albedo

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: NDArray[np.bool_] | NDArray[np.intp]) -> "Surfels":
        return Surfels(*(getattr(self, name)[index] for name in self.__dataclass_fields__))

    @property
    def areas(self) -> Float:
        """(N,) square metres."""
        return np.asarray(np.linalg.norm(self.along, axis=1) * np.linalg.norm(self.across, axis=1))

    def moved(self, rotation: Float, offset: ArrayLike) -> "Surfels":
        """Turned by ``rotation`` (3, 3), then shifted by ``offset`` (3,) metres."""
        turn = rotation.T
        return Surfels(
            self.points @ turn + np.asarray(offset),
            self.along @ turn,
            self.across @ turn,
            self.normals @ turn,
            self.albedo,
            self.emission,
        )

    @staticmethod
    def joined(pieces: Sequence["Surfels"]) -> "Surfels":
        return Surfels(*(np.concatenate([getattr(p, name) for p in pieces]) for name in Surfels.__dataclass_fields__))


@dataclass(frozen=True)
class Sheet:
    """A flat parallelogram: corner and two edges; its front is the side of ``cross(a, b)``."""

    corner: Vector
    a: Vector
    b: Vector


@dataclass(frozen=True)
class Block:
    """A box about the origin, its edges rounded by ``radius``."""

    size: Vector
    radius: float = 0.0


@dataclass(frozen=True)
class Lathe:
    """A profile of (radius, z) points turned about z, scaled in x and y. Where it rises, outside is away from z."""

    profile: tuple[tuple[float, float], ...]
    scale: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Leaves:
    """M flat leaves: centres, half-length vectors, and half-width vectors, (M, 3) each."""

    centres: Float
    lengths: Float
    widths: Float


Surface = Sheet | Block | Lathe | Leaves


@dataclass(frozen=True, eq=False)
class Part:
    """A surface of one material at its place in the object."""

    surface: Surface
    material: Material
    offset: Vector = (0.0, 0.0, 0.0)
    rotation: Float = field(default_factory=lambda: np.eye(3))  # (3, 3)


def surfels_of(part: Part, spacing: float) -> Surfels:
    """Cut a part into surfels about ``spacing`` metres apart, in object coordinates."""
    surface, material = part.surface, part.material
    spacing = spacing * material.detail
    if isinstance(surface, Sheet):
        pieces = [_sheet(surface, material, spacing)]
    elif isinstance(surface, Block):
        pieces = _block(surface, material, spacing)
    elif isinstance(surface, Lathe):
        pieces = _lathe(surface, material, spacing)
    else:
        pieces = [_leaves(surface, material)]
    return Surfels.joined(pieces).moved(part.rotation, part.offset)


def cells(length: float, spacing: float, pitch: float = 0.0, joint: float = 0.0) -> tuple[Float, Float]:
    """Centres and widths of cells that fill ``length``: even inside, narrow at both ends and at each joint."""
    if pitch > 0:
        joints = np.arange(pitch, length - joint, pitch)
        bounds = np.concatenate([[0.0], np.sort(np.concatenate([joints - joint / 2, joints + joint / 2])), [length]])
        edges = [np.linspace(a, b, max(1, round((b - a) / spacing)) + 1)[:-1] for a, b in pairwise(bounds)]
        edge = np.concatenate([*edges, [length]])
        return (edge[1:] + edge[:-1]) / 2, np.diff(edge)
    rim = sum(EDGE_CELLS) * spacing
    if length < 0.4 * spacing:
        widths = np.array([length])
    elif length < 2 * rim + 0.5 * spacing:
        widths = np.array([0.25, 0.5, 0.25]) * length
    else:
        inner = length - 2 * rim
        count = max(1, round(inner / spacing))
        ends = np.array(EDGE_CELLS) * spacing
        widths = np.concatenate([ends, np.full(count, inner / count), ends[::-1]])
    return np.cumsum(widths) - widths / 2, widths


def _dressed(
    points: Float, along: Float, across: Float, material: Material, uv: Float, extent: tuple[float, float]
) -> Surfels:
    """Give surfels their normals and colours."""
    normals = np.cross(along, across)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    colours = albedo(material, uv, extent, points)
    return Surfels(points, along, across, normals, colours, np.full(len(points), material.emission))


def _spacings(material: Material, spacing: float) -> tuple[float, float]:
    root = np.sqrt(material.stretch)
    return spacing * root, spacing / root


def _sheet(sheet: Sheet, material: Material, spacing: float) -> Surfels:
    a, b = np.asarray(sheet.a, float), np.asarray(sheet.b, float)
    extent = (float(np.linalg.norm(a)), float(np.linalg.norm(b)))
    swap = (
        material.stretch > 1 and extent[1] > extent[0] and material.joints == (0.0, 0.0, 0.0)
    )  # grain runs lengthwise
    du, dv = _spacings(material, spacing)[:: -1 if swap else 1]
    u, wu = cells(extent[0], du, material.joints[0], material.joints[2])
    v, wv = cells(extent[1], dv, material.joints[1], material.joints[2])
    uu, vv = np.repeat(u, len(v)), np.tile(v, len(u))
    a, b = a / extent[0], b / extent[1]
    points = np.asarray(sheet.corner) + uu[:, None] * a + vv[:, None] * b
    along, across = np.repeat(wu, len(v))[:, None] * a, np.tile(wv, len(u))[:, None] * b
    uv = np.stack([vv, uu] if swap else [uu, vv], 1)
    return _dressed(points, along, across, material, uv, extent[::-1] if swap else extent)


def _block(block: Block, material: Material, spacing: float) -> list[Surfels]:
    half = np.asarray(block.size, float) / 2
    pieces = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            i, j = ((axis + 1) % 3, (axis + 2) % 3) if sign > 0 else ((axis + 2) % 3, (axis + 1) % 3)
            corner, a, b = np.where(np.arange(3) == axis, sign * half, -half), np.zeros(3), np.zeros(3)
            a[i], b[j] = 2 * half[i], 2 * half[j]
            flat = _sheet(Sheet(_vector(corner), _vector(a), _vector(b)), material, spacing)
            pieces.append(_rounded(flat, half, block.radius) if block.radius > 0 else flat)
    return pieces


def _vector(array: Float) -> Vector:
    return float(array[0]), float(array[1]), float(array[2])


def _rounded(flat: Surfels, half: Float, radius: float) -> Surfels:
    """Surfels on a sharp box drawn in onto the box with rounded edges."""
    inner = half - min(radius, float(half.min()) * 0.999)

    def draw_in(points: Float) -> tuple[Float, Float]:
        core = np.clip(points, -inner, inner)
        out = points - core
        out = out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)
        return core + out * (half - inner).min(), out

    points, normals = draw_in(flat.points)
    along = draw_in(flat.points + flat.along / 2)[0] - draw_in(flat.points - flat.along / 2)[0]
    across = draw_in(flat.points + flat.across / 2)[0] - draw_in(flat.points - flat.across / 2)[0]
    return Surfels(points, along, across, normals, flat.albedo, flat.emission)


def _lathe(lathe: Lathe, material: Material, spacing: float) -> list[Surfels]:
    pieces: list[Surfels] = []
    profile = np.asarray(lathe.profile, float)  # (P, 2)
    scale = np.array([*lathe.scale, 1.0])
    start = 0.0
    du, dv = _spacings(material, spacing)[::-1]
    for (r0, z0), (r1, z1) in pairwise(profile):
        length = float(np.hypot(r1 - r0, z1 - z0))
        if length < 1e-6:
            continue
        short = length < 1.5 * dv
        centre, width = (np.array([length / 2]), np.array([length])) if short else cells(length, dv)
        for s, w in zip(centre, width, strict=True):
            t = s / length
            r, z = r0 + t * (r1 - r0), z0 + t * (z1 - z0)
            around = max(MIN_AROUND, int(np.ceil(2 * np.pi * r * max(lathe.scale) / du)))
            angle = (np.arange(around) + 0.5 * (len(pieces) % 2)) * (2 * np.pi / around)
            out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)  # (A, 3)
            turn = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], 1)
            points = (out * r + [0, 0, z]) * scale
            along = turn * (2 * np.pi * r / around) * scale
            across = (out * ((r1 - r0) / length) + [0, 0, (z1 - z0) / length]) * w * scale
            uv = np.stack([np.full(around, start + s), angle * max(r, 0.02)], 1)
            pieces.append(_dressed(points, along, across, material, uv, (1.0, 1.0)))
        start += length
    return pieces


def _leaves(leaves: Leaves, material: Material) -> Surfels:
    """Two surfels a leaf, tapering to its tip."""
    centres = np.concatenate([leaves.centres - 0.35 * leaves.lengths, leaves.centres + 0.4 * leaves.lengths])
    along = np.concatenate([leaves.lengths * 1.1, leaves.lengths * 0.9])
    across = np.concatenate([leaves.widths * 1.5, leaves.widths * 1.0])
    uv = np.zeros((len(centres), 2))
    return _dressed(centres, along, across, material, uv, (1.0, 1.0))


def upright(yaw: float) -> Float:
    """Rotation (3, 3) about z by ``yaw`` radians, counter-clockwise."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def tilted(pitch: float) -> Float:
    """Rotation (3, 3) about x by ``pitch`` radians: positive leans what stands upright back, towards -y."""
    c, s = np.cos(pitch), np.sin(pitch)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
