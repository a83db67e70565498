"""CPU milliseconds a frame of the CPU rasterizer, on one core, beside another renderer's in the same run.

    python benchmarks/rendering.py [WORLD.spz ...] [--size 640x480 ...] [--prototype splat_cpu.py]
    python benchmarks/rendering.py --cold            seconds of the first picture: compiling, and from the cache
    python benchmarks/rendering.py --memory 3000000 3  peak memory of a process that renders so many, SH degree 3

Worlds are taken as they are in their files, with OpenCV axes and a free origin, as captured rooms and Marble's have;
after them come a generated world and a synthetic room of a million. Each pose is timed three times with both renderers
in turn; the best counts.
"""

import argparse
import importlib.util
import itertools
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
from scipy.spatial.transform import Rotation

from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.cpu import CpuRasterizer, Scratch, SplatTable, rasterize
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import GenerationSettings
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import read_cloud
from flymirage_core.splats.world import World
from flymirage_core.worldgen.model import OfflineWorldModel

REPEATS = 3
FIELD_OF_VIEW = np.radians(90)
SPREAD = 0.6
"""Metres round the origin within which the poses lie."""

Renderer = Callable[[Camera], object]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", nargs="*", type=Path)
    parser.add_argument("--size", nargs="+", default=["320x240", "640x480", "960x720"])
    parser.add_argument("--poses", type=int, default=8)
    parser.add_argument("--gaussians", type=int, default=1_000_000, help="of the synthetic room")
    parser.add_argument("--cold", action="store_true")
    parser.add_argument("--memory", type=int, nargs=2, metavar=("GAUSSIANS", "DEGREE"))
    parser.add_argument("--prototype", type=Path, help="a module with Scene, Workspace and render, to compare with")
    chosen = parser.parse_args()
    if chosen.cold:
        first_picture_times()
    elif chosen.memory:
        peak_memory(*chosen.memory)
    else:
        compare(chosen)


def compare(chosen: argparse.Namespace) -> None:
    """The table: each world at each size."""
    prototype = loaded(chosen.prototype) if chosen.prototype else None
    print(f"{'world':<24}{'Gaussians':>10}{'size':>10}{'ours':>9}{'max':>8}{'proto':>9}{'ratio':>7}{'2 threads':>11}")
    for name, cloud in worlds(chosen.worlds, chosen.gaussians):
        ours, other = our_renderer(cloud), prototype_renderer(prototype, cloud) if prototype else None
        for size in chosen.size:
            cameras = poses(*map(int, size.split("x")), chosen.poses)
            mine, theirs = best_times([ours, other] if other else [ours], cameras)
            other_columns = f"{theirs.mean():9.1f}{mine.mean() / theirs.mean():7.2f}" if other else f"{'':16}"
            row = f"{name:<24}{len(cloud):>10}{size:>10}{mine.mean():9.1f}{mine.max():8.1f}{other_columns}"
            print(f"{row}{speed_up(cloud, cameras):10.2f}x", flush=True)
    print(
        f"CPU ms a frame, one core, best of {REPEATS}, mean and maximum of {chosen.poses} poses; 2 threads: wall time"
    )


def worlds(paths: list[Path], gaussians: int) -> Iterator[tuple[str, GaussianCloud]]:
    for path in paths:
        yield path.stem, read_cloud(path)
    world = generated_world()
    turn = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # z up to OpenCV's y down, as captured rooms have it
    means = ((world.cloud.means - world.centre) @ turn.T).astype(np.float32)
    turned = Rotation.from_matrix(turn) * Rotation.from_quat(world.cloud.quaternions)
    yield "generated", replace(world.cloud, means=means, quaternions=turned.as_quat().astype(np.float32))
    yield "synthetic room", synthetic_room(gaussians)


def generated_world() -> World:
    """What the embedded world model makes of one description."""
    description = OfflineSceneWriter().describe("benchmark")
    return OfflineWorldModel(GenerationSettings()).build(description)


def synthetic_room(count: int, coefficients: int = 16) -> GaussianCloud:
    """Plates on the walls of a room of 8 x 3 x 6 m and on 14 boxes in it, free round the origin; SH degree 3."""
    rng = np.random.default_rng(0)
    low, high = [np.array([-4.0, -1.4, -3.0])], [np.array([4.0, 1.6, 3.0])]
    for angle in np.arange(14) / 14 * 2 * np.pi:
        centre = np.array([3.2 * np.cos(angle), 1.2, 2.3 * np.sin(angle)])
        half = rng.uniform(0.15, 0.5, 3)
        low.append(centre - half)
        high.append(centre + half)
    box = rng.choice(15, count, p=[0.5, *[0.5 / 14] * 14])
    axis = rng.integers(0, 3, count)
    points = rng.uniform(np.array(low)[box], np.array(high)[box])
    ends = np.where(rng.random(count) < 0.5, np.array(low)[box, axis], np.array(high)[box, axis])
    points[np.arange(count), axis] = ends
    scales = np.exp(rng.normal(np.log(0.012), 0.5, (count, 3)))
    scales[np.arange(count), axis] = 0.002
    sh = rng.standard_normal((count, coefficients, 3), np.float32)
    sh *= 0.1
    return GaussianCloud(
        points.astype(np.float32),
        np.tile(np.array([0, 0, 0, 1], np.float32), (count, 1)),
        scales.astype(np.float32),
        rng.beta(4, 1, count).astype(np.float32),
        sh,
    )


