"""Writing a scene's episodes into LeRobot's data, video and episode files, one at a time."""

from pathlib import Path
from types import TracebackType
from typing import Any

import cv2
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from flymirage_core.dataset.column_stats import PictureCounts, numeric_stats
from flymirage_core.dataset.episodes import Episode
from flymirage_core.dataset.export_folder import Placed, shard_folder
from flymirage_core.dataset.flight_columns import flight_columns
from flymirage_core.dataset.lerobot_places import (
    Start,
    data_path,
    episodes_path,
    files_at,
    index_row,
    place_at,
    placed_columns,
    task_indices,
)
from flymirage_core.dataset.lerobot_schema import (
    CHUNKS_SIZE,
    DATA_FILES_MB,
    DEPTH_KEY,
    PNG,
    REPORTED,
    RGB_KEY,
    VIDEO_COLUMNS,
    data_schema,
    episode_schema,
)
from flymirage_core.dataset.lerobot_stats import save_sketch
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.dataset.video_join import VideoJoiner, VideoSpan
from flymirage_core.errors import ProductError
from flymirage_core.rendering.frames import CameraRig, FlightFrames

STATS_EVERY = 5
"""Every so many frames a picture is counted into the statistics; neighbours look alike."""
ROWS_OF_GROUP = 8
"""Of a data file's row groups: who wants one frame's depth reads a group, and they cost 0.3 % of the file."""
PNG_COMPRESSION = 1
"""zlib level: 3 takes twice as long for a twentieth less."""


class EpisodeWriter:
    """Writes a scene's episodes into data and video files of its own; a context manager, then `finish`."""

    def __init__(self, folder: Path, rig: CameraRig, described: dict[str, Any], start: Start) -> None:
        self._folder, self._described, self._start = folder, described, start
        self._rate = round(rig.frame_rate)
        self._rows: list[dict[str, Any]] = []
        self._tasks: list[str] = []  # the scene's own
        self._task_of: list[int] = []
        self._numbers: list[dict[str, NDArray[Any]]] = []
        self._pictures: dict[str, PictureCounts] = {}
        self._videos = VideoJoiner(folder / "videos" / RGB_KEY, self._rate, start.first_video_file)
        self._data = DataFiles(folder, data_schema(described), start.first_data_file)

    def __enter__(self) -> "EpisodeWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._videos.__exit__(kind, error, trace)
        self._data.close()

    def add(self, products: SceneProducts, episode: Episode, long_prompt: str) -> None:
        """Write one flight's frames, and note its row of meta/episodes; ``long_prompt`` is of its run, or ""."""
        flight = next(f for f in products.trajectories if f.flight_id == episode.flight_id)
        frames = products.frames.flight(episode.flight_id)
        texts = [p.text for p in episode.training_prompts]
        task = texts[episode.flight_id % len(texts)]
        self._tasks += [text for text in dict.fromkeys(texts) if text not in self._tasks]
        self._task_of.append(self._tasks.index(task))
        numbers: dict[str, NDArray[Any]] = {
            **flight_columns(flight, frames, products.boxes.by_id(episode.object_id)),
            **self._index_columns(len(frames)),
        }
        pictures = {RGB_KEY: _counted_rgb(frames)}
        pngs: list[bytes] = []
        if DEPTH_KEY in self._described:
            pngs, pictures[DEPTH_KEY] = _encoded_depth(frames)
        video = self._videos.append(frames.folder / "rgb.mp4", len(frames))
        place = self._data.append(numbers, {DEPTH_KEY: pngs} if pngs else {})
        tasks = [task, *(t for t in texts if t != task)]
        own = {"tasks": tasks, "flymirage/long_prompt": long_prompt, **_own_columns(episode)}
        self._note(own, place, video, numbers, pictures)

    def finish(self, scene: str) -> Placed:
        """Write the scene's rows of meta/episodes and its statistics."""
        place = place_at(
            self._start,
            [row["length"] for row in self._rows],
            self._data.count,
            self._videos.count,
            self._tasks,
            self._task_of,
        )
        path = self._folder / episodes_path(self._start.episode_file)
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.Table.from_pylist(self._rows, schema=episode_schema(self._described)), path)
        columns = {name: np.concatenate([n[name] for n in self._numbers]) for name in self._numbers[0]}
        save_sketch(shard_folder(self._folder, scene), columns, self._pictures)
        return Placed(place, files_at(scene, place))

    def _index_columns(self, length: int) -> dict[str, NDArray[Any]]:
        frame = np.arange(length, dtype=np.int64)[:, None]  # (F, 1)
        task = task_indices(self._start.tasks, self._tasks)[self._task_of[-1]]
        first = self._start.first_frame + sum(row["length"] for row in self._rows)
        return {
            "next.done": frame == length - 1,
            "timestamp": (frame / self._rate).astype(np.float32),
            "frame_index": frame,
            **placed_columns(self._start.first_episode + len(self._rows), first, length, task),
        }

    def _note(
        self,
        own: dict[str, Any],
        place: tuple[int, int],
        video: VideoSpan,
        numbers: dict[str, NDArray[Any]],
        pictures: dict[str, PictureCounts],
    ) -> None:
        stats = {n: numeric_stats(v) for n, v in numbers.items()} | {n: c.stats() for n, c in pictures.items()}
        chunk, file = divmod(self._start.episode_file, CHUNKS_SIZE)
        self._rows.append(
            {
                **index_row(int(numbers["episode_index"][0, 0]), int(numbers["index"][0, 0]), len(numbers["index"])),
                "length": len(numbers["index"]),
                "data/chunk_index": place[0],
                "data/file_index": place[1],
                **{f"videos/{RGB_KEY}/{name}": getattr(video, name) for name in VIDEO_COLUMNS},
                "flymirage/rgb_crc32": video.crc32,
                "meta/episodes/chunk_index": chunk,
                "meta/episodes/file_index": file,
                **own,
                **{f"stats/{n}/{s}": value for n, values in stats.items() for s, value in values.items()},
            }
        )
        self._numbers.append(numbers)
        for name, counts in pictures.items():
            self._pictures[name] = self._pictures[name] + counts if name in self._pictures else counts


