import numpy as np
import pytest
from flight_worlds import empty_room, fill, furnished_room, pillar_corridor

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.bspline import fit_bspline
from flymirage_core.navigation.flight_check import check_flight
from flymirage_core.navigation.flight_space import FlightSpace, keep_clear
from flymirage_core.navigation.fly import fly_task_sets
from flymirage_core.navigation.local_map import LocalMap
from flymirage_core.navigation.replanner import Replanner, _State, replan_flight_in
from flymirage_core.navigation.task_sets import generate_task_sets
from flymirage_core.occupancy.grid import FREE, OCCUPIED
from flymirage_core.settings import PlannerSettings, QuadrotorSettings, TaskSettings

SETTINGS = PlannerSettings(mode="receding", sensing_range=2.5, horizon=5.0)
START, GOAL = np.array([1.0, 1.5, 1.3]), np.array([11.0, 1.5, 1.3])


def replan(grid, start=START, goal=GOAL, settings=SETTINGS):
    return replan_flight_in(FlightSpace.of(grid, settings), start, goal, settings, np.random.default_rng(0))


def hidden_wall():
    """A corridor with a wall that leaves a door at the side, 6 m from the start."""
    return fill(empty_room(12, 4, 2.6), (7.0, 0.0, 0.0), (7.2, 2.6, 2.6))


def trap():
    """A corridor with a pocket that is open towards the start: what looks like the way is none."""
    grid = fill(empty_room(12, 5, 2.6), (5.0, 0.0, 0.0), (8.0, 0.2, 2.6))
    fill(grid, (5.0, 2.8, 0.0), (8.0, 3.0, 2.6))
    return fill(grid, (7.8, 0.0, 0.0), (8.0, 3.0, 2.6))


@pytest.mark.parametrize("world", [hidden_wall, trap])
def test_an_obstacle_that_is_seen_late_is_flown_round(world):
    flight = replan(world())
    assert len(flight.spline.pieces) > 1
    assert flight.measures.min_clearance >= SETTINGS.inflation
    np.testing.assert_allclose(flight.spline.at(flight.spline.duration), GOAL, atol=1e-6)
    assert "receding" in flight.planner


def test_before_the_obstacle_is_seen_the_drone_flies_straight_at_it():
    spline = replan(hidden_wall()).spline
    t = np.linspace(0, spline.duration, 500)
    p = spline.at(t)
    unseen = p[:, 0] < 7.0 - SETTINGS.sensing_range - SETTINGS.inflation - 0.3
    assert np.abs(p[unseen, 1] - 1.5).max() < 0.1
    assert p[:, 1].max() > 2.6


def test_position_velocity_and_acceleration_are_continuous_through_every_replan():
    spline = replan(trap()).spline
    joints = np.cumsum([piece.duration for piece in spline.pieces])[:-1]
    assert len(joints) > 2
    for before, after in zip(spline.pieces[:-1], spline.pieces[1:], strict=True):
        for order in range(3):
            np.testing.assert_allclose(after.spline.at(0.0, order), before.spline.at(before.duration, order), atol=1e-9)
    np.testing.assert_allclose(spline.at(joints + 1e-9), spline.at(joints - 1e-9), atol=1e-7)


def test_a_jump_between_two_pieces_is_seen_by_the_checker():
    room, settings = empty_room(12, 3, 2.6), PlannerSettings()
    first = fit_bspline(np.linspace(START, np.add(START, [2, 0, 0]), 9), 0.8)
    second = fit_bspline(np.linspace(np.add(START, [2, 0.05, 0]), np.add(START, [4, 0, 0]), 9), 0.8)
    pieces = [(s.control_points, s.interval, s.duration) for s in (first, second)]
    with pytest.raises(PlanningError, match="jumps"):
        check_flight(pieces, (START, np.add(START, [4, 0, 0])), room, keep_clear(room, 0.3), 0.3, settings)


def test_a_closed_corridor_is_given_up_with_a_reason():
    with pytest.raises(PlanningError, match="connects"):
        replan(fill(empty_room(12, 3, 2.6), (7.0, 0.0, 0.0), (7.2, 3.0, 2.6)))


def test_the_local_map_knows_what_it_has_come_near_to_and_no_more():
    truth = keep_clear(hidden_wall(), 0.3)
    local = LocalMap(truth, 2.0)
    local.look_from(np.add(START, [2.0, 0.5, 0]))
    assert (local.known.state[60:] == FREE).all()
    assert local.look_from(np.add(START, [4.5, 0.5, 0]))
    assert (local.known.state == OCCUPIED).sum() < (truth.state == OCCUPIED).sum()
    assert ((local.known.state == FREE) | (local.known.state == truth.state)).all()
    assert not local.look_from(np.add(START, [4.5, 0.5, 0]))


@pytest.mark.parametrize("speed", [0.3, 0.9, 1.4])
def test_an_emergency_stop_brakes_to_rest_within_the_limits(speed):
    local = LocalMap(keep_clear(empty_room(12, 3, 2.6), 0.3), 5.0)
    local.look_from(START)
    state = _State(START, np.array([speed, 0.1, 0.0]), np.array([0.4, -0.3, 0.1]))
    stop = Replanner(local, GOAL, 0.3, SETTINGS).stop(state)
    for order, value in enumerate((state.position, state.velocity, state.acceleration)):
        np.testing.assert_allclose(stop.at(0.0, order), value, atol=1e-9)
    assert np.abs(stop.at(stop.duration, 1)).max() < 1e-9
    assert stop.duration < 2.5
    for value, limit in zip(
        stop.highest_norms(), (SETTINGS.max_speed, SETTINGS.max_acceleration, SETTINGS.max_jerk), strict=True
    ):
        assert value <= limit


def test_a_drone_that_cannot_stop_in_time_says_so():
    local = LocalMap(keep_clear(fill(empty_room(12, 3, 2.6), (2.0, 0, 0), (2.2, 3, 2.6)), 0.3), 5.0)
    local.look_from(START)
    state = _State(START, np.array([1.4, 0.0, 0.0]), np.zeros(3))
    with pytest.raises(PlanningError, match="too late"):
        Replanner(local, GOAL, 0.3, SETTINGS).stop(state)


def test_an_obstacle_in_sight_at_once_is_passed_like_in_one_shot():
    flight = replan(pillar_corridor(), np.array([0.8, 1.5, 1.3]), np.array([7.4, 1.5, 1.3]))
    assert flight.measures.min_clearance >= SETTINGS.inflation


def test_task_sets_are_flown_in_receding_mode_and_tracked():
    grid, boxes = furnished_room()
    tasks = generate_task_sets(
        grid, boxes, (4.0, 3.0, 1.4), TaskSettings(sets=2, targets_per_set=3), np.random.default_rng(3)
    )
    flown = fly_task_sets(tasks, grid, boxes, SETTINGS, QuadrotorSettings(), np.random.default_rng(1))
    assert flown.rejected == ()
    for flight in flown:
        assert flight.report.planner.endswith("receding")
        assert flight.report.end_error < 0.01
        assert flight.report.tracking_position_rms < 0.05
        assert np.abs(flight.velocities[[0, -1]]).max() < 1e-9


def test_before_a_wall_without_a_way_round_the_drone_stops_in_the_air():
    world = keep_clear(fill(empty_room(12, 3, 2.6), (7.0, 0.0, 0.0), (7.2, 3.0, 2.6)), 0.3)
    replanner = Replanner(LocalMap(world, 2.5), GOAL, 0.3, SETTINGS)
    with pytest.raises(PlanningError, match="connects"):
        replanner.fly(START)
    assert replanner.stops == 1
