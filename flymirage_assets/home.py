"""Dagster's home folder: made on first use, and tidied of runs whose process was killed."""

import os
import shutil
from pathlib import Path

import dagster as dg

PID_TAG = ".dagster/flymirage_pid"  # the prefix keeps them out of the UI
BOOT_TAG = ".dagster/flymirage_boot"


def prepare_home() -> Path:
    """The DAGSTER_HOME of this project (the environment's, else ``.flymirage/dagster`` here), with its dagster.yaml."""
    home = Path(os.environ.get("DAGSTER_HOME", ".flymirage/dagster")).resolve()
    home.mkdir(parents=True, exist_ok=True)
    if not (home / "dagster.yaml").exists():
        shutil.copyfile(Path(__file__).with_name("dagster.yaml"), home / "dagster.yaml")
    os.environ["DAGSTER_HOME"] = str(home)
    return home


def process_tags() -> dict[str, str]:
    """Tags that tell later which process ran a run, so that a killed one is recognised."""
    return {PID_TAG: str(os.getpid()), BOOT_TAG: _boot_id()}


def close_dead_runs(instance: dg.DagsterInstance) -> int:
    """Report runs as failed whose command-line process is gone (kill -9, power cut), and free their slots."""
    running = instance.get_runs(dg.RunsFilter(statuses=[dg.DagsterRunStatus.STARTED, dg.DagsterRunStatus.STARTING]))
    dead = [run for run in running if PID_TAG in run.tags and not _is_alive(run.tags[PID_TAG], run.tags[BOOT_TAG])]
    for run in dead:
        instance.report_run_failed(run, "the process of this run is gone; run the command again to carry on")
        instance.event_log_storage.free_concurrency_slots_for_run(run.run_id)
    return len(dead)


def _is_alive(pid: str, boot: str) -> bool:
    return boot == _boot_id() and Path(f"/proc/{pid}").exists() if Path("/proc").exists() else _answers(int(pid))


def _answers(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _boot_id() -> str:
    path = Path("/proc/sys/kernel/random/boot_id")
    return path.read_text().strip() if path.exists() else ""
