"""What it costs to keep what was rendered: codecs of colour and depth, and the frames stage against bare rendering.

    python benchmarks/filming.py WORLD.spz ... [--size 640x480] [--frames 40] [--threads 0]

Worlds as in rendering.py; without any, a generated one. The camera turns slowly on a small circle. Figures are of the
whole process's CPU time, because some encoders have threads of their own; stage and rendering also in wall time.
"""

import argparse
import importlib.metadata
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import cv2
import imagecodecs
import numpy as np
from rendering import generated_world
from scipy.spatial.transform import Rotation

from flymirage_core.rendering.camera import Intrinsics
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.frames import LEVEL_CAMERA, BodyPath, CameraRig, cameras_along
from flymirage_core.rendering.rasterizer import Rendering
from flymirage_core.rendering.recording import record_frames
from flymirage_core.rendering.video import yuv420p
from flymirage_core.rendering.views import depth_to_millimetres
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.imports import import_world

FFV1 = {"level": "3", "coder": "1", "context": "0", "slices": "4", "slicecrc": "1"}
HEVC = {"preset": "ultrafast", "x265-params": "log-level=none:pools=none:frame-threads=1"}
NEAR, FAR = 0.05, 20.0
"""Metres between which 12 bits are spread, evenly in the logarithm."""
ROUNDS = 4


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", nargs="*", type=Path)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--threads", type=int, default=0, help="of the renderer; 0 = all cores")
    chosen = parser.parse_args()
    width, height = map(int, chosen.size.split("x"))
    body = tuple(tuple(row) for row in np.block([[LEVEL_CAMERA, np.zeros((3, 1))], [np.zeros((1, 3)), 1]]).tolist())
    rig = CameraRig(Intrinsics.from_horizontal_fov(width, height, np.radians(80)), body, 10.0)
    print(f"PyAV {av.__version__}, OpenCV {importlib.metadata.version('opencv-python-headless')}, {chosen.size}")
    for name, cloud, centre in worlds(chosen.worlds):
        path = small_circle(centre, chosen.frames)
        pictures = list(CpuRasterizer().render(cloud, cameras_along(path, rig)))
        invalid = np.mean([picture.depth == 0 for picture in pictures])
        print(f"\n{name}: {len(cloud)} Gaussians, {invalid:.1%} of the depth is no return")
        compare_codecs(pictures)
        compare_stage(cloud, path, rig, chosen.threads)


def worlds(paths: Sequence[Path]) -> Iterator[tuple[str, GaussianCloud, np.ndarray]]:
    for path in paths:
        world = import_world(path, "auto", None, CleaningSettings())
        yield path.stem, world.cloud, world.centre
    if not paths:
        world = generated_world()
        yield "generated", world.cloud, world.centre


def small_circle(centre: np.ndarray, count: int) -> BodyPath:
    angles = np.arange(count) * np.radians(3)  # 30 degrees a second
    positions = centre + 0.3 * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    return BodyPath(0, np.arange(count) / 10, positions, Rotation.from_rotvec(np.outer(angles, [0, 0, 1])).as_quat())


def compare_codecs(pictures: list[Rendering]) -> None:
    colours, depths = [p.rgb for p in pictures], [depth_to_millimetres(p.depth) for p in pictures]
    print(f"  {'colour':<34}{'kB':>8}{'CPU ms':>8}{'PSNR dB':>9}")
    for name, options in (
        ("H.264 crf 18 veryfast fastdecode", {"crf": "18", "preset": "veryfast", "tune": "fastdecode"}),
        ("H.264 crf 18 superfast", {"crf": "18", "preset": "superfast"}),
        ("H.264 crf 18 ultrafast", {"crf": "18", "preset": "ultrafast"}),
        ("H.264 qp 18 ultrafast", {"qp": "18", "preset": "ultrafast"}),
    ):
        size, cost, back = encoded(map(yuv420p, colours), "libx264", "yuv420p", options, "mp4")
        pairs = zip(colours, (cv2.cvtColor(b, cv2.COLOR_YUV2RGB_I420) for b in back), strict=True)
        noise = np.mean([np.mean((a.astype(float) - b) ** 2) for a, b in pairs])
        print(f"  {name:<34}{size:>8.1f}{cost:>8.1f}{10 * np.log10(255**2 / noise):>9.1f}")
    print(f"  {'depth':<34}{'kB':>8}{'CPU ms':>8}{'median':>9}{'p99':>7}{'max mm':>8}")
    codecs: list[tuple[str, Callable[[], tuple[float, float, list[np.ndarray]]]]] = [
        ("FFV1 16 bit", lambda: encoded(depths, "ffv1", "gray16le", FFV1, "mkv")),
        ("HuffYUV 16 bit (ffvhuff)", lambda: encoded(depths, "ffvhuff", "gray16le", {"pred": "median"}, "nut")),
        ("JPEG-LS 16 bit", lambda: encoded(depths, "jpegls", "gray16le", {}, "nut")),
        *(
            (f"JPEG XL 16 bit, effort {effort}", lambda effort=effort: as_jpeg_xl(depths, effort))
            for effort in (1, 2, 3)
        ),
        *((f"PNG 16 bit, zlib {level}", lambda level=level: as_png(depths, level)) for level in (1, 3, 6)),
        ("HEVC 12 bit, lossless", lambda: as_hevc(depths, "lossless=1")),
        ("HEVC 12 bit, crf 0", lambda: as_hevc(depths, "crf=0")),
        ("HEVC 12 bit, crf 8", lambda: as_hevc(depths, "crf=8")),
    ]
    for name, encode in codecs:
        size, cost, back = encode()
        error = np.concatenate([np.abs(a.astype(int) - b)[a > 0] for a, b in zip(depths, back, strict=True)])
        p99 = np.quantile(error, 0.99)
        print(f"  {name:<34}{size:>8.1f}{cost:>8.1f}{np.median(error):>9.0f}{p99:>7.0f}{error.max():>8.0f}")


