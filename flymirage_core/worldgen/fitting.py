"""Splats fitted to traced pictures of their world: colour, and in their faces' planes place, extent and turn.

Cut and lit by themselves, splats show edges softer than they are: each is as wide as its cell, and as bright as its
middle. A few hundred small pictures from where drones fly say better (Kerbl et al. 2023, with the normals
held). In steps of `BATCH` pictures: colours by the damped mean of what is missing, the rest by Adam.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.progress import track
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import Scratch, SplatTable
from flymirage_core.rendering.gradients import gradients
from flymirage_core.rendering.threads import in_order, usable_cores
from flymirage_core.scene.keys import rng
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.worldgen import fitting_kernels as kernels
from flymirage_core.worldgen.reference import SharedLightTracer
from flymirage_core.worldgen.sampling import SH_C0, LitWorld
from flymirage_core.worldgen.truth import WorldTruth
from flymirage_core.worldgen.visibility import flown_spots

Float = NDArray[np.float64]
Float32 = NDArray[np.float32]

WIDTH, HEIGHT, FOCAL = 160, 128, 270.0
"""Pixels: small pictures, each pixel 1.4 times as wide as a drone's at 640 over 80 degrees."""
PITCH: Final = (-0.6, 0.3)
"""Radians."""
AHEAD: Final = 1.0
"""Metres that are free in front of the camera."""
BATCH: Final = 10
"""Pictures a step."""
ROUNDS: Final = 2
"""How often each picture is used. From the third time on splats learn pictures by heart."""
COLOUR_RATE, DAMPING = 0.7, 3.5
"""Share of a splat's missing colour that a step gives it; pixels that it is thought to cover besides, rightly."""
RATES: Final = np.array([0.02, 0.02, 0.04, 0.06, 0.06], np.float32)
"""Adam's, of the logarithms of the two extents, the turn (radians) and the two shifts (extents)."""
LAST_RATE: Final = 0.3
"""Share of the rates that is left at the last step."""
REACH: Final = 1.35
"""By how much the balls round the renderer's blocks are widened for splats that shift and grow."""


def fitted(world: LitWorld, truth: WorldTruth, count: int) -> GaussianCloud:
    """The world's splats, fitted to up to ``count`` pictures of it: those that would face a wall are left out."""
    views = cameras(truth, count, rng(truth.scene, "fitting"))
    if not views:
        return world.cloud
    batches = [views[i : i + BATCH] for i in range(0, len(views), BATCH)]
    fit, steps = Fit.of(world.cloud), ROUNDS * len(batches)
    traced = in_order(SharedLightTracer(world).pictures, batches, threads=1)  # the next while these are learned from
    kept: list[list[Float32]] = []
    for step in track(range(steps), "steps of fitting", steps):
        if step < len(batches):
            kept.append(next(traced))
        number = step % len(batches)
        fit.step(batches[number], kept[number], LAST_RATE ** (step / steps))
    return fit.cloud()


def cameras(truth: WorldTruth, count: int, generator: np.random.Generator) -> list[Camera]:
    """Up to ``count`` views from free spots round c to all sides."""
    spots = flown_spots(truth, count, generator)  # (N, 3)
    yaw, pitch = generator.uniform(0, 2 * np.pi, len(spots)), generator.uniform(*PITCH, len(spots))
    ways = np.column_stack([np.cos(yaw), np.sin(yaw), np.tan(pitch)])  # (N, 3)
    clear = truth.is_free(spots + AHEAD * ways * [1, 1, 0])
    pinhole = Intrinsics(WIDTH, HEIGHT, FOCAL, FOCAL, WIDTH / 2, HEIGHT / 2)
    return [Camera(pinhole, look_along(spot, way)) for spot, way in zip(spots[clear], ways[clear], strict=True)]


@dataclass(frozen=True, eq=False)
class Fit:
    """Splats on their way, in the renderer's order. All arrays but those of ``first`` are written to."""

    start: GaussianCloud
    first: SplatTable
    table: SplatTable
    shape: Float32  # (N, 5) logarithms of two extents, turn (radians), two shifts in first extents
    colours: Float32  # (N, 3) display
    means: Float32  # (N, 5) Adam's
    squares: Float32  # (N, 5) Adam's
    fades: Float32  # (N, 2) Adam's
    total: Float32  # (N, 9) gradients of one step

    @staticmethod
    def of(cloud: GaussianCloud) -> "Fit":
        first = SplatTable.of(cloud)
        table = replace(first, **{name: getattr(first, name).copy() for name in ("means", "axes", "blocks", "sh")})
        table.blocks[:, 3] *= REACH
        n = len(table.file_indices)
        shape, means, squares = (np.zeros((n, 5), np.float32) for _ in range(3))
        colours = np.ascontiguousarray(0.5 + SH_C0 * table.sh.T, np.float32)
        fades, total = np.ones((n, 2), np.float32), np.zeros((n, kernels.SUMS), np.float32)
        return Fit(cloud, first, table, shape, colours, means, squares, fades, total)

    def step(self, cameras: list[Camera], pictures: list[Float32], pace: float) -> float:
        """One step by ``pictures`` (H, W, 3) at ``pace`` of the rates; the mean squared error before it."""
        first, table, squared = self.first, self.table, 0.0
        views = list(zip(cameras, pictures, strict=True))
        for seen in in_order(lambda view: gradients(table, *view, Scratch.for_table(table)), views, usable_cores()):
            kernels.gather(seen.rows, seen.sums, seen.shapes, first.axes, table.axes, self.total)
            squared += seen.squared_error
        moved = self.total[:, 3] >= kernels.SEEN
        rates, rate = (pace * RATES).astype(np.float32), np.float32(pace * COLOUR_RATE)
        adam = (self.means, self.squares, self.fades)
        kernels.advance(self.total, self.colours, self.shape, *adam, rates, rate, np.float32(DAMPING))
        kernels.apply(self.shape, moved, first.means, first.axes, table.means, table.axes)
        table.sh[:, moved] = ((self.colours[moved] - 0.5) / SH_C0).T
        return squared / sum(p.size for p in pictures)

    def cloud(self) -> GaussianCloud:
        """As they are now, in the order of the cloud that they were."""
        rows, start = self.table.file_indices, self.start
        quaternions, scales = start.quaternions.copy(), start.scales.copy()
        means, sh = start.means.copy(), start.sh.copy()
        turns = Rotation.from_rotvec(self.shape[:, 2:3] * [0.0, 0.0, 1.0])
        quaternions[rows] = (Rotation.from_quat(quaternions[rows]) * turns).as_quat()
        scales[rows, :2] *= np.exp(self.shape[:, :2])
        means[rows], sh[rows, 0] = self.table.means.T, self.table.sh.T
        return GaussianCloud(means, quaternions, scales, start.opacities, sh)
