"""Surface normals and roughness of fused points, by principal components of each point's neighbourhood."""

from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

Float32 = NDArray[np.float32]
Index = NDArray[np.intp]

MIN_NEIGHBOURS: Final = 5
"""Points with fewer, themselves included, get the zero vector."""


def surface_normals(points: Float32, to_camera: Float32, radius: float, neighbours: int) -> Float32:
    """(N, 3) unit normals on the side that the cameras saw, or zero where too few points are near.

    Args:
        points: (N, 3) metres.
        to_camera: (N, 3) mean direction to the cameras that saw each point.
        radius: metres within which points are neighbours.
        neighbours: most that are used.
    """
    return surface_shape(points, to_camera, radius, neighbours)[0]


def surface_variation(points: Float32, radius: float, neighbours: int) -> Float32:
    """(N,) least eigenvalue of each neighbourhood over the sum of all three (Pauly, Gross & Kobbelt 2002).

    0 on a plane, about 0.02 on a vase, 0.1 in leaves, 1/3 in a cloud without direction; 0 where points are too few.
    """
    return surface_shape(points, np.zeros_like(points), radius, neighbours)[1]


def surface_shape(points: Float32, to_camera: Float32, radius: float, neighbours: int) -> tuple[Float32, Float32]:
    """`surface_normals` (N, 3) and `surface_variation` (N,) at once."""
    counts, covariances = _neighbourhoods(points, radius, neighbours)
    values, vectors = np.linalg.eigh(covariances)  # (N, 3) ascending, (N, 3, 3)
    across = vectors[:, :, 0]
    normals = across * np.where((across * to_camera).sum(axis=1) < 0, -1, 1)[:, None]
    variation = values[:, 0] / np.maximum(values.sum(axis=1), 1e-12)
    enough = counts >= MIN_NEIGHBOURS
    return np.where(enough[:, None], normals, 0).astype(np.float32), np.where(enough, variation, 0).astype(np.float32)


def _neighbourhoods(points: Float32, radius: float, neighbours: int) -> tuple[Index, NDArray[np.float64]]:
    """Of each point: number of its neighbours (N,), itself included, and their covariance times it (N, 3, 3).

    Points are sorted into cells as long as the radius: a k-d tree, which serves any radius, takes three times as long.
    """
    cells = np.floor((points - points.min(axis=0, initial=np.inf)) / radius).astype(np.int64) + 1
    shape = cells.max(axis=0, initial=0) + 2
    keys = (cells[:, 0] * shape[1] + cells[:, 1]) * shape[2] + cells[:, 2]
    order = np.argsort(keys, kind="stable")
    occupied, starts = np.unique(keys[order], return_index=True)
    columns = (np.arange(-1, 2)[:, None] * shape[1] + np.arange(-1, 2)).ravel() * shape[2]  # (9,) three cells each
    first = np.searchsorted(occupied, occupied[:, None] + columns - 1)  # (C, 9)
    last = np.searchsorted(occupied, occupied[:, None] + columns + 1, side="right")
    ends = np.append(starts, len(points))
    counts = np.zeros(len(points), np.intp)
    covariances = np.zeros((len(points), 3, 3))
    _gather(points[order], order, ends, ends[first], ends[last], radius, neighbours, counts, covariances)
    return counts, covariances


@numba.njit(cache=True, nogil=True)
def _gather(
    points: Float32,
    order: Index,
    cells: Index,
    first: Index,
    last: Index,
    radius: float,
    most: int,
    counts: Index,
    covariances: NDArray[np.float64],
) -> None:
    """Fill both outputs. Points lie cell by cell; those round cell c are the ``first[c, j]`` to ``last[c, j]``."""
    nearest, squares = np.zeros(most, np.intp), np.zeros(most)
    for c in range(len(first)):
        for n in range(cells[c], cells[c + 1]):
            found = 0
            for j in range(first.shape[1]):
                for m in range(first[c, j], last[c, j]):
                    square = 0.0
                    for a in range(3):
                        square += (points[m, a] - points[n, a]) ** 2
                    if square > radius**2 or (found == most and square >= squares[most - 1]):
                        continue
                    k = min(found, most - 1)
                    while k > 0 and squares[k - 1] > square:
                        squares[k], nearest[k] = squares[k - 1], nearest[k - 1]
                        k -= 1
                    squares[k], nearest[k] = square, m
                    found = min(found + 1, most)
            counts[order[n]] = found
            mean = np.zeros(3)
            for k in range(found):
                for a in range(3):
                    mean[a] += points[nearest[k], a] / found
            for k in range(found):
                for a in range(3):
                    for b in range(3):
                        covariances[order[n], a, b] += (points[nearest[k], a] - mean[a]) * (
                            points[nearest[k], b] - mean[b]
                        )
