"""`Frames`, the product of the `frames` asset: for each flight an RGB video, a depth video and a pose a frame.

Layout: ``<flight_id:04d>/rgb.mp4`` (H.264), ``<flight_id:04d>/depth.mkv`` (FFV1, 16-bit millimetres, 0 = no return),
``frames.parquet`` (flight_id, frame_index, time, position, quaternion xyzw of the camera's optical
frame, alpha_coverage, mean_depth), ``camera.json`` (intrinsics, T_body_camera, frame rate). Nothing is decoded before it is
asked for.
"""

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from flymirage_core.files import link_tree
from flymirage_core.rendering.camera import Camera, Intrinsics


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
class FlightFrames:
    """The frames of one flight; videos are decoded when iterated."""

    flight_id: int
    folder: Path
    rig: CameraRig
    table: pd.DataFrame  # frame_index, time, position, quaternion, alpha_coverage

    def __len__(self) -> int:
        return len(self.table)

    def cameras(self) -> list[Camera]:
        """World pose of the optical frame at every frame."""
        raise NotImplementedError

    def rgb(self) -> Iterator[NDArray[np.uint8]]:
        """Pictures (H, W, 3), in order."""
        raise NotImplementedError

    def depth(self) -> Iterator[NDArray[np.uint16]]:
        """Depth (H, W) in millimetres, in order; 0 = no return."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class Frames:
    """All flights' frames of a scene: a handle on a folder."""

    folder: Path
    rig: CameraRig
    table: pd.DataFrame

    def flight(self, flight_id: int) -> FlightFrames:
        rows = self.table[self.table["flight_id"] == flight_id].reset_index(drop=True)
        return FlightFrames(flight_id, self.folder / f"{flight_id:04d}", self.rig, rows)

    @property
    def flight_ids(self) -> list[int]:
        return sorted(int(i) for i in self.table["flight_id"].unique())

    def summary(self) -> dict[str, str | int | float]:
        return {"flights": len(self.flight_ids), "frames": len(self.table)}

    def save(self, folder: Path) -> None:
        link_tree(self.folder, folder)

    @staticmethod
    def load(folder: Path) -> "Frames":
        return Frames(folder, CameraRig.load(folder / "camera.json"), pd.read_parquet(folder / "frames.parquet"))
