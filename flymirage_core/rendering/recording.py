"""Filming flights: rendering, encoding and writing overlap, and no more than a few pictures are ever held.

The rasterizer works ahead on its own threads; each video is encoded on a thread of its own; the caller's thread hands
pictures from the one to the others. On a machine with many cores several flights are filmed in turns, because one
encoder thread would not keep up. The files are the same bytes whatever the number of threads.
"""

import zlib
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.spatial.transform import Rotation

from flymirage_core.errors import ProductError
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.cpu import usable_cores
from flymirage_core.rendering.frame_writer import FrameWriter
from flymirage_core.rendering.frames import (
    FRAME_SCHEMA,
    TARGET_SEEN,
    BodyPath,
    CameraRig,
    Frames,
    VideoFile,
    cameras_along,
    flight_folder,
    save_video_files,
)
from flymirage_core.rendering.image_stack import ImageStackWriter
from flymirage_core.rendering.instances import OrientedBoxes, instance_ids, seen_share
from flymirage_core.rendering.rasterizer import MIN_ALPHA_FOR_DEPTH, Rasterizer, Rendering
from flymirage_core.rendering.video import VideoWriter
from flymirage_core.rendering.views import depth_to_millimetres
from flymirage_core.splats.cloud import GaussianCloud

QUEUE = 4
"""Pictures that may wait for an encoder; then the renderer waits."""


