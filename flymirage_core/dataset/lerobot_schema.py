"""LeRobot v3.0 on disk, as tables and JSON: features, info.json, tasks, episode rows. No pictures, no flights."""

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa

from flymirage_core.dataset.column_stats import STAT_NAMES
from flymirage_core.dataset.conventions import ACTION_NAMES, STATE_NAMES
from flymirage_core.dataset.flight_columns import COLUMNS
from flymirage_core.rendering.frames import CameraRig

CODEBASE_VERSION = "v3.0"
ROBOT_TYPE = "quadrotor"
RGB_KEY = "observation.images.front"
DEPTH_KEY = "observation.images.front_depth"
DATA_PATH = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
VIDEO_PATH = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4"
EPISODES_PATH = "meta/episodes/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
CHUNKS_SIZE = 1000
DATA_FILES_MB = 100
VIDEO_FILES_MB = 200

VIDEO_COLUMNS = ("chunk_index", "file_index", "from_timestamp", "to_timestamp")
REPORTED = ("length", "max_speed", "max_acceleration", "max_body_rate", "max_yaw_rate", "min_clearance")
"""What an episode's row says of its feasibility; all else of the report is in scenes/<scene>/episodes.parquet."""

INDEX_COLUMNS = {
    "timestamp": "float32",
    "frame_index": "int64",
    "episode_index": "int64",
    "index": "int64",
    "task_index": "int64",
}
PNG = pa.struct([("bytes", pa.binary()), ("path", pa.string())])
"""How the `datasets` library stores a picture in a table."""


def features(rig: CameraRig, with_depth: bool) -> dict[str, Any]:
    """The ``features`` of info.json."""
    height, width = rig.intrinsics.height, rig.intrinsics.width
    axes = ["height", "width", "channels"]
    video = {
        "video.height": height,
        "video.width": width,
        "video.codec": "h264",
        "video.pix_fmt": "yuv420p",
        "video.is_depth_map": False,
        "video.fps": round(rig.frame_rate),
        "video.channels": 3,
        "has_audio": False,
    }
    described: dict[str, Any] = {RGB_KEY: {"dtype": "video", "shape": [height, width, 3], "names": axes, "info": video}}
    if with_depth:
        info = {"is_depth_map": True, "depth_unit": "mm", "no_return": 0}
        described[DEPTH_KEY] = {"dtype": "image", "shape": [height, width, 1], "names": axes, "info": info}
    for name, dimensions in COLUMNS.items():
        described[name] = {"dtype": "float32", "shape": [len(dimensions)], "names": list(dimensions)}
    described["next.done"] = {"dtype": "bool", "shape": [1], "names": None}
    for name, dtype in INDEX_COLUMNS.items():
        described[name] = {"dtype": dtype, "shape": [1], "names": None}
    return described


def data_schema(described: dict[str, Any]) -> pa.Schema:
    """Of the data files: one row a frame, vectors as fixed-size lists, described for the `datasets` library too."""
    columns: list[tuple[str, pa.DataType]] = []
    hub: dict[str, Any] = {}
    for name, feature in described.items():
        if feature["dtype"] == "video":
            continue
        if feature["dtype"] == "image":
            columns.append((name, PNG))
            hub[name] = {"_type": "Image"}
            continue
        scalar = pa.bool_() if feature["dtype"] == "bool" else pa.type_for_alias(feature["dtype"])
        value, length = {"dtype": feature["dtype"], "_type": "Value"}, feature["shape"][0]
        columns.append((name, scalar if length == 1 else pa.list_(scalar, length)))
        hub[name] = value if length == 1 else {"feature": value, "length": length, "_type": "Sequence"}
    return pa.schema(columns, metadata={"huggingface": json.dumps({"info": {"features": hub}})})


