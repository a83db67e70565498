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
BLOCK: Final = 0.75
"""Metres: edge of the blocks in which points are passed over that a frame does not show."""
BLOCK_SLACK: Final = 0.01
"""Metres, so that no rounding hides a block."""
MIN_SUPPORT_POINTS: Final = 5
"""Points of an object that a view must hit to have seen it."""


def solid(points: Float32, frames: Sequence[Frame]) -> NDArray[np.bool_]:
    """(N,) True for points (N, 3) that at least `MIN_HITS` frames hit, and no fewer than see through them."""
    votes = _votes(points, frames)
    return np.asarray((votes[:, 0] >= min(MIN_HITS, len(frames))) & (votes[:, 1] <= votes[:, 0]))


def hidden(points: Float32, frames: Sequence[Frame]) -> NDArray[np.bool_]:
    """(N,) True for places (N, 3) that no frame sees through: something may be there."""
    return np.asarray(_votes(points, frames)[:, 1] == 0)


def _votes(points: Float32, frames: Sequence[Frame]) -> NDArray[np.int32]:
    """(N, 2) frames that hit each point (N, 3), and that see through it."""
    votes = np.zeros((len(points), 2), np.int32)
    if len(points):
        groups = _Groups.in_blocks(points)
        for frame in frames:
            _vote(groups.points, groups.starts, groups.shown_in(frame), frame.depth, *_projection(frame), votes)
        votes[groups.order] = votes.copy()
    return votes


@dataclass(frozen=True, eq=False)
class Detections:
    """How an object was seen: number of views, metres from its centre to the nearest, and its points in each frame."""

    views: int
    nearest: float
    hits: NDArray[np.int64]  # (F,) points that each frame hit; 0 where the frame is too far away or hit too few


def hits(points: Float32, frames: Sequence[Frame]) -> NDArray[np.bool_]:
    """(N, F) which frames hit which points (N, 3)."""
    hit = np.zeros((len(points), len(frames)), bool)
    if not len(points):
        return hit
    groups = _Groups.in_blocks(points)
    for f, frame in enumerate(frames):
        _mark(groups.points, groups.starts, groups.shown_in(frame), frame.depth, *_projection(frame), hit[:, f])
    out = np.empty_like(hit)
    out[groups.order] = hit
    return out


def detections(
    box: FittedBox, rows: NDArray[np.intp], hit_by: NDArray[np.bool_], eyes: NDArray[np.float64], max_distance: float
) -> Detections:
    """The frames within ``max_distance`` metres of a box's centre that hit its points often enough.

    ``rows``: (M,) of its points in ``hit_by`` (K, F), which tells what frames hit what points. ``eyes``: (F, 3) where
    the frames were taken from. The paper's pruning of single detections (section III-B): what lies beyond d_th1 of the
    camera does not count.
    """
    distance = np.linalg.norm(eyes - box.centre, axis=1)  # (F,)
    found = np.where(distance <= max_distance, _count(hit_by, rows), 0)
    found[found < MIN_SUPPORT_POINTS] = 0
    seen = found > 0
    return Detections(int(seen.sum()), float(distance[seen].min(initial=np.inf)), found)


@dataclass(frozen=True, eq=False)
class _Groups:
    """Points in G groups with a ball round each, so that a frame may pass over those outside of its view."""

    points: Float32  # (N, 3) group by group
    order: NDArray[np.intp]  # (N,) number of each point before
    starts: NDArray[np.intp]  # (G + 1,)
    centres: NDArray[np.float64]  # (G, 3)
    radii: NDArray[np.float64]  # (G,)

    @staticmethod
    def in_blocks(points: Float32) -> "_Groups":
        """Grouped by cubes of `BLOCK` metres."""
        blocks = np.floor(points / BLOCK).astype(np.int64)
        labels = np.unique(blocks, axis=0, return_inverse=True)[1].reshape(-1)
        order = np.argsort(labels, kind="stable")
        ordered = points[order]
        starts = np.concatenate([[0], np.cumsum(np.bincount(labels))]).astype(np.intp)
        low, high = (ufunc.reduceat(ordered, starts[:-1]).astype(float) for ufunc in (np.minimum, np.maximum))
        return _Groups(ordered, order, starts, (low + high) / 2, np.linalg.norm(high - low, axis=1) / 2)

    def shown_in(self, frame: Frame) -> NDArray[np.intp]:
        """Groups (S,) that may reach into a frame's view."""
        k = frame.camera.intrinsics
        sides = np.array(
            [[k.fx, 0, k.cx], [-k.fx, 0, k.width - k.cx], [0, k.fy, k.cy], [0, -k.fy, k.height - k.cy], [0, 0, 1]]
        )  # (5, 3) inward normals in the camera's frame
        sides /= np.linalg.norm(sides, axis=1, keepdims=True)
        inside = (self.centres - frame.camera.position) @ (frame.camera.T_world_camera[:3, :3] @ sides.T)  # (G, 5)
        return np.flatnonzero((inside > -self.radii[:, None] - BLOCK_SLACK).all(axis=1))


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
def _vote(
    points: Float32,
    starts: NDArray[np.intp],
    groups: NDArray[np.intp],
    depth: Float32,
    matrix: Float32,
    lens: Float32,
    votes: NDArray[np.int32],
) -> None:
    for g in groups:
        for n in range(starts[g], starts[g + 1]):
            gap, tolerance = _surface_gap(points[n], depth, matrix, lens)
            if abs(gap) <= tolerance:
                votes[n, 0] += 1
            elif gap > tolerance:
                votes[n, 1] += 1


@numba.njit(cache=True, nogil=True)
def _mark(
    points: Float32,
    starts: NDArray[np.intp],
    groups: NDArray[np.intp],
    depth: Float32,
    matrix: Float32,
    lens: Float32,
    hit: NDArray[np.bool_],
) -> None:
    for g in groups:
        for n in range(starts[g], starts[g + 1]):
            gap, tolerance = _surface_gap(points[n], depth, matrix, lens)
            hit[n] = abs(gap) <= tolerance


@numba.njit(cache=True, nogil=True)
def _count(hit_by: NDArray[np.bool_], rows: NDArray[np.intp]) -> NDArray[np.int64]:
    """(F,) how many of the ``rows`` of ``hit_by`` (K, F) are True: numpy's own sum takes ten times as long."""
    counts = np.zeros(hit_by.shape[1], np.int64)
    for row in rows:
        for f in range(len(counts)):
            counts[f] += hit_by[row, f]
    return counts
