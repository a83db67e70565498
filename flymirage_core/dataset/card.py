"""The data set's card: a README.md with its figures beside the paper's, its terms, its makers and its conventions."""

from collections import Counter
from collections.abc import Iterable, Sequence

from flymirage_core.dataset.changelog import DataVersion
from flymirage_core.dataset.scene_products import BOXER_TERMS
from flymirage_core.dataset.statistics import (
    PAPER_LENGTH_SHARES,
    PAPER_MEAN_LENGTH,
    PAPER_MEDIAN_LENGTH,
    DatasetStatistics,
    SceneShare,
    length_bin_names,
    statistics_of,
)

SPLIT_MEANINGS = {
    "train": "what may be trained on",
    "val_seen": "whole task sets held out of training scenes",
    "val_unseen": "whole scenes held out",
    "test_unseen_category": "whole kinds of places held out",
    "test_unseen_instruction": "flights of training scenes whose every instruction is held out",
}
KIND_MEANINGS = {
    "object_centred": "by what it is",
    "relative": "by what it is near",
    "appearance": "by how it looks",
}
CITATION = """```bibtex
@article{flymirage2026,
  title   = {FlyMirage: A Fully Automated Generation Pipeline for Diverse and Scalable UAV Flight Data via
             Generative World Model},
  journal = {arXiv preprint arXiv:2605.19600},
  year    = {2026}
}
```"""


def hub_header(shares: tuple[SceneShare, ...]) -> str:
    """What the Hugging Face hub reads at the top of a LeRobot folder's card; its licence is the strictest that lies
    on any scene."""
    strict = any(BOXER_TERMS in share.terms for share in shares)
    licence = "license: cc-by-nc-4.0" if strict else "license: other\nlicense_name: see-terms-below"
    return f"""---
pretty_name: FlyMirage
{licence}
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


def dataset_card(shares: tuple[SceneShare, ...], versions: tuple[DataVersion, ...]) -> str:
    """Markdown; the same data set gives the same text."""
    s = statistics_of(shares)
    version = f", data version {versions[-1].number} (`{versions[-1].digest}`)" if versions else ""
    return "\n".join(
        [
            "# An aerial vision-language-navigation data set, made by FlyMirage",
            "",
            f"{s.episodes} flights with {s.prompts} instructions in {s.scenes} Gaussian-splat "
            f"{'scene' if s.scenes == 1 else 'scenes'}; {s.frames} frames of RGB, metric depth "
            f"and 6-DoF pose ({s.hours:.2f} h of flight){version}.",
            "",
            *_figures(s),
            *_prompts_and_splits(s),
            *_left_out(s),
            *_scenes(shares),
            *_terms_and_makers(shares, s),
            "## Conventions",
            "World frame z up, metres, radians, seconds; quaternions xyzw body (FLU) to world; camera OpenCV; depth "
            "uint16 millimetres, 0 = no return. All else, with K, T_body_camera and formulas: `conventions.json`.",
            "",
            "## Citation",
            CITATION,
            "",
        ]
    )


def markdown_table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n" + "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _figures(s: DatasetStatistics) -> list[str]:
    return [
        "## Figures",
        markdown_table(
            ("", "here", "paper"),
            [
                ("objects in a scene (min / median / max)", _span(s.objects_per_scene), "60-100"),
                ("distinct labels", str(s.labels), "> 5,000 in 500 scenes"),
                ("mean flight, m", f"{s.mean_length:.2f}", f"{PAPER_MEAN_LENGTH}"),
                ("median flight, m", f"{s.median_length:.2f}", f"{PAPER_MEDIAN_LENGTH}"),
                ("prompts for a flight", f"{s.prompts_per_episode:.2f}", "2-3"),
            ],
        ),
        "### Kinds of places",
        markdown_table(("category", "scenes", "share"), _shares(s.scenes_per_category)),
        "### Flown length",
        markdown_table(("metres", "flights", "share", "published share"), _lengths(s)),
        "### Commonest labels",
        markdown_table(("label", "boxes", "share"), _shares(s.commonest_labels, s.objects)),
    ]


def _prompts_and_splits(s: DatasetStatistics) -> list[str]:
    kinds = [(f"`{k}`", str(v), KIND_MEANINGS.get(k, "")) for k, v in s.prompts_per_kind.items()]
    kinds.append(("long", str(s.long_prompts), "over several flights, one after the other"))
    splits = [(f"`{k}`", str(v), SPLIT_MEANINGS.get(k, "")) for k, v in s.episodes_per_split.items()]
    return [
        "### Prompts and splits",
        markdown_table(("kind of prompt", "prompts", "how it says where to"), kinds),
        markdown_table(("split", "flights", "meaning"), splits),
        "Splits follow from hashes of the scene's kind, its key and the task set: adding scenes moves nothing. "
        f"{s.held_out_prompts} instructions of training flights are held out too (instruction-unseen).",
        "",
    ]


def _left_out(s: DatasetStatistics) -> list[str]:
    return [
        "## What was left out, and why",
        f"Flights flown: {s.flights}; further tasks that could not be planned: {s.rejected_tasks}; dropped by the "
        f"verdict: {s.dropped}; kept, but without an unambiguous instruction and so no episode: "
        f"{s.kept_without_prompts}.",
        "",
        markdown_table(("gate failed (a flight may fail several)", "flights"), _counts(s.dropped_by_gate)),
    ]


def _scenes(shares: tuple[SceneShare, ...]) -> list[str]:
    rows = [
        (c.scene, c.category, str(c.objects), str(c.flights), str(c.dropped), str(c.episodes))
        for c in (share.counts for share in shares)
    ]
    return ["## Scenes", markdown_table(("scene", "category", "objects", "flown", "dropped", "episodes"), rows)]


def _terms_and_makers(shares: tuple[SceneShare, ...], s: DatasetStatistics) -> list[str]:
    terms: Counter[str] = Counter()
    for share in shares:
        terms[share.terms] += share.counts.episodes
    makers = sorted({(asset, tool) for share in shares for asset, tool in share.tools.items()})
    scenes = max(s.scenes, 1)
    return [
        "## Terms",
        markdown_table(("terms that lie on the data", "episodes"), _counts(dict(sorted(terms.items())))),
        "## Makers and costs",
        markdown_table(("product", "made by"), _pairs(makers)),
        f"${s.usd:.2f} paid for services (${s.usd / scenes:.2f} a scene), {s.computing_hours:.2f} hours of computing "
        f"({60 * s.computing_hours / scenes:.1f} minutes a scene). The paper: about $2 a scene.",
        "",
    ]


def _lengths(s: DatasetStatistics) -> list[tuple[str, ...]]:
    total = max(s.episodes, 1)
    return [
        (name, str(s.length_histogram[name]), f"{s.length_histogram[name] / total:.1%}", f"{paper:.2%}")
        for name, paper in zip(length_bin_names(), PAPER_LENGTH_SHARES, strict=True)
    ]


def _span(values: dict[str, float]) -> str:
    return " / ".join(f"{values[k]:.0f}" for k in ("min", "median", "max"))


def _shares(counts: dict[str, int], total: int = 0) -> list[tuple[str, ...]]:
    total = total or sum(counts.values())
    return [(name, str(n), f"{n / total:.1%}") for name, n in counts.items()] or [("none", "0", "")]


def _counts(counts: dict[str, int]) -> list[tuple[str, ...]]:
    return [(name, str(count)) for name, count in counts.items()] or [("none", "0")]


def _pairs(pairs: Iterable[tuple[str, str]]) -> list[tuple[str, ...]]:
    return list(pairs) or [("not recorded", "")]
