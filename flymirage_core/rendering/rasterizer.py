"""What every renderer takes and gives."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.threads import in_order, usable_cores
from flymirage_core.splats.cloud import GaussianCloud

P = TypeVar("P")

MIN_ALPHA_FOR_DEPTH = 0.5
"""Below this alpha the expected depth mixes too much of nothing: depth is written as 0, no return."""


@dataclass(frozen=True, eq=False)
class Rendering:
    """One picture: colour, expected z-depth ``sum(w z) / sum(w)`` in metres, and accumulated opacity."""

    rgb: NDArray[np.uint8]  # (H, W, 3)
    depth: NDArray[np.float32]  # (H, W) metres, z-depth, 0 = no return (alpha < 0.5)
    alpha: NDArray[np.float32]  # (H, W) in [0, 1]


class Rasterizer(ABC):
    """Renders a cloud from many cameras; answers in the cameras' order, lazily, so that frames can be streamed."""

    name: str

    @abstractmethod
    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]:
        """One picture for each camera."""

    def develop(
        self, cloud: GaussianCloud, cameras: Sequence[Camera], finish: Callable[[int, Rendering], P]
    ) -> Generator[P, None, None]:
        """What ``finish`` makes of each camera's number and picture, on several threads at once, in order.

        Work on finished pictures goes here rather than into the loop that reads `render`, which has one thread.
        """
        pictures = enumerate(self.render(cloud, cameras))
        return in_order(lambda numbered: finish(*numbered), pictures, usable_cores())
