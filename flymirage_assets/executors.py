"""Who runs the stages of a run. The engines are Dagster's own; the extras bring them."""

import os

import dagster as dg

from flymirage_core.errors import InputError
from flymirage_core.settings import Settings


def executor_of(settings: Settings) -> dg.ExecutorDefinition:
    """The executor that ``settings.executor`` names; raises `InputError` if its extra is not installed."""
    if settings.executor == "multiprocess":
        return dg.multiprocess_executor.configured({"max_concurrent": os.cpu_count() or 1})
    try:
        if settings.executor == "celery":
            from dagster_celery import celery_executor

            return celery_executor.configured(_celery_config())
        if settings.executor == "ray":
            from dagster_ray import ray_executor

            return ray_executor.configured({"ray": {"address": os.environ.get("RAY_ADDRESS", "auto"), "num_cpus": 1}})
    except ImportError as error:
        raise InputError(
            f"executor {settings.executor!r} needs the package {error.name!r}: pip install "
            f"'flymirage[{settings.executor}]', or set FLYMIRAGE_EXECUTOR=in_process"
        ) from error
    return dg.in_process_executor


def _celery_config() -> dict[str, object]:
    """Broker and results where ``CELERY_BROKER_URL`` says; a task whose worker is lost goes to another one."""
    broker = os.environ.get("CELERY_BROKER_URL", "redis://localhost:6379/0")
    return {
        "broker": broker,
        "backend": os.environ.get("CELERY_RESULT_BACKEND", broker),
        "config_source": {"task_acks_late": True, "task_reject_on_worker_lost": True, "worker_prefetch_multiplier": 1},
    }
