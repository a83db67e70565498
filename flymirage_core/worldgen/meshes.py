"""Parts as triangles: what rays are cast against, what measures an object's box, and what is written as a collider."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from numpy.typing import NDArray

from flymirage_core.worldgen.materials import Material, albedo
from flymirage_core.worldgen.surfaces import Block, Float, Leaves, Part, Patch, Sheet, block_faces, drawn_in, patch_uv

ROUND_STEPS = (0.0, 0.3, 1.0)
"""Shares of a rounded edge's radius at which a block's grid has lines."""


@dataclass(frozen=True, eq=False)
class TexturedMesh:
    """Triangles of several parts that know their materials: F faces over V vertices, object (or world) coordinates."""

    vertices: Float  # (V, 3)
    faces: NDArray[np.int64]  # (F, 3) counter-clockwise seen from the front
    face_part: NDArray[np.int64]  # (F,) number of the part
    uv: Float  # (V, 2) surface coordinates, metres
    local: Float  # (V, 3) coordinates in the part's own frame: what textures are made of
    extent: Float  # (V, 2) of the patch, metres
    materials: tuple[Material, ...]  # of each part
    leaves: NDArray[np.bool_]  # (M,) which parts are leaves, through which light shines

    def albedo(self, faces: NDArray[np.int64], weights: Float) -> Float:
        """Linear albedo (N, 3) at barycentric ``weights`` (N, 3) of ``faces`` (N,)."""
        corners = self.faces[faces]  # (N, 3)
        uv, local = ((weights[..., None] * a[corners]).sum(axis=1) for a in (self.uv, self.local))
        colours = np.zeros((len(faces), 3))
        for chosen in _groups(self.patches[faces]):
            material = self.materials[int(self.face_part[faces[chosen[0]]])]
            u, v = self.extent[corners[chosen[0], 0]]
            colours[chosen] = albedo(material, uv[chosen], (float(u), float(v)), local[chosen])
        return colours

    @cached_property
    def patches(self) -> NDArray[np.integer]:
        """(F,) number of the patch that each face is of: those of one part and extent count as one."""
        rows = np.column_stack([self.face_part, self.extent[self.faces[:, 0]]])
        number = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
        return number.astype(np.min_scalar_type(int(number.max(initial=0))))  # 16 bits are sorted by counting

    def emission(self, faces: NDArray[np.int64]) -> Float:
        """(N,) radiance that ``faces`` (N,) give off, as a multiple of their albedo."""
        return np.array([m.emission for m in self.materials])[self.face_part[faces]]

    def opacity(self, faces: NDArray[np.int64]) -> Float:
        """(N,) opacity of ``faces`` (N,): less than 1 for glass."""
        return np.array([m.opacity for m in self.materials])[self.face_part[faces]]

    def opaque(self) -> NDArray[np.int64]:
        """(N,) faces that hide what is behind them: all but panes of glass."""
        return np.flatnonzero(self.opacity(np.arange(len(self.faces))) > 0.5)

    def areas(self) -> Float:
        """(M,) square metres of each part."""
        a, b, c = self.vertices[self.faces].swapaxes(0, 1)
        size = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2  # (F,)
        return np.asarray(np.bincount(self.face_part, size, len(self.materials)), np.float64)

    def trimesh(self) -> trimesh.Trimesh:
        """With sRGB face colours: each triangle's albedo at its middle."""
        faces = np.arange(len(self.faces))
        linear = self.albedo(faces, np.full((len(faces), 3), 1 / 3))
        srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
        colours = np.rint(255 * np.column_stack([srgb, self.opacity(faces)])).astype(np.uint8)  # (F, 4)
        return trimesh.Trimesh(self.vertices, self.faces, face_colors=colours, process=False)


def mesh_of(parts: Sequence[Part]) -> trimesh.Trimesh:
    """The parts as one mesh with a colour for each triangle, in the parts' coordinates (metres)."""
    return textured_mesh(parts).trimesh()


def textured_mesh(parts: Sequence[Part]) -> TexturedMesh:
    """The parts' triangles, in the parts' coordinates. A leaf is two triangles, a flat sheet two, a bent one many."""
    columns: list[tuple[Float, NDArray[np.int64], NDArray[np.int64], Float, Float, Float]] = []
    start = 0
    for number, part in enumerate(parts):
        for points, triangles, coordinates, extent in _pieces(part):
            placed = points @ part.rotation.T + np.asarray(part.offset)
            mirrored = np.linalg.det(part.rotation) < 0  # which turns corners round
            seen = triangles[:, ::-1] if mirrored else triangles
            sizes = np.tile(extent, (len(points), 1))
            columns.append((placed, seen + start, np.full(len(triangles), number), coordinates, points, sizes))
            start += len(points)
    vertices, faces, numbers, uv, local, extents = (np.concatenate(column) for column in zip(*columns, strict=True))
    return TexturedMesh(
        vertices,
        faces,
        numbers,
        uv,
        local,
        extents,
        tuple(p.material for p in parts),
        np.array([isinstance(p.surface, Leaves) for p in parts]),
    )


