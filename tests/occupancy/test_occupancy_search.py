from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from flymirage_core.errors import PlanningError
from flymirage_core.occupancy.distance import clearance_at, clearance_field
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.occupancy.queries import path_is_free
from flymirage_core.occupancy.search import (
    CLEARANCE_WEIGHT,
    clearance_weighted_path,
    nearest_free,
    reachable,
    shortest_path,
)
from flymirage_core.occupancy.smoothing import resample_path, smooth_path

SEEDS = st.integers(0, 2**32 - 1)


def random_grid(seed, shape=(6, 5, 4), free=0.7):
    state = np.where(np.random.default_rng(seed).random(shape) < free, FREE, OCCUPIED).astype(np.uint8)
    return OccupancyGrid(state, np.array([-0.3, 0.2, 1.0]), 0.1)


def two_free_voxels(grid, seed):
    free = np.argwhere(grid.state == FREE)
    a, b = np.random.default_rng(seed).integers(0, len(free), 2)
    return free[a], free[b]


def all_costs(grid, start, price):
    """Dijkstra over all voxels with every allowed step written out, from scipy."""
    shape, rows, columns, costs = grid.state.shape, [], [], []
    for a in np.argwhere(grid.state == FREE):
        for d in np.argwhere(np.ones((3, 3, 3))) - 1:
            block = grid.state[tuple(slice(min(x, x + e), max(x, x + e) + 1) for x, e in zip(a, d, strict=True))]
            if d.any() and grid.contains(a + d) and (a + d >= 0).all() and (block == FREE).all():
                rows.append(np.ravel_multi_index(a, shape))
                columns.append(np.ravel_multi_index(a + d, shape))
                costs.append(np.linalg.norm(d) * (price[tuple(a)] + price[tuple(a + d)]) / 2)
    graph = coo_matrix((costs, (rows, columns)), shape=(grid.state.size,) * 2)
    return dijkstra(graph, indices=np.ravel_multi_index(start, shape)).reshape(shape)


def cost_of(grid, path, price):
    cells = grid.index_of(path)
    ends = price[tuple(cells[:-1].T)] + price[tuple(cells[1:].T)]
    return (np.linalg.norm(np.diff(cells, axis=0), axis=1) * ends / 2).sum()


@given(SEEDS)
@settings(max_examples=60)
def test_shortest_path_is_as_short_as_dijkstras(seed):
    grid = random_grid(seed)
    a, b = two_free_voxels(grid, seed)
    price = np.ones(grid.state.shape)
    costs = all_costs(grid, a, price)
    np.testing.assert_array_equal(reachable(grid, grid.centre_of(a)), np.isfinite(costs))
    if np.isfinite(costs[tuple(b)]):
        path = shortest_path(grid, grid.centre_of(a), grid.centre_of(b))
        assert cost_of(grid, path, price) == pytest.approx(costs[tuple(b)], abs=1e-6)
        assert path_is_free(grid, path)
    else:
        with pytest.raises(PlanningError, match="no free space connects"):
            shortest_path(grid, grid.centre_of(a), grid.centre_of(b))


@given(SEEDS)
@settings(max_examples=30)
def test_clearance_weighted_path_is_as_cheap_as_dijkstras(seed):
    grid = random_grid(seed, (7, 7, 5), free=0.9)
    a, b = two_free_voxels(grid, seed)
    field = clearance_field(grid)
    price = 1 + CLEARANCE_WEIGHT * np.clip(1 - field / 0.25, 0, 1)
    costs = all_costs(grid, a, price)
    if np.isfinite(costs[tuple(b)]):
        path = clearance_weighted_path(grid, field, grid.centre_of(a), grid.centre_of(b), 0.25)
        assert cost_of(grid, path, price) == pytest.approx(costs[tuple(b)], rel=1e-5)


def corridor():
    """Two rooms joined by a wide opening and, on the direct way, a narrow one."""
    state = np.zeros((40, 40, 10), np.uint8)
    state[20, :, :] = OCCUPIED
    state[20, 19, :] = FREE
    state[20, 22:37, :] = FREE
    return OccupancyGrid(state, np.zeros(3), 0.1)


