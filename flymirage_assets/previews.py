"""One picture for each product: what a person wants to see of it. Composition only; drawing is in the core."""

from collections.abc import Iterable

import cv2
import numpy as np

from flymirage_assets.stage import Stage
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.targets import Targets
from flymirage_core.dataset.manifest import DatasetManifest
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.navigation.task_sets import TaskSets
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.pictures.box_overlay import draw_boxes
from flymirage_core.pictures.canvas import INK, Picture, contact_sheet, hue, resized, stacked, text_card
from flymirage_core.pictures.flights import flight_over_time, flights_by_speed
from flymirage_core.pictures.floor_plan import FloorPlan
from flymirage_core.pictures.target_selection import draw_target_selection
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.frames import FlightFrames, Frames
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.rendering.views import PosedViews, View
from flymirage_core.scene.description import SceneDescription
from flymirage_core.splats.world import World

START: tuple[int, int, int] = (40, 160, 70)
GOAL: tuple[int, int, int] = (205, 60, 45)


def description(stage: Stage, product: SceneDescription) -> Picture:
    asked = ", ".join(f"{o.count} {o.colour} {o.noun}" for o in product.objects)
    place = f"{product.category} / {product.subcategory}; {product.style}; {product.light.words}"
    return text_card(product.title, [p for p in (place, product.prose, asked) if p.strip("/; ")])


def image(stage: Stage, product: ScenePicture, description: SceneDescription) -> Picture:
    return product.rgb


def world(stage: Stage, product: World, description: SceneDescription, image: ScenePicture) -> Picture:
    """Eight looks from c, which is what every other camera in the pipeline will see."""
    intrinsics = Intrinsics.from_horizontal_fov(320, 240, np.radians(90))
    yaws = np.arange(8) * 45
    cameras = [
        Camera(intrinsics, look_along(product.centre, [np.sin(np.radians(y)), np.cos(np.radians(y)), -0.1]))
        for y in yaws
    ]
    views = [v.rgb for v in stage.tools.rasterizer.render(product.cloud, cameras)]
    return contact_sheet(views, [f"yaw {y} deg from +y" for y in yaws], columns=4, width=240)


def orbit(stage: Stage, product: PosedViews, world: World) -> Picture:
    return _sheet(product, range(len(product)), columns=12 if len(product) > 24 else 6, width=120)


