"""`DatasetManifest`, the product of the `dataset` asset: all episodes, splits, statistics, terms and conventions."""

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from flymirage_core.dataset.card import dataset_card
from flymirage_core.dataset.conventions import conventions
from flymirage_core.dataset.episodes import (
    EPISODE_SCHEMA,
    Episode,
    SceneProducts,
    episodes_from,
    episodes_of,
    episodes_table,
)
from flymirage_core.dataset.splits import SEEN_SHARE, SPLITS, UNSEEN_SHARE
from flymirage_core.dataset.statistics import DatasetStatistics, SceneCounts, Tally
from flymirage_core.errors import ProductError
from flymirage_core.rendering.frames import CameraRig

MANIFEST_VERSION = 1


@dataclass(frozen=True)
class DatasetManifest:
    """The table of contents of a data set; pictures and states stay with their products."""

    episodes: tuple[Episode, ...]
    scenes: tuple[SceneCounts, ...]
    statistics: DatasetStatistics
    conventions: dict[str, Any]

    def summary(self) -> dict[str, str | int | float]:
        s = self.statistics
        return {
            "scenes": s.scenes,
            "episodes": s.episodes,
            "frames": s.frames,
            "prompts": s.prompts,
            "prompts_per_episode": s.prompts_per_episode,
            "mean_length_m": s.mean_length,
            "median_length_m": s.median_length,
            "dropped": s.dropped,
            "kept_without_prompts": s.kept_without_prompts,
            **{f"{split}_episodes": count for split, count in s.episodes_per_split.items()},
        }

    def card(self) -> str:
        """README.md of the data set."""
        return dataset_card(self.statistics, self.scenes, Counter(e.licence for e in self.episodes))

    def save(self, folder: Path) -> None:
        """manifest.json, episodes.parquet, statistics.json, conventions.json, README.md."""
        folder.mkdir(parents=True, exist_ok=True)
        pq.write_table(episodes_table(self.episodes), folder / "episodes.parquet")
        _write_json(folder / "statistics.json", self.statistics.as_dict())
        _write_json(folder / "conventions.json", self.conventions)
        (folder / "README.md").write_text(self.card())
        manifest = {
            "version": MANIFEST_VERSION,
            "splits": {
                "rule": "sha256 of the scene key, and of scene key and task set",
                "val_unseen_share_of_scenes": UNSEEN_SHARE,
                "val_seen_share_of_task_sets": SEEN_SHARE,
                "episodes": {split: [e.episode_id for e in self.episodes if e.split == split] for split in SPLITS},
            },
            "scenes": [asdict(s) for s in self.scenes],
        }
        _write_json(folder / "manifest.json", manifest)

    @staticmethod
    def load(folder: Path) -> "DatasetManifest":
        """Raises `ProductError` if the folder is of a version that this code does not read."""
        manifest = json.loads((folder / "manifest.json").read_text())
        if manifest.get("version") != MANIFEST_VERSION:
            raise ProductError(
                f"{folder / 'manifest.json'} has version {manifest.get('version')!r}, this FlyMirage reads "
                f"{MANIFEST_VERSION}; materialise `dataset` again"
            )
        return DatasetManifest(
            episodes_from(pq.read_table(folder / "episodes.parquet", schema=EPISODE_SCHEMA)),
            tuple(SceneCounts(**s) for s in manifest["scenes"]),
            DatasetStatistics(**json.loads((folder / "statistics.json").read_text())),
            json.loads((folder / "conventions.json").read_text()),
        )


def build_manifest(scenes: Iterable[SceneProducts]) -> DatasetManifest:
    """One pass over the scenes; each is let go before the next is asked for."""
    tally = Tally()
    episodes: list[Episode] = []
    rigs: list[tuple[str, CameraRig]] = []
    for products in scenes:
        own = tuple(episodes_of(products))
        tally.add(products, own)
        episodes += own
        rigs.append((products.scene, products.frames.rig))
    return DatasetManifest(tuple(episodes), tuple(tally.scenes), tally.statistics(), conventions(rigs))


def _write_json(path: Path, value: Any) -> None:
    path.write_text(json.dumps(value, indent=2) + "\n")