def encoded(
    frames: Any, codec: str, pixel_format: str, options: dict[str, str], container: str
) -> tuple[float, float, list[np.ndarray]]:
    """kB and CPU ms a frame, and the frames decoded."""
    with tempfile.TemporaryDirectory() as folder:
        path, count, start = Path(folder) / f"video.{container}", 0, time.process_time()
        with av.open(str(path), "w") as output:
            stream: Any = output.add_stream(codec, rate=10, options=options)
            stream.codec_context.gop_size, stream.codec_context.max_b_frames = 2, 0
            stream.codec_context.thread_count = 1
            for count, frame in enumerate(frames, start=1):
                picture = av.VideoFrame.from_ndarray(frame, format=pixel_format)
                if count == 1:
                    stream.width, stream.height, stream.pix_fmt = picture.width, picture.height, pixel_format
                picture.pts, picture.time_base = count - 1, Fraction(1, 10)
                output.mux(stream.encode(picture))
            output.mux(stream.encode(None))
        cost = (time.process_time() - start) * 1000 / count
        with av.open(str(path)) as video:
            back = [frame.to_ndarray(format=pixel_format) for frame in video.decode(video=0)]
        return path.stat().st_size / 1000 / count, cost, back


def as_jpeg_xl(depths: list[np.ndarray], effort: int) -> tuple[float, float, list[np.ndarray]]:
    start = time.process_time()
    files = [imagecodecs.jpegxl_encode(depth, lossless=True, effort=effort, numthreads=1) for depth in depths]
    cost = (time.process_time() - start) * 1000 / len(depths)
    return sum(map(len, files)) / 1000 / len(files), cost, [imagecodecs.jpegxl_decode(file) for file in files]


def as_png(depths: list[np.ndarray], level: int) -> tuple[float, float, list[np.ndarray]]:
    start = time.process_time()
    files = [cv2.imencode(".png", depth, [cv2.IMWRITE_PNG_COMPRESSION, level])[1] for depth in depths]
    cost = (time.process_time() - start) * 1000 / len(depths)
    return sum(map(len, files)) / 1000 / len(files), cost, [cv2.imdecode(f, cv2.IMREAD_UNCHANGED) for f in files]


def as_hevc(depths: list[np.ndarray], rate: str) -> tuple[float, float, list[np.ndarray]]:
    span = np.log(FAR / NEAR)
    table = np.rint(1 + 4094 * np.log(np.clip(np.arange(65536) / 1000, NEAR, FAR) / NEAR) / span).astype(np.uint16)
    table[0] = 0
    options = {**HEVC, "x265-params": f"{HEVC['x265-params']}:{rate}"}
    size, cost, back = encoded((table[d] for d in depths), "libx265", "gray12le", options, "mp4")
    metres = NEAR * np.exp((np.arange(4096) - 1) / 4094 * span)
    metres[0] = 0
    return size, cost, [np.rint(metres[b] * 1000).astype(int) for b in back]


def compare_stage(cloud: GaussianCloud, path: BodyPath, rig: CameraRig, threads: int) -> None:
    """Bare rendering and the whole stage in turns; the best of each."""
    rasterizer = CpuRasterizer(threads)
    cameras = cameras_along(path, rig)
    times = np.empty((ROUNDS, 2, 2))  # round, bare or stage, wall or CPU
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(ROUNDS):
            for kind, run in enumerate(
                (
                    lambda: list(map(id, rasterizer.render(cloud, cameras))),
                    lambda: record_frames(cloud, [path], rig, rasterizer, Path(folder)),
                )
            ):
                wall, cpu = time.perf_counter(), time.process_time()
                run()
                times[turn, kind] = time.perf_counter() - wall, time.process_time() - cpu
    (bare_wall, bare_cpu), (wall, cpu) = times.min(axis=0) * 1000 / len(cameras)
    print(
        f"  bare rendering {bare_wall:.1f} ms wall, {bare_cpu:.1f} ms CPU; stage {wall:.1f} ms wall, {cpu:.1f} ms CPU"
    )
    print(f"  the stage runs at {bare_wall / wall:.0%} of bare rendering on {rasterizer.threads} threads", end="")
    print(f" (by CPU time {bare_cpu / cpu:.0%})")


if __name__ == "__main__":
    main()
