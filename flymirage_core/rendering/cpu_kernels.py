"""The compiled kernels of the CPU rasterizer: project, sort, bin, blend. gsplat 1.6's mathematics, in float32.

All of them live in this one file, constants included, because numba's cache on disk is keyed by a function's own file.
What they are given is prepared, and called, by `rendering.cpu`. One call renders one frame on one core without the GIL.

A Gaussian's exponent is never expanded into ``a dx^2 + 2 b dx dy + c dy^2``, whose terms cancel in float32 for needles:
it is kept as two squares, for instance ``dy^2 / 2 syy + (dx - dy sxy/syy)^2 syy / 2 det``.
"""

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
UInt32 = NDArray[np.uint32]
Int64 = NDArray[np.int64]

F = np.float32  # every literal in a float32 kernel is wrapped, or numba computes in float64
U = np.uint64  # offsets in a tile are unsigned: a signed index costs a test for "counted from the end"

# gsplat's constants (1.6.0, csrc). A GPU back end passes the first three; the others are compiled into gsplat.
NEAR = 0.01
"""Metres of z-depth: Gaussians whose centre is nearer are not drawn."""
FAR = 1e10
"""Metres of z-depth: Gaussians whose centre is farther are not drawn."""
BLUR = 0.3
"""eps2d, pixels squared: added to the variance along both image axes, because a pixel is no point."""
MIN_ALPHA = 1 / 255
"""A Gaussian that covers a pixel by less is skipped at that pixel."""
MAX_ALPHA = 0.99
"""No single Gaussian covers a pixel by more."""
T_STOP = 1e-4
"""A Gaussian that would bring the light left at a pixel to this or less is not drawn there, nor is any behind it."""
EXTENT = 3.33
"""Standard deviations at which a Gaussian ends; up to opacity 1 its alpha is below `MIN_ALPHA` just before."""
FRUSTUM_MARGIN = 0.15
"""The projection is linearised at most this share of the image's size outside of the image."""

BLOCK = 256
"""Gaussians that are neighbours in space, and are culled together."""
LANES = 16
"""Width of a tile in pixels, and of the vectors that LLVM makes of a row of it."""
TILE_HEIGHT = 32
"""Height of a tile in pixels."""
BATCH = 64
"""Gaussians that a tile looks at before it composites them; after each batch it drops its finished rows."""

# One visible Gaussian is one record of 16 floats, a cache line. Exponents are log2(alpha) / 8, see `_composite_row`:
#   PEAK + Y_FALL dy^2 + X_CURVE (dx - X_SLOPE dy)^2 = PEAK + X_FALL dx^2 + (dy - Y_SLOPE dx)^2 / Y_SPREAD
RECORD = 16
CENTRE_X, CENTRE_Y, DEPTH, PEAK = 0, 1, 2, 3  # pixels, pixels, metres, exponent at the centre
X_CURVE, X_SLOPE, Y_FALL = 4, 5, 6
Y_SPREAD, Y_SLOPE, X_FALL = 7, 8, 9
HALF_WIDTH, HALF_HEIGHT = 10, 11  # pixels, of the ellipse alpha = MIN_ALPHA
GEOMETRY = 12  # floats before the colour
RED, GREEN, BLUE = 12, 13, 14

LOWEST = F(math.log2(MIN_ALPHA) / 8)
GAUSS = F(-0.5 * math.log2(math.e) / 8)  # exponent per squared Mahalanobis distance
BLUR_REACH = F(EXTENT * math.sqrt(BLUR))  # pixels over which a point is blurred

# A row of a tile is five vectors side by side: red, green, blue, depth, light. (In planes 2 kB apart, they would share
# the low bits of their addresses, and a processor takes a load from one for a load of what was just stored in another.)
ROW = 5 * LANES
ROW_G, ROW_B, ROW_Z, ROW_LIGHT = U(LANES), U(2 * LANES), U(3 * LANES), U(4 * LANES)
CACHE_LINE = 64
"""Bytes. Vectors that straddle two lines cost double."""

