"""What a 2D detector says about boxes: its windows in many views lifted through depth, one vote for each that fits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.appearance import window_of
from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.fused_points import Frame
from flymirage_core.annotation.yolox import PictureDetection, YoloxDetector

MIN_WINDOW_IOU: Final = 0.45
"""Overlap of a detection's window and a box's from which the one is about the other."""
MIN_SHOWN: Final = 0.2
"""Least share of a box's points that a view must hit to be asked about it."""
MIN_VOTE: Final = 0.8
"""Sum of score x overlap from which a noun is believed ..."""
MIN_VOTE_SHARE: Final = 0.08
"""... if it also is this much for each view that was asked ..."""
CLEAR: Final = 0.5
"""... and this share of all votes about the box."""
MAX_VIEWS: Final = 160
"""Views shown to the detector at most, spread over all: it needs 40 ms for each."""

_KNOWN: Final[Mapping[str, tuple[str, float, float]]] = {
    "bicycle": ("bicycle", 1.0, 2.2),
    "car": ("car", 2.4, 6.0),
    "motorcycle": ("motorcycle", 1.2, 2.6),
    "traffic light": ("traffic light", 0.4, 6.0),
    "fire hydrant": ("fire hydrant", 0.4, 1.4),
    "bench": ("bench", 0.8, 3.0),
    "backpack": ("backpack", 0.25, 0.8),
    "handbag": ("handbag", 0.15, 0.7),
    "suitcase": ("suitcase", 0.35, 1.1),
    "bottle": ("bottle", 0.1, 0.5),
    "bowl": ("bowl", 0.1, 0.5),
    "chair": ("chair", 0.4, 1.4),
    "couch": ("sofa", 0.7, 3.6),
    "potted plant": ("potted plant", 0.15, 2.5),
    "bed": ("bed", 1.7, 3.0),
    "dining table": ("table", 0.5, 3.5),
    "tv": ("television", 0.3, 2.2),
    "laptop": ("laptop", 0.2, 0.6),
    "microwave": ("microwave", 0.3, 0.8),
    "oven": ("oven", 0.4, 1.1),
    "sink": ("sink", 0.3, 1.2),
    "refrigerator": ("fridge", 0.9, 2.4),
    "book": ("books", 0.1, 0.6),
    "clock": ("clock", 0.1, 0.9),
    "vase": ("vase", 0.1, 1.1),
    "teddy bear": ("teddy bear", 0.15, 1.0),
}
"""The detector's classes that are believed: our noun, and least and greatest longest side in metres. Persons, animals,
cutlery and sports things only misfire where nobody lives; toilets are round white armchairs more often than not."""


@dataclass(frozen=True)
class Vote:
    """What the views say that a box is."""

    noun: str
    weight: float  # sum of score x overlap over the views
    views: int  # that were asked


def look_at(frames: Sequence[Frame], detector: YoloxDetector) -> list[list[PictureDetection]]:
    """What the detector sees in each frame; nothing in those that are left out, of more than `MAX_VIEWS`."""
    step = -(-len(frames) // MAX_VIEWS)
    return [detector.detect(frame.rgb) if i % step == 0 else [] for i, frame in enumerate(frames)]


def votes(
    boxes: Sequence[FittedBox],
    hits: NDArray[np.int64],
    frames: Sequence[Frame],
    found: Sequence[Sequence[PictureDetection]],
) -> list[Vote | None]:
    """For each box what the detections ``found`` in each frame say it is; None where that is nothing clear.

    ``hits`` (B, F): points of each box that each frame shows. A detection votes for the one box whose window it fits
    best, if that box's size allows its noun.
    """
    tallies, asked = _tallies(boxes, hits, frames, found)
    return [_winner(tally, n) for tally, n in zip(tallies, asked, strict=True)]


def vote_weights(
    boxes: Sequence[FittedBox],
    hits: NDArray[np.int64],
    frames: Sequence[Frame],
    found: Sequence[Sequence[PictureDetection]],
) -> NDArray[np.float64]:
    """(B,) weight of the noun that most is said for, of each of some rival boxes; arguments as in `votes`."""
    tallies, _ = _tallies(boxes, hits, frames, found)
    return np.array([max(tally.values(), default=0.0) for tally in tallies])


def _tallies(
    boxes: Sequence[FittedBox],
    hits: NDArray[np.int64],
    frames: Sequence[Frame],
    found: Sequence[Sequence[PictureDetection]],
) -> tuple[list[dict[str, float]], list[int]]:
    """Sum of score x overlap for each noun, and the number of views asked, of each box."""
    tallies: list[dict[str, float]] = [{} for _ in boxes]
    asked = [0] * len(boxes)
    shown = hits >= np.maximum(MIN_SHOWN * np.array([[len(box.members)] for box in boxes]).reshape(-1, 1), 1)
    for f, (frame, detections) in enumerate(zip(frames, found, strict=True)):
        if not detections:
            continue
        windows = {b: w for b in np.flatnonzero(shown[:, f]).tolist() if (w := window_of(boxes[b], frame)) is not None}
        for b in windows:
            asked[b] += 1
        for detection in detections:
            fits = {b: _overlap(detection.window, w) for b, w in windows.items() if _plausible(detection, boxes[b])}
            b = max(fits, key=lambda k: fits[k], default=-1)
            if b >= 0 and fits[b] >= MIN_WINDOW_IOU:
                noun = _KNOWN[detection.label][0]
                tallies[b][noun] = tallies[b].get(noun, 0.0) + detection.score * fits[b]
    return tallies, asked


def _plausible(detection: PictureDetection, box: FittedBox) -> bool:
    known = _KNOWN.get(detection.label)
    return known is not None and known[1] <= max(box.size) <= known[2]


def _winner(tally: dict[str, float], asked: int) -> Vote | None:
    if not tally:
        return None
    noun = max(sorted(tally), key=lambda word: tally[word])
    weight = tally[noun]
    believed = weight >= MIN_VOTE and weight >= MIN_VOTE_SHARE * asked and weight >= CLEAR * sum(tally.values())
    return Vote(noun, weight, asked) if believed else None


def _overlap(a: Sequence[float], b: Sequence[float]) -> float:
    """Intersection over union of two windows (left, top, right, bottom)."""
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    if width <= 0 or height <= 0:
        return 0.0
    shared = width * height
    return shared / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - shared)
