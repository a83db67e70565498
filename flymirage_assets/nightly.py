"""Schedules: new scenes every night, and in the morning a report of what came of it."""

from collections.abc import Iterator, Sequence
from datetime import UTC, date, datetime
from typing import Any

import dagster as dg

from flymirage_assets.growing import night_scenes, why_stop
from flymirage_assets.runs import scene_tags
from flymirage_assets.stage import scenes
from flymirage_core.scene.taxonomy import taxonomy_named
from flymirage_core.settings import Settings
from resources.store import open_store


def nightly_schedules(settings: Settings) -> list[dg.ScheduleDefinition]:
    """``nightly_growth`` and ``nightly_report``; off unless ``growth.nightly`` is set or the UI switches them on."""
    growth = settings.growth
    common: dict[str, Any] = {
        "execution_timezone": growth.timezone,
        "default_status": dg.DefaultScheduleStatus.RUNNING if growth.nightly else dg.DefaultScheduleStatus.STOPPED,
    }

    @dg.schedule(job_name="grow_scene", cron_schedule=growth.cron, **common)
    def nightly_growth(context: dg.ScheduleEvaluationContext) -> Iterator[dg.RunRequest | dg.SkipReason]:
        """The night's new scenes, one run each. A second tick of the same night asks for the same scenes."""
        store = open_store(settings.store)
        if reason := why_stop(store, settings):
            yield dg.SkipReason(reason)
            return
        night = _night(context)
        keys = night_scenes(store, night, growth.scenes_per_night, taxonomy_named(settings.taxonomy))
        context.instance.add_dynamic_partitions(str(scenes.name), keys)
        asked = {run.tags.get("dagster/partition") for run in _runs_of(context, night)}
        for key in keys:
            origin = store.origin(key)
            if key not in asked and origin is not None:
                tags = {**scene_tags(origin), NIGHT_TAG: night.isoformat()}
                yield dg.RunRequest(run_key=f"grow:{key}", partition_key=key, tags=tags)

    @dg.schedule(job_name="report_night", cron_schedule=growth.sweep_cron, **common)
    def nightly_report(context: dg.ScheduleEvaluationContext) -> dg.RunRequest:
        """What came of the night: grown, failed, dropped, spent."""
        night = _night(context).isoformat()
        return dg.RunRequest(
            run_key=f"report:{night}", run_config={"ops": {"growth_report": {"config": {"night": night}}}}
        )

    return [nightly_growth, nightly_report]


NIGHT_TAG = "flymirage/night"


def _night(context: dg.ScheduleEvaluationContext) -> date:
    return (context.scheduled_execution_time or datetime.now(UTC)).date()


def _runs_of(context: dg.ScheduleEvaluationContext, night: date) -> Sequence[dg.DagsterRun]:
    return context.instance.get_runs(dg.RunsFilter(tags={NIGHT_TAG: night.isoformat()}))
