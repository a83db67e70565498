"""Many flights' H.264 videos in few mp4 files: packets are copied, nothing is encoded a second time."""

import zlib
from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

import av
import numpy as np

from flymirage_core.errors import ProductError

CHUNK_SIZE = 1000
"""Files in one chunk folder; LeRobot's default."""
MAX_VIDEO_BYTES = 200 * 2**20
"""A file is closed when it grows past this; LeRobot's default."""


class VideoSpan(NamedTuple):
    """Where an episode's pictures lie."""

    chunk_index: int
    file_index: int
    from_timestamp: float  # seconds: exactly n / fps
    to_timestamp: float
    crc32: int  # of the episode's packets, in order


class VideoJoiner:
    """Appends videos to files ``chunk-CCC/file-NNN.mp4`` under a folder, from number ``first`` on."""

    def __init__(self, folder: Path, frame_rate: int, first: int = 0, max_bytes: int = MAX_VIDEO_BYTES) -> None:
        self._folder, self._rate, self._first, self._max_bytes = folder, frame_rate, first, max_bytes
        self._number = first - 1  # of the current file, over all chunks
        self._output: Any = None
        self._stream: Any = None
        self._frames = self._bytes = 0
        self._parameters: bytes = b""

    def __enter__(self) -> "VideoJoiner":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._close()

    @property
    def count(self) -> int:
        return self._number - self._first + 1

    def append(self, video: Path, frame_count: int) -> VideoSpan:
        """Copy a whole video behind the last; its first frame must be a key frame, as in every file of its own.

        Raises `ProductError` if it is torn, no H.264, or has not ``frame_count`` frames evenly spaced at its rate.
        """
        try:
            return self._append(video, frame_count)
        except av.FFmpegError as error:
            raise ProductError(f"{video} is missing or torn ({error}); materialise `frames` again") from error

    def _append(self, video: Path, frame_count: int) -> VideoSpan:
        with av.open(str(video)) as source:
            stream = source.streams.video[0]
            if stream.codec_context.name != "h264":
                raise ProductError(f"{video} is {stream.codec_context.name}, expected h264; materialise `frames` again")
            packets = [p for p in source.demux(stream) if p.pts is not None]
            pts, dts = self._frame_numbers(video, packets, frame_count)
            self._make_room(stream)
            crc = 0
            for packet, shown, decoded in zip(packets, pts, dts, strict=True):
                packet.stream = self._stream
                packet.time_base = Fraction(1, self._rate)
                packet.pts, packet.dts, packet.duration = self._frames + shown, self._frames + decoded, 1
                self._bytes += packet.size
                crc = zlib.crc32(bytes(packet), crc)
                self._output.mux(packet)
        first, self._frames = self._frames, self._frames + frame_count
        chunk, file = divmod(self._number, CHUNK_SIZE)
        return VideoSpan(chunk, file, first / self._rate, self._frames / self._rate, crc)

    def _frame_numbers(self, video: Path, packets: list[Any], frame_count: int) -> tuple[list[int], list[int]]:
        """Presentation and decoding order of the packets in whole frames from 0."""
        seconds = np.array([float(p.pts * p.time_base) for p in packets])
        shown = (seconds - seconds.min(initial=np.inf)) * self._rate
        whole = np.rint(shown)
        even = len(packets) == frame_count and np.array_equal(np.sort(whole), np.arange(frame_count))
        if not even or np.abs(shown - whole).max() > 0.01:
            raise ProductError(
                f"{video} has {len(packets)} frames, expected {frame_count} evenly spaced ones at {self._rate} Hz; "
                "materialise `frames` again"
            )
        delays = [round(float((p.pts - p.dts) * p.time_base) * self._rate) for p in packets]
        pts = [int(n) for n in whole]
        return pts, [n - delay for n, delay in zip(pts, delays, strict=True)]

    def _make_room(self, stream: Any) -> None:
        """A new file at the start, when the last is full, and where the codec's parameters change."""
        parameters = bytes(stream.codec_context.extradata or b"")
        if self._output is None or self._bytes > self._max_bytes or parameters != self._parameters:
            self._close()
            self._number += 1
            chunk, file = divmod(self._number, CHUNK_SIZE)
            path = self._folder / f"chunk-{chunk:03d}" / f"file-{file:03d}.mp4"
            path.parent.mkdir(parents=True, exist_ok=True)
            self._output = av.open(str(path), "w", options={"movflags": "faststart", "fflags": "+bitexact"})
            self._stream = self._output.add_stream_from_template(stream)
            self._stream.time_base = Fraction(1, self._rate)
            self._frames = self._bytes = 0
            self._parameters = parameters

    def _close(self) -> None:
        if self._output is not None:
            self._output.close()
            self._output = None
