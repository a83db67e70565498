"""LeRobot's statistics of a feature: min, max, mean, std, count and five quantiles, per episode and over all.

Numbers are kept (a few dozen bytes a frame); pictures are counted into histograms, so that both answers are exact.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

QUANTILES = {"q01": 0.01, "q10": 0.10, "q50": 0.50, "q90": 0.90, "q99": 0.99}
STAT_NAMES = ("min", "max", "mean", "std", "count", *QUANTILES)

Stats = dict[str, Any]


def numeric_stats(values: NDArray[Any]) -> Stats:
    """Of each column of ``values`` (N, n), as lists of length n; count is [N]."""
    v = values.astype(np.float64)
    return {
        "min": v.min(axis=0).tolist(),
        "max": v.max(axis=0).tolist(),
        "mean": v.mean(axis=0).tolist(),
        "std": v.std(axis=0).tolist(),
        "count": [len(v)],
        **{name: np.quantile(v, q, axis=0).tolist() for name, q in QUANTILES.items()},
    }


@dataclass(frozen=True, eq=False)
class PictureCounts:
    """How often each level occurs in each channel of the sampled pictures."""

    counts: NDArray[np.int64]  # (C, levels)
    pictures: int
    scale: float  # the value of one level: 1/255 for RGB, 1 mm for depth

    @staticmethod
    def of_rgb(rgb: NDArray[np.uint8]) -> "PictureCounts":
        counts = [np.bincount(rgb[:, :, c].ravel(), minlength=256) for c in range(3)]
        return PictureCounts(np.array(counts, np.int64), 1, 1 / 255)

    @staticmethod
    def of_depth(depth: NDArray[np.uint16]) -> "PictureCounts":
        """Millimetres; 0, no return, is not counted."""
        counts = np.bincount(depth.ravel(), minlength=65536)
        counts[0] = 0
        return PictureCounts(counts[None].astype(np.int64), 1, 1.0)

    def __add__(self, other: "PictureCounts") -> "PictureCounts":
        return PictureCounts(self.counts + other.counts, self.pictures + other.pictures, self.scale)

    def stats(self) -> Stats:
        """As nested lists (C, 1, 1), count [pictures]; all zero for a channel without any value."""
        rows = [_histogram_stats(c, self.scale) for c in self.counts]
        stats: Stats = {name: [[[row[name]]] for row in rows] for name in STAT_NAMES if name != "count"}
        return {**stats, "count": [self.pictures]}


def _histogram_stats(counts: NDArray[np.int64], scale: float) -> dict[str, float]:
    total = int(counts.sum())
    if total == 0:
        return dict.fromkeys(STAT_NAMES, 0.0)
    levels = np.arange(len(counts)) * scale
    seen = np.flatnonzero(counts)
    mean = float(counts @ levels) / total
    variance = float(counts @ (levels - mean) ** 2) / total
    below = np.cumsum(counts)
    return {
        "min": float(levels[seen[0]]),
        "max": float(levels[seen[-1]]),
        "mean": mean,
        "std": float(np.sqrt(variance)),
        **{name: float(levels[np.searchsorted(below, q * total)]) for name, q in QUANTILES.items()},
    }