def record_frames(
    cloud: GaussianCloud,
    paths: Sequence[BodyPath],
    rig: CameraRig,
    rasterizer: Rasterizer,
    folder: Path,
    objects: OrientedBoxes | None = None,
) -> Frames:
    """Film every flight into ``folder``; if ``objects`` are given, with a video of which one each pixel shows.

    ``frames.parquet`` is written last. Raises `InputError` if the picture's size cannot be a video's, `ProductError` if
    the rasterizer stops early.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rig.save(folder / "camera.json")
    films = [film for path in paths if len(path.times) for film in _films(folder, path, rig, objects)]
    order = list(turns({number: len(film.cameras) for number, film in enumerate(films)}, lanes()))
    places = [iter(film.cameras) for film in films]
    pictures = rasterizer.render(cloud, [next(places[number]) for number in order])
    try:
        for done, number in enumerate(order):
            picture = next(pictures, None)
            if picture is None:
                raise ProductError(f"{folder}: the rasterizer gave {done} pictures, {len(order)} were asked for")
            films[number].append(picture)
        for film in films:
            film.finish()
    finally:
        for film in films:
            film.abandon()
    save_video_files(folder, [file for film in films for file in film.files])
    rows = [film.rows() for film in films if film.is_front]
    table = pa.concat_tables([FRAME_SCHEMA.empty_table(), *rows])
    pq.write_table(table, folder / "frames.parquet", write_page_checksum=True)
    return Frames(folder, rig, table.to_pandas())


def _films(folder: Path, path: BodyPath, rig: CameraRig, objects: OrientedBoxes | None) -> Iterator["_Film"]:
    """One for each camera of the rig, the front one first."""
    at = flight_folder(folder, path.flight_id)
    yield _Film(folder, at, path, rig, objects)
    for side in rig.sides:
        yield _Film(folder, at / side, replace(path, target=None), rig.looking(side), objects, is_front=False)


def lanes() -> int:
    """How many flights are filmed in turns: an encoder for each core, two to a flight."""
    return max(1, usable_cores() // 2)


def turns(counts: dict[int, int], lanes: int) -> Iterator[int]:
    """The flight that each next picture is of: ``lanes`` flights take turns, and one that ends makes room for the next.

    >>> list(turns({1: 2, 2: 3, 3: 1}, 2))
    [1, 2, 1, 2, 3, 2]
    """
    waiting = iter(counts)
    active = deque((flight, counts[flight]) for flight in islice(waiting, lanes))
    while active:
        flight, left = active.popleft()
        yield flight
        if left > 1:
            active.append((flight, left - 1))
        else:
            active.extend((following, counts[following]) for following in islice(waiting, 1))


@dataclass(frozen=True)
class Measured:
    """What is known of a picture besides its pose."""

    alpha_coverage: float
    mean_depth: float
    target_share: float | None


class _Film:
    """One flight's videos in the making, through one camera, and its rows of `FRAME_SCHEMA`.

    Its threads start with its first picture, and end with its last.
    """

    def __init__(
        self,
        root: Path,
        at: Path,
        path: BodyPath,
        rig: CameraRig,
        objects: OrientedBoxes | None,
        *,
        is_front: bool = True,
    ) -> None:
        self.path, self.is_front, self.files = path, is_front, list[VideoFile]()
        self.cameras = cameras_along(path, rig)
        self._root, self._objects, self._given, self._measured = root, objects, 0, list[Measured]()
        self._rgb = _Encoder(VideoWriter(at / "rgb.mp4", rig.frame_rate))
        self._depth = _Encoder(ImageStackWriter(at / "depth.zip"))
        self._instances = _Encoder(ImageStackWriter(at / "instances.zip")) if objects is not None else None

    def append(self, picture: Rendering) -> None:
        """Hand one more picture to the encoders; waits for them if they are `QUEUE` pictures behind."""
        camera = self.cameras[self._given]
        self._given += 1
        self._rgb.append(lambda: picture.rgb)
        self._depth.append(lambda: self._look_at(picture, camera))
        if self._instances is not None and self._objects is not None:
            objects = self._objects
            self._instances.append(lambda: instance_ids(picture.depth, camera, objects))
        if self._given == len(self.cameras):
            for encoder in self._encoders:
                encoder.end()

    def finish(self) -> None:
        """Wait until the videos are whole; raises what went wrong with them."""
        self.files = [encoder.file(self._root) for encoder in self._encoders]

    def abandon(self) -> None:
        """Let go of threads and files, whether the videos are whole or not."""
        for encoder in self._encoders:
            encoder.abandon()

    def rows(self) -> pa.Table:
        poses = np.array([camera.T_world_camera for camera in self.cameras])  # (T, 4, 4)
        quaternions = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
        shares = [m.target_share for m in self._measured]
        columns = [
            pa.array(np.full(len(poses), self.path.flight_id, np.int32)),
            pa.array(np.arange(len(poses), dtype=np.int32)),
            pa.array(np.asarray(self.path.times, float)),
            pa.FixedSizeListArray.from_arrays(pa.array(poses[:, :3, 3].ravel()), 3),
            pa.FixedSizeListArray.from_arrays(pa.array(quaternions.ravel()), 4),
            pa.array([m.alpha_coverage for m in self._measured], pa.float32()),
            pa.array([m.mean_depth for m in self._measured], pa.float32()),
            pa.array(shares, pa.float32()),
            pa.array([None if share is None else share >= TARGET_SEEN for share in shares], pa.bool_()),
        ]
        return pa.Table.from_arrays(columns, schema=FRAME_SCHEMA)

    @property
    def _encoders(self) -> list["_Encoder"]:
        return [self._rgb, self._depth, *([self._instances] if self._instances is not None else [])]

    def _look_at(self, picture: Rendering, camera: Camera) -> np.ndarray:
        """Measure a picture, and make its depth ready to be kept: (H, W) uint16 millimetres."""
        millimetres = depth_to_millimetres(picture.depth)
        returns = int(np.count_nonzero(millimetres))
        target = self.path.target
        self._measured.append(
            Measured(
                float(np.count_nonzero(picture.alpha >= MIN_ALPHA_FOR_DEPTH)) / picture.alpha.size,
                float(millimetres.sum(dtype=np.uint64)) / returns / 1000 if returns else 0.0,
                None if target is None else seen_share(picture.depth, camera, target),
            )
        )
        return millimetres


class _Encoder:
    """A video writer on a thread of its own, which starts with the first picture."""

    def __init__(self, writer: FrameWriter) -> None:
        self._writer = writer
        self._pool: ThreadPoolExecutor | None = None
        self._pending: deque[Future[Any]] = deque()
        self._written = 0, 0  # size and checksum of the file

    def append(self, make: Callable[[], np.ndarray]) -> None:
        """Encode what ``make`` makes, both on the thread; raises what went wrong with an earlier picture."""
        if self._pool is None:
            self._pool = ThreadPoolExecutor(1, "encoder")
            self._pending.append(self._pool.submit(self._writer.open))
        while len(self._pending) >= QUEUE:
            self._pending.popleft().result()
        self._pending.append(self._pool.submit(lambda: self._writer.append(make())))

    def end(self) -> None:
        """No more pictures; does not wait."""
        if self._pool is not None:
            self._pending.append(self._pool.submit(self._writer.close))
            self._pending.append(self._pool.submit(self._take_checksum))
            self._pool.shutdown(wait=False)

    def file(self, root: Path) -> VideoFile:
        """Wait for the whole file."""
        while self._pending:
            self._pending.popleft().result()
        return VideoFile(self._writer.path.relative_to(root).as_posix(), *self._written)

    def _take_checksum(self) -> None:
        content = self._writer.path.read_bytes()
        self._written = len(content), zlib.crc32(content)

    def abandon(self) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
        self._writer.abandon()