def info(described: dict[str, Any], fps: int, episodes: int, frames: int, tasks: int, splits: dict[str, str]) -> Any:
    """meta/info.json; ``splits`` are ranges of episodes, "train": "0:24,30:40"."""
    return {
        "codebase_version": CODEBASE_VERSION,
        "robot_type": ROBOT_TYPE,
        "total_episodes": episodes,
        "total_frames": frames,
        "total_tasks": tasks,
        "chunks_size": CHUNKS_SIZE,
        "data_files_size_in_mb": DATA_FILES_MB,
        "video_files_size_in_mb": VIDEO_FILES_MB,
        "fps": fps,
        "splits": splits,
        "data_path": DATA_PATH,
        "video_path": VIDEO_PATH,
        "features": described,
    }


def modality() -> Any:
    """meta/modality.json: how GR00T cuts state and action into named parts."""
    parts = {"position": (0, 3), "orientation": (3, 7), "velocity": (7, 10), "body_rate": (10, len(STATE_NAMES))}
    moves = {"displacement": (0, 3), "yaw": (3, len(ACTION_NAMES))}
    return {
        "state": {name: {"start": a, "end": b} for name, (a, b) in parts.items()},
        "action": {name: {"start": a, "end": b} for name, (a, b) in moves.items()},
        "video": {"front": {"original_key": RGB_KEY}},
        "annotation": {"human.task_description": {"original_key": "task_index"}},
    }


def write_tasks(tasks: list[str], path: Path) -> None:
    """meta/tasks.parquet: column task_index, and a pandas index named task; LeRobot reads it by that name."""
    table = pd.DataFrame({"task_index": range(len(tasks))}, index=pd.Index(tasks, name="task"))
    table.astype("int64").to_parquet(path)


def episode_schema(described: dict[str, Any]) -> pa.Schema:
    """Of meta/episodes: LeRobot's columns, then ours under ``flymirage/``, then ``stats/<feature>/<statistic>``."""
    columns: list[tuple[str, pa.DataType]] = [
        ("episode_index", pa.int64()),
        ("tasks", pa.list_(pa.string())),
        ("length", pa.int64()),
        ("data/chunk_index", pa.int64()),
        ("data/file_index", pa.int64()),
        ("dataset_from_index", pa.int64()),
        ("dataset_to_index", pa.int64()),
        (f"videos/{RGB_KEY}/chunk_index", pa.int64()),
        (f"videos/{RGB_KEY}/file_index", pa.int64()),
        (f"videos/{RGB_KEY}/from_timestamp", pa.float64()),
        (f"videos/{RGB_KEY}/to_timestamp", pa.float64()),
        ("meta/episodes/chunk_index", pa.int64()),
        ("meta/episodes/file_index", pa.int64()),
        ("flymirage/episode_id", pa.string()),
        ("flymirage/scene", pa.string()),
        ("flymirage/category", pa.string()),
        ("flymirage/flight_id", pa.int64()),
        ("flymirage/set_index", pa.int64()),
        ("flymirage/leg_index", pa.int64()),
        ("flymirage/split", pa.string()),
        ("flymirage/object_id", pa.int64()),
        ("flymirage/object_label", pa.string()),
        ("flymirage/box_centre", pa.list_(pa.float64(), 3)),
        ("flymirage/box_size", pa.list_(pa.float64(), 3)),
        ("flymirage/box_yaw", pa.float64()),
        ("flymirage/prompts", pa.list_(pa.string())),
        ("flymirage/prompt_kinds", pa.list_(pa.string())),
        ("flymirage/held_out_prompts", pa.list_(pa.string())),
        ("flymirage/long_prompt", pa.string()),  # over this and the neighbouring episodes that have the same; or ""
        ("flymirage/licence", pa.string()),
        ("flymirage/rgb_crc32", pa.int64()),  # of the episode's video packets
        *((f"flymirage/{name}", pa.float64()) for name in REPORTED),
    ]
    for name, feature in described.items():
        pictures = feature["dtype"] in ("video", "image")
        value: pa.DataType = pa.list_(pa.float64())
        if pictures:
            value = pa.list_(pa.list_(pa.list_(pa.float64())))
        columns += [(f"stats/{name}/{s}", pa.list_(pa.int64()) if s == "count" else value) for s in STAT_NAMES]
    return pa.schema(columns)
