"""The one Definitions object: what the UI, the daemon and the command line all load."""

from typing import cast

import dagster as dg

from flymirage_assets import sqlite
from flymirage_assets.assets.dataset import dataset_assets
from flymirage_assets.assets.growth import growth_assets
from flymirage_assets.assets.navigation import navigation_assets
from flymirage_assets.assets.scene_annotation import scene_annotation_assets
from flymirage_assets.assets.world_generation import world_generation_assets
from flymirage_assets.executors import executor_of
from flymirage_assets.nightly import nightly_schedules
from flymirage_assets.sensors import automation_sensor, failure_sensor
from flymirage_assets.sweep import sweep_sensor
from flymirage_core.settings import Settings
from resources.io_manager import ProductIOManager
from resources.store import Store

sqlite.fewer_syncs()


def build_definitions(settings: Settings) -> dg.Definitions:
    """All assets, jobs, schedules and sensors under ``settings``; one run is one scene."""
    scene_assets = [
        *world_generation_assets(settings),
        *scene_annotation_assets(settings),
        *navigation_assets(settings),
    ]
    over_all = dataset_assets(settings)
    report = growth_assets()
    scene_selection = dg.AssetSelection.assets(*scene_assets)
    limit = {"dagster/max_runtime": str(settings.operation.max_run_seconds)}
    grow_scene = dg.define_asset_job("grow_scene", scene_selection, description="One scene, whole.", tags=limit)
    replan = dg.define_asset_job(
        "replan",
        dg.AssetSelection.assets("trajectories").downstream() & scene_selection,
        description="Trajectories and what follows from them; what is up to date costs nothing.",
        tags=limit,
    )
    report_job = dg.define_asset_job("report_night", dg.AssetSelection.assets(*report))
    return dg.Definitions(
        assets=[*scene_assets, *over_all, *report],
        jobs=[
            grow_scene,
            replan,
            report_job,
            dg.define_asset_job("dataset_and_exports", dg.AssetSelection.assets(*over_all)),
        ],
        schedules=nightly_schedules(settings),
        sensors=[automation_sensor(settings, scene_selection), sweep_sensor(settings), *failure_sensor(settings)],
        resources={"io_manager": ProductIOManager(base=str(Store(settings.store).base))},
        executor=executor_of(settings),
    )


def store_of(definitions: dg.Definitions) -> Store:
    """The store that the assets of ``definitions`` use."""
    return cast(ProductIOManager, (definitions.resources or {})["io_manager"]).store


defs = build_definitions(Settings())
