"""The exports' self-test: what was written is read back, by its own conventions.json, and held against its sources."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flymirage_core.dataset.depth_geometry import Depth, camera_of, depth_disagreement
from flymirage_core.dataset.flight_columns import poses_from_actions, wrapped
from flymirage_core.dataset.lerobot_schema import RGB_KEY
from flymirage_core.dataset.reader import EpisodeRecord, LeRobotFolder
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.errors import ProductError
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.frames import FlightFrames

PIXEL_TOLERANCE = 1.0
"""Pixels between the target's centre seen by the exported pose and by the camera that took the picture."""
POSE_TOLERANCE = 1e-3
"""Metres and radians by which poses rebuilt from float32 actions may drift over an episode."""
DEPTH_TOLERANCE = 0.05
"""Median share of the z-depth by which two frames' depths may disagree after re-projection; 1 % is usual."""


class ExportedEpisode(NamedTuple):
    """What an export says of an episode, in the terms that every format can be brought to."""

    name: str
    cameras: list[Camera]  # a frame
    box_centre: NDArray[np.float64]  # (3,) the target's
    depths: tuple[Depth, Depth] | None  # of the first and the middle frame, mm


def check_geometry(episode: ExportedEpisode, frames: FlightFrames) -> bool:
    """Hold an exported episode against the frames it was made from; is the target's centre in the last picture?

    The target's centre, projected by the exported cameras, must lie where the cameras that took the first and the
    last picture have it; the depth of the first frame must agree with the middle one's over the exported poses.
    Raises `ProductError` otherwise.
    """
    if len(episode.cameras) != len(frames):
        raise ProductError(
            f"export self-test: {episode.name} has {len(episode.cameras)} frames, expected {len(frames)}"
        )
    source = frames.cameras()
    for index in (0, -1):
        _check_view(episode, index, source[index])
    if episode.depths is not None:
        check_depth(episode.name, episode.cameras, episode.depths)
    (pixel,), (depth,) = episode.cameras[-1].project(episode.box_centre)
    k = episode.cameras[-1].intrinsics
    return bool(depth > 0 and 0 <= pixel[0] < k.width and 0 <= pixel[1] < k.height)


def check_depth(name: str, cameras: list[Camera], depths: tuple[Depth, Depth]) -> None:
    """Raise `ProductError` if the depths of the first and the middle camera do not agree over their poses."""
    middle = len(cameras) // 2
    error = depth_disagreement(depths[0], cameras[0], depths[1], cameras[middle])
    if error > DEPTH_TOLERANCE:  # NaN: the two share no point
        raise ProductError(
            f"export self-test: the depth of {name} disagrees by {error:.1%} between frames 0 and {middle}, at most "
            f"{DEPTH_TOLERANCE:.0%} is allowed: depth and poses differ"
        )


def check_lerobot(folder: Path, products: SceneProducts) -> int:
    """Check every episode of one scene; returns in how many of them the target's centre lies in the last picture.

    Raises `ProductError` if a pose rebuilt from the actions, the target re-projected into the first or last frame, or
    the depth seen from another frame is not where it was, or if an episode's first picture is another's.
    """
    export = LeRobotFolder(folder)
    return sum(_check_episode(export, e, products) for e in export.episodes if e.scene == products.scene)


def _check_episode(export: LeRobotFolder, episode: EpisodeRecord, products: SceneProducts) -> bool:
    columns = export.columns(episode.index, ("observation.state", "action", "sim.yaw"))
    state, action, yaw = (columns[k].astype(np.float64) for k in ("observation.state", "action", "sim.yaw"))
    _check_actions(episode, state, action, yaw)
    frames = products.frames.flight(episode.flight_id)
    _check_first_picture(export, episode, frames)
    described = export.camera(episode.scene)
    wanted = (0, len(frames) // 2)
    depths = [d for i, d in enumerate(export.depth(episode.index)) if i in wanted]
    pair = (depths[0], depths[-1]) if depths else None
    cameras = [camera_of(row, described) for row in state]
    centre = np.array(episode.row["flymirage/box_centre"])
    return check_geometry(ExportedEpisode(f"episode {episode.index} ({_name(episode)})", cameras, centre, pair), frames)


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


def _check_view(episode: ExportedEpisode, index: int, source: Camera) -> None:
    """Both cameras must see the target's centre at the same pixel; or both have it behind them."""
    (pixel,), (depth,) = episode.cameras[index].project(episode.box_centre)
    (expected,), (expected_depth,) = source.project(episode.box_centre)
    if depth <= 0 and expected_depth <= 0:
        same = bool(abs(depth - expected_depth) < 0.01)
    else:
        same = bool(np.linalg.norm(pixel - expected) <= PIXEL_TOLERANCE)  # NaN, one behind: not the same
    if not same or (index == -1 and depth <= 0):
        which = "first" if index == 0 else "last"
        raise ProductError(
            f"export self-test: the target of {episode.name} projects {np.linalg.norm(pixel - expected):.1f} pixels "
            f"from where its {which} picture has it (z-depth {depth:.2f} m): poses and pictures differ"
        )


def _name(episode: EpisodeRecord) -> str:
    return f"{episode.scene}/{episode.flight_id:04d}"
