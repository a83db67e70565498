"""The validator's checks of a LeRobot folder: counts, rows, poses, actions, feasibility, videos, depth, statistics."""

import json
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import av
import numpy as np
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.dataset.conventions import ACTION_NAMES, STATE_NAMES
from flymirage_core.dataset.depth_geometry import camera_of, depth_disagreement
from flymirage_core.dataset.export_check import DEPTH_TOLERANCE
from flymirage_core.dataset.findings import QUATERNION_TOLERANCE, READING_ERRORS, Finding
from flymirage_core.dataset.flight_columns import COLUMNS, into_yaw_frame, wrapped
from flymirage_core.dataset.lerobot_places import data_path, episodes_path, video_path
from flymirage_core.dataset.lerobot_schema import CHUNKS_SIZE, DEPTH_KEY, RGB_KEY, data_schema
from flymirage_core.dataset.reader import EpisodeRecord, LeRobotFolder
from flymirage_core.dataset.scene_folders import png16_from

ACTION_TOLERANCE = 1e-3
"""Metres and radians between an action and the step that the states make."""
SPEED_TOLERANCE = 0.35
"""m/s between the mean of two frames' velocities and the mean velocity between their positions, at 10 Hz."""
YAW_TOLERANCE = 0.1
"""Radians between sim.yaw and the heading of the body's x axis, which pitch and roll together turn a little."""
FEASIBLE_SLACK = 1.02
"""By which a value sampled at frames may exceed the report's, which was taken at every state."""
STATS_TOLERANCE = 1e-4
"""By which a mean in stats.json may differ from the data's, as a share of the standard deviation."""
INDEX = ("timestamp", "frame_index", "episode_index", "index", "task_index", "next.done")


def _counts(folder: Path) -> Iterator[Finding]:
    """info.json's version, totals, features and split ranges are those of the tables."""
    export = LeRobotFolder(folder)
    info, episodes, file = export.info, export.episodes, "meta/info.json"
    found = {
        "total_episodes": len(episodes),
        "total_frames": sum(e.length for e in episodes),
        "total_tasks": len(export.tasks),
    }
    for name, value in found.items():
        if info.get(name) != value:
            yield Finding("counts", file, name, f"is {info.get(name)!r}, the tables have {value}")
    if len(set(export.tasks)) != len(export.tasks):
        yield Finding("counts", "meta/tasks.parquet", "", "holds a task twice")
    listed: dict[int, str] = {}
    for split, text in info["splits"].items():
        for number in (n for part in text.split(",") for n in range(*(int(x) for x in part.split(":")))):
            if number in listed:
                where = f"splits, episode {number}"
                yield Finding("counts", file, where, f"is in {listed[number]!r} and in {split!r}")
            listed[number] = split
    for e in episodes:
        if listed.get(e.index) != e.split:
            where = f"splits, episode {e.index}"
            yield Finding("counts", file, where, f"is in {listed.get(e.index)!r}, its row says {e.split!r}")
    parts = json.loads((folder / "meta" / "modality.json").read_text())
    for kind, length in (("state", len(STATE_NAMES)), ("action", len(ACTION_NAMES))):
        covered = sorted(n for part in parts[kind].values() for n in range(part["start"], part["end"]))
        if covered != list(range(length)):
            yield Finding("counts", "meta/modality.json", kind, f"covers {covered}, expected 0 to {length - 1} once")


def _rows(folder: Path) -> Iterator[Finding]:
    """Schema of each data file; indices, time stamps, tasks and ends of every episode."""
    export = LeRobotFolder(folder)
    expected = data_schema(export.info["features"])
    for path in sorted((folder / "data").rglob("*.parquet")):
        schema = pq.read_schema(path)
        for name in expected.names:
            if name not in schema.names or not schema.field(name).type.equals(expected.field(name).type):
                found = schema.field(name).type if name in schema.names else "missing"
                where = f"column {name}"
                yield Finding(
                    "rows", str(path.relative_to(folder)), where, f"is {found}, expected {expected.field(name).type}"
                )
    first = 0
    for episode in export.episodes:
        yield from _episode_rows(export, episode, first)
        first += episode.length


