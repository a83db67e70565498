"""The LeRobot export: read back by our reader, checked by lerobot-doctor, and never half-written."""

import hashlib
import json
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from filmed_room import RIG, renamed, scene_products
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from lerobot_doctor.dataset_loader import load_local
from lerobot_doctor.runner import Severity, run_checks

from flymirage_core.dataset import lerobot, lerobot_files, video_join
from flymirage_core.dataset.column_stats import QUANTILES, NumberSketch, PictureCounts, joint_stats
from flymirage_core.dataset.export_folder import ExportReport
from flymirage_core.dataset.flight_columns import flight_columns, into_yaw_frame, poses_from_actions
from flymirage_core.dataset.lerobot import DepthExport, export_lerobot
from flymirage_core.dataset.lerobot_schema import DEPTH_KEY, RGB_KEY
from flymirage_core.dataset.reader import LeRobotFolder
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.errors import InputError, ProductError
from flymirage_core.language.prompts import LongPrompt, Prompts
from flymirage_core.rendering.camera import Intrinsics
from flymirage_core.rendering.frames import CameraRig, Frames


@pytest.fixture(scope="module")
def cafe(tmp_path_factory: pytest.TempPathFactory) -> SceneProducts:
    return scene_products(tmp_path_factory.mktemp("cafe"))


@pytest.fixture(scope="module")
def scenes(cafe: SceneProducts) -> list[SceneProducts]:
    return [cafe, renamed(cafe, "hall")]


@pytest.fixture(scope="module")
def report(scenes: list[SceneProducts], tmp_path_factory: pytest.TempPathFactory) -> ExportReport:
    return export_lerobot(scenes, tmp_path_factory.mktemp("export") / "lerobot")


@pytest.fixture(scope="module")
def export(report: ExportReport) -> LeRobotFolder:
    return LeRobotFolder(report.folder)


def digest(folder: Path) -> dict[str, str]:
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in files}


def test_every_episode_gives_back_its_flights_frames_to_the_bit(export: LeRobotFolder, cafe: SceneProducts) -> None:
    assert [e.length for e in export.episodes] == [len(cafe.frames.flight(e.flight_id)) for e in export.episodes]
    for episode in export.episodes:
        source = cafe.frames.flight(episode.flight_id)
        read = list(export.frames(episode.index))
        assert len(read) == episode.length
        for frame, rgb, depth in zip(read, source.rgb(), source.depth(), strict=True):
            np.testing.assert_array_equal(frame.rgb, rgb)
            np.testing.assert_array_equal(frame.depth, depth)


def test_timestamps_are_whole_frames_within_episodes_and_within_the_video(export: LeRobotFolder) -> None:
    first = 0
    for episode in export.episodes:
        row = episode.row
        times = export.columns(episode.index, ("timestamp", "index"))
        assert times["timestamp"].dtype == np.float32
        np.testing.assert_array_equal(times["timestamp"], (np.arange(episode.length) / 10).astype(np.float32))
        np.testing.assert_array_equal(times["index"], np.arange(first, first + episode.length))
        assert (row["dataset_from_index"], row["dataset_to_index"]) == (first, first + episode.length)
        in_file = sum(e.length for e in export.episodes[: episode.index] if e.scene == episode.scene)
        assert row[f"videos/{RGB_KEY}/from_timestamp"] == in_file / 10
        assert row[f"videos/{RGB_KEY}/to_timestamp"] == (in_file + episode.length) / 10
        first += episode.length


