"""`LeRobotFolder`: our own small reader of the export; it needs nothing of LeRobot and decodes what is asked for."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from numpy.typing import NDArray

from flymirage_core.dataset.lerobot_schema import CODEBASE_VERSION, DEPTH_KEY, RGB_KEY
from flymirage_core.dataset.scene_folders import png16_from
from flymirage_core.errors import InputError, ProductError


@dataclass(frozen=True)
class EpisodeRecord:
    """One row of meta/episodes; ``row`` holds all of its columns."""

    index: int
    length: int
    split: str
    scene: str
    flight_id: int
    prompts: tuple[str, ...]
    row: dict[str, Any]


@dataclass(frozen=True, eq=False)
class ExportedFrame:
    """One frame of an episode; see conventions.json for units and frames."""

    timestamp: float  # seconds
    rgb: NDArray[np.uint8]  # (H, W, 3)
    depth: NDArray[np.uint16] | None  # (H, W) millimetres, 0 = no return; None if exported without
    state: NDArray[np.float32]  # (13,)
    action: NDArray[np.float32]  # (4,)
    task: str


@dataclass(frozen=True)
class LeRobotFolder:
    """A LeRobot v3.0 folder of FlyMirage's; raises `InputError` where it is none."""

    folder: Path

    @cached_property
    def info(self) -> dict[str, Any]:
        path = self.folder / "meta" / "info.json"
        if not path.exists():
            raise InputError(f"{self.folder} is no LeRobot folder: meta/info.json is missing")
        info: dict[str, Any] = json.loads(path.read_text())
        if info.get("codebase_version") != CODEBASE_VERSION:
            raise InputError(
                f"{path} has version {info.get('codebase_version')!r}, this reader knows {CODEBASE_VERSION}"
            )
        return info

    @cached_property
    def conventions(self) -> dict[str, Any]:
        conventions: dict[str, Any] = json.loads((self.folder / "conventions.json").read_text())
        return conventions

    @cached_property
    def episodes(self) -> tuple[EpisodeRecord, ...]:
        files = sorted((self.folder / "meta" / "episodes").rglob("*.parquet"))
        rows = [row for path in files for row in pq.read_table(path).to_pylist()]
        return tuple(
            EpisodeRecord(
                row["episode_index"],
                row["length"],
                row["flymirage/split"],
                row["flymirage/scene"],
                row["flymirage/flight_id"],
                tuple(row["flymirage/prompts"]),
                row,
            )
            for row in rows
        )

    @cached_property
    def tasks(self) -> tuple[str, ...]:
        """Prompts by task_index."""
        table = pq.read_table(self.folder / "meta" / "tasks.parquet").sort_by("task_index")
        return tuple(table["task"].to_pylist())

    def columns(self, episode: int, names: tuple[str, ...]) -> dict[str, NDArray[Any]]:
        """Numeric columns of an episode, each (F, n), or (F,) for scalars."""
        table = self._table(episode, names)
        return {name: _numpy(table[name]) for name in names}

    def rgb(self, episode: int) -> Iterator[NDArray[np.uint8]]:
        """Pictures (H, W, 3), in order, found by the episode's timestamps alone."""
        record = self.episodes[episode]
        path, first = self.video(record)
        rate = self.info["fps"]
        with av.open(str(path)) as container:
            stream = container.streams.video[0]
            tick = float(stream.time_base or 1)  # seconds
            container.seek(round(first / rate / tick), stream=stream)
            for frame in container.decode(stream):
                number = round((frame.pts or 0) * tick * rate)
                if number >= first + record.length:
                    return
                if number >= first:
                    planes = frame.to_ndarray(format="yuv420p")  # to RGB as `rendering.video` does it
                    yield np.asarray(cv2.cvtColor(planes, cv2.COLOR_YUV2RGB_I420), np.uint8)

    def depth(self, episode: int) -> Iterator[NDArray[np.uint16]]:
        """Depth (H, W) in millimetres, in order; nothing if the export holds none."""
        for i, cell in enumerate(self.depth_cells(episode)):
            yield png16_from(cell, f"{self.folder}: depth picture {i} of episode {episode}")

    def depth_cells(self, episode: int) -> Iterator[bytes]:
        """The depth pictures as they are stored, in order; nothing if the export holds none."""
        if DEPTH_KEY in self.info["features"]:
            yield from (cell["bytes"] or b"" for cell in self._table(episode, (DEPTH_KEY,))[DEPTH_KEY].to_pylist())

    def frames(self, episode: int) -> Iterator[ExportedFrame]:
        """The frames of an episode, pictures and numbers together."""
        numbers = self.columns(episode, ("timestamp", "observation.state", "action", "task_index"))
        depths: Iterator[NDArray[np.uint16] | None] = self.depth(episode)
        for i, rgb in enumerate(self.rgb(episode)):
            yield ExportedFrame(
                float(numbers["timestamp"][i]),
                rgb,
                next(depths, None),
                numbers["observation.state"][i],
                numbers["action"][i],
                self.tasks[int(numbers["task_index"][i])],
            )

    def camera(self, scene: str) -> dict[str, Any]:
        """The entry of conventions.json for a scene's camera."""
        for camera in self.conventions["cameras"]:
            if scene in camera["scenes"]:
                found: dict[str, Any] = camera
                return found
        raise InputError(f"{self.folder / 'conventions.json'} names no camera for scene {scene}")

    def _table(self, episode: int, names: tuple[str, ...]) -> pa.Table:
        record = self.episodes[episode]
        path = self._data_file(record)
        chosen = pc.field("episode_index") == record.index
        table = pq.read_table(path, columns=list(names), filters=chosen)
        if len(table) != record.length:
            raise ProductError(
                f"{path} has {len(table)} rows of episode {episode}, expected {record.length}; export again"
            )
        return table

    def video(self, record: EpisodeRecord) -> tuple[Path, int]:
        """The file, and the number of the episode's first frame in it."""
        where = {k: record.row[f"videos/{RGB_KEY}/{k}"] for k in ("chunk_index", "file_index", "from_timestamp")}
        path = self.folder / self.info["video_path"].format(video_key=RGB_KEY, **where)
        return path, round(where["from_timestamp"] * self.info["fps"])

    def data(self, record: EpisodeRecord) -> tuple[Path, int]:
        """The data file, and the number of the episode's first row in it."""
        path = self._data_file(record)
        return path, record.row["dataset_from_index"] - self._first_of_file[path]

    @cached_property
    def _first_of_file(self) -> dict[Path, int]:
        """The number, in the whole, of each data file's first row."""
        first: dict[Path, int] = {}
        for episode in self.episodes:
            first.setdefault(self._data_file(episode), episode.row["dataset_from_index"])
        return first

    def _data_file(self, record: EpisodeRecord) -> Path:
        where = {k: record.row[f"data/{k}"] for k in ("chunk_index", "file_index")}
        return self.folder / str(self.info["data_path"]).format(**where)


def _numpy(column: pa.ChunkedArray) -> NDArray[Any]:
    array = column.combine_chunks()
    if pa.types.is_fixed_size_list(array.type):
        flat: NDArray[Any] = array.flatten().to_numpy().reshape(len(array), -1)
        return flat
    values: NDArray[Any] = array.to_numpy(zero_copy_only=False)
    return values
