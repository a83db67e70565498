"""The rasterizer's protocol: what every back end takes and gives."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera
from flymirage_core.splats.cloud import GaussianCloud

MIN_ALPHA_FOR_DEPTH = 0.5
"""Below this alpha the expected depth mixes too much of nothing: depth is written as 0, no return."""


@dataclass(frozen=True, eq=False)
class Rendering:
    """One picture: colour, expected z-depth ``sum(w z) / sum(w)`` in metres, and accumulated opacity."""

    rgb: NDArray[np.uint8]  # (H, W, 3)
    depth: NDArray[np.float32]  # (H, W) metres, z-depth, 0 = no return (alpha < 0.5)
    alpha: NDArray[np.float32]  # (H, W) in [0, 1]


class Rasterizer(Protocol):
    """Renders a cloud from many cameras; answers in the cameras' order, lazily, so that frames can be streamed."""

    @property
    def name(self) -> str: ...

    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]: ...
