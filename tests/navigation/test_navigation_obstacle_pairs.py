import numpy as np
from flight_worlds import empty_room, fill
from scipy import ndimage

from flymirage_core.navigation.lbfgs import REBOUND, Problem, minimise
from flymirage_core.navigation.obstacle_pairs import (
    ObstaclePairs,
    collision_segments,
    find_pairs,
    segment_pairs,
    voxels_of,
)
from flymirage_core.occupancy.grid import FREE, OccupancyGrid

WEIGHTS = np.array([1.0, 0.5, 0.1, 0.0])


def line(start, end, count=15):
    return np.linspace(start, end, count)


def blocked_room() -> OccupancyGrid:
    return fill(empty_room(4, 3, 2), (1.8, 1.0, 0.0), (2.2, 2.0, 2.0))


def test_pairs_of_given_paths_agree_with_the_original(original, original_room):
    room = original_room[0]
    grown = ndimage.binary_dilation(room.blocked, np.ones((3, 3, 3)))  # the original's inflation by one voxel
    space = OccupancyGrid(grown.astype(np.uint8), room.origin, room.resolution)
    compared = 0
    for case in original["pairs"]:
        index = np.array(case["pair_index"])
        if len(case["astar_paths"]) > 1 or (np.diff(index) != 1).any():  # where one segment ends is not recorded
            continue
        path = np.array(case["astar_paths"][0]["path"])
        pairs = segment_pairs(np.array(case["ctrl"]), index[0], index[-1], path, space)
        np.testing.assert_array_equal(pairs.index, index)
        np.testing.assert_allclose(pairs.p, case["pair_p"], atol=1e-9)
        np.testing.assert_allclose(pairs.v, case["pair_v"], atol=1e-9)
        compared += 1
    assert compared == 10


def test_free_control_points_have_no_pairs():
    assert len(find_pairs(line((0.3, 0.3, 1.0), (3.7, 0.3, 1.0)), blocked_room())) == 0


def test_pairs_push_control_points_out_of_the_obstacle():
    room = blocked_room()
    points = line((0.5, 1.3, 1.05), (3.5, 1.3, 1.05), 25)
    inside = np.flatnonzero(room.state_at(points) != FREE)
    pairs = find_pairs(points, room)
    assert set(inside) <= set(pairs.index)
    np.testing.assert_allclose(np.linalg.norm(pairs.v, axis=1), 1)
    for i, p, v in zip(pairs.index, pairs.p, pairs.v, strict=True):
        if i in inside:
            assert room.state_at(p) == FREE
            assert (points[i] - p) @ v < 0  # on the wrong side of its half-space


def test_a_segment_begins_and_ends_at_free_control_points():
    points = line((0.5, 1.3, 1.05), (3.5, 1.3, 1.05), 25)
    ((first, last),) = collision_segments(points, blocked_room())
    assert blocked_room().state_at(points[[first, last]]).tolist() == [FREE, FREE]
    assert (blocked_room().state_at(points[first + 1 : last]) != FREE).any()


def test_an_obstacle_thinner_than_the_legs_between_control_points_is_found():
    room = fill(empty_room(4, 3, 2), (2.0, 1.0, 0.0), (2.1, 2.0, 2.0))
    points = line((0.5, 1.3, 1.05), (3.5, 1.3, 1.05), 10)
    assert (room.state_at(points) == FREE).all()
    assert len(find_pairs(points, room)) > 0


def test_the_optimiser_stops_at_an_obstacle_that_no_pair_knows():
    room = blocked_room()
    points = line((0.5, 1.5, 1.0), (3.5, 1.5, 1.0), 25)
    points[3:-3] += np.random.default_rng(0).normal(0, 0.05, (19, 3))  # so that there is something to optimise
    none = ObstaclePairs.none()
    problem = Problem(0.2, np.array([9.0, 9.0, 99.0]), none.index, none.p, none.v, 0.5, np.zeros((0, 3)), WEIGHTS)
    assert minimise(points, problem, voxels_of(room), 1e-3) == REBOUND
