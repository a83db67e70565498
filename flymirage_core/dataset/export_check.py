"""The export's self-test: what was written is read back, by its own conventions.json, and held against its sources."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from flymirage_core.dataset.episodes import SceneProducts
from flymirage_core.dataset.flight_columns import poses_from_actions, wrapped
from flymirage_core.dataset.lerobot_schema import RGB_KEY
from flymirage_core.dataset.reader import EpisodeRecord, LeRobotFolder
from flymirage_core.errors import ProductError
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.frames import FlightFrames

PIXEL_TOLERANCE = 1.0
"""Pixels between the target's centre seen by the exported pose and by the camera that took the picture."""
POSE_TOLERANCE = 1e-3
"""Metres and radians by which poses rebuilt from float32 actions may drift over an episode."""


def check_export(folder: Path, scenes: Iterable[SceneProducts]) -> int:
    """Check every episode; returns in how many of them the target's centre lies in the last picture.

    Raises `ProductError` if a pose rebuilt from the actions, or the target re-projected into the last frame, is not
    where it was in the products, or if an episode's first picture is another's.
    """
    export = LeRobotFolder(folder)
    products = {p.scene: p for p in scenes}
    return sum(_check_episode(export, episode, products[episode.scene]) for episode in export.episodes)


def _check_episode(export: LeRobotFolder, episode: EpisodeRecord, products: SceneProducts) -> bool:
    columns = export.columns(episode.index, ("observation.state", "action", "sim.yaw", "timestamp"))
    state, action, yaw = (columns[k].astype(np.float64) for k in ("observation.state", "action", "sim.yaw"))
    _check_actions(episode, state, action, yaw)
    frames = products.frames.flight(episode.flight_id)
    _check_first_picture(export, episode, frames)
    return _check_last_view(episode, _camera_of(state[-1], export.camera(episode.scene)), frames.cameras()[-1])


def _check_actions(episode: EpisodeRecord, state: Any, action: Any, yaw: Any) -> None:
    positions, yaws = poses_from_actions(state[0, :3], float(yaw[0]), action)
    drift = float(np.linalg.norm(positions - state[:, :3], axis=1).max())
    turn = float(np.abs(wrapped(yaws - yaw)).max())
    if not max(drift, turn) <= POSE_TOLERANCE:
        raise ProductError(
            f"export self-test: episode {episode.index} ({_name(episode)}) drifts {drift:.4f} m and "
            f"{turn:.4f} rad when its poses are rebuilt from its actions, at most {POSE_TOLERANCE} is allowed"
        )


def _check_first_picture(export: LeRobotFolder, episode: EpisodeRecord, frames: FlightFrames) -> None:
    """The joined video, asked for the episode's first time stamp, must give the flight's first frame to the bit."""
    found, expected = next(export.rgb(episode.index), None), next(frames.rgb())
    if found is None or not np.array_equal(found, expected):
        raise ProductError(
            f"export self-test: the joined video does not show the first frame of episode {episode.index} "
            f"({_name(episode)}) at {episode.row['videos/' + RGB_KEY + '/from_timestamp']:.3f} s"
        )


def _check_last_view(episode: EpisodeRecord, exported: Camera, source: Camera) -> bool:
    """Whether the target's centre is in the picture; both cameras must see it at the same pixel, and before them."""
    target = np.array(episode.row["flymirage/box_centre"])
    (pixel,), (depth,) = exported.project(target)
    (expected,), _ = source.project(target)
    error = float(np.linalg.norm(pixel - expected))
    if not (depth > 0 and error <= PIXEL_TOLERANCE):
        raise ProductError(
            f"export self-test: the target of episode {episode.index} ({_name(episode)}) projects "
            f"{error:.1f} pixels from where its last picture has it (z-depth {depth:.2f} m): poses and pictures differ"
        )
    k = exported.intrinsics
    return bool(0 <= pixel[0] < k.width and 0 <= pixel[1] < k.height)


def _name(episode: EpisodeRecord) -> str:
    return f"{episode.scene}/{episode.flight_id:04d}"


def _camera_of(state: Any, camera: dict[str, Any]) -> Camera:
    """The camera that conventions.json and a row of the state (13,) describe."""
    body = np.eye(4)
    body[:3, :3], body[:3, 3] = Rotation.from_quat(state[3:7]).as_matrix(), state[:3]
    (fx, _, cx), (_, fy, cy), _ = camera["K"]
    intrinsics = Intrinsics(camera["width"], camera["height"], fx, fy, cx, cy)
    return Camera(intrinsics, body @ np.array(camera["T_body_camera"]))
