"""Scene Annotation (paper, section III-B): orbit, first boxes, Algorithm 1, exploration, the fused global box map."""

import math

import dagster as dg

from flymirage_assets import previews
from flymirage_assets.stage import Stage, product_asset
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.exploration import explore
from flymirage_core.annotation.targets import Targets, select_targets
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.progress import track
from flymirage_core.rendering.placements import orbit, view_intrinsics
from flymirage_core.rendering.views import PosedViews
from flymirage_core.settings import Settings
from flymirage_core.splats.world import World


def scene_annotation_assets(settings: Settings) -> list[dg.AssetsDefinition]:
    group = "scene_annotation"

    @product_asset(
        version="1", group=group, settings=settings, sections=["views"], tools=["rasterizer"], draw=previews.orbit
    )
    def orbit_renders(stage: Stage, world: World) -> PosedViews:
        """RGB, expected depth and pose on the inward orbit around c: a full yaw sweep at each of several elevations."""
        cameras, elevations = orbit(world.centre, stage.settings.views)
        pictures = stage.tools.rasterizer.render(world.cloud, cameras)
        return PosedViews.write(stage.scratch, cameras, track(pictures, "views", len(cameras)), elevations)

    @product_asset(
        version="9",
        group=group,
        settings=settings,
        sections=["annotation"],
        tools=["annotator"],
        draw=previews.orbit_boxes,
    )
    def orbit_boxes(stage: Stage, orbit_renders: PosedViews) -> BoxMap:
        """The candidate set O: first-pass 3D boxes, from the orbit alone and at all distances."""
        return stage.tools.annotator.annotate(orbit_renders, max_distance=math.inf)

    @product_asset(
        version="1", group=group, settings=settings, sections=["targets", "occupancy"], draw=previews.targets
    )
    def targets(stage: Stage, orbit_boxes: BoxMap, world: World) -> Targets:
        """Algorithm 1: far objects, spread in distance and direction, that need a closer look."""
        return select_targets(orbit_boxes, world.centre, stage.settings.targets)

    @product_asset(
        version="1",
        group=group,
        settings=settings,
        sections=["views", "occupancy", "exploration"],
        tools=["rasterizer"],
        draw=previews.exploration,
    )
    def exploration_renders(stage: Stage, world: World, targets: Targets) -> PosedViews:
        """Four-view rigs along collision-checked, Laplacian-smoothed A* paths from c to each target."""
        grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
        intrinsics = view_intrinsics(stage.settings.views)
        cameras, paths = explore(grid, world.centre, targets, stage.settings.exploration, intrinsics)
        pictures = stage.tools.rasterizer.render(world.cloud, cameras)
        return PosedViews.write(stage.scratch, cameras, track(pictures, "views", len(cameras)), paths)

    @product_asset(
        version="9",
        group=group,
        settings=settings,
        sections=["annotation", "targets"],
        tools=["annotator"],
        draw=previews.boxes,
    )
    def boxes(stage: Stage, orbit_renders: PosedViews, exploration_renders: PosedViews) -> BoxMap:
        """The global box map, fused from both passes; nothing beyond d_th1 of the camera that saw it enters."""
        views = [*orbit_renders, *exploration_renders]
        return stage.tools.annotator.annotate(views, max_distance=stage.settings.targets.near_distance)

    return [orbit_renders, orbit_boxes, targets, exploration_renders, boxes]
