"""The one Definitions object: what the UI, the daemon and the command line all load."""

import dagster as dg

from flymirage_assets.assets.dataset import dataset_assets
from flymirage_assets.assets.navigation import navigation_assets
from flymirage_assets.assets.scene_annotation import scene_annotation_assets
from flymirage_assets.assets.world_generation import world_generation_assets
from flymirage_core.settings import Settings
from resources.io_manager import ProductIOManager
from resources.store import Store


def build_definitions(settings: Settings) -> dg.Definitions:
    """All assets and jobs under ``settings``; one run is one scene, in one process."""
    scene_assets = [
        *world_generation_assets(settings),
        *scene_annotation_assets(settings),
        *navigation_assets(settings),
    ]
    over_all = dataset_assets(settings)
    replan = dg.AssetSelection.assets("trajectories").downstream() - dg.AssetSelection.assets(*over_all)
    return dg.Definitions(
        assets=[*scene_assets, *over_all],
        jobs=[
            dg.define_asset_job("grow_scene", dg.AssetSelection.assets(*scene_assets), description="One scene, whole."),
            dg.define_asset_job("replan", replan, description="Trajectories and what follows from them."),
            dg.define_asset_job("dataset_and_exports", dg.AssetSelection.assets(*over_all)),
        ],
        resources={"io_manager": ProductIOManager(base=str(Store(settings.store).base))},
        executor=dg.in_process_executor,
    )


defs = build_definitions(Settings())
