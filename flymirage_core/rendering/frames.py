"""`Frames`, the product of the `frames` asset: for each flight an RGB video, a depth video and a pose a frame.

Layout: ``<flight_id:04d>/rgb.mp4`` (H.264), ``<flight_id:04d>/depth.zip`` (lossless JPEG XL, 16-bit millimetres, 0 = no
return), if asked for ``<flight_id:04d>/instances.zip`` (the same, object_id + 1, 0 = no object) and the same files in
``<flight_id:04d>/left``, ``back`` and ``right``; ``frames.parquet`` (`FRAME_SCHEMA`, a row a frame), ``camera.json``
(intrinsics, T_body_camera, frame rate), ``videos.json`` (sizes and checksums). Nothing is decoded before it is asked
for. `recording` makes it.
"""

import json
import math
import zlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
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
from flymirage_core.rendering.image_stack import read_images, read_images_at
from flymirage_core.rendering.instances import OrientedBoxes
from flymirage_core.rendering.video import read_rgb, read_rgb_at
from flymirage_core.settings import FrameSettings

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
        ("target_share", pa.float32()),  # share of pixels that show the flight's target; null if it has none
        ("target_in_view", pa.bool_()),  # is that share at least `TARGET_SEEN`?
    ]
)

VIDEOS = ("rgb.mp4", "depth.zip")
SIDES = {"left": 90.0, "back": 180.0, "right": 270.0}
"""Where the other three cameras of a surround rig look: degrees about the body's z from where the first one looks."""
TARGET_SEEN = 5e-4
"""Share of the pixels from which on a target counts as in view: 12 x 12 of 640 x 480."""


@dataclass(frozen=True)
class CameraRig:
    """The drone's camera: intrinsics, where it sits on the body (FLU), its frame rate in Hz, and others beside it."""

    intrinsics: Intrinsics
    T_body_camera: tuple[tuple[float, ...], ...]  # 4x4, camera (OpenCV) to body (FLU)
    frame_rate: float
    sides: tuple[str, ...] = ()  # names in `SIDES` of like cameras that look elsewhere

    def looking(self, side: str) -> "CameraRig":
        """The camera of that name in `SIDES` alone. Raises `InputError` if the rig has none."""
        if side not in self.sides:
            raise InputError(f"the rig has no camera that looks {side}; set frames.surround and film again")
        turned = np.eye(4)
        turned[:3, :3] = Rotation.from_euler("z", SIDES[side], degrees=True).as_matrix()
        pose = turned @ np.array(self.T_body_camera)
        return replace(self, T_body_camera=tuple(tuple(row) for row in pose.tolist()), sides=())

    def save(self, path: Path) -> None:
        path.write_text(json.dumps(asdict(self), indent=2) + "\n")

    @staticmethod
    def load(path: Path) -> "CameraRig":
        data = json.loads(path.read_text())
        rows = tuple(tuple(float(x) for x in row) for row in data["T_body_camera"])
        return CameraRig(Intrinsics(**data["intrinsics"]), rows, data["frame_rate"], tuple(data["sides"]))


@dataclass(frozen=True, eq=False)
class BodyPath:
    """Where the drone is at each frame of one flight. World frame, metres, seconds; body FLU."""

    flight_id: int
    times: Float64  # (T,)
    positions: Float64  # (T, 3)
    quaternions: Float64  # (T, 4) xyzw, body to world
    target: OrientedBoxes | None = None  # (1,) what the flight flies to, if that is known


