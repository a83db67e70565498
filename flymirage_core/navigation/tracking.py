"""The closed-loop check: a simulated quadrotor flies the recorded states, and how far it strays is measured.

A rigid body with drag, rotors that lag and have limits, and the geometric controller of T. Lee, M. Leok and
N. H. McClamroch, "Geometric tracking control of a quadrotor UAV on SE(3)", CDC 2010, at 500 Hz. As published, the
controller knows neither of drag nor of lag, so it has something to correct. Nothing here knows of planning: the
reference is what a user of the data set has, the recorded positions and yaws.
"""

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from flymirage_core.navigation.flatness import GRAVITY, FlatMotion, allocation, body_motion
from flymirage_core.settings import QuadrotorSettings

Float64 = NDArray[np.float64]

RATE: Final = 500.0
"""Hz, of control and of integration (Runge-Kutta of fourth order)."""
POSITION_BANDWIDTH: Final = 6.0
"""rad/s: natural frequency of the position loop ..."""
ATTITUDE_BANDWIDTH: Final = 25.0
"""... and of the attitude loop; both critically damped."""
TURN: Final = 6
RATES: Final = 15
ROTORS: Final = 18
STATE: Final = 22
"""The simulated state: position 3, velocity 3, attitude 9 (by rows, from `TURN` on), body rates 3, rotor thrusts 4."""
AT_REST: Final[Any] = ([(1, np.zeros(3)), (2, np.zeros(3))],) * 2
"""Boundary conditions of the reference."""
YAW_AT_REST: Final[Any] = ([(1, 0.0)],) * 2


@dataclass(frozen=True)
class TrackingMeasures:
    """How well the simulated quadrotor kept to the recorded states."""

    position_rms: float  # metres
    attitude_rms: float  # radians, angle between recorded and simulated attitude
    position_max: float  # metres
    attitude_max: float  # radians
    saturation: float  # share of the time that a rotor was asked for more, or less, than it can give


class Body(NamedTuple):
    """`QuadrotorSettings` for the kernel."""

    mass: float
    inertia: Float64  # (3,)
    drag: Float64  # (3,) 1/s
    allocation: Float64  # (4, 4)
    unallocation: Float64  # (4, 4) its inverse
    least_thrust: float  # newtons a rotor
    most_thrust: float
    lag: float  # seconds


class Reference(NamedTuple):
    """Where the controller should be at each of its S steps."""

    positions: Float64  # (S, 3)
    velocities: Float64  # (S, 3)
    forces: Float64  # (S, 3) acceleration and gravity, world, m/s^2
    yaws: Float64  # (S,)
    rates: Float64  # (S, 3)
    turning: Float64  # (S, 3) rad/s^2


def track(
    times: Float64, positions: Float64, yaws: Float64, quaternions: Float64, quadrotor: QuadrotorSettings
) -> TrackingMeasures:
    """Flies recorded states and compares at the recorded times.

    Args:
        times: (T,) seconds, even, from 0; T >= 2.
        positions: (T, 3) from rest to rest.
        yaws: (T,) radians, wrapped or not.
        quaternions: (T, 4) xyzw, body to world, to be compared with.
    """
    steps = round(float(times[-1]) * RATE)
    clock = np.linspace(0.0, float(times[-1]), steps + 1)
    place = make_interp_spline(times, positions, k=5, bc_type=AT_REST)
    turn = make_interp_spline(times, np.unwrap(yaws), k=3, bc_type=YAW_AT_REST)
    motion = FlatMotion(place(clock, 1), place(clock, 2), place(clock, 3), turn(clock), turn(clock, 1))
    wanted = body_motion(motion, float(clock[1]), quadrotor.model_copy(update={"drag": (0.0, 0.0, 0.0)}))
    reference = Reference(
        np.ascontiguousarray(place(clock)),
        np.ascontiguousarray(motion.velocity),
        motion.acceleration + np.array([0.0, 0.0, GRAVITY]),
        np.ascontiguousarray(motion.yaw),
        wanted.body_rates,
        wanted.angular_accelerations,
    )
    first = Rotation.from_quat(quaternions[0]).as_matrix()
    flown, attitudes, saturated = _simulate(_body(quadrotor), reference, first, float(clock[1]))
    at = np.rint(times * RATE).astype(int)
    away = np.linalg.norm(flown[at] - positions, axis=1)
    tilted = np.asarray((Rotation.from_matrix(attitudes[at]).inv() * Rotation.from_quat(quaternions)).magnitude())
    return TrackingMeasures(_rms(away), _rms(tilted), float(away.max()), float(tilted.max()), saturated / max(steps, 1))


def _rms(values: Float64) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _body(q: QuadrotorSettings) -> Body:
    mixing = allocation(q)
    unmixing = np.asarray(np.linalg.inv(mixing), np.float64)
    return Body(q.mass, np.array(q.inertia), np.array(q.drag), mixing, unmixing, *q.rotor_limits, q.rotor_lag)


