"""`DatasetStatistics`: the paper's figures of section IV, counted over all scenes."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from flymirage_core.dataset.episodes import Episode, SceneProducts
from flymirage_core.dataset.splits import SPLITS

LENGTH_BIN_EDGES = (0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, float("inf"))
"""Metres: the bins of the trajectory-length histogram on the paper's site."""
PAPER_LENGTH_SHARES = (0.0, 0.427, 0.316, 0.162, 0.085, 0.0088, 0.0007, 0.0004, 0.0007)
"""The same histogram of the published data set, for comparison."""
PAPER_MEAN_LENGTH, PAPER_MEDIAN_LENGTH = 4.33, 4.06
"""Metres, section IV."""


@dataclass(frozen=True)
class SceneCounts:
    """What one scene gave, and where its flights went."""

    scene: str
    category: str
    objects: int
    flights: int  # flown and filmed
    rejected_tasks: int  # no flight could be planned
    dropped: int  # by the verdict
    kept_without_prompts: int  # nothing unambiguous could be said of the target
    episodes: int


@dataclass(frozen=True)
class DatasetStatistics:
    """Counts over all scenes; lengths are flown metres of episodes."""

    scenes: int = 0
    episodes: int = 0
    frames: int = 0
    hours: float = 0.0
    scenes_per_category: dict[str, int] = field(default_factory=dict)
    objects_per_scene: dict[str, float] = field(default_factory=dict)  # min, median, max
    objects: int = 0
    labels: int = 0  # distinct, over all scenes
    flights: int = 0
    rejected_tasks: int = 0
    dropped: int = 0
    dropped_by_gate: dict[str, int] = field(default_factory=dict)  # a flight counts at every gate it failed
    kept_without_prompts: int = 0
    length_histogram: dict[str, int] = field(default_factory=dict)  # "2-4": 17
    mean_length: float = 0.0
    median_length: float = 0.0
    prompts: int = 0
    prompts_per_episode: float = 0.0
    prompts_per_kind: dict[str, int] = field(default_factory=dict)
    episodes_per_split: dict[str, int] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def length_bin_names() -> list[str]:
    """
    >>> length_bin_names()[1], length_bin_names()[-1]
    ('2-4', '16+')
    """
    edges = LENGTH_BIN_EDGES
    return [f"{a:.0f}-{b:.0f}" if np.isfinite(b) else f"{a:.0f}+" for a, b in pairwise(edges)]


def length_histogram(lengths: Iterable[float]) -> dict[str, int]:
    """Trajectories in each bin; a bin holds its lower edge and not its upper one."""
    bins = np.digitize(np.fromiter(lengths, float), LENGTH_BIN_EDGES) - 1
    counts = np.bincount(bins, minlength=len(LENGTH_BIN_EDGES) - 1)
    return dict(zip(length_bin_names(), counts.tolist(), strict=True))


@dataclass
class Tally:
    """Collects statistics scene by scene, so that no scene need be held."""

    scenes: list[SceneCounts] = field(default_factory=list)
    labels: set[str] = field(default_factory=set)
    lengths: list[float] = field(default_factory=list)
    kinds: Counter[str] = field(default_factory=Counter)
    splits: Counter[str] = field(default_factory=Counter)
    gates: Counter[str] = field(default_factory=Counter)
    frames: int = 0
    seconds: float = 0.0

    def add(self, products: SceneProducts, episodes: tuple[Episode, ...]) -> SceneCounts:
        kept = len(products.verdicts.kept)
        counts = SceneCounts(
            scene=products.scene,
            category=products.description.category,
            objects=len(products.boxes),
            flights=len(products.trajectories),
            rejected_tasks=len(products.trajectories.rejected),
            dropped=len(products.verdicts) - kept,
            kept_without_prompts=kept - len(episodes),
            episodes=len(episodes),
        )
        self.scenes.append(counts)
        self.labels |= {b.label for b in products.boxes}
        self.gates.update(g.gate for v in products.verdicts for g in v.gates if not g.passed)
        for episode in episodes:
            self.lengths.append(episode.report.length)
            self.kinds.update(p.kind for p in episode.prompts)
            self.splits[episode.split] += 1
            self.frames += episode.frame_count
            self.seconds += episode.report.duration
        return counts

    def statistics(self) -> DatasetStatistics:
        objects = [s.objects for s in self.scenes] or [0]
        lengths = self.lengths or [0.0]
        return DatasetStatistics(
            scenes=len(self.scenes),
            episodes=len(self.lengths),
            frames=self.frames,
            hours=round(self.seconds / 3600, 4),
            scenes_per_category=dict(sorted(Counter(s.category for s in self.scenes).items())),
            objects_per_scene={
                "min": float(min(objects)),
                "median": float(np.median(objects)),
                "max": float(max(objects)),
            },
            objects=sum(s.objects for s in self.scenes),
            labels=len(self.labels),
            flights=sum(s.flights for s in self.scenes),
            rejected_tasks=sum(s.rejected_tasks for s in self.scenes),
            dropped=sum(s.dropped for s in self.scenes),
            dropped_by_gate=dict(sorted(self.gates.items())),
            kept_without_prompts=sum(s.kept_without_prompts for s in self.scenes),
            length_histogram=length_histogram(self.lengths),
            mean_length=round(float(np.mean(lengths)), 3),
            median_length=round(float(np.median(lengths)), 3),
            prompts=self.kinds.total(),
            prompts_per_episode=round(self.kinds.total() / max(len(self.lengths), 1), 3),
            prompts_per_kind=dict(sorted(self.kinds.items())),
            episodes_per_split={split: self.splits[split] for split in SPLITS},
        )
