"""A rasterizer that tells how far it is."""

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing
from typing import TypeVar

from flymirage_core.progress import track
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.rasterizer import Rasterizer, Rendering
from flymirage_core.splats.cloud import GaussianCloud

P = TypeVar("P")


class TrackedRasterizer(Rasterizer):
    """Reports each picture of ``inner`` to the progress listener, counted as ``what``."""

    def __init__(self, inner: Rasterizer, what: str) -> None:
        self.name, self._inner, self._what = inner.name, inner, what

    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]:
        return track(self._inner.render(cloud, cameras), self._what, len(cameras))

    def develop(
        self, cloud: GaussianCloud, cameras: Sequence[Camera], finish: Callable[[int, Rendering], P]
    ) -> Generator[P, None, None]:
        with closing(self._inner.develop(cloud, cameras, finish)) as finished:
            yield from track(finished, self._what, len(cameras))
