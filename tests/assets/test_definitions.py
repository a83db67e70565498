"""What Dagster loads: the thirteen products and the data set, by way of workspace.yaml as `make dev` does."""

import subprocess
import sys
from pathlib import Path

import dagster as dg
import pytest

from flymirage_assets.definitions import build_definitions
from flymirage_assets.executors import ray_environment
from flymirage_assets.home import PROCESS_TAG, close_dead_runs, process_tags, tag_with_process
from flymirage_assets.report import SCENE_PRODUCTS
from flymirage_core.settings import PlannerSettings, Settings


def test_the_assets_are_the_products_of_the_paper() -> None:
    keys = {key.path[-1] for key in build_definitions(Settings()).resolve_all_asset_keys()}
    assert {*SCENE_PRODUCTS, "dataset", "lerobot", "growth_report"} <= keys


def test_every_asset_says_what_it_is_who_owns_it_where_its_code_is_and_what_a_record_holds() -> None:
    graph = build_definitions(Settings()).resolve_asset_graph()
    for key in graph.get_all_asset_keys():
        asset = graph.get(key)
        assert asset.kinds and "python" not in asset.kinds, key
        assert asset.owners and asset.group_name and asset.description, key
        assert asset.metadata["dagster/column_schema"].columns, key
        (place,) = asset.metadata["dagster/code_references"].code_references
        assert isinstance(place, dg.LocalFileCodeReference) and Path(place.file_path).exists(), key


def test_a_setting_changes_the_code_versions_of_the_stages_that_read_it_alone() -> None:
    def versions(settings: Settings) -> dict[str, str | None]:
        graph = build_definitions(settings).resolve_asset_graph()
        return {key.path[-1]: graph.get(key).code_version for key in graph.get_all_asset_keys()}

    plain, faster = versions(Settings()), versions(Settings(planner=PlannerSettings(max_speed=1.0)))
    changed = {name for name in plain if plain[name] != faster[name]}
    assert changed == {"trajectories", "quality_verdict"}  # the gates measure against the same limits


def test_the_workspace_loads_as_dagster_dev_loads_it() -> None:
    root = Path(__file__).parents[2]
    command = [sys.executable, "-m", "dagster", "definitions", "validate", "-w", "workspace.yaml"]
    outcome = subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=120, check=False)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr


@dg.op
def nothing() -> None: ...


@dg.job
def idle_job() -> None:
    nothing()


@pytest.mark.parametrize(("tags", "closed"), [(process_tags(), 0), ({**process_tags(), PROCESS_TAG: "1-7-gone"}, 1)])
def test_runs_of_killed_processes_are_closed_and_others_left(tags: dict[str, str], closed: int) -> None:
    with dg.instance_for_test() as instance:
        run = instance.create_run_for_job(idle_job, status=dg.DagsterRunStatus.STARTED, tags=tags)
        assert close_dead_runs(instance) == closed
        stored = instance.get_run_by_id(run.run_id)
        assert stored is not None
        assert (stored.status == dg.DagsterRunStatus.FAILURE) == bool(closed)


def test_a_retry_is_not_taken_for_the_killed_run_whose_tags_it_has() -> None:
    with dg.instance_for_test() as instance:
        started, tags = dg.DagsterRunStatus.STARTED, {**process_tags(), PROCESS_TAG: "1-7-gone"}
        killed = instance.create_run_for_job(idle_job, status=started, tags=tags)
        retry = {"parent_run_id": killed.run_id, "root_run_id": killed.run_id}
        retried = instance.create_run_for_job(idle_job, status=started, tags=tags, **retry)
        assert close_dead_runs(instance) == 1
        statuses = [run.status for run in instance.get_runs(dg.RunsFilter(run_ids=[retried.run_id]))]
        assert statuses == [started]
        tag_with_process(instance, retried)
        assert close_dead_runs(instance) == 0


def test_stages_on_ray_have_the_settings_of_this_process_and_none_of_its_secrets(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("PLANNER__MAX_SPEED", "PG_PASSWORD", "OPERATION__WEBHOOK_URL"):
        monkeypatch.setenv(f"FLYMIRAGE_{name}", "1")
    names = ray_environment()
    assert {"DAGSTER_HOME", "FLYMIRAGE_PLANNER__MAX_SPEED"} <= set(names)
    assert not {"FLYMIRAGE_PG_PASSWORD", "FLYMIRAGE_OPERATION__WEBHOOK_URL"} & set(names)
