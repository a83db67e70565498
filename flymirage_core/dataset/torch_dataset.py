"""`FlightDataset`: a LeRobot export as a torch Dataset, with random access, delta timestamps, depth and target masks.

It reads our own exports with PyAV and pyarrow alone. Videos have a key frame every second frame, so any frame is one
seek and at most two decodings away; opened files stay open in each worker.
"""

import os
from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import av
import cv2
import numpy as np
import pyarrow.parquet as pq
import torch
from numpy.typing import NDArray
from torch.utils.data import Dataset

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.annotation.instances import instance_ids
from flymirage_core.dataset.depth_geometry import camera_of
from flymirage_core.dataset.export_folder import shard_folder
from flymirage_core.dataset.lerobot_schema import DEPTH_KEY, INDEX_COLUMNS, RGB_KEY
from flymirage_core.dataset.reader import EpisodeRecord, LeRobotFolder
from flymirage_core.dataset.scene_folders import png16_from
from flymirage_core.errors import InputError, ProductError

OPEN_FILES = 8
"""Videos and tables that a worker keeps open."""
MASK_KEY = "target_mask"
T = TypeVar("T")


class FlightDataset(Dataset[dict[str, Any]]):
    """Frames of a LeRobot export; ``dataset[i]`` is a dictionary of tensors.

    ``observation.images.front`` (3, H, W) float32 in 0..1; ``observation.state`` (13,), ``action`` (4,) and the
    ``sim.*`` columns float32, units in conventions.json; ``task`` the instruction. With ``rgb=False`` no picture is
    decoded, for those who learn from depth alone or from states. With ``depth=True`` also
    ``observation.images.front_depth`` (1, H, W) float32 metres, 0 = no return; with ``masks=True`` ``target_mask``
    (H, W) bool: the pixels whose depth lies in the target's box, as `annotation.instances` has it. A key of
    ``delta_timestamps`` (seconds, multiples of 1 / fps) gets a leading time axis, clamped to the episode, and
    ``<key>_is_pad`` (T,) says where it was clamped.
    """

    def __init__(
        self,
        folder: Path,
        split: str | None = None,
        scenes: Sequence[str] = (),
        delta_timestamps: Mapping[str, Sequence[float]] | None = None,
        *,
        rgb: bool = True,
        depth: bool = False,
        masks: bool = False,
    ) -> None:
        self.export = LeRobotFolder(folder)
        self.fps: int = self.export.info["fps"]
        self.episodes = tuple(
            e
            for e in self.export.episodes
            if (split is None or e.split == split) and (not scenes or e.scene in set(scenes))
        )
        if not self.episodes:
            known = ", ".join(f"{name} {ranges}" for name, ranges in self.export.info["splits"].items())
            raise InputError(f"{folder} has no episode of split {split!r} in scenes {list(scenes)}; it has {known}")
        if (depth or masks) and DEPTH_KEY not in self.export.info["features"]:
            raise InputError(f"{folder} was exported without depth: export it again with --depth png16")
        self.numeric = [n for n, f in self.export.info["features"].items() if f["dtype"] == "float32"]
        self._rgb_wanted, self._depth, self._masks = rgb, depth, masks
        self._deltas = self._frame_deltas(delta_timestamps or {})
        self._ends = np.cumsum([e.length for e in self.episodes]).tolist()
        self._columns: dict[int, dict[str, NDArray[Any]]] = {}
        self._videos: OrderedDict[Path, _Video] = OrderedDict()
        self._tables: OrderedDict[Path, _DepthTable] = OrderedDict()
        self._boxes: dict[str, BoxMap] = {}
        self._last_depth: tuple[tuple[Path, int] | None, NDArray[np.float32]] = (None, np.zeros((0, 0), np.float32))
        self._process = os.getpid()

    def __len__(self) -> int:
        return int(self._ends[-1])

    def __getitem__(self, index: int) -> dict[str, Any]:
        if not -len(self) <= index < len(self):
            raise IndexError(f"frame {index} of {len(self)}")
        self._open_own_files()
        index %= len(self)
        number = bisect_right(self._ends, index)
        episode = self.episodes[number]
        frame = index - (self._ends[number] - episode.length)
        columns = self._episode_columns(episode)
        item: dict[str, Any] = {
            "task": self.export.tasks[int(columns["task_index"][frame])],
            "episode_index": torch.tensor(episode.index),
            "frame_index": torch.tensor(frame),
            "timestamp": torch.tensor(frame / self.fps, dtype=torch.float32),
        }
        readers = {name: _row_of(columns[name]) for name in self.numeric if name not in INDEX_COLUMNS}
        if self._rgb_wanted:
            readers[RGB_KEY] = lambda i: self._rgb(episode, i)
        if self._depth:
            readers[DEPTH_KEY] = lambda i: torch.from_numpy(self._depth_metres(episode, i).copy())[None]
        if self._masks:
            readers[MASK_KEY] = lambda i: self._mask(episode, i, columns["observation.state"][i])
        for name, read in readers.items():
            item |= self._over_time(name, read, frame, episode.length)
        return item

    def __getstate__(self) -> dict[str, Any]:
        """Workers open files of their own."""
        return {**self.__dict__, "_videos": OrderedDict(), "_tables": OrderedDict()}

    def _open_own_files(self) -> None:
        """A forked worker shares its parent's open files, and each would move the other's place in them."""
        if self._process != os.getpid():
            self._process, self._videos, self._tables = os.getpid(), OrderedDict(), OrderedDict()

    def _over_time(
        self, name: str, read: Callable[[int], torch.Tensor], frame: int, length: int
    ) -> dict[str, torch.Tensor]:
        if name not in self._deltas:
            return {name: read(frame)}
        wanted = [frame + delta for delta in self._deltas[name]]
        clamped = [min(max(i, 0), length - 1) for i in wanted]
        pad = torch.tensor([i != j for i, j in zip(wanted, clamped, strict=True)])
        return {name: torch.stack([read(i) for i in clamped]), f"{name}_is_pad": pad}

    def _frame_deltas(self, seconds: Mapping[str, Sequence[float]]) -> dict[str, list[int]]:
        pictures = ((RGB_KEY, self._rgb_wanted), (DEPTH_KEY, self._depth), (MASK_KEY, self._masks))
        known = [n for n in self.numeric if n not in INDEX_COLUMNS] + [key for key, on in pictures if on]
        for name, deltas in seconds.items():
            if name not in known:
                raise InputError(f"delta_timestamps: there is no {name!r}; there are {', '.join(known)}")
            off = [d for d in deltas if abs(d * self.fps - round(d * self.fps)) > 1e-3]
            if off:
                raise InputError(f"delta_timestamps of {name!r}: {off[0]} s is no multiple of 1/{self.fps} s")
        return {name: [round(d * self.fps) for d in deltas] for name, deltas in seconds.items()}

    def _episode_columns(self, episode: EpisodeRecord) -> dict[str, NDArray[Any]]:
        """All numbers of an episode, read once: a few kilobytes."""
        if episode.index not in self._columns:
            columns = self.export.columns(episode.index, (*self.numeric, "task_index"))
            self._columns[episode.index] = {name: np.array(values) for name, values in columns.items()}  # writable
        return self._columns[episode.index]

    def _rgb(self, episode: EpisodeRecord, frame: int) -> torch.Tensor:
        path, first = self.export.video(episode)
        video = _kept_open(self._videos, path, lambda: _Video(path, self.fps))
        planes = np.ascontiguousarray(video.frame(first + frame).transpose(2, 0, 1))  # (3, H, W)
        # By numpy: torch would wake all its threads for each picture, and on a busy machine wait for them.
        return torch.from_numpy(np.divide(planes, np.float32(255), dtype=np.float32))

    def _depth_metres(self, episode: EpisodeRecord, frame: int) -> NDArray[np.float32]:
        """(H, W), 0 = no return; the last one is kept, since the mask asks for it again."""
        path, first = self.export.data(episode)
        if self._last_depth[0] != (path, first + frame):
            table = _kept_open(self._tables, path, lambda: _DepthTable(path))
            where = f"{path}: depth picture {frame} of episode {episode.index}"
            metres = np.divide(png16_from(table.png(first + frame), where), np.float32(1000), dtype=np.float32)
            self._last_depth = ((path, first + frame), metres)
        return self._last_depth[1]

    def _mask(self, episode: EpisodeRecord, frame: int, state: NDArray[Any]) -> torch.Tensor:
        camera = camera_of(state, self.export.camera(episode.scene))
        ids = instance_ids(self._depth_metres(episode, frame), camera, (self._target(episode),))  # (H, W)
        return torch.from_numpy(ids > 0)

    def _target(self, episode: EpisodeRecord) -> ObjectBox:
        if episode.scene not in self._boxes:
            self._boxes[episode.scene] = BoxMap.load(shard_folder(self.export.folder, episode.scene))
        return self._boxes[episode.scene].by_id(episode.row["flymirage/object_id"])


