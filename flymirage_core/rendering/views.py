"""`PosedViews`, the product of both render assets: a folder of posed RGB-D pictures that are decoded when asked for."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pandas as pd

from flymirage_core.errors import ProductError
from flymirage_core.files import link_tree
from flymirage_core.rendering import picture_kernels
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.rasterizer import Rendering

DEPTH_UNIT = 0.001
"""Depth is stored as 16-bit millimetres; 0 = no return, 65.535 m the farthest that can be stored."""


def depth_to_millimetres(depth: np.ndarray) -> np.ndarray:
    """float32 metres (H, W) -> uint16 millimetres (H, W), rounded; what is not finite or too far becomes 0."""
    millimetres = np.empty(depth.shape, np.uint16)
    picture_kernels.millimetres(np.ascontiguousarray(depth, np.float32).ravel(), millimetres.reshape(-1))
    return millimetres


@dataclass(frozen=True, eq=False)
class View:
    """One posed picture."""

    camera: Camera
    picture: Rendering


@dataclass(frozen=True, eq=False)
class PosedViews:
    """Posed RGB-D views on disk: ``views[i]`` decodes one, iterating streams them all.

    ``groups`` (one string a view) tells which orbit elevation or exploration target a view belongs to.
    """

    folder: Path
    cameras: tuple[Camera, ...]
    groups: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.cameras)

    def __getitem__(self, index: int) -> View:
        return View(self.cameras[index], read_picture(self.folder, index))

    def __iter__(self) -> Iterator[View]:
        return (self[i] for i in range(len(self)))

    def summary(self) -> dict[str, int | float]:
        return {"views": len(self), "groups": len(set(self.groups))}

    @staticmethod
    def write(
        folder: Path, cameras: Iterable[Camera], pictures: Iterable[Rendering], groups: Iterable[str]
    ) -> "PosedViews":
        """Write pictures as they come; the returned handle reads from ``folder``."""
        folder.mkdir(parents=True, exist_ok=True)
        cameras, groups = tuple(cameras), tuple(groups)
        for i, picture in enumerate(pictures):
            write_picture(folder, i, picture)
        rows = [
            {"group": g, **vars(c.intrinsics), "T_world_camera": c.T_world_camera.ravel().tolist()}
            for c, g in zip(cameras, groups, strict=True)
        ]
        columns = ["group", "width", "height", "fx", "fy", "cx", "cy", "T_world_camera"]
        pd.DataFrame(rows, columns=columns).to_parquet(folder / "views.parquet", index=False)
        return PosedViews(folder, cameras, groups)

    def save(self, folder: Path) -> None:
        """Copy to ``folder`` (by hard link where the file system can)."""
        link_tree(self.folder, folder)

    @staticmethod
    def load(folder: Path) -> "PosedViews":
        """A handle on a saved folder; raises `ProductError` if its table is missing or torn."""
        try:
            table = pd.read_parquet(folder / "views.parquet")
        except (OSError, ValueError) as error:
            raise ProductError(f"{folder / 'views.parquet'} is missing or torn; materialise the views again") from error
        cameras = tuple(
            Camera(
                Intrinsics(r["width"], r["height"], r["fx"], r["fy"], r["cx"], r["cy"]),
                np.array(r["T_world_camera"], float).reshape(4, 4),
            )
            for r in table.to_dict("records")
        )
        return PosedViews(folder, cameras, tuple(table["group"]))


def write_picture(folder: Path, index: int, picture: Rendering) -> None:
    """RGB as JPEG (quality 95), depth as 16-bit PNG in millimetres, alpha as 8-bit PNG."""
    stem = f"{index:04d}"
    _write(folder / f"{stem}_rgb.jpg", picture.rgb[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, 95])
    _write(folder / f"{stem}_depth.png", depth_to_millimetres(picture.depth), [cv2.IMWRITE_PNG_COMPRESSION, 1])
    _write(
        folder / f"{stem}_alpha.png", np.rint(picture.alpha * 255).astype(np.uint8), [cv2.IMWRITE_PNG_COMPRESSION, 1]
    )


def read_picture(folder: Path, index: int) -> Rendering:
    """The picture that `write_picture` wrote; raises `ProductError` if a file is missing or torn."""
    stem = f"{index:04d}"
    rgb = _read(folder / f"{stem}_rgb.jpg", cv2.IMREAD_COLOR)[:, :, ::-1]
    depth = _read(folder / f"{stem}_depth.png", cv2.IMREAD_UNCHANGED)
    alpha = _read(folder / f"{stem}_alpha.png", cv2.IMREAD_UNCHANGED)
    return Rendering(
        np.ascontiguousarray(rgb),
        depth.astype(np.float32) * np.float32(DEPTH_UNIT),
        alpha.astype(np.float32) / np.float32(255),
    )


def _write(path: Path, image: np.ndarray, options: list[int]) -> None:
    if not cv2.imwrite(str(path), image, options):
        raise ProductError(f"{path} could not be written; is the disk full?")


def _read(path: Path, mode: int) -> np.ndarray:
    image = cv2.imread(str(path), mode)
    if image is None:
        raise ProductError(f"{path} is missing or torn; delete the product's folder and materialise it again")
    return image
