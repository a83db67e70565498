import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from flymirage_core.navigation.flatness import GRAVITY, attitude_and_rates

accelerations = st.tuples(*[st.floats(-4, 4)] * 3)
angles = st.floats(-3.1, 3.1)


def one(acceleration, yaw):
    quaternion, _ = attitude_and_rates(np.array([acceleration]), np.zeros((1, 3)), np.array([yaw]), np.zeros(1))
    return Rotation.from_quat(quaternion[0]).as_matrix()


@given(angles)
def test_a_drone_at_rest_is_level_and_looks_along_its_yaw(yaw):
    np.testing.assert_allclose(one((0, 0, 0), yaw), Rotation.from_euler("z", yaw).as_matrix(), atol=1e-12)


@given(accelerations, angles)
def test_thrust_is_along_the_bodys_z_axis(acceleration, yaw):
    thrust = np.add(acceleration, [0, 0, GRAVITY])
    np.testing.assert_allclose(one(acceleration, yaw)[:, 2], thrust / np.linalg.norm(thrust), atol=1e-9)


@given(accelerations, angles)
def test_the_nose_points_along_yaw_seen_from_above(acceleration, yaw):
    nose = one(acceleration, yaw)[:, 0]
    np.testing.assert_allclose(nose[:2] / np.hypot(*nose[:2]), [np.cos(yaw), np.sin(yaw)], atol=1e-9)


def test_a_drone_that_accelerates_forwards_pitches_its_nose_down():
    assert one((2.0, 0, 0), 0.0)[2, 0] < 0


def test_body_rates_turn_each_attitude_into_the_next():
    t = np.linspace(0, 2, 20001)
    wave = np.stack([np.sin(2 * t), np.cos(1.5 * t), np.sin(3 * t)], axis=1)
    slope = np.stack([2 * np.cos(2 * t), -1.5 * np.sin(1.5 * t), 3 * np.cos(3 * t)], axis=1)
    yaw, yaw_rate = 0.8 * np.sin(t), 0.8 * np.cos(t)
    quaternions, rates = attitude_and_rates(2 * wave, 2 * slope, yaw, yaw_rate)
    attitude = Rotation.from_quat(quaternions)
    measured = (attitude[:-1].inv() * attitude[1:]).as_rotvec() / (t[1] - t[0])
    np.testing.assert_allclose((rates[:-1] + rates[1:]) / 2, measured, atol=1e-5)
    assert ((quaternions[1:] * quaternions[:-1]).sum(axis=1) > 0).all()
