"""Filming flights: rendering, encoding and writing overlap, and no more than a few pictures are ever held.

What can be done to a picture alone (its colours to yuv420p, its depth to an image, measuring) is done by the
rasterizer's `develop`, on the thread that rendered it; the caller's thread encodes the videos, where order matters, and
writes. The files are the same bytes whatever the number of threads.
"""

import zlib
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.errors import ProductError
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
from flymirage_core.rendering.image_stack import ImageStackWriter, jpeg_xl
from flymirage_core.rendering.instances import OrientedBoxes, instance_ids, seen_share
from flymirage_core.rendering.rasterizer import MIN_ALPHA_FOR_DEPTH, Rasterizer, Rendering
from flymirage_core.rendering.video import VideoWriter, yuv420p
from flymirage_core.rendering.views import depth_to_millimetres
from flymirage_core.splats.cloud import GaussianCloud


def record_frames(
    cloud: GaussianCloud,
    paths: Sequence[BodyPath],
    rig: CameraRig,
    rasterizer: Rasterizer,
    folder: Path,
    objects: OrientedBoxes | None = None,
) -> Frames:
    """Film every flight into ``folder``; if ``objects`` are given, with pictures of which one each pixel shows.

    ``frames.parquet`` is written last. Raises `InputError` if the picture's size cannot be a video's, `ProductError` if
    the rasterizer stops early.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rig.save(folder / "camera.json")
    fronts = [
        _Film(folder, flight_folder(folder, path.flight_id), path, rig, objects) for path in paths if len(path.times)
    ]
    films = [film for front in fronts for film in (front, *front.beside())]
    order = [(film, index) for film in films for index in range(len(film.cameras))]
    developed = rasterizer.develop(
        cloud, [film.cameras[i] for film, i in order], lambda n, picture: order[n][0].develop(order[n][1], picture)
    )
    try:
        with closing(developed):
            for done, (film, _) in enumerate(order):
                frame = next(developed, None)
                if frame is None:
                    raise ProductError(f"{folder}: the rasterizer gave {done} pictures, {len(order)} were asked for")
                film.append(frame)
    finally:
        for film in films:
            film.abandon()
    save_video_files(folder, [file for film in films for file in film.files])
    table = pa.concat_tables([FRAME_SCHEMA.empty_table(), *(film.rows() for film in fronts)])
    pq.write_table(table, folder / "frames.parquet", write_page_checksum=True)
    return Frames(folder, rig, table.to_pandas())


@dataclass(frozen=True)
class Measured:
    """What is known of a picture besides its pose."""

    alpha_coverage: float  # share of the pixels
    mean_depth: float  # metres, z-depth
    target_share: float | None  # share of the pixels


@dataclass(frozen=True, eq=False)
class Developed:
    """A picture as it is written, and what is known of it."""

    planes: NDArray[np.uint8]  # (H 3/2, W) yuv420p
    depth: bytes  # an image of millimetres
    instances: bytes | None  # an image of object numbers
    measured: Measured


class _Film:
    """One flight's videos in the making, through one camera, and its rows of `FRAME_SCHEMA`."""

    def __init__(self, root: Path, at: Path, path: BodyPath, rig: CameraRig, objects: OrientedBoxes | None) -> None:
        self.path, self.files = path, list[VideoFile]()
        self.cameras = cameras_along(path, rig)
        self._root, self._at, self._rig, self._objects, self._measured = root, at, rig, objects, list[Measured]()
        self._rgb = VideoWriter(at / "rgb.mp4", rig.frame_rate)
        self._depth = ImageStackWriter(at / "depth.zip")
        self._instances = ImageStackWriter(at / "instances.zip")

    def beside(self) -> Iterator["_Film"]:
        """The films of the rig's other cameras, for which nobody measures the target."""
        for side in self._rig.sides:
            path, rig = replace(self.path, target=None), self._rig.looking(side)
            yield _Film(self._root, self._at / side, path, rig, self._objects)

    def develop(self, index: int, picture: Rendering) -> Developed:
        """Make the picture of camera ``index`` ready to be written, and measure it; several threads do so at once."""
        camera, objects, target = self.cameras[index], self._objects, self.path.target
        millimetres = depth_to_millimetres(picture.depth)  # (H, W)
        returns = cv2.countNonZero(millimetres)
        measured = Measured(
            float(np.count_nonzero(picture.alpha >= MIN_ALPHA_FOR_DEPTH)) / picture.alpha.size,
            float(cv2.sumElems(millimetres)[0]) / returns / 1000 if returns else 0.0,
            None if target is None else seen_share(picture.depth, camera, target),
        )
        instances = None if objects is None else jpeg_xl(instance_ids(picture.depth, camera, objects))
        return Developed(yuv420p(picture.rgb), jpeg_xl(millimetres), instances, measured)

    def append(self, frame: Developed) -> None:
        """Write the next picture; with the last one the files are whole."""
        if not self._measured:
            for writer in self._writers:
                writer.open()
        self._measured.append(frame.measured)
        self._rgb.append_planes(frame.planes)
        self._depth.append_image(frame.depth)
        if frame.instances is not None:
            self._instances.append_image(frame.instances)
        if len(self._measured) == len(self.cameras):
            for writer in self._writers:
                writer.close()
            self.files = [self._written(writer.path) for writer in self._writers]

    def abandon(self) -> None:
        """Let go of the files, whether they are whole or not."""
        for writer in self._writers:
            writer.abandon()

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
    def _writers(self) -> list[FrameWriter]:
        return [self._rgb, self._depth, *([self._instances] if self._objects is not None else [])]

    def _written(self, path: Path) -> VideoFile:
        content = path.read_bytes()
        return VideoFile(path.relative_to(self._root).as_posix(), len(content), zlib.crc32(content))
