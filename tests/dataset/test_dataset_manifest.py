"""Episodes, splits, statistics and the manifest: what counts, where it goes, and that it comes back from disk."""

import json
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import pytest
from filmed_room import renamed, scene_products
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flymirage_core.dataset.card import hub_header
from flymirage_core.dataset.episodes import episodes_of
from flymirage_core.dataset.manifest import DatasetManifest, build_manifest
from flymirage_core.dataset.scene_products import SceneLineage, SceneProducts, terms_of
from flymirage_core.dataset.splits import SPLITS, is_unseen_instruction, split_of
from flymirage_core.dataset.statistics import length_bin_names, length_histogram
from flymirage_core.errors import ProductError
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.scene.description import Provenance
from flymirage_core.scene.taxonomy import standard_taxonomy

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


KEYS = st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True)


def in_place(products: SceneProducts, kind: str) -> SceneProducts:
    """The same scene as another kind of place."""
    return replace(products, description=products.description.model_copy(update={"subcategory": kind}))


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
        assert last.data_versions == {"boxes": "ab12"} and last.gates == list(cafe.verdicts)[2].gates

    def test_a_dropped_flight_is_no_episode(self, cafe: SceneProducts) -> None:
        assert [e.flight_id for e in episodes_of(drop(cafe, 1))] == [0, 2]

    def test_a_kept_flight_of_which_nothing_can_be_said_is_counted_and_is_no_episode(self, cafe: SceneProducts) -> None:
        silent = replace(cafe, prompts=Prompts(tuple(p for p in cafe.prompts if p.flight_id != 1)))
        manifest = build_manifest([silent])
        assert [e.flight_id for e in manifest.episodes] == [0, 2]
        assert manifest.statistics.kept_without_prompts == 1
        assert "without an unambiguous instruction and so no episode: 1" in manifest.card()

    def test_terms_name_who_imposes_them(self, cafe: SceneProducts) -> None:
        assert terms_of(cafe) == "no third-party terms"
        imported = Provenance(kind="imported", writer="import", file_name="flat.spz")
        described = cafe.description.model_copy(update={"provenance": imported})
        assert "flat.spz" in terms_of(replace(cafe, description=described))
        boxes = replace(cafe.boxes, boxes=tuple(replace(b, annotator="boxer d364743") for b in cafe.boxes))
        assert "CC-BY-NC-4.0" in terms_of(replace(cafe, boxes=boxes))
        paid = SceneLineage(tools={"world": "marble 1.2", "boxes": "embedded 3"})
        assert terms_of(replace(cafe, lineage=paid)) == "the terms of marble 1.2"

    def test_non_commercial_terms_reach_the_card_and_its_header(self, cafe: SceneProducts) -> None:
        boxes = replace(cafe.boxes, boxes=tuple(replace(b, annotator="boxer d364743") for b in cafe.boxes))
        manifest = build_manifest([cafe, replace(renamed(cafe, "hall"), boxes=boxes)])
        assert "| CC-BY-NC-4.0, non-commercial (boxes by Boxer) | 3 |" in manifest.card()
        assert "license: cc-by-nc-4.0" in hub_header(manifest.scenes)
        assert "cc-by-nc" not in hub_header(manifest.scenes[:1])


class TestSplits:
    @settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
    @given(
        st.lists(
            st.tuples(KEYS, st.sampled_from(["bakery", "wine bar", "attic"])), min_size=2, max_size=6, unique=True
        ),
        st.randoms(use_true_random=False),
    )
    def test_growth_never_reassigns_an_episode_or_an_instruction(
        self, cafe: SceneProducts, scenes: list[tuple[str, str]], chance: Random
    ) -> None:
        """However a data set grows, in whatever order: what was published stays where it was."""

        def assigned(some: list[tuple[str, str]]) -> dict[str, tuple[str, tuple[str, ...]]]:
            products = [in_place(renamed(cafe, key), kind) for key, kind in dict(some).items()]
            episodes = build_manifest(products).episodes
            return {e.episode_id: (e.split, tuple(p.text for p in e.training_prompts)) for e in episodes}

        scenes = list(dict(scenes).items())
        early = assigned(scenes[: len(scenes) // 2])
        chance.shuffle(scenes)
        assert early.items() <= assigned(scenes).items()

    def test_a_held_out_sentence_is_in_no_training_episode(self) -> None:
        texts = [f"Fly to the {colour} chair number {i}." for colour in ("red", "blue") for i in range(500)]
        held = [t for t in texts if is_unseen_instruction(t)]
        assert 0.07 < len(held) / len(texts) < 0.13

    def test_a_kind_of_place_is_held_out_with_all_its_scenes_and_an_imported_world_never(self) -> None:
        assert {split_of(f"scene-{i}", i % 7, "wine bar") for i in range(200)} == {"test_unseen_category"}
        assert "test_unseen_category" not in {split_of(f"scene-{i}", i % 7) for i in range(200)}
        kinds = [name for c in standard_taxonomy().categories for name in c.subcategories]
        held = [name for name in kinds if split_of("x", 0, name) == "test_unseen_category"]
        assert 0.04 < len(held) / len(kinds) < 0.2

    def test_a_flight_whose_every_instruction_is_held_out_trains_nobody(self, cafe: SceneProducts) -> None:
        said = next(t for t in (f"Go to the chair, take {i}." for i in range(99)) if is_unseen_instruction(t))
        own = tuple(replace(p, text=said) for p in cafe.prompts)
        splits = {e.flight_id: e.split for e in episodes_of(replace(renamed(cafe, "hall"), prompts=Prompts(own)))}
        assert set(splits.values()) <= {"test_unseen_instruction", "val_seen"}
        assert "test_unseen_instruction" in splits.values()

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
        assert statistics.dropped_by_gate == {next(iter(cafe.verdicts)).gates[1].gate: 1}
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
        assert files == {
            "manifest.json",
            "episodes.parquet",
            "statistics.json",
            "conventions.json",
            "README.md",
            "CHANGELOG.md",
        }

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
        (tmp_path / "manifest.json").write_text(text.replace('"version": 2', '"version": 9', 1))
        with pytest.raises(ProductError, match="has version 9, this FlyMirage reads 2"):
            DatasetManifest.load(tmp_path)


class TestChangelog:
    def test_each_change_of_content_is_a_version_that_says_what_changed(self, cafe: SceneProducts) -> None:
        hall, again = renamed(cafe, "hall"), replace(cafe, data_versions={"boxes": "cd34"})
        first = build_manifest([cafe])
        grown = build_manifest([cafe, hall], first.versions)
        changed = build_manifest([again], grown.versions)
        assert [(v.number, v.added, v.changed, v.removed) for v in changed.versions] == [
            (1, ("cafe",), (), ()),
            (2, ("hall",), (), ()),
            (3, (), ("cafe",), ("hall",)),
        ]
        assert [v.episodes for v in changed.versions] == [3, 6, 3]

    def test_the_same_data_are_the_same_version(self, cafe: SceneProducts, tmp_path: Path) -> None:
        first = build_manifest([cafe])
        first.save(tmp_path)
        assert build_manifest([cafe], DatasetManifest.load(tmp_path).versions).versions == first.versions
        assert "Added 1 scenes: cafe." in (tmp_path / "CHANGELOG.md").read_text()