def poses(width: int, height: int, count: int) -> list[Camera]:
    """Level cameras near the origin, all round."""
    positions = np.random.default_rng(0).uniform(-SPREAD, SPREAD, (count, 3))
    cameras = []
    for angle, position in zip(np.arange(count) * 2 * np.pi / count, positions, strict=True):
        pose = np.eye(4)
        pose[:3, :3] = [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
        pose[:3, 3] = position
        cameras.append(Camera(Intrinsics.from_horizontal_fov(width, height, FIELD_OF_VIEW), pose))
    return cameras


def best_times(renderers: list[Renderer], cameras: list[Camera]) -> tuple[np.ndarray, np.ndarray]:
    """Best CPU milliseconds (P,) at each pose of the first and the last renderer, which take turns."""
    times = np.empty((REPEATS, len(renderers), len(cameras)))
    for renderer in renderers:
        renderer(cameras[0])  # compiles
    for repeat, (r, renderer), (c, camera) in itertools.product(
        range(REPEATS), enumerate(renderers), enumerate(cameras)
    ):
        start = time.thread_time()
        renderer(camera)
        times[repeat, r, c] = (time.thread_time() - start) * 1000
    best = times.min(axis=0)
    return best[0], best[-1]


def speed_up(cloud: GaussianCloud, cameras: list[Camera]) -> float:
    """Wall time of one thread over that of two; means something on two idle cores only."""
    walls = []
    for threads in (1, 2):
        rasterizer = CpuRasterizer(threads)
        for _ in rasterizer.render(cloud, cameras[:1]):
            pass  # prepares the cloud
        start = time.perf_counter()
        for _ in rasterizer.render(cloud, cameras * 2):
            pass
        walls.append(time.perf_counter() - start)
    return walls[0] / walls[1]


def first_picture_times() -> None:
    """Seconds from asking for the first picture to having it, in new processes: compiled, then from numba's cache."""
    code = (
        "import sys, time; sys.path.insert(0, sys.argv[1]); import rendering as b; c = b.synthetic_room(2);"
        "from flymirage_core.progress import listening\nstart, cpu = time.perf_counter(), time.process_time()\n"
        "with listening(lambda *report: print(' ', *report)): next(b.CpuRasterizer(1).render(c, b.poses(64, 48, 1)))\n"
        "print(f'{time.perf_counter() - start:.1f} s wall, {time.process_time() - cpu:.1f} s CPU')"
    )
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        for state in ("cold", "from the cache"):
            print(state, flush=True)
            here = str(Path(__file__).parent)
            subprocess.run([sys.executable, "-c", code, here], env=environment, check=True)


def peak_memory(count: int, degree: int) -> None:
    """Most memory that this process held while it made and rendered a synthetic room, on two threads."""
    cloud = synthetic_room(count, (degree + 1) ** 2)
    made = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    for _ in CpuRasterizer(2).render(cloud, poses(640, 480, 8)):
        pass
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"{count} Gaussians, SH {degree}: {made:.2f} GiB when made, {peak:.2f} GiB after 640x480 on two threads")


def our_renderer(cloud: GaussianCloud) -> Renderer:
    table = SplatTable.of(cloud)
    scratch = Scratch.for_table(table)
    return lambda camera: rasterize(table, camera, scratch)


def prototype_renderer(module: ModuleType, cloud: GaussianCloud) -> Renderer:
    wxyz = cloud.quaternions[:, [3, 0, 1, 2]]
    scene = module.Scene(cloud.means, wxyz, cloud.scales, cloud.opacities, cloud.sh)
    workspace = module.Workspace(scene)

    def render(camera: Camera) -> object:
        k = camera.intrinsics
        return module.render(scene, workspace, camera.T_camera_world, k.matrix, k.width, k.height)

    return render


def loaded(path: Path) -> ModuleType:
    """The module in a file, under its own name, as numba's cache on disk wants it."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise SystemExit(f"{path} is no Python module")
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    main()
