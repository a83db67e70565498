"""How right the boxes are: recall, precision, centre error, nouns, colours, CPU seconds. Truth is for scoring only.

    python benchmarks/annotation.py worlds --results FILE [--count 20] [--prototype lift_boxes.py]   # ANNOTATION.md
    python benchmarks/annotation.py generated demo-1 demo-2    # worlds of the embedded world model, by scene key
    python benchmarks/annotation.py analytic 11 12 13          # exact RGB-D of rooms made of boxes, by seed
    python benchmarks/annotation.py captured ROOM.spz ...      # no truth: boxes drawn into views, to be looked at

``--pictures FOLDER`` writes overlays, ``--detector FILE`` gives YOLOX-Nano's weights. Pass 1 is the orbit at all
distances; pass 2 adds the exploration, cut at d_th1. ``worlds`` appends a line a world to FILE and skips those in it.
"""

import argparse
import importlib.util
import json
import math
import multiprocessing
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from annotation_colours import colour_of_paint, colours_of_surface, share_called
from annotation_table import table
from scipy.optimize import linear_sum_assignment

from flymirage_core.annotation.annotator import Annotator
from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.exploration import exploration_paths, explore
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.labels import UNKNOWN
from flymirage_core.annotation.targets import select_targets
from flymirage_core.annotation.yolox import YoloxDetector
from flymirage_core.language.looks import coloured
from flymirage_core.language.scene_relations import Truth
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.pictures.box_overlay import draw_boxes
from flymirage_core.pictures.floor_plan import FloorPlan
from flymirage_core.pictures.target_selection import draw_target_selection
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.placements import orbit, view_intrinsics
from flymirage_core.rendering.views import PosedViews, View
from flymirage_core.settings import Settings
from flymirage_core.splats.cloud import GaussianCloud

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "annotation"))

MIN_TRUE_SIZE = 0.2  # metres: smaller true objects are not counted as missed
PIXEL_STEP = 4  # every fourth pixel, both ways, is looked at
MIN_COLOUR_SHARE = 1 / 3
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
    category: str = ""
    surface_colours: Callable[[Any], Counter[str]] = lambda thing: Counter()  # of a true object: `colours_of_surface`


@dataclass(frozen=True)
class Seen:
    """The views of both passes, and what the first gave."""

    first: BoxMap
    orbit_views: list[View]
    all_views: list[View]
    seconds: float  # CPU of the first pass's annotation


def see_both_passes(scene: Scene, annotator: Annotator, settings: Settings) -> Seen:
    cameras, _ = orbit(scene.centre, settings.views)
    orbit_views = scene.see(cameras)
    started = time.process_time()
    first = annotator.annotate(orbit_views, math.inf)
    seconds = time.process_time() - started
    targets = select_targets(first, scene.centre, settings.targets)
    rigs, _ = explore(scene.grid, scene.centre, targets, settings.exploration, view_intrinsics(settings.views))
    return Seen(first, orbit_views, orbit_views + scene.see(rigs), seconds)


@dataclass(frozen=True)
class Score:
    """Matches of boxes with the truth at one IoU."""

    pairs: list[tuple[int, int, float]]  # truth, box, IoU
    recall: float
    precision: float
    judged: int  # boxes that are right or wrong
    centre_error: float  # metres


def score_boxes(boxes: Sequence[Any], truth: Sequence[Any], min_iou: float) -> list[tuple[int, int, float]]:
    """One-to-one matches (truth, box, IoU) of the largest summed IoU."""
    ious = np.array([[yaw_iou(t, b) for b in boxes] for t in truth]).reshape(len(truth), len(boxes))
    rows, columns = linear_sum_assignment(-np.where(ious >= min_iou, ious, 0))
    return [(int(t), int(b), float(ious[t, b])) for t, b in zip(rows, columns, strict=True) if ious[t, b] >= min_iou]


