"""`FrameWriter`: what writes frame after frame into one file, a video or a stack of images."""

from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any, Self

from numpy.typing import NDArray


class FrameWriter(ABC):
    """A file of frames in the making; it is whole after `close`, or when the ``with`` block has ended."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.count = 0  # frames so far

    def __enter__(self) -> Self:
        self.open()
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        if kind is None:
            self.close()
        else:
            self.abandon()

    @abstractmethod
    def open(self) -> None:
        """Make the file; what comes next must end in `close` or `abandon`."""

    @abstractmethod
    def append(self, frame: NDArray[Any]) -> None:
        """Write one more frame; its shape must be the first one's. Raises `InputError`."""

    @abstractmethod
    def close(self) -> None:
        """Write what is left. Raises `InputError` if there was no frame."""

    @abstractmethod
    def abandon(self) -> None:
        """Let go of the file as it is; after `close` this does nothing."""
