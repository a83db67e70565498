"""The data set's card: a README.md with its figures beside the paper's, its terms and its conventions."""

from collections import Counter

from flymirage_core.dataset.statistics import (
    PAPER_LENGTH_SHARES,
    PAPER_MEAN_LENGTH,
    PAPER_MEDIAN_LENGTH,
    DatasetStatistics,
    SceneCounts,
    length_bin_names,
)

HUB_HEADER = """---
pretty_name: FlyMirage
task_categories:
- robotics
language:
- en
tags:
- LeRobot
- vision-language-navigation
- aerial
- gaussian-splatting
- depth
configs:
- config_name: default
  data_files: data/*/*.parquet
---

"""
"""What the Hugging Face hub reads at the top of a LeRobot folder's card."""


def dataset_card(statistics: DatasetStatistics, scenes: tuple[SceneCounts, ...], licences: Counter[str]) -> str:
    """Markdown; the same data set gives the same text."""
    s = statistics
    share = s.prompts_per_episode
    return "\n".join(
        [
            "# An aerial vision-language-navigation data set, made by FlyMirage",
            "",
            f"{s.episodes} flights with {s.prompts} instructions in {s.scenes} Gaussian-splat "
            f"{'scene' if s.scenes == 1 else 'scenes'}; {s.frames} frames of RGB, metric depth "
            f"and 6-DoF pose ({s.hours:.2f} h of flight).",
            "",
            "## Figures",
            _table(
                ("", "here", "paper"),
                [
                    ("objects in a scene (min / median / max)", _span(s.objects_per_scene), "60-100"),
                    ("distinct labels", str(s.labels), "> 5,000 in 500 scenes"),
                    ("mean flight, m", f"{s.mean_length:.2f}", f"{PAPER_MEAN_LENGTH}"),
                    ("median flight, m", f"{s.median_length:.2f}", f"{PAPER_MEDIAN_LENGTH}"),
                    ("prompts for a flight", f"{share:.2f}", "2-3"),
                ],
            ),
            "### Flown length",
            _table(("metres", "flights", "share", "published share"), _lengths(s)),
            "### Prompts and splits",
            _table(("kind of prompt", "prompts"), [(k, str(v)) for k, v in s.prompts_per_kind.items()]),
            _table(("split", "flights"), [(k, str(v)) for k, v in s.episodes_per_split.items()]),
            "Splits follow from a hash of the scene's key and the task set: adding scenes moves nothing. `val_unseen` "
            "holds out whole scenes, `val_seen` whole task sets of training scenes.",
            "",
            "## What was left out, and why",
            f"{s.flights} flights were flown; {s.rejected_tasks} further tasks could not be planned. {s.dropped} "
            f"flights were dropped by the verdict; {s.kept_without_prompts} kept ones have no unambiguous instruction "
            "and are no episodes.",
            "",
            _table(("gate failed (a flight may fail several)", "flights"), _counts(s.dropped_by_gate)),
            "## Scenes",
            _table(
                ("scene", "category", "objects", "flown", "dropped", "episodes"),
                [
                    (c.scene, c.category, str(c.objects), str(c.flights), str(c.dropped), str(c.episodes))
                    for c in scenes
                ],
            ),
            "## Terms",
            _table(("terms that lie on the data", "episodes"), _counts(dict(sorted(licences.items())))),
            "## Conventions",
            "World frame z up, metres, radians, seconds; quaternions xyzw body (FLU) to world; camera OpenCV; depth "
            "uint16 millimetres, 0 = no return. All else, with K, T_body_camera and formulas: `conventions.json`.",
            "",
        ]
    )


def _lengths(s: DatasetStatistics) -> list[tuple[str, ...]]:
    total = max(s.episodes, 1)
    return [
        (name, str(s.length_histogram[name]), f"{s.length_histogram[name] / total:.1%}", f"{paper:.2%}")
        for name, paper in zip(length_bin_names(), PAPER_LENGTH_SHARES, strict=True)
    ]


def _span(values: dict[str, float]) -> str:
    return " / ".join(f"{values[k]:.0f}" for k in ("min", "median", "max"))


def _counts(counts: dict[str, int]) -> list[tuple[str, ...]]:
    return [(name, str(count)) for name, count in counts.items()] or [("none", "0")]


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n" + "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
