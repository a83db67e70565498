"""RGB video on disk: H.264 in mp4. Frames go in and come out one by one.

The same frames give the same bytes whatever else the machine does: one encoder thread, no random identifiers, no dates.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
from av.video.reformatter import ColorRange, Colorspace
from numpy.typing import NDArray

from flymirage_core.errors import InputError, ProductError
from flymirage_core.rendering import picture_kernels
from flymirage_core.rendering.frame_writer import FrameWriter

GROUP_OF_PICTURES = 2
"""Frames from one key frame to the next; small, so that a trainer can jump to any frame (LeRobot's choice)."""
H264_OPTIONS = {"qp": "18", "preset": "ultrafast"}
"""45 dB at 640 x 480, 20 to 27 kB and 1.4 ms of CPU a frame; a constant quantiser is cheaper and smaller here than
"crf" at the same quality, and "veryfast" takes 5 ms, which the renderer would wait for (benchmarks/RENDERING.md)."""
BT601 = Colorspace.ITU601


class VideoWriter(FrameWriter):
    """Encodes RGB frames at ``rate`` Hz into one H.264 file (yuv420p), whole when the ``with`` block has ended."""

    def __init__(self, path: Path, rate: float) -> None:
        super().__init__(path)
        self._rate = Fraction(rate).limit_denominator(1001)
        self._container: Any = None
        self._stream: Any = None

    def open(self) -> None:
        """Make the file; what comes next must end in `close` or `abandon`."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._container = av.open(str(self.path), "w", options={"fflags": "+bitexact"})

    def close(self) -> None:
        """Write what is left. Raises `InputError` if there was no frame."""
        try:
            if self._stream is not None:
                self._container.mux(self._stream.encode(None))
        finally:
            self.abandon()
        if self.count == 0:
            raise InputError(f"{self.path.name}: no frame was given; a video needs at least one")

    def abandon(self) -> None:
        """Let go of the file as it is; after `close` this does nothing."""
        if self._container is not None:
            self._container.close()
            self._container = None

    def append(self, frame: NDArray[np.uint8]) -> None:
        """Encode one more frame (H, W, 3), H and W even; its shape must be the first one's. Raises `InputError`."""
        self.append_planes(yuv420p(frame))

    def append_planes(self, planes: NDArray[np.uint8]) -> None:
        """Encode one more frame as `yuv420p` gives it (H 3/2, W); otherwise as `append`."""
        height, width = planes.shape[0] * 2 // 3, planes.shape[1]
        if self._stream is None:
            self._open_stream(width, height)
        stream = self._stream
        if (width, height) != (stream.width, stream.height):
            raise InputError(
                f"{self.path.name}: frame {self.count} is {width} x {height} pixels, the first was "
                f"{stream.width} x {stream.height}; all frames of a video must have one size"
            )
        picture = av.VideoFrame.from_numpy_buffer(planes, format="yuv420p")
        picture.pts, picture.time_base = self.count, 1 / self._rate
        self._container.mux(stream.encode(picture))
        self.count += 1

    def _open_stream(self, width: int, height: int) -> None:
        stream = self._stream = self._container.add_stream("libx264", rate=self._rate, options=H264_OPTIONS)
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        context = stream.codec_context
        context.gop_size, context.max_b_frames, context.thread_count = GROUP_OF_PICTURES, 0, 1
        context.flags |= av.codec.context.Flags.bitexact
        context.time_base = 1 / self._rate
        context.colorspace, context.color_range = BT601, ColorRange.MPEG


def write_rgb(path: Path, frames: Iterable[NDArray[np.uint8]], rate: float) -> int:
    """Write RGB ``frames`` (H, W, 3) as they come; return how many there were."""
    with VideoWriter(path, rate) as writer:
        for frame in frames:
            writer.append(frame)
    return writer.count


def read_rgb(path: Path, count: int) -> Iterator[NDArray[np.uint8]]:
    """The ``count`` RGB frames (H, W, 3) of a video, one by one; raises `ProductError` if they are not all there."""
    return (_rgb_from(planes) for planes in _decoded(path, count))


def read_rgb_at(path: Path, indices: Iterable[int]) -> list[NDArray[np.uint8]]:
    """The RGB frames (H, W, 3) at ``indices`` of a video, without decoding those before; errors as in `read_rgb`."""
    return [_rgb_from(planes) for planes in _decoded_at(path, indices)]


def yuv420p(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """RGB (H, W, 3) to the planes Y, U, V (H 3/2, W): BT.601, limited range, a colour the mean of its four pixels.

    Raises `InputError` if H or W is odd. A third of OpenCV's cost, and 0.4 to 1.4 dB nearer than libswscale.
    """
    height, width = rgb.shape[:2]
    if width % 2 or height % 2:
        raise InputError(f"a picture has {width} x {height} pixels; H.264 video needs an even width and an even height")
    planes = np.empty((height * 3 // 2, width), np.uint8)
    picture_kernels.yuv420p(np.ascontiguousarray(rgb).reshape(-1), height, width, planes.reshape(-1))
    return planes


def _rgb_from(planes: NDArray[Any]) -> NDArray[np.uint8]:
    """By OpenCV, because libswscale's default conversion comes out one grey level darker."""
    return np.asarray(cv2.cvtColor(planes, cv2.COLOR_YUV2RGB_I420), np.uint8)


def _decoded_at(path: Path, indices: Iterable[int]) -> Iterator[NDArray[Any]]:
    try:
        with av.open(str(path)) as container:
            stream: Any = container.streams.video[0]
            decoded, following = container.decode(stream), 0
            for index in indices:
                wanted = round(index / (stream.average_rate * stream.time_base))
                if index != following:
                    container.seek(wanted, stream=stream)  # to the key frame at or before it
                    decoded = container.decode(stream)
                following = index + 1
                frame = next((f for f in decoded if f.pts >= wanted), None)
                if frame is None or frame.is_corrupt:
                    raise ProductError(f"{path} has no whole frame {index}; materialise `frames` again")
                yield frame.to_ndarray(format="yuv420p")
    except (av.FFmpegError, IndexError) as error:
        raise ProductError(f"{path} is missing or torn ({error}); materialise `frames` again") from error


def _decoded(path: Path, count: int) -> Iterator[NDArray[Any]]:
    done = 0
    try:
        with av.open(str(path)) as container:
            for frame in container.decode(video=0):
                if frame.is_corrupt:
                    raise ProductError(f"{path}: frame {done} is damaged; materialise `frames` again")
                done += 1
                if done <= count:
                    yield frame.to_ndarray(format="yuv420p")
    except (av.FFmpegError, IndexError) as error:
        raise ProductError(f"{path} is missing or torn ({error}); materialise `frames` again") from error
    if done != count:
        raise ProductError(f"{path} holds {done} frames, {count} were expected; materialise `frames` again")
