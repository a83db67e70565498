"""Pictures of 16 bits a pixel on disk, without loss: a zip archive of JPEG XL images, one a frame.

Any frame can be read alone, any tool can unpack the archive, and zip's checksums tell damage. The same frames give the
same bytes. Depth is kept so (millimetres, 0 = no return), and which object a pixel shows.
"""

import zipfile
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path

import imagecodecs
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import InputError, ProductError
from flymirage_core.rendering.frame_writer import FrameWriter

UInt16 = NDArray[np.uint16]

EFFORT = 1
"""libjxl's fastest: 0.7 ms of CPU and 118 kB for depth of 640 x 480. FFV1 is a quarter smaller and costs 6 ms, which
the renderer would wait for (benchmarks/RENDERING.md)."""
NO_DATE = (1980, 1, 1, 0, 0, 0)


class ImageStackWriter(FrameWriter):
    """Writes frame after frame into one archive, which is whole when the ``with`` block has ended."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._shape: tuple[int, ...] = ()
        self._archive: zipfile.ZipFile | None = None

    def open(self) -> None:
        """Make the file; what comes next must end in `close` or `abandon`."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._archive = zipfile.ZipFile(self.path, "w", zipfile.ZIP_STORED)

    def append(self, frame: UInt16) -> None:
        """Write one more frame (H, W); its shape must be the first one's."""
        self._shape = self._shape or frame.shape
        if frame.shape != self._shape:
            (height, width), (first_height, first_width) = frame.shape, self._shape
            raise InputError(
                f"{self.path.name}: frame {self.count} is {width} x {height} pixels, the first was "
                f"{first_width} x {first_height}; all frames of a flight must have one size"
            )
        self.append_image(jpeg_xl(frame))

    def append_image(self, image: bytes) -> None:
        """Write one more frame as `jpeg_xl` gives it; its size must be the first one's."""
        assert self._archive is not None  # `open` comes first
        self._archive.writestr(zipfile.ZipInfo(_member(self.count), NO_DATE), image)
        self.count += 1

    def close(self) -> None:
        """Write the archive's index. Raises `InputError` if there was no frame."""
        self.abandon()
        if self.count == 0:
            raise InputError(f"{self.path.name}: no frame was given; an image stack needs at least one")

    def abandon(self) -> None:
        """Let go of the file; after `close` this does nothing."""
        if self._archive is not None:
            self._archive.close()
            self._archive = None


def jpeg_xl(frame: UInt16) -> bytes:
    """A frame (H, W) as a JPEG XL image, without loss. Holds no GIL."""
    return bytes(imagecodecs.jpegxl_encode(np.ascontiguousarray(frame), lossless=True, effort=EFFORT, numthreads=1))


def read_images(path: Path, count: int) -> Iterator[UInt16]:
    """The ``count`` frames (H, W) of a stack, one by one.

    Raises `ProductError` if the file is missing or torn, a frame is damaged, or there are not ``count`` of them.
    """
    with _opened(path) as archive:
        found = len(archive.namelist())
        if found != count:
            raise ProductError(f"{path} holds {found} frames, {count} were expected; materialise `frames` again")
        for index in range(count):
            yield _read(archive, path, index)


def read_images_at(path: Path, indices: Iterable[int]) -> list[UInt16]:
    """The frames (H, W) at ``indices``, without decoding any other; errors as in `read_images`."""
    with _opened(path) as archive:
        return [_read(archive, path, index) for index in indices]


def _opened(path: Path) -> zipfile.ZipFile:
    try:
        return zipfile.ZipFile(path)
    except (OSError, zipfile.BadZipFile) as error:
        raise ProductError(f"{path} is missing or torn ({error}); materialise `frames` again") from error


def _read(archive: zipfile.ZipFile, path: Path, index: int) -> UInt16:
    try:
        frame: UInt16 = imagecodecs.jpegxl_decode(archive.read(_member(index)), numthreads=1)
    except (KeyError, OSError, EOFError, zipfile.BadZipFile, zlib.error, imagecodecs.JpegxlError) as error:
        raise ProductError(f"{path} has no whole frame {index} ({error}); materialise `frames` again") from error
    return frame


def _member(index: int) -> str:
    return f"{index:06d}.jxl"
