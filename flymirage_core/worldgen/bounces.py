"""Light that comes from surfaces rather than from lamps: gathered at patches, in as many rounds as there are bounces.

A patch is all surface of a voxel that looks one of six ways. Each casts rays over its hemisphere; what they hit is
again a patch, or the sky. Between patches irradiance is interpolated. Both sides of a thin wall are patches of their
own, so no light leaks through.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.sky import Sky
from flymirage_core.worldgen.surfaces import Surfels

Float = NDArray[np.float64]
Int = NDArray[np.int64]

FINEST_VOXEL: Final = 0.16
"""Metres, of patches; larger in places that would have more than `MOST_CELLS` voxels."""
MOST_CELLS: Final = 6e6
FAR: Final = 18.0
"""Metres from the middle of the table (in plan): beyond, `FAR_BLOCK` voxels along each axis are one."""
FAR_BLOCK: Final = 5
RAYS: Final = 80
"""From each patch, over the hemisphere by the cosine: a Fibonacci lattice, turned by another angle for each patch."""
LIFT: Final = 0.01
"""Metres above its surface at which a ray begins."""
BATCH: Final = 8192
"""Patches that gather at once."""
UNKNOWN, OUTSIDE = -2, -1


@dataclass(frozen=True, eq=False)
class Patches:
    """P patches and the table by which places find theirs."""

    origin: Float  # (3,) corner of the table, metres
    voxel: float
    table: NDArray[np.int32]  # (X, Y, Z, 6) patch number or -1; ways +x -x +y -y +z -z
    points: Float  # (P, 3)
    normals: Float  # (P, 3)
    albedo: Float  # (P, 3)
    glow: Float  # (P, 3) radiance given off, apart from lamps

    @staticmethod
    def of(surfels: Surfels, glow: Float) -> "Patches":
        """Patches of all surfels; ``glow`` (N, 3) is the radiance of those that are no lamps."""
        low, high = surfels.points.min(axis=0), surfels.points.max(axis=0)
        voxel = max(FINEST_VOXEL, float(np.prod(high - low + 1.0) / MOST_CELLS) ** (1 / 3))
        origin = low - 1.5 * voxel
        shape = np.ceil((high - origin) / voxel).astype(int) + 2
        cell = _cells(surfels.points, origin, voxel, shape)
        key = np.ravel_multi_index((*cell.T, _ways(surfels.normals)), (*shape, 6))
        keys, own = np.unique(key, return_inverse=True)
        table = np.full((*shape, 6), -1, np.int32)
        table.reshape(-1)[keys] = np.arange(len(keys))
        weight = np.maximum(surfels.areas, 1e-9)
        total = np.bincount(own, weight)[:, None]

        def mean(values: Float) -> Float:
            return np.stack([np.bincount(own, weight * column) for column in values.T], axis=1) / total

        normals = mean(surfels.normals)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
        spots = surfels.points[_foremost(surfels.points, own, normals)]
        return Patches(origin, voxel, table, spots, normals, mean(surfels.albedo), mean(glow))

    def at(self, points: Float, normals: Float) -> Int:
        """(N,) number of the patch that a surface place belongs to; `UNKNOWN` where there is none."""
        cell = _cells(points, self.origin, self.voxel, np.array(self.table.shape[:3]))
        found = self.table[(*cell.T, _ways(normals))].astype(np.int64)
        return np.where(found < 0, UNKNOWN, found)

    def between(self, values: Float, points: Float, normals: Float) -> Float:
        """``values`` (P, 3) at any surface places (N, 3): trilinear in space, by squared cosine among the six ways."""
        at = (points - self.origin) / self.voxel - 0.5
        base = np.floor(at).astype(np.int64)
        inside = at - base
        total, weights = np.zeros((len(points), 3)), np.full(len(points), 1e-12)
        shape = np.array(self.table.shape[:3])
        for corner in np.ndindex(2, 2, 2):
            share = np.where(np.array(corner) == 1, inside, 1 - inside).prod(axis=1) + 1e-4
            cell = _snapped(base + corner, self.voxel, shape)
            for axis in range(3):
                way = 2 * axis + (normals[:, axis] < 0)
                found = self.table[cell[:, 0], cell[:, 1], cell[:, 2], way]
                weight = np.where(found >= 0, share * normals[:, axis] ** 2, 0.0)
                total += weight[:, None] * values[found]
                weights += weight
        return np.asarray(total / weights[:, None])


def _foremost(points: Float, own: Int, normals: Float) -> Int:
    """(P,) the surface place of each patch that lies furthest along its normal.

    The mean of a wall's face and of the frame set back in it lies inside the wall, where all is dark.
    """
    order = np.lexsort(((points * normals[own]).sum(axis=1), own))
    last = np.append(np.flatnonzero(np.diff(own[order])), len(order) - 1)
    return np.asarray(order[last])


def _cells(points: Float, origin: Float, voxel: float, shape: Int) -> Int:
    """(N, 3) table cells of points."""
    return _snapped(np.floor((points - origin) / voxel).astype(np.int64), voxel, shape)


def _snapped(cells: Int, voxel: float, shape: Int) -> Int:
    """Cells (N, 3) in the table; far ones in the corner of their block."""
    cells = np.clip(cells, 0, shape - 1)
    far = (np.abs(cells[:, :2] - shape[:2] / 2) > FAR / voxel).any(axis=1)
    cells[far] -= cells[far] % FAR_BLOCK
    return cells


def gathered(
    patches: Patches, direct: Float, caster: RayCaster, normals: Float, sky: Sky | None, bounces: int
) -> Float:
    """(P, 3) irradiance of patches from other surfaces and the sky.

    Args:
        patches: of the whole place.
        direct: (P, 3) irradiance straight from lamps and the sun.
        caster: all surfaces; ``normals`` (F, 3) are those of its faces.
        sky: what rays see that hit nothing; None: nothing.
        bounces: how often light is handed on.
    """
    seen, from_sky = _trace(patches, caster, normals, sky)
    known = np.maximum(seen, 0)
    indirect = np.zeros_like(direct)
    for _ in range(bounces):
        radiance = patches.glow + patches.albedo * (direct + indirect) / np.pi  # (P, 3)
        mean = radiance.mean(axis=0)
        for start in range(0, len(seen), BATCH):
            part = slice(start, start + BATCH)
            light = np.where((seen[part] >= 0)[..., None], radiance[known[part]], 0.0)
            light += np.where((seen[part] == UNKNOWN)[..., None], mean, 0.0)
            indirect[part] = np.pi * (light.mean(axis=1) + from_sky[part])
    return indirect


def _trace(patches: Patches, caster: RayCaster, normals: Float, sky: Sky | None) -> tuple[NDArray[np.int32], Float]:
    """(P, R) which patch each ray sees, and (P, 3) the mean radiance of the sky over all rays of a patch."""
    count = len(patches.points)
    seen, from_sky = np.empty((count, RAYS), np.int32), np.zeros((count, 3))
    for start in range(0, count, BATCH):
        part = slice(start, min(start + BATCH, count))
        directions = hemispheres(patches.normals[part], start).reshape(-1, 3)
        origins = np.repeat(patches.points[part] + LIFT * patches.normals[part], RAYS, axis=0)
        hits = caster.hits(origins, directions)
        facing = normals[hits.face]
        facing = facing * -np.sign((facing * directions).sum(axis=1))[:, None]
        found = patches.at(origins + (hits.distance[:, None] - 1e-3) * directions, facing)
        missed = hits.face < 0
        seen[part] = np.where(missed, OUTSIDE, found).reshape(-1, RAYS)
        if sky is not None and missed.any():
            light = np.zeros((len(directions), 3))
            light[missed] = sky.radiance(directions[missed])
            from_sky[part] = light.reshape(-1, RAYS, 3).mean(axis=1)
    return seen, from_sky


def hemispheres(normals: Float, first: int) -> Float:
    """(N, R, 3) directions about ``normals`` (N, 3), by the cosine; ``first`` is the first one's number."""
    i = np.arange(RAYS) + 0.5
    radius, height = np.sqrt(i / RAYS), np.sqrt(1 - i / RAYS)
    turn = (np.arange(first, first + len(normals)) * 0.6180339887498949 % 1.0) * 2 * np.pi
    angle = np.pi * (1 + 5**0.5) * i + turn[:, None]  # (N, R)
    a, b = _tangents(normals)
    flat = (radius * np.cos(angle))[..., None] * a[:, None] + (radius * np.sin(angle))[..., None] * b[:, None]
    return np.asarray(flat + height[None, :, None] * normals[:, None])


def _tangents(normals: Float) -> tuple[Float, Float]:
    """Two unit vectors (N, 3) that stand on each normal and on each other."""
    other = np.where(np.abs(normals[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    a = np.cross(other, normals)
    a /= np.maximum(np.linalg.norm(a, axis=1, keepdims=True), 1e-12)
    return a, np.cross(normals, a)


def _ways(normals: Float) -> Int:
    """(N,) which of +x -x +y -y +z -z each normal points to most."""
    axis = np.abs(normals).argmax(axis=1)
    return np.asarray(2 * axis + (normals[np.arange(len(normals)), axis] < 0))