def _episode_rows(export: LeRobotFolder, episode: EpisodeRecord, first: int) -> Iterator[Finding]:
    file = _episode_file(episode)
    if (episode.row["dataset_from_index"], episode.row["dataset_to_index"]) != (first, first + episode.length):
        found = (episode.row["dataset_from_index"], episode.row["dataset_to_index"])
        yield Finding("rows", file, _row(episode), f"says frames {found}, expected {(first, first + episode.length)}")
    columns = export.columns(episode.index, INDEX)
    frame = np.arange(episode.length)
    right = {
        "frame_index": columns["frame_index"] == frame,
        "index": columns["index"] == first + frame,
        "timestamp": np.abs(columns["timestamp"] - frame / export.info["fps"]) < 1e-4,
        "next.done": columns["next.done"] == (frame == episode.length - 1),
        "task_index": np.isin(columns["task_index"], _task_numbers(export, episode)),
    }
    for name, ok in right.items():
        for i in np.flatnonzero(~ok)[:1]:
            yield Finding("rows", _data_file(episode), _row(episode, i), f"{name} is {columns[name][i]}")


def _task_numbers(export: LeRobotFolder, episode: EpisodeRecord) -> list[int]:
    return [i for i, text in enumerate(export.tasks) if text in episode.row["tasks"]]


def _states(folder: Path) -> Iterator[Finding]:
    """Finite values, unit quaternions, actions that lead from state to state, velocities that are the positions'."""
    export = LeRobotFolder(folder)
    for episode in export.episodes:
        columns = {n: v.astype(np.float64) for n, v in export.columns(episode.index, tuple(COLUMNS)).items()}
        state, action, yaw = columns["observation.state"], columns["action"], columns["sim.yaw"]
        broken = {
            f"{name} is not finite": ~np.isfinite(v.reshape(len(v), -1)).all(axis=1) for name, v in columns.items()
        }
        norms = np.linalg.norm(state[:, 3:7], axis=1)
        broken["the quaternion's norm is not 1"] = ~(np.abs(norms - 1) <= QUATERNION_TOLERANCE)
        broken |= _motion(state, action, yaw, export.info["fps"], norms)
        for what, wrong in broken.items():
            for i in np.flatnonzero(wrong)[:1]:
                yield Finding("states", _data_file(episode), _row(episode, int(i)), what)


def _motion(state: Any, action: Any, yaw: Any, fps: float, norms: Any) -> dict[str, NDArray[np.bool_]]:
    """What is wrong at which frame: (F,) each."""
    step = np.column_stack([into_yaw_frame(np.diff(state[:, :3], axis=0), yaw[:-1]), wrapped(np.diff(yaw))])
    error = np.abs(action[:-1] - step)
    error[:, 3] = np.abs(wrapped(action[:-1, 3] - step[:, 3]))
    mean_velocity = np.diff(state[:, :3], axis=0) * fps
    stated = (state[:-1, 7:10] + state[1:, 7:10]) / 2
    safe = np.where(norms[:, None] > 0, state[:, 3:7], [0.0, 0.0, 0.0, 1.0])
    ahead = Rotation.from_quat(np.nan_to_num(safe, nan=1.0)).as_matrix()[:, :2, 0]
    heading = np.abs(wrapped(np.arctan2(ahead[:, 1], ahead[:, 0]) - yaw))
    off = np.linalg.norm(mean_velocity - stated, axis=1) > SPEED_TOLERANCE
    return {
        "the action does not lead to the next state": np.append((error > ACTION_TOLERANCE).any(axis=1), False),
        "the velocity is not that of the positions": np.append(off, False),
        "sim.yaw is not the quaternion's heading": heading > YAW_TOLERANCE,
    }


