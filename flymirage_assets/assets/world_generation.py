"""World Generation (paper, section III-A): description -> image -> Gaussian-splat world."""

import dagster as dg

from flymirage_assets import previews
from flymirage_assets.stage import Stage, product_asset
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import SceneDescription
from flymirage_core.settings import Settings
from flymirage_core.splats.world import World
from resources.imports import describe_import, load_import, picture_of_import


def world_generation_assets(settings: Settings) -> list[dg.AssetsDefinition]:
    @product_asset(
        version="2", group="world_generation", settings=settings, tools=["scene_writer"], draw=previews.description
    )
    def description(stage: Stage) -> SceneDescription:
        """The scene's structured specification and prose, from a taxonomy pick; of an import, its provenance."""
        if stage.origin.kind == "imported":
            return describe_import(stage.origin)
        return stage.tools.scene_writer.describe(stage.scene, stage.origin.place)

    @product_asset(
        version="4",
        group="world_generation",
        settings=settings,
        sections=["generation", "cleaning"],
        tools=["image_painter"],
        draw=previews.image,
    )
    def image(stage: Stage, description: SceneDescription) -> ScenePicture:
        """One picture of the scene; of an imported world, a view rendered from its centre."""
        if description.provenance.kind == "imported":
            return picture_of_import(
                load_import(stage.store, stage.origin, stage.settings.cleaning), stage.tools.rasterizer
            )
        return stage.tools.image_painter.paint(description)

    @product_asset(
        version="4",
        group="world_generation",
        settings=settings,
        sections=["generation", "cleaning"],
        tools=["world_model"],
        draw=previews.world,
    )
    def world(stage: Stage, description: SceneDescription, image: ScenePicture) -> World:
        """The 3D Gaussian world in the metric z-up frame, with its centre c, from the description and its picture."""
        if description.provenance.kind == "imported":
            return load_import(stage.store, stage.origin, stage.settings.cleaning)
        return stage.tools.world_model.build(description, image)

    return [description, image, world]