# 2**x on [-1, 0] to 1e-7: a polynomial through Chebyshev nodes, weighted for the relative error.
_NODES = np.cos(np.pi * (np.arange(400) + 0.5) / 400) / 2 - 0.5
_EXP2 = np.polynomial.Polynomial.fit(_NODES, 2**_NODES, 5, w=2**-_NODES).convert().coef
P0, P1, P2, P3, P4, P5 = (F(c) for c in _EXP2)

# Real spherical harmonics in 3DGS's order and signs.
SH0 = F(0.28209479177387814)
SH1 = F(0.4886025119029199)
SH2_XY, SH2_Z2, SH2_X2 = F(1.0925484305920792), F(0.31539156525252005), F(0.5462742152960396)
SH3_0, SH3_1, SH3_2 = F(0.5900435899266435), F(2.890611442640554), F(0.4570457994644658)
SH3_3, SH3_4 = F(0.3731763325901154), F(1.445305721320277)

FAST: dict[str, Any] = {
    "nogil": True,
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"nnan", "ninf", "nsz", "arcp", "contract", "afn", "reassoc"},
}

Splats = tuple[Float32, Float32, Float32, UInt32, Float32, Float32]
"""means (3, N), axes (9, N), log2 opacities (N,), file indices (N,), blocks (N / 256, 4), sh (3 K, N)."""


def render_frame(
    splats: Splats, camera: Float64, records: Float32, ids: UInt32, rgb: Float32, depth: Float32, alpha: Float32
) -> None:
    """Fill ``rgb`` (H, W, 3), expected ``depth`` (H, W) in metres and ``alpha`` (H, W) with one frame, on black.

    ``splats`` are the arrays of `cpu.SplatTable`; ``camera`` (18,) is R_camera_world by rows, the eye's position, fx,
    fy, cx, cy, width, height. ``records`` (N, 16) and ``ids`` (N,) are scratch, for one thread at a time. Not compiled
    itself: LLVM would optimise all of the kernels once more, for a second of the first start.
    """
    starts, lists, _ = binned(splats, camera, records, ids)
    _blend(records, starts, lists, rgb, depth, alpha)


def binned(splats: Splats, camera: Float64, records: Float32, ids: UInt32) -> tuple[Int64, UInt32, int]:
    """The first half of `render_frame`: what `_bin` returns, and how many records were written."""
    means, axes, opacities, file_indices, blocks, sh = splats
    count = _project(means, axes, opacities, sh, blocks, camera, records, ids)
    order = _depth_order(records, ids, file_indices, count)
    return *_bin(records, order, int(camera[16]), int(camera[17])), count


def compiled() -> bool:
    """Are the kernels compiled, or loaded from numba's cache, in this process?"""
    return bool(_blend.signatures)


@njit(**FAST)
def _project(
    means: Float32,
    axes: Float32,
    opacities: Float32,
    sh: Float32,
    blocks: Float32,
    camera: Float64,
    records: Float32,
    ids: UInt32,
) -> int:
    """Write the record and the index of every Gaussian whose ellipse meets the image; return how many."""
    count = 0
    for block in range(len(blocks)):
        if not _block_in_view(blocks[block], camera):
            continue
        first = block * BLOCK
        last = min(first + BLOCK, means.shape[1])
        found, keep = _project_block(means, axes, opacities, first, last, camera)
        before = count
        for i in range(last - first):
            if keep[i]:
                for k in range(GEOMETRY):
                    records[count, k] = found[k, i]
                ids[count] = first + i
                count += 1
        if count > before:
            colours = _colour_block(means, sh, first, last, camera)
            for j in range(before, count):
                for k in range(3):
                    records[j, RED + k] = colours[k, ids[j] - first]
    return count


