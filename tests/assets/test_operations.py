"""The machine room: growth that is the same however often it is asked for, failures, automation, housekeeping."""

import errno
import signal
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, date, datetime
from pathlib import Path

import dagster as dg
import pytest
from projects import Project

from flymirage_assets import cli
from flymirage_assets.conditions import CASCADE
from flymirage_assets.failures import one_clear_sentence
from flymirage_assets.growing import next_scenes, night_scenes, why_stop
from flymirage_core.errors import BudgetError, InputError, TransientServiceError
from flymirage_core.operation_settings import GrowthSettings
from flymirage_core.settings import Settings
from resources.services.account import Account
from resources.services.ledger import Call, Ledger
from resources.store import Store, open_store

NIGHT = date(2026, 11, 21)


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return open_store(str(tmp_path / "store"))


def flymirage(folder: Path, *arguments: str, **environment: str) -> str:
    """A command over stand-in stages; what it printed."""
    outcome = Project(folder, {}, "stand_in").flymirage(*arguments, **environment)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    return outcome.stdout


def test_a_night_has_the_same_scenes_however_often_it_is_asked_for(store: Store) -> None:
    first = night_scenes(store, NIGHT, 5)
    origins = [store.origin(key) for key in first]
    assert night_scenes(store, NIGHT, 5) == first == night_scenes(Store(str(store.base)), NIGHT, 5)
    assert [store.origin(key) for key in first] == origins
    assert len(store.scenes()) == 5


def test_new_scenes_are_spread_evenly_over_the_categories(store: Store) -> None:
    night_scenes(store, NIGHT, 12)
    store.remove_note("growth/tally.json")  # it is only a cache
    night_scenes(store, date(2026, 11, 22), 12)
    places = [origin.place for key in store.scenes() if (origin := store.origin(key)) is not None]
    counts = Counter(place[0] for place in places if place is not None)
    assert sum(counts.values()) == 24 and max(counts.values()) - min(counts.values()) <= 1


def test_two_commands_at_once_never_take_the_same_new_scene(store: Store) -> None:
    with dg.DagsterInstance.ephemeral() as one:
        first = next_scenes(store, one, 1)
        with dg.DagsterInstance.ephemeral() as two:
            assert next_scenes(store, two, 1) == first  # unfinished: the same one first
            assert next_scenes(store, two, 2) == [*first, "scene-0002"]


def test_growth_stops_before_the_disk_is_full(store: Store) -> None:
    def needing(free_gb: float) -> Settings:
        return Settings(store=str(store.base), growth=GrowthSettings(min_free_gb=free_gb))

    assert why_stop(store, needing(0.0)) == ""
    assert "min_free_gb" in why_stop(store, needing(1e9))


def test_growth_stops_when_the_night_has_no_money_left(store: Store) -> None:
    settings = Settings(store=str(store.base), profile="paper", growth=GrowthSettings(min_free_gb=0.0))
    assert why_stop(store, settings) == ""
    ledger = Account(store, "flat", "world", settings.services).ledger
    no_caps = dict.fromkeys(("scene_usd", "night_usd", "month_usd"), 1e9)
    unlimited = Ledger(ledger.database, settings.services.budget.model_copy(update=no_caps))
    spent = settings.services.budget.night_usd
    unlimited.book(Call("1", "flat", "world", "marble", "model", spent, "2026-01"))
    assert "night_usd" in why_stop(store, settings)


def test_the_nightly_schedule_asks_for_each_scene_of_the_night_once(tmp_path: Path) -> None:
    from flymirage_assets.definitions import build_definitions

    settings = Settings(store=str(tmp_path / "store"))
    defs = build_definitions(settings)
    schedule = defs.resolve_schedule_def("nightly_growth")
    tick = datetime(2026, 11, 21, 2, 0, tzinfo=UTC)

    def requested(instance: dg.DagsterInstance) -> list[dg.RunRequest]:
        context = dg.build_schedule_context(
            instance=instance, scheduled_execution_time=tick, repository_def=defs.get_repository_def()
        )
        return list(schedule.evaluate_tick(context).run_requests or [])

    with dg.instance_for_test() as instance:
        first, second = requested(instance), requested(instance)
        expected = [f"grow:n20261121-00{i}" for i in range(1, 6)]
        assert [r.run_key for r in first] == [r.run_key for r in second] == expected
        assert len(instance.get_dynamic_partitions("scene")) == 5
        assert {"flymirage/scene", "flymirage/category", "flymirage/night"} <= set(first[0].tags)


