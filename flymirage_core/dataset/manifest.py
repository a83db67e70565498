"""`DatasetManifest`, the product of the `dataset` asset: all episodes, splits, statistics, terms and conventions."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from flymirage_core.dataset.card import dataset_card
from flymirage_core.dataset.changelog import DataVersion, changelog_text, scene_hash, with_next_version
from flymirage_core.dataset.conventions import conventions
from flymirage_core.dataset.episodes import EPISODE_SCHEMA, Episode, episodes_from, episodes_of, episodes_table
from flymirage_core.dataset.scene_products import SceneSource
from flymirage_core.dataset.splits import SPLIT_RULE, SPLITS
from flymirage_core.dataset.statistics import DatasetStatistics, SceneShare, statistics_of
from flymirage_core.errors import ProductError
from flymirage_core.rendering.frames import CameraRig

MANIFEST_VERSION = 2


@dataclass(frozen=True)
class DatasetManifest:
    """The table of contents of a data set; pictures and states stay with their products."""

    episodes: tuple[Episode, ...]
    scenes: tuple[SceneShare, ...]
    conventions: dict[str, Any]
    versions: tuple[DataVersion, ...]  # the last one is this

    @cached_property
    def statistics(self) -> DatasetStatistics:
        return statistics_of(self.scenes)

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
        return dataset_card(self.scenes, self.versions)

    def save(self, folder: Path) -> None:
        """manifest.json, episodes.parquet, statistics.json, conventions.json, README.md, CHANGELOG.md."""
        folder.mkdir(parents=True, exist_ok=True)
        pq.write_table(episodes_table(self.episodes), folder / "episodes.parquet")
        _write_json(folder / "statistics.json", self.statistics.as_dict())
        _write_json(folder / "conventions.json", self.conventions)
        (folder / "README.md").write_text(self.card())
        (folder / "CHANGELOG.md").write_text(changelog_text(self.versions))
        manifest = {
            "version": MANIFEST_VERSION,
            "splits": {
                "rule": SPLIT_RULE,
                "episodes": {split: [e.episode_id for e in self.episodes if e.split == split] for split in SPLITS},
            },
            "scenes": [asdict(s) for s in self.scenes],
            "versions": [v.as_dict() for v in self.versions],
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
            tuple(SceneShare.from_dict(s) for s in manifest["scenes"]),
            json.loads((folder / "conventions.json").read_text()),
            tuple(DataVersion.from_dict(v) for v in manifest["versions"]),
        )


def build_manifest(scenes: Iterable[SceneSource], earlier: tuple[DataVersion, ...] = ()) -> DatasetManifest:
    """One pass over the scenes; each is let go before the next is asked for. ``earlier`` are the data set's versions
    so far: the manifest has one more if anything differs from the last."""
    shares: list[SceneShare] = []
    episodes: list[Episode] = []
    rigs: list[tuple[str, CameraRig]] = []
    hashes: dict[str, str] = {}
    for source in scenes:
        products = source.products()
        own = tuple(episodes_of(products))
        shares.append(SceneShare.of(products, own))
        episodes += own
        rigs.append((products.scene, products.frames.rig))
        hashes[products.scene] = scene_hash(products.data_versions)
    versions = with_next_version(earlier, hashes, len(episodes))
    return DatasetManifest(tuple(episodes), tuple(shares), conventions(rigs), versions)


def _write_json(path: Path, value: Any) -> None:
    path.write_text(json.dumps(value, indent=2) + "\n")
