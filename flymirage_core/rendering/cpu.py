"""`CpuRasterizer`: Gaussians to RGB, expected depth and alpha on all cores. Its kernels are in `cpu_kernels`."""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass
from queue import SimpleQueue
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from flymirage_core.progress import current_listener
from flymirage_core.rendering import cpu_kernels as kernels
from flymirage_core.rendering import picture_kernels
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.rasterizer import MIN_ALPHA_FOR_DEPTH, Rasterizer, Rendering
from flymirage_core.rendering.threads import in_order, usable_cores
from flymirage_core.splats.cloud import GaussianCloud

Float32 = NDArray[np.float32]
P = TypeVar("P")

MAX_COORDINATE = 1e5
"""Metres. Gaussians farther from the world's origin are left out."""
MAX_SCALE = 1e3
"""Metres. Gaussians with a larger standard deviation are left out: their squares would overflow float32."""


CHUNK = 2**16
"""Gaussians whose coefficients are moved at once, so that a second copy of a large cloud is never held."""
COMPILING = "compiling the renderer (once)"
PATIENCE = 1.5
"""Seconds after which a person is told that kernels are being compiled; from numba's cache they come sooner."""


class CpuRasterizer(Rasterizer):
    """Renders whole frames side by side, one on each of ``threads`` threads (0 = all cores this process may use).

    The same cloud and camera give the same bytes whatever the number of threads. Gaussians that cannot be drawn (not
    finite, a zero quaternion, an opacity below 1/255, absurdly far or large) are left out.
    """

    name = "cpu"

    def __init__(self, threads: int = 0) -> None:
        self.threads = threads or usable_cores()
        self._prepared: tuple[GaussianCloud, SplatTable] | None = None

    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]:
        """Pictures in the cameras' order. At most ``threads + LOOK_AHEAD`` frames are held or in the making."""
        return self.develop(cloud, cameras, lambda _, picture: picture)

    def develop(
        self, cloud: GaussianCloud, cameras: Sequence[Camera], finish: Callable[[int, Rendering], P]
    ) -> Generator[P, None, None]:
        """As `Rasterizer.develop`, on the thread that rendered the picture, while its core's cache still holds it."""
        return self._frames(cloud, cameras, lambda number, picture: finish(number, picture.quantised()))

    def render_float(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator["FloatPicture"]:
        """As `render`, before rounding to 8 bits and before depth is struck out where alpha is small."""
        return self._frames(cloud, cameras, lambda _, picture: picture)

    def _frames(
        self, cloud: GaussianCloud, cameras: Iterable[Camera], finish: "Callable[[int, FloatPicture], P]"
    ) -> Generator[P, None, None]:
        compile_kernels()
        table = self._table(cloud)
        scratch: SimpleQueue[Scratch] = SimpleQueue()
        for _ in range(self.threads):
            scratch.put(Scratch.for_table(table))

        def frame(numbered: tuple[int, Camera]) -> P:
            number, camera = numbered
            mine = scratch.get()
            try:
                return finish(number, rasterize(table, camera, mine))
            finally:
                scratch.put(mine)

        yield from in_order(frame, enumerate(cameras), self.threads)

    def _table(self, cloud: GaussianCloud) -> "SplatTable":
        prepared = self._prepared
        if prepared is None or prepared[0] is not cloud:
            self._prepared = prepared = (cloud, SplatTable.of(cloud))
        return prepared[1]


@dataclass(frozen=True, eq=False)
class FloatPicture:
    """What the kernels make: linear in the Gaussians' colours, on black, not clipped above."""

    rgb: Float32  # (H, W, 3), 1 = full
    depth: Float32  # (H, W) metres, expected z-depth, also where hardly anything is
    alpha: Float32  # (H, W) in [0, 1]

    def quantised(self) -> Rendering:
        """Rounded and clipped to 8 bits; depth is 0 where alpha is below `MIN_ALPHA_FOR_DEPTH`."""
        rgb, depth = np.empty(self.rgb.shape, np.uint8), self.depth.copy()
        picture_kernels.quantise(
            self.rgb.ravel(), depth.ravel(), self.alpha.ravel(), MIN_ALPHA_FOR_DEPTH, rgb.reshape(-1)
        )
        return Rendering(rgb, depth, self.alpha)


@dataclass(frozen=True, eq=False)
class SplatTable:
    """A cloud made ready for the kernels: a structure of arrays in Morton order, culled in blocks of 256."""

    means: Float32  # (3, N) metres
    axes: Float32  # (9, N) the ellipsoid's three half axes (R S, column by column), metres
    log2_opacities: Float32  # (N,)
    file_indices: NDArray[np.uint32]  # (N,) place in the cloud, which breaks ties in depth
    blocks: Float32  # (N / 256, 4) centre and radius of a ball round the block's ellipsoids
    sh: Float32  # (3 K, N)

    @staticmethod
    def of(cloud: GaussianCloud) -> "SplatTable":
        """Sort a cloud's drawable Gaussians along a Morton curve. Takes about half a second for a million."""
        kept = np.flatnonzero(drawable(cloud))
        kept = kept[np.argsort(morton_codes(cloud.means[kept]), kind="stable")]
        means, scales = cloud.means[kept], np.abs(cloud.scales[kept])
        return SplatTable(
            np.ascontiguousarray(means.T),
            scaled_axes(cloud.quaternions[kept], scales),
            np.log2(np.minimum(cloud.opacities[kept], 1)),
            kept.astype(np.uint32),
            bounding_balls(means, np.float32(kernels.EXTENT) * scales.max(axis=1, initial=0)),
            _columns(cloud.sh, kept),
        )

    def arrays(self) -> kernels.Splats:
        return self.means, self.axes, self.log2_opacities, self.file_indices, self.blocks, self.sh


@dataclass(frozen=True, eq=False)
class Scratch:
    """Where a frame's visible Gaussians are written; one for each thread. Only touched pages cost memory."""

    records: Float32  # (N, 16)
    ids: NDArray[np.uint32]  # (N,)

    @staticmethod
    def for_table(table: SplatTable) -> "Scratch":
        n = len(table.file_indices)
        return Scratch(np.empty((n, kernels.RECORD), np.float32), np.empty(n, np.uint32))


def rasterize(table: SplatTable, camera: Camera, scratch: Scratch) -> FloatPicture:
    """One frame on the calling thread."""
    k = camera.intrinsics
    shape = (k.height, k.width)
    picture = FloatPicture(np.empty((*shape, 3), np.float32), np.empty(shape, np.float32), np.empty(shape, np.float32))
    kernels.render_frame(
        table.arrays(), packed(camera), scratch.records, scratch.ids, picture.rgb, picture.depth, picture.alpha
    )
    return picture


def packed(camera: Camera) -> NDArray[np.float64]:
    """The camera (18,) as the kernels read it: R_camera_world by rows, position, fx, fy, cx, cy, width, height."""
    k = camera.intrinsics
    rotation = camera.T_camera_world[:3, :3].ravel()
    return np.concatenate([rotation, camera.position, [k.fx, k.fy, k.cx, k.cy, k.width, k.height]]).astype(np.float64)


def compile_kernels() -> None:
    """Compile the kernels, or load them from numba's cache, before the first picture; tells the progress listener."""
    if kernels.compiled():
        return
    with ThreadPoolExecutor(1, "compiler") as pool:
        compiled = pool.submit(_first_picture)
        listener = current_listener()
        done, _ = wait([compiled], PATIENCE)
        if listener is not None and not done:
            listener(COMPILING, 0, 1)
            compiled.result()
            listener(COMPILING, 1, 1)
        compiled.result()


def _first_picture() -> None:
    """Renders one Gaussian, with arrays of the types that all clouds have."""
    point = GaussianCloud(*(np.ones((1, *shape), np.float32) for shape in ((3,), (4,), (3,), (), (1, 3))))
    table = SplatTable.of(point)
    rasterize(table, Camera(Intrinsics(8, 8, 8, 8, 4, 4), np.eye(4)), Scratch.for_table(table)).quantised()


def drawable(cloud: GaussianCloud) -> NDArray[np.bool_]:
    """Which Gaussians (N,) can be drawn at all; the kernels assume finite numbers."""
    with np.errstate(invalid="ignore"):
        usable: NDArray[np.bool_] = (
            (np.abs(cloud.means) <= MAX_COORDINATE).all(axis=1)
            & (np.abs(cloud.scales) <= MAX_SCALE).all(axis=1)
            & np.isfinite(cloud.quaternions).all(axis=1)
            & (np.abs(cloud.quaternions).max(axis=1, initial=0) > 1e-12)
            & (cloud.opacities >= kernels.MIN_ALPHA)
            & np.isfinite(cloud.opacities)
            & np.isfinite(cloud.sh).all(axis=(1, 2))
        )
    return usable


def _columns(sh: Float32, kept: NDArray[np.intp]) -> Float32:
    """The coefficients (3 K, N) of those ``kept`` (N,) of ``sh`` (M, K, 3). In chunks: they are most of a cloud."""
    flat = sh.reshape(len(sh), 3 * sh.shape[1])
    columns = np.empty((flat.shape[1], len(kept)), np.float32)
    for first in range(0, len(kept), CHUNK):
        columns[:, first : first + CHUNK] = flat[kept[first : first + CHUNK]].T
    return columns


def morton_codes(points: Float32) -> NDArray[np.uint32]:
    """Place (N,) of ``points`` (N, 3) on a Morton curve with 1024 steps an axis over the middle 99 % of the points."""
    if len(points) == 0:
        return np.empty(0, np.uint32)
    low, high = np.quantile(points, [0.005, 0.995], axis=0).astype(np.float32)
    step = max(float((high - low).max()), 1e-6) / 1023
    cells = np.clip((points - low) / step, 0, 1023).astype(np.uint32)
    for shift, mask in ((16, 0x030000FF), (8, 0x0300F00F), (4, 0x030C30C3), (2, 0x09249249)):
        cells = (cells | cells << np.uint32(shift)) & np.uint32(mask)
    codes: NDArray[np.uint32] = cells[:, 0] | cells[:, 1] << np.uint32(1) | cells[:, 2] << np.uint32(2)
    return codes


def scaled_axes(quaternions: Float32, scales: Float32) -> Float32:
    """The columns of R S (9, N), for quaternions (N, 4) xyzw of any length and scales (N, 3)."""
    q = quaternions.astype(np.float64)
    x, y, z, w = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    columns = (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )
    axes = np.empty((9, len(q)), np.float32)
    for k, column in enumerate(columns):
        for i, component in enumerate(column):
            axes[3 * k + i] = component * scales[:, k]
    return axes


def bounding_balls(means: Float32, radii: Float32) -> Float32:
    """Centre and radius (N / 256, 4) of a ball round the balls (means, radii) of each block of 256."""
    starts = np.arange(0, len(means), kernels.BLOCK)
    if len(starts) == 0:
        return np.empty((0, 4), np.float32)
    low, high = np.minimum.reduceat(means, starts), np.maximum.reduceat(means, starts)
    centres = (low + high) / 2  # (B, 3)
    distances = np.linalg.norm(means - np.repeat(centres, kernels.BLOCK, axis=0)[: len(means)], axis=1)
    slack = np.float32(1.0001)  # for rounding
    return np.column_stack([centres, np.maximum.reduceat(distances + radii, starts) * slack]).astype(np.float32)
