"""The compiled kernels that pass a picture's error back to the Gaussians it was blended from.

They call functions of `cpu_kernels`: after a change there, touch this file, or numba's cache keeps what was compiled.
"""

import numpy as np
from numba import njit

from flymirage_core.rendering.cpu_kernels import (
    BATCH,
    BLUE,
    CENTRE_X,
    CENTRE_Y,
    FAST,
    GAUSS,
    GREEN,
    LANES,
    LOWEST,
    MAX_ALPHA,
    P0,
    P1,
    P2,
    P3,
    P4,
    P5,
    PEAK,
    RED,
    T_STOP,
    TILE_HEIGHT,
    X_CURVE,
    X_SLOPE,
    Y_FALL,
    F,
    Float32,
    Float64,
    Int64,
    U,
    UInt32,
    _aligned,
    _look_ahead,
)

# A row of a tile: the loss's gradient by red, green, blue; what is behind, times that gradient; the light left.
ROW = 5 * LANES
ROW_G, ROW_B, ROW_BEHIND, ROW_LIGHT = U(LANES), U(2 * LANES), U(3 * LANES), U(4 * LANES)

SUMS = 10
"""What is summed over the pixels of one Gaussian, of its weight w and of e = dL / d ln(alpha):
w dL/dred, w dL/dgreen, w dL/dblue, w, e, e dx, e dy, e dx dx, e dx dy, e dy dy."""


