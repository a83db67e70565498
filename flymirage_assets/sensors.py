"""Sensors: automation that follows changed code and new scenes, and a word to somebody when a run fails."""

import dagster as dg
import httpx

from flymirage_core.settings import Settings


def automation_sensor(settings: Settings, scenes: dg.AssetSelection) -> dg.AutomationConditionSensorDefinition:
    """Requests what the assets' automation conditions ask for. It can start paid stages, so it is off by default."""
    on = settings.operation.automation
    return dg.AutomationConditionSensorDefinition(
        "automation",
        target=scenes,
        minimum_interval_seconds=30,
        default_status=dg.DefaultSensorStatus.RUNNING if on else dg.DefaultSensorStatus.STOPPED,
        description="Rebuilds what a changed planner (or any stage's code or settings) makes stale, for every scene.",
    )


def failure_sensor(settings: Settings) -> list[dg.SensorDefinition]:
    """Posts each failed run to ``operation.webhook_url``; none without one."""
    url = settings.operation.webhook_url.get_secret_value()
    if not url:
        return []

    @dg.run_failure_sensor(name="tell_failures", default_status=dg.DefaultSensorStatus.RUNNING)
    def tell_failures(context: dg.RunFailureSensorContext) -> None:
        """One POST for each failed run: event, job, scene, run_id, error."""
        run = context.dagster_run
        steps = [e.step_failure_data for e in context.get_step_failure_events()]
        told = [d.user_failure_data.description for d in steps if d.user_failure_data is not None]
        message = {
            "event": "run_failed",
            "job": run.job_name,
            "scene": run.tags.get("dagster/partition", ""),
            "run_id": run.run_id,
            "error": next((t for t in told if t), context.failure_event.message or ""),
        }
        httpx.post(url, json=message, timeout=10.0).raise_for_status()

    return [tell_failures]
