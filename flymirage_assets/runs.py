"""Running the Dagster assets from a command line: the same assets, the same instance, in this process."""

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import dagster as dg

from flymirage_assets.home import close_dead_runs, prepare_home, process_tags
from flymirage_assets.stage import scenes
from flymirage_core.errors import FlyMirageError

QUIET = {"loggers": {"console": {"config": {"log_level": "CRITICAL"}}}}


@dataclass(frozen=True)
class RunOutcome:
    """How a run ended; ``error`` is one sentence, "" if it succeeded."""

    run_id: str
    error: str


@contextmanager
def dagster_instance() -> Iterator[dg.DagsterInstance]:
    """The instance that the UI shows, freed of runs whose process was killed."""
    prepare_home()
    warnings.filterwarnings("ignore", module="dagster")
    logging.getLogger("alembic").setLevel(logging.WARNING)
    with dg.DagsterInstance.get() as instance:
        close_dead_runs(instance)
        yield instance


def run_scene(instance: dg.DagsterInstance, scene: str) -> RunOutcome:
    """Materialise every product of one scene; what is up to date costs nothing."""
    instance.add_dynamic_partitions(str(scenes.name), [scene])
    return _run(instance, "grow_scene", partition_key=scene)


def run_export(instance: dg.DagsterInstance, folder: str, depth: str) -> RunOutcome:
    """Materialise the data set and write the LeRobot folder."""
    return _run(instance, "dataset_and_exports", ops={"lerobot": {"config": {"folder": folder, "depth": depth}}})


def _run(
    instance: dg.DagsterInstance, job: str, partition_key: str | None = None, ops: dict[str, Any] | None = None
) -> RunOutcome:
    from flymirage_assets.definitions import defs  # late: it reads the settings

    result = defs.resolve_job_def(job).execute_in_process(
        instance=instance,
        partition_key=partition_key,
        run_config={**QUIET, **({"ops": ops} if ops else {})},
        tags=process_tags(),
        raise_on_error=False,
    )
    if result.success:
        return RunOutcome(result.run_id, "")
    failures = [event for event in result.all_events if event.is_step_failure]
    return RunOutcome(result.run_id, "; ".join(_sentence(event) for event in failures[:1]) or "the run failed")


def _sentence(event: dg.DagsterEvent) -> str:
    data = event.step_failure_data
    description = data.user_failure_data.description if data.user_failure_data else None
    if description:
        return f"{event.step_key}: {description}"
    cause = data.error.cause if data.error is not None and data.error.cause is not None else data.error
    message = cause.message.strip() if cause is not None else "failed"
    return f"{event.step_key}: {message} (a bug of FlyMirage: `make dev` shows the whole trace in the run's log)"


class RunError(FlyMirageError):
    """A run of the pipeline did not succeed."""