@njit(**FAST)
def _block_in_view(block: Float32, camera: Float64) -> bool:
    """Can the block (centre, radius round all its Gaussians' ellipsoids) reach the image? Never wrongly False.

    A Gaussian of radius r is as wide as r sqrt(1 + t^2) in the image at distance one, t being where the projection is
    linearised; the image is widened by the blur.
    """
    dx, dy, dz = block[0] - F(camera[9]), block[1] - F(camera[10]), block[2] - F(camera[11])
    x = F(camera[0]) * dx + F(camera[1]) * dy + F(camera[2]) * dz
    y = F(camera[3]) * dx + F(camera[4]) * dy + F(camera[5]) * dz
    z = F(camera[6]) * dx + F(camera[7]) * dy + F(camera[8]) * dz
    radius = block[3]
    if z + radius < F(NEAR) or z - radius > F(FAR):
        return False
    fx, fy, cx, cy, width, height = _pinhole(camera)
    left, right = (cx + BLUR_REACH) / fx, (width - cx + BLUR_REACH) / fx
    above, below = (cy + BLUR_REACH) / fy, (height - cy + BLUR_REACH) / fy
    margin_x, margin_y = F(FRUSTUM_MARGIN) * width / fx, F(FRUSTUM_MARGIN) * height / fy
    in_view: bool = (
        x + left * z > -radius * math.sqrt(F(1) + (left + margin_x) ** 2)
        and right * z - x > -radius * math.sqrt(F(1) + (right + margin_x) ** 2)
        and y + above * z > -radius * math.sqrt(F(1) + (above + margin_y) ** 2)
        and below * z - y > -radius * math.sqrt(F(1) + (below + margin_y) ** 2)
    )
    return in_view


@njit(**FAST)
def _pinhole(camera: Float64) -> tuple[np.float32, np.float32, np.float32, np.float32, np.float32, np.float32]:
    """fx, fy, cx, cy, width, height in pixels."""
    return F(camera[12]), F(camera[13]), F(camera[14]), F(camera[15]), F(camera[16]), F(camera[17])


