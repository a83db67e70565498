"""Points held against all views: which are solid and which are seen through, and which views saw an object."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.fused_points import Frame

Float32 = NDArray[np.float32]

TOLERANCE: Final = 0.06
"""Metres between a point and a frame's surface along the axis within which the frame hits the point."""
RELATIVE_TOLERANCE: Final = 0.025
"""The same as a share of depth, where that is more."""
MIN_HITS: Final = 2
"""Frames that must hit a point."""
MIN_SUPPORT_POINTS: Final = 5
"""Points of an object that a view must hit to have seen it."""


def solid(points: Float32, frames: Sequence[Frame]) -> NDArray[np.bool_]:
    """(N,) True for points (N, 3) that at least `MIN_HITS` frames hit, and no fewer than see through them."""
    votes = np.zeros((len(points), 2), np.int32)  # hits, seen through
    for frame in frames:
        _vote(points, frame.depth, *_projection(frame), votes)
    return np.asarray((votes[:, 0] >= min(MIN_HITS, len(frames))) & (votes[:, 1] <= votes[:, 0]))


@dataclass(frozen=True, eq=False)
class Detections:
    """How an object was seen: number of views, metres from its centre to the nearest, and its points in each frame."""

    views: int
    nearest: float
    hits: NDArray[np.int64]  # (F,) points that each frame hit; 0 where the frame is too far away or hit too few


def detections(
    points: Float32, boxes: Sequence[FittedBox], frames: Sequence[Frame], max_distance: float
) -> list[Detections]:
    """For each box, the frames within ``max_distance`` metres of its centre that hit its points (N, 3) often enough.

    The paper's pruning of single detections (section III-B): what lies beyond d_th1 of the camera does not count.
    """
    owner = np.full(len(points), -1, np.int64)
    for k, box in enumerate(boxes):
        owner[box.members] = k
    owned = np.flatnonzero(owner >= 0)
    centres = np.array([box.centre for box in boxes]).reshape(-1, 3)
    views, nearest = np.zeros(len(boxes), int), np.full(len(boxes), np.inf)
    found = np.zeros((len(boxes), len(frames)), np.int64)
    for f, frame in enumerate(frames):
        hits = np.zeros(len(boxes), np.int64)
        _count_hits(points[owned], owner[owned], frame.depth, *_projection(frame), hits)
        distance = np.linalg.norm(centres - frame.camera.position, axis=1)
        seen = (hits >= MIN_SUPPORT_POINTS) & (distance <= max_distance)
        views += seen
        found[:, f] = np.where(seen, hits, 0)
        nearest = np.where(seen, np.minimum(nearest, distance), nearest)
    return [Detections(int(v), float(d), h) for v, d, h in zip(views, nearest, found, strict=True)]


def _projection(frame: Frame) -> tuple[Float32, Float32]:
    """T_camera_world's upper rows (3, 4) and the lens (4,) fx, fy, cx, cy."""
    k = frame.camera.intrinsics
    lens = np.array([k.fx, k.fy, k.cx, k.cy], np.float32)
    return np.ascontiguousarray(frame.camera.T_camera_world[:3], np.float32), lens


@numba.njit(cache=True, nogil=True)
def _surface_gap(point: Float32, depth: Float32, matrix: Float32, lens: Float32) -> tuple[float, float]:
    """(surface depth - point's depth, tolerance); NaN where the frame says nothing."""
    x = matrix[0, 0] * point[0] + matrix[0, 1] * point[1] + matrix[0, 2] * point[2] + matrix[0, 3]
    y = matrix[1, 0] * point[0] + matrix[1, 1] * point[1] + matrix[1, 2] * point[2] + matrix[1, 3]
    z = matrix[2, 0] * point[0] + matrix[2, 1] * point[1] + matrix[2, 2] * point[2] + matrix[2, 3]
    if z <= np.float32(0.2):
        return np.nan, 0.0
    u = int(np.floor(x / z * lens[0] + lens[2]))
    v = int(np.floor(y / z * lens[1] + lens[3]))
    if u < 1 or v < 1 or u >= depth.shape[1] - 1 or v >= depth.shape[0] - 1 or depth[v, u] <= 0:
        return np.nan, 0.0
    return depth[v, u] - z, max(TOLERANCE, RELATIVE_TOLERANCE * z)


@numba.njit(cache=True, nogil=True)
def _vote(points: Float32, depth: Float32, matrix: Float32, lens: Float32, votes: NDArray[np.int32]) -> None:
    for n in range(len(points)):
        gap, tolerance = _surface_gap(points[n], depth, matrix, lens)
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
    hits: NDArray[np.int64],
) -> None:
    for n in range(len(points)):
        gap, tolerance = _surface_gap(points[n], depth, matrix, lens)
        if abs(gap) <= tolerance:
            hits[owner[n]] += 1
