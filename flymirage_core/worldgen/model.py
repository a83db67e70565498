"""The embedded twins of the image model and the world model: a furnished, lit room out of words, and its picture."""

from functools import lru_cache

import numpy as np

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.scene.description import SceneDescription
from flymirage_core.settings import GenerationSettings
from flymirage_core.splats.world import World
from flymirage_core.worldgen.layout import lay_out
from flymirage_core.worldgen.sampling import gaussians
from flymirage_core.worldgen.truth import WorldTruth

NAME = "offline 1"
PICTURE_SIZE = (960, 640)
PICTURE_FOV_DEG = 82.0
PICTURE_BACK = 0.42
"""The picture is taken from the room's middle plus this share of its sides, towards a corner."""
PICTURE_HEIGHT = 1.9
"""Metres."""


class OfflineWorldModel:
    """Description -> layout -> surfaces -> lit Gaussians. The picture is not needed: it shows the same world."""

    name = NAME

    def __init__(self, settings: GenerationSettings) -> None:
        self.settings = settings

    def build(self, description: SceneDescription, picture: ScenePicture | None = None) -> World:
        """A world of about ``settings.gaussians`` Gaussians; the floor's middle is the origin, c is free for 1 m."""
        return _built(description, self.settings.gaussians)


@lru_cache(maxsize=1)  # the painter has just built the world that the world model is asked for next
def _built(description: SceneDescription, count: int) -> World:
    room, truth = lay_out(description)
    cloud = gaussians(description, room, truth, count)
    notes = {
        "source": f"world model {NAME}",
        "scale": 1.0,
        "scale_source": "metric by construction",
        "objects_placed": len(truth.objects),
        "objects_unplaced": sum(u.count for u in truth.unplaced),
    }
    return World(cloud, np.array(truth.centre), notes)


class OfflinePainter:
    """Paints by building the world and rendering it from the corner that shows most of the room."""

    name = NAME

    def __init__(self, rasterizer: Rasterizer, settings: GenerationSettings) -> None:
        self.rasterizer = rasterizer
        self.model = OfflineWorldModel(settings)

    def paint(self, description: SceneDescription) -> ScenePicture:
        world = self.model.build(description)
        views = list(self.rasterizer.render(world.cloud, [corner_view(description, c) for c in range(4)]))
        near = [float(np.quantile(v.depth[v.depth > 0], 0.1)) if (v.depth > 0).any() else 0.0 for v in views]
        return ScenePicture(views[int(np.argmax(near))].rgb, f"{NAME} through {self.rasterizer.name}")


def corner_view(description: SceneDescription, corner: int) -> Camera:
    """Looking across the room from near corner 0..3."""
    x, y, _ = description.dimensions
    side = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)][corner])
    position = np.array([*(side * PICTURE_BACK * (x, y)), PICTURE_HEIGHT])
    direction = np.array([*(-side * (x, y)), -0.2 * np.hypot(x, y)])
    intrinsics = Intrinsics.from_horizontal_fov(*PICTURE_SIZE, np.radians(PICTURE_FOV_DEG))
    return Camera(intrinsics, look_along(position, direction))


def build_truth(description: SceneDescription) -> WorldTruth:
    """What `OfflineWorldModel` puts where, for measuring; the world itself never carries it."""
    return lay_out(description)[1]
