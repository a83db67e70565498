"""How right the boxes are: recall, precision, centre error and CPU seconds of both passes. Truth is for scoring only.

    python benchmarks/annotation.py analytic 11 12 13          # exact RGB-D of rooms made of boxes, by seed
    python benchmarks/annotation.py generated demo-1 demo-2    # worlds of the embedded world model, by scene key
    python benchmarks/annotation.py captured ROOM.spz ...      # no truth: boxes drawn into views, to be looked at

``--pictures FOLDER`` writes overlays. Pass 1 is the orbit at all distances; pass 2 adds the exploration, cut at d_th1.
"""

import argparse
import math
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from scipy.optimize import linear_sum_assignment

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.exploration import explore
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.targets import select_targets
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.pictures.box_overlay import draw_boxes
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.placements import orbit, view_intrinsics
from flymirage_core.rendering.views import View
from flymirage_core.settings import Settings
from flymirage_core.splats.cloud import GaussianCloud

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "annotation"))

MIN_TRUE_SIZE = 0.2  # metres: smaller true objects are not counted as missed
MIN_TRUE_PIXELS = 150  # over all views within d_th1 of its centre


@dataclass(frozen=True)
class Scene:
    """Something to annotate: how to see it, where one can fly, and the truth if there is one."""

    name: str
    see: Callable[[Sequence[Camera]], list[View]]
    grid: OccupancyGrid
    centre: np.ndarray
    truth: Sequence[Any]  # boxes with centre, size, yaw; empty if unknown
    openings: Sequence[np.ndarray] = ()  # (2, 3) corners of windows and doors: boxes there are neither right nor wrong


@dataclass(frozen=True)
class Passes:
    """What both passes gave."""

    first: BoxMap
    second: BoxMap
    orbit_views: list[View]
    all_views: list[View]
    groups: list[str]
    seconds: tuple[float, float]  # CPU of each pass's annotation


def run(scene: Scene, settings: Settings) -> Passes:
    annotator = EmbeddedAnnotator(settings.annotation)
    cameras, _ = orbit(scene.centre, settings.views)
    orbit_views = scene.see(cameras)
    started = time.process_time()
    first = annotator.annotate(orbit_views, math.inf)
    first_seconds = time.process_time() - started
    targets = select_targets(first, scene.centre, settings.targets)
    rigs, groups = explore(scene.grid, scene.centre, targets, settings.exploration, view_intrinsics(settings.views))
    views = orbit_views + scene.see(rigs)
    started = time.process_time()
    second = annotator.annotate(views, settings.targets.near_distance)
    return Passes(first, second, orbit_views, views, groups, (first_seconds, time.process_time() - started))


@dataclass(frozen=True)
class Score:
    """Matches of a box map with the truth at one IoU."""

    pairs: list[tuple[int, int, float]]  # truth, box, IoU
    recall: float
    precision: float
    centre_error: float


def score(
    boxes: BoxMap, truth: Sequence[Any], counted: Sequence[bool], min_iou: float, openings: Sequence[np.ndarray] = ()
) -> Score:
    """One-to-one matches of the largest summed IoU; true objects that are not ``counted`` neither help nor harm."""
    ious = np.array([[yaw_iou(t, b) for b in boxes] for t in truth]).reshape(len(truth), len(boxes))
    rows, columns = linear_sum_assignment(-np.where(ious >= min_iou, ious, 0))
    pairs = [(int(t), int(b), float(ious[t, b])) for t, b in zip(rows, columns, strict=True) if ious[t, b] >= min_iou]
    hits = sum(counted[t] for t, _, _ in pairs)
    spare = sum(not counted[t] for t, _, _ in pairs)
    matched = {b for _, b, _ in pairs}
    spare += sum(_in_opening(box, openings) for b, box in enumerate(boxes) if b not in matched)
    errors = [np.linalg.norm(np.subtract(truth[t].centre, boxes.boxes[b].centre)) for t, b, _ in pairs]
    return Score(
        pairs,
        hits / max(sum(counted), 1),
        hits / max(len(boxes) - spare, 1),
        float(np.mean(errors)) if errors else math.nan,
    )


def _in_opening(box: Any, openings: Sequence[np.ndarray]) -> bool:
    """Whether a flat box's middle lies in a window or a door."""
    return min(box.size) < 0.2 and any(
        (o[0] - 0.15 <= box.centre).all() and (box.centre <= o[1] + 0.15).all() for o in openings
    )


def countable(truth: Sequence[Any], views: Iterable[View], max_distance: float) -> list[bool]:
    """Which true objects are large enough, and were seen by views that their centre is within ``max_distance`` of."""
    pixels = np.zeros(len(truth), int)
    centres = np.array([box.centre for box in truth]).reshape(-1, 3)
    for view in views:
        near = np.flatnonzero(np.linalg.norm(centres - view.camera.position, axis=1) <= max_distance)
        points = _near_points(view, 2 * max_distance)
        for i in near:
            box = truth[i]
            c, s = np.cos(box.yaw), np.sin(box.yaw)
            local = (points - box.centre) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            pixels[i] += int((np.abs(local) < np.divide(box.size, 2) + 0.02).all(axis=1).sum())
    return [bool(max(box.size) >= MIN_TRUE_SIZE and n >= MIN_TRUE_PIXELS) for box, n in zip(truth, pixels, strict=True)]


