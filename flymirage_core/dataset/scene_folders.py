"""What the simpler formats share: a scene's files are its own, linked when unchanged; pictures, poses, checks."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.dataset.export_folder import Placed, Shard, common_files, link_files
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.dataset.statistics import SceneShare
from flymirage_core.errors import ProductError
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.rendering.frames import CameraRig

JPEG_QUALITY = 95
PNG_COMPRESSION = 1
"""zlib level: 3 takes twice as long for a twentieth less."""


class SceneFolders:
    """The parts of `ExportFormat` that are alike wherever no number runs over all scenes."""

    @property
    def options(self) -> dict[str, Any]:
        return {}

    def admit(self, rigs: Iterable[tuple[str, CameraRig]]) -> None:
        """Every scene has a folder, and so a camera, of its own."""

    def keep(self, source: Path, folder: Path, shard: Shard, before: list[Shard]) -> Placed:
        names = [name for name in shard.files if name not in common_files(shard.scene)]
        link_files(source, folder, names)
        return Placed(shard.place, names)

    def header(self, shares: tuple[SceneShare, ...]) -> str:
        return ""


def flight_of(products: SceneProducts, flight_id: int) -> Flight:
    return next(f for f in products.trajectories if f.flight_id == flight_id)


def write_jpeg(path: Path, rgb: NDArray[np.uint8]) -> None:
    _write(path, jpeg_bytes(rgb))


def write_png16(path: Path, depth: NDArray[np.uint16]) -> None:
    _write(path, png16_bytes(depth))


def jpeg_bytes(picture: NDArray[np.uint8]) -> bytes:
    """Of RGB (H, W, 3) or grey (H, W)."""
    bgr = picture[:, :, ::-1] if picture.ndim == 3 else picture
    return _encoded(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])


def png16_bytes(depth: NDArray[np.uint16]) -> bytes:
    return _encoded(".png", depth, [cv2.IMWRITE_PNG_COMPRESSION, PNG_COMPRESSION])


def read_png16(path: Path) -> NDArray[np.uint16]:
    """Raises `ProductError` if it is missing or torn."""
    return png16_from(path.read_bytes() if path.exists() else b"", str(path))


def png16_from(data: bytes, where: str) -> NDArray[np.uint16]:
    """Depth (H, W) in millimetres; raises `ProductError` that names ``where`` if it is no 16-bit PNG."""
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED) if data else None
    if image is None or image.dtype != np.uint16:
        raise ProductError(f"{where} is missing or no 16-bit PNG; export again")
    return image.astype(np.uint16)


def _encoded(kind: str, picture: NDArray[Any], options: list[int]) -> bytes:
    ok, data = cv2.imencode(kind, picture, options)
    if not ok:
        raise ProductError(f"a picture of shape {picture.shape} could not be written as {kind}")
    return data.tobytes()


def _write(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