def test_states_are_the_flights_states_and_actions_lead_from_frame_to_frame(
    export: LeRobotFolder, cafe: SceneProducts
) -> None:
    for episode in export.episodes:
        flight = cafe.trajectories.flights[episode.flight_id]
        columns = export.columns(episode.index, ("observation.state", "action", "sim.yaw", "next.done"))
        state, action = columns["observation.state"], columns["action"]
        np.testing.assert_allclose(state[:, :3], flight.positions[::3], atol=1e-6)
        np.testing.assert_allclose(np.abs((state[:, 3:7] * flight.quaternions[::3]).sum(axis=1)), 1.0, atol=1e-6)
        np.testing.assert_allclose(state[:, 7:10], flight.velocities[::3], atol=1e-6)
        positions, yaws = poses_from_actions(state[0, :3].astype(float), flight.yaws[0], action.astype(float))
        np.testing.assert_allclose(positions, flight.positions[::3], atol=1e-5)
        np.testing.assert_allclose(yaws, flight.yaws[::3], atol=1e-5)
        assert (action[-1] == 0).all()
        assert columns["next.done"].tolist() == [False] * (episode.length - 1) + [True]


def test_a_long_instruction_stands_beside_each_flight_of_its_run_and_their_frames_follow_one_another(
    cafe: SceneProducts, tmp_path: Path
) -> None:
    text = "Fly to the red chair, then to the blue one."
    ids = tuple(v.flight_id for v in cafe.verdicts if v.keep)
    flights = tuple(replace(f, set_index=0, leg_index=i) for i, f in enumerate(cafe.trajectories.flights))
    prompts = replace(cafe.prompts, long_prompts=(LongPrompt(0, ids[:2], text, "test"),))
    one_set = replace(cafe, prompts=prompts, trajectories=replace(cafe.trajectories, flights=flights))
    export = LeRobotFolder(export_lerobot([one_set], tmp_path / "out").folder)
    run = [e for e in export.episodes if e.row["flymirage/long_prompt"] == text]
    assert [e.flight_id for e in run] == list(ids[:2])
    assert run[0].row["dataset_to_index"] == run[1].row["dataset_from_index"]
    assert {e.row["flymirage/long_prompt"] for e in export.episodes if e not in run} <= {""}
    half = replace(one_set, prompts=replace(prompts, prompts=prompts.of_flight(ids[0])))
    alone = LeRobotFolder(export_lerobot([half], tmp_path / "half").folder)
    assert [e.row["flymirage/long_prompt"] for e in alone.episodes] == [""], "its second flight is no episode"


def test_one_frames_depth_is_read_without_the_whole_flights(export: LeRobotFolder) -> None:
    for path in sorted((export.folder / "data").rglob("*.parquet")):
        file = pq.ParquetFile(path).metadata
        assert max(file.row_group(i).num_rows for i in range(file.num_row_groups)) <= lerobot_files.ROWS_OF_GROUP


def test_lerobot_doctor_finds_nothing_broken(report: ExportReport) -> None:
    findings = run_checks(load_local(report.folder))
    broken = [m.message for r in findings.results for m in r.messages if m.severity is Severity.FAIL]
    assert broken == []
    assert findings.summary_counts["PASS"] >= 6


def test_a_target_ahead_is_in_the_picture_and_one_behind_is_not(cafe: SceneProducts) -> None:
    flight, frames = cafe.trajectories.flights[0], cafe.frames.flight(0)
    red, blue = (flight_columns(flight, frames, cafe.boxes.by_id(i))["sim.target_in_picture"] for i in (0, 1))
    assert red.all() and not blue.any()


def test_missing_depth_does_not_count_into_the_depth_statistics() -> None:
    depth = np.array([[0, 1000], [3000, 0]], np.uint16)
    stats = PictureCounts.of_depth(depth).stats()
    assert (stats["min"], stats["mean"], stats["max"]) == ([[[1000.0]]], [[[2000.0]]], [[[3000.0]]])


def test_only_state_and_action_carry_the_prefixes_that_lerobot_takes_for_them(export: LeRobotFolder) -> None:
    names = export.info["features"]
    assert [n for n in names if n.startswith("action")] == ["action"]
    assert [n for n in names if n.startswith("observation")] == [RGB_KEY, DEPTH_KEY, "observation.state"]