def _near_points(view: View, max_distance: float) -> np.ndarray:
    k, depth = view.camera.intrinsics, view.picture.depth
    u, v = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    rays = np.stack([(u - k.cx) / k.fx, (v - k.cy) / k.fy, np.ones_like(u)], axis=-1)
    near = (depth > 0) & (depth * np.linalg.norm(rays, axis=-1) < max_distance)
    return (rays * depth[..., None])[near] @ view.camera.T_world_camera[:3, :3].T + view.camera.position


def splat_scene(
    name: str,
    cloud: GaussianCloud,
    centre: np.ndarray,
    settings: Settings,
    truth: Sequence[Any] = (),
    openings: Sequence[np.ndarray] = (),
) -> Scene:
    rasterizer = CpuRasterizer(settings.threads)
    grid = occupancy_from_splats(cloud, centre, settings.occupancy)

    def see(cameras: Sequence[Camera]) -> list[View]:
        return [View(c, p) for c, p in zip(cameras, rasterizer.render(cloud, cameras), strict=True)]

    return Scene(name, see, grid, centre, truth, openings)


def generated(key: str, settings: Settings) -> Scene:
    from flymirage_core.scene.writer import OfflineSceneWriter
    from flymirage_core.worldgen.layout import lay_out
    from flymirage_core.worldgen.model import OfflineWorldModel

    description = OfflineSceneWriter().describe(key)
    world = OfflineWorldModel(settings.generation).build(description)
    room, truth = lay_out(description)
    openings = []
    for o in (*room.windows, *room.doors):
        wall = room.walls[o.wall]
        ends = np.array([wall.origin + wall.along * o.left, wall.origin + wall.along * o.right])  # (2, 2)
        openings.append(np.array([[*ends.min(axis=0), o.bottom], [*ends.max(axis=0), o.top]]))
    return splat_scene(key, world.cloud, world.centre, settings, truth.objects, openings)


def captured(path: str, settings: Settings) -> Scene:
    from flymirage_core.splats.imports import import_world

    world = import_world(Path(path), "auto", None, settings.cleaning)
    return splat_scene(Path(path).stem, world.cloud, world.centre, settings)


def analytic(seed: str, settings: Settings) -> Scene:
    from analytic_room import views_of
    from furnished_room import furnished_room, grid_of

    room = furnished_room(int(seed))
    return Scene(
        f"analytic {seed}",
        lambda cameras: views_of(room, cameras),
        grid_of(room, settings.occupancy.resolution),
        np.array([0, 0, 1.4]),
        room.truth,
    )


MAKERS = {"analytic": analytic, "generated": generated, "captured": captured}
HEADER = "scene           pass   views boxes  true   R.25   P.25    R.5    P.5    cm  CPU s"


def report(scene: Scene, passes: Passes, settings: Settings) -> None:
    counted = countable(scene.truth, passes.all_views, settings.targets.near_distance)
    for name, boxes, views, seconds in (
        ("1", passes.first, passes.orbit_views, passes.seconds[0]),
        ("1+2", passes.second, passes.all_views, passes.seconds[1]),
    ):
        if not scene.truth:
            print(f"{scene.name:<16}{name:<6}{len(views):>6}{len(boxes):>6}{'no truth':>47}{seconds:>7.1f}", flush=True)
            continue
        loose, strict = (score(boxes, scene.truth, counted, iou, scene.openings) for iou in (0.25, 0.5))
        print(
            f"{scene.name:<16}{name:<6}{len(views):>6}{len(boxes):>6}{sum(counted):>6}{loose.recall:>7.2f}"
            f"{loose.precision:>7.2f}{strict.recall:>7.2f}{strict.precision:>7.2f}"
            f"{100 * loose.centre_error:>6.1f}{seconds:>7.1f}",
            flush=True,
        )


def write_pictures(folder: Path, scene: Scene, passes: Passes, max_distance: float) -> None:
    """Overlays: boxes of pass 2 in six views of the orbit and in two of the exploration."""
    folder.mkdir(parents=True, exist_ok=True)
    views = passes.orbit_views
    picks = [views[k] for k in range(len(views) // 3, 2 * len(views) // 3, 2)]
    rigs = passes.all_views[len(views) :]
    picks += [rigs[k] for k in np.linspace(0, len(rigs) - 1, 6).astype(int)] if rigs else []
    tiles = [
        cv2.resize(draw_boxes(big(v), _big(v.camera), passes.second, 2 * max_distance), None, fx=1, fy=1) for v in picks
    ]
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % 2)
    sheet = np.vstack([np.hstack(tiles[k : k + 2]) for k in range(0, len(tiles), 2)])
    cv2.imwrite(str(folder / f"{scene.name.replace(' ', '_')}.png"), sheet[:, :, ::-1])


def big(view: View) -> np.ndarray:
    return cv2.resize(view.picture.rgb, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR)


def _big(camera: Camera) -> Camera:
    k = camera.intrinsics
    return Camera(type(k)(2 * k.width, 2 * k.height, 2 * k.fx, 2 * k.fy, 2 * k.cx, 2 * k.cy), camera.T_world_camera)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=sorted(MAKERS))
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--pictures", type=Path)
    arguments = parser.parse_args()
    settings = Settings()
    print(HEADER)
    for name in arguments.scenes:
        scene = MAKERS[arguments.kind](name, settings)
        passes = run(scene, settings)
        report(scene, passes, settings)
        if arguments.pictures:
            write_pictures(arguments.pictures, scene, passes, settings.targets.near_distance)


if __name__ == "__main__":
    main()