def orbit_boxes(stage: Stage, product: BoxMap, orbit_renders: PosedViews) -> Picture:
    return _boxes_in(product, orbit_renders, len(orbit_renders) // 3)


def targets(stage: Stage, product: Targets, orbit_boxes: BoxMap, world: World) -> Picture:
    grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
    plan = _plan(grid, world.centre)
    return draw_target_selection(plan, orbit_boxes, product.boxes, world.centre, stage.settings.targets)


def exploration(stage: Stage, product: PosedViews, world: World, targets: Targets) -> Picture:
    grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
    plan = _plan(grid, world.centre)
    for i, group in enumerate(dict.fromkeys(product.groups)):
        points = [c.position for c, g in zip(product.cameras, product.groups, strict=True) if g == group]
        plan.path(points, hue(i))
        for point in points:
            plan.dot(point, hue(i), 3)
    plan.boxes(targets.boxes)
    plan.dot(world.centre, START)
    step = max(1, len(product) // 12)
    shown = list(range(0, len(product), step))[:12]
    return stacked([plan.with_caption(["camera paths from c (green) to the targets"]), _sheet(product, shown, 6, 120)])


def boxes(stage: Stage, product: BoxMap, orbit_renders: PosedViews, exploration_renders: PosedViews) -> Picture:
    return _boxes_in(product, orbit_renders, len(orbit_renders) // 3)


def task_sets(stage: Stage, product: TaskSets, world: World, boxes: BoxMap) -> Picture:
    grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
    plan = _plan(grid, world.centre)
    plan.boxes(boxes)
    for task in product:
        plan.path([task.start, task.target_point], hue(task.set_index), 1)
        plan.dot(task.target_point, GOAL, 4)
    return plan.with_caption([f"{len(product)} tasks, one colour for each set; red: target points"])


def trajectories(stage: Stage, product: Trajectories, world: World, boxes: BoxMap, task_sets: TaskSets) -> Picture:
    """All flights by speed, from above and from the side, and the longest one over time."""
    grid = occupancy_from_splats(world.cloud, world.centre, stage.settings.occupancy)
    maps = flights_by_speed(product, grid, boxes, _heights(world.centre), stage.settings.planner)
    numbers = [f"{name.replace('_', ' ')}: {value}" for name, value in product.summary().items()]
    about = text_card("trajectories", ["   ".join(numbers), *sorted({r.reason for r in product.rejected})[:3]])
    if not product.flights:
        return stacked([maps, about])
    longest = max(product, key=lambda f: f.report.length)
    title = text_card(f"flight {longest.flight_id} to the {boxes.by_id(longest.object_id).label}", [], maps.shape[1])
    return stacked([about, maps, title, flight_over_time(longest, stage.settings.planner, maps.shape[1])])


def frames(stage: Stage, product: Frames, world: World, boxes: BoxMap, trajectories: Trajectories) -> Picture:
    """Six frames of the longest flight, colour above depth."""
    if not product.flight_ids:
        return text_card("no flight was recorded", [])
    flight = product.flight(max(product.flight_ids, key=lambda i: len(product.flight(i))))
    shown = _six(flight)
    depth = [_depth_picture(d) for d in flight.depth_at(shown)]
    return contact_sheet(
        flight.rgb_at(shown) + depth, [_stamp(flight, i) for i in shown] * 2, columns=len(shown), width=180
    )


def quality_verdict(
    stage: Stage, product: QualityVerdicts, frames: Frames, trajectories: Trajectories, boxes: BoxMap
) -> Picture:
    """The last frame of each flight: framed green if kept, red with the failed gates if dropped."""
    tiles, captions = [], []
    for verdict in product:
        flight = frames.flight(verdict.flight_id)
        last = flight.rgb_at([len(flight) - 1])[0].copy()
        cv2.rectangle(last, (0, 0), (last.shape[1] - 1, last.shape[0] - 1), START if verdict.keep else GOAL, 12)
        failed = ", ".join(g.gate for g in verdict.gates if not g.passed)
        tiles.append(last)
        captions.append(f"{verdict.flight_id}: {failed or 'kept'}")
    return contact_sheet(tiles, captions, columns=6, width=150)


def prompts(
    stage: Stage,
    product: Prompts,
    frames: Frames,
    boxes: BoxMap,
    trajectories: Trajectories,
    quality_verdict: QualityVerdicts,
) -> Picture:
    """Six frames of each of the first three flights, with what the drone was told."""
    rows: list[Picture] = []
    for flight_id in list(dict.fromkeys(p.flight_id for p in product))[:3]:
        flight = frames.flight(flight_id)
        shown = _six(flight)
        sheet = contact_sheet(flight.rgb_at(shown), [_stamp(flight, i) for i in shown], columns=len(shown), width=150)
        texts = [f"{p.kind}: {p.text}" for p in product.of_flight(flight_id)]
        rows += [sheet, text_card(f"flight {flight_id}", texts, sheet.shape[1])]
    return stacked(rows) if rows else text_card("no prompt was written", [])


def _sheet(views: PosedViews, shown: Iterable[int], columns: int, width: int) -> Picture:
    shown = list(shown)
    pictures = [views[i].picture.rgb for i in shown]
    return contact_sheet(pictures, [views.groups[i] for i in shown], columns, width)


def _boxes_in(boxes: BoxMap, orbit_renders: PosedViews, start: int) -> Picture:
    """All boxes drawn into four views of the middle elevation, a quarter turn apart."""
    step = max(1, len(orbit_renders) // (4 * len(set(orbit_renders.groups))))
    views: list[View] = [orbit_renders[(start + i * step) % len(orbit_renders)] for i in range(4)]
    drawn = [
        draw_boxes(resized(v.picture.rgb, 2 * v.camera.intrinsics.width), _doubled(v.camera), boxes) for v in views
    ]
    return contact_sheet(drawn, [f"{len(boxes)} boxes"] + [""] * 3, columns=2, width=480)


def _doubled(camera: Camera) -> Camera:
    k = camera.intrinsics
    twice = Intrinsics(2 * k.width, 2 * k.height, 2 * k.fx, 2 * k.fy, 2 * k.cx, 2 * k.cy)
    return Camera(twice, camera.T_world_camera)


def _plan(grid: OccupancyGrid, centre: np.ndarray) -> FloorPlan:
    return FloorPlan.of(grid, _heights(centre))


def _heights(centre: np.ndarray) -> tuple[float, float]:
    """Where most is flown: from a little below c to a little above it."""
    return max(0.3, centre[2] - 0.8), centre[2] + 0.6


def _six(flight: FlightFrames) -> list[int]:
    return sorted({int(i) for i in np.linspace(0, len(flight) - 1, 6)})


def _stamp(flight: FlightFrames, index: int) -> str:
    return f"{float(flight.table['time'].iloc[index]):.1f} s"


def _depth_picture(depth: np.ndarray) -> Picture:
    metres = depth.astype(np.float32) / 1000
    shade = np.clip(255 * (1 - metres / max(float(metres.max()), 1e-3)), 0, 255).astype(np.uint8)
    coloured = cv2.applyColorMap(shade, cv2.COLORMAP_VIRIDIS)[:, :, ::-1].copy()
    coloured[depth == 0] = INK
    return coloured.astype(np.uint8)


def dataset(stage: Stage, product: DatasetManifest) -> Picture:
    numbers = [f"{name.replace('_', ' ')}: {value}" for name, value in product.summary().items()]
    return text_card("the data set", numbers)
