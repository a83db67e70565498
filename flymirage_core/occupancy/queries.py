"""Questions about lines and balls: is it free, is it clear of matter, what does a ray hit first.

Two different questions on purpose. *Free* means flyable: no voxel touched is OCCUPIED or UNKNOWN. *Clear* is the
paper's (section III-C): no occupied point in a cylinder or a ball; unknown space is no matter.
"""

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

Float64 = NDArray[np.float64]


def segment_is_free(grid: OccupancyGrid, start: ArrayLike, end: ArrayLike) -> bool:
    """True if every voxel that the segment from ``start`` (3,) to ``end`` (3,) passes through is FREE."""
    return path_is_free(grid, np.stack([np.asarray(start, float), np.asarray(end, float)]))


def path_is_free(grid: OccupancyGrid, path: ArrayLike) -> bool:
    """True if every voxel that the polyline ``path`` (K, 3) passes through is FREE."""
    cells = (np.asarray(path, float) - grid.origin) / grid.resolution  # (K, 3) in voxels
    return bool(_path_is_free(grid.state, cells))


def cylinder_is_clear(grid: OccupancyGrid, start: ArrayLike, end: ArrayLike, radius: float) -> bool:
    """The paper's visibility check: no occupied point in the cylinder of ``radius`` metres from ``start`` to ``end``.

    An occupied voxel counts as the ball inscribed in it, so a wall counts from its face on. The cylinder's ends are
    flat and go through ``start`` and ``end``: let ``end`` be where the ray reaches the object, so that the object's
    own matter does not count. ``start`` and ``end``: (3,) world.
    """
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(b - a))
    if length == 0:
        return sphere_is_clear(grid, a, radius)
    reach = radius + grid.resolution / 2
    points = _occupied_centres(grid, np.minimum(a, b) - reach, np.maximum(a, b) + reach)  # (M, 3)
    axis = (b - a) / length
    along = (points - a) @ axis  # (M,)
    away = np.linalg.norm(points - a - along[:, None] * axis, axis=1)  # (M,)
    return not bool(((along >= 0) & (along <= length) & (away <= reach)).any())


def sphere_is_clear(grid: OccupancyGrid, point: ArrayLike, radius: float) -> bool:
    """The paper's waypoint safety: no occupied voxel's face within ``radius`` metres of ``point`` (3,)."""
    p = np.asarray(point, float)
    points = _occupied_centres(grid, p - radius - grid.resolution, p + radius + grid.resolution)  # (M, 3)
    gaps = np.maximum(np.abs(points - p) - grid.resolution / 2, 0)  # (M, 3) to the voxel's box
    return not bool((np.linalg.norm(gaps, axis=1) <= radius).any())


def first_hit(grid: OccupancyGrid, origin: ArrayLike, direction: ArrayLike, max_range: float) -> Float64:
    """Metres (...,) along rays from ``origin`` (3,) in ``direction`` (..., 3) to the first OCCUPIED voxel's face.

    inf where nothing is hit within ``max_range`` metres or before the grid ends. Directions need not be unit length.
    """
    directions = np.asarray(direction, float)
    units = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    start = (np.asarray(origin, float) - grid.origin) / grid.resolution
    hits = _first_hits(grid.state, start, units.reshape(-1, 3), max_range / grid.resolution)
    return np.asarray(hits * grid.resolution).reshape(directions.shape[:-1])


def _occupied_centres(grid: OccupancyGrid, lower: Float64, upper: Float64) -> Float64:
    """Centres (M, 3) of the occupied voxels in a box of world points."""
    first = np.clip(grid.index_of(lower), 0, grid.state.shape)
    last = np.clip(grid.index_of(upper) + 1, 0, grid.state.shape)
    box = grid.state[first[0] : last[0], first[1] : last[1], first[2] : last[2]]
    return grid.centre_of(np.argwhere(box == OCCUPIED) + first)


@numba.njit(cache=True, nogil=True)
def _path_is_free(state: NDArray[np.uint8], cells: Float64) -> bool:
    for n in range(len(cells) - 1):
        delta = cells[n + 1] - cells[n]
        length = np.sqrt((delta**2).sum())
        if length == 0:
            delta[0] = 1.0
        else:
            delta /= length
        if _walk(state, cells[n], delta, length, FREE) <= length:
            return False
    return True


@numba.njit(cache=True, nogil=True)
def _first_hits(state: NDArray[np.uint8], start: Float64, units: Float64, reach: float) -> Float64:
    out = np.empty(len(units))
    for n in range(len(units)):
        out[n] = _walk(state, start, units[n], reach, OCCUPIED)
    return out


@numba.njit(cache=True, nogil=True)
def _walk(state: NDArray[np.uint8], start: Float64, unit: Float64, reach: float, subject: int) -> float:
    """Amanatides & Woo 1987, in voxel units: walk the voxels of a ray; the distance where the walk stops, else inf.

    ``subject`` FREE stops at the first voxel that is not free, outside of the grid included; OCCUPIED at the first one
    that is occupied, and never once the ray has left the grid.
    """
    cell = np.floor(start).astype(np.int64)
    step = np.sign(unit).astype(np.int64)
    travelled = 0.0
    crossing = np.full(3, np.inf)  # distance to the next face along each axis
    for k in range(3):
        if step[k] != 0:
            crossing[k] = (cell[k] + (step[k] > 0) - start[k]) / unit[k]
    while travelled <= reach:
        inside = True
        leaving = False
        for k in range(3):
            if cell[k] < 0 or cell[k] >= state.shape[k]:
                inside = False
                leaving = leaving or (cell[k] < 0 and step[k] <= 0) or (cell[k] >= state.shape[k] and step[k] >= 0)
        value = state[cell[0], cell[1], cell[2]] if inside else UNKNOWN
        if (subject == FREE and value != FREE) or (subject == OCCUPIED and value == OCCUPIED):
            return travelled
        if leaving:
            return np.inf
        k = int(np.argmin(crossing))
        travelled = crossing[k]
        cell[k] += step[k]
        crossing[k] = (cell[k] + (step[k] > 0) - start[k]) / unit[k]
    return np.inf