class DataFiles:
    """Data files from number ``first`` on; an episode is some whole row groups of one file."""

    def __init__(self, folder: Path, schema: pa.Schema, first: int = 0, max_bytes: int = DATA_FILES_MB * 2**20) -> None:
        self._folder, self._schema, self._first, self._max_bytes = folder, schema, first, max_bytes
        self._number, self._bytes = first - 1, 0
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
        self._writer.write_table(table, row_group_size=ROWS_OF_GROUP)
        self._bytes += table.nbytes
        chunk, file = divmod(self._number, CHUNKS_SIZE)
        return chunk, file

    @property
    def count(self) -> int:
        return self._number - self._first + 1

    def close(self) -> None:
        if self._writer is not None:
            self._writer.close()
            self._writer = None

    def _open_next(self) -> None:
        self.close()
        self._number, self._bytes = self._number + 1, 0
        path = self._folder / data_path(self._number)
        path.parent.mkdir(parents=True, exist_ok=True)
        # Dictionaries are of no use to PNGs and to floats that hardly repeat.
        self._writer = pq.ParquetWriter(path, self._schema, use_dictionary=False)


def _own_columns(episode: Episode) -> dict[str, Any]:
    return {
        "flymirage/episode_id": episode.episode_id,
        "flymirage/scene": episode.scene,
        "flymirage/category": episode.category,
        "flymirage/flight_id": episode.flight_id,
        "flymirage/set_index": episode.set_index,
        "flymirage/leg_index": episode.leg_index,
        "flymirage/split": episode.split,
        "flymirage/object_id": episode.object_id,
        "flymirage/object_label": episode.object_label,
        "flymirage/box_centre": episode.box_centre,
        "flymirage/box_size": episode.box_size,
        "flymirage/box_yaw": episode.box_yaw,
        "flymirage/prompts": [p.text for p in episode.prompts],
        "flymirage/prompt_kinds": [p.kind for p in episode.prompts],
        "flymirage/held_out_prompts": [p.text for p in episode.held_out_prompts],
        "flymirage/licence": episode.licence,
        **{f"flymirage/{name}": getattr(episode.report, name) for name in REPORTED},
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
