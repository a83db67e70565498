import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.navigation.yaw import SUBSTEPS, plan_yaw
from flymirage_core.settings import PlannerSettings

SETTINGS = PlannerSettings()
RATE = SETTINGS.state_rate


def straight_flight(end=(4.0, 0.0, 1.0), seconds=4):
    share = np.linspace(0, 1, int(seconds * RATE) * SUBSTEPS + 1)[:, None]
    return np.array([0.0, 0.0, 1.0]) + share**2 * (3 - 2 * share) * (np.array(end) - [0, 0, 1])


def away(a, b):
    return abs(np.angle(np.exp(1j * (a - b))))


@settings(max_examples=30)
@given(st.floats(-3.1, 3.1), st.floats(-3.1, 3.1), st.floats(-3.1, 3.1))
def test_rate_and_acceleration_keep_their_limits_and_the_end_looks_at_the_target(first_yaw, course, bearing):
    end = np.array([4 * np.cos(course), 4 * np.sin(course), 1.0])
    target = end + 1.5 * np.array([np.cos(bearing), np.sin(bearing), 0.0])
    plan = plan_yaw(straight_flight(end), target, first_yaw, SETTINGS)
    assert np.abs(np.diff(plan.yaws)).max() * RATE <= SETTINGS.max_yaw_rate + 1e-9
    assert np.abs(plan.rates).max() <= SETTINGS.max_yaw_rate + 1e-9
    assert np.abs(np.diff(plan.rates)).max() * RATE <= SETTINGS.max_yaw_acceleration + 1e-9
    assert plan.yaws[0] == first_yaw
    assert away(plan.yaws[-1], bearing) < 0.01
    assert abs(plan.rates[-1]) < 0.02
    assert len(plan.yaws) == plan.before + len(straight_flight()) // SUBSTEPS + 1 + plan.after


def test_a_drone_that_looks_the_wrong_way_turns_before_it_departs():
    plan = plan_yaw(straight_flight(), np.array([5.0, 0.0, 1.0]), np.pi / 2, SETTINGS)
    assert plan.before > 0
    assert away(plan.yaws[plan.before], 0.0) < 0.6


def test_a_drone_that_already_looks_ahead_departs_at_once_and_stops_at_once():
    plan = plan_yaw(straight_flight(), np.array([5.0, 0.0, 1.0]), 0.0, SETTINGS)
    assert (plan.before, plan.after) == (0, 0)
    np.testing.assert_allclose(plan.yaws, 0, atol=1e-9)


def test_yaw_follows_the_flight_round_a_bend():
    angle = np.linspace(0, np.pi / 2, int(6 * RATE) * SUBSTEPS + 1)
    bend = 4 * np.stack([np.sin(angle), 1 - np.cos(angle), 0 * angle], axis=1)
    plan = plan_yaw(bend, np.array([4.0, 6.0, 0.0]), None, SETTINGS)
    half = len(plan.yaws) // 2
    assert away(plan.yaws[half], np.pi / 4) < 0.4
    assert (plan.before, plan.after) == (0, 0)


def test_a_climb_looks_at_the_target_instead_of_spinning():
    plan = plan_yaw(straight_flight((0.0, 0.0, 3.0)), np.array([0.0, 2.0, 3.0]), np.pi / 2, SETTINGS)
    np.testing.assert_allclose(plan.yaws, np.pi / 2, atol=1e-6)


@pytest.mark.parametrize("first_yaw", [3.0, -3.0])
def test_the_turn_takes_the_shorter_way_round(first_yaw):
    end = np.array([-4.0, 0.0, 1.0])
    plan = plan_yaw(straight_flight(end), end - [1, 0, 0], first_yaw, SETTINGS)
    assert np.abs(plan.yaws - first_yaw).max() < 0.3
