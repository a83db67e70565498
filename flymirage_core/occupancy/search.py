"""A* on a voxel grid, and what of it is reachable at all.

Neighbours are the 26 round a voxel; a diagonal step is taken only if the whole block of 4 or 8 voxels that it crosses
is free. So the straight line between two neighbours of a path never touches a blocked voxel, and what is connected is
what is 6-connected.
"""

import heapq
from typing import Final

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from flymirage_core.errors import PlanningError
from flymirage_core.occupancy.grid import FREE, OccupancyGrid

Float64 = NDArray[np.float64]

CLEARANCE_WEIGHT: Final = 4.0
"""A metre flown in touch with an obstacle costs as much as 1 + this many metres flown in the open."""


def shortest_path(grid: OccupancyGrid, start: ArrayLike, goal: ArrayLike) -> Float64:
    """Shortest free path (K, 3) from ``start`` (3,) to ``goal`` (3,): both exactly, voxel centres between them.

    To keep a drone's distance, search in an inflated grid (paper, section III-B).

    Raises:
        PlanningError: the start or the goal is blocked, or no free space connects them.
    """
    return _path(grid, start, goal, np.ones(grid.state.shape, np.float32))


def clearance_weighted_path(
    grid: OccupancyGrid, field: NDArray[np.float32], start: ArrayLike, goal: ArrayLike, comfortable_clearance: float
) -> Float64:
    """Like `shortest_path`, but a metre costs up to 1 + `CLEARANCE_WEIGHT` where ``comfortable_clearance`` is not kept.

    The price falls linearly from touch to ``comfortable_clearance`` metres. ``field``: (X, Y, Z) metres, the
    `clearance_field` of this grid or of the one it was inflated from.
    """
    lack = np.clip(1 - field / np.float32(comfortable_clearance), 0, 1)  # (X, Y, Z)
    return _path(grid, start, goal, (1 + np.float32(CLEARANCE_WEIGHT) * lack).astype(np.float32))


def nearest_free(grid: OccupancyGrid, point: ArrayLike, max_distance: float) -> Float64:
    """``point`` (3,) itself if it is free, else the nearest free voxel's centre (3,) within ``max_distance`` metres.

    Raises:
        PlanningError: nothing is free within that distance.
    """
    p = np.asarray(point, float)
    if grid.state_at(p) == FREE:
        return p
    first = np.clip(grid.index_of(p - max_distance), 0, grid.state.shape)
    last = np.clip(grid.index_of(p + max_distance) + 1, 0, grid.state.shape)
    box = grid.state[first[0] : last[0], first[1] : last[1], first[2] : last[2]]
    centres = grid.centre_of(np.argwhere(box == FREE) + first)  # (M, 3)
    distances = np.linalg.norm(centres - p, axis=1)
    if len(distances) == 0 or distances.min() > max_distance:
        raise PlanningError(f"no free space within {max_distance:g} m of {_text(p)}")
    return np.asarray(centres[int(distances.argmin())])


def reachable(grid: OccupancyGrid, start: ArrayLike) -> NDArray[np.bool_]:
    """(X, Y, Z) True where `shortest_path` from ``start`` (3,) leads; all False if ``start`` is blocked."""
    if grid.state_at(start) != FREE:
        return np.zeros(grid.state.shape, bool)
    labels, _ = ndimage.label(grid.state == FREE)
    return np.asarray(labels == labels[tuple(grid.index_of(start))])


def _path(grid: OccupancyGrid, start: ArrayLike, goal: ArrayLike, price: NDArray[np.float32]) -> Float64:
    a, b = np.asarray(start, float), np.asarray(goal, float)
    for name, point in (("start", a), ("goal", b)):
        if grid.state_at(point) != FREE:
            raise PlanningError(f"path search: the {name} {_text(point)} is blocked")
    cells = _search(grid.state, price, grid.index_of(a), grid.index_of(b))  # (K, 3)
    if len(cells) == 0:
        raise PlanningError(f"path search: no free space connects {_text(a)} and {_text(b)}")
    inner = grid.centre_of(cells[1:-1])  # the ends' own voxels are left out: the ends lie in them
    return np.vstack([a, inner, b])