def _feasibility(folder: Path) -> Iterator[Finding]:
    """Speed, body rates, acceleration and clearance, recomputed from the rows, within what the episode reports."""
    export = LeRobotFolder(folder)
    for episode in export.episodes:
        columns = export.columns(episode.index, ("observation.state", "sim.acceleration", "sim.clearance"))
        state = columns["observation.state"].astype(np.float64)
        norms = {
            "max_speed": np.linalg.norm(state[:, 7:10], axis=1),
            "max_body_rate": np.linalg.norm(state[:, 10:13], axis=1),
            "max_acceleration": np.linalg.norm(columns["sim.acceleration"].astype(np.float64), axis=1),
        }
        for name, values in norms.items():
            limit = episode.row[f"flymirage/{name}"]
            i = int(np.argmax(values))
            if not values[i] <= limit * FEASIBLE_SLACK + 1e-3:
                message = f"{name.removeprefix('max_')} is {values[i]:.3f}, the episode reports at most {limit:.3f}"
                yield Finding("feasibility", _data_file(episode), _row(episode, i), message)
        least, i = episode.row["flymirage/min_clearance"], int(np.argmin(columns["sim.clearance"]))
        if not columns["sim.clearance"][i] >= least - 1e-3:
            message = f"clearance is {columns['sim.clearance'][i]:.3f} m, the episode reports at least {least:.3f} m"
            yield Finding("feasibility", _data_file(episode), _row(episode, i), message)
        if not least > 0:
            yield Finding("feasibility", _episode_file(episode), _row(episode), f"min_clearance is {least} m")


def _videos(folder: Path) -> Iterator[Finding]:
    """Each video holds exactly its episodes' frames, evenly spaced, and each episode's frames are those written."""
    export = LeRobotFolder(folder)
    by_file: dict[int, list[EpisodeRecord]] = {}
    for episode in export.episodes:
        by_file.setdefault(_number(episode, f"videos/{RGB_KEY}"), []).append(episode)
    for number, episodes in by_file.items():
        name = video_path(number)
        try:
            packets = _packets(folder / name, export.info["fps"])
        except READING_ERRORS as error:
            yield Finding("videos", name, "", f"cannot be read: {error}")
            continue
        total = sum(e.length for e in episodes)
        if sorted(packets) != list(range(total)):
            yield Finding("videos", name, "", f"has {len(packets)} frames, its episodes have {total}")
        for episode in episodes:
            yield from _episode_video(name, episode, packets, export.info["fps"])


def _episode_video(name: str, episode: EpisodeRecord, packets: dict[int, bytes], fps: float) -> Iterator[Finding]:
    start, end = (episode.row[f"videos/{RGB_KEY}/{k}"] * fps for k in ("from_timestamp", "to_timestamp"))
    if abs(end - start - episode.length) > 1e-6 or abs(start - round(start)) > 1e-6:
        message = f"says video frames {start:g} to {end:g}, the episode has {episode.length}"
        yield Finding("videos", _episode_file(episode), _row(episode), message)
        return
    crc = 0
    for number in range(round(start), round(end)):
        crc = zlib.crc32(packets.get(number, b""), crc)
    if crc != episode.row["flymirage/rgb_crc32"]:
        message = f"{_row(episode)}, video frames {round(start)} to {round(end) - 1}"
        yield Finding("videos", name, message, "are not the frames that were written for this episode")


def _packets(path: Path, fps: float) -> dict[int, bytes]:
    """Encoded frames by their number."""
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        rate = float(stream.time_base or 1) * fps
        return {round(p.pts * rate): bytes(p) for p in container.demux(stream) if p.pts is not None}


