"""What a 2D detector says about boxes: its windows in many views lifted through depth, one vote for each that fits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.fused_points import Frame
from flymirage_core.annotation.yolox import PictureDetection, YoloxDetector

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]

MIN_WINDOW_IOU: Final = 0.45
"""Overlap of a detection's window and a box's from which the one is about the other."""
SURFACE_POINTS: Final = 150
"""Points of a box, spread over its surface, that are looked for in each view."""
SURFACE_SLACK: Final = 0.1
"""Metres between a point and what a view sees there, up to which it sees the point."""
MIN_SHOWN: Final = 0.2
"""Least share of a box's points that a view must show to be asked about it."""
OUTLYING: Final = 2.0
"""Per cent of the points that each side of a window leaves out."""
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


def visible_windows(surfaces: Sequence[Float32], frames: Sequence[Frame]) -> Float64:
    """(B, F, 4) left, top, right, bottom in pixels of what each frame shows of each of B surfaces, points (M, 3).

    What other things hide is not in the window, as it is not in a detector's; NaN where too little is shown.
    """
    sampled = [surface[:: max(1, len(surface) // SURFACE_POINTS)] for surface in surfaces]
    owner = np.repeat(np.arange(len(sampled)), [len(points) for points in sampled])
    points = np.concatenate([np.zeros((0, 3), np.float32), *sampled])
    windows = np.full((len(sampled), len(frames), 4), np.nan)
    for f, frame in enumerate(frames):
        pixels, depth = frame.camera.project(points)
        height, width = frame.depth.shape
        with np.errstate(invalid="ignore"):
            near = np.flatnonzero((depth > 0) & (pixels >= 0).all(axis=1) & (pixels < (width, height)).all(axis=1))
        u, v = pixels[near].astype(int).T
        shown = near[np.abs(frame.depth[v, u] - depth[near]) < SURFACE_SLACK]
        for b in np.unique(owner[shown]):
            own = pixels[shown[owner[shown] == b]]
            if len(own) >= MIN_SHOWN * len(sampled[b]):
                windows[b, f] = np.percentile(own, (OUTLYING, 100 - OUTLYING), axis=0).ravel()
    return windows


@dataclass(frozen=True, eq=False)
class Overlaps:
    """How well each of D believable detections fits each of B boxes."""

    nouns: tuple[str, ...]  # of the detections
    scores: Float64  # (D,)
    ious: Float64  # (B, D), 0 where the frame does not show the box or the box's size forbids the noun


def overlaps(boxes: Sequence[FittedBox], windows: Float64, found: Sequence[Sequence[PictureDetection]]) -> Overlaps:
    """Of the detections ``found`` in each frame with ``windows`` (B, F, 4) of `visible_windows`."""
    known = [(f, seen) for f, detections in enumerate(found) for seen in detections if seen.label in _KNOWN]
    frames = np.array([f for f, _ in known], int)
    detected = np.array([seen.window for _, seen in known]).reshape(-1, 4)  # (D, 4)
    least, most = np.array([_KNOWN[seen.label][1:] for _, seen in known]).reshape(-1, 2).T
    longest = np.array([max(box.size) for box in boxes])[:, None]
    own = windows[:, frames]  # (B, D, 4)
    low, high = np.maximum(own[..., :2], detected[:, :2]), np.minimum(own[..., 2:], detected[:, 2:])
    shared = np.clip(high - low, 0, None).prod(axis=-1)
    both = (own[..., 2:] - own[..., :2]).prod(axis=-1) + (detected[:, 2:] - detected[:, :2]).prod(axis=-1)
    fits = np.nan_to_num(shared / np.maximum(both - shared, 1e-9))
    return Overlaps(
        tuple(_KNOWN[seen.label][0] for _, seen in known),
        np.array([seen.score for _, seen in known]),
        np.where((least <= longest) & (longest <= most), fits, 0.0),
    )


def votes(
    boxes: Sequence[FittedBox], windows: Float64, found: Sequence[Sequence[PictureDetection]]
) -> list[Vote | None]:
    """For each box what the detections say it is, arguments as of `overlaps`; None where that is nothing clear.

    A detection votes for the one box whose window it fits best, if that box's size allows its noun.
    """
    seen = overlaps(boxes, windows, found)
    looked = np.array([len(detections) > 0 for detections in found])
    asked = (~np.isnan(windows[:, looked, 0])).sum(axis=1)
    tallies: list[dict[str, float]] = [{} for _ in boxes]
    for d, noun in enumerate(seen.nouns if len(boxes) else ()):
        b = int(seen.ious[:, d].argmax())
        if seen.ious[b, d] >= MIN_WINDOW_IOU:
            tallies[b][noun] = tallies[b].get(noun, 0.0) + float(seen.scores[d] * seen.ious[b, d])
    return [_winner(tally, int(n)) for tally, n in zip(tallies, asked, strict=True)]


def _winner(tally: dict[str, float], asked: int) -> Vote | None:
    if not tally:
        return None
    noun = max(sorted(tally), key=lambda word: tally[word])
    weight = tally[noun]
    believed = weight >= MIN_VOTE and weight >= MIN_VOTE_SHARE * asked and weight >= CLEAR * sum(tally.values())
    return Vote(noun, weight, asked) if believed else None
