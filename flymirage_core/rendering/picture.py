"""`ScenePicture`, the product of the `image` asset: one picture of the scene, and what made it."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import ProductError


@dataclass(frozen=True, eq=False)
class ScenePicture:
    """An RGB picture, kept losslessly as PNG: an image model's answer cannot be asked for twice."""

    rgb: NDArray[np.uint8]  # (H, W, 3)
    painter: str  # "offline 1", "rendered view of the import", "gpt-image-2"

    def summary(self) -> dict[str, str | int | float]:
        return {"width": self.rgb.shape[1], "height": self.rgb.shape[0], "painter": self.painter}

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        if not cv2.imwrite(str(folder / "image.png"), self.rgb[:, :, ::-1]):
            raise ProductError(f"{folder / 'image.png'} could not be written; is the disk full?")
        (folder / "painter.txt").write_text(self.painter + "\n")

    @staticmethod
    def load(folder: Path) -> "ScenePicture":
        image = cv2.imread(str(folder / "image.png"), cv2.IMREAD_COLOR)
        if image is None:
            raise ProductError(f"{folder / 'image.png'} is missing or torn; materialise `image` again")
        return ScenePicture(np.ascontiguousarray(image[:, :, ::-1]), (folder / "painter.txt").read_text().strip())
