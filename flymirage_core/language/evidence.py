"""What a verdict is given on: frames sampled along a flight, each with the one after it."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.picture_measures import Luma, to_luma
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.frames import FlightFrames, Frames

PAPER_FRAME_RATE = 30.0
"""Hz: the video rate that `VerdictSettings.frame_step` counts frames of (section III-C)."""
NEIGHBOUR_STEP = 2
"""Every second sampled frame is compared with the one after it: half of a verdict's time is decoding."""


@dataclass(frozen=True, eq=False)
class Sighting:
    """One sampled frame."""

    frame_index: int
    camera: Camera
    rgb: NDArray[np.uint8]  # (H, W, 3)
    depth: NDArray[np.uint16]  # (H, W) millimetres, 0 = no return

    @cached_property
    def luma(self) -> Luma:
        return to_luma(self.rgb)  # (H, W)


@dataclass(frozen=True, eq=False)
class Evidence:
    """One flight, its target, and what was filmed."""

    flight: Flight
    target: ObjectBox
    sightings: tuple[Sighting, ...]  # sampled along the flight, the last frame among them
    pairs: tuple[tuple[Sighting, Sighting], ...]  # neighbouring frames
    coverage: NDArray[np.float64]  # (F,) share of opaque pixels of every frame
    frame_rate: float
    openings: float = 0.0
    """Share of a picture that the scene itself leaves empty, such as a captured room's door (`scene_openings`)."""

    @staticmethod
    def of(
        flight: Flight, target: ObjectBox, frames: FlightFrames, frame_step: int, openings: float = 0.0
    ) -> "Evidence":
        """Decodes the sampled frames and every second one's neighbour. Raises `ProductError` if a video is torn."""
        count, rate = len(frames), frames.rig.frame_rate
        sampled = sampled_indices(count, rate, frame_step)
        wanted = sorted({*sampled, *(i + 1 for i in sampled[::NEIGHBOUR_STEP] if i + 1 < count)})
        cameras = frames.cameras()
        pictures = zip(wanted, frames.rgb_at(wanted), frames.depth_at(wanted), strict=True)
        seen = {i: Sighting(i, cameras[i], rgb, depth) for i, rgb, depth in pictures}
        coverage = frames.table["alpha_coverage"].to_numpy(float)  # (F,)
        sightings, pairs = tuple(seen[i] for i in sampled), neighbours(seen.values())
        return Evidence(flight, target, sightings, pairs, coverage, rate, openings)


def scene_openings(frames: Frames) -> float:
    """Share of its worst picture that a scene's median flight finds empty (alpha < 0.5): what the scene is like.

    The door of a captured room, behind which nothing was captured, is seen by most flights; a hole by few.
    """
    if frames.table.empty:
        return 0.0
    return float(1.0 - frames.table.groupby("flight_id")["alpha_coverage"].min().median())


def neighbours(sightings: Iterable[Sighting]) -> tuple[tuple[Sighting, Sighting], ...]:
    """Those, in order, that follow one another without a frame between them."""
    return tuple((a, b) for a, b in pairwise(sightings) if b.frame_index == a.frame_index + 1)


def sampled_indices(frame_count: int, frame_rate: float, frame_step: int) -> list[int]:
    """Every ``frame_step``-th frame of a 30 Hz video (the same seconds at another rate), and always the last.

    >>> sampled_indices(50, 10.0, 30)
    [0, 10, 20, 30, 40, 49]
    """
    step = max(1, round(frame_step * frame_rate / PAPER_FRAME_RATE))
    return sorted({*range(0, frame_count, step), frame_count - 1})
