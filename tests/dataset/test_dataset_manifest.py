"""Episodes, splits, statistics and the manifest: what counts, where it goes, and that it comes back from disk."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from filmed_room import renamed, scene_products
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.dataset.episodes import SceneProducts, episodes_of, licence_of
from flymirage_core.dataset.manifest import DatasetManifest, build_manifest
from flymirage_core.dataset.splits import SPLITS, split_of
from flymirage_core.dataset.statistics import length_bin_names, length_histogram
from flymirage_core.errors import ProductError
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.scene.description import Provenance

PUBLISHED = {
    "cafe": ["val_seen", "train", "train", "train", "train", "val_seen"],
    "home": [
        "train",
        "val_seen",
        "val_unseen",
        "train",
        "val_unseen",
        "train",
        "train",
        "val_seen",
        "train",
        "train",
        "val_unseen",
        "train",
    ],
}


@pytest.fixture(scope="module")
def cafe(tmp_path_factory: pytest.TempPathFactory) -> SceneProducts:
    return scene_products(tmp_path_factory.mktemp("cafe"), frames=4)


def drop(products: SceneProducts, flight_id: int) -> SceneProducts:
    """The same scene with one flight failing one gate."""
    verdicts = []
    for verdict in products.verdicts:
        if verdict.flight_id == flight_id:
            bad = replace(verdict.gates[1], passed=False, reason="blurred")
            verdict = replace(verdict, keep=False, gates=(verdict.gates[0], bad, *verdict.gates[2:]))
        verdicts.append(verdict)
    return replace(products, verdicts=QualityVerdicts(tuple(verdicts)))


class TestEpisodes:
    def test_each_kept_flight_with_a_prompt_is_one_episode_with_everything_about_it(self, cafe: SceneProducts) -> None:
        episodes = list(episodes_of(cafe))
        assert [e.episode_id for e in episodes] == ["cafe/0000", "cafe/0001", "cafe/0002"]
        last = episodes[-1]
        assert (last.object_label, last.frame_count, last.frame_rate) == ("bookshelf", 8, 10.0)
        assert last.start_position == tuple(cafe.trajectories.flights[2].positions[0])
        assert last.data_versions == {"boxes": "ab12"} and len(last.gates) == 10

    def test_a_dropped_flight_is_no_episode(self, cafe: SceneProducts) -> None:
        assert [e.flight_id for e in episodes_of(drop(cafe, 1))] == [0, 2]

    def test_a_kept_flight_of_which_nothing_can_be_said_is_counted_and_is_no_episode(self, cafe: SceneProducts) -> None:
        silent = replace(cafe, prompts=Prompts(tuple(p for p in cafe.prompts if p.flight_id != 1)))
        manifest = build_manifest([silent])
        assert [e.flight_id for e in manifest.episodes] == [0, 2]
        assert manifest.statistics.kept_without_prompts == 1
        assert "1 kept ones have no unambiguous instruction" in manifest.card()

    def test_terms_name_who_imposes_them(self, cafe: SceneProducts) -> None:
        assert licence_of(cafe) == "no third-party terms"
        imported = Provenance(kind="imported", writer="import", file_name="flat.spz")
        described = cafe.description.model_copy(update={"provenance": imported})
        assert "flat.spz" in licence_of(replace(cafe, description=described))
        boxes = replace(cafe.boxes, boxes=tuple(replace(b, annotator="boxer d364743") for b in cafe.boxes))
        assert "CC-BY-NC-4.0" in licence_of(replace(cafe, boxes=boxes))


class TestSplits:
    @given(st.lists(st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True), min_size=2, max_size=30, unique=True))
    def test_growth_never_reassigns_a_scene(self, scenes: list[str]) -> None:
        def assigned(some: list[str]) -> dict[tuple[str, int], str]:
            return {(scene, index): split_of(scene, index) for scene in some for index in range(3)}

        early, late = assigned(scenes[:-1]), assigned(scenes[::-1])
        assert early.items() <= late.items()

    def test_an_unseen_scene_is_unseen_in_all_of_its_flights(self) -> None:
        for scene in (f"scene-{i}" for i in range(200)):
            splits = {split_of(scene, index) for index in range(20)}
            assert splits == {"val_unseen"} or "val_unseen" not in splits

    def test_shares_are_about_a_tenth_each(self) -> None:
        splits = [split_of(f"scene-{i}", index) for i in range(500) for index in range(8)]
        shares = {s: splits.count(s) / len(splits) for s in SPLITS}
        assert 0.05 < shares["val_unseen"] < 0.15 and 0.05 < shares["val_seen"] < 0.15

    def test_the_rule_of_published_data_is_frozen(self) -> None:
        """These answers are in data sets that people trained on: if this test fails, the change is wrong."""
        assert [split_of("cafe", i) for i in range(6)] == PUBLISHED["cafe"]
        assert [split_of(f"home-{i:02d}", 0) for i in range(12)] == PUBLISHED["home"]


class TestStatistics:
    def test_lengths_fall_into_the_published_bins_lower_edge_included(self) -> None:
        counts = length_histogram([0.5, 2.0, 3.99, 4.0, 9.9, 10.0, 15.9, 16.0, 80.0])
        assert list(counts) == ["0-2", "2-4", "4-6", "6-8", "8-10", "10-12", "12-14", "14-16", "16+"]
        assert list(counts.values()) == [1, 2, 1, 0, 1, 1, 0, 1, 2]

    @given(st.lists(st.floats(0, 200), max_size=50))
    def test_no_flight_is_lost_or_counted_twice(self, lengths: list[float]) -> None:
        counts = length_histogram(lengths)
        assert sum(counts.values()) == len(lengths)
        assert list(counts) == length_bin_names()

    def test_counts_add_up_over_scenes_and_reasons_are_told(self, cafe: SceneProducts) -> None:
        statistics = build_manifest(iter([cafe, drop(renamed(cafe, "hall"), 0)])).statistics
        assert (statistics.scenes, statistics.flights, statistics.episodes, statistics.dropped) == (2, 6, 5, 1)
        assert statistics.dropped_by_gate == {"sharpness": 1}
        assert statistics.labels == 4 and statistics.objects_per_scene["median"] == 5
        assert sum(statistics.prompts_per_kind.values()) == statistics.prompts
        lengths = [f.report.length for f in cafe.trajectories]
        assert statistics.mean_length == pytest.approx(np.mean([*lengths, *lengths[1:]]), abs=1e-3)

    def test_a_data_set_without_scenes_is_empty_and_not_an_error(self) -> None:
        manifest = build_manifest([])
        assert manifest.summary()["episodes"] == 0
        assert "0 flights" in manifest.card()


class TestManifest:
    def test_it_comes_back_from_disk_as_it_was(self, cafe: SceneProducts, tmp_path: Path) -> None:
        manifest = build_manifest([cafe])
        manifest.save(tmp_path)
        assert DatasetManifest.load(tmp_path) == manifest
        files = {p.name for p in tmp_path.iterdir()}
        assert files == {"manifest.json", "episodes.parquet", "statistics.json", "conventions.json", "README.md"}

    def test_the_same_products_give_the_same_bytes(self, cafe: SceneProducts, tmp_path: Path) -> None:
        for name in ("one", "two"):
            build_manifest([cafe]).save(tmp_path / name)
        for path in (tmp_path / "one").iterdir():
            assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes()

    def test_splits_are_listed_and_disjoint(self, cafe: SceneProducts, tmp_path: Path) -> None:
        build_manifest([cafe, renamed(cafe, "hall")]).save(tmp_path)
        listed = json.loads((tmp_path / "manifest.json").read_text())["splits"]["episodes"]
        everything = [e for split in SPLITS for e in listed[split]]
        assert len(everything) == len(set(everything)) == 6

    def test_a_version_of_the_future_is_one_clear_sentence(self, cafe: SceneProducts, tmp_path: Path) -> None:
        build_manifest([cafe]).save(tmp_path)
        text = (tmp_path / "manifest.json").read_text()
        (tmp_path / "manifest.json").write_text(text.replace('"version": 1', '"version": 9', 1))
        with pytest.raises(ProductError, match="has version 9, this FlyMirage reads 1"):
            DatasetManifest.load(tmp_path)
