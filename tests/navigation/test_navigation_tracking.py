import numpy as np
import pytest

from flymirage_core.navigation.flatness import FlatMotion, body_motion
from flymirage_core.navigation.tracking import track
from flymirage_core.settings import QuadrotorSettings

RATE = 30.0
QUADROTOR = QuadrotorSettings()


def hop(distance, seconds, quadrotor=QUADROTOR):
    """Times, positions, yaws and attitudes of a straight minimum-jerk flight from rest to rest with a slow turn."""
    t = np.arange(round(seconds * RATE) + 1) / RATE
    u = t / seconds
    share = np.stack(
        [
            10 * u**3 - 15 * u**4 + 6 * u**5,
            (30 * u**2 - 60 * u**3 + 30 * u**4) / seconds,
            (60 * u - 180 * u**2 + 120 * u**3) / seconds**2,
            (60 - 360 * u + 360 * u**2) / seconds**3,
        ]
    )
    along = np.array([0.8, 0.5, 0.2]) * distance
    p, v, a, j = share[:, :, None] * along
    yaw, yaw_rate = 0.5 * share[0], 0.5 * share[1]
    return t, p, yaw, body_motion(FlatMotion(v, a, j, yaw, yaw_rate), 1 / RATE, quadrotor).quaternions


def test_a_calm_flight_is_tracked_within_millimetres_and_a_degree():
    measures = track(*hop(3.0, 5.0), QUADROTOR)
    assert measures.position_rms < 0.01
    assert np.degrees(measures.attitude_rms) < 1
    assert measures.saturation == 0


def test_hover_is_held_exactly():
    measures = track(*hop(0.0, 2.0), QUADROTOR)
    assert measures.position_max < 1e-6


def test_a_flight_beyond_what_the_rotors_give_is_not_tracked():
    measures = track(*hop(8.0, 1.2), QUADROTOR)
    assert measures.saturation > 0.1
    assert measures.position_rms > 0.1


def test_slower_rotors_track_worse():
    slow = QuadrotorSettings(rotor_lag=0.06)
    assert track(*hop(4.0, 3.0), slow).position_rms > track(*hop(4.0, 3.0), QUADROTOR).position_rms


def test_attitudes_that_do_not_belong_to_the_flight_are_seen():
    t, p, yaw, q = hop(3.0, 5.0)
    measures = track(t, p, yaw, np.roll(q, 30, axis=0), QUADROTOR)
    assert np.degrees(measures.attitude_rms) > 3


def test_wrapped_and_unwrapped_yaws_are_one_flight():
    t, p, yaw, q = hop(3.0, 5.0)
    turned = np.angle(np.exp(1j * (yaw + 3.0)))
    assert np.abs(np.diff(turned)).max() > 3  # it wraps
    assert track(t, p, turned, q, QUADROTOR).position_rms == pytest.approx(
        track(t, p, yaw + 3.0, q, QUADROTOR).position_rms, abs=1e-9
    )
