"""Camera paths to targets: free, evenly spaced, looking ahead, honest about what cannot be reached."""

import numpy as np
import pytest
from analytic_room import make_box

from flymirage_core.annotation.exploration import exploration_paths, explore, smooth_headings
from flymirage_core.annotation.targets import Targets
from flymirage_core.errors import PlanningError
from flymirage_core.occupancy.distance import inflate
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.occupancy.queries import path_is_free
from flymirage_core.rendering.camera import Intrinsics
from flymirage_core.settings import ExplorationSettings

LENS = Intrinsics.from_horizontal_fov(32, 24, np.pi / 2)
SETTINGS = ExplorationSettings()
CENTRE = np.array([1.0, 1.0, 1.5])


def hall() -> OccupancyGrid:
    """10 x 4 x 3 m, free inside of one voxel of wall; 0.1 m voxels."""
    state = np.full((100, 40, 30), OCCUPIED, np.uint8)
    state[1:-1, 1:-1, 1:-1] = FREE
    return OccupancyGrid(state, np.zeros(3), 0.1)


def walled(grid: OccupancyGrid, x: float, gap: float = 0.0) -> OccupancyGrid:
    """The hall with a wall across at ``x``, open for ``gap`` metres at its far side."""
    state = grid.state.copy()
    i, j = int(x * 10), 40 - int(gap * 10)
    state[i : i + 2, :j] = OCCUPIED
    return OccupancyGrid(state, grid.origin, grid.resolution)


def to(*boxes) -> Targets:
    return Targets(tuple(boxes))


CHAIR = make_box(7, (8.5, 2, 0.5), (0.5, 0.5, 1.0), label="chair")


def test_each_position_has_four_views_and_the_targets_name():
    cameras, groups = explore(hall(), CENTRE, to(CHAIR), SETTINGS, LENS)
    assert len(cameras) == len(groups) > 0
    assert len(cameras) % 4 == 0
    assert set(groups) == {"target 7 chair"}
    first_rig = [c.forward[:2] for c in cameras[:4]]
    assert first_rig[0] == pytest.approx(-first_rig[3], abs=1e-9)
    assert first_rig[1] == pytest.approx(-first_rig[2], abs=1e-9)


def test_the_path_begins_at_the_centre_and_ends_within_the_stand_off_of_the_box():
    (path,) = exploration_paths(hall(), CENTRE, to(CHAIR), SETTINGS)
    assert path.positions[0] == pytest.approx(CENTRE)
    assert path.reached
    assert CHAIR.distance(path.positions[-1]) <= SETTINGS.stand_off + 0.1


def test_positions_are_no_farther_apart_than_the_spacing():
    (path,) = exploration_paths(hall(), CENTRE, to(CHAIR), SETTINGS)
    assert np.linalg.norm(np.diff(path.positions, axis=0), axis=1).max() <= SETTINGS.rig_spacing + 1e-9


def test_the_path_goes_round_a_wall_and_no_camera_comes_nearer_to_it_than_the_clearance():
    grid = walled(hall(), 5.0, gap=1.2)
    (path,) = exploration_paths(grid, CENTRE, to(CHAIR), SETTINGS)
    assert path.reached
    assert (inflate(grid, SETTINGS.clearance).state_at(path.positions) == FREE).all()
    assert path_is_free(grid, path.positions)


def test_the_front_camera_looks_along_the_path():
    cameras, _ = explore(hall(), np.array([1.0, 2.0, 1.5]), to(CHAIR), SETTINGS, LENS)
    assert all(camera.forward[0] > 0.95 for camera in cameras[::4])


def test_a_target_behind_a_closed_wall_is_looked_at_from_the_nearest_place_and_its_group_says_so():
    grid = walled(hall(), 5.0)
    (path,) = exploration_paths(grid, CENTRE, to(CHAIR), SETTINGS)
    assert not path.reached
    assert path.positions[-1][0] == pytest.approx(4.7, abs=0.15)
    assert path.name == f"target 7 chair (path ends {path.gap:.1f} m before it)"


def test_no_targets_give_no_cameras():
    assert explore(hall(), CENTRE, to(), SETTINGS, LENS) == ([], [])


def test_a_target_beside_the_centre_still_gives_a_rig():
    cameras, _ = explore(hall(), CENTRE, to(make_box(1, (1.5, 1, 1.5))), SETTINGS, LENS)
    assert len(cameras) >= 4


def test_a_centre_inside_matter_is_one_clear_sentence():
    grid = hall()
    grid.state[:] = OCCUPIED
    with pytest.raises(PlanningError, match="give another centre, or lower"):
        explore(grid, CENTRE, to(CHAIR), SETTINGS, LENS)


def test_a_centre_with_little_room_is_left_with_less_clearance():
    state = np.full((60, 5, 5), OCCUPIED, np.uint8)
    state[1:-1, 1:-1, 1:-1] = FREE  # a duct 0.3 m wide
    duct = OccupancyGrid(state, np.zeros(3), 0.1)
    (path,) = exploration_paths(duct, (0.5, 0.25, 0.25), to(make_box(0, (5, 0.25, 0.25))), SETTINGS)
    assert path.reached


def test_headings_do_not_jump_where_azimuth_wraps():
    angles = np.radians(np.linspace(150, 210, 12))
    positions = np.cumsum(np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1), axis=0)
    headings = smooth_headings(positions)
    steps = np.angle(np.exp(1j * np.diff(headings)))
    assert np.abs(steps).max() < np.radians(10)


def test_headings_follow_a_corner_smoothly():
    positions = np.array([[k, 0, 0] for k in range(6)] + [[5, k, 0] for k in range(1, 6)], float)
    headings = smooth_headings(positions)
    assert headings[0] == pytest.approx(0, abs=0.02)
    assert headings[-1] == pytest.approx(np.pi / 2, abs=0.02)
    assert (np.diff(headings) >= -1e-9).all()
    assert np.diff(headings).max() < np.radians(45)
