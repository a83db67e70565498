"""Worlds that the user already has: their description, their picture, and reading them out of the store."""

from dataclasses import replace

import numpy as np

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import Light
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.imports import import_world
from flymirage_core.splats.world import World
from resources.records import SceneOrigin
from resources.store import Store

PICTURE_SIZE = (960, 640)
PICTURE_FOV = np.radians(80.0)


def load_import(store: Store, origin: SceneOrigin, cleaning: CleaningSettings) -> World:
    """The imported world in the metric z-up frame; raises `WorldError` or `ProductError` with one sentence."""
    world = import_world(store.imported_file(origin), origin.up, origin.scale, cleaning)
    return replace(world, notes={**world.notes, "source": origin.file_name})


def describe_import(origin: SceneOrigin) -> SceneDescription:
    """What is known of an imported world: its provenance, and nothing made up."""
    title = origin.title or origin.scene
    return SceneDescription(
        scene=origin.scene,
        title=title,
        category="imported",
        subcategory="imported",
        setting="indoor",
        dimensions=(0.0, 0.0, 0.0),
        zones=(),
        style="",
        era="",
        palette=(),
        light=Light(time_of_day="noon", sky="none", sources=("sky",), words="as captured"),
        objects=(),
        prose=f"{title}: a Gaussian-splat world imported from {origin.file_name}.",
        image_prompt="",
        world_prompt="",
        provenance=Provenance(
            kind="imported",
            writer="import",
            file_name=origin.file_name,
            file_sha256=origin.file_sha256,
            up=origin.up,
            scale=origin.scale or 0.0,
        ),
    )


def picture_of_import(world: World, rasterizer: Rasterizer) -> ScenePicture:
    """The view from c along the yaw (of eight) that shows most detail."""
    intrinsics = Intrinsics.from_horizontal_fov(*PICTURE_SIZE, PICTURE_FOV)
    yaws = np.arange(8) * np.pi / 4
    cameras = [Camera(intrinsics, look_along(world.centre, [np.sin(y), np.cos(y), -0.15])) for y in yaws]
    views = [v.rgb for v in rasterizer.render(world.cloud, cameras)]
    detail = [float(np.abs(np.diff(v.astype(np.int16), axis=1)).mean()) for v in views]
    return ScenePicture(views[int(np.argmax(detail))], f"rendered view of the import ({rasterizer.name})")