@njit(**FAST)
def _project_block(
    means: Float32, axes: Float32, opacities: Float32, first: int, last: int, camera: Float64
) -> tuple[Float32, NDArray[np.uint8]]:
    """EWA splatting of up to 256 Gaussians: their records by columns (12, 256), and which of them meet the image.

    Camera coordinates are computed in float64: depths come out as the float32 nearest to the truth, so the order (half
    of a captured room's Gaussians have a neighbour at the very same depth) does not hang on the processor.
    """
    R0, R1, R2, R3, R4, R5, R6, R7, R8, e0, e1, e2 = camera[:12]
    r0, r1, r2, r3, r4, r5, r6, r7, r8 = F(R0), F(R1), F(R2), F(R3), F(R4), F(R5), F(R6), F(R7), F(R8)
    fx, fy, cx, cy, w, h = _pinhole(camera)
    margin_x, margin_y = F(FRUSTUM_MARGIN) * w / fx, F(FRUSTUM_MARGIN) * h / fy
    left, right, above, below = (
        -cx / fx - margin_x,
        (w - cx) / fx + margin_x,
        -cy / fy - margin_y,
        (h - cy) / fy + margin_y,
    )
    m0, m1, m2 = means[0, first:last], means[1, first:last], means[2, first:last]
    a0, a1, a2 = axes[0, first:last], axes[1, first:last], axes[2, first:last]
    b0, b1, b2 = axes[3, first:last], axes[4, first:last], axes[5, first:last]
    c0, c1, c2 = axes[6, first:last], axes[7, first:last], axes[8, first:last]
    opacity = opacities[first:last]
    found = np.empty((GEOMETRY, BLOCK), np.float32)  # made here, so that LLVM knows that nothing else lies there
    keep = np.empty(BLOCK, np.uint8)
    for i in range(last - first):
        d0, d1, d2 = m0[i] - e0, m1[i] - e1, m2[i] - e2
        x, y, z = F(R0 * d0 + R1 * d1 + R2 * d2), F(R3 * d0 + R4 * d1 + R5 * d2), F(R6 * d0 + R7 * d1 + R8 * d2)
        in_depth = (z >= F(NEAR)) & (z <= F(FAR))
        per_z = F(1) / (z if in_depth else F(1))
        tx, ty = min(max(x * per_z, left), right), min(max(y * per_z, above), below)
        # the rows of J R, and by them the Gaussian's three scaled axes a, b, c in the image
        j0, j1, j2 = fx * per_z * (r0 - tx * r6), fx * per_z * (r1 - tx * r7), fx * per_z * (r2 - tx * r8)
        k0, k1, k2 = fy * per_z * (r3 - ty * r6), fy * per_z * (r4 - ty * r7), fy * per_z * (r5 - ty * r8)
        ax, ay = (
            j0 * a0[i] + j1 * a1[i] + j2 * a2[i],
            k0 * a0[i] + k1 * a1[i] + k2 * a2[i],
        )
        bx, by = (
            j0 * b0[i] + j1 * b1[i] + j2 * b2[i],
            k0 * b0[i] + k1 * b1[i] + k2 * b2[i],
        )
        gx, gy = (
            j0 * c0[i] + j1 * c1[i] + j2 * c2[i],
            k0 * c0[i] + k1 * c1[i] + k2 * c2[i],
        )
        sxx, sxy, syy = ax * ax + bx * bx + gx * gx, ax * ay + bx * by + gx * gy, ay * ay + by * by + gy * gy
        # Cauchy-Binet: the determinant as a sum of squares, where sxx syy - sxy^2 would cancel
        ab, bg, ga = ax * by - ay * bx, bx * gy - by * gx, gx * ay - gy * ax
        det = ab * ab + bg * bg + ga * ga + F(BLUR) * (sxx + syy) + F(BLUR) * F(BLUR)
        sxx, syy = sxx + F(BLUR), syy + F(BLUR)
        peak = opacity[i] * F(0.125)
        reach2 = (LOWEST - peak) / GAUSS  # squared Mahalanobis distance at which alpha is MIN_ALPHA
        u, v = fx * x * per_z + cx, fy * y * per_z + cy
        half_width, half_height = math.sqrt(max(reach2, F(0)) * sxx), math.sqrt(max(reach2, F(0)) * syy)
        per_det, per_xx, per_yy = F(1) / det, F(1) / sxx, F(1) / syy
        found[CENTRE_X, i], found[CENTRE_Y, i], found[DEPTH, i], found[PEAK, i] = u, v, z, peak
        found[X_CURVE, i], found[X_SLOPE, i], found[Y_FALL, i] = GAUSS * syy * per_det, sxy * per_yy, GAUSS * per_yy
        found[Y_SPREAD, i], found[Y_SLOPE, i], found[X_FALL, i] = det * per_xx / GAUSS, sxy * per_xx, GAUSS * per_xx
        found[HALF_WIDTH, i], found[HALF_HEIGHT, i] = half_width, half_height
        keep[i] = (
            in_depth
            & (reach2 > F(0))
            & (u + half_width > F(0))
            & (u - half_width < w)
            & (v + half_height > F(0))
            & (v - half_height < h)
        )
    return found, keep


