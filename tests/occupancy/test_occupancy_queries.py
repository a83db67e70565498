import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from flymirage_core.occupancy.queries import (
    cylinder_is_clear,
    first_hit,
    path_is_free,
    segment_is_free,
    sphere_is_clear,
)

SEEDS = st.integers(0, 2**32 - 1)


def random_grid(seed, free=0.97):
    rng = np.random.default_rng(seed)
    state = rng.choice([FREE, OCCUPIED, UNKNOWN], (9, 8, 7), p=[free, (1 - free) * 0.7, (1 - free) * 0.3])
    return OccupancyGrid(state.astype(np.uint8), np.array([-0.4, 0.1, -0.2]), 0.1), rng


def inside(grid, rng, n=2):
    return grid.origin + rng.uniform(0, 1, (n, 3)) * np.array(grid.state.shape) * grid.resolution


def sampled(start, end, n=4000):
    return start + np.linspace(0, 1, n)[:, None] * (end - start)


@given(SEEDS)
@settings(max_examples=150)
def test_a_free_segment_has_only_free_points_and_a_blocked_one_a_blocked_point(seed):
    grid, rng = random_grid(seed)
    start, end = inside(grid, rng)
    points = sampled(start, end)
    all_free = (grid.state_at(points) == FREE).all()
    if segment_is_free(grid, start, end):
        assert all_free
    elif all_free:  # the walk sees corners that the samples miss: then some voxel is clipped by less than their spacing
        near = [grid.state_at(points + d * grid.resolution * 1e-3) for d in np.vstack([np.eye(3), -np.eye(3)])]
        assert (np.array(near) != FREE).any()


def test_segments_outside_of_the_grid_and_of_no_length():
    grid = OccupancyGrid(np.zeros((4, 4, 4), np.uint8), np.zeros(3), 0.1)
    assert segment_is_free(grid, [0.05, 0.05, 0.05], [0.35, 0.35, 0.05])
    assert not segment_is_free(grid, [0.05, 0.05, 0.05], [0.45, 0.05, 0.05])
    assert not segment_is_free(grid, [-0.3, 0.05, 0.05], [0.3, 0.05, 0.05])
    assert segment_is_free(grid, [0.05] * 3, [0.05] * 3)
    assert not segment_is_free(grid, [0.5] * 3, [0.5] * 3)
    assert not path_is_free(grid, [[0.05] * 3, [0.35, 0.05, 0.05], [0.35, 0.35, 0.45], [0.05] * 3])


@given(SEEDS, st.floats(0, 0.3))
@settings(max_examples=100)
def test_cylinder_is_clear_exactly_if_no_occupied_ball_reaches_into_it(seed, radius):
    grid, rng = random_grid(seed, free=0.99)
    start, end = inside(grid, rng)
    clear, length = True, np.linalg.norm(end - start)
    for index in np.argwhere(grid.state == OCCUPIED):
        p = grid.centre_of(index) - start
        along = p @ (end - start) / length
        away = np.linalg.norm(np.cross(p, end - start)) / length
        clear &= not (0 <= along <= length and away <= radius + grid.resolution / 2)
    assert cylinder_is_clear(grid, start, end, radius) == clear


@given(SEEDS, st.floats(0, 0.4))
@settings(max_examples=100)
def test_sphere_is_clear_exactly_if_no_occupied_box_reaches_into_it(seed, radius):
    grid, rng = random_grid(seed, free=0.99)
    (point,) = inside(grid, rng, 1)
    boxes = grid.centre_of(np.argwhere(grid.state == OCCUPIED)).reshape(-1, 3)
    nearest = np.clip(point, boxes - 0.05, boxes + 0.05)
    assert sphere_is_clear(grid, point, radius) == (np.linalg.norm(nearest - point, axis=1) > radius).all()


@given(SEEDS)
@settings(max_examples=100)
def test_first_hit_is_the_nearest_occupied_box_along_the_ray(seed):
    grid, rng = random_grid(seed)
    origin = inside(grid, rng, 1)[0] + rng.choice([0, 2.0])  # also from outside, into the grid
    directions = np.vstack([rng.normal(size=(5, 3)), grid.centre_of([4, 4, 4]) - origin])
    hits = first_hit(grid, origin, directions, 5.0)
    lower = grid.origin + np.argwhere(grid.state == OCCUPIED).reshape(-1, 3) * grid.resolution
    for direction, hit in zip(directions / np.linalg.norm(directions, axis=1, keepdims=True), hits, strict=True):
        slabs = np.sort([(lower - origin) / direction, (lower + grid.resolution - origin) / direction], axis=0)
        near, far = slabs[0].max(axis=1), slabs[1].min(axis=1)
        entries = np.maximum(near[(near < far) & (far > 0)], 0)
        assert np.isclose(hit, entries.min(initial=np.inf), atol=1e-9)


def test_first_hit_has_a_range_and_takes_rays_along_the_axes():
    state = np.zeros((20, 3, 3), np.uint8)
    state[12] = OCCUPIED
    grid = OccupancyGrid(state, np.zeros(3), 0.1)
    np.testing.assert_allclose(first_hit(grid, [0.05, 0.15, 0.15], [[2, 0, 0], [-1, 0, 0]], 5), [1.15, np.inf])
    assert first_hit(grid, [0.05, 0.15, 0.15], [1, 0, 0], 1.1) == np.inf
