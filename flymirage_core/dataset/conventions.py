"""`conventions.json`: units, frames and formulas of every number in the data set, for those who train on it."""

from collections.abc import Iterable
from typing import Any

from flymirage_core.rendering.frames import CameraRig

CONVENTIONS_VERSION = 1

STATE_NAMES = ("x", "y", "z", "qx", "qy", "qz", "qw", "vx", "vy", "vz", "wx", "wy", "wz")
ACTION_NAMES = ("dx", "dy", "dz", "dyaw")


def conventions(rigs: Iterable[tuple[str, CameraRig]]) -> dict[str, Any]:
    """Everything a reader must know, with the cameras of all scenes; scenes with one rig share an entry."""
    cameras: dict[CameraRig, list[str]] = {}
    for scene, rig in rigs:
        cameras.setdefault(rig, []).append(scene)
    return {
        "version": CONVENTIONS_VERSION,
        "units": {"length": "m", "angle": "rad", "time": "s", "depth": "mm (uint16)"},
        "world": "right-handed, z up, ground near z = 0, one frame for each scene",
        "body": "FLU: x forward, y left, z up; its origin is the drone's centre",
        "camera": "OpenCV: x right, y down, z forward; pinhole without distortion, pixel centres at +0.5",
        "quaternion": "xyzw, unit, body (FLU) to world",
        "yaw": "ENU: counter-clockwise from world +x, seen from above",
        "image": "uint8 RGB (H, W, 3)",
        "depth": {
            "meaning": "z-depth, not ray length; expected depth sum(w z) / sum(w) of the splats",
            "unit": "mm",
            "dtype": "uint16",
            "no_return": 0,
            "clip": 65535,
        },
        "box": "centre and full size in metres, yaw about world z from world +x to the box's x axis",
        "cameras": [{"scenes": scenes, **_camera(rig)} for rig, scenes in cameras.items()],
        "projection": "p = K (R^T (X - t)) with T_world_camera = T_world_body T_body_camera = [R t; 0 1]",
    }


def lerobot_conventions() -> dict[str, Any]:
    """What the LeRobot export adds: columns, and the definition of an action."""
    return {
        "observation.state": {
            "names": list(STATE_NAMES),
            "meaning": "position m, world; quaternion xyzw, body to world; velocity m/s, world; body rates rad/s, FLU",
        },
        "action": {
            "names": list(ACTION_NAMES),
            "meaning": "displacement from this frame to the next, in the yaw frame of this one (FLU, gravity-aligned)",
            "formula": "[dx dy dz] = Rz(-yaw_k) (p_{k+1} - p_k);  dyaw = wrap(yaw_{k+1} - yaw_k)",
            "inverse": "p_{k+1} = p_k + Rz(yaw_k) [dx dy dz];  yaw_{k+1} = yaw_k + dyaw",
            "last_frame": "zero: the drone has arrived",
        },
        "sim.yaw": "rad, ENU: the yaw of the action's formulas",
        "sim.acceleration": "m/s^2, world, without gravity",
        "sim.imu": "ideal IMU at the drone's centre, FLU: specific force m/s^2 (+9.81 along z at rest), rates rad/s",
        "sim.velocity_body": "vx, vy, vz in m/s in the yaw frame (FLU), yaw rate in rad/s",
        "sim.pose_from_start": "x, y, z in m and yaw in rad relative to the first frame, in its yaw frame",
        "sim.clearance": "m from the drone's centre to the nearest voxel that may not be flown in",
        "sim.target_in_picture": "1 where the target's box centre projects into the picture (hidden or not), else 0",
        "task": "one of the episode's prompts, kinds taken in turn; all of them in meta/episodes, flymirage/prompts",
        "flymirage/long_prompt": "in meta/episodes: one instruction over this episode and those before and behind it "
        "that have the same; they were flown one after the other, and their frames follow one another; or empty",
        "timestamp": "frame_index / fps",
    }


def _camera(rig: CameraRig) -> dict[str, Any]:
    return {
        "width": rig.intrinsics.width,
        "height": rig.intrinsics.height,
        "K": rig.intrinsics.matrix.tolist(),
        "T_body_camera": [list(row) for row in rig.T_body_camera],
        "frame_rate": rig.frame_rate,
        "dt": 1.0 / rig.frame_rate,
    }
