import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from flymirage_core.navigation.flatness import GRAVITY, FlatMotion, allocation, body_motion
from flymirage_core.settings import QuadrotorSettings

QUADROTOR = QuadrotorSettings()
WITHOUT_DRAG = QuadrotorSettings(drag=(0, 0, 0))

vectors = st.tuples(*[st.floats(-4, 4)] * 3)
angles = st.floats(-3.1, 3.1)


def one(acceleration, yaw, velocity=(0, 0, 0), quadrotor=WITHOUT_DRAG):
    a, v = np.array([acceleration], float), np.array([velocity], float)
    return body_motion(FlatMotion(v, a, np.zeros((1, 3)), np.array([yaw]), np.zeros(1)), 0.01, quadrotor)


def attitude(motion):
    return Rotation.from_quat(motion.quaternions[0]).as_matrix()


def weaving(count, quadrotor):
    """Times, the flat motion and the body's motion of a wild flight of two seconds."""
    t = np.linspace(0, 2, count)
    velocity = np.stack([-np.cos(2 * t), np.sin(1.5 * t) / 0.75, -2 * np.cos(3 * t) / 3], axis=1)
    acceleration = 2 * np.stack([np.sin(2 * t), np.cos(1.5 * t), np.sin(3 * t)], axis=1)
    jerk = 2 * np.stack([2 * np.cos(2 * t), -1.5 * np.sin(1.5 * t), 3 * np.cos(3 * t)], axis=1)
    motion = FlatMotion(velocity, acceleration, jerk, 0.8 * np.sin(t), 0.8 * np.cos(t))
    return t, motion, body_motion(motion, t[1], quadrotor)


@given(angles)
def test_a_drone_at_rest_is_level_and_looks_along_its_yaw(yaw):
    np.testing.assert_allclose(attitude(one((0, 0, 0), yaw)), Rotation.from_euler("z", yaw).as_matrix(), atol=1e-12)


@given(vectors, angles)
def test_without_drag_thrust_is_along_the_bodys_z_axis(acceleration, yaw):
    thrust = np.add(acceleration, [0, 0, GRAVITY])
    np.testing.assert_allclose(attitude(one(acceleration, yaw))[:, 2], thrust / np.linalg.norm(thrust), atol=1e-9)


@given(vectors, vectors, angles)
def test_thrust_gravity_and_drag_together_give_the_acceleration(acceleration, velocity, yaw):
    motion = one(acceleration, yaw, velocity, QUADROTOR)
    R, D = attitude(motion), np.diag(QUADROTOR.drag)
    force = motion.thrusts[0] / QUADROTOR.mass * R[:, 2] - R @ D @ R.T @ np.array(velocity) - [0, 0, GRAVITY]
    np.testing.assert_allclose(force, acceleration, atol=1e-9)


@given(vectors, vectors, angles)
def test_the_nose_points_along_yaw_seen_from_above(acceleration, velocity, yaw):
    nose = attitude(one(acceleration, yaw, velocity, QUADROTOR))[:, 0]
    np.testing.assert_allclose(nose[:2] / np.hypot(*nose[:2]), [np.cos(yaw), np.sin(yaw)], atol=1e-9)


def test_a_drone_that_accelerates_forwards_pitches_its_nose_down():
    assert attitude(one((2.0, 0, 0), 0.0))[2, 0] < 0


def test_a_drone_that_cruises_forwards_leans_against_its_drag():
    assert attitude(one((0, 0, 0), 0.0, (1.5, 0, 0), QUADROTOR))[2, 0] < 0


def test_body_rates_turn_each_attitude_into_the_next():
    t, _, body = weaving(20001, QUADROTOR)
    turn = Rotation.from_quat(body.quaternions)
    measured = (turn[:-1].inv() * turn[1:]).as_rotvec() / (t[1] - t[0])
    np.testing.assert_allclose((body.body_rates[:-1] + body.body_rates[1:]) / 2, measured, atol=1e-5)
    assert ((body.quaternions[1:] * body.quaternions[:-1]).sum(axis=1) > 0).all()


def test_angular_acceleration_is_the_slope_of_the_body_rates():
    t, _, body = weaving(2001, QUADROTOR)
    grown = np.cumsum(body.angular_accelerations[:-1] + np.diff(body.angular_accelerations, axis=0) / 2, axis=0) * t[1]
    np.testing.assert_allclose(body.body_rates[0] + grown, body.body_rates[1:], atol=1e-3)


def test_an_accelerometer_at_rest_reads_gravity_upwards():
    np.testing.assert_allclose(one((0, 0, 0), 1.0, quadrotor=QUADROTOR).specific_forces, [[0, 0, GRAVITY]], atol=1e-12)


def test_integrating_the_imu_gives_the_flight_back():
    t, motion, body = weaving(20001, QUADROTOR)
    turn = Rotation.from_quat(body.quaternions)
    a = turn.apply(body.specific_forces) - [0, 0, GRAVITY]
    v = motion.velocity[0] + np.cumsum((a[1:] + a[:-1]) / 2, axis=0) * t[1]
    np.testing.assert_allclose(v, motion.velocity[1:], atol=1e-6)


def test_rotors_share_the_weight_in_hover():
    hover = one((0, 0, 0), 0.3, quadrotor=QUADROTOR).rotor_thrusts
    np.testing.assert_allclose(hover, QUADROTOR.mass * GRAVITY / 4, rtol=1e-12)


def test_more_thrust_at_the_left_rolls_the_drone_to_the_right_and_at_the_rear_pitches_it_down():
    left, rear = np.array([1.0, 0, 0, 1]), np.array([0.0, 0, 1, 1])
    assert (allocation(QUADROTOR) @ left)[1] > 0
    assert (allocation(QUADROTOR) @ rear)[2] > 0


def test_rotor_thrusts_give_the_torques_of_eulers_equation():
    _, _, body = weaving(2001, QUADROTOR)
    wrench = body.rotor_thrusts @ allocation(QUADROTOR).T
    inertia = np.array(QUADROTOR.inertia)
    momentum = inertia * body.body_rates
    torque = inertia * body.angular_accelerations + np.cross(body.body_rates, momentum)
    np.testing.assert_allclose(wrench, np.column_stack([body.thrusts, torque]), atol=1e-12)
