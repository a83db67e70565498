"""The data set over all scenes: manifest, splits, statistics, card, and the exports. Unpartitioned."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

import dagster as dg

from flymirage_assets import previews
from flymirage_assets.stage import ProductAsset, Stage, materialize_result, one_clear_sentence
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.dataset.episodes import SceneProducts
from flymirage_core.dataset.lerobot import DepthExport, export_lerobot
from flymirage_core.dataset.manifest import DatasetManifest, build_manifest
from flymirage_core.errors import InputError
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.navigation.task_sets import TaskSets
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.rendering.frames import Frames
from flymirage_core.scene.description import SceneDescription
from flymirage_core.settings import Settings
from resources.io_manager import ProductIOManager
from resources.store import ALL_SCENES, Store

_NEEDED: dict[str, Any] = {
    "description": SceneDescription,
    "boxes": BoxMap,
    "task_sets": TaskSets,
    "trajectories": Trajectories,
    "frames": Frames,
    "quality_verdict": QualityVerdicts,
    "prompts": Prompts,
}


def finished_scenes(store: Store) -> list[str]:
    """Scenes that have every product which the data set needs."""
    return [s for s in store.scenes() if all(store.current(asset, s) is not None for asset in _NEEDED)]


def check_exportable(store: Store) -> None:
    """Raise `InputError` if no scene is finished."""
    if not finished_scenes(store):
        raise InputError("there is nothing to export: no scene has all its products yet; run `flymirage grow`")


def scene_products(store: Store, scene: str) -> SceneProducts:
    """All products of one scene, loaded (videos stay on disk until asked for)."""
    values = {asset: kind.load(store.folder(asset, scene)) for asset, kind in _NEEDED.items()}
    versions = {asset: record.digest for asset in _NEEDED if (record := store.current(asset, scene))}
    return SceneProducts(scene=scene, data_versions=versions, verdicts=values.pop("quality_verdict"), **values)


def all_products(store: Store) -> Iterator[SceneProducts]:
    """The finished scenes' products, one scene at a time."""
    return (scene_products(store, scene) for scene in finished_scenes(store))


class LeRobotConfig(dg.Config):
    """Where the LeRobot folder goes, and how depth is kept in it."""

    folder: str = "data/lerobot"
    depth: str = DepthExport.PNG16.value


def dataset_assets(settings: Settings) -> list[dg.AssetsDefinition]:
    def compute(stage: Stage) -> DatasetManifest:
        return build_manifest(all_products(stage.store))

    stage = ProductAsset("dataset", compute, previews.dataset, "1", (), (), settings)
    every_scene = dg.AssetDep("prompts", partition_mapping=dg.AllPartitionMapping())

    @dg.asset(
        deps=[every_scene],
        group_name="dataset",
        code_version=stage.code_version,
        required_resource_keys={"io_manager"},
        kinds={"parquet"},
    )
    def dataset(context: dg.AssetExecutionContext) -> Any:
        """Episodes of all finished scenes, with splits, statistics and the data set's card."""
        store = cast(ProductIOManager, context.resources.io_manager).store
        with one_clear_sentence():
            digests = {
                f"{asset}/{scene}": record.digest
                for scene in finished_scenes(store)
                for asset in _NEEDED
                if (record := store.current(asset, scene))
            }
            commit = stage.materialise(store, ALL_SCENES, {}, digests, context.log.info)
        return materialize_result(commit, store)

    @dg.asset(deps=[dataset], group_name="dataset", required_resource_keys={"io_manager"}, kinds={"lerobot"})
    def lerobot(context: dg.AssetExecutionContext, config: LeRobotConfig) -> dg.MaterializeResult[None]:
        """The data set as a LeRobot v3.0 folder: video, depth, state, action, instructions."""
        store = cast(ProductIOManager, context.resources.io_manager).store
        with one_clear_sentence():
            check_exportable(store)
            folder = Path(config.folder).absolute()
            report = export_lerobot(all_products(store), folder, DepthExport(config.depth))
        return dg.MaterializeResult(metadata={**report.summary(), "folder": dg.MetadataValue.path(str(folder))})

    return [dataset, lerobot]