def _text(point: Float64) -> str:
    return "({:.2f}, {:.2f}, {:.2f})".format(*point)


@numba.njit(cache=True, nogil=True)
def _octile(dx: int, dy: int, dz: int) -> float:
    """Length of the shortest 26-connected way in empty space, in voxels."""
    a, b, c = abs(dx), abs(dy), abs(dz)
    high, low = max(a, b, c), min(a, b, c)
    return float(high + (np.sqrt(2) - 1) * (a + b + c - high - low) + (np.sqrt(3) - np.sqrt(2)) * low)


@numba.njit(cache=True, nogil=True)
def _step_is_free(state: NDArray[np.uint8], x: int, y: int, z: int, dx: int, dy: int, dz: int) -> bool:
    """Whether all voxels of the block between (x, y, z) and its neighbour are inside and free."""
    for i in range(2):
        for j in range(2):
            for k in range(2):
                u, v, t = x + i * dx, y + j * dy, z + k * dz
                if not (0 <= u < state.shape[0] and 0 <= v < state.shape[1] and 0 <= t < state.shape[2]):
                    return False
                if state[u, v, t] != FREE:
                    return False
    return True


@numba.njit(cache=True, nogil=True)
def _search(
    state: NDArray[np.uint8],
    price: NDArray[np.float32],  # (X, Y, Z) >= 1, per voxel length; an edge pays the mean of its ends
    start: NDArray[np.intp],
    goal: NDArray[np.intp],
) -> NDArray[np.int64]:
    """A* with the octile heuristic; cells (K, 3) from start to goal, none if there is no way."""
    ny, nz = state.shape[1], state.shape[2]
    cost = np.full(state.size, np.inf)
    parent = np.full(state.size, -1, np.int64)
    closed = np.zeros(state.size, np.bool_)
    first = (start[0] * ny + start[1]) * nz + start[2]
    last = (goal[0] * ny + goal[1]) * nz + goal[2]
    cost[first] = 0.0
    queue = [(0.0, 0.0, first)]  # estimated total, -cost (of two equal estimates the one nearer to the goal), cell
    while len(queue) > 0:
        cell = heapq.heappop(queue)[2]
        if cell == last:
            return _traced(parent, cell, ny, nz)
        if closed[cell]:
            continue
        closed[cell] = True
        x, y, z = cell // (ny * nz), cell // nz % ny, cell % nz
        for dx in range(-1, 2):
            for dy in range(-1, 2):
                for dz in range(-1, 2):
                    u, v, t = x + dx, y + dy, z + dz
                    if not (0 <= u < state.shape[0] and 0 <= v < ny and 0 <= t < nz) or state[u, v, t] != FREE:
                        continue
                    other = (u * ny + v) * nz + t
                    if closed[other]:
                        continue
                    length = np.sqrt(float(dx * dx + dy * dy + dz * dz))
                    total = cost[cell] + length * 0.5 * (price[x, y, z] + price[u, v, t])
                    if total < cost[other] - 1e-9 and _step_is_free(state, x, y, z, dx, dy, dz):
                        cost[other] = total
                        parent[other] = cell
                        estimate = total + _octile(goal[0] - u, goal[1] - v, goal[2] - t)
                        heapq.heappush(queue, (estimate, -total, other))
    return np.empty((0, 3), np.int64)


@numba.njit(cache=True, nogil=True)
def _traced(parent: NDArray[np.int64], cell: int, ny: int, nz: int) -> NDArray[np.int64]:
    """The cells (K, 3) from the root to ``cell``."""
    count = 1
    node = cell
    while parent[node] >= 0:
        node = parent[node]
        count += 1
    cells = np.empty((count, 3), np.int64)
    for n in range(count - 1, -1, -1):
        cells[n, 0], cells[n, 1], cells[n, 2] = cell // (ny * nz), cell // nz % ny, cell % nz
        cell = parent[cell]
    return cells
