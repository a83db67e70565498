"""What a picture's error says of each Gaussian in it: the rasterizer's backward pass, on the calling thread.

The loss is half the squared error of the float picture, summed over pixels and channels. Its kernels are in
`gradient_kernels`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering import cpu_kernels, gradient_kernels
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.cpu import Scratch, SplatTable, packed

Float32 = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Gradients:
    """Of the K Gaussians that one picture shows."""

    rows: NDArray[np.uint32]  # (K,) their columns in the table
    sums: Float32  # (K, 10) colours (3), pixels covered, logarithm of opacity; see `gradient_kernels.SUMS`
    shapes: Float32  # (K, 9) of means (3) and of the first two half axes (3 each), per metre
    squared_error: float  # summed over pixels and channels


def gradients(table: SplatTable, camera: Camera, target: Float32, scratch: Scratch) -> Gradients:
    """Of one view, ``target`` (H, W, 3) being what it should show, 1 = full."""
    eye = packed(camera)
    starts, lists, count = cpu_kernels.binned(table.arrays(), eye, scratch.records, scratch.ids)
    seen = np.empty_like(target)
    plane = np.empty((2, *target.shape[:2]), np.float32)
    cpu_kernels._blend(scratch.records, starts, lists, seen, plane[0], plane[1])
    error = seen - target
    sums = np.empty((count, gradient_kernels.SUMS), np.float32)
    gradient_kernels.blame(scratch.records, starts, lists, seen, error, sums)
    shapes = gradient_kernels.shape_gradients(
        table.means, table.axes, eye, scratch.records, scratch.ids, count, sums
    )  # (K, 9)
    rows = scratch.ids[:count].copy()
    squared = float(np.square(error, dtype=np.float64).sum())
    return Gradients(rows, sums, shapes, squared)
