import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from flymirage_core.occupancy.distance import clearance_at, clearance_field, inflate, voxels_near
from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

SEEDS = st.integers(0, 2**32 - 1)


def random_grid(seed, shape=(7, 6, 5), free=0.85, resolution=0.1):
    state = np.random.default_rng(seed).choice(
        [FREE, OCCUPIED, UNKNOWN], shape, p=[free, (1 - free) / 2, (1 - free) / 2]
    )
    return OccupancyGrid(state.astype(np.uint8), np.array([-0.3, 0.2, 1.0]), resolution)


def brute_clearance(grid):
    """Distance from each voxel's centre to all blocked voxels' boxes, those of a shell round the grid included."""
    padded = np.pad(grid.blocked, 1, constant_values=True)
    boxes = np.argwhere(padded) - 1
    gaps = np.maximum(np.abs(np.argwhere(np.ones(grid.state.shape))[:, None] - boxes) - 0.5, 0)
    distances = np.linalg.norm(gaps, axis=2).min(axis=1).reshape(grid.state.shape)
    return np.where(grid.blocked, 0, distances) * grid.resolution


@given(SEEDS)
@settings(max_examples=40)
def test_clearance_is_the_distance_to_the_nearest_blocked_box(seed):
    grid = random_grid(seed)
    np.testing.assert_allclose(clearance_field(grid), brute_clearance(grid), atol=1e-6)


@given(SEEDS, st.floats(0, 0.5))
@settings(max_examples=40)
def test_inflation_never_frees_and_keeps_its_distance(seed, radius):
    grid = random_grid(seed)
    inflated = inflate(grid, radius)
    assert not ((inflated.state == FREE) & grid.blocked).any()
    clearance = clearance_field(grid)
    assert (clearance[inflated.state == FREE] >= radius - 1e-4).all()
    assert (clearance[(grid.state == FREE) & inflated.blocked] < radius + 1e-4).all()


@pytest.mark.parametrize(
    ("radius", "layers"), [(0.0, 0), (0.05, 0), (0.06, 1), (0.1, 1), (0.3, 3), (0.35, 3), (0.36, 4)]
)
def test_inflation_off_a_wall_counts_layers_from_its_face(radius, layers):
    state = np.full((40, 41, 41), FREE, np.uint8)
    state[0] = OCCUPIED
    inflated = inflate(OccupancyGrid(state, np.zeros(3), 0.1), radius)
    assert inflated.blocked[:20, 20, 20].sum() == 1 + layers


def test_clearance_outside_of_the_grid_is_zero():
    grid = random_grid(0, free=1.0)
    field = clearance_field(grid)
    assert clearance_at(grid, field, [[0.05, 0.45, 1.25], [9, 9, 9], [-0.31, 0.45, 1.25]]).tolist() == pytest.approx(
        [0.25, 0, 0]
    )


@given(SEEDS, st.floats(0, 6))
@settings(max_examples=60)
def test_what_is_near_is_what_a_whole_distance_transform_finds_near(seed, distance):
    voxels = np.random.default_rng(seed).random((7, 6, 5)) < 0.05
    voxels[3, 3, 3] = True
    np.testing.assert_array_equal(voxels_near(voxels, distance), ndimage.distance_transform_edt(~voxels) <= distance)
