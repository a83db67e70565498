"""Which fused points hold against all views: votes of frames that hit them and of frames that see through them."""

from collections.abc import Sequence
from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.fused_points import Frame

Float32 = NDArray[np.float32]

TOLERANCE: Final = 0.06
"""Metres between a point and a frame's surface along the axis within which the frame hits the point."""
RELATIVE_TOLERANCE: Final = 0.025
"""The same as a share of depth, where that is more."""
MIN_HITS: Final = 2
"""Frames that must hit a point."""


def solid(points: Float32, frames: Sequence[Frame]) -> NDArray[np.bool_]:
    """(N,) True for points (N, 3) that at least `MIN_HITS` frames hit, and no fewer than see through them."""
    votes = np.zeros((len(points), 2), np.int32)  # hits, seen through
    for frame in frames:
        _vote(points, frame.depth, *_projection(frame), votes)
    return np.asarray((votes[:, 0] >= min(MIN_HITS, len(frames))) & (votes[:, 1] <= votes[:, 0]))


def supporting_frames(
    points: Float32, owner: NDArray[np.int64], count: int, frames: Sequence[Frame], max_distance: float, min_points: int
) -> NDArray[np.int64]:
    """(count,) frames within ``max_distance`` metres that hit at least ``min_points`` points of each owner.

    ``owner``: (N,) whose point it is, 0..count-1, or -1 for nobody's.
    """
    support = np.zeros(count, np.int64)
    for frame in frames:
        hits = np.zeros(count, np.int64)
        _count_hits(points, owner, frame.depth, *_projection(frame), max_distance, hits)
        support += hits >= min_points
    return support


def _projection(frame: Frame) -> tuple[Float32, Float32]:
    """T_camera_world's upper rows (3, 4) and the lens (4,) fx, fy, cx, cy."""
    k = frame.camera.intrinsics
    lens = np.array([k.fx, k.fy, k.cx, k.cy], np.float32)
    return np.ascontiguousarray(frame.camera.T_camera_world[:3], np.float32), lens


@numba.njit(cache=True, nogil=True)
def _surface_gap(point: Float32, depth: Float32, matrix: Float32, lens: Float32) -> tuple[float, float, float]:
    """(surface depth - point's depth, tolerance, distance to the camera); NaN where the frame says nothing."""
    x = matrix[0, 0] * point[0] + matrix[0, 1] * point[1] + matrix[0, 2] * point[2] + matrix[0, 3]
    y = matrix[1, 0] * point[0] + matrix[1, 1] * point[1] + matrix[1, 2] * point[2] + matrix[1, 3]
    z = matrix[2, 0] * point[0] + matrix[2, 1] * point[1] + matrix[2, 2] * point[2] + matrix[2, 3]
    if z <= np.float32(0.2):
        return np.nan, 0.0, 0.0
    u = int(np.floor(x / z * lens[0] + lens[2]))
    v = int(np.floor(y / z * lens[1] + lens[3]))
    if u < 1 or v < 1 or u >= depth.shape[1] - 1 or v >= depth.shape[0] - 1 or depth[v, u] <= 0:
        return np.nan, 0.0, 0.0
    return depth[v, u] - z, max(TOLERANCE, RELATIVE_TOLERANCE * z), np.sqrt(x * x + y * y + z * z)


@numba.njit(cache=True, nogil=True)
def _vote(points: Float32, depth: Float32, matrix: Float32, lens: Float32, votes: NDArray[np.int32]) -> None:
    for n in range(len(points)):
        gap, tolerance, _ = _surface_gap(points[n], depth, matrix, lens)
        if abs(gap) <= tolerance:
            votes[n, 0] += 1
        elif gap > tolerance:
            votes[n, 1] += 1


@numba.njit(cache=True, nogil=True)
def _count_hits(
    points: Float32,
    owner: NDArray[np.int64],
    depth: Float32,
    matrix: Float32,
    lens: Float32,
    max_distance: float,
    hits: NDArray[np.int64],
) -> None:
    for n in range(len(points)):
        if owner[n] < 0:
            continue
        gap, tolerance, distance = _surface_gap(points[n], depth, matrix, lens)
        if abs(gap) <= tolerance and distance <= max_distance:
            hits[owner[n]] += 1
