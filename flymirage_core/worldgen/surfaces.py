"""The surfaces that things are made of, and cutting them into surfels: small flat pieces that become Gaussians.

A `Part` is a surface with a material. Everything is metres; a part's coordinates are those of its object: origin at the
centre of the footprint, z up from its base, +y the front.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.worldgen.halving import textured_cells
from flymirage_core.worldgen.materials import Material

Float = NDArray[np.float64]
Vector = tuple[float, float, float]

EDGE_CELLS = (0.25, 0.5)
"""Widths of a patch's outermost cells as shares of the spacing: narrow, so that silhouettes are crisp."""
FINE_JOINTS = 1.8
"""Joints are cut where they are this many spacings apart."""
CORNER = 0.6
"""Radians: where a patch turns more from one grid line to the next, it has an edge."""
MAX_TURN = 0.8
"""Radians that one surfel may span on a curved surface."""
LEAF_LENGTHS, LEAF_WIDTHS = (0.8, 0.65), (1.1, 0.7)
"""Of a leaf's two surfels, in half lengths and half widths: together their splats cover about what the leaf does."""
FEWER_LEAVES = 0.35
"""Leaves smaller than this share of the spacing are drawn together into fewer, larger ones."""


@dataclass(frozen=True, eq=False)
class Surfels:
    """N flat rectangles: centre, the two edge vectors (full lengths), the outward normal, and how they look."""

    points: Float  # (N, 3)
    along: Float  # (N, 3) edge vector u
    across: Float  # (N, 3) edge vector v
    normals: Float  # (N, 3) unit, outward
    albedo: Float  # (N, 3) linear
    emission: Float  # (N,) radiance given off, as a multiple of albedo
    opacity: Float  # (N,) 1 where solid, less for glass

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: NDArray[np.bool_] | NDArray[np.intp]) -> "Surfels":
        return Surfels(*(getattr(self, name)[index] for name in self.__dataclass_fields__))

    @property
    def areas(self) -> Float:
        """(N,) square metres."""
        return np.asarray(np.linalg.norm(self.along, axis=1) * np.linalg.norm(self.across, axis=1))

    def moved(self, rotation: Float, offset: ArrayLike) -> "Surfels":
        """Mapped by the linear map ``rotation`` (3, 3), then shifted by ``offset`` (3,) metres."""
        turn = rotation.T
        normals = self.normals @ np.linalg.inv(rotation)  # a stretched surface's normal goes by the inverse transpose
        return Surfels(
            self.points @ turn + np.asarray(offset),
            self.along @ turn,
            self.across @ turn,
            normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12),
            self.albedo,
            self.emission,
            self.opacity,
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


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface through a grid of points (P, Q, 3): turned, swept, lofted, bent. Its front is cross(down P, along Q).

    Neighbouring rows or columns that turn by more than `CORNER` meet in an edge; less is one smooth surface.
    """

    grid: Float


@dataclass(frozen=True, eq=False)
class Leaves:
    """M flat leaves: centres, half-length vectors, and half-width vectors, (M, 3) each."""

    centres: Float
    lengths: Float
    widths: Float


Surface = Sheet | Block | Patch | Leaves


@dataclass(frozen=True, eq=False)
class Part:
    """A surface of one material at its place in the object: mapped by ``rotation``, then shifted by ``offset``."""

    surface: Surface
    material: Material
    offset: Vector = (0.0, 0.0, 0.0)
    rotation: Float = field(default_factory=lambda: np.eye(3))  # (3, 3) linear map, a rotation or a stretch


def surfels_of(part: Part, spacing: float) -> Surfels:
    """Cut a part into surfels about ``spacing`` metres apart, in object coordinates."""
    surface, material = part.surface, part.material
    spacing = spacing * material.detail
    if isinstance(surface, Sheet):
        pieces = [_sheet(surface, material, spacing)]
    elif isinstance(surface, Block):
        pieces = _block(surface, material, spacing)
    elif isinstance(surface, Patch):
        pieces = _patch(surface, material, spacing)
    else:
        pieces = [_leaves(surface, material, spacing)]
    return Surfels.joined(pieces).moved(part.rotation, part.offset)


def cells(length: float, spacing: float, pitch: float = 0.0, joint: float = 0.0) -> tuple[Float, Float]:
    """Centres and widths of cells that fill ``length``: even inside, narrow at both ends and at each joint.

    Joints so close that they would make the cells much finer than ``spacing`` are passed over.
    """
    if pitch > FINE_JOINTS * spacing:
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
    points: Float,
    along: Float,
    across: Float,
    material: Material,
    uv: Float,
    extent: tuple[float, float],
    spacing: float,
) -> Surfels:
    """Give surfels their normals and colours, and halve them where the texture asks for it (`textured_cells`).

    ``uv`` (N, 2) is the middle; u runs with ``along``.
    """
    cells, colours = textured_cells(np.concatenate([points, along, across, uv], axis=1), material, extent, spacing)
    points, along, across = cells[:, :3], cells[:, 3:6], cells[:, 6:9]
    normals = np.cross(along, across)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    ones = np.ones(len(points))
    return Surfels(points, along, across, normals, colours, material.emission * ones, material.opacity * ones)


def _spacings(material: Material, spacing: float) -> tuple[float, float]:
    root = np.sqrt(material.stretch)
    return spacing * root, spacing / root


def _sheet(sheet: Sheet, material: Material, spacing: float) -> Surfels:
    a, b = np.asarray(sheet.a, float), np.asarray(sheet.b, float)
    extent = (float(np.linalg.norm(a)), float(np.linalg.norm(b)))
    lengthwise = material.stretch > 1 and extent[1] > extent[0] and material.joints == (0.0, 0.0, 0.0)
    du, dv = _spacings(material, spacing)[:: -1 if lengthwise else 1]
    u, wu = cells(extent[0], du, material.joints[0], material.joints[2])
    v, wv = cells(extent[1], dv, material.joints[1], material.joints[2])
    uu, vv = np.repeat(u, len(v)), np.tile(v, len(u))
    a, b = a / extent[0], b / extent[1]
    points = np.asarray(sheet.corner) + uu[:, None] * a + vv[:, None] * b
    along, across = np.repeat(wu, len(v))[:, None] * a, np.tile(wv, len(u))[:, None] * b
    if lengthwise:  # the grain runs along the longer side
        return _dressed(points, across, -along, material, np.stack([vv, uu], 1), extent[::-1], spacing)
    return _dressed(points, along, across, material, np.stack([uu, vv], 1), extent, spacing)


def _block(block: Block, material: Material, spacing: float) -> list[Surfels]:
    half = np.asarray(block.size, float) / 2
    radius = min(block.radius, float(half.min()) * 0.999)
    pieces = []
    for corner, a, b in block_faces(half):
        flat = _sheet(Sheet(vector(corner), vector(a), vector(b)), material, spacing)
        pieces.append(_rounded(flat, half, radius) if radius > 0 else flat)
    return pieces


def block_faces(half: Float) -> list[tuple[Float, Float, Float]]:
    """Corner and two edges (3,) of each face of a box of half size ``half``: cross(a, b) is outside, b is up."""
    faces = []
    for axis in range(3):
        across, up = ((1, 2), (0, 2), (0, 1))[axis]
        for sign in (-1.0, 1.0):
            turn = sign if axis != 1 else -sign  # so that cross(a, b) points outwards
            corner, a, b = -half, np.zeros(3), np.zeros(3)
            corner[axis], corner[across] = sign * half[axis], -turn * half[across]
            a[across], b[up] = 2 * turn * half[across], 2 * half[up]
            faces.append((corner, a, b))
    return faces


def vector(array: ArrayLike) -> Vector:
    """Three numbers as plain floats."""
    x, y, z = np.asarray(array, float)
    return float(x), float(y), float(z)


def _rounded(flat: Surfels, half: Float, radius: float) -> Surfels:
    """Surfels on a sharp box drawn in onto the box with rounded edges."""
    points = drawn_in(flat.points, half, radius)
    along, across = (
        drawn_in(flat.points + edge / 2, half, radius) - drawn_in(flat.points - edge / 2, half, radius)
        for edge in (flat.along, flat.across)
    )
    out = points - np.clip(points, -(half - radius), half - radius)
    normals = out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)
    return Surfels(points, along, across, normals, flat.albedo, flat.emission, flat.opacity)


def drawn_in(points: Float, half: Float, radius: float) -> Float:
    """Points (N, 3) on a sharp box of half size ``half`` drawn in onto the box with edges rounded by ``radius``."""
    core = np.clip(points, -(half - radius), half - radius)
    out = points - core
    return np.asarray(core + radius * out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12))


def _patch(patch: Patch, material: Material, spacing: float) -> list[Surfels]:
    """Rows of surfels down the grid, and in each row as many as its length there needs."""
    grid = np.concatenate([patch.grid, patch_uv(patch.grid)], axis=2)  # (P, Q, 5)
    du, dv = _spacings(material, spacing)
    rows = _row_bounds(patch.grid, du)
    if len(rows) == 0:
        return []
    middle = rows.mean(axis=1)
    steps, turns = _steps(patch.grid.swapaxes(0, 1))  # (Q - 1,), (Q - 2,)
    pieces = []
    for a, b in pairwise(_corners(turns)):
        line = np.stack([_at(grid, middle, np.full(len(middle), float(q)))[:, :3] for q in range(a, b + 1)], 1)
        lengths = np.linalg.norm(np.diff(line, axis=1), axis=2).sum(axis=1)  # (R,)
        fewest = np.ceil(turns[a : b - 1].sum() / MAX_TURN)
        counts = np.where(lengths > 1e-5, np.maximum(np.rint(lengths / dv), max(fewest, 1.0)), 0.0).astype(int)
        row = np.repeat(np.arange(len(rows)), counts)
        k = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
        reach = np.concatenate([[0.0], np.cumsum(steps[a:b])])
        smooth_ring = b - a == len(steps) and _closed(patch.grid)
        left, right = (
            np.interp(_bound(j, counts[row], smooth_ring) * reach[-1], reach, np.arange(a, b + 1)) for j in (k, k + 1)
        )
        if len(row):
            pieces.append(_patch_surfels(grid, rows[row], left, right, material, spacing))
    return pieces


def _patch_surfels(grid: Float, rows: Float, left: Float, right: Float, material: Material, spacing: float) -> Surfels:
    """One surfel for each cell between two row positions (N, 2) and two column positions (N,)."""
    top, bottom, r, q = rows[:, 0], rows[:, 1], rows.mean(axis=1), (left + right) / 2
    centre = _at(grid, r, q)
    along = (_at(grid, bottom, q) - _at(grid, top, q))[:, :3]
    across = (_at(grid, r, right) - _at(grid, r, left))[:, :3]
    extent = (float(grid[..., 3].max()), float(grid[..., 4].max()))
    return _dressed(centre[:, :3], along, across, material, centre[:, 3:], extent, spacing)


def patch_uv(grid: Float) -> Float:
    """(P, Q, 2) surface coordinates of a patch's grid points in metres: u down its rows, v along each."""
    down = np.linalg.norm(np.diff(grid, axis=0), axis=2).mean(axis=1)
    along = np.linalg.norm(np.diff(grid, axis=1), axis=2)
    u = np.repeat(np.concatenate([[0.0], np.cumsum(down)])[:, None], grid.shape[1], axis=1)
    return np.stack([u, np.concatenate([np.zeros((len(grid), 1)), np.cumsum(along, axis=1)], axis=1)], axis=2)


