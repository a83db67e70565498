"""The data set over all scenes: manifest, splits, statistics, card, and the exports. Unpartitioned."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import dagster as dg

from flymirage_assets import previews
from flymirage_assets.catalogue import KINDS
from flymirage_assets.failures import one_clear_sentence
from flymirage_assets.report import SCENE_PRODUCTS
from flymirage_assets.stage import ProductAsset, Stage, about, materialize_result
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.dataset.changelog import DataVersion
from flymirage_core.dataset.export_folder import export
from flymirage_core.dataset.formats import DESCRIPTIONS, FORMATS
from flymirage_core.dataset.lerobot import DepthExport
from flymirage_core.dataset.manifest import DatasetManifest, build_manifest
from flymirage_core.dataset.scene_products import SceneLineage, SceneProducts
from flymirage_core.errors import InputError, ProductError
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
    return store.scenes_with_all(tuple(_NEEDED))


def check_exportable(store: Store) -> None:
    """Raise `InputError` if no scene is finished."""
    if not finished_scenes(store):
        raise InputError("there is nothing to export: no scene has all its products yet; run `flymirage grow`")


def scene_products(store: Store, scene: str) -> SceneProducts:
    """All products of one scene, loaded (videos stay on disk until asked for)."""
    values = {asset: kind.load(store.folder(asset, scene)) for asset, kind in _NEEDED.items()}
    records = {asset: record for asset in SCENE_PRODUCTS if (record := store.current(asset, scene)) is not None}
    lineage = SceneLineage(
        seed=scene,
        tools={asset: "; ".join(dict.fromkeys(r.tools.values())) for asset, r in records.items() if r.tools},
        usd=sum(r.usd for r in records.values()),
        seconds=sum(r.seconds for r in records.values()),
        flymirage_version=records["prompts"].flymirage_version,
    )
    verdicts = values.pop("quality_verdict")
    return SceneProducts(
        scene=scene, data_versions=_versions(store, scene), verdicts=verdicts, lineage=lineage, **values
    )


def _versions(store: Store, scene: str) -> dict[str, str]:
    return {asset: record.digest for asset in _NEEDED if (record := store.current(asset, scene))}


@dataclass(frozen=True)
class StoredScene:
    """A finished scene whose products are loaded when an export asks for them."""

    store: Store
    scene: str

    @cached_property
    def data_versions(self) -> dict[str, str]:
        return _versions(self.store, self.scene)

    def products(self) -> SceneProducts:
        return scene_products(self.store, self.scene)


def stored_scenes(store: Store, wanted: Iterable[str] = ()) -> list[StoredScene]:
    """The finished scenes, or those of them that are ``wanted``; raises `InputError` if one of them is not finished."""
    finished = finished_scenes(store)
    missing = sorted(set(wanted) - set(finished))
    if missing:
        raise InputError(
            f"{', '.join(missing)}: no such finished scene; those that are: {', '.join(finished) or 'none'}"
        )
    return [StoredScene(store, scene) for scene in wanted or finished]


def _earlier_versions(store: Store) -> tuple[DataVersion, ...]:
    """The data set's versions so far; none if there is no data set that this code reads."""
    try:
        return DatasetManifest.load(store.folder("dataset", ALL_SCENES)).versions
    except ProductError:
        return ()


class ExportConfig(dg.Config):
    """Where an export goes, which scenes it holds (all finished ones if none is named), how LeRobot keeps depth."""

    folder: str = ""  # data/<format> if empty
    scenes: list[str] = []  # noqa: RUF012 - a pydantic field
    depth: str = DepthExport.PNG16.value


def export_asset(form: str, dataset: dg.AssetsDefinition) -> dg.AssetsDefinition:
    """The asset that writes one format; only scenes that are new or changed since the last time are written."""

    @dg.asset(
        name=form,
        deps=[dataset],
        group_name="dataset",
        owners=["team:dataset"],
        required_resource_keys={"io_manager"},
        kinds=KINDS[form],
        description=DESCRIPTIONS[form],
        metadata=about(form, export),
    )
    def write(context: dg.AssetExecutionContext, config: ExportConfig) -> dg.MaterializeResult[None]:
        store = cast(ProductIOManager, context.resources.io_manager).store
        with one_clear_sentence():
            check_exportable(store)
            folder = Path(config.folder or f"data/{form}").absolute()
            chosen = FORMATS[form](DepthExport(config.depth))
            report = export(chosen, stored_scenes(store, config.scenes), folder)
        return dg.MaterializeResult(metadata={**report.summary(), "folder": dg.MetadataValue.path(str(folder))})

    return write


def dataset_assets(settings: Settings) -> list[dg.AssetsDefinition]:
    def compute(stage: Stage) -> DatasetManifest:
        return build_manifest(stored_scenes(stage.store), _earlier_versions(stage.store))

    stage = ProductAsset("dataset", compute, previews.dataset, "2", (), (), settings)
    every_scene = dg.AssetDep("prompts", partition_mapping=dg.AllPartitionMapping())

    @dg.asset(
        deps=[every_scene],
        group_name="dataset",
        owners=["team:dataset"],
        code_version=stage.code_version,
        required_resource_keys={"io_manager"},
        kinds=KINDS["dataset"],
        metadata=about("dataset", build_manifest),
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

    return [dataset, *(export_asset(form, dataset) for form in FORMATS)]
