"""How far the CPU renderer, and gsplat where a CUDA card is, are from the float64 oracle of the tests.

    python benchmarks/exactness.py [WORLD.spz ...]

Clouds of 20,000 Gaussians with SH degree 0 to 3, seen from outside and from amid them (behind, on and around the near
plane; huge ones, plates and needles), then worlds from their files' origin. Colours are compared before rounding.
"""

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.cpu import CpuRasterizer, FloatPicture
from flymirage_core.rendering.gsplat_backend import GsplatRasterizer, why_unusable
from flymirage_core.rendering.rasterizer import Rendering
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import read_cloud

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "rendering"))
from clouds import camera, random_cloud
from oracle import splat


def main() -> None:
    print(f"{'scene':<28}{'PSNR dB':>9}{'max':>9}{'> 1e-3':>8}{'<= 2/255':>10}{'depth p99.9 mm':>16}{'oracle s':>10}")
    for name, cloud, view in scenes([Path(argument) for argument in sys.argv[1:]]):
        start = time.process_time()
        truth = splat(cloud, view)
        seconds = time.process_time() - start
        print(
            f"{name:<28}{line(next(CpuRasterizer(1).render_float(cloud, [view])), truth)}{seconds:>10.1f}", flush=True
        )
        if not why_unusable():
            print(f"{'  gsplat, rounded to 8 bits':<28}{line(next(GsplatRasterizer().render(cloud, [view])), truth)}")
    if why_unusable():
        print(f"gsplat was not run: {why_unusable()}")


def scenes(worlds: list[Path]) -> Iterator[tuple[str, GaussianCloud, Camera]]:
    for degree in range(4):
        cloud = random_cloud(degree, 20_000, degree)
        yield f"outside, SH {degree}", cloud, camera([-4, -6, 2], [0.5, 1, -0.3], 320, 240)
        yield f"amid, SH {degree}", cloud, camera([0.2, -0.1, 0.3], [1, 0.2, -0.1], 320, 240)
    for path in worlds:
        yield path.stem, read_cloud(path), Camera(Intrinsics.from_horizontal_fov(640, 480, 1.4), np.eye(4))


def line(found: FloatPicture | Rendering, truth: tuple[np.ndarray, np.ndarray, np.ndarray]) -> str:
    """PSNR, greatest error, share beyond 1e-3 and within 2/255 of the colours; depth's p99.9 where alpha > 0.5."""
    rgb, depth, alpha = truth
    rgb = np.clip(rgb, 0, 1)
    colours = found.rgb / 255 if found.rgb.dtype == np.uint8 else np.clip(found.rgb, 0, 1)
    error = np.abs(colours - rgb)
    psnr = -10 * np.log10(np.mean(error**2))
    pixels = error.max(axis=2)
    solid = (alpha > 0.5) & (found.alpha >= 0.5)
    depth_error = np.quantile(np.abs(found.depth - depth)[solid], 0.999) * 1000
    within = np.mean(pixels <= 2 / 255)
    return f"{psnr:>9.1f}{pixels.max():>9.5f}{np.mean(pixels > 1e-3):>8.3%}{within:>10.3%}{depth_error:>16.3f}"


if __name__ == "__main__":
    main()
