"""One command, one real data set: what a newcomer gets, and what a crash, a second run or a new setting change."""

import json
import shutil
import signal
from pathlib import Path

import dagster as dg
import pytest
from projects import Project

from flymirage_assets.report import SCENE_PRODUCTS
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.rendering.frames import Frames

SCENE = "scene-0001"


def test_every_product_is_made_with_provenance_and_a_picture(grown: Project) -> None:
    for asset in SCENE_PRODUCTS:
        record = grown.store.current(asset, SCENE)
        assert record is not None, asset
        assert grown.store.is_whole(record)
        assert record.code_version and record.digest and record.seed == SCENE
        preview = grown.store.folder(asset, SCENE) / "preview.jpg"
        assert 1_000 < preview.stat().st_size <= 45_000, asset


def test_flights_end_in_front_of_what_the_prompts_name(grown: Project) -> None:
    boxes = BoxMap.load(grown.store.folder("boxes", SCENE))
    flights = {f.flight_id: f for f in Trajectories.load(grown.store.folder("trajectories", SCENE))}
    verdicts = QualityVerdicts.load(grown.store.folder("quality_verdict", SCENE))
    prompts = Prompts.load(grown.store.folder("prompts", SCENE))
    assert len(boxes) > 10 and flights
    assert {p.flight_id for p in prompts} <= set(verdicts.kept) <= set(flights)
    for flight in flights.values():
        target = boxes.by_id(flight.object_id)
        assert target.distance(flight.positions[-1]) < target.distance(flight.positions[0])


def test_frames_follow_the_flight(grown: Project) -> None:
    frames = Frames.load(grown.store.folder("frames", SCENE))
    flights = Trajectories.load(grown.store.folder("trajectories", SCENE))
    for flight in flights:
        recorded = frames.flight(flight.flight_id)
        assert len(recorded) == sum(1 for _ in recorded.rgb()) == sum(1 for _ in recorded.depth())
        assert abs(recorded.table["time"].iloc[-1] - flight.report.duration) <= 1 / frames.rig.frame_rate


def test_the_run_and_its_pictures_are_in_dagster(grown: Project) -> None:
    with dg.DagsterInstance.from_config(str(grown.folder / ".flymirage" / "dagster")) as instance:
        assert instance.get_dynamic_partitions("scene") == [SCENE]
        for asset in SCENE_PRODUCTS:
            event = instance.get_latest_materialization_event(dg.AssetKey(asset))
            assert event is not None and event.asset_materialization is not None
            metadata = event.asset_materialization.metadata
            assert "data:image/jpeg;base64," in str(metadata["picture"].value)
            numbers = {name for name, entry in metadata.items() if isinstance(entry.value, int | float)}
            assert {"seconds", "bytes", "usd"} < numbers - {"reused", "commit_seconds"}, (
                asset
            )  # what the UI plots per partition
            record = grown.store.current(asset, SCENE)
            tags = event.asset_materialization.tags or {}
            assert record is not None and tags["dagster/data_version"] == record.digest


def test_a_second_run_finds_nothing_to_do(grown: Project) -> None:
    before = {a: grown.store.current(a, SCENE) for a in SCENE_PRODUCTS}
    outcome = grown.flymirage("make", SCENE)
    assert outcome.returncode == 0, outcome.stdout
    assert {a: grown.store.current(a, SCENE) for a in SCENE_PRODUCTS} == before
    with dg.DagsterInstance.from_config(str(grown.folder / ".flymirage" / "dagster")) as instance:
        event = instance.get_latest_materialization_event(dg.AssetKey("boxes"))
    assert event is not None and event.asset_materialization is not None
    metadata = event.asset_materialization.metadata
    assert metadata["reused"].value is True and "data:image/jpeg;base64," in str(metadata["picture"].value)


def test_a_planner_change_rebuilds_trajectories_and_what_follows_and_nothing_else(
    grown: Project, tmp_path: Path
) -> None:
    project = Project(tmp_path / "copy")
    shutil.copytree(grown.folder, project.folder)
    before = {a: project.store.current(a, SCENE) for a in SCENE_PRODUCTS}
    outcome = project.flymirage("make", SCENE, FLYMIRAGE_PLANNER__MAX_SPEED="1.0")
    assert outcome.returncode == 0, outcome.stdout
    rebuilt = {a for a in SCENE_PRODUCTS if project.store.current(a, SCENE) != before[a]}
    assert rebuilt == {"trajectories", "frames", "quality_verdict", "prompts"}


@pytest.mark.timeout(600)  # two whole scenes, on two cores that another worker uses too
@pytest.mark.parametrize("instant", ["files committed:4", "staged:10"])
def test_a_killed_run_resumes_and_ends_with_the_same_bytes(grown: Project, project: Project, instant: str) -> None:
    killed = project.flymirage("grow", FLYMIRAGE_FAULT=instant)
    assert killed.returncode == -signal.SIGKILL
    done = len(project.digests(SCENE))
    resumed = project.flymirage("grow")
    assert resumed.returncode == 0, resumed.stdout
    assert done < len(SCENE_PRODUCTS)
    assert project.digests(SCENE) == grown.digests(SCENE)
    with dg.DagsterInstance.from_config(str(project.folder / ".flymirage" / "dagster")) as instance:
        assert sorted(run.status.value for run in instance.get_runs()) == ["FAILURE", "SUCCESS"]


def test_the_export_is_a_lerobot_data_set(grown: Project) -> None:
    outcome = grown.flymirage("export", "lerobot", "--out", "out")
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    info = json.loads((grown.folder / "out" / "meta" / "info.json").read_text())
    kept = QualityVerdicts.load(grown.store.folder("quality_verdict", SCENE)).kept
    assert info["codebase_version"] == "v3.0"
    assert 0 < info["total_episodes"] <= len(kept)


def test_status_shows_the_scene(grown: Project) -> None:
    assert f"{len(SCENE_PRODUCTS)}/{len(SCENE_PRODUCTS)}" in grown.flymirage("status").stdout
    assert "trajectories" in grown.flymirage("status", SCENE).stdout


def test_the_demo_is_one_command_with_a_table_and_the_places_of_things(project: Project) -> None:
    denser = {"FLYMIRAGE_GENERATION__GAUSSIANS": "120000"}  # of fewer, a floor near by lets what backs it shine through
    outcome = project.flymirage("demo", **denser)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    assert "sets = 8" in (project.folder / "flymirage.toml").read_text()
    assert all(asset in outcome.stdout for asset in SCENE_PRODUCTS)
    assert str(project.folder / "data" / "lerobot") in outcome.stdout
    assert (project.folder / "data" / "lerobot" / "meta" / "info.json").exists()
    assert (project.folder / "data" / "gallery" / "scenes" / "demo.html").exists()
    checked = project.flymirage("validate", "data/lerobot")
    assert checked.returncode == 0 and "sound" in checked.stdout, checked.stdout + checked.stderr


@pytest.mark.slow
def test_a_captured_world_becomes_a_data_set(captured_worlds: Path, project: Project) -> None:
    closer = {"FLYMIRAGE_VIEWS__WIDTH": "320", "FLYMIRAGE_VIEWS__HEIGHT": "240", "FLYMIRAGE_TASKS__SETS": "6"}
    outcome = project.flymirage(
        "import", str(captured_worlds / "bedroom_sw_lod2.spz"), "--scene", "my-bedroom", **closer
    )
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    assert len(Trajectories.load(project.store.folder("trajectories", "my-bedroom"))) > 0