def test_tasks_are_found_by_their_pandas_index_and_every_prompt_is_one(export: LeRobotFolder) -> None:
    tasks = pd.read_parquet(export.folder / "meta" / "tasks.parquet")
    assert tasks.index.name == "task" and list(tasks.columns) == ["task_index"]
    held_out = {p for e in export.episodes if e.split == "train" for p in e.row["flymirage/held_out_prompts"]}
    assert {p for e in export.episodes for p in e.prompts} - held_out == set(tasks.index)
    for episode in export.episodes:
        (task,) = {f.task for f in export.frames(episode.index)}
        assert task in episode.prompts and episode.row["tasks"][0] == task


def test_splits_are_ranges_that_cover_every_episode_once(export: LeRobotFolder) -> None:
    listed = {
        split: [n for part in text.split(",") for n in range(*(int(x) for x in part.split(":")))]
        for split, text in export.info["splits"].items()
    }
    assert {e.index: e.split for e in export.episodes} == {n: split for split, own in listed.items() for n in own}
    assert sum(len(own) for own in listed.values()) == len(export.episodes)


def test_statistics_are_those_of_the_columns_and_of_the_pictures(export: LeRobotFolder, cafe: SceneProducts) -> None:
    stats = json.loads((export.folder / "meta" / "stats.json").read_text())
    states = np.concatenate(
        [export.columns(e.index, ("observation.state",))["observation.state"] for e in export.episodes]
    )
    np.testing.assert_allclose(stats["observation.state"]["mean"], states.mean(axis=0, dtype=float), atol=1e-9)
    ranks = (states <= np.array(stats["observation.state"]["q50"])).mean(axis=0)
    assert (ranks >= 0.495).all()
    assert stats["observation.state"]["count"] == [len(states)]
    sampled = np.stack([f for i in (0, 1, 2) for f in list(cafe.frames.flight(i).rgb())[::5]]) / 255
    assert np.shape(stats[RGB_KEY]["mean"]) == (3, 1, 1)
    np.testing.assert_allclose(np.ravel(stats[RGB_KEY]["mean"]), sampled.mean(axis=(0, 1, 2)), atol=1e-9)
    np.testing.assert_allclose(np.ravel(stats[RGB_KEY]["std"]), sampled.std(axis=(0, 1, 2)), atol=1e-9)
    assert set(stats) == set(export.info["features"])


def test_other_tools_read_depth_as_16_bit_png_and_vectors_as_fixed_lists(export: LeRobotFolder) -> None:
    table = pq.read_table(export.folder / "data" / "chunk-000" / "file-000.parquet")
    assert str(table.schema.field("observation.state").type) == "fixed_size_list<element: float>[13]"
    assert str(table.schema.field("timestamp").type) == "float"
    png = table[DEPTH_KEY][0].as_py()["bytes"]
    depth = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_UNCHANGED)
    assert depth.dtype == np.uint16 and depth.shape == (48, 64)
    hub = json.loads(table.schema.metadata[b"huggingface"])["info"]["features"]
    assert hub[DEPTH_KEY] == {"_type": "Image"} and hub["action"]["length"] == 4


def test_conventions_tell_the_camera_and_what_an_action_is(export: LeRobotFolder) -> None:
    camera = export.camera("hall")
    assert camera["K"] == RIG.intrinsics.matrix.tolist() and camera["dt"] == 0.1
    assert "Rz" in export.conventions["lerobot"]["action"]["formula"]


def test_without_depth_the_export_has_no_depth_and_is_still_whole(cafe: SceneProducts, tmp_path: Path) -> None:
    report = export_lerobot([cafe], tmp_path / "out", DepthExport.NONE)
    export = LeRobotFolder(report.folder)
    assert DEPTH_KEY not in export.info["features"]
    assert next(export.frames(0)).depth is None
    assert run_checks(load_local(report.folder)).overall_severity is not Severity.FAIL


def test_the_same_products_give_the_same_bytes(
    scenes: list[SceneProducts], report: ExportReport, tmp_path: Path
) -> None:
    again = export_lerobot(iter(scenes), tmp_path / "again")
    assert digest(again.folder) == digest(report.folder)