@njit(**FAST)
def _colour_block(means: Float32, sh: Float32, first: int, last: int, camera: Float64) -> Float32:
    """The colours (3, 256) that up to 256 Gaussians show to the camera: max(0.5 + SH(direction), 0)."""
    px, py, pz = means[0, first:last], means[1, first:last], means[2, first:last]
    ex, ey, ez = F(camera[9]), F(camera[10]), F(camera[11])
    basis = np.empty((16, BLOCK), np.float32)
    for i in range(last - first):  # all four bands: cheaper than to ask
        dx, dy, dz = px[i] - ex, py[i] - ey, pz[i] - ez
        scale = F(1) / math.sqrt(dx * dx + dy * dy + dz * dz + F(1e-20))
        x, y, z = dx * scale, dy * scale, dz * scale
        xx, yy, zz = x * x, y * y, z * z
        basis[0, i] = SH0
        basis[1, i], basis[2, i], basis[3, i] = -SH1 * y, SH1 * z, -SH1 * x
        basis[4, i], basis[5, i], basis[6, i] = SH2_XY * x * y, -SH2_XY * y * z, SH2_Z2 * (F(3) * zz - F(1))
        basis[7, i], basis[8, i] = -SH2_XY * x * z, SH2_X2 * (xx - yy)
        basis[9, i], basis[10, i] = -SH3_0 * y * (F(3) * xx - yy), SH3_1 * x * y * z
        basis[11, i], basis[12, i] = -SH3_2 * y * (F(5) * zz - F(1)), SH3_3 * z * (F(5) * zz - F(3))
        basis[13, i], basis[14, i] = -SH3_2 * x * (F(5) * zz - F(1)), SH3_4 * z * (xx - yy)
        basis[15, i] = -SH3_0 * x * (xx - F(3) * yy)
    colours = np.full((3, BLOCK), F(0.5), np.float32)
    for k in range(len(sh)):
        coefficients = sh[k, first:last]
        for i in range(last - first):
            colours[k % 3, i] += basis[k // 3, i] * coefficients[i]
    return np.maximum(colours, F(0))


@njit(**FAST)
def _depth_order(records: Float32, ids: UInt32, file_indices: UInt32, count: int) -> UInt32:
    """Indices (count,) of records from front to back; at equal float32 depth in the order of the file, as gsplat."""
    keys = np.empty(count, np.uint32)
    order = np.empty(count, np.uint32)
    highest = np.uint32(0)
    for i in range(count):
        keys[i] = file_indices[ids[i]]
        highest = max(highest, keys[i])
        order[i] = i
    order = _radix_sort(keys, order, highest)
    depths = np.empty(count, np.float32)
    for i in range(count):
        depths[i] = records[order[i], DEPTH]
    by_depth: UInt32 = _radix_sort(depths.view(np.uint32), order, np.uint32(0x7F800000))  # positive floats sort so
    return by_depth


@njit(**FAST)
def _radix_sort(keys: UInt32, values: UInt32, highest: np.uint32) -> UInt32:
    """``values`` in the order of ``keys``, none of which is above ``highest``; stable, 11 bits a pass."""
    digits = np.uint32(2047)
    next_keys = np.empty_like(keys)
    next_values = np.empty_like(values)
    position = np.empty(2048, np.uint32)
    shift = np.uint32(0)
    while shift < np.uint32(32) and (highest >> shift) > np.uint32(0):
        position[:] = 0
        for i in range(len(keys)):
            position[(keys[i] >> shift) & digits] += np.uint32(1)
        total = np.uint32(0)
        for digit in range(2048):
            total, position[digit] = total + position[digit], total
        for i in range(len(keys)):
            digit = (keys[i] >> shift) & digits
            next_keys[position[digit]] = keys[i]
            next_values[position[digit]] = values[i]
            position[digit] += np.uint32(1)
        keys, next_keys = next_keys, keys
        values, next_values = next_values, values
        shift += np.uint32(11)
    return values


@njit(**FAST)
def _bin(records: Float32, order: UInt32, width: int, height: int) -> tuple[Int64, UInt32]:
    """Which Gaussians meet which tile, from front to back: tile t's are ``lists[starts[t]:starts[t + 1]]``."""
    columns, rows = (width + LANES - 1) // LANES, (height + TILE_HEIGHT - 1) // TILE_HEIGHT
    starts = np.zeros(columns * rows + 1, np.int64)
    rectangles = np.empty((len(order), 4), np.uint16)  # first and last column, first and last row
    for i in range(len(order)):
        p = records[i]
        left, right = (p[CENTRE_X] - p[HALF_WIDTH]) / F(LANES), (p[CENTRE_X] + p[HALF_WIDTH]) / F(LANES)
        top, bottom = (p[CENTRE_Y] - p[HALF_HEIGHT]) / F(TILE_HEIGHT), (p[CENTRE_Y] + p[HALF_HEIGHT]) / F(TILE_HEIGHT)
        rectangle = rectangles[i]
        rectangle[0], rectangle[1] = _tile(left, columns), _tile(right, columns)
        rectangle[2], rectangle[3] = _tile(top, rows), _tile(bottom, rows)
        for row in range(rectangle[2], rectangle[3] + 1):
            for column in range(rectangle[0], rectangle[1] + 1):
                starts[row * columns + column + 1] += 1
    for tile in range(columns * rows):
        starts[tile + 1] += starts[tile]
    lists = np.empty(starts[-1], np.uint32)
    position = starts.copy()
    for gaussian in order:
        rectangle = rectangles[gaussian]
        for row in range(rectangle[2], rectangle[3] + 1):
            for column in range(rectangle[0], rectangle[1] + 1):
                tile = row * columns + column
                lists[position[tile]] = gaussian
                position[tile] += 1
    return starts, lists


@njit(**FAST)
def _tile(coordinate: np.float32, tiles: int) -> int:
    """The tile at ``coordinate``, or the nearest one; a valid index whatever the float is."""
    return min(max(int(min(max(coordinate, F(0)), F(tiles))), 0), tiles - 1)


@njit(**FAST)
def _blend(records: Float32, starts: Int64, lists: UInt32, rgb: Float32, depth: Float32, alpha: Float32) -> None:
    """Composite tile by tile, in a buffer that stays in the first-level cache."""
    height, width = alpha.shape
    columns = (width + LANES - 1) // LANES
    tile = _aligned(ROW * TILE_HEIGHT)
    live = np.empty(TILE_HEIGHT, np.uint8)
    batch = np.empty((BATCH, 3), np.int64)
    for index in range(len(starts) - 1):
        left, top = (index % columns) * LANES, (index // columns) * TILE_HEIGHT
        tile_width, tile_height = min(LANES, width - left), min(TILE_HEIGHT, height - top)
        tile[:] = F(0)
        for y in range(TILE_HEIGHT):
            live[y] = 1
            for lane in range(LANES):
                tile[y * ROW + 4 * LANES + lane] = F(1)
        for first in range(starts[index], starts[index + 1], BATCH):
            last = min(first + BATCH, starts[index + 1])
            met = _look_ahead(records, lists[first:last], F(left), F(top), tile_height, batch)
            for k in range(met):
                _composite(tile, live, records[batch[k, 0]], F(left), F(top), batch[k, 1], batch[k, 2])
            if not _find_live_rows(tile, live, tile_width, tile_height):
                break
        _write_tile(tile, left, top, rgb, depth, alpha)


@njit(**FAST)
def _look_ahead(
    records: Float32, gaussians: UInt32, left: np.float32, top: np.float32, tile_height: int, batch: Int64
) -> int:
    """Write (Gaussian, first row, last row) of those that meet the tile into ``batch``; return how many.

    Apart from the compositing because it waits for memory, and here for many records at once.
    """
    met = 0
    for gaussian in gaussians:
        first, last = _rows_met(records[gaussian], left, top, tile_height)
        batch[met, 0], batch[met, 1], batch[met, 2] = gaussian, first, last
        met += first <= last
    return met


@njit(**FAST)
def _aligned(size: int) -> Float32:
    """Float32 scratch (size,) that starts at a cache line."""
    room = np.empty(size + CACHE_LINE // 4, np.float32)
    skipped = (-room.ctypes.data % CACHE_LINE) // 4
    return room[skipped : skipped + size]


@njit(**FAST)
def _rows_met(p: Float32, left: np.float32, top: np.float32, tile_height: int) -> tuple[int, int]:
    """First and last row of the tile in which the ellipse alpha >= MIN_ALPHA can meet a pixel's centre.

    The ellipse's highest point has dx = -X_SLOPE HALF_HEIGHT; if that lies beside the tile, the highest point inside of
    the tile lies on the nearer edge. The lowest likewise.
    """
    low, high = left + F(0.5) - p[CENTRE_X], left + F(LANES - 0.5) - p[CENTRE_X]
    lean = p[X_SLOPE] * p[HALF_HEIGHT]
    dx_top, dx_bottom = min(max(-lean, low), high), min(max(lean, low), high)
    inside_top = (LOWEST - p[PEAK] - p[X_FALL] * dx_top * dx_top) * p[Y_SPREAD]
    inside_bottom = (LOWEST - p[PEAK] - p[X_FALL] * dx_bottom * dx_bottom) * p[Y_SPREAD]
    centre = p[CENTRE_Y] - top - F(0.5)
    slack = F(0.01)  # pixels; rounding must not cost a row
    first = centre + p[Y_SLOPE] * dx_top - math.sqrt(max(inside_top, F(0))) - slack
    last = centre + p[Y_SLOPE] * dx_bottom + math.sqrt(max(inside_bottom, F(0))) + slack
    if max(inside_top, inside_bottom) < F(0):
        last = F(-1)
    first, last = min(max(first, F(0)), F(TILE_HEIGHT)), max(min(last, F(tile_height - 1)), F(-1))
    return max(int(math.ceil(first)), 0), min(int(math.floor(last)), tile_height - 1)  # noqa: RUF046 - a float in numba


@njit(**FAST)
def _composite(
    tile: Float32, live: NDArray[np.uint8], p: Float32, left: np.float32, top: np.float32, first: int, last: int
) -> None:
    """Composite one Gaussian into the live rows ``first`` to ``last`` of a tile."""
    centre_x, centre_y = p[CENTRE_X] - left - F(0.5), p[CENTRE_Y] - top - F(0.5)
    slope, fall, peak, curve = p[X_SLOPE], p[Y_FALL], p[PEAK], p[X_CURVE]
    red, green, blue, z = p[RED], p[GREEN], p[BLUE], p[DEPTH]
    for y in range(first, last + 1):
        if live[y]:
            dy = F(y) - centre_y
            _composite_row(tile, U(y * ROW), centre_x + slope * dy, peak + fall * dy * dy, curve, red, green, blue, z)


@njit(**FAST)
def _composite_row(
    tile: Float32,
    offset: np.uint64,
    centre: np.float32,
    peak: np.float32,
    curve: np.float32,
    red: np.float32,
    green: np.float32,
    blue: np.float32,
    z: np.float32,
) -> None:
    """One Gaussian into one row of 16 pixels. A constant trip count and no branch: LLVM makes plain vector code of it.

    A negative transmittance marks a finished pixel, whose light left is its absolute value: its weight then is
    negative, which stops it again.
    """
    for lane in range(LANES):
        i = offset + U(lane)
        dx = F(lane) - centre
        exponent = peak + curve * dx * dx
        x = max(exponent, F(-1))
        root = P0 + x * (P1 + x * (P2 + x * (P3 + x * (P4 + x * P5))))  # 2**x, alpha's eighth root
        root = root * root
        root = root * root
        opacity = min(root * root, F(MAX_ALPHA))
        opacity = opacity if exponent >= LOWEST else F(0)
        light = tile[i + ROW_LIGHT]
        weight = opacity * light
        left = light - weight
        stop = left <= F(T_STOP)
        weight = F(0) if stop else weight
        tile[i] += weight * red
        tile[i + ROW_G] += weight * green
        tile[i + ROW_B] += weight * blue
        tile[i + ROW_Z] += weight * z
        tile[i + ROW_LIGHT] = -abs(light) if stop else left


@njit(**FAST)
def _find_live_rows(tile: Float32, live: NDArray[np.uint8], tile_width: int, tile_height: int) -> bool:
    """Mark rows with no unfinished pixel as not live; is any row live still?"""
    live_rows = 0
    for y in range(tile_height):
        if live[y]:
            most = F(-1)
            for x in range(tile_width):
                most = max(most, tile[y * ROW + 4 * LANES + x])
            if most > F(0):
                live_rows += 1
            else:
                live[y] = 0
    return live_rows > 0


@njit(**FAST)
def _write_tile(tile: Float32, left: int, top: int, rgb: Float32, depth: Float32, alpha: Float32) -> None:
    """The tile's pixels into the frame; expected depth is the sum of w z over the sum of w."""
    height, width = alpha.shape
    for y in range(min(TILE_HEIGHT, height - top)):
        for x in range(min(LANES, width - left)):
            i = y * ROW + x
            covered = F(1) - abs(tile[i + 4 * LANES])
            rgb[top + y, left + x, 0] = tile[i]
            rgb[top + y, left + x, 1] = tile[i + LANES]
            rgb[top + y, left + x, 2] = tile[i + 2 * LANES]
            depth[top + y, left + x] = tile[i + 3 * LANES] / max(covered, F(1e-10))
            alpha[top + y, left + x] = covered
