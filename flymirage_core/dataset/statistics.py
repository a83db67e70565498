"""`DatasetStatistics`: the paper's figures of section IV, counted over all scenes."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from flymirage_core.dataset.episodes import Episode
from flymirage_core.dataset.scene_products import SceneProducts, terms_of
from flymirage_core.dataset.splits import SPLITS

LENGTH_BIN_EDGES = (0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, float("inf"))
"""Metres: the bins of the trajectory-length histogram on the paper's site."""
PAPER_LENGTH_SHARES = (0.0, 0.427, 0.316, 0.162, 0.085, 0.0088, 0.0007, 0.0004, 0.0007)
"""The same histogram of the published data set, for comparison."""
PAPER_MEAN_LENGTH, PAPER_MEDIAN_LENGTH = 4.33, 4.06
"""Metres, section IV."""
COMMONEST = 25
"""Labels listed by name."""


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
    long_prompts: int = 0  # over several flights of a set
    held_out_prompts: int = 0  # of training episodes, for the instruction-unseen test
    episodes_per_split: dict[str, int] = field(default_factory=dict)
    commonest_labels: dict[str, int] = field(default_factory=dict)  # label -> boxes, the `COMMONEST` ones
    usd: float = 0.0  # paid for services
    computing_hours: float = 0.0

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


@dataclass(frozen=True)
class SceneShare:
    """What one scene adds to the statistics; shares of all scenes make `DatasetStatistics`, in any order."""

    counts: SceneCounts
    subcategory: str
    labels: dict[str, int]  # label -> boxes
    lengths: tuple[float, ...]  # metres, of its episodes
    kinds: dict[str, int]  # prompt kind -> prompts
    long_prompts: int
    held_out_prompts: int
    splits: dict[str, int]  # split -> episodes
    gates: dict[str, int]  # gate -> flights that failed it
    frames: int
    duration: float  # seconds flown
    terms: str
    tools: dict[str, str]  # asset -> who made it
    usd: float
    computing: float  # seconds

    @staticmethod
    def of(products: SceneProducts, episodes: tuple[Episode, ...]) -> "SceneShare":
        verdicts, lineage = products.verdicts, products.lineage
        kept = len(verdicts.kept)
        return SceneShare(
            counts=SceneCounts(
                scene=products.scene,
                category=products.description.category,
                objects=len(products.boxes),
                flights=len(products.trajectories),
                rejected_tasks=len(products.trajectories.rejected),
                dropped=len(verdicts) - kept,
                kept_without_prompts=kept - len(episodes),
                episodes=len(episodes),
            ),
            subcategory=products.description.subcategory,
            labels=_counted(box.label for box in products.boxes),
            lengths=tuple(e.report.length for e in episodes),
            kinds=_counted(p.kind for e in episodes for p in e.prompts),
            long_prompts=len(products.prompts.long_prompts),
            held_out_prompts=sum(len(e.held_out_prompts) for e in episodes),
            splits=_counted(e.split for e in episodes),
            gates=_counted(g.gate for v in verdicts for g in v.gates if not g.passed),
            frames=sum(e.frame_count for e in episodes),
            duration=sum(e.report.duration for e in episodes),
            terms=terms_of(products),
            tools=dict(sorted(lineage.tools.items())),
            usd=round(lineage.usd, 4),
            computing=round(lineage.seconds, 1),
        )

    @staticmethod
    def from_dict(data: dict[str, Any]) -> "SceneShare":
        return SceneShare(**{**data, "counts": SceneCounts(**data["counts"]), "lengths": tuple(data["lengths"])})


def statistics_of(shares: Iterable[SceneShare]) -> DatasetStatistics:
    """Counted over all scenes."""
    shares = tuple(shares)
    counts = [share.counts for share in shares]
    lengths = [length for share in shares for length in share.lengths]
    objects = [c.objects for c in counts] or [0]
    kinds = _summed(share.kinds for share in shares)
    labels = _summed(share.labels for share in shares)
    splits = _summed(share.splits for share in shares)
    return DatasetStatistics(
        scenes=len(shares),
        episodes=len(lengths),
        frames=sum(share.frames for share in shares),
        hours=round(sum(share.duration for share in shares) / 3600, 4),
        scenes_per_category=_counted(c.category for c in counts),
        objects_per_scene={"min": float(min(objects)), "median": float(np.median(objects)), "max": float(max(objects))},
        objects=sum(c.objects for c in counts),
        labels=len(labels),
        commonest_labels=dict(sorted(labels.items(), key=lambda item: (-item[1], item[0]))[:COMMONEST]),
        flights=sum(c.flights for c in counts),
        rejected_tasks=sum(c.rejected_tasks for c in counts),
        dropped=sum(c.dropped for c in counts),
        dropped_by_gate=_summed(share.gates for share in shares),
        kept_without_prompts=sum(c.kept_without_prompts for c in counts),
        length_histogram=length_histogram(lengths),
        mean_length=round(float(np.mean(lengths or [0.0])), 3),
        median_length=round(float(np.median(lengths or [0.0])), 3),
        prompts=sum(kinds.values()),
        prompts_per_episode=round(sum(kinds.values()) / max(len(lengths), 1), 3),
        prompts_per_kind=kinds,
        long_prompts=sum(share.long_prompts for share in shares),
        held_out_prompts=sum(share.held_out_prompts for share in shares),
        episodes_per_split={split: splits.get(split, 0) for split in SPLITS},
        usd=round(sum(share.usd for share in shares), 2),
        computing_hours=round(sum(share.computing for share in shares) / 3600, 3),
    )


def _counted(names: Iterable[str]) -> dict[str, int]:
    return dict(sorted(Counter(names).items()))


def _summed(counts: Iterable[dict[str, int]]) -> dict[str, int]:
    total: Counter[str] = Counter()
    for count in counts:
        total.update(count)
    return dict(sorted(total.items()))
