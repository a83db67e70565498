"""`Frames`, the product of the `frames` asset: for each flight an RGB video, a depth video and a pose a frame.

Layout: ``<flight_id:04d>/rgb.mp4`` (H.264), ``<flight_id:04d>/depth.mkv`` (FFV1, 16-bit millimetres, 0 = no return),
``frames.parquet`` (`FRAME_SCHEMA`, a row a frame), ``camera.json`` (intrinsics, T_body_camera, frame rate). Nothing is
decoded before it is asked for.
"""

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.errors import InputError, ProductError
from flymirage_core.files import link_tree
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.rasterizer import MIN_ALPHA_FOR_DEPTH, Rasterizer, Rendering
from flymirage_core.rendering.video import depth_writer, read_depth, read_depth_at, read_rgb, read_rgb_at, rgb_writer
from flymirage_core.rendering.views import depth_to_millimetres
from flymirage_core.settings import FrameSettings
from flymirage_core.splats.cloud import GaussianCloud

Float64 = NDArray[np.float64]

LEVEL_CAMERA = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""R_body_camera (3, 3) of a camera that looks along the body's x: OpenCV's right, down and forward in body FLU."""

FRAME_SCHEMA = pa.schema(
    [
        ("flight_id", pa.int32()),
        ("frame_index", pa.int32()),  # within the flight, from 0
        ("time", pa.float64()),  # seconds from the flight's start
        ("position", pa.list_(pa.float64(), 3)),  # of the optical centre, world frame, metres
        ("quaternion", pa.list_(pa.float64(), 4)),  # xyzw, camera (OpenCV) to world
        ("alpha_coverage", pa.float32()),  # share of pixels with alpha >= 0.5
        ("mean_depth", pa.float32()),  # metres, over the pixels with a return; 0 if there is none
    ]
)


@dataclass(frozen=True)
class CameraRig:
    """The drone's camera: intrinsics, where it sits on the body (FLU), and its frame rate in Hz."""

    intrinsics: Intrinsics
    T_body_camera: tuple[tuple[float, ...], ...]  # 4x4, camera (OpenCV) to body (FLU)
    frame_rate: float

    def save(self, path: Path) -> None:
        path.write_text(json.dumps(asdict(self), indent=2) + "\n")

    @staticmethod
    def load(path: Path) -> "CameraRig":
        data = json.loads(path.read_text())
        rows = tuple(tuple(float(x) for x in row) for row in data["T_body_camera"])
        return CameraRig(Intrinsics(**data["intrinsics"]), rows, data["frame_rate"])


@dataclass(frozen=True, eq=False)
class BodyPath:
    """Where the drone is at each frame of one flight. World frame, metres, seconds; body FLU."""

    flight_id: int
    times: Float64  # (T,)
    positions: Float64  # (T, 3)
    quaternions: Float64  # (T, 4) xyzw, body to world


@dataclass(frozen=True, eq=False)
class FlightFrames:
    """The frames of one flight; videos are decoded when iterated."""

    flight_id: int
    folder: Path
    rig: CameraRig
    table: pd.DataFrame  # the flight's rows of `FRAME_SCHEMA`

    def __len__(self) -> int:
        return len(self.table)

    def cameras(self) -> list[Camera]:
        """World pose of the optical frame at every frame."""
        poses = _poses_from(np.array(self.table["position"].tolist()), np.array(self.table["quaternion"].tolist()))
        return [Camera(self.rig.intrinsics, pose) for pose in poses]

    def rgb(self) -> Iterator[NDArray[np.uint8]]:
        """Pictures (H, W, 3), in order. Raises `ProductError` if the video is missing, torn or short."""
        return read_rgb(self.folder / "rgb.mp4", len(self))

    def rgb_at(self, indices: Iterable[int]) -> list[NDArray[np.uint8]]:
        """The pictures at ``indices``, without decoding all that come before. Errors as in `rgb`."""
        return read_rgb_at(self.folder / "rgb.mp4", indices)

    def depth_at(self, indices: Iterable[int]) -> list[NDArray[np.uint16]]:
        """The depth frames at ``indices``. Errors as in `rgb`."""
        return read_depth_at(self.folder / "depth.mkv", indices)

    def depth(self) -> Iterator[NDArray[np.uint16]]:
        """Depth (H, W) in millimetres, in order; 0 = no return. Raises `ProductError` as `rgb` does."""
        return read_depth(self.folder / "depth.mkv", len(self))


@dataclass(frozen=True, eq=False)
class Frames:
    """All flights' frames of a scene: a handle on a folder."""

    folder: Path
    rig: CameraRig
    table: pd.DataFrame  # `FRAME_SCHEMA`

    def flight(self, flight_id: int) -> FlightFrames:
        rows = self.table[self.table["flight_id"] == flight_id].reset_index(drop=True)
        if rows.empty:
            raise InputError(f"flight {flight_id} has no frames; those that have are {self.flight_ids}")
        return FlightFrames(flight_id, _flight_folder(self.folder, flight_id), self.rig, rows)

    @property
    def flight_ids(self) -> list[int]:
        return sorted(int(i) for i in self.table["flight_id"].unique())

    def summary(self) -> Mapping[str, str | int | float]:
        return {"flights": len(self.flight_ids), "frames": len(self.table)}

    def save(self, folder: Path) -> None:
        """Give ``folder`` the same files, by hard link where the file system can."""
        if folder.resolve() != self.folder.resolve():
            link_tree(self.folder, folder)

    @staticmethod
    def load(folder: Path) -> "Frames":
        """A handle on a saved folder; raises `ProductError` if its table, its camera or a flight's video is missing."""
        try:
            rig = CameraRig.load(folder / "camera.json")
            table = pq.read_table(folder / "frames.parquet", schema=FRAME_SCHEMA).to_pandas()
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ProductError(f"{folder} is no whole `frames` product ({error}); materialise it again") from error
        frames = Frames(folder, rig, table)
        for flight_id in frames.flight_ids:
            for video in (_flight_folder(folder, flight_id) / name for name in ("rgb.mp4", "depth.mkv")):
                if not video.is_file():
                    raise ProductError(f"{video} is missing; materialise `frames` again")
        return frames