@dataclass(frozen=True)
class VideoFile:
    """A video's path within the product, its size, and its checksum."""

    path: str
    bytes: int
    crc32: int


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

    def looking(self, side: str) -> "FlightFrames":
        """The same flight through the camera "left", "back" or "right", whose share of the target nobody measured.

        Raises `InputError` if it was not filmed.
        """
        rig = self.rig.looking(side)
        T_front_side = np.linalg.inv(self.rig.T_body_camera) @ np.array(rig.T_body_camera)
        poses = np.array([camera.T_world_camera @ T_front_side for camera in self.cameras()])  # (T, 4, 4)
        table = self.table[["flight_id", "frame_index", "time"]].assign(
            position=list(poses[:, :3, 3]), quaternion=list(Rotation.from_matrix(poses[:, :3, :3]).as_quat())
        )
        return FlightFrames(self.flight_id, self.folder / side, rig, table)

    def rgb(self) -> Iterator[NDArray[np.uint8]]:
        """Pictures (H, W, 3), in order. Raises `ProductError` if the video is missing, torn or short."""
        return read_rgb(self.folder / "rgb.mp4", len(self))

    def rgb_at(self, indices: Iterable[int]) -> list[NDArray[np.uint8]]:
        """The pictures at ``indices``, without decoding all that come before. Errors as in `rgb`."""
        return read_rgb_at(self.folder / "rgb.mp4", indices)

    def depth_at(self, indices: Iterable[int]) -> list[NDArray[np.uint16]]:
        """The depth frames at ``indices``. Errors as in `rgb`."""
        return read_images_at(self.folder / "depth.zip", indices)

    def instances(self) -> Iterator[NDArray[np.uint16]]:
        """Object numbers (H, W), in order: ``object_id + 1``, 0 = none. Raises `ProductError` if there is no video."""
        return read_images(self.folder / "instances.zip", len(self))

    def depth(self) -> Iterator[NDArray[np.uint16]]:
        """Depth (H, W) in millimetres, in order; 0 = no return. Raises `ProductError` as `rgb` does."""
        return read_images(self.folder / "depth.zip", len(self))


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
        return FlightFrames(flight_id, flight_folder(self.folder, flight_id), self.rig, rows)

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
        """A handle on a saved folder.

        Raises `ProductError` if its table or its camera is torn, frames are missing from a flight, or a video is
        missing or cut short. A video that is damaged but of its full size is found by `check`.
        """
        try:
            rig = CameraRig.load(folder / "camera.json")
            table = pq.read_table(folder / "frames.parquet", schema=FRAME_SCHEMA, page_checksum_verification=True)
            videos = _load_video_files(folder)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ProductError(f"{folder} is no whole `frames` product ({error}); materialise it again") from error
        frames = Frames(folder, rig, table.to_pandas())
        frames._check_index({video.path for video in videos})
        for video in videos:
            path = folder / video.path
            size = path.stat().st_size if path.is_file() else None
            if size != video.bytes:
                found = "is missing" if size is None else f"has {size} bytes, {video.bytes} were written"
                raise ProductError(f"{path} {found}; materialise `frames` again")
        return frames

    def check(self) -> None:
        """Read every video's bytes once; raises `ProductError` if any is not what was written."""
        for video in _load_video_files(self.folder):
            path = self.folder / video.path
            if not path.is_file() or zlib.crc32(path.read_bytes()) != video.crc32:
                raise ProductError(f"{path} is damaged: its checksum is wrong; materialise `frames` again")

    def _check_index(self, videos: set[str]) -> None:
        """Every flight's frames are numbered 0, 1, 2, ... and each of its cameras has both of its videos."""
        for flight_id in self.flight_ids:
            rows = self.table["frame_index"][self.table["flight_id"] == flight_id]
            if rows.tolist() != list(range(len(rows))):
                raise ProductError(
                    f"{self.folder / 'frames.parquet'}: flight {flight_id} has {len(rows)} rows that are not numbered "
                    f"from 0 to {len(rows) - 1}; materialise `frames` again"
                )
            folder = flight_folder(Path(), flight_id)
            for path in (at / name for at in (folder, *(folder / s for s in self.rig.sides)) for name in VIDEOS):
                if path.as_posix() not in videos:
                    raise ProductError(
                        f"{self.folder / 'videos.json'} does not know {path}; materialise `frames` again"
                    )


def save_video_files(folder: Path, videos: list[VideoFile]) -> None:
    """Write ``videos.json``."""
    text = json.dumps([asdict(video) for video in sorted(videos, key=lambda v: v.path)], indent=0)
    (folder / "videos.json").write_text(text + "\n")


def _load_video_files(folder: Path) -> list[VideoFile]:
    return [VideoFile(**entry) for entry in json.loads((folder / "videos.json").read_text())]


def camera_rig(settings: FrameSettings) -> CameraRig:
    """A camera in the body's centre that looks along its x axis, tilted by ``pitch_deg``; more with ``surround``."""
    T_body_camera = np.eye(4)
    nose_down = Rotation.from_euler("y", math.radians(settings.pitch_deg))  # y is left: positive lowers the nose
    T_body_camera[:3, :3] = nose_down.as_matrix() @ LEVEL_CAMERA
    fov = math.radians(settings.horizontal_fov_deg)
    intrinsics = Intrinsics.from_horizontal_fov(settings.width, settings.height, fov)
    sides = tuple(SIDES) if settings.surround else ()
    return CameraRig(intrinsics, tuple(tuple(row) for row in T_body_camera.tolist()), settings.rate, sides)


def cameras_along(path: BodyPath, rig: CameraRig) -> list[Camera]:
    """The drone's camera at each frame of a flight."""
    poses = _poses_from(path.positions, path.quaternions) @ np.array(rig.T_body_camera)  # (T, 4, 4)
    return [Camera(rig.intrinsics, pose) for pose in poses]


def flight_folder(folder: Path, flight_id: int) -> Path:
    """Where a flight's videos are."""
    return folder / f"{flight_id:04d}"


def _poses_from(positions: Float64, quaternions: Float64) -> Float64:
    """Homogeneous poses (T, 4, 4) of ``positions`` (T, 3) and ``quaternions`` (T, 4) xyzw."""
    poses = np.tile(np.eye(4), (len(positions), 1, 1))
    if len(positions):
        poses[:, :3, :3] = Rotation.from_quat(quaternions).as_matrix()
        poses[:, :3, 3] = positions
    return poses