def test_full_files_are_followed_by_the_next_and_episodes_are_never_cut(
    cafe: SceneProducts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = {"max_bytes": 1000}
    monkeypatch.setattr(lerobot_files, "VideoJoiner", lambda *a: video_join.VideoJoiner(*a, **small))
    monkeypatch.setattr(lerobot_files, "DataFiles", lambda *a, f=lerobot_files.DataFiles: f(*a, **small))
    export = LeRobotFolder(export_lerobot([cafe], tmp_path / "out").folder)
    assert [e.row["data/file_index"] for e in export.episodes] == [0, 1, 2]
    assert [e.row[f"videos/{RGB_KEY}/file_index"] for e in export.episodes] == [0, 1, 2]
    for episode in export.episodes:
        source = list(cafe.frames.flight(episode.flight_id).rgb())
        np.testing.assert_array_equal(list(export.rgb(episode.index)), source)
    assert run_checks(load_local(export.folder)).overall_severity is not Severity.FAIL


class TestGrowth:
    """Adding, changing and removing scenes: only what must be written is, and the result is as if made anew."""

    @pytest.fixture
    def grown(self, scenes: list[SceneProducts], tmp_path: Path) -> Path:
        return export_lerobot(scenes, tmp_path / "out").folder

    def test_a_new_scene_writes_its_own_files_and_the_metadata_and_links_the_rest(
        self, grown: Path, scenes: list[SceneProducts], cafe: SceneProducts
    ) -> None:
        def shard_files(folder: Path) -> dict[str, int]:
            found = [
                p for kind in ("data", "videos", "meta/episodes") for p in (folder / kind).rglob("*.*") if p.is_file()
            ]
            return {str(p.relative_to(folder)): p.stat().st_ino for p in found}

        before = shard_files(grown)
        report = export_lerobot([*scenes, renamed(cafe, "annex")], grown)
        assert (report.written, report.kept) == (("annex",), ("cafe", "hall"))
        after = shard_files(grown)
        assert {name: after[name] for name in before} == before  # the very same files
        assert set(after) - set(before) == {
            "data/chunk-000/file-002.parquet",
            f"videos/{RGB_KEY}/chunk-000/file-002.mp4",
            "meta/episodes/chunk-000/file-002.parquet",
        }
        broken = [r for r in run_checks(load_local(grown)).results if r.severity is Severity.FAIL]
        assert broken == [] and len(LeRobotFolder(grown).episodes) == 9

    def test_unchanged_scenes_are_not_even_read(self, grown: Path, scenes: list[SceneProducts]) -> None:
        @dataclass(frozen=True)
        class Sealed:
            scene: str
            data_versions: dict[str, str]

            def products(self) -> SceneProducts:
                raise AssertionError(f"{self.scene} was read")

        before = digest(grown)
        report = export_lerobot([Sealed(s.scene, s.data_versions) for s in scenes], grown)
        assert report.written == () and digest(grown) == before

    @pytest.mark.parametrize("gone", ["cafe", "hall"])
    def test_a_removed_scene_leaves_no_gap(
        self, grown: Path, scenes: list[SceneProducts], gone: str, tmp_path: Path
    ) -> None:
        left = [s for s in scenes if s.scene != gone]
        export_lerobot(left, grown)
        anew = digest(export_lerobot(left, tmp_path / "anew").folder)
        history = {"export.json", "CHANGELOG.md", "README.md"}
        assert same_but(digest(grown), anew, history)

    def test_a_changed_scene_is_written_in_its_place_and_those_behind_it_move(
        self, grown: Path, scenes: list[SceneProducts], cafe: SceneProducts, tmp_path: Path
    ) -> None:
        changed = replace(
            cafe,
            prompts=Prompts(tuple(p for p in cafe.prompts if p.flight_id != 1)),
            data_versions={"prompts": "new"},
        )
        report = export_lerobot([changed, scenes[1]], grown)
        assert (report.written, report.kept) == (("cafe",), ("hall",))
        anew = digest(export_lerobot([changed, scenes[1]], tmp_path / "anew").folder)
        assert same_but(digest(grown), anew, {"export.json", "CHANGELOG.md", "README.md"})
        export = LeRobotFolder(grown)
        for episode in export.episodes:
            np.testing.assert_array_equal(
                list(export.rgb(episode.index)), list(cafe.frames.flight(episode.flight_id).rgb())
            )

    def test_one_scene_is_exported_alone(self, scenes: list[SceneProducts], tmp_path: Path) -> None:
        export = LeRobotFolder(export_lerobot(scenes[1:], tmp_path / "hall").folder)
        assert {e.scene for e in export.episodes} == {"hall"} and [e.index for e in export.episodes] == [0, 1, 2]

    def test_the_changelog_tells_the_history(self, grown: Path, scenes: list[SceneProducts]) -> None:
        export_lerobot(scenes[:1], grown)
        text = (grown / "CHANGELOG.md").read_text()
        assert "Added 2 scenes: cafe, hall." in text and "Removed 1 scenes: hall." in text


def same_but(found: dict[str, str], expected: dict[str, str], history: set[str]) -> bool:
    return {k: v for k, v in found.items() if k not in history} == {
        k: v for k, v in expected.items() if k not in history
    }


@given(st.lists(hnp.arrays(float, st.integers(1, 60), elements=st.floats(-9, 9)), min_size=1, max_size=6))
def test_joint_statistics_of_scenes_are_those_of_all_their_frames(parts: list[np.ndarray]) -> None:
    everything = np.concatenate(parts)
    stats = joint_stats([NumberSketch.of(part[:, None]) for part in parts])
    assert stats["count"] == [len(everything)]
    for name in ("min", "max", "mean", "std"):
        np.testing.assert_allclose(stats[name], getattr(np, name)(everything), atol=1e-9)
    for name, rank in QUANTILES.items():
        (value,) = stats[name]
        slack = 0.005 + len(parts) / len(everything)
        assert (everything <= value + 1e-9).mean() >= rank - slack
        assert (everything < value - 1e-9).mean() <= rank + slack


class TestRefusals:
    def test_nothing_to_export_says_where_everything_went(self, cafe: SceneProducts, tmp_path: Path) -> None:
        silent = replace(cafe, prompts=Prompts(()))
        with pytest.raises(InputError, match="3 flights in 1 scenes, 0 dropped by the verdict, 3 kept without"):
            export_lerobot([silent], tmp_path / "out")
        assert not (tmp_path / "out").exists()

    def test_scenes_filmed_at_different_sizes_do_not_share_a_folder(self, cafe: SceneProducts, tmp_path: Path) -> None:
        wide = CameraRig(Intrinsics.from_horizontal_fov(128, 48, 1.4), RIG.T_body_camera, RIG.frame_rate)
        other = replace(renamed(cafe, "hall"), frames=Frames(cafe.frames.folder, wide, cafe.frames.table))
        with pytest.raises(InputError, match="hall was filmed at 128x48, 10 Hz and cafe at 64x48, 10 Hz"):
            export_lerobot([cafe, other], tmp_path / "out")

    def test_a_broken_frame_rate_is_named(self, cafe: SceneProducts, tmp_path: Path) -> None:
        odd = replace(cafe, frames=Frames(cafe.frames.folder, replace(RIG, frame_rate=7.5), cafe.frames.table))
        with pytest.raises(InputError, match=r"7\.5 Hz, but LeRobot takes whole frame rates"):
            export_lerobot([odd], tmp_path / "out")

    def test_a_folder_with_other_things_in_it_is_left_alone(self, cafe: SceneProducts, tmp_path: Path) -> None:
        (tmp_path / "thesis.tex").write_text("years of work")
        with pytest.raises(InputError, match="is not empty and no FlyMirage export"):
            export_lerobot([cafe], tmp_path)
        assert (tmp_path / "thesis.tex").read_text() == "years of work"

    def test_poses_that_do_not_match_the_pictures_fail_the_self_test(self, cafe: SceneProducts, tmp_path: Path) -> None:
        flipped = CameraRig(RIG.intrinsics, tuple(tuple(-x for x in row) for row in RIG.T_body_camera), 10.0)
        wrong = replace(cafe, frames=Frames(cafe.frames.folder, flipped, cafe.frames.table))
        with pytest.raises(ProductError, match="export self-test: the target of episode 0"):
            export_lerobot([wrong], tmp_path / "out")
        assert list(tmp_path.iterdir()) == []

    def test_a_video_with_a_frame_too_few_is_refused(self, cafe: SceneProducts, tmp_path: Path) -> None:
        table = cafe.frames.table
        extra = table[table.flight_id == 2].iloc[[-1]].assign(frame_index=19, time=1.9)
        longer = replace(cafe, frames=Frames(cafe.frames.folder, RIG, pd.concat([table, extra])))
        with pytest.raises(ProductError, match="materialise `frames` again"):
            export_lerobot([longer], tmp_path / "out")


class TestCrashes:
    def test_a_crash_leaves_the_earlier_export_untouched(
        self, cafe: SceneProducts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        folder = tmp_path / "out"
        before = digest(export_lerobot([cafe], folder).folder)

        def disk_full(*_: object) -> None:
            raise OSError("No space left on device")

        monkeypatch.setattr(lerobot, "write_tasks", disk_full)
        with pytest.raises(OSError, match="No space left"):
            export_lerobot([cafe, renamed(cafe, "hall")], folder)
        assert digest(folder) == before
        assert [p.name for p in tmp_path.iterdir()] == ["out"]

    def test_leftovers_of_a_killed_export_do_no_harm(self, cafe: SceneProducts, tmp_path: Path) -> None:
        (tmp_path / ".out.partial" / "data").mkdir(parents=True)
        (tmp_path / ".out.partial" / "data" / "torn.parquet").write_bytes(b"PAR1")
        export_lerobot([cafe], tmp_path / "out")
        assert not list((tmp_path / "out").rglob("torn.parquet"))
        assert [p.name for p in tmp_path.iterdir()] == ["out"]

    def test_a_new_export_replaces_the_old_one_whole(self, cafe: SceneProducts, tmp_path: Path) -> None:
        export_lerobot([cafe, renamed(cafe, "hall")], tmp_path / "out")
        export_lerobot([cafe], tmp_path / "out", DepthExport.NONE)
        assert {e.scene for e in LeRobotFolder(tmp_path / "out").episodes} == {"cafe"}


finite = st.floats(-5, 5)


@settings(max_examples=50)
@given(hnp.arrays(float, (8, 3), elements=finite), hnp.arrays(float, 8, elements=finite))
def test_any_path_is_rebuilt_from_its_actions(positions: np.ndarray, yaws: np.ndarray) -> None:
    actions = np.zeros((8, 4))
    actions[:-1, :3] = into_yaw_frame(np.diff(positions, axis=0), yaws[:-1])
    actions[:-1, 3] = np.diff(yaws)
    rebuilt, turned = poses_from_actions(positions[0], yaws[0], actions)
    np.testing.assert_allclose(rebuilt, positions, atol=1e-9)
    np.testing.assert_allclose(turned, yaws, atol=1e-9)


def test_an_action_ahead_is_positive_x_and_to_the_left_positive_y() -> None:
    north = np.array([np.pi / 2])
    np.testing.assert_allclose(into_yaw_frame(np.array([[0.0, 1.0, 0.0]]), north), [[1.0, 0.0, 0.0]], atol=1e-12)
    np.testing.assert_allclose(into_yaw_frame(np.array([[-1.0, 0.0, 0.0]]), north), [[0.0, 1.0, 0.0]], atol=1e-12)