def corners_of(part: Part) -> Float:
    """Points (V, 3) of a part whose bounds are the part's bounds, its own placement applied."""
    local = np.concatenate([piece[0] for piece in _pieces(part)])
    return np.asarray(local @ part.rotation.T + np.asarray(part.offset))


Piece = tuple[Float, NDArray[np.int64], Float, tuple[float, float]]
"""Local vertices (V, 3), faces (F, 3), uv (V, 2), extent."""


def _pieces(part: Part) -> list[Piece]:
    surface = part.surface
    if isinstance(surface, Leaves):
        return [_leaf_piece(surface)]
    if isinstance(surface, Patch):
        return [_grid_piece(surface.grid, patch_uv(surface.grid))]
    if isinstance(surface, Sheet):
        return [_sheet_piece(surface, part.material)]
    return _block_pieces(surface, part.material)


def _grid_piece(grid: Float, uv: Float) -> Piece:
    rows, columns = grid.shape[:2]
    i = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + columns, i + 1], 1), np.stack([i + 1, i + columns, i + columns + 1], 1)])
    points = grid.reshape(-1, 3)
    a, b, c = points[faces].swapaxes(0, 1)
    faces = faces[np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-12]
    return points, faces, uv.reshape(-1, 2), (float(uv[..., 0].max()), float(uv[..., 1].max()))


def _sheet_piece(sheet: Sheet, material: Material) -> Piece:
    a, b = np.asarray(sheet.a, float), np.asarray(sheet.b, float)
    extent = (float(np.linalg.norm(a)), float(np.linalg.norm(b)))
    share = np.array([[[0, 0], [0, 1]], [[1, 0], [1, 1]]], float)  # (2, 2, 2)
    grid = np.asarray(sheet.corner) + share[..., :1] * a + share[..., 1:] * b
    points, faces, uv, _ = _grid_piece(grid, share * extent)
    lengthwise = material.stretch > 1 and extent[1] > extent[0] and material.joints == (0.0, 0.0, 0.0)
    return (points, faces, uv[:, ::-1], extent[::-1]) if lengthwise else (points, faces, uv, extent)


def _block_pieces(block: Block, material: Material) -> list[Piece]:
    half = np.asarray(block.size, float) / 2
    radius = min(block.radius, float(half.min()) * 0.999)
    ramp = np.array(ROUND_STEPS) * radius if radius > 0 else np.zeros(1)
    pieces = []
    for corner, a, b in block_faces(half):
        across, up = float(np.linalg.norm(a)), float(np.linalg.norm(b))
        u, v = np.concatenate([ramp, across - ramp[::-1]]), np.concatenate([ramp, up - ramp[::-1]])
        grid = corner + (u[:, None, None] / across) * a + (v[None, :, None] / up) * b
        if radius > 0:
            grid = drawn_in(grid.reshape(-1, 3), half, radius).reshape(grid.shape)
        uv = np.stack(np.broadcast_arrays(u[:, None], v[None, :]), 2)
        lengthwise = material.stretch > 1 and up > across and material.joints == (0.0, 0.0, 0.0)
        pieces.append(_grid_piece(grid, uv[..., ::-1] if lengthwise else uv))
    return pieces


def _leaf_piece(leaves: Leaves) -> Piece:
    """A rhomb with its widest place behind the middle: two triangles a leaf."""
    c, l, w = leaves.centres, leaves.lengths, leaves.widths
    points = np.stack([c - l, c - 0.2 * l + w, c + l, c - 0.2 * l - w], 1).reshape(-1, 3)  # (4 M, 3)
    first = 4 * np.arange(len(c))[:, None]
    faces = np.concatenate([first + np.array([0, 2, 1]), first + np.array([0, 3, 2])])
    return points, faces, np.zeros((len(points), 2)), (1.0, 1.0)


def _groups(patches: NDArray[np.integer]) -> list[NDArray[np.intp]]:
    """Indices of the rows of each patch, of ``patches`` (N,)."""
    order = np.argsort(patches, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(patches[order])) + 1) if len(order) else []
