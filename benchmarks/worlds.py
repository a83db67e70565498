"""Generated worlds, measured: splats against the ray-traced mesh, cost, content, and whether they can be flown in.

    python benchmarks/worlds.py [--scenes 30] [--results data/worlds] [--sheet docs/worlds.jpg] [--no-flights]

Scenes are drawn from all categories in turn. For each: PSNR and SSIM of an unseen drone view (the middle 480 x 360 of
640 x 480 pixels) against the mesh
ray-traced with the same materials and light, 2 x 2 samples a pixel; holes (alpha < 0.5) of all views; CPU seconds and
peak memory; splats, instances, labels; flights planned and flown, not filmed, on the grid of the splats and the boxes
of the truth, so that annotation has no part in the figures: with the paper's N_s = 20 sets, and with `MORE_SETS`.

Each scene's figures (JSON) and pictures (PNG) are written to the results folder as soon as they are there; a run that
finds a scene there does not make it again.
"""

import argparse
import json
import resource
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import cv2
import numpy as np

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.navigation.fly import fly_task_sets
from flymirage_core.navigation.task_sets import generate_task_sets
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.taxonomy import standard_taxonomy
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import GenerationSettings, Settings
from flymirage_core.worldgen.assembly import Assembly, assemble
from flymirage_core.worldgen.fitting import fitted
from flymirage_core.worldgen.reference import ReferenceTracer
from flymirage_core.worldgen.sampling import LitWorld, lit_world
from flymirage_core.worldgen.truth import WorldTruth
from flymirage_core.worldgen.viewpoints import best_view

SETTINGS = Settings()
VIEWS = 3
SIZE, FOV_DEG = (640, 480), 80.0
MIDDLE = (480, 360)
"""Pixels of a view that are ray-traced for comparison: its middle, at full resolution."""
MORE_SETS = 26
"""Sets of tasks with which a scene of few or narrow ways still has 100 flights."""
REACH, BALL = 8.0, 0.45
"""Drone views stand within REACH metres of c, with BALL metres free round them."""
THUMBNAIL = (192, 144)
HEADER = (
    f"{'scene':52} {'s':>5} {'MB':>5} {'splats':>7} {'PSNR':>5} {'SSIM':>6} {'holes %':>7} {'things':>6} "
    f"{'labels':>6} {'missed':>6} {'tasks':>5} {'flown':>5} {'more':>5}"
)


@dataclass
class Row:
    """One scene's figures."""

    name: str
    open_air: bool
    seconds: float
    megabytes: float
    splats: int
    psnr: list[float]
    ssim: list[float]
    holes: list[float]
    things: int
    labels: list[str]
    missed: int
    tasks: int | None = None  # None: not tried yet
    flown: int | None = None
    flown_of_more: int | None = None

    def line(self) -> str:
        return (
            f"{self.name[:52]:52} {self.seconds:5.1f} {self.megabytes:5.0f} "
            f"{self.splats:7} {mean(self.psnr):5.1f} {mean(self.ssim):6.3f} {100 * mean(self.holes):7.3f} "
            f"{self.things:6} {len(self.labels):6} {self.missed:6} "
            f"{self.tasks!s:>5} {self.flown!s:>5} {self.flown_of_more!s:>5}"
        )


def mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else float("nan")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=30)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--gaussians", type=int, default=SETTINGS.generation.gaussians)
    parser.add_argument("--results", type=Path, default=Path("data/worlds"))
    parser.add_argument("--sheet", type=Path)
    parser.add_argument("--flights", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--references", type=int, default=1, help="drone views a scene that are also ray-traced")
    options = parser.parse_args()
    options.results.mkdir(parents=True, exist_ok=True)
    print(HEADER, flush=True)
    rows, pictures = [], []
    for description in descriptions(options.first + options.scenes)[options.first :]:
        row, strip = once(description, options)
        print(row.line(), flush=True)
        rows.append(row)
        pictures.append(strip)
    if options.sheet:
        write_sheet(pictures, [row.name for row in rows], options.sheet)
    summarise(rows)


def once(description: SceneDescription, options: argparse.Namespace) -> tuple[Row, np.ndarray]:
    """A scene's figures and strip of pictures: what the results folder lacks of them is made and written there."""
    figures, picture = (options.results / f"{description.scene}.{kind}" for kind in ("json", "png"))
    made = None
    if not figures.exists():
        made = build(description, options.gaussians)
        row, strip = look_at(description, made, options.references)
        cv2.imwrite(str(picture), strip[:, :, ::-1])
        figures.write_text(json.dumps(asdict(row)))
    row = Row(**json.loads(figures.read_text()))
    if options.flights and row.tasks is None:
        made = made or build(description, options.gaussians)
        row.tasks, row.flown, row.flown_of_more = fly(made.world, made.assembly.truth)
        figures.write_text(json.dumps(asdict(row)))
    return row, cv2.imread(str(picture))[:, :, ::-1]


def descriptions(count: int) -> list[SceneDescription]:
    """Scenes from all categories in turn, as growth would balance them."""
    counts: dict[tuple[str, str], int] = {}
    result = []
    for number in range(count):
        description = OfflineSceneWriter(standard_taxonomy(), counts).describe(f"worlds-{number:03d}")
        place = (description.category, description.subcategory)
        counts[place] = counts.get(place, 0) + 1
        result.append(description)
    return result


@dataclass
class Made:
    """One scene, built, and what that took."""

    assembly: Assembly
    world: LitWorld
    seconds: float
    megabytes: float


def build(description: SceneDescription, gaussians: int) -> Made:
    began = time.process_time()
    assembly = assemble(description)
    world = lit_world(assembly, gaussians)
    settings = GenerationSettings(gaussians=gaussians)
    world = replace(world, cloud=fitted(world, assembly.truth, settings.views))
    seconds = time.process_time() - began
    return Made(assembly, world, seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


def look_at(description: SceneDescription, made: Made, references: int) -> tuple[Row, np.ndarray]:
    """A scene's figures but for its flights, and its picture and drone views side by side."""
    truth, world = made.assembly.truth, made.world
    cameras = drone_views(truth, np.random.default_rng(len(truth.objects)))
    views = list(CpuRasterizer().render(world.cloud, cameras))
    row = Row(
        f"{description.scene} {description.category}: {description.subcategory}",
        made.assembly.place.open_air,
        made.seconds,
        made.megabytes,
        len(world.cloud),
        *([], []),
        [float((v.alpha < 0.5).mean()) for v in views],
        len(truth.objects),
        sorted({f"{o.colour} {o.material} {o.noun}" for o in truth.objects}),
        sum(u.count for u in truth.unplaced),
    )
    compare(world, cameras[:references], views, row)
    picture = best_view(world.cloud, truth, CpuRasterizer())
    strip = [cv2.resize(picture, SIZE, interpolation=cv2.INTER_AREA), *(v.rgb for v in views)]
    return row, np.concatenate(strip, axis=1)


def drone_views(truth: WorldTruth, rng: np.random.Generator) -> list[Camera]:
    """Random free spots in the spaces near c, level to slightly downward."""
    intrinsics = Intrinsics.from_horizontal_fov(*SIZE, np.radians(FOV_DEG))
    offsets = BALL * np.array(np.meshgrid(*[[-1, 0, 1]] * 3)).reshape(3, -1).T
    cameras: list[Camera] = []
    while len(cameras) < VIEWS:
        space = truth.spaces[0]
        spot = rng.uniform(space.low, np.minimum(space.high, [99, 99, 3.0]))
        if spot[2] < 0.7 or np.hypot(*(spot - truth.centre)[:2]) > REACH or not truth.is_free(spot + offsets).all():
            continue
        yaw = rng.uniform(0, 2 * np.pi)
        if not truth.is_free(spot + 1.2 * np.array([np.cos(yaw), np.sin(yaw), 0.0]))[0]:
            continue  # a drone does not look at a wall before its nose
        cameras.append(Camera(intrinsics, look_along(spot, [np.cos(yaw), np.sin(yaw), rng.uniform(-0.35, 0.05)])))
    return cameras


def compare(world: LitWorld, cameras: list[Camera], views: list, row: Row) -> None:
    tracer = ReferenceTracer(world)
    (width, height), (u, v) = MIDDLE, (np.array(SIZE) - MIDDLE) // 2
    for camera, view in zip(cameras, views, strict=False):
        k = camera.intrinsics
        middle = Camera(Intrinsics(width, height, k.fx, k.fy, k.cx - u, k.cy - v), camera.T_world_camera)
        reference, seen = tracer.render(middle, 2), view.rgb[v : v + height, u : u + width] / 255.0
        row.psnr.append(float(-10 * np.log10(((reference - seen) ** 2).mean())))
        row.ssim.append(ssim(reference, seen))


def ssim(one: np.ndarray, other: np.ndarray) -> float:
    """Structural similarity of the grey pictures (Wang et al. 2004): Gaussian window of 11, sigma 1.5."""
    x, y = (a @ [0.299, 0.587, 0.114] for a in (one, other))

    def blur(a: np.ndarray) -> np.ndarray:
        return cv2.GaussianBlur(a, (11, 11), 1.5)

    mx, my = blur(x), blur(y)
    vx, vy, vxy = blur(x * x) - mx * mx, blur(y * y) - my * my, blur(x * y) - mx * my
    a, b = 0.01**2, 0.03**2
    return float((((2 * mx * my + a) * (2 * vxy + b)) / ((mx * mx + my * my + a) * (vx + vy + b))).mean())


def fly(world: LitWorld, truth: WorldTruth) -> tuple[int, int, int]:
    """(tasks, flights) with the paper's number of sets, and the flights with `MORE_SETS`, which begin with the same."""
    centre = np.array(truth.centre)
    grid = occupancy_from_splats(world.cloud, centre, SETTINGS.occupancy)
    boxes = BoxMap(
        tuple(
            ObjectBox(o.object_id, o.noun, o.centre, o.size, o.yaw, 1.0, "truth", o.colour, o.material, 1, 1.0, "truth")
            for o in truth.objects
        )
    )
    more = SETTINGS.tasks.model_copy(update={"sets": MORE_SETS})
    tasks = generate_task_sets(grid, boxes, centre, more, np.random.default_rng(1))
    generator = np.random.default_rng(2)
    flights = fly_task_sets(tasks, grid, boxes, SETTINGS.planner, SETTINGS.quadrotor, generator).flights
    paper = SETTINGS.tasks.sets
    return (
        sum(t.set_index < paper for t in tasks),
        sum(f.set_index < paper for f in flights),
        len(flights),
    )


def write_sheet(strips: list[np.ndarray], names: list[str], path: Path) -> None:
    """Two scenes a row, each its picture and three drone views, with its name."""
    cells = []
    for wide, name in zip(strips, names, strict=True):
        strip = cv2.resize(wide, (4 * THUMBNAIL[0], THUMBNAIL[1]), interpolation=cv2.INTER_AREA)
        title = np.full((18, strip.shape[1], 3), 255, np.uint8)
        cv2.putText(title, name, (4, 13), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (30, 30, 30), 1, cv2.LINE_AA)
        cells.append(np.concatenate([title, strip]))
    if len(cells) % 2:
        cells.append(np.full_like(cells[0], 255))
    sheet = np.concatenate([np.concatenate(cells[i : i + 2], axis=1) for i in range(0, len(cells), 2)])
    for quality in range(92, 20, -4):
        data = cv2.imencode(".jpg", sheet[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
        if len(data) <= 400_000:
            break
    path.write_bytes(data.tobytes())


def summarise(rows: list[Row]) -> None:
    def told(name: str, values: Sequence[float], form: str = "{:.2f}") -> None:
        if values:
            told = (form.format(f(values)) for f in (np.mean, np.median, min, max))
            print("{:26} mean {:>9}  median {:>9}  least {:>9}  most {:>9}".format(name, *told))

    print()
    for kind, of in (("indoors", [r for r in rows if not r.open_air]), ("open air", [r for r in rows if r.open_air])):
        told(f"PSNR {kind}, dB", [x for r in of for x in r.psnr])
        told(f"SSIM {kind}", [x for r in of for x in r.ssim], "{:.3f}")
    told("PSNR, dB", [x for r in rows for x in r.psnr])
    told("SSIM", [x for r in rows for x in r.ssim], "{:.3f}")
    told("holes, % of pixels", [100 * x for r in rows for x in r.holes], "{:.4f}")
    told("CPU seconds", [r.seconds for r in rows], "{:.1f}")
    told("peak MB of the process", [r.megabytes for r in rows], "{:.0f}")
    told("splats", [r.splats for r in rows], "{:.0f}")
    told("instances", [r.things for r in rows], "{:.0f}")
    told("not placed", [r.missed for r in rows], "{:.0f}")
    print(f"{'distinct labels in all':26} {len({label for r in rows for label in r.labels})}")
    for name, flown in (
        (f"N_s = {SETTINGS.tasks.sets}", [r.flown for r in rows if r.flown is not None]),
        (f"N_s = {MORE_SETS}", [r.flown_of_more for r in rows if r.flown_of_more is not None]),
    ):
        told(f"flights, {name}", flown, "{:.0f}")
        print(f"scenes with >= 100 flights, {name}: {sum(f >= 100 for f in flown)} of {len(flown)}")


if __name__ == "__main__":
    main()
