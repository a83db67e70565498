"""The embedded twins of the image model and the world model: a furnished, lit place out of words, and its picture."""

from functools import lru_cache

import numpy as np

from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.scene.description import SceneDescription
from flymirage_core.settings import GenerationSettings
from flymirage_core.splats.collider import to_glb
from flymirage_core.splats.world import World
from flymirage_core.worldgen.assembly import assemble, build_truth
from flymirage_core.worldgen.fitting import fitted
from flymirage_core.worldgen.sampling import lit_world
from flymirage_core.worldgen.viewpoints import best_view, panorama

NAME = "offline 6"


class OfflineWorldModel:
    """Description -> spaces -> layout -> surfaces -> lit Gaussians. The picture is not needed: it shows this world."""

    name = NAME

    def __init__(self, settings: GenerationSettings) -> None:
        self.settings = settings

    def build(self, description: SceneDescription, picture: ScenePicture | None = None) -> World:
        """A world of about ``settings.gaussians`` Gaussians; the main space's middle is the origin, c free by 1 m."""
        return _built(description, self.settings.gaussians, self.settings.views)


@lru_cache(maxsize=1)  # the painter has just built the world that the world model is asked for next
def _built(description: SceneDescription, count: int, views: int) -> World:
    assembly = assemble(description)
    lit = lit_world(assembly, count)
    truth = assembly.truth
    cloud = fitted(lit, truth, views)
    notes = {
        "source": f"world model {NAME}",
        "scale": 1.0,
        "scale_source": "metric by construction",
        "objects_placed": len(truth.objects),
        "objects_unplaced": sum(u.count for u in truth.unplaced),
    }
    collider = to_glb(lit.mesh.vertices, lit.mesh.faces)
    centre = np.array(truth.centre)
    return World(cloud, centre, notes, collider, panorama(cloud, centre, CpuRasterizer()))


class OfflinePainter:
    """Paints by building the world and rendering it from the viewpoint that shows most of it."""

    name = NAME

    def __init__(self, rasterizer: Rasterizer, settings: GenerationSettings) -> None:
        self.rasterizer = rasterizer
        self.model = OfflineWorldModel(settings)

    def paint(self, description: SceneDescription) -> ScenePicture:
        world = self.model.build(description)
        truth = build_truth(description)
        return ScenePicture(best_view(world.cloud, truth, self.rasterizer), f"{NAME} through {self.rasterizer.name}")
