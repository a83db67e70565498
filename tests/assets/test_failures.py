"""Failures in a real Dagster instance: what is tried again, from where, what is freed, and who is told."""

import json
import os
import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import dagster as dg
import numpy as np
import pytest

from flymirage_assets.home import PROCESS_TAG, close_dead_runs, process_tags
from flymirage_assets.sensors import failure_sensor
from flymirage_assets.stage import Stage, product_asset
from flymirage_core.errors import InputError, TransientServiceError
from flymirage_core.operation_settings import OperationSettings
from flymirage_core.settings import Settings
from resources.io_manager import ProductIOManager

SCENE = "s1"
SETTINGS = Settings(operation=OperationSettings(step_retries=2, retry_delay=0.0))


class Text:
    """A product of one line."""

    def __init__(self, text: str) -> None:
        self.text = text

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True)
        (folder / "text").write_text(self.text)

    @staticmethod
    def load(folder: Path) -> "Text":
        return Text((folder / "text").read_text())

    def summary(self) -> dict[str, str | int | float]:
        return {"letters": len(self.text)}


def draw(stage: Stage, product: Text, **inputs: Text) -> np.ndarray:
    return np.zeros((8, 8, 3), np.uint8)


def two_stages(store: Path, errors: list[Exception]) -> dg.Definitions:
    """``description`` and, from it, ``image``, which fails with each of ``errors`` before it succeeds."""

    @product_asset(version="1", group="test", settings=SETTINGS, draw=draw)
    def description(stage: Stage) -> Text:
        """First."""
        return Text(stage.scene)

    @product_asset(version="1", group="test", settings=SETTINGS, draw=draw)
    def image(stage: Stage, description: Text) -> Text:
        """Second."""
        if errors:
            raise errors.pop(0)
        return Text(f"{description.text} painted")

    return dg.Definitions(
        assets=[description, image],
        jobs=[dg.define_asset_job("grow_scene")],
        resources={"io_manager": ProductIOManager(base=str(store))},
        executor=dg.in_process_executor,
    )


@pytest.fixture
def instance() -> Iterator[dg.DagsterInstance]:
    """An instance on disk, as a project has one, that knows the scene."""
    with dg.instance_for_test() as found:
        found.add_dynamic_partitions("scene", [SCENE])
        yield found


def run(definitions: dg.Definitions, instance: dg.DagsterInstance, **how: object) -> dg.ExecuteInProcessResult:
    job = definitions.resolve_job_def("grow_scene")
    return job.execute_in_process(instance=instance, partition_key=SCENE, raise_on_error=False, **how)  # type: ignore


def test_a_transient_failure_is_tried_again_in_the_same_run(tmp_path: Path, instance: dg.DagsterInstance) -> None:
    result = run(two_stages(tmp_path, [TransientServiceError("busy"), ConnectionError("dropped")]), instance)
    assert result.success
    assert len([e for e in result.all_events if e.event_type_value == "STEP_RESTARTED"]) == 2


def test_a_permanent_failure_is_not_tried_again(tmp_path: Path, instance: dg.DagsterInstance) -> None:
    result = run(two_stages(tmp_path, [InputError("no"), InputError("never")]), instance)
    assert not result.success
    assert not [e for e in result.all_events if e.event_type_value == "STEP_RESTARTED"]


ERRORS: list[Exception] = []


def failing_job() -> dg.JobDefinition:
    return two_stages(Path(os.environ["TWO_STAGES_STORE"]), ERRORS).resolve_job_def("grow_scene")


def test_a_retried_run_goes_on_from_the_stage_that_failed(
    tmp_path: Path, instance: dg.DagsterInstance, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TWO_STAGES_STORE", str(tmp_path))
    monkeypatch.setattr(sys.modules[__name__], "ERRORS", [InputError("no")])
    job, tags = dg.reconstructable(failing_job), {"dagster/partition": SCENE}
    failed = dg.execute_job(job, instance, tags=tags)
    retry = dg.ReexecutionOptions.from_failure(failed.run_id, instance)
    again = dg.execute_job(job, instance, tags=tags, reexecution_options=retry)
    assert not failed.success and again.success
    assert {e.step_key for e in again.all_events if e.is_step_success} == {"image"}


def test_pool_slots_of_a_killed_run_are_free_again(instance: dg.DagsterInstance) -> None:
    @dg.op
    def nothing() -> None: ...

    @dg.job
    def job() -> None:
        nothing()

    storage = instance.event_log_storage
    storage.set_concurrency_slots("gpu", 1)
    tags = {**process_tags(), PROCESS_TAG: "1-7-gone"}
    killed = instance.create_run_for_job(job, status=dg.DagsterRunStatus.STARTED, tags=tags)
    assert storage.claim_concurrency_slot("gpu", killed.run_id, "frames").is_claimed
    assert not storage.claim_concurrency_slot("gpu", "another run", "frames").is_claimed
    assert close_dead_runs(instance) == 1
    assert storage.claim_concurrency_slot("gpu", "another run", "frames").is_claimed


def test_a_failed_run_is_told_to_the_webhook(tmp_path: Path, instance: dg.DagsterInstance) -> None:
    told: list[dict[str, str]] = []

    class Hook(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            told.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()

    server = HTTPServer(("127.0.0.1", 0), Hook)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    operation = OperationSettings(webhook_url=f"http://127.0.0.1:{server.server_port}/hook")  # type: ignore[arg-type]
    (sensor,) = failure_sensor(Settings(operation=operation))
    failed = run(two_stages(tmp_path, [InputError("the key is refused")]), instance)
    stored = instance.get_run_by_id(failed.run_id)
    (event,) = [e for e in failed.all_events if e.event_type_value == "PIPELINE_FAILURE"]
    assert stored is not None
    context = dg.build_run_status_sensor_context("tell_failures", event, instance, stored)
    sensor(context.for_run_failure())
    server.shutdown()
    expected = {"event": "run_failed", "job": "grow_scene", "scene": SCENE, "run_id": failed.run_id}
    assert told == [{**expected, "error": "the key is refused"}]