def _depth(folder: Path) -> Iterator[Finding]:
    """Every depth picture is whole, of the features' size, and agrees with its neighbour's over the poses."""
    export = LeRobotFolder(folder)
    if DEPTH_KEY not in export.info["features"]:
        return
    shape = tuple(export.info["features"][DEPTH_KEY]["shape"][:2])
    for episode in export.episodes:
        described = export.camera(episode.scene)
        cameras = [
            camera_of(s, described) for s in export.columns(episode.index, ("observation.state",))["observation.state"]
        ]
        before = None
        for i, cell in enumerate(export.depth_cells(episode.index)):
            try:
                depth = png16_from(cell, "the depth picture")
            except READING_ERRORS as error:
                yield Finding("depth", _data_file(episode), _row(episode, i), str(error))
                before = None
                continue
            if depth.shape != shape:
                yield Finding(
                    "depth", _data_file(episode), _row(episode, i), f"depth is {depth.shape}, expected {shape}"
                )
            elif before is not None:
                disagreement = depth_disagreement(before, cameras[i - 1], depth, cameras[i])
                if disagreement > DEPTH_TOLERANCE:
                    message = f"depth and pose disagree with frame {i - 1}'s by {disagreement:.1%} (median)"
                    yield Finding("depth", _data_file(episode), _row(episode, i), message)
            before = depth if depth.shape == shape else None


def _targets(folder: Path) -> Iterator[Finding]:
    """sim.target_in_picture says where the target's box centre, projected by the row's pose, lies."""
    export = LeRobotFolder(folder)
    for episode in export.episodes:
        columns = export.columns(episode.index, ("observation.state", "sim.target_in_picture"))
        described = export.camera(episode.scene)
        for i, state in enumerate(columns["observation.state"]):
            pixels, depth = camera_of(state, described).project(episode.row["flymirage/box_centre"])
            u, v = pixels[0]
            shown = bool(depth[0] > 0 and 0 <= u < described["width"] and 0 <= v < described["height"])
            on_edge = (
                depth[0] > 0 and min(abs(u), abs(v), abs(u - described["width"]), abs(v - described["height"])) < 1
            )
            if shown != bool(columns["sim.target_in_picture"][i]) and not on_edge:
                says = "in" if not shown else "not in"
                message = f"says that the target is {says} the picture, by pose and box it is not so"
                yield Finding("targets", _data_file(episode), _row(episode, i), message)
                break


def _statistics(folder: Path) -> Iterator[Finding]:
    """Means in stats.json are those of the columns."""
    export = LeRobotFolder(folder)
    stats = json.loads((folder / "meta" / "stats.json").read_text())
    for name in COLUMNS:
        values = np.concatenate([export.columns(e.index, (name,))[name].astype(np.float64) for e in export.episodes])
        values = values.reshape(len(values), -1)
        slack = STATS_TOLERANCE * values.std(axis=0) + 1e-6
        if not (np.abs(values.mean(axis=0) - np.ravel(stats[name]["mean"])) <= slack).all():
            found, said = values.mean(axis=0).round(4).tolist(), stats[name]["mean"]
            yield Finding("statistics", "meta/stats.json", name, f"mean is {said}, the data's is {found}")


LEROBOT_CHECKS: dict[str, Callable[[Path], Iterator[Finding]]] = {
    "counts": _counts,
    "rows": _rows,
    "states": _states,
    "feasibility": _feasibility,
    "videos": _videos,
    "depth": _depth,
    "targets": _targets,
    "statistics": _statistics,
}


def _row(episode: EpisodeRecord, frame: int | None = None) -> str:
    name = f"episode {episode.index} ({episode.scene}/{episode.flight_id:04d})"
    if frame is None:
        return name
    return f"row {episode.row['dataset_from_index'] + frame}, {name}, frame {frame}"


def _data_file(episode: EpisodeRecord) -> str:
    return data_path(_number(episode, "data"))


def _episode_file(episode: EpisodeRecord) -> str:
    return episodes_path(_number(episode, "meta/episodes"))


def _number(episode: EpisodeRecord, kind: str) -> int:
    """Of the file among all files of its kind."""
    return int(episode.row[f"{kind}/chunk_index"]) * CHUNKS_SIZE + int(episode.row[f"{kind}/file_index"])
