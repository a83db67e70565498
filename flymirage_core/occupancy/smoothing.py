"""Paths made smooth without leaving free space, and paths resampled."""

from typing import Final

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.queries import _path_is_free

Float64 = NDArray[np.float64]

SMOOTHING_ITERATIONS: Final = 100
SMOOTHING_STRENGTH: Final = 0.5
"""Share of the way to the middle of its two neighbours that a point moves in one iteration."""
TOLERANCE: Final = 1e-6
"""Voxels. A move is tried this much to all sides, so that no rounding can put a point across a face that it touches."""


def smooth_path(
    grid: OccupancyGrid,
    path: ArrayLike,
    iterations: int = SMOOTHING_ITERATIONS,
    strength: float = SMOOTHING_STRENGTH,
) -> Float64:
    """Collision-aware Laplacian smoothing of ``path`` (K, 3), ends kept (paper, section III-B).

    In each iteration each inner point in turn moves towards the middle of its neighbours, unless one of its two
    segments would then touch a voxel that is not free. So a path that is free stays free; give the inflated grid that
    it was searched in.
    """
    cells = (np.asarray(path, float) - grid.origin) / grid.resolution  # (K, 3) voxels
    return _smooth(grid.state, cells, iterations, strength) * grid.resolution + grid.origin


def resample_path(path: ArrayLike, spacing: float) -> Float64:
    """Points (M, 3) at equal distances of at most ``spacing`` metres along the polyline ``path`` (K, 3), ends kept.

    The points lie on the path; the straight lines between them cut its corners by up to half the spacing.
    """
    points = np.asarray(path, float)
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)  # (K-1,)
    along = np.concatenate([[0.0], np.cumsum(lengths)])  # (K,)
    count = max(int(np.ceil(along[-1] / spacing - 1e-9)), 1) + 1
    stations = np.linspace(0, along[-1], count)  # (M,)
    return np.stack([np.interp(stations, along, points[:, axis]) for axis in range(3)], axis=1)


@numba.njit(cache=True, nogil=True)
def _smooth(state: NDArray[np.uint8], cells: Float64, iterations: int, strength: float) -> Float64:
    cells = cells.copy()
    trial = np.empty((3, 3))
    for _ in range(iterations):
        for n in range(1, len(cells) - 1):
            trial[0], trial[2] = cells[n - 1], cells[n + 1]
            trial[1] = cells[n] + strength * (0.5 * (trial[0] + trial[2]) - cells[n])
            if _is_free_with_tolerance(state, trial):
                cells[n] = trial[1]
    return cells


@numba.njit(cache=True, nogil=True)
def _is_free_with_tolerance(state: NDArray[np.uint8], cells: Float64) -> bool:
    """Whether the path is free under each of the 8 shifts to the corners of a tiny cube."""
    shift = np.empty(3)
    for corner in range(8):
        for k in range(3):
            shift[k] = TOLERANCE if corner >> k & 1 else -TOLERANCE
        if not _path_is_free(state, cells + shift):
            return False
    return True