def _steps(grid: Float) -> tuple[Float, Float]:
    """Mean distances from row to row (P - 1,) and mean angles between two steps (P - 2,)."""
    step = np.diff(grid, axis=0)
    length = np.linalg.norm(step, axis=2)  # (P - 1, Q)
    unit = step / np.maximum(length, 1e-12)[..., None]
    angle = np.arccos(np.clip((unit[1:] * unit[:-1]).sum(axis=2), -1, 1))
    weight = np.minimum(length[1:], length[:-1])
    return length.mean(axis=1), (angle * weight).sum(axis=1) / np.maximum(weight.sum(axis=1), 1e-12)


def _corners(turns: Float) -> list[int]:
    return [0, *(int(i) + 1 for i in np.flatnonzero(turns > CORNER)), len(turns) + 1]


def _row_bounds(grid: Float, spacing: float) -> Float:
    """(R, 2) where each row of surfels begins and ends, as fractional row numbers of the grid."""
    steps, turns = _steps(grid)
    rows = []
    for a, b in pairwise(_corners(turns)):
        reach = np.concatenate([[0.0], np.cumsum(steps[a:b])])
        if reach[-1] < 1e-5:
            continue
        count = max(1, round(reach[-1] / spacing), int(np.ceil(turns[a : b - 1].sum() / MAX_TURN)))
        bounds = _bound(np.arange(count + 1), np.full(count + 1, count), False) * reach[-1]
        at = np.interp(bounds, reach, np.arange(a, b + 1))
        rows.append(np.stack([at[:-1], at[1:]], 1))
    return np.concatenate(rows) if rows else np.zeros((0, 2))