def score(boxes: Sequence[Any], scene: Scene, counted: Sequence[bool], min_iou: float) -> Score:
    """True objects that are not ``counted``, and boxes at doors and windows, neither help nor harm."""
    pairs = score_boxes(boxes, scene.truth, min_iou)
    hits = sum(counted[t] for t, _, _ in pairs)
    matched = {b for _, b, _ in pairs}
    spare = sum(not counted[t] for t, _, _ in pairs)
    spare += sum(in_opening(box, scene.openings) for b, box in enumerate(boxes) if b not in matched)
    errors = [np.linalg.norm(np.subtract(scene.truth[t].centre, boxes[b].centre)) for t, b, _ in pairs]
    return Score(
        pairs,
        hits / max(sum(counted), 1),
        hits / max(len(boxes) - spare, 1),
        len(boxes) - spare,
        float(np.mean(errors)) if errors else math.nan,
    )


def in_opening(box: Any, openings: Sequence[np.ndarray]) -> bool:
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
    pixels *= PIXEL_STEP**2
    return [bool(max(box.size) >= MIN_TRUE_SIZE and n >= MIN_TRUE_PIXELS) for box, n in zip(truth, pixels, strict=True)]


def _near_points(view: View, max_distance: float) -> np.ndarray:
    k, depth = view.camera.intrinsics, view.picture.depth
    depth = depth[::PIXEL_STEP, ::PIXEL_STEP]
    u, v = np.meshgrid(np.arange(0, k.width, PIXEL_STEP) + 0.5, np.arange(0, k.height, PIXEL_STEP) + 0.5)
    rays = np.stack([(u - k.cx) / k.fx, (v - k.cy) / k.fy, np.ones_like(u)], axis=-1)
    near = (depth > 0) & (depth * np.linalg.norm(rays, axis=-1) < max_distance)
    return (rays * depth[..., None])[near] @ view.camera.T_world_camera[:3, :3].T + view.camera.position


def splat_scene(name: str, cloud: GaussianCloud, centre: np.ndarray, settings: Settings, **known: Any) -> Scene:
    rasterizer = CpuRasterizer(settings.threads)
    grid = occupancy_from_splats(cloud, centre, settings.occupancy)

    def see(cameras: Sequence[Camera]) -> list[View]:
        return [View(c, p) for c, p in zip(cameras, rasterizer.render(cloud, cameras), strict=True)]

    return Scene(name, see, grid, centre, **({"truth": ()} | known))


def generated(key: str, settings: Settings) -> Scene:
    from flymirage_core.scene.writer import OfflineSceneWriter

    return described(OfflineSceneWriter().describe(key), settings)


def described(description: Any, settings: Settings) -> Scene:
    """The generated world of a scene description."""
    from flymirage_core.worldgen.assembly import build_truth
    from flymirage_core.worldgen.model import OfflineWorldModel

    world = OfflineWorldModel(settings.generation).build(description)
    truth = build_truth(description)
    known = {
        "truth": truth.objects,
        "openings": [np.array(opening) for opening in truth.openings],
        "category": f"{description.category} / {description.subcategory}",
        "surface_colours": lambda thing: colours_of_surface(thing, description.scene),
    }
    return splat_scene(description.scene, world.cloud, world.centre, settings, **known)


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


def measured(scene: Scene, seen: Seen, second: BoxMap, settings: Settings) -> dict[str, Any]:
    """All figures of one world."""
    counted = countable(scene.truth, seen.all_views, settings.targets.near_distance)
    row: dict[str, Any] = {"true": sum(counted), "views": len(seen.all_views), "boxes": len(second)}
    for name, boxes in (("1", seen.first), ("2", second)):
        loose, strict = (score(boxes.boxes, scene, counted, iou) for iou in (0.25, 0.5))
        row |= {f"R25_{name}": loose.recall, f"P25_{name}": loose.precision, f"cm_{name}": 100 * loose.centre_error}
        row[f"judged_{name}"] = loose.judged
        row |= {f"R50_{name}": strict.recall, f"P50_{name}": strict.precision}
    pairs = [(scene.truth[t], second.boxes[b]) for t, b, _ in score_boxes(second.boxes, scene.truth, 0.25)]
    return row | names_and_colours([(t, b) for t, b in pairs if hasattr(t, "noun")], scene.surface_colours)


