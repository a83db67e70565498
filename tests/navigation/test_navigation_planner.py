import numpy as np
import pytest
from flight_worlds import empty_room, fill, pillar_corridor
from scipy.interpolate import BSpline

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.flight_check import exact_clearance
from flymirage_core.navigation.flight_space import FlightSpace, keep_clear
from flymirage_core.navigation.planner import plan_flight, plan_flight_in
from flymirage_core.occupancy.grid import FREE
from flymirage_core.occupancy.queries import segment_is_free
from flymirage_core.occupancy.search import shortest_path
from flymirage_core.settings import PlannerSettings

SETTINGS = PlannerSettings()
START, GOAL = np.array([0.8, 0.9, 1.2]), np.array([7.3, 0.9, 1.5])


def plan(grid, start=START, goal=GOAL, settings=SETTINGS, seed=0):
    return plan_flight(grid, start, goal, settings, np.random.default_rng(seed))


def curve_of(flight):
    """The flight as scipy's spline, and 2000 times."""
    points, dt = flight.spline.control_points, flight.spline.interval
    return BSpline((np.arange(len(points) + 4) - 3) * dt, points, 3), np.linspace(0, flight.spline.duration, 2000)


@pytest.fixture(scope="module")
def flight():
    return plan(pillar_corridor())


def test_a_flight_winds_round_pillars_and_keeps_its_distance(flight):
    grid = pillar_corridor()
    curve, times = curve_of(flight)
    assert not segment_is_free(grid, START, GOAL)
    assert (keep_clear(grid, SETTINGS.inflation).state_at(curve(times)) == FREE).all()
    assert exact_clearance(grid, curve(times)).min() >= SETTINGS.inflation


def test_a_flight_goes_from_rest_to_rest_exactly(flight):
    curve, times = curve_of(flight)
    np.testing.assert_allclose(curve(times[[0, -1]]), [START, GOAL], atol=1e-9)
    for derivative in (1, 2):
        np.testing.assert_allclose(curve(times[[0, -1]], derivative), 0, atol=1e-8)


def test_norms_of_speed_acceleration_and_jerk_keep_their_limits(flight):
    curve, times = curve_of(flight)
    limits = SETTINGS.max_speed, SETTINGS.max_acceleration, SETTINGS.max_jerk
    for derivative, limit in enumerate(limits, start=1):
        assert np.linalg.norm(curve(times, derivative), axis=1).max() <= limit


def test_a_flight_makes_use_of_its_limits(flight):
    assert flight.measures.max_speed > 0.9 * SETTINGS.max_speed
    way = shortest_path(keep_clear(pillar_corridor(), SETTINGS.inflation), START, GOAL)
    assert flight.measures.length < 1.1 * np.linalg.norm(np.diff(way, axis=0), axis=1).sum()


def test_a_flight_lasts_a_whole_number_of_states(flight):
    states = flight.spline.duration * SETTINGS.state_rate
    assert states == pytest.approx(round(states), abs=1e-6)


def test_attempts_are_recorded(flight):
    assert flight.attempts.endswith(":ok")
    assert flight.inflation == SETTINGS.inflation


def test_the_same_inputs_give_the_same_bytes():
    one, other = (plan(pillar_corridor()).spline for _ in range(2))
    assert one.control_points.tobytes() == other.control_points.tobytes()
    assert one.interval == other.interval


@pytest.mark.parametrize("height", [0.5, 1.25])
def test_a_straight_free_flight_is_straight(height):
    start, goal = np.array([1.0, 1.5, 1.25]), np.array([5.0, 1.5, height])
    measures = plan(empty_room(6, 3, 2.5), start, goal).measures
    assert measures.length < 1.01 * np.linalg.norm(goal - start)


@pytest.mark.parametrize("distance", [0.06, 0.3, 1.0])
def test_short_flights_are_flown_too(distance):
    start = np.array([1.0, 1.5, 1.25])
    assert plan(empty_room(3, 3, 2.5), start, np.add(start, [distance, 0, 0])).measures.end_error < 1e-6


def test_a_flight_to_where_the_drone_is_has_a_reason_to_fail():
    with pytest.raises(PlanningError, match="already there"):
        plan(empty_room(3, 3, 2.5), (1, 1, 1), (1, 1, 1))


def test_a_goal_behind_a_wall_without_a_door_has_a_reason_to_fail():
    with pytest.raises(PlanningError, match="no free space connects"):
        plan(fill(empty_room(8, 3, 2.6), (4.0, 0.0, 0.0), (4.2, 3.0, 2.6)))


def test_a_goal_in_an_obstacle_has_a_reason_to_fail():
    with pytest.raises(PlanningError, match=r"goal \(4.10, 2.00, 1.00\) is blocked"):
        plan(pillar_corridor(), START, (4.1, 2.0, 1.0))


def test_a_gap_too_narrow_for_the_inflation_is_flown_with_less_and_says_so():
    grid = fill(empty_room(8, 3, 2.6), (4.0, 0.0, 0.0), (4.2, 3.0, 2.6))
    grid.state[40:42, 12:17] = FREE  # a slit of 0.5 m
    flight = plan(grid)
    assert flight.inflation == SETTINGS.min_inflation
    assert flight.attempts.startswith("seed:")
    assert "@0.2m:ok" in flight.attempts
    assert SETTINGS.min_inflation <= flight.measures.min_clearance < SETTINGS.inflation


@pytest.mark.parametrize("voxels", [1, 2, 3])
def test_all_connected_cases_of_the_originals_room_are_flown(original_room, voxels):
    grid, starts, goals = original_room
    settings = PlannerSettings(inflation=0.1 * voxels, min_inflation=0.1 * voxels)
    space = FlightSpace.of(grid, settings)
    flown = 0
    for n, (start, goal) in enumerate(zip(starts, goals, strict=True)):
        if (space.inflated[0].state_at([start, goal]) == FREE).all():
            flight = plan_flight_in(space, start, goal, settings, np.random.default_rng(n))
            assert flight.measures.min_clearance >= settings.inflation - 1e-6
            flown += 1
    assert flown == (20, 20, 17)[voxels - 1]