def _bound(k: NDArray[np.intp], count: NDArray[np.intp], even: bool) -> Float:
    """Share of the way at which the k-th of ``count`` cells begins: narrower at both ends, so that edges are crisp."""
    first, second = EDGE_CELLS
    near = np.minimum(k, count - k)
    inset = np.where(near <= 0, 0.0, np.where(near == 1, first, near - 2 + first + second))
    total = count - 4 + 2 * (first + second)
    narrow = np.where(k <= count / 2, inset, total - inset) / np.maximum(total, 1e-9)
    return np.where((count < 4) | even, k / np.maximum(count, 1), narrow)


def _closed(grid: Float) -> bool:
    return bool(np.abs(grid[:, 0] - grid[:, -1]).max() < 1e-9)


def _at(grid: Float, rows: Float, columns: Float) -> Float:
    """(N, C) bilinear values of a grid (P, Q, C) at fractional row and column numbers."""
    i = np.clip(rows.astype(int), 0, grid.shape[0] - 2)
    j = np.clip(columns.astype(int), 0, grid.shape[1] - 2)
    s, t = (rows - i)[:, None], (columns - j)[:, None]
    upper = grid[i, j] * (1 - t) + grid[i, j + 1] * t
    return np.asarray(upper * (1 - s) + (grid[i + 1, j] * (1 - t) + grid[i + 1, j + 1] * t) * s)


