"""The data set's figures beside the paper's (section IV and its site), from statistics or from the products' tables."""

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

import pyarrow.parquet as pq

from flymirage_core.dataset.statistics import (
    PAPER_LENGTH_SHARES,
    PAPER_MEAN_LENGTH,
    PAPER_MEDIAN_LENGTH,
    DatasetStatistics,
    SceneCounts,
    SceneShare,
)
from flymirage_core.errors import ProductError

TABLES = {
    "description": "description.json",
    "boxes": "boxes.parquet",
    "trajectories": "flights.parquet",
    "frames": "frames.parquet",
    "quality_verdict": "verdicts.parquet",
    "prompts": "prompts.parquet",
}
"""The one file of each product that is read."""
NOT_STATED = "-"
PAPER_CATEGORIES = (
    "six: transportation; workplaces & offices; commercial & retail; industrial & utility; leisure & hospitality; homes"
)


@dataclass(frozen=True)
class Figure:
    """One line of the comparison."""

    name: str
    ours: str
    paper: str


def figures(statistics: DatasetStatistics) -> list[Figure]:
    """What section IV and the site state of the published data set, and what ours has."""
    s = statistics
    objects = s.objects_per_scene
    lines = [
        Figure("scenes", f"{s.scenes:,}", "500+ (site: 1,100)"),
        Figure("trajectories", f"{s.episodes:,}", "50,000 (site: 114,275)"),
        Figure("trajectories per scene", f"{s.episodes / max(s.scenes, 1):.1f}", "100 (site: 103.9)"),
        Figure("mean length", f"{s.mean_length:.2f} m", f"{PAPER_MEAN_LENGTH:.2f} m"),
        Figure("median length", f"{s.median_length:.2f} m", f"{PAPER_MEDIAN_LENGTH:.2f} m"),
        Figure("objects per scene", f"median {objects.get('median', 0):.0f}, {_span(objects)}", "60-100"),
        Figure("object labels", f"{s.labels:,}", "5,000+"),
        Figure("prompts per trajectory", f"{s.prompts_per_episode:.2f}", "2-3"),
        Figure(
            "prompts by kind",
            _counts({k.replace("_", "-"): n for k, n in s.prompts_per_kind.items()}),
            "up to one of each of three kinds",
        ),
        Figure("kept by the verdict", _share(s.flights - s.dropped, s.flights), NOT_STATED),
        Figure("kept, but nothing sure to say", _share(s.kept_without_prompts, s.flights - s.dropped), NOT_STATED),
        Figure("categories", _counts(s.scenes_per_category), PAPER_CATEGORIES),
    ]
    shares = zip(s.length_histogram.items(), PAPER_LENGTH_SHARES, strict=True) if s.length_histogram else ()
    return lines + [
        Figure(f"length {name} m", f"{count / max(s.episodes, 1):.1%}", f"{paper:.1%}")
        for (name, count), paper in shares
    ]


def statistics_of_export(folder: Path) -> DatasetStatistics:
    """The statistics that every export carries.

    Raises:
        ProductError: ``folder`` has no ``statistics.json``, or it is not one of ours.
    """
    path = folder / "statistics.json"
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return DatasetStatistics(**{f.name: found[f.name] for f in fields(DatasetStatistics) if f.name in found})
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise ProductError(
            f"{path} is missing or no data set's statistics ({error}); give an export's folder"
        ) from error


def share_of_tables(scene: str, folders: Mapping[str, Path]) -> SceneShare:
    """What a scene adds, from a few columns of its products' tables (`TABLES`): no state or video is read.

    A kept flight with a prompt is an episode; splits and costs are left out.
    """
    at = {asset: folders[asset] / name for asset, name in TABLES.items()}
    description = json.loads(at["description"].read_text(encoding="utf-8"))
    labels = Counter(pq.read_table(at["boxes"], columns=["label"])["label"].to_pylist())
    flights = pq.read_table(at["trajectories"], columns=["flight_id", "length", "duration"]).to_pylist()
    verdicts = pq.read_table(at["quality_verdict"], columns=["flight_id", "keep", "gates"]).to_pylist()
    prompts = pq.read_table(at["prompts"], columns=["flight_id", "kind"]).to_pylist()
    kept = {v["flight_id"] for v in verdicts if v["keep"]}
    episodes = [f for f in flights if f["flight_id"] in kept & {p["flight_id"] for p in prompts}]
    return SceneShare(
        counts=SceneCounts(
            scene=scene,
            category=description["category"],
            objects=labels.total(),
            flights=len(flights),
            rejected_tasks=pq.read_metadata(folders["trajectories"] / "rejected.parquet").num_rows,
            dropped=len(verdicts) - len(kept),
            kept_without_prompts=len(kept) - len(episodes),
            episodes=len(episodes),
        ),
        subcategory=description["subcategory"],
        labels=dict(labels),
        lengths=tuple(f["length"] for f in episodes),
        kinds=dict(Counter(p["kind"] for p in prompts)),
        long_prompts=pq.read_metadata(folders["prompts"] / "long_prompts.parquet").num_rows,
        held_out_prompts=0,
        splits={},
        gates=dict(Counter(g["gate"] for v in verdicts for g in v["gates"] if not g["passed"])),
        frames=pq.read_metadata(at["frames"]).num_rows,
        duration=sum(f["duration"] for f in episodes),
        terms="",
        tools={},
        usd=0.0,
        computing=0.0,
    )


def _span(objects: Mapping[str, float]) -> str:
    return f"{objects.get('min', 0):.0f} to {objects.get('max', 0):.0f}"


def _share(part: int, whole: int) -> str:
    return f"{part:,} of {whole:,} ({part / max(whole, 1):.1%})"


def _counts(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{name} {count:,}" for name, count in counts.items()) or NOT_STATED