@numba.njit(cache=True, nogil=True)
def _simulate(body: Body, reference: Reference, first: Float64, dt: float) -> tuple[Float64, Float64, int]:
    """Positions (S, 3), attitudes (S, 3, 3), and at how many steps a rotor was asked for what it cannot give."""
    count = len(reference.positions)
    positions = np.empty((count, 3))
    attitudes = np.empty((count, 3, 3))
    state = np.zeros(STATE)
    for k in range(3):
        state[k] = reference.positions[0, k]
        state[3 + k] = reference.velocities[0, k]
        state[RATES + k] = reference.rates[0, k]
        for n in range(3):
            state[TURN + 3 * k + n] = first[k, n]
    for n in range(4):
        state[ROTORS + n] = body.mass * GRAVITY / 4
    trial, thrusts = np.empty(STATE), np.empty(4)
    slopes = np.empty((4, STATE))
    saturated = 0
    for s in range(count):
        for k in range(3):
            positions[s, k] = state[k]
            for n in range(3):
                attitudes[s, k, n] = state[TURN + 3 * k + n]
        saturated += _control(body, reference, s, state, thrusts)
        _derivative(body, state, thrusts, slopes[0])
        for stage in range(1, 4):
            share = dt if stage == 3 else dt / 2
            for i in range(STATE):
                trial[i] = state[i] + share * slopes[stage - 1, i]
            _derivative(body, trial, thrusts, slopes[stage])
        for i in range(STATE):
            state[i] += dt / 6 * (slopes[0, i] + 2 * slopes[1, i] + 2 * slopes[2, i] + slopes[3, i])
        _orthonormalise(state)
    return positions, attitudes, saturated


@numba.njit(cache=True, nogil=True)
def _control(body: Body, reference: Reference, s: int, state: Float64, thrusts: Float64) -> int:
    """Lee's controller: writes the rotor thrusts (4,), cut to their limits; 1 if one had to be cut."""
    turn = state[TURN:RATES].reshape(3, 3)
    rates = state[RATES:ROTORS]
    wanted = np.empty((3, 3))  # rows: the wanted body axes
    size = 0.0
    for k in range(3):
        wanted[2, k] = (
            reference.forces[s, k]
            - POSITION_BANDWIDTH**2 * (state[k] - reference.positions[s, k])
            - 2 * POSITION_BANDWIDTH * (state[3 + k] - reference.velocities[s, k])
        )
        size += wanted[2, k] ** 2
    wrench = np.zeros(4)
    for k in range(3):
        wrench[0] += body.mass * wanted[2, k] * turn[k, 2]
        wanted[2, k] /= np.sqrt(size)
    ahead = np.cos(reference.yaws[s]), np.sin(reference.yaws[s])
    wanted[0, 0], wanted[0, 1] = ahead[0] * wanted[2, 2], ahead[1] * wanted[2, 2]  # left of the yaw x z
    wanted[0, 2] = -ahead[1] * wanted[2, 1] - ahead[0] * wanted[2, 0]
    _normalise(wanted[0])
    _cross(wanted[2], wanted[0], wanted[1])
    off = np.zeros((3, 3))  # R_wanted^T R
    for i in range(3):
        for j in range(3):
            for k in range(3):
                off[i, j] += wanted[i, k] * turn[k, j]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        error = (off[j, i] - off[i, j]) / 2
        rate, turning = 0.0, 0.0
        for n in range(3):
            rate += off[n, k] * reference.rates[s, n]
            turning += off[n, k] * reference.turning[s, n]
        turning -= ATTITUDE_BANDWIDTH**2 * error + 2 * ATTITUDE_BANDWIDTH * (rates[k] - rate)
        gyroscopic = (body.inertia[j] - body.inertia[i]) * rates[i] * rates[j]
        wrench[1 + k] = body.inertia[k] * turning + gyroscopic
    cut = 0
    for n in range(4):
        asked = 0.0
        for k in range(4):
            asked += body.unallocation[n, k] * wrench[k]
        thrusts[n] = min(max(asked, body.least_thrust), body.most_thrust)
        if thrusts[n] != asked:
            cut = 1
    return cut


@numba.njit(cache=True, nogil=True)
def _derivative(body: Body, state: Float64, asked: Float64, out: Float64) -> None:
    """Of the state, for rotor thrusts (4,) that are asked for and come with a lag of first order."""
    turn = state[TURN:RATES].reshape(3, 3)
    rates, rotors = state[RATES:ROTORS], state[ROTORS:]
    wrench = np.zeros(4)
    for n in range(4):
        out[ROTORS + n] = (asked[n] - rotors[n]) / body.lag
        for k in range(4):
            wrench[k] += body.allocation[k, n] * rotors[n]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        out[k] = state[3 + k]
        out[3 + k] = turn[k, 2] * wrench[0] / body.mass
        out[RATES + k] = (wrench[1 + k] - (body.inertia[j] - body.inertia[i]) * rates[i] * rates[j]) / body.inertia[k]
        for n in range(3):  # R' = R [w]x, row by row
            out[TURN + 3 * n + k] = turn[n, i] * rates[j] - turn[n, j] * rates[i]
    for n in range(3):
        speed = 0.0
        for k in range(3):
            speed += turn[k, n] * state[3 + k]
        for k in range(3):
            out[3 + k] -= turn[k, n] * body.drag[n] * speed
    out[5] -= GRAVITY


@numba.njit(cache=True, nogil=True)
def _orthonormalise(state: Float64) -> None:
    """Gram-Schmidt on the rows of the state's attitude, in place."""
    turn = state[TURN:RATES].reshape(3, 3)
    _normalise(turn[0])
    along = 0.0
    for k in range(3):
        along += turn[0, k] * turn[1, k]
    for k in range(3):
        turn[1, k] -= along * turn[0, k]
    _normalise(turn[1])
    _cross(turn[0], turn[1], turn[2])


@numba.njit(cache=True, nogil=True)
def _normalise(vector: Float64) -> None:
    size = np.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    for k in range(3):
        vector[k] /= size


@numba.njit(cache=True, nogil=True)
def _cross(a: Float64, b: Float64, out: Float64) -> None:
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        out[k] = a[i] * b[j] - a[j] * b[i]