class _Video:
    """A video file that stays open; frames that follow each other are decoded without a seek."""

    def __init__(self, path: Path, fps: int) -> None:
        self._path = path
        self._container: Any = av.open(str(path))
        self._stream: Any = self._container.streams.video[0]
        self._stream.codec_context.thread_count = 1  # workers are the parallelism
        self._per_frame = 1 / (fps * float(self._stream.time_base or 1))  # ticks
        self._decoder: Any = None
        self._next = -1  # number of the frame that the decoder gives next

    def frame(self, number: int) -> NDArray[np.uint8]:
        """RGB (H, W, 3) of the file's ``number``-th frame; raises `ProductError` if it is not there."""
        if self._decoder is None or not self._next <= number <= self._next + 2:
            self._container.seek(round(number * self._per_frame), stream=self._stream)
            self._decoder = self._container.decode(self._stream)
        for picture in self._decoder:
            found = round(picture.pts / self._per_frame)
            self._next = found + 1
            if found == number:
                planes = picture.to_ndarray(format="yuv420p")
                return np.asarray(cv2.cvtColor(planes, cv2.COLOR_YUV2RGB_I420), np.uint8)
            if found > number:
                break
        self._decoder = None
        raise ProductError(f"{self._path} has no frame {number}; `flymirage validate` names what is wrong")


class _DepthTable:
    """A data file that stays open; of its depth pictures one row group is read at a time."""

    def __init__(self, path: Path) -> None:
        self._file = pq.ParquetFile(path, memory_map=True)
        groups = range(self._file.num_row_groups)
        self._ends = np.cumsum([self._file.metadata.row_group(i).num_rows for i in groups]).tolist()

    def png(self, row: int) -> bytes:
        """The picture in the file's ``row``-th row, as it is stored."""
        group = bisect_right(self._ends, row)
        cells = self._file.read_row_group(group, columns=[DEPTH_KEY])[DEPTH_KEY]
        return cells[row - self._ends[group] + len(cells)].as_py()["bytes"] or b""


def _kept_open(opened: "OrderedDict[Path, T]", path: Path, make: Callable[[], T]) -> T:
    """The entry of ``path``; the least recently used ones are let go."""
    if path not in opened:
        opened[path] = make()
        if len(opened) > OPEN_FILES:
            opened.popitem(last=False)
    opened.move_to_end(path)
    return opened[path]


def _row_of(column: NDArray[Any]) -> Callable[[int], torch.Tensor]:
    return lambda i: torch.as_tensor(column[i], dtype=torch.float32)
