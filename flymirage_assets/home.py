"""Dagster's home folder: made on first use, and tidied of runs whose process was killed."""

import os
import shutil
import socket
from collections.abc import Mapping
from pathlib import Path

import dagster as dg
from filelock import FileLock

from flymirage_assets.pools import POOL_LIMITS
from resources.processes import is_alive, this_process

PROCESS_TAG = ".dagster/flymirage_process"  # the prefix keeps them out of the UI
HOST_TAG = ".dagster/flymirage_host"


def prepare_home() -> Path:
    """The DAGSTER_HOME of this project (the environment's, else ``.flymirage/dagster`` here), with its dagster.yaml."""
    home = Path(os.environ.get("DAGSTER_HOME", ".flymirage/dagster")).resolve()
    home.mkdir(parents=True, exist_ok=True)
    with opening(home):
        if not (home / "dagster.yaml").exists():
            shutil.copyfile(Path(__file__).with_name("dagster.yaml"), home / "dagster.yaml")
    os.environ["DAGSTER_HOME"] = str(home)
    return home


def opening(home: Path) -> FileLock:
    """One process at a time: two cannot create Dagster's databases at once."""
    return FileLock(home / "opening.lock")


def process_tags() -> dict[str, str]:
    """Tags that tell later which process ran a run, so that a killed one is recognised."""
    return {PROCESS_TAG: this_process(), HOST_TAG: socket.gethostname()}


def tag_with_process(instance: dg.DagsterInstance, run: dg.DagsterRun) -> None:
    """Let a run that the daemon launched be recognised too when its process is gone."""
    if run.tags.get(PROCESS_TAG) != this_process() and not run.is_finished:
        instance.add_run_tags(run.run_id, process_tags())


def limit_pools(instance: dg.DagsterInstance) -> None:
    """Give each pool its limit, unless somebody set another one."""
    storage = instance.event_log_storage
    known = {limit.name for limit in storage.get_pool_limits() if not limit.from_default}
    for pool, limit in POOL_LIMITS.items():
        if pool not in known:
            storage.set_concurrency_slots(pool, limit)


def close_dead_runs(instance: dg.DagsterInstance) -> int:
    """Report runs of this machine as failed whose process is gone (kill -9, power cut), and free their pool slots.

    The daemon then runs them again once, from the stage that failed; so does the same command.
    """
    begun = [dg.DagsterRunStatus.NOT_STARTED, dg.DagsterRunStatus.STARTING, dg.DagsterRunStatus.STARTED]
    running = instance.get_runs(dg.RunsFilter(statuses=begun))
    dead = [run for run in running if _is_dead(run.tags) and not _inherited(instance, run)]
    for run in dead:
        instance.report_run_failed(run, "the process of this run is gone; run the command again to carry on")
    for run in dead:
        instance.event_log_storage.free_concurrency_slots_for_run(run.run_id)
    return len(dead)


def _is_dead(tags: Mapping[str, str]) -> bool:
    if PROCESS_TAG not in tags or tags.get(HOST_TAG) != socket.gethostname():
        return False  # nothing is known of it from here
    return not is_alive(tags[PROCESS_TAG])


def _inherited(instance: dg.DagsterInstance, run: dg.DagsterRun) -> bool:
    """True if the process it names is that of the run it retries: Dagster copies the tags, and it has none yet."""
    parent = instance.get_run_by_id(run.parent_run_id) if run.parent_run_id else None
    return parent is not None and parent.tags.get(PROCESS_TAG) == run.tags[PROCESS_TAG]
