"""Distances to what is blocked: the clearance field, and grids whose obstacles have grown by a radius."""

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid

Float32 = NDArray[np.float32]


def clearance_field(grid: OccupancyGrid) -> Float32:
    """(X, Y, Z) metres from each voxel's centre to the nearest blocked voxel's surface; 0 in blocked voxels.

    Exact (the distance to a box is a sum over axes, so three passes of one-dimensional minima give it), where a
    Euclidean distance transform between centres would be up to 0.37 voxels too long beside corners. Outside of the
    grid is blocked.
    """
    return _clearance_up_to(grid, np.inf)


def _clearance_up_to(grid: OccupancyGrid, limit: float) -> Float32:
    """`clearance_field` where it is less than ``limit`` metres, ``limit`` elsewhere: the less, the faster."""
    squared = np.where(grid.blocked, 0, (limit / grid.resolution) ** 2).astype(np.float32)  # (X, Y, Z) voxels^2
    for axis in range(3):
        lines = np.ascontiguousarray(np.moveaxis(squared, axis, -1))
        squared = np.moveaxis(_line_distances(lines.reshape(-1, lines.shape[-1])).reshape(lines.shape), -1, axis)
    return np.ascontiguousarray(np.sqrt(squared) * np.float32(grid.resolution))


def clearance_at(grid: OccupancyGrid, field: Float32, points: ArrayLike) -> Float32:
    """Clearance (...,) in metres at world points (..., 3), of the voxel that holds the point; 0 outside of the grid."""
    indices = grid.index_of(points)
    inside = grid.contains(indices)
    i, j, k = np.moveaxis(np.where(inside[..., None], indices, 0), -1, 0)
    return np.where(inside, field[i, j, k], 0).astype(np.float32)


def inflate(grid: OccupancyGrid, radius: float) -> OccupancyGrid:
    """The grid as the centre of a ball of ``radius`` metres sees it: free only where the whole ball is in free space.

    Euclidean, from voxel centres to blocked surfaces: 0.3 m at 0.1 m resolution is three voxels off a wall. What
    becomes blocked becomes OCCUPIED; nothing becomes free.
    """
    tolerance = 1e-4 * grid.resolution
    reached = (grid.state == FREE) & (_clearance_up_to(grid, radius) < radius - tolerance)
    return OccupancyGrid(np.where(reached, OCCUPIED, grid.state).astype(np.uint8), grid.origin, grid.resolution)


def voxels_near(voxels: NDArray[np.bool_], distance: float) -> NDArray[np.bool_]:
    """(X, Y, Z) which voxels' centres lie within ``distance`` voxels of the centre of one of ``voxels`` (X, Y, Z).

    Squared distances, axis by axis and no farther than asked for: a tenth of a whole distance transform's time.
    """
    reach = int(distance)
    squared = np.where(voxels, 0, 3 * (reach + 1) ** 2).astype(np.uint16)  # (X, Y, Z)
    for axis in range(3):
        line = np.moveaxis(squared, axis, 0)
        nearest = line.copy()
        for step in range(1, reach + 1):
            nearest[step:] = np.minimum(nearest[step:], line[:-step] + step**2)
            nearest[:-step] = np.minimum(nearest[:-step], line[step:] + step**2)
        squared = np.moveaxis(nearest, 0, axis)
    return np.asarray(squared <= distance**2)


@numba.njit(cache=True, nogil=True)
def _line_distances(lines: Float32) -> Float32:
    """Along each line (M, n): least of value at distance d plus (gap between the voxels)^2; 0 beyond the ends."""
    out = np.empty_like(lines)
    n = lines.shape[1]
    for m in range(len(lines)):
        for i in range(n):
            best = lines[m, i]
            d = 1
            while d <= n and (d - 0.5) ** 2 < best:
                gap = np.float32((d - 0.5) ** 2)
                below = lines[m, i - d] if i >= d else np.float32(0)
                above = lines[m, i + d] if i + d < n else np.float32(0)
                best = min(best, below + gap, above + gap)
                d += 1
            out[m, i] = best
    return out
