"""The {p, v} pairs of EGO-Planner (arXiv 2008.08835, section III): what pushes control points out of obstacles.

Where the polygon of control points crosses blocked voxels, a path round them is searched; each control point inside
gets a point p on the obstacle's surface, towards that path, and the unit direction v from the control point to it. No
distance field is needed, and the push is bounded by a half-space.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.bspline import FIXED
from flymirage_core.occupancy.grid import FREE, OccupancyGrid
from flymirage_core.occupancy.search import shortest_path

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

MERGED_GAP: Final = 2
"""Two obstacles with no more free samples than this between them, half a voxel apart, are passed as one."""
MIN_PUSH: Final = 1e-5
"""Metres: a control point nearer than this to the path round the obstacle has no direction to be pushed in."""
MIN_MIDPOINT_PUSH: Final = 0.01
"""Metres: a leg that is pushed less than this gets no pair."""
WINDOW: Final = 2.0
"""Metres of grid kept round a collision segment when the path round it is searched."""


@dataclass(frozen=True, eq=False)
class ObstaclePairs:
    """P pairs; a control point may have several."""

    index: Int64  # (P,) control point
    p: Float64  # (P, 3) world, on the obstacle's surface
    v: Float64  # (P, 3) unit

    @staticmethod
    def none() -> "ObstaclePairs":
        return ObstaclePairs(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)))

    def __len__(self) -> int:
        return len(self.index)

    def __add__(self, other: "ObstaclePairs") -> "ObstaclePairs":
        return ObstaclePairs(
            np.concatenate([self.index, other.index]),
            np.concatenate([self.p, other.p]),
            np.concatenate([self.v, other.v]),
        )


class Voxels(NamedTuple):
    """An `OccupancyGrid` for compiled kernels."""

    state: NDArray[np.uint8]  # (X, Y, Z)
    origin: Float64  # (3,)
    resolution: float


def voxels_of(grid: OccupancyGrid) -> Voxels:
    return Voxels(grid.state, grid.origin, grid.resolution)


def find_pairs(points: Float64, space: OccupancyGrid) -> ObstaclePairs:
    """Pairs for all control points (N, 3) inside of blocked voxels of ``space``.

    Raises:
        PlanningError: an end of a collision segment cannot be joined to the other by free space.
    """
    found = ObstaclePairs.none()
    for first, last in collision_segments(points, space):
        found += segment_pairs(points, first, last, _path_round(points[first], points[last], space), space)
    return found


def collision_segments(points: Float64, space: OccupancyGrid, last: int | None = None) -> list[tuple[int, int]]:
    """Pairs (in, out) of free control points between which the polygon (N, 3) crosses blocked voxels.

    ``last`` is the last control point looked at; all of the polygon, if not given (the original looks at two thirds).
    """
    end = len(points) - FIXED if last is None else last
    hits = _blocked_runs(voxels_of(space), points, FIXED - 1, end)
    free = space.state_at(points) == FREE
    segments: list[tuple[int, int]] = []
    for entry, exit_ in hits:
        while entry > 0 and not free[entry]:
            entry -= 1
        while exit_ < len(points) - 1 and not free[exit_]:
            exit_ += 1
        if segments and entry < segments[-1][1] - 1:  # they overlap by more than the leg that both touch
            entry = segments.pop()[0]
        segments.append((int(entry), int(exit_)))
    return segments


def segment_pairs(points: Float64, first: int, last: int, path: Float64, space: OccupancyGrid) -> ObstaclePairs:
    """Pairs for the control points ``first`` to ``last`` of (N, 3), given a free path (K, 3) that joins the two."""
    found, p, v = _segment_pairs(voxels_of(space), points, first, last, np.ascontiguousarray(path))
    index = np.flatnonzero(found)
    return ObstaclePairs(index + first, p[index], v[index])


def _path_round(a: Float64, b: Float64, space: OccupancyGrid) -> Float64:
    """Shortest free path from ``a`` to ``b``: in a window round them if there is one, else in the whole grid."""
    try:
        return shortest_path(space.window(np.minimum(a, b) - WINDOW, np.maximum(a, b) + WINDOW), a, b)
    except PlanningError:
        return shortest_path(space, a, b)


@numba.njit(cache=True, nogil=True)
def is_blocked(voxels: Voxels, point: Float64) -> bool:
    """Whether a world point (3,) lies in a voxel that is not free; outside of the grid counts as blocked."""
    state, origin = voxels.state, voxels.origin
    i = int(np.floor((point[0] - origin[0]) / voxels.resolution))
    j = int(np.floor((point[1] - origin[1]) / voxels.resolution))
    k = int(np.floor((point[2] - origin[2]) / voxels.resolution))
    if i < 0 or j < 0 or k < 0 or i >= state.shape[0] or j >= state.shape[1] or k >= state.shape[2]:
        return True
    return bool(state[i, j, k] != FREE)


@numba.njit(cache=True, nogil=True)
def _blocked_runs(voxels: Voxels, points: Float64, first: int, last: int) -> Int64:
    """(S, 2): control points before and after each blocked run of the polygon, sampled every half voxel at most."""
    runs = np.empty((len(points), 2), np.int64)
    leg = np.zeros(3)
    sample = np.zeros(3)
    count = 0
    gap = MERGED_GAP + 1  # free samples since the last blocked one
    inside = False
    for i in range(first, last):
        length = _direction(points[i], points[i + 1], leg)
        steps = int(np.ceil(length / (0.5 * voxels.resolution))) + 1
        for s in range(steps):
            for k in range(3):
                sample[k] = points[i, k] + leg[k] * (length * s / steps)
            if is_blocked(voxels, sample):
                if not inside and gap > MERGED_GAP:
                    runs[count, 0] = i
                    count += 1
                inside = True
                gap = 0
                runs[count - 1, 1] = i + 1
            else:
                inside = False
                gap += 1
    return runs[:count]


@numba.njit(cache=True, nogil=True)
def _segment_pairs(
    voxels: Voxels,
    points: Float64,
    first: int,
    last: int,
    path: Float64,
) -> tuple[NDArray[np.bool_], Float64, Float64]:
    count = last - first + 1
    found = np.zeros(count, np.bool_)
    p = np.zeros((count, 3))
    v = np.zeros((count, 3))
    x = np.zeros(3)  # where the path crosses the plane across the flight
    tangent = np.zeros(3)
    middle = np.zeros(3)
    for n in range(1, count - 1):
        inner = points[first + n]
        _direction(points[first + n - 1], points[first + n + 1], tangent)
        if _plane_crossing(path, inner, tangent, x):
            length = _direction(inner, x, v[n])
            found[n] = length > MIN_PUSH
            if found[n]:
                _surface_point(voxels, inner, v[n], length, p[n])
    if count == 2:  # the obstacle lies between two neighbours
        leg = _direction(points[first], points[last], tangent)
        for k in range(3):
            p[0, k] = points[first, k]
            middle[k] = points[first, k] + tangent[k] * leg / 2
        if _plane_crossing(path, middle, tangent, x):
            found[0] = _direction(middle, x, v[0]) > MIN_MIDPOINT_PUSH
    for n in range(1, count):  # points without a pair take their neighbour's, forwards and then backwards
        if not found[n] and found[n - 1]:
            _copy_pair(n - 1, n, found, p, v)
    for n in range(count - 2, -1, -1):
        if not found[n] and found[n + 1]:
            _copy_pair(n + 1, n, found, p, v)
    return found, p, v


@numba.njit(cache=True, nogil=True)
def _copy_pair(source: int, to: int, found: NDArray[np.bool_], p: Float64, v: Float64) -> None:
    found[to] = True
    for k in range(3):
        p[to, k] = p[source, k]
        v[to, k] = v[source, k]


@numba.njit(cache=True, nogil=True)
def _direction(a: Float64, b: Float64, out: Float64) -> float:
    """Writes the unit vector from ``a`` to ``b`` to ``out`` (3,) and returns their distance; zeros if they are one."""
    length = np.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)
    for k in range(3):
        out[k] = (b[k] - a[k]) / length if length > 0 else 0.0
    return float(length)


@numba.njit(cache=True, nogil=True)
def _side(point: Float64, centre: Float64, normal: Float64) -> float:
    total = 0.0
    for k in range(3):
        total += (point[k] - centre[k]) * normal[k]
    return total


@numba.njit(cache=True, nogil=True)
def _plane_crossing(path: Float64, point: Float64, normal: Float64, out: Float64) -> bool:
    """Where ``path`` (K, 3), from its middle on, crosses the plane through ``point`` with ``normal``; False if not."""
    k = len(path) // 2
    here = _side(path[k], point, normal)
    step = -1 if here > 0 else 1  # the path runs along the normal
    while 0 <= k + step < len(path):
        there = _side(path[k + step], point, normal)
        if here * there <= 0 and here != there:
            for axis in range(3):
                out[axis] = (there * path[k, axis] - here * path[k + step, axis]) / (there - here)
            return True
        k += step
        here = there
    return False


@numba.njit(cache=True, nogil=True)
def _surface_point(
    voxels: Voxels,
    inner: Float64,
    v: Float64,
    length: float,
    out: Float64,
) -> None:
    """From ``length`` metres along ``v`` back to ``inner``, voxel by voxel: the last point before a blocked one."""
    at = length
    while True:
        for k in range(3):
            out[k] = inner[k] + at * v[k]
        if is_blocked(voxels, out):
            at += voxels.resolution
            break
        if at < voxels.resolution:
            break
        at -= voxels.resolution
    for k in range(3):
        out[k] = inner[k] + at * v[k]
