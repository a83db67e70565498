"""Attitude and body rates that a quadrotor needs to fly a trajectory: differential flatness.

The rotors push along the body's z axis only, so acceleration and gravity fix where that axis points; yaw fixes the rest
(D. Mellinger and V. Kumar, ICRA 2011). The heading convention and the exact third rate are those of M. Faessler,
A. Franchi and D. Scaramuzza, RA-L 2018 (without drag): the body's x axis, seen from above, points along yaw.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Float64 = NDArray[np.float64]

GRAVITY: Final = 9.81
"""m/s^2, along world -z."""


def attitude_and_rates(
    acceleration: Float64, jerk: Float64, yaw: Float64, yaw_rate: Float64
) -> tuple[Float64, Float64]:
    """Quaternions (T, 4) xyzw, body (x forward, y left, z up) to world, and body rates (T, 3) about the body's axes.

    Args:
        acceleration: (T, 3) m/s^2, world (z up), without gravity.
        jerk: (T, 3) m/s^3, world.
        yaw: (T,) radians, counter-clockwise from world +x.
        yaw_rate: (T,) rad/s.

    Defined while the drone does not fall freely and does not pitch by a right angle; the planner's acceleration limit
    is far below either.
    """
    thrust = acceleration + np.array([0.0, 0.0, GRAVITY])  # (T, 3)
    c = np.linalg.norm(thrust, axis=1, keepdims=True)
    z = thrust / c
    zero = np.zeros_like(yaw)
    x_heading = np.stack([np.cos(yaw), np.sin(yaw), zero], axis=1)  # (T, 3)
    y_heading = np.stack([-np.sin(yaw), np.cos(yaw), zero], axis=1)
    x = np.cross(y_heading, z)
    tilt = np.linalg.norm(x, axis=1, keepdims=True)
    x /= tilt
    y = np.cross(z, x)
    turn = jerk / c  # of the body's z axis, apart from its part along z
    about_x = -_dot(y, turn)
    about_y = _dot(x, turn)
    about_z = (yaw_rate * _dot(x_heading, x) + about_y * _dot(y_heading, z)) / tilt[:, 0]
    quaternions = Rotation.from_matrix(np.stack([x, y, z], axis=2)).as_quat()
    flips = np.concatenate([[False], np.cumsum(_dot(quaternions[1:], quaternions[:-1]) < 0) % 2 == 1])
    quaternions[flips] *= -1  # q and -q are one attitude: keep the series free of jumps
    return quaternions, np.stack([about_x, about_y, about_z], axis=1)


def _dot(a: Float64, b: Float64) -> Float64:
    return np.asarray((a * b).sum(axis=1))
