"""Running the Dagster assets from a command line: the same assets, the same instance, in this process."""

import logging
import time
import uuid
import warnings
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

import dagster as dg

from flymirage_assets.failures import STOPS_GROWTH
from flymirage_assets.home import close_dead_runs, limit_pools, opening, prepare_home, process_tags
from flymirage_assets.stage import scenes
from flymirage_core.errors import FlyMirageError
from flymirage_core.settings import Settings
from resources.records import SceneOrigin

UNFINISHED = [
    dg.DagsterRunStatus.QUEUED,
    dg.DagsterRunStatus.NOT_STARTED,
    dg.DagsterRunStatus.STARTING,
    dg.DagsterRunStatus.STARTED,
    dg.DagsterRunStatus.CANCELING,
]
QUIET = {"loggers": {"console": {"config": {"log_level": "CRITICAL"}}}}


@dataclass(frozen=True)
class RunOutcome:
    """How a run ended; ``error`` is one sentence, "" if it succeeded."""

    run_id: str
    error: str
    interrupted: bool = False  # Ctrl-C
    stops_growth: bool = False  # every other scene would meet the same: a spent budget, a refused key


@contextmanager
def dagster_instance() -> Iterator[dg.DagsterInstance]:
    """The instance that the UI shows, freed of runs whose process was killed, with its pools' limits set."""
    warnings.filterwarnings("ignore", module="dagster")
    logging.getLogger("alembic").setLevel(logging.WARNING)
    with ExitStack() as stack:
        with opening(prepare_home()):
            instance = stack.enter_context(dg.DagsterInstance.get())
            close_dead_runs(instance)
            limit_pools(instance)
        yield instance


def run_scene(instance: dg.DagsterInstance, scene: str, assets: Sequence[str] = ()) -> RunOutcome:
    """Materialise the products of one scene, all or ``assets``; what is up to date costs nothing.

    If a service refused the scene's content and it got another description, once more from there.
    """
    from flymirage_assets.definitions import defs, store_of  # late: it reads the settings

    instance.add_dynamic_partitions(str(scenes.name), [scene])
    while True:
        before = store_of(defs).origin(scene)
        outcome = _run(instance, "grow_scene", partition_key=scene, assets=assets)
        after = store_of(defs).origin(scene)
        if not outcome.error or after is None or after.reroll == (0 if before is None else before.reroll):
            return outcome
        logging.getLogger("flymirage").warning(outcome.error)


def run_export(instance: dg.DagsterInstance, form: str, config: dict[str, Any]) -> RunOutcome:
    """Materialise the data set and write one format's folder; ``config`` as `ExportConfig`."""
    return _run(instance, "dataset_and_exports", ops={form: {"config": config}}, assets=["dataset", form])


def _run(
    instance: dg.DagsterInstance,
    job: str,
    partition_key: str | None = None,
    ops: dict[str, Any] | None = None,
    assets: Sequence[str] = (),
) -> RunOutcome:
    from flymirage_assets.definitions import defs, store_of  # late: it reads the settings

    origin = store_of(defs).origin(partition_key) if partition_key else None
    result = defs.resolve_job_def(job).execute_in_process(
        instance=instance,
        partition_key=partition_key,
        run_config={**QUIET, **({"ops": ops} if ops else {})},
        tags={**process_tags(), **(scene_tags(origin) if origin else {})},
        asset_selection=[dg.AssetKey(name) for name in assets] or None,
        raise_on_error=False,
    )
    if result.success:
        return RunOutcome(result.run_id, "")
    failures = [event for event in result.all_events if event.is_step_failure]
    if not failures:
        return RunOutcome(result.run_id, "the run failed before its first stage: `make dev` shows its log")
    return RunOutcome(
        result.run_id,
        _sentence(failures[0]),
        interrupted=any(_is_interrupt(failure) for failure in failures),
        stops_growth=_stops_growth(failures[0]),
    )


def forget_scene(instance: dg.DagsterInstance, scene: str) -> int:
    """Take a scene's key and its runs, with all their events, out of Dagster; return how many runs."""
    runs = instance.get_runs(dg.RunsFilter(tags={"dagster/partition": scene}))
    for run in runs:
        instance.delete_run(run.run_id)
    if instance.has_dynamic_partition(str(scenes.name), scene):
        instance.delete_dynamic_partition(str(scenes.name), scene)
    return len(runs)


def launch_backfill(assets: Sequence[str], keys: Sequence[str]) -> str:
    """Hand a backfill of ``assets`` for scenes ``keys`` to the daemon, as a click in the UI does; return its id."""
    from dagster._core.execution.backfill import PartitionBackfill  # there is no public way besides the UI's

    from flymirage_assets.definitions import defs

    with dagster_instance() as instance:
        instance.add_dynamic_partitions(str(scenes.name), list(keys))
        backfill = PartitionBackfill.from_asset_partitions(
            backfill_id=uuid.uuid4().hex[:8],
            asset_graph=defs.resolve_asset_graph(),
            partition_names=list(keys),
            asset_selection=[dg.AssetKey(name) for name in assets],
            backfill_timestamp=time.time(),
            tags={},
            dynamic_partitions_store=instance,
            all_partitions=False,
            title="flymirage rebuild",
            description=None,
            run_config=None,
        )
        instance.add_backfill(backfill)
    return backfill.backfill_id


def scene_tags(origin: SceneOrigin) -> dict[str, str]:
    """By which runs are found in the UI: the scene, its kind, its category, the profile that made it."""
    tags = {"flymirage/scene": origin.scene, "flymirage/kind": origin.kind, "flymirage/profile": Settings().profile}
    return tags | ({"flymirage/category": origin.category.replace(" ", "_")} if origin.category else {})


def _is_interrupt(event: dg.DagsterEvent) -> bool:
    error = event.step_failure_data.error
    return error is not None and error.cls_name in ("DagsterExecutionInterruptedError", "KeyboardInterrupt")


def _stops_growth(event: dg.DagsterEvent) -> bool:
    data = event.step_failure_data.user_failure_data
    return data is not None and STOPS_GROWTH in data.metadata


def _sentence(event: dg.DagsterEvent) -> str:
    data = event.step_failure_data
    description = data.user_failure_data.description if data.user_failure_data else None
    if description:
        return f"{event.step_key}: {description}"
    message = data.error.message.strip() if data.error is not None else "failed"
    return f"{event.step_key}: {message} (a bug of FlyMirage: `make dev` shows the whole trace in the run's log)"


class RunError(FlyMirageError):
    """A run of the pipeline did not succeed."""
