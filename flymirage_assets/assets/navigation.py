"""Navigation & Collection (paper, section III-C): task sets, feasible flights, frames, verdicts, prompts."""

import dagster as dg

from flymirage_assets import previews
from flymirage_assets.stage import Stage, product_asset
from flymirage_assets.tracked import TrackedRasterizer
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.instances import oriented_boxes
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.navigation.camera_paths import camera_paths
from flymirage_core.navigation.fly import fly_task_sets
from flymirage_core.navigation.task_sets import TaskSets, generate_task_sets
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.rendering.frames import Frames, camera_rig
from flymirage_core.rendering.recording import record_frames
from flymirage_core.settings import Settings
from flymirage_core.splats.world import World


def navigation_assets(settings: Settings) -> list[dg.AssetsDefinition]:
    group = "navigation_and_collection"

    @product_asset(
        version="3", group=group, settings=settings, sections=["occupancy", "tasks"], draw=previews.task_sets
    )
    def task_sets(stage: Stage, world: World, boxes: BoxMap) -> TaskSets:
        """N_s sets of N_o targets, each accepted by position, visibility, waypoint-safety and distance checks."""
        grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
        return generate_task_sets(grid, boxes, world.centre, stage.settings.tasks, stage.rng("task_sets"))

    @product_asset(
        version="2",
        group=group,
        settings=settings,
        sections=["occupancy", "planner", "quadrotor"],
        draw=previews.trajectories,
    )
    def trajectories(stage: Stage, world: World, boxes: BoxMap, task_sets: TaskSets) -> Trajectories:
        """EGO-Planner flights from target to target: 6-DoF states with velocity, body rates and clearance."""
        grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
        chosen = stage.settings
        return fly_task_sets(task_sets, grid, boxes, chosen.planner, chosen.quadrotor, stage.rng("trajectories"))

    @product_asset(
        version="4", group=group, settings=settings, sections=["frames"], tools=["rasterizer"], draw=previews.frames
    )
    def frames(stage: Stage, world: World, boxes: BoxMap, trajectories: Trajectories) -> Frames:
        """RGB video, lossless depth video and, at every frame, the camera's pose and how much shows the target."""
        rig = camera_rig(stage.settings.frames)
        paths = camera_paths(trajectories, boxes, rig.frame_rate)
        rasterizer = TrackedRasterizer(stage.tools.rasterizer, "frames")
        objects = oriented_boxes(boxes) if stage.settings.frames.instances else None
        return record_frames(world.cloud, paths, rig, rasterizer, stage.scratch, objects)

    @product_asset(
        version="1",
        group=group,
        settings=settings,
        sections=["verdict", "planner"],
        tools=["frame_judge"],
        draw=previews.quality_verdict,
    )
    def quality_verdict(stage: Stage, frames: Frames, trajectories: Trajectories, boxes: BoxMap) -> QualityVerdicts:
        """Keep or drop, for each flight: measured gates, each with its value, its threshold and a reason."""
        return stage.tools.frame_judge.judge(frames, trajectories, boxes)

    @product_asset(version="1", group=group, settings=settings, tools=["prompter"], draw=previews.prompts)
    def prompts(
        stage: Stage, frames: Frames, boxes: BoxMap, trajectories: Trajectories, quality_verdict: QualityVerdicts
    ) -> Prompts:
        """Up to three instructions for each kept flight: object-centred, relative, appearance; none ambiguous."""
        return stage.tools.prompter.write(stage.scene, frames, boxes, trajectories, quality_verdict)

    return [task_sets, trajectories, frames, quality_verdict, prompts]
