"""LeRobot's statistics of a feature: min, max, mean, std, count and five quantiles, per episode and over all.

Pictures are counted into histograms, which add up exactly. Numbers of a scene are summed up in a `NumberSketch`: of
many sketches all statistics come out exact but the quantiles, which are right within half a per cent of rank.
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


SKETCH_LEVELS = np.linspace(0.0, 1.0, 201)
"""Ranks at which a sketch knows the value; the five quantiles are among them."""
MOST_POINTS = 4001
"""Values at which the joint distribution of many sketches is worked out."""


@dataclass(frozen=True, eq=False)
class NumberSketch:
    """A column of one scene, small enough to keep: what is needed to state a whole data set's statistics."""

    count: int
    mean: NDArray[np.float64]  # (n,)
    variance: NDArray[np.float64]  # (n,)
    grid: NDArray[np.float64]  # (201, n) values at `SKETCH_LEVELS`; the first row is the least, the last the most

    @staticmethod
    def of(values: NDArray[Any]) -> "NumberSketch":
        v = values.astype(np.float64)
        return NumberSketch(len(v), v.mean(axis=0), v.var(axis=0), np.quantile(v, SKETCH_LEVELS, axis=0))


def joint_stats(sketches: list[NumberSketch]) -> Stats:
    """Statistics of the column over all sketches, as `numeric_stats` gives them."""
    counts = np.array([s.count for s in sketches], float)  # (S,)
    share = (counts / counts.sum())[:, None]
    means = np.array([s.mean for s in sketches])  # (S, n)
    mean = (share * means).sum(axis=0)
    variance = (share * (np.array([s.variance for s in sketches]) + (means - mean) ** 2)).sum(axis=0)
    grids = np.array([s.grid for s in sketches])  # (S, 201, n)
    quantiles = np.array([_joint_quantiles(grids[:, :, i], share[:, 0]) for i in range(grids.shape[2])])  # (n, 5)
    return {
        "min": grids[:, 0].min(axis=0).tolist(),
        "max": grids[:, -1].max(axis=0).tolist(),
        "mean": mean.tolist(),
        "std": np.sqrt(variance).tolist(),
        "count": [int(counts.sum())],
        **{name: quantiles[:, i].tolist() for i, name in enumerate(QUANTILES)},
    }


def _joint_quantiles(grids: NDArray[np.float64], share: NDArray[np.float64]) -> NDArray[np.float64]:
    """The five quantiles of a mixture of distributions whose values at `SKETCH_LEVELS` are ``grids`` (S, 201)."""
    wanted = np.array(list(QUANTILES.values()))
    if len(grids) == 1:
        return np.asarray(np.interp(wanted, SKETCH_LEVELS, grids[0]))
    points = np.unique(grids)
    if len(points) > MOST_POINTS:
        points = np.quantile(points, np.linspace(0, 1, MOST_POINTS))
    ranks = sum(w * _ranks(grid, points) for grid, w in zip(grids, share, strict=True))
    found = np.searchsorted(np.asarray(ranks), wanted - 1e-12)
    return np.asarray(points[np.minimum(found, len(points) - 1)])


def _ranks(grid: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of a distribution's values <= each point. Not np.interp: at a value that many frames share, the rank jumps,
    and the upper end of the jump is meant."""
    top = len(grid) - 1
    last = np.searchsorted(grid, points, side="right") - 1  # the highest level at or below the point; -1 = none
    low, high = np.take(grid, last, mode="clip"), np.take(grid, last + 1, mode="clip")
    within = np.divide(points - low, high - low, out=np.zeros(len(points)), where=high > low)
    return np.where(last < 0, 0.0, np.minimum(last + within, top) / top)


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
