"""Writing episodes into LeRobot's data and video files, one at a time; metadata is gathered on the way."""

from pathlib import Path
from types import TracebackType
from typing import Any

import cv2
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from flymirage_core.dataset.column_stats import PictureCounts, numeric_stats
from flymirage_core.dataset.episodes import Episode, SceneProducts
from flymirage_core.dataset.flight_columns import flight_columns
from flymirage_core.dataset.lerobot_schema import (
    CHUNKS_SIZE,
    DATA_FILES_MB,
    DATA_PATH,
    DEPTH_KEY,
    EPISODES_PATH,
    PNG,
    RGB_KEY,
    data_schema,
    episode_schema,
)
from flymirage_core.dataset.video_join import VideoJoiner, VideoSpan
from flymirage_core.errors import ProductError
from flymirage_core.rendering.frames import CameraRig, FlightFrames

STATS_EVERY = 5
"""Every so many frames a picture is counted into the statistics; neighbours look alike."""
PNG_COMPRESSION = 1
"""zlib level: 3 takes twice as long for a twentieth less."""


class EpisodeWriter:
    """Appends episodes to data and video files, and keeps what the metadata needs; a context manager."""

    def __init__(self, folder: Path, rig: CameraRig, described: dict[str, Any]) -> None:
        self.rows: list[dict[str, Any]] = []
        self.tasks: list[str] = []
        self.frames = 0
        self.pictures: dict[str, PictureCounts] = {}
        self._numbers: list[dict[str, NDArray[Any]]] = []
        self._task_of: dict[str, int] = {}
        self._described = described
        self._rate = round(rig.frame_rate)
        self._videos = VideoJoiner(folder / "videos" / RGB_KEY, self._rate)
        self._data = DataFiles(folder, data_schema(described))

    def __enter__(self) -> "EpisodeWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._videos.__exit__(kind, error, trace)
        self._data.close()

    def add(self, products: SceneProducts, episode: Episode) -> None:
        """Write one flight's frames, and note its row of meta/episodes."""
        flight = next(f for f in products.trajectories if f.flight_id == episode.flight_id)
        frames = products.frames.flight(episode.flight_id)
        texts = [p.text for p in episode.prompts]
        task = texts[episode.flight_id % len(texts)]
        numbers: dict[str, NDArray[Any]] = {
            **flight_columns(flight, frames, products.boxes.by_id(episode.object_id)),
            **self._index_columns(len(frames), [self._task_index(text) for text in texts][texts.index(task)]),
        }
        pictures = {RGB_KEY: _counted_rgb(frames)}
        pngs: list[bytes] = []
        if DEPTH_KEY in self._described:
            pngs, pictures[DEPTH_KEY] = _encoded_depth(frames)
        video = self._videos.append(frames.folder / "rgb.mp4", len(frames))
        place = self._data.append(numbers, {DEPTH_KEY: pngs} if pngs else {})
        self._note(episode, [task, *(t for t in texts if t != task)], place, video, numbers, pictures)

    def numbers(self) -> dict[str, NDArray[Any]]:
        """All numeric columns over all frames, each (N, n)."""
        return {name: np.concatenate([n[name] for n in self._numbers]) for name in self._numbers[0]}

    def write_episodes(self, meta: Path) -> None:
        """meta/episodes, in one file: a row is a few kilobytes."""
        path = meta.parent / EPISODES_PATH.format(chunk_index=0, file_index=0)
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.Table.from_pylist(self.rows, schema=episode_schema(self._described)), path)

    def _index_columns(self, length: int, task_index: int) -> dict[str, NDArray[Any]]:
        frame = np.arange(length, dtype=np.int64)[:, None]  # (F, 1)
        return {
            "next.done": frame == length - 1,
            "timestamp": (frame / self._rate).astype(np.float32),
            "frame_index": frame,
            "episode_index": np.full_like(frame, len(self.rows)),
            "index": frame + self.frames,
            "task_index": np.full_like(frame, task_index),
        }

    def _task_index(self, text: str) -> int:
        if text not in self._task_of:
            self._task_of[text] = len(self.tasks)
            self.tasks.append(text)
        return self._task_of[text]

    def _note(
        self,
        episode: Episode,
        tasks: list[str],
        place: tuple[int, int],
        video: VideoSpan,
        numbers: dict[str, NDArray[Any]],
        pictures: dict[str, PictureCounts],
    ) -> None:
        length = len(numbers["index"])
        stats = {n: numeric_stats(v) for n, v in numbers.items()} | {n: c.stats() for n, c in pictures.items()}
        self.rows.append(
            {
                "episode_index": len(self.rows),
                "tasks": tasks,
                "length": length,
                "data/chunk_index": place[0],
                "data/file_index": place[1],
                "dataset_from_index": self.frames,
                "dataset_to_index": self.frames + length,
                **{f"videos/{RGB_KEY}/{name}": value for name, value in video._asdict().items()},
                "meta/episodes/chunk_index": 0,
                "meta/episodes/file_index": 0,
                **_own_columns(episode),
                **{f"stats/{n}/{s}": value for n, values in stats.items() for s, value in values.items()},
            }
        )
        self.frames += length
        self._numbers.append(numbers)
        for name, counts in pictures.items():
            self.pictures[name] = self.pictures[name] + counts if name in self.pictures else counts