def names_and_colours(
    pairs: Sequence[tuple[Any, Any]], surface_colours: Callable[[Any], Counter[str]]
) -> dict[str, int]:
    """Counts over matched (true object, box) pairs; a family's name is the last word of the true noun.

    ``colour``: the seen word may be used for `MIN_COLOUR_SHARE` of what is seen of the thing; ``paint``: it may be used
    for the paint that the generator names.
    """
    right = sum(b.label == t.noun for t, b in pairs)
    family = sum(b.label != t.noun and b.label == t.noun.split()[-1] for t, b in pairs)
    generic = sum(b.label == UNKNOWN for _, b in pairs)
    paint = sum(b.colour != "" and coloured(colour_of_paint(t.colour), b.colour) is not Truth.NO for t, b in pairs)
    colour = sum(share_called(b.colour, surface_colours(t)) >= MIN_COLOUR_SHARE for t, b in pairs)
    counts = {"matched": len(pairs), "noun": right, "family": family, "generic": generic}
    return counts | {"colour": colour, "paint": paint}


def prototype_figures(path: Path, scene: Scene, seen: Seen, settings: Settings) -> dict[str, float]:
    """CPU seconds, recall and precision of the prototype's second pass on the same views."""
    specification = importlib.util.spec_from_file_location("prototype", path)
    assert specification is not None and specification.loader is not None
    prototype = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(prototype)
    frames = [(v.picture.rgb, v.picture.depth, v.camera.T_world_camera) for v in seen.all_views]
    intrinsics = seen.all_views[0].camera.intrinsics.matrix
    distance = settings.targets.near_distance
    started = time.process_time()
    answer = prototype.annotate(frames, intrinsics, distance)
    seconds = time.process_time() - started
    rows = answer[0] if isinstance(answer, tuple) else answer
    boxes = [PlainBox(tuple(map(float, b["c"])), tuple(map(float, b["s"])), float(b["yaw"])) for b in rows]
    loose = score(boxes, scene, countable(scene.truth, seen.all_views, distance), 0.25)
    return {"prototype_s": seconds, "prototype_R25": loose.recall, "prototype_P25": loose.precision}


@dataclass(frozen=True)
class PlainBox:
    centre: tuple[float, ...]
    size: tuple[float, ...]
    yaw: float


