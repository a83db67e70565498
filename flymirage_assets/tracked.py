"""A rasterizer that tells how far it is."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from flymirage_core.progress import track
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.rasterizer import Rasterizer, Rendering
from flymirage_core.splats.cloud import GaussianCloud


@dataclass(frozen=True)
class TrackedRasterizer:
    """Reports each picture of ``inner`` to the progress listener, counted as ``what``."""

    inner: Rasterizer
    what: str

    @property
    def name(self) -> str:
        return self.inner.name

    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]:
        return track(self.inner.render(cloud, cameras), self.what, len(cameras))
