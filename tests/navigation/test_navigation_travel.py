"""How far a drone has to fly to a target: what is searched, and what it answers."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.target_checks import can_travel
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.occupancy.search import shortest_path
from flymirage_core.occupancy.smoothing import smooth_path

RESOLUTION = 0.1


@given(st.integers(0, 10_000), st.floats(0.4, 2.0))
@settings(max_examples=200)
def test_a_way_is_short_enough_in_its_surroundings_exactly_if_it_is_in_the_whole_world(seed, max_distance):
    rng = np.random.default_rng(seed)
    state = np.where(rng.random((24, 24, 6)) < 0.3, OCCUPIED, FREE).astype(np.uint8)
    grid = OccupancyGrid(state, np.array([-1.0, 0.3, 0.0]), RESOLUTION)
    start, end = grid.centre_of(rng.permutation(np.argwhere(state == FREE))[:2])
    try:
        path = smooth_path(grid, shortest_path(grid, start, end))
        expected = np.linalg.norm(np.diff(path, axis=0), axis=1).sum() <= max_distance
    except PlanningError:
        expected = False
    assert can_travel(grid, start, end, max_distance) == expected


def test_a_window_is_the_same_world_with_less_in_it():
    state = np.zeros((5, 6, 7), np.uint8)
    state[2, 3, 4] = OCCUPIED
    grid = OccupancyGrid(state, np.array([1.0, 2.0, 3.0]), 0.5)
    window = grid.window([1.6, 3.1, 4.9], [99.0, 3.9, 5.4])
    assert window.state.shape == (4, 2, 2)
    point, beside = grid.centre_of([[2, 3, 4], [3, 3, 4]])
    assert window.state_at(point) == OCCUPIED and window.state_at(beside) == FREE