@njit(**FAST)
def blame(records: Float32, starts: Int64, lists: UInt32, picture: Float32, gradient: Float32, sums: Float32) -> None:
    """Fill ``sums`` (N, 10) of the records of a frame, ``gradient`` (H, W, 3) being that of the loss by ``picture``.

    ``starts`` and ``lists`` are of `cpu_kernels._bin`. From front to back once more: what lies behind a Gaussian is the
    finished picture less what was composited up to it.
    """
    height, width = picture.shape[:2]
    columns = (width + LANES - 1) // LANES
    tile = _aligned(ROW * TILE_HEIGHT)
    batch = np.empty((BATCH, 3), np.int64)
    sums[:] = F(0)
    for index in range(len(starts) - 1):
        left, top = (index % columns) * LANES, (index // columns) * TILE_HEIGHT
        tile_width, tile_height = min(LANES, width - left), min(TILE_HEIGHT, height - top)
        _fill(tile, picture, gradient, left, top, tile_width, tile_height)
        for first in range(starts[index], starts[index + 1], BATCH):
            last = min(first + BATCH, starts[index + 1])
            met = _look_ahead(records, lists[first:last], F(left), F(top), tile_height, batch)
            for k in range(met):
                i = batch[k, 0]
                _blame_one(tile, records[i], F(left), F(top), batch[k, 1], batch[k, 2], sums[i])
            if _finished(tile, tile_width, tile_height):
                break


@njit(**FAST)
def _fill(tile: Float32, picture: Float32, gradient: Float32, left: int, top: int, width: int, height: int) -> None:
    tile[:] = F(0)
    for y in range(height):
        for x in range(width):
            i = y * ROW + x
            behind = F(0)
            for k in range(3):
                tile[i + k * LANES] = gradient[top + y, left + x, k]
                behind += gradient[top + y, left + x, k] * picture[top + y, left + x, k]
            tile[i + 3 * LANES] = behind
            tile[i + 4 * LANES] = F(1)


@njit(**FAST)
def _finished(tile: Float32, tile_width: int, tile_height: int) -> bool:
    most = F(-1)
    for y in range(tile_height):
        for x in range(tile_width):
            most = max(most, tile[y * ROW + 4 * LANES + x])
    return bool(most <= F(0))


@njit(**FAST)
def _blame_one(
    tile: Float32, p: Float32, left: np.float32, top: np.float32, first: int, last: int, sums: Float32
) -> None:
    """Composite one Gaussian into rows ``first`` to ``last`` and add to its ``sums``. As `_composite_row`."""
    centre_x, centre_y = p[CENTRE_X] - left - F(0.5), p[CENTRE_Y] - top - F(0.5)
    red, green, blue, curve = p[RED], p[GREEN], p[BLUE], p[X_CURVE]
    for y in range(first, last + 1):
        dy = F(y) - centre_y
        offset, centre, peak = U(y * ROW), centre_x + p[X_SLOPE] * dy, p[PEAK] + p[Y_FALL] * dy * dy
        s_red, s_green, s_blue, s_weight, s_0, s_x, s_xx = F(0), F(0), F(0), F(0), F(0), F(0), F(0)
        for lane in range(LANES):
            i = offset + U(lane)
            dx = F(lane) - centre
            exponent = peak + curve * dx * dx
            x = max(exponent, F(-1))
            root = P0 + x * (P1 + x * (P2 + x * (P3 + x * (P4 + x * P5))))
            root = root * root
            root = root * root
            full = root * root
            opacity = min(full, F(MAX_ALPHA))
            opacity = opacity if exponent >= LOWEST else F(0)
            light = tile[i + ROW_LIGHT]
            weight = opacity * light
            left_over = light - weight
            stop = left_over <= F(T_STOP)
            weight = F(0) if stop else weight
            tile[i + ROW_LIGHT] = -abs(light) if stop else left_over
            own = tile[i] * red + tile[i + ROW_G] * green + tile[i + ROW_B] * blue
            behind = tile[i + ROW_BEHIND] - weight * own
            tile[i + ROW_BEHIND] = behind
            e = weight * own - behind * opacity / (F(1) - opacity)
            e = F(0) if stop else e
            e = e if full <= F(MAX_ALPHA) else F(0)
            s_red += weight * tile[i]
            s_green += weight * tile[i + ROW_G]
            s_blue += weight * tile[i + ROW_B]
            s_weight += weight
            away = F(lane) - centre_x
            s_0 += e
            s_x += e * away
            s_xx += e * away * away
        sums[0] += s_red
        sums[1] += s_green
        sums[2] += s_blue
        sums[3] += s_weight
        sums[4] += s_0
        sums[5] += s_x
        sums[6] += s_0 * dy
        sums[7] += s_xx
        sums[8] += s_x * dy
        sums[9] += s_0 * dy * dy


@njit(**FAST)
def shape_gradients(
    means: Float32, axes: Float32, camera: Float64, records: Float32, ids: UInt32, count: int, sums: Float32
) -> Float32:
    """Gradients (count, 9) of the loss by each visible Gaussian's mean (3) and its first two half axes (3 each).

    That a Gaussian looks otherwise from where it has moved to is left out; it is small beside its distance.
    """
    result = np.empty((count, 9), np.float32)
    for i in range(count):
        n, p, s = ids[i], records[i], sums[i]
        # the conic: exponent -1/2 (qxx dx^2 + 2 qxy dx dy + qyy dy^2)
        qxx = p[X_CURVE] / GAUSS
        qxy = -qxx * p[X_SLOPE]
        qyy = p[Y_FALL] / GAUSS + qxx * p[X_SLOPE] * p[X_SLOPE]
        gu, gv = qxx * s[5] + qxy * s[6], qxy * s[5] + qyy * s[6]
        # Q M Q
        mxx, mxy, myx, myy = (
            qxx * s[7] + qxy * s[8],
            qxx * s[8] + qxy * s[9],
            qxy * s[7] + qyy * s[8],
            qxy * s[8] + qyy * s[9],
        )
        hxx, hxy, hyy = mxx * qxx + mxy * qxy, mxx * qxy + mxy * qyy, myx * qxy + myy * qyy
        d0, d1, d2 = means[0, n] - F(camera[9]), means[1, n] - F(camera[10]), means[2, n] - F(camera[11])
        r = camera
        x = F(r[0]) * d0 + F(r[1]) * d1 + F(r[2]) * d2
        y = F(r[3]) * d0 + F(r[4]) * d1 + F(r[5]) * d2
        z = F(r[6]) * d0 + F(r[7]) * d1 + F(r[8]) * d2
        per_z = F(1) / z
        fx, fy = F(camera[12]) * per_z, F(camera[13]) * per_z
        tx, ty = x * per_z, y * per_z
        for k in range(3):
            jk, kk = fx * (F(r[k]) - tx * F(r[6 + k])), fy * (F(r[3 + k]) - ty * F(r[6 + k]))
            result[i, k] = jk * gu + kk * gv
        for axis in range(2):
            ax, ay = F(0), F(0)
            for k in range(3):
                jk, kk = fx * (F(r[k]) - tx * F(r[6 + k])), fy * (F(r[3 + k]) - ty * F(r[6 + k]))
                ax += jk * axes[3 * axis + k, n]
                ay += kk * axes[3 * axis + k, n]
            hx, hy = hxx * ax + hxy * ay, hxy * ax + hyy * ay
            for k in range(3):
                jk, kk = fx * (F(r[k]) - tx * F(r[6 + k])), fy * (F(r[3 + k]) - ty * F(r[6 + k]))
                result[i, 3 + 3 * axis + k] = jk * hx + kk * hy
    return result
