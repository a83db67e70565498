"""What a trajectory asks of a quadrotor, by differential flatness: attitude, rates, rotor thrusts, IMU readings.

The model: a rigid body of mass m with thrust c m along its z axis and linear rotor drag,

    a = -g e_z + c z_B - R D R^T v,    J w' = tau - w x J w,

with D = diag(d_x, d_y, d_z) in 1/s. Position and yaw fix all else (D. Mellinger and V. Kumar, ICRA 2011); with drag, by
M. Faessler, A. Franchi and D. Scaramuzza, "Differential flatness of quadrotor dynamics subject to rotor drag", RA-L
2018, whose heading convention this is: the body's x axis, seen from above, points along yaw.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.settings import QuadrotorSettings

Float64 = NDArray[np.float64]

GRAVITY: Final = 9.81
"""m/s^2, along world -z."""


@dataclass(frozen=True, eq=False)
class FlatMotion:
    """The flat outputs and the derivatives that matter, at T even times. World frame, z up."""

    velocity: Float64  # (T, 3) m/s
    acceleration: Float64  # (T, 3) m/s^2, without gravity
    jerk: Float64  # (T, 3) m/s^3
    yaw: Float64  # (T,) radians, counter-clockwise from world +x
    yaw_rate: Float64  # (T,) rad/s


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """What the quadrotor does and feels. Body frame: x forward, y left, z up, origin at the centre of mass."""

    quaternions: Float64  # (T, 4) xyzw, body to world, without sign flips
    body_rates: Float64  # (T, 3) rad/s about the body's axes: what an ideal gyroscope reads
    angular_accelerations: Float64  # (T, 3) rad/s^2, about the body's axes
    specific_forces: Float64  # (T, 3) m/s^2: what an ideal accelerometer reads; (0, 0, +9.81) in hover
    thrusts: Float64  # (T,) newtons, all rotors together
    rotor_thrusts: Float64  # (T, 4) newtons; order as in `allocation`


def body_motion(motion: FlatMotion, dt: float, quadrotor: QuadrotorSettings) -> BodyMotion:
    """All that the motion, sampled every ``dt`` seconds, asks of the quadrotor.

    Angular acceleration is the central difference of the exact rates over the neighbouring samples: the jerk of a cubic
    spline steps at its knots, the exact rates step with it, and no rotor follows a step.

    Defined while the drone does not fall freely and does not pitch by a right angle; the planner's acceleration limit
    is far below either.
    """
    drag = np.array(quadrotor.drag)
    axes, c = _attitude(motion, drag)
    rates = _rates(motion, axes, c, drag)
    turning = np.gradient(rates, dt, axis=0) if len(rates) > 1 else np.zeros_like(rates)
    inertia = np.array(quadrotor.inertia)
    torques = inertia * turning + np.cross(rates, inertia * rates)  # (T, 3) newton metres
    thrusts = quadrotor.mass * c
    wrenches = np.column_stack([thrusts, torques])  # (T, 4)
    specific = -drag * _in_body(axes, motion.velocity)
    specific[:, 2] += c
    return BodyMotion(
        quaternions=_continuous(Rotation.from_matrix(axes).as_quat()),
        body_rates=rates,
        angular_accelerations=turning,
        specific_forces=specific,
        thrusts=thrusts,
        rotor_thrusts=wrenches @ np.linalg.inv(allocation(quadrotor)).T,
    )


def allocation(quadrotor: QuadrotorSettings) -> Float64:
    """(4, 4): from the rotors' thrusts to total thrust and the torques about the body's x, y, z.

    Rotors in an X: front left, front right, rear right, rear left. Front left and rear right turn clockwise seen from
    above, so their drag turns the body counter-clockwise.
    """
    lever = quadrotor.arm / np.sqrt(2)
    k = quadrotor.torque_per_thrust
    return np.array(
        [
            [1.0, 1.0, 1.0, 1.0],
            [lever, -lever, -lever, lever],
            [-lever, -lever, lever, lever],
            [k, -k, k, -k],
        ]
    )


def _attitude(motion: FlatMotion, drag: Float64) -> tuple[Float64, Float64]:
    """The body's axes as columns (T, 3, 3), and thrust per mass (T,) in m/s^2.

    The thrust has no part along x_B or y_B, so each is square to the acceleration that its own drag leaves to explain.
    """
    force = motion.acceleration + np.array([0.0, 0.0, GRAVITY])  # (T, 3)
    sideways = np.stack([-np.sin(motion.yaw), np.cos(motion.yaw), np.zeros_like(motion.yaw)], axis=1)  # (T, 3)
    x = _unit(np.cross(sideways, force + drag[0] * motion.velocity))
    y = _unit(np.cross(force + drag[1] * motion.velocity, x))
    z = np.cross(x, y)
    return np.stack([x, y, z], axis=2), _dot(z, force + drag[2] * motion.velocity)


def _rates(motion: FlatMotion, axes: Float64, c: Float64, drag: Float64) -> Float64:
    """Body rates (T, 3): the model's derivative along x_B and y_B, and that of x_B staying square to the yaw's left."""
    v, a, j = (_in_body(axes, w) for w in (motion.velocity, motion.acceleration, motion.jerk))
    yaw, zero = motion.yaw, np.zeros_like(motion.yaw)
    ahead = _in_body(axes, np.stack([np.cos(yaw), np.sin(yaw), zero], axis=1))
    left = _in_body(axes, np.stack([-np.sin(yaw), np.cos(yaw), zero], axis=1))
    dx, dy, dz = drag
    system = np.zeros((len(yaw), 3, 3))
    system[:, 0, 1] = c - (dz - dx) * v[:, 2]
    system[:, 0, 2] = (dy - dx) * v[:, 1]
    system[:, 1, 0] = -c + (dz - dy) * v[:, 2]
    system[:, 1, 2] = (dy - dx) * v[:, 0]
    system[:, 2, 1] = -left[:, 2]
    system[:, 2, 2] = left[:, 1]
    known = np.stack([j[:, 0] + dx * a[:, 0], j[:, 1] + dy * a[:, 1], motion.yaw_rate * ahead[:, 0]], axis=1)
    return np.asarray(np.linalg.solve(system, known[:, :, None])[:, :, 0])


def _continuous(quaternions: Float64) -> Float64:
    """q and -q are one attitude: the signs that keep the series free of jumps."""
    flips = np.concatenate([[False], np.cumsum(_dot(quaternions[1:], quaternions[:-1]) < 0) % 2 == 1])
    return np.where(flips[:, None], -quaternions, quaternions)


def _in_body(axes: Float64, vectors: Float64) -> Float64:
    """World vectors (T, 3) along the body's axes."""
    return np.asarray(np.einsum("tij,ti->tj", axes, vectors))


def _unit(vectors: Float64) -> Float64:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _dot(a: Float64, b: Float64) -> Float64:
    return np.asarray((a * b).sum(axis=1))