def test_a_weighted_path_takes_the_wide_opening_and_the_shortest_the_narrow_one():
    grid = corridor()
    field, a, b = clearance_field(grid), [0.55, 1.95, 0.55], [3.55, 1.95, 0.55]
    short, wide = shortest_path(grid, a, b), clearance_weighted_path(grid, field, a, b, 0.6)
    assert clearance_at(grid, field, short).min() < 0.2 < clearance_at(grid, field, wide).min()
    for path in (short, wide):
        np.testing.assert_array_equal(path[[0, -1]], [a, b])


def test_search_says_why_there_is_no_path():
    grid = corridor()
    cases = [([2.05, 0, 0.5], [1, 1, 0.5], "start .* is blocked"), ([1, 1, 0.5], [9, 9, 9], "goal .* is blocked")]
    for a, b, reason in cases:
        with pytest.raises(PlanningError, match=reason):
            shortest_path(grid, a, b)


def test_nearest_free_is_the_point_itself_or_the_nearest_voxel():
    grid = corridor()
    np.testing.assert_array_equal(nearest_free(grid, [1.02, 1.03, 0.5], 0.1), [1.02, 1.03, 0.5])
    np.testing.assert_allclose(nearest_free(grid, [2.06, 0.55, 0.55], 0.3), [2.15, 0.55, 0.55])
    with pytest.raises(PlanningError, match="no free space within 0"):
        nearest_free(grid, [2.05, 0.55, 0.55], 0.05)
    with pytest.raises(PlanningError):
        nearest_free(grid, [-50, 0, 0], 1.0)


@given(SEEDS)
@settings(max_examples=40)
def test_smoothing_stays_free_keeps_the_ends_and_never_lengthens(seed):
    grid = random_grid(seed, (12, 12, 6), free=0.9)
    a, b = two_free_voxels(grid, seed)
    if not reachable(grid, grid.centre_of(a))[tuple(b)]:
        return
    path = shortest_path(grid, grid.centre_of(a), grid.centre_of(b))
    smooth = smooth_path(grid, path)
    assert path_is_free(grid, smooth)
    dense = np.concatenate([p + np.linspace(0, 1, 50)[:, None] * (q - p) for p, q in pairwise(smooth)])
    assert (grid.state_at(dense) == FREE).all()
    np.testing.assert_allclose(smooth[[0, -1]], path[[0, -1]], atol=1e-12)
    assert (
        np.linalg.norm(np.diff(smooth, axis=0), axis=1).sum()
        <= np.linalg.norm(np.diff(path, axis=0), axis=1).sum() + 1e-9
    )


def test_smoothing_rounds_a_zigzag():
    grid = OccupancyGrid(np.zeros((30, 30, 10), np.uint8), np.zeros(3), 0.1)
    zigzag = np.array([[0.5 + 0.1 * i, 1 + 0.3 * (i % 2), 0.5] for i in range(15)])
    smooth = smooth_path(grid, zigzag)
    np.testing.assert_allclose(smooth[:, 1], 1.0, atol=0.05)  # both ends of it are at 1.0


@given(SEEDS, st.floats(0.03, 2))
@settings(max_examples=40)
def test_resampling_spaces_points_evenly_on_the_path(seed, spacing):
    path = np.random.default_rng(seed).uniform(0, 2, (5, 3))
    points = resample_path(path, spacing)
    length = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    np.testing.assert_allclose(points[[0, -1]], path[[0, -1]])
    assert len(points) == max(int(np.ceil(length / spacing - 1e-9)), 1) + 1
    starts, sides = path[:-1], np.diff(path, axis=0)
    along = np.clip(((points[:, None] - starts) * sides).sum(-1) / (sides**2).sum(-1), 0, 1)
    off = np.linalg.norm(points[:, None] - starts - along[..., None] * sides, axis=2).min(axis=1)
    np.testing.assert_allclose(off, 0, atol=1e-9)
    assert (np.linalg.norm(np.diff(points, axis=0), axis=1) <= spacing + 1e-9).all()


def test_resampling_a_path_of_no_length_keeps_its_ends():
    np.testing.assert_array_equal(resample_path([[1, 2, 3], [1, 2, 3]], 0.5), [[1, 2, 3], [1, 2, 3]])
