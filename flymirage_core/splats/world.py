"""`World`, the product of the `world` asset: a cleaned splat cloud in the metric z-up frame, and its centre c."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flymirage_core.splats.cloud import GaussianCloud


@dataclass(frozen=True)
class World:
    """A place to fly in: Gaussians (world frame, z up, metres, ground near z = 0), and the scene centre c.

    ``notes`` tells how the frame was found (source of scale, up axis and floor) and what cleaning removed.
    """

    cloud: GaussianCloud
    centre: NDArray[np.float64]  # (3,) the paper's c: Marble's panorama origin, in free space
    notes: dict[str, Any] = field(default_factory=dict)
    collider: Path | None = None  # GLB in the same frame, if the source has one

    def summary(self) -> dict[str, str | int | float]:
        return {"gaussians": len(self.cloud), "sh_degree": self.cloud.sh_degree, **self.notes}

    def save(self, folder: Path) -> None:
        """``world.ply`` (standard 3DGS, read by SuperSplat and gsplat), ``world.json``, ``collider.glb`` if there is one."""
        raise NotImplementedError

    @staticmethod
    def load(folder: Path) -> "World":
        raise NotImplementedError