class DataFiles:
    """``data/chunk-000/file-000.parquet`` and its successors; an episode is one row group, never cut in two."""

    def __init__(self, folder: Path, schema: pa.Schema, max_bytes: int = DATA_FILES_MB * 2**20) -> None:
        self._folder, self._schema, self._max_bytes = folder, schema, max_bytes
        self._number, self._bytes = -1, 0
        self._writer: pq.ParquetWriter | None = None

    def append(self, numbers: dict[str, NDArray[Any]], pngs: dict[str, list[bytes]]) -> tuple[int, int]:
        """Write one episode; returns its chunk and file."""
        columns: dict[str, pa.Array] = {name: _arrow(values) for name, values in numbers.items()}
        for name, pictures in pngs.items():
            columns[name] = pa.array([{"bytes": p, "path": None} for p in pictures], PNG)
        table = pa.table({name: columns[name] for name in self._schema.names}, schema=self._schema)
        if self._writer is None or self._bytes + table.nbytes > self._max_bytes:
            self._open_next()
        assert self._writer is not None
        self._writer.write_table(table, row_group_size=len(table))
        self._bytes += table.nbytes
        chunk, file = divmod(self._number, CHUNKS_SIZE)
        return chunk, file

    def close(self) -> None:
        if self._writer is not None:
            self._writer.close()
            self._writer = None

    def _open_next(self) -> None:
        self.close()
        self._number, self._bytes = self._number + 1, 0
        chunk, file = divmod(self._number, CHUNKS_SIZE)
        path = self._folder / DATA_PATH.format(chunk_index=chunk, file_index=file)
        path.parent.mkdir(parents=True, exist_ok=True)
        # Dictionaries are of no use to PNGs and to floats that hardly repeat.
        self._writer = pq.ParquetWriter(path, self._schema, use_dictionary=False)


def _own_columns(episode: Episode) -> dict[str, Any]:
    return {
        "flymirage/episode_id": episode.episode_id,
        "flymirage/scene": episode.scene,
        "flymirage/flight_id": episode.flight_id,
        "flymirage/split": episode.split,
        "flymirage/object_label": episode.object_label,
        "flymirage/box_centre": episode.box_centre,
        "flymirage/box_size": episode.box_size,
        "flymirage/box_yaw": episode.box_yaw,
        "flymirage/prompts": [p.text for p in episode.prompts],
        "flymirage/prompt_kinds": [p.kind for p in episode.prompts],
    }


def _arrow(values: NDArray[Any]) -> pa.Array:
    """(F, 1) becomes a plain column, (F, n) one of fixed-size lists."""
    flat = pa.array(np.ascontiguousarray(values).ravel())
    return flat if values.shape[1] == 1 else pa.FixedSizeListArray.from_arrays(flat, values.shape[1])


def _counted_rgb(frames: FlightFrames) -> PictureCounts:
    counted = [PictureCounts.of_rgb(rgb) for i, rgb in enumerate(frames.rgb()) if i % STATS_EVERY == 0]
    return sum(counted[1:], counted[0])


def _encoded_depth(frames: FlightFrames) -> tuple[list[bytes], PictureCounts]:
    """Every frame's depth as 16-bit PNG, and the sampled ones counted."""
    pngs: list[bytes] = []
    counted: list[PictureCounts] = []
    for i, depth in enumerate(frames.depth()):
        ok, png = cv2.imencode(".png", depth, [cv2.IMWRITE_PNG_COMPRESSION, PNG_COMPRESSION])
        if not ok:
            raise ProductError(f"{frames.folder}: depth frame {i} could not be written as PNG")
        pngs.append(png.tobytes())
        if i % STATS_EVERY == 0:
            counted.append(PictureCounts.of_depth(depth))
    return pngs, sum(counted[1:], counted[0])