def camera_rig(settings: FrameSettings) -> CameraRig:
    """A camera in the body's centre that looks along its x axis, tilted down by ``pitch_deg``."""
    T_body_camera = np.eye(4)
    nose_down = Rotation.from_euler("y", math.radians(settings.pitch_deg))  # y is left: positive lowers the nose
    T_body_camera[:3, :3] = nose_down.as_matrix() @ LEVEL_CAMERA
    fov = math.radians(settings.horizontal_fov_deg)
    intrinsics = Intrinsics.from_horizontal_fov(settings.width, settings.height, fov)
    return CameraRig(intrinsics, tuple(tuple(row) for row in T_body_camera.tolist()), settings.rate)


def cameras_along(path: BodyPath, rig: CameraRig) -> list[Camera]:
    """The drone's camera at each frame of a flight."""
    poses = _poses_from(path.positions, path.quaternions) @ np.array(rig.T_body_camera)  # (T, 4, 4)
    return [Camera(rig.intrinsics, pose) for pose in poses]


def record_frames(
    cloud: GaussianCloud, paths: Sequence[BodyPath], rig: CameraRig, rasterizer: Rasterizer, folder: Path
) -> Frames:
    """Film every flight into ``folder``; only a few frames are ever held.

    All flights are one call of the rasterizer, which works ahead while this thread encodes. ``frames.parquet`` is
    written last. Raises `InputError` if the picture's size cannot be a video's.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rig.save(folder / "camera.json")
    cameras = [cameras_along(path, rig) for path in paths]
    pictures = rasterizer.render(cloud, [camera for along in cameras for camera in along])
    tables = [FRAME_SCHEMA.empty_table()]
    for path, along in zip(paths, cameras, strict=True):
        if along:
            measured = _film(_flight_folder(folder, path.flight_id), len(along), pictures, rig.frame_rate)
            tables.append(_rows(path, along, measured))
    table = pa.concat_tables(tables)
    pq.write_table(table, folder / "frames.parquet")
    return Frames(folder, rig, table.to_pandas())


def _film(folder: Path, count: int, pictures: Iterator[Rendering], rate: float) -> list[tuple[float, float]]:
    """Encode the next ``count`` pictures into a flight's two videos; (alpha coverage, mean depth) of each."""
    measured = []
    with rgb_writer(folder / "rgb.mp4", rate) as rgb, depth_writer(folder / "depth.mkv", rate) as depth:
        for index in range(count):
            picture = next(pictures, None)
            if picture is None:
                raise ProductError(f"{folder}: the rasterizer gave {index} pictures, {count} were asked for")
            rgb.append(picture.rgb)
            depth.append(depth_to_millimetres(picture.depth))
            returns = picture.depth[picture.depth > 0]
            coverage = float(np.mean(picture.alpha >= MIN_ALPHA_FOR_DEPTH))
            measured.append((coverage, float(returns.mean()) if len(returns) else 0.0))
    return measured


def _rows(path: BodyPath, cameras: list[Camera], measured: list[tuple[float, float]]) -> pa.Table:
    """A flight's rows of `FRAME_SCHEMA`."""
    poses = np.array([camera.T_world_camera for camera in cameras])  # (T, 4, 4)
    quaternions = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
    coverage, mean_depth = np.array(measured, np.float32).T
    columns = [
        pa.array(np.full(len(cameras), path.flight_id, np.int32)),
        pa.array(np.arange(len(cameras), dtype=np.int32)),
        pa.array(np.asarray(path.times, float)),
        pa.FixedSizeListArray.from_arrays(pa.array(poses[:, :3, 3].ravel()), 3),
        pa.FixedSizeListArray.from_arrays(pa.array(quaternions.ravel()), 4),
        pa.array(coverage),
        pa.array(mean_depth),
    ]
    return pa.Table.from_arrays(columns, schema=FRAME_SCHEMA)


def _flight_folder(folder: Path, flight_id: int) -> Path:
    """Where a flight's videos are."""
    return folder / f"{flight_id:04d}"


def _poses_from(positions: Float64, quaternions: Float64) -> Float64:
    """Homogeneous poses (T, 4, 4) of ``positions`` (T, 3) and ``quaternions`` (T, 4) xyzw."""
    poses = np.tile(np.eye(4), (len(positions), 1, 1))
    if len(positions):
        poses[:, :3, :3] = Rotation.from_quat(quaternions).as_matrix()
        poses[:, :3, 3] = positions
    return poses
