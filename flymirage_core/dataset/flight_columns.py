"""What a flight's frames say in numbers: LeRobot's state and action columns, and our extras under ``sim.``.

Pictures are not made here. `poses_from_actions` is the inverse that a trainer needs, and the self-test uses.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.dataset.conventions import ACTION_NAMES, STATE_NAMES
from flymirage_core.errors import ProductError
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.frames import FlightFrames

Float64 = NDArray[np.float64]

COLUMNS: dict[str, tuple[str, ...]] = {
    "observation.state": STATE_NAMES,
    "action": ACTION_NAMES,
    "sim.yaw": ("yaw",),
    "sim.acceleration": ("ax", "ay", "az"),
    "sim.imu": ("fx", "fy", "fz", "wx", "wy", "wz"),
    "sim.velocity_body": ("vx", "vy", "vz", "yaw_rate"),
    "sim.pose_from_start": ("x", "y", "z", "yaw"),
    "sim.clearance": ("clearance",),
    "sim.target_in_picture": ("target_in_picture",),
}
"""Names of the dimensions of every float32 column. Extras must begin neither with ``action`` nor with ``observation``:
LeRobot takes every such column for an action or a state."""

TIME_TOLERANCE = 1e-3
"""Seconds by which a frame's time may differ from frame_index / rate."""


def flight_columns(flight: Flight, frames: FlightFrames, target: ObjectBox) -> dict[str, NDArray[np.float32]]:
    """The columns of `COLUMNS`, each (F, n) float32, one row a frame; see `conventions.py` for their meaning.

    Raises `ProductError` if the frames are not evenly spaced at their rate, or reach past the flight.
    """
    times = _frame_times(flight, frames)
    state = _states(flight, times)
    yaw = np.interp(times, flight.times, np.unwrap(flight.yaws))  # (F,)
    position, velocity = state[:, :3], state[:, 7:10]
    action = np.zeros((len(times), 4))  # (F, 4)
    action[:-1, :3] = into_yaw_frame(np.diff(position, axis=0), yaw[:-1])
    action[:-1, 3] = np.diff(yaw)
    yaw_rate = np.gradient(yaw, times) if len(times) > 1 else np.zeros(1)
    columns = {
        "observation.state": state,
        "action": action,
        "sim.yaw": wrapped(yaw)[:, None],
        "sim.acceleration": _interpolated(times, flight.times, flight.accelerations),
        "sim.imu": np.column_stack([_interpolated(times, flight.times, flight.specific_forces), state[:, 10:13]]),
        "sim.velocity_body": np.column_stack([into_yaw_frame(velocity, yaw), yaw_rate]),
        "sim.pose_from_start": np.column_stack(
            [into_yaw_frame(position - position[0], np.full(len(times), yaw[0])), wrapped(yaw - yaw[0])]
        ),
        "sim.clearance": np.interp(times, flight.times, flight.clearances)[:, None],
        "sim.target_in_picture": _target_in_picture(frames.cameras(), target)[:, None],
    }
    return {name: columns[name].astype(np.float32) for name in COLUMNS}


def poses_from_actions(first: Float64, first_yaw: float, actions: Float64) -> tuple[Float64, Float64]:
    """Positions (F, 3) and unwrapped yaws (F,) from the first position (3,) and yaw, and actions (F, 4)."""
    yaws = first_yaw + np.concatenate([[0.0], np.cumsum(actions[:-1, 3])])
    steps = into_yaw_frame(actions[:-1, :3], -yaws[:-1])
    return first + np.vstack([np.zeros(3), np.cumsum(steps, axis=0)]), yaws


def into_yaw_frame(vectors: Float64, yaws: Float64) -> Float64:
    """World vectors (F, 3) seen from bodies that are level and turned by ``yaws`` (F,): Rz(-yaw) v."""
    c, s = np.cos(yaws), np.sin(yaws)
    x, y, z = vectors.T
    return np.column_stack([c * x + s * y, c * y - s * x, z])


def wrapped(angles: Float64) -> Float64:
    """Angles in [-pi, pi)."""
    return np.asarray((angles + np.pi) % (2 * np.pi) - np.pi)


def _frame_times(flight: Flight, frames: FlightFrames) -> Float64:
    times = frames.table["time"].to_numpy(float)
    even = np.arange(len(times)) / frames.rig.frame_rate
    if np.abs(times - even).max() > TIME_TOLERANCE or times[-1] > flight.times[-1] + TIME_TOLERANCE:
        raise ProductError(
            f"flight {flight.flight_id}: {len(times)} frames end at {times[-1]:.3f} s, expected evenly spaced ones at "
            f"{frames.rig.frame_rate:g} Hz that end at {even[-1]:.3f} s, within the flight's {flight.times[-1]:.3f} s; "
            "materialise `frames` again"
        )
    within: Float64 = np.minimum(even, flight.times[-1])
    return within


def _states(flight: Flight, times: Float64) -> Float64:
    """Position, quaternion xyzw, velocity, body rates at ``times``: (F, 13)."""
    turns: Float64 = Slerp(flight.times, Rotation.from_quat(flight.quaternions))(times).as_quat()
    turns *= np.where(turns[:, 3:] < 0, -1.0, 1.0)  # q and -q are one rotation: w >= 0 is written
    return np.column_stack(
        [
            _interpolated(times, flight.times, flight.positions),
            turns,
            _interpolated(times, flight.times, flight.velocities),
            _interpolated(times, flight.times, flight.body_rates),
        ]
    )


def _interpolated(times: Float64, known: Float64, values: Float64) -> Float64:
    return np.column_stack([np.interp(times, known, column) for column in values.T])


def _target_in_picture(cameras: list[Camera], target: ObjectBox) -> Float64:
    """1 where the box's centre projects into the picture, else 0: (F,)."""
    shown = []
    for camera in cameras:
        pixels, depth = camera.project(target.centre)
        k = camera.intrinsics
        shown.append(depth[0] > 0 and 0 <= pixels[0, 0] < k.width and 0 <= pixels[0, 1] < k.height)
    return np.array(shown, float)