def world_keys(count: int) -> list[str]:
    """Keys of ``count`` worlds that nothing was tuned on, spread evenly over the taxonomy's categories."""
    from flymirage_core.scene.taxonomy import standard_taxonomy

    taxonomy = standard_taxonomy()
    wanted = -(-count // len(taxonomy.categories))
    seen: dict[str, int] = {}
    keys: list[str] = []
    number = 0
    while len(keys) < count:
        number += 1
        category, _ = taxonomy.pick(f"bench-{number}")
        if seen.get(category, 0) < wanted:
            seen[category] = seen.get(category, 0) + 1
            keys.append(f"bench-{number}")
    return keys


def measure_worlds(arguments: argparse.Namespace, annotator: Annotator, settings: Settings) -> None:
    done = {json.loads(line)["world"] for line in arguments.results.read_text().splitlines()}
    for key in world_keys(arguments.count):
        if key in done:
            continue
        scene = generated(key, settings)
        seen = see_both_passes(scene, annotator, settings)
        second, seconds, megabytes = annotated_apart(seen.all_views, annotator, settings)
        row = {"world": key, "category": scene.category, "s_1": seen.seconds, "s_2": seconds, "MB": megabytes}
        row |= measured(scene, seen, second, settings)
        if arguments.prototype:
            row |= prototype_figures(arguments.prototype, scene, seen, settings)
        with arguments.results.open("a") as file:
            file.write(json.dumps(row) + "\n")
        print(key, {k: round(v, 2) if isinstance(v, float) else v for k, v in row.items()}, flush=True)


def annotated_apart(views: Sequence[View], annotator: Annotator, settings: Settings) -> tuple[BoxMap, float, float]:
    """Second pass in a process of its own that reads the views as products are read; its CPU seconds and most MB."""
    with tempfile.TemporaryDirectory() as folder:
        cameras, pictures = [view.camera for view in views], [view.picture for view in views]
        PosedViews.write(Path(folder), cameras, pictures, [""] * len(views))
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            return pool.submit(_annotate_folder, Path(folder), annotator, settings).result()


def _annotate_folder(folder: Path, annotator: Annotator, settings: Settings) -> tuple[BoxMap, float, float]:
    started = time.process_time()
    boxes = annotator.annotate(PosedViews.load(folder), settings.targets.near_distance)
    status = (
        Path("/proc/self/status").read_text().split()
    )  # rusage would count what the parent held when it spawned this
    return boxes, time.process_time() - started, int(status[status.index("VmHWM:") + 1]) / 1000


def write_pictures(folder: Path, scene: Scene, seen: Seen, boxes: BoxMap, settings: Settings) -> None:
    """Boxes of pass 2 in six views of the orbit and in six of the exploration; and Algorithm 1 from above."""
    folder.mkdir(parents=True, exist_ok=True)
    views = seen.orbit_views
    picks = [views[k] for k in range(len(views) // 3, 2 * len(views) // 3, 2)]
    rigs = seen.all_views[len(views) :]
    picks += [rigs[k] for k in np.linspace(0, len(rigs) - 1, 6).astype(int)] if rigs else []
    tiles = [
        draw_boxes(_big_picture(v), _big_camera(v.camera), boxes, 2 * settings.targets.near_distance) for v in picks
    ]
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % 2)
    sheet = np.vstack([np.hstack(tiles[k : k + 2]) for k in range(0, len(tiles), 2)])
    stem = scene.name.replace(" ", "_")
    cv2.imwrite(str(folder / f"{stem}.png"), sheet[:, :, ::-1])
    targets = select_targets(seen.first, scene.centre, settings.targets)
    ways = exploration_paths(scene.grid, scene.centre, targets, settings.exploration)
    plan = FloorPlan.of(scene.grid, (max(0.3, scene.centre[2] - 0.8), scene.centre[2] + 0.6))
    drawing = draw_target_selection(
        plan, seen.first, targets.boxes, scene.centre, settings.targets, [way.positions for way in ways]
    )
    cv2.imwrite(str(folder / f"{stem}_algorithm_1.png"), drawing[:, :, ::-1])


def _big_picture(view: View) -> np.ndarray:
    return cv2.resize(view.picture.rgb, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR)


def _big_camera(camera: Camera) -> Camera:
    k = camera.intrinsics
    return Camera(type(k)(2 * k.width, 2 * k.height, 2 * k.fx, 2 * k.fy, 2 * k.cx, 2 * k.cy), camera.T_world_camera)


def show(arguments: argparse.Namespace, annotator: Annotator, settings: Settings) -> None:
    for name in arguments.scenes:
        scene = MAKERS[arguments.kind](name, settings)
        seen = see_both_passes(scene, annotator, settings)
        started = time.process_time()
        boxes = annotator.annotate(seen.all_views, settings.targets.near_distance)
        seconds = time.process_time() - started
        row = measured(scene, seen, boxes, settings) if scene.truth else {"boxes": len(boxes)}
        figures = " ".join(f"{k} {v:.2f}" if isinstance(v, float) else f"{k} {v}" for k, v in row.items())
        print(f"{scene.name}: {figures} CPU {seen.seconds:.1f} + {seconds:.1f} s", flush=True)
        if arguments.pictures:
            write_pictures(arguments.pictures, scene, seen, boxes, settings)
        if not scene.truth:
            for b in boxes:
                size = " x ".join(f"{s:.2f}" for s in b.size)
                print(
                    f"  {b.object_id:3} {b.label} ({b.label_source} {b.label_score:.2f}) {b.colour} {b.material} {size}"
                )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["worlds", *sorted(MAKERS)])
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--detector", type=Path)
    parser.add_argument("--results", type=Path)
    parser.add_argument("--prototype", type=Path)
    parser.add_argument("--count", type=int, default=20)
    arguments = parser.parse_args()
    settings = Settings()
    annotator = EmbeddedAnnotator(
        settings.annotation, YoloxDetector(arguments.detector) if arguments.detector else None
    )
    if arguments.kind != "worlds":
        show(arguments, annotator, settings)
        return
    arguments.results.touch()
    measure_worlds(arguments, annotator, settings)
    print(table([json.loads(line) for line in arguments.results.read_text().splitlines()]))


if __name__ == "__main__":
    main()
