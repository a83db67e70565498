"""Scene annotation as a whole: a generated world scored against its truth, and a captured room if there is one."""

import math
import os
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.exploration import explore
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.labels import UNKNOWN
from flymirage_core.annotation.targets import select_targets
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.placements import orbit, view_intrinsics
from flymirage_core.rendering.views import View
from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import GenerationSettings, Settings
from flymirage_core.splats.imports import import_world
from flymirage_core.splats.world import World
from flymirage_core.worldgen.assembly import build_truth
from flymirage_core.worldgen.model import OfflineWorldModel

SETTINGS = Settings()
DATA = Path(os.environ.get("FLYMIRAGE_TEST_DATA", Path(__file__).parents[3] / "shared" / "data"))


def both_passes(world: World):
    """(first boxes, final boxes, views of the final ones) as the pipeline makes them."""
    annotator, rasterizer = EmbeddedAnnotator(SETTINGS.annotation), CpuRasterizer()

    def see(cameras):
        return [View(c, p) for c, p in zip(cameras, rasterizer.render(world.cloud, cameras), strict=True)]

    views = see(orbit(world.centre, SETTINGS.views)[0])
    first = annotator.annotate(views, math.inf)
    targets = select_targets(first, world.centre, SETTINGS.targets)
    grid = occupancy_from_splats(world.cloud, world.centre, SETTINGS.occupancy)
    cameras, _ = explore(grid, world.centre, targets, SETTINGS.exploration, view_intrinsics(SETTINGS.views))
    views += see(cameras)
    return first, annotator.annotate(views, SETTINGS.targets.near_distance), views


def a_home() -> SceneDescription:
    """The first indoor home among some keys: halls with galleries are harder."""
    writer = OfflineSceneWriter()
    described = (writer.describe(f"gate-{i}") for i in range(200))
    return next(d for d in described if d.setting == "indoor" and d.category.startswith("homes"))


@pytest.mark.slow
def test_objects_of_a_generated_world_are_found_where_they_are():
    description = a_home()
    first, boxes, views = both_passes(OfflineWorldModel(GenerationSettings(fitting_views=0)).build(description))
    positions = np.array([v.camera.position for v in views])
    truth = [
        t
        for t in build_truth(description).objects
        if max(t.size) >= 0.2 and np.linalg.norm(positions - t.centre, axis=1).min() <= SETTINGS.targets.near_distance
    ]
    ious = np.array([[yaw_iou(t, b) for b in boxes] for t in truth])
    rows, columns = linear_sum_assignment(-np.where(ious >= 0.25, ious, 0))
    hits = int((ious[rows, columns] >= 0.25).sum())
    assert len(first) > 0
    assert hits >= 0.6 * len(truth)  # among them are a few that no view saw
    assert hits >= 0.7 * len(boxes)  # doors are no objects of the truth
    assert sum(b.label != UNKNOWN for b in boxes) >= 0.4 * len(boxes)
    assert all(b.nearest_camera_distance <= SETTINGS.targets.near_distance for b in boxes)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["bedroom_sw_lod2.spz"])
def test_a_captured_room_is_annotated_without_its_walls(name):
    if not (DATA / name).exists():
        pytest.skip(f"{name} is not beside this repository")
    world = import_world(DATA / name, "auto", None, SETTINGS.cleaning)
    _, boxes, _ = both_passes(world)
    assert 4 <= len(boxes) <= 25
    assert any(b.size[2] < 1.2 and 1.8 < max(b.size) < 2.6 and min(b.size[:2]) > 1.4 for b in boxes)  # the bed
    assert all(max(b.size) < 3.5 for b in boxes)
