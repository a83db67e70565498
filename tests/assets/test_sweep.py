"""The morning's sweep: a page at a tick, every scene looked at once, and once more the next morning."""

from datetime import UTC, datetime
from pathlib import Path

import dagster as dg
import pytest

from flymirage_assets import sweep
from flymirage_assets.home import PROCESS_TAG, process_tags
from flymirage_core.settings import Settings
from resources.processes import this_process
from resources.records import SceneOrigin
from resources.store import open_store

NIGHT, MORNING, NEXT_MORNING = (datetime(2026, 11, *at, tzinfo=UTC) for at in ((21, 4), (21, 6), (22, 6)))
KEYS = [f"s{i:03d}" for i in range(7)]


class Sweeper:
    """The sensor over a store with scenes of which nothing is made yet, ticked by hand."""

    def __init__(self, folder: Path, instance: dg.DagsterInstance) -> None:
        settings = Settings(store=str(folder / "store"))
        for key in KEYS:
            open_store(settings.store).register(SceneOrigin(scene=key, kind="generated"))
        instance.add_dynamic_partitions("scene", KEYS)
        self.instance, self.sensor, self.cursor = instance, sweep.sweep_sensor(settings), None

    def tick(self, at: datetime) -> list[dg.RunRequest]:
        context = dg.build_sensor_context(self.instance, cursor=self.cursor)
        with dg.partition_loading_context(effective_dt=at):
            result = self.sensor(context)
        assert isinstance(result, dg.SensorResult)
        self.cursor = result.cursor
        return list(result.run_requests or [])


@pytest.fixture
def sweeper(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Sweeper:
    monkeypatch.setattr(sweep, "PAGE_SECONDS", 0.0)
    monkeypatch.setattr(sweep, "AT_ONCE", 3)
    return Sweeper(tmp_path, dg.DagsterInstance.ephemeral())


def test_a_sweep_that_was_just_switched_on_waits_for_its_hour(sweeper: Sweeper) -> None:
    assert sweeper.tick(NIGHT) == [] == sweeper.tick(NIGHT)
    assert sweeper.tick(MORNING) != []


def test_every_scene_is_looked_at_once_a_morning_a_page_at_a_tick(sweeper: Sweeper) -> None:
    sweeper.tick(NIGHT)
    pages = [[r.partition_key for r in sweeper.tick(MORNING)] for _ in range(5)]
    assert pages == [KEYS[:3], KEYS[3:6], KEYS[6:], [], []]
    again = [r.run_key for _ in range(4) for r in sweeper.tick(NEXT_MORNING)]
    assert len(again) == len(set(again)) == len(KEYS) and all("2026-11-22" in str(key) for key in again)


def test_a_tick_that_died_is_asked_for_again_with_the_same_run_keys(sweeper: Sweeper) -> None:
    sweeper.tick(NIGHT)
    cursor = sweeper.cursor
    first = [r.run_key for r in sweeper.tick(MORNING)]
    sweeper.cursor = cursor
    assert [r.run_key for r in sweeper.tick(MORNING)] == first


def test_a_clock_that_jumps_a_day_ahead_and_back_asks_for_no_run_twice(sweeper: Sweeper) -> None:
    def keys_at(morning: datetime) -> list[str | None]:
        return [request.run_key for _ in range(4) for request in sweeper.tick(morning)]

    sweeper.tick(NIGHT)
    first, ahead, back = keys_at(MORNING), keys_at(NEXT_MORNING), keys_at(MORNING)
    assert back == first and not set(first) & set(ahead)  # Dagster starts one run for each run key


@pytest.mark.parametrize(
    ("process", "asked"),
    [(this_process(), [KEYS[0], KEYS[2]]), ("1-7-gone", [KEYS[0], KEYS[1], KEYS[2]])],
    ids=["alive", "killed"],  # the same in each of the processes that share the tests
)
def test_a_scene_that_is_being_made_is_left_alone_unless_its_process_was_killed(
    sweeper: Sweeper, process: str, asked: list[str]
) -> None:
    @dg.op
    def nothing() -> None: ...

    @dg.job
    def job() -> None:
        nothing()

    tags = {**process_tags(), PROCESS_TAG: process, "dagster/partition": KEYS[1]}
    sweeper.instance.create_run_for_job(job, status=dg.DagsterRunStatus.STARTED, tags=tags)
    sweeper.tick(NIGHT)
    assert [r.partition_key for r in sweeper.tick(MORNING)] == asked
