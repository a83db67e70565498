"""Compiled loops over one picture's pixels: rounding, millimetres, yuv420p, which box one shows. No GIL is held."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
UInt16 = NDArray[np.uint16]

F = np.float32
COMPILED: dict[str, Any] = {"nogil": True, "cache": True, "error_model": "numpy"}


@njit(**COMPILED)
def quantise(rgb: Float32, depth: Float32, alpha: Float32, min_alpha: float, out: NDArray[np.uint8]) -> None:
    """Round and clip ``rgb`` (3 P,) into ``out``; strike out ``depth`` (P,) where ``alpha`` (P,) is too small."""
    for i in range(len(rgb)):
        out[i] = np.uint8(min(max(rgb[i], F(0)), F(1)) * F(255) + F(0.5))
    least = F(min_alpha)
    for i in range(len(depth)):
        depth[i] = depth[i] if alpha[i] >= least else F(0)


@njit(**COMPILED)
def millimetres(depth: Float32, out: UInt16) -> None:
    """Metres (P,) to rounded millimetres (P,); what is not finite, not positive or too far becomes 0."""
    for i in range(len(depth)):
        scaled = np.rint(depth[i] * F(1000))
        out[i] = np.uint16(scaled) if (scaled >= F(1)) & (scaled <= F(65535)) else np.uint16(0)  # NaN is neither


@njit(**COMPILED)
def yuv420p(rgb: NDArray[np.uint8], height: int, width: int, out: NDArray[np.uint8]) -> None:
    """RGB (3 P,) of an even ``height`` and ``width`` to the planes Y, U, V (3/2 P,): BT.601, limited range.

    The colour of four pixels is their mean. In sixteen-bit fixed point: nine tenths of the bytes are those of exact
    arithmetic, the others are off by one.
    """
    half = width // 2
    u_plane, v_plane = out[height * width :], out[height * width * 5 // 4 :]
    for y in range(0, height, 2):
        upper, lower = rgb[y * width * 3 : (y + 1) * width * 3], rgb[(y + 1) * width * 3 : (y + 2) * width * 3]
        for row, luma in ((upper, out[y * width : (y + 1) * width]), (lower, out[(y + 1) * width : (y + 2) * width])):
            for x in range(width):
                r, g, b = np.int32(row[3 * x]), np.int32(row[3 * x + 1]), np.int32(row[3 * x + 2])
                luma[x] = (16829 * r + 33039 * g + 6416 * b + (16 << 16) + (1 << 15)) >> 16
        u, v = u_plane[y // 2 * half : (y // 2 + 1) * half], v_plane[y // 2 * half : (y // 2 + 1) * half]
        for x in range(half):
            i = 6 * x
            r = np.int32(upper[i]) + upper[i + 3] + lower[i] + lower[i + 3]
            g = np.int32(upper[i + 1]) + upper[i + 4] + lower[i + 1] + lower[i + 4]
            b = np.int32(upper[i + 2]) + upper[i + 5] + lower[i + 2] + lower[i + 5]
            u[x] = (-9714 * r - 19070 * g + 28784 * b + (128 << 18) + (1 << 17)) >> 18
            v[x] = (28784 * r - 24103 * g - 4681 * b + (128 << 18) + (1 << 17)) >> 18


@njit(**COMPILED)
def mark_box(
    depth: Float32,
    ray: Float64,
    rectangle: tuple[int, int, int, int],
    low: Float64,
    high: Float64,
    value: np.uint16,
    ids: UInt16,
) -> int:
    """Write ``value`` into the pixels of ``ids`` (H, W) that show a point of a box; return how many there are.

    A pixel's point in the box's own frame is ``ray[0] + depth (ray[1] + (x + 0.5) ray[2] + (y + 0.5) ray[3])``; it lies
    in the box if it is between ``low`` and ``high`` (3,). Only rows and columns of ``rectangle`` (first and end row,
    first and end column) are looked at.
    """
    first_row, end_row, first_column, end_column = rectangle
    count = 0
    for y in range(first_row, end_row):
        v = y + 0.5
        a0, a1, a2 = ray[1, 0] + v * ray[3, 0], ray[1, 1] + v * ray[3, 1], ray[1, 2] + v * ray[3, 2]
        for x in range(first_column, end_column):
            z = depth[y, x]
            p0 = ray[0, 0] + z * (a0 + (x + 0.5) * ray[2, 0])
            p1 = ray[0, 1] + z * (a1 + (x + 0.5) * ray[2, 1])
            p2 = ray[0, 2] + z * (a2 + (x + 0.5) * ray[2, 2])
            inside = (p0 >= low[0]) & (p0 <= high[0]) & (p1 >= low[1]) & (p1 <= high[1])
            inside &= (p2 >= low[2]) & (p2 <= high[2]) & (z > F(0))
            if inside:
                ids[y, x] = value
                count += 1
    return count
