"""The morning's look at every scene: what is stale or unfinished is requested again, page after page.

At every tick, all day, runs whose process was killed are closed: a scene of theirs is then free to be made again.
"""

import time
from bisect import bisect_right
from collections.abc import Sequence

import dagster as dg
from pydantic import BaseModel

from flymirage_assets.home import close_dead_runs
from flymirage_assets.runs import UNFINISHED, scene_tags
from flymirage_assets.stage import scenes
from flymirage_assets.staleness import StageSpec, stage_specs, stale_products
from flymirage_core.settings import Settings
from resources.store import Store, open_store

PAGE_SECONDS = 4.0
"""A tick looks at scenes for so long and leaves the others to the next one; Dagster stops a tick after 60 s."""
AT_ONCE = 20
"""Scenes between two looks at the clock."""


class SweepCursor(BaseModel):
    """How far the sweep is: of which morning (ISO 8601), after which scene, and whether it has seen all."""

    morning: str
    after: str = ""
    done: bool = False


def sweep_sensor(settings: Settings) -> dg.SensorDefinition:
    """``stale_sweep``: begins at ``growth.sweep_cron``; off unless ``growth.nightly`` or the UI switches it on."""
    growth = settings.growth
    on = dg.DefaultSensorStatus.RUNNING if growth.nightly else dg.DefaultSensorStatus.STOPPED
    mornings = dg.TimeWindowPartitionsDefinition(
        start="2020-01-01", cron_schedule=growth.sweep_cron, timezone=growth.timezone, fmt="%Y-%m-%d"
    )

    @dg.sensor(name="stale_sweep", job_name="grow_scene", minimum_interval_seconds=30, default_status=on)
    def stale_sweep(context: dg.SensorEvaluationContext) -> dg.SensorResult:
        """Scenes with stale or missing products, one run each, of these products alone; paid stages only if missing."""
        close_dead_runs(context.instance)
        last = mornings.get_last_partition_window()
        morning = last.end.isoformat() if last is not None else ""
        if context.cursor is None:  # just switched on
            return _looked(SweepCursor(morning=morning, done=True), [], f"begins at {growth.sweep_cron}")
        cursor = SweepCursor.model_validate_json(context.cursor)
        if cursor.morning != morning:
            cursor = SweepCursor(morning=morning)
        if cursor.done:
            return _looked(cursor, [], "all scenes were looked at this morning")
        keys = sorted(context.instance.get_dynamic_partitions(str(scenes.name)))
        ahead = keys[bisect_right(keys, cursor.after) :]
        requests, seen = _page(open_store(settings.store), settings, context.instance, ahead, morning)
        after = ahead[seen - 1] if seen else cursor.after
        cursor = SweepCursor(morning=morning, after=after, done=seen == len(ahead))
        return _looked(cursor, requests, f"{len(ahead) - seen} of {len(keys)} scenes are left to look at")

    return stale_sweep


def _page(
    store: Store, settings: Settings, instance: dg.DagsterInstance, keys: Sequence[str], morning: str
) -> tuple[list[dg.RunRequest], int]:
    """Requests for the first of ``keys``, as many as `PAGE_SECONDS` allow, and how many these were."""
    from flymirage_assets.definitions import defs  # late: it is being built

    specs, started, seen = stage_specs(defs), time.monotonic(), 0
    running = instance.get_run_records(dg.RunsFilter(statuses=UNFINISHED))
    busy = {record.dagster_run.tags.get("dagster/partition") for record in running}
    requests: list[dg.RunRequest] = []
    while seen < len(keys) and (not seen or time.monotonic() - started < PAGE_SECONDS):
        batch = keys[seen : seen + AT_ONCE]
        wanted = _wanted(store, specs, settings, [key for key in batch if key not in busy])
        requests += [_request(store, scene, assets, morning) for scene, assets in wanted.items()]
        seen += len(batch)
    return requests, seen


def _wanted(store: Store, specs: Sequence[StageSpec], settings: Settings, keys: Sequence[str]) -> dict[str, list[str]]:
    """Scene -> its stale products; a paid one that is there is left to `flymirage rebuild`."""
    paid = {spec.name for spec in specs if spec.paid}
    wanted: dict[str, list[str]] = {}
    for stale in stale_products(store, specs, settings, keys):
        if stale.asset not in paid or stale.reasons == ("not made yet",):
            wanted.setdefault(stale.scene, []).append(stale.asset)
    return wanted


def _request(store: Store, scene: str, assets: Sequence[str], morning: str) -> dg.RunRequest:
    origin = store.origin(scene)
    return dg.RunRequest(
        run_key=f"sweep:{morning}:{scene}",
        partition_key=scene,
        asset_selection=[dg.AssetKey(name) for name in assets],
        tags={} if origin is None else scene_tags(origin),
    )


def _looked(cursor: SweepCursor, requests: list[dg.RunRequest], said: str) -> dg.SensorResult:
    reason = None if requests else dg.SkipReason(said)
    return dg.SensorResult(run_requests=requests, skip_reason=reason, cursor=cursor.model_dump_json())
