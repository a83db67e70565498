"""Who runs the stages of a run. The engines are Dagster's own; the extras bring them."""

import os

import dagster as dg

from flymirage_core.errors import InputError
from flymirage_core.settings import Settings

SECRETS = ("PASSWORD", "WEBHOOK")
"""In names of variables: Ray shows its jobs' environment on its dashboard."""


def executor_of(settings: Settings) -> dg.ExecutorDefinition:
    """The executor that ``settings.executor`` names; raises `InputError` if its extra is not installed."""
    if settings.executor == "multiprocess":
        return dg.multiprocess_executor.configured({"max_concurrent": os.cpu_count() or 1})
    try:
        if settings.executor == "celery":
            from dagster_celery import celery_executor

            celery: dg.ExecutorDefinition = celery_executor.configured(_celery_config())
            return celery
        if settings.executor == "ray":
            from dagster_ray import ray_executor

            config = {"address": os.environ.get("RAY_ADDRESS", "auto"), "num_cpus": 1, "env_vars": ray_environment()}
            ray: dg.ExecutorDefinition = ray_executor.configured({"ray": config})
            return ray
    except ImportError as error:
        raise InputError(
            f"executor {settings.executor!r} needs the package {error.name!r}: pip install "
            f"'flymirage[{settings.executor}]', or set FLYMIRAGE_EXECUTOR=in_process"
        ) from error
    return dg.in_process_executor


def ray_environment() -> list[str]:
    """Variables of this process that Ray's jobs get, or their stages had other settings; secrets are the cluster's."""
    ours = (name for name in os.environ if name.startswith("FLYMIRAGE_"))
    return ["DAGSTER_HOME", *sorted(name for name in ours if not any(secret in name for secret in SECRETS))]


def _celery_config() -> dict[str, object]:
    """Broker and results where ``CELERY_BROKER_URL`` says; workers read deploy/dagster_celery_config.py."""
    broker = os.environ.get("CELERY_BROKER_URL", "redis://localhost:6379/0")
    return {"broker": broker, "backend": os.environ.get("CELERY_RESULT_BACKEND", broker)}