def _leaves(leaves: Leaves, material: Material, spacing: float) -> Surfels:
    """Two surfels a leaf, tapering to its tip; where they are too fine for the spacing, fewer and larger leaves."""
    area = float((np.linalg.norm(leaves.lengths, axis=1) * np.linalg.norm(leaves.widths, axis=1)).mean())
    stride = max(1, int((FEWER_LEAVES * spacing / 2) ** 2 / max(area, 1e-9)))
    grown = np.sqrt(stride)
    centres, lengths, widths = leaves.centres[::stride], leaves.lengths[::stride], leaves.widths[::stride]
    lengths, widths = lengths * grown, widths * grown
    outward = centres - leaves.centres.mean(axis=0)  # leaves are bright on their outer and on their upper side
    outward = outward / np.maximum(np.linalg.norm(outward, axis=1, keepdims=True), 1e-9) + [0.0, 0.0, 0.8]
    facing = np.where((np.cross(lengths, widths) * outward).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    points = np.concatenate([centres - 0.35 * lengths, centres + 0.4 * lengths])
    along = np.concatenate([lengths * share for share in LEAF_LENGTHS])
    across = np.concatenate([widths * share * facing for share in LEAF_WIDTHS])
    return _dressed(points, along, across, material, np.zeros((len(points), 2)), (1.0, 1.0), np.inf)


def upright(yaw: float) -> Float:
    """Rotation (3, 3) about z by ``yaw`` radians, counter-clockwise."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def tilted(pitch: float) -> Float:
    """Rotation (3, 3) about x by ``pitch`` radians: positive leans what stands upright back, towards -y."""
    c, s = np.cos(pitch), np.sin(pitch)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
