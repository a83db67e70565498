"""`World`, the product of the `world` asset: a cleaned splat cloud in the metric z-up frame, and its centre c."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import ProductError, WorldError
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import read_cloud, write_ply

SCHEMA: Final = 1
PANORAMA_QUALITY: Final = 92
"""Of the panorama's JPEG: it is looked at, never measured."""


@dataclass(frozen=True)
class World:
    """A place to fly in: Gaussians (world frame, z up, metres, ground near z = 0), and the scene centre c.

    ``notes`` tells how the frame was found (source of scale, up axis and floor) and what cleaning removed.
    """

    cloud: GaussianCloud
    centre: NDArray[np.float64]  # (3,) the paper's c: Marble's panorama origin, in free space
    notes: dict[str, Any] = field(default_factory=dict)
    collider: bytes | None = None  # a GLB of this frame, metres; `splats.collider` turns its y up to z up
    panorama: NDArray[np.uint8] | None = None  # (H, 2H, 3) all round c: its middle column looks along +y, left is -x

    def summary(self) -> dict[str, str | int | float]:
        return {"gaussians": len(self.cloud), "sh_degree": self.cloud.sh_degree, **self.notes}

    def save(self, folder: Path) -> None:
        """``world.ply`` (3DGS, as SuperSplat and gsplat read it), ``world.json``.

        Where there are such, ``collider.glb`` and ``panorama.jpg`` (lossy: loading gives nearly the same picture).

        Raises:
            ProductError: the panorama cannot be written.
        """
        folder.mkdir(parents=True, exist_ok=True)
        write_ply(self.cloud, folder / "world.ply")
        if self.collider is not None:
            (folder / "collider.glb").write_bytes(self.collider)
        if self.panorama is not None:
            path = folder / "panorama.jpg"
            if not cv2.imwrite(str(path), self.panorama[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, PANORAMA_QUALITY]):
                raise ProductError(f"{path} could not be written; is the disk full?")
        document = {"schema": SCHEMA, "centre": [float(x) for x in self.centre], "notes": self.notes}
        (folder / "world.json").write_text(json.dumps(document, indent=2, sort_keys=True) + "\n", encoding="utf-8")

    @staticmethod
    def load(folder: Path) -> "World":
        """Read back what `save` wrote; raises `ProductError` if it is not whole or of another schema."""
        try:
            document = json.loads((folder / "world.json").read_text(encoding="utf-8"))
            schema = document["schema"]
            if schema != SCHEMA:
                raise ProductError(
                    f"{folder}: the world has schema {schema!r}, this code reads {SCHEMA}; make it again"
                )
            centre, notes = np.array(document["centre"], np.float64), dict(document["notes"])
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ProductError(f"{folder}: world.json is missing or torn ({error}); make the world again") from error
        try:
            cloud = read_cloud(folder / "world.ply")
        except WorldError as error:
            raise ProductError(f"{error}; make the world again") from error
        collider = folder / "collider.glb"
        return World(cloud, centre, notes, collider.read_bytes() if collider.exists() else None, _panorama(folder))


def _panorama(folder: Path) -> NDArray[np.uint8] | None:
    path = folder / "panorama.jpg"
    if not path.exists():
        return None
    image = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if image is None:
        raise ProductError(f"{path} is torn; make the world again")
    return np.ascontiguousarray(image[:, :, ::-1], np.uint8)