@pytest.mark.parametrize(
    ("error", "retried"),
    [
        (TransientServiceError("busy"), True),
        (TimeoutError("slow"), True),
        (InputError("bad"), False),
        (BudgetError("spent"), False),
        (OSError(errno.ENOSPC, "No space", "/x"), False),
        (ZeroDivisionError("bug"), False),
    ],
)
def test_only_what_may_pass_by_itself_is_tried_again(error: Exception, retried: bool) -> None:
    with pytest.raises(dg.Failure) as failure, one_clear_sentence():
        raise error
    assert failure.value.allow_retries == retried
    assert failure.value.description


def test_automation_follows_a_new_key_and_a_changed_planner_and_nothing_else() -> None:
    scenes = dg.DynamicPartitionsDefinition(name="toy")

    def chain(planner: str) -> dg.Definitions:
        @dg.asset(partitions_def=scenes, code_version="1", automation_condition=CASCADE)
        def world() -> None: ...

        @dg.asset(partitions_def=scenes, code_version=planner, automation_condition=CASCADE, deps=[world])
        def trajectories() -> None: ...

        @dg.asset(partitions_def=scenes, code_version="1", automation_condition=CASCADE, deps=[trajectories])
        def frames() -> None: ...

        return dg.Definitions(assets=[world, trajectories, frames])

    def asked(result: dg.EvaluateAutomationConditionsResult) -> dict[str, int]:
        names = ("world", "trajectories", "frames")
        return {n: count for n in names if (count := result.get_num_requested(dg.AssetKey(n)))}

    with dg.DagsterInstance.ephemeral() as instance:
        instance.add_dynamic_partitions("toy", ["a", "b"])
        before = chain("1")
        first = dg.evaluate_automation_conditions(before, instance)
        assert asked(first) == {"world": 2, "trajectories": 2, "frames": 2}
        for key in ("a", "b"):
            dg.materialize(list(before.assets or []), instance=instance, partition_key=key)  # type: ignore[arg-type]
        calm = dg.evaluate_automation_conditions(before, instance, cursor=first.cursor)
        assert asked(calm) == {}
        changed = dg.evaluate_automation_conditions(chain("2"), instance, cursor=calm.cursor)
        assert asked(changed) == {"trajectories": 2, "frames": 2}


def test_rebuild_says_why_and_touches_what_the_change_touches_and_the_way_back_is_free(tmp_path: Path) -> None:
    flymirage(tmp_path, "grow", "--scenes", "1")
    assert "nothing is stale" in flymirage(tmp_path, "rebuild", "--dry-run")
    changed = {"FLYMIRAGE_PLANNER__MAX_SPEED": "1.0"}
    shown = flymirage(tmp_path, "rebuild", "--dry-run", **changed)
    assert "setting planner.max_speed: 1.5 -> 1.0" in shown and "follows from trajectories" in shown
    ran = flymirage(tmp_path, "rebuild", "--stage", "trajectories", **changed)
    assert "✓ trajectories" in ran and "✓ frames" in ran and "✓ world" not in ran and "✓ boxes" not in ran
    back = flymirage(tmp_path, "rebuild")
    assert "made so before" in back and "✓" not in back


def test_two_first_commands_at_once_make_one_home(tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as both:
        homes = set(both.map(lambda _: flymirage(tmp_path, "home"), range(2)))
    assert homes == {f"{tmp_path}/.flymirage/dagster\n"}


def test_removing_a_scene_leaves_nothing_of_it(tmp_path: Path) -> None:
    flymirage(tmp_path, "grow", "--scenes", "1")
    flymirage(tmp_path, "remove", "scene-0001", "--yes")
    left = [p for p in (tmp_path / ".flymirage" / "store").rglob("*") if "scene-0001" in str(p)]
    assert left == []
    with dg.DagsterInstance.from_config(str(tmp_path / ".flymirage" / "dagster")) as instance:
        assert instance.get_dynamic_partitions("scene") == [] and not instance.get_runs()
        assert not instance.get_materialized_partitions(dg.AssetKey("prompts"))


def test_a_scripts_background_job_can_be_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    """The shell ignores SIGINT for it, and Dagster has SIGTERM do as SIGINT does."""
    heard: list[object] = []
    monkeypatch.setattr(cli, "app", lambda: heard.append(signal.getsignal(signal.SIGINT)))
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        cli.main()
    finally:
        signal.signal(signal.SIGINT, before)
    assert heard == [signal.default_int_handler]
