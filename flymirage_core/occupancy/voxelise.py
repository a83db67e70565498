"""From splats to a voxel grid: how much of a ray's light each voxel takes, and which space is reached from c.

The recipe and its knobs are those of the field's splat voxelisers: opacity threshold, floater filter, flood fill from a
seed. All of it is geometry of the cloud; nothing here looks at colour.
"""

from typing import Final

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from flymirage_core.errors import WorldError
from flymirage_core.occupancy.distance import voxels_near
from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from flymirage_core.settings import OccupancySettings
from flymirage_core.splats.cloud import GaussianCloud

Bool = NDArray[np.bool_]

PASSAGE_RADIUS: Final = 0.2
"""Metres. The flood fill is a ball of this radius, so it does not creep through cracks: no drone would fit either."""
CENTRE_RADIUS: Final = 0.15
"""Metres. How far the flood fill's seed may be moved from c; less than `PASSAGE_RADIUS`, so never through a wall."""
REACH: Final = np.array([15.0, 15.0, 10.0])
"""Metres from c along x, y and z: the grid never extends further, however far one sees out of the window."""
BOUND_QUANTILE: Final = 0.002
"""Share of the visible surface that may lie outside of the bounds on each of the six sides: stray splats."""
MARGIN: Final = 0.3
"""Metres of grid kept round the free space, so that walls are in it."""
FLOOR_GAP: Final = 0.5
"""Metres. Holes in the floor up to twice as wide, and holes of any size that floor surrounds, count as floor."""
FLOOR_FULLNESS: Final = 0.6
"""The floor is the first layer below c with this share of the fullest layer's matter: no table has as much."""
MIN_FLOOR_SHARE: Final = 0.25
"""A layer is the floor only if it is this share of the columns that hold any matter (else: terrain, no flat floor)."""
FLOOR_DEPTH: Final = 0.3
"""Metres. The floor lies at least this far below c."""
SPREAD: Final = 2.5
"""Standard deviations to which a Gaussian is spread over voxels; 98.8 % of its mass along each axis."""


def occupancy_from_splats(cloud: GaussianCloud, centre: ArrayLike, settings: OccupancySettings) -> OccupancyGrid:
    """Free, occupied and unknown space of a world.

    A voxel is OCCUPIED where `accumulated_opacity` passes the threshold and the island it belongs to (26-connected)
    is no floater. It is FREE where a ball of `PASSAGE_RADIUS` that starts at c can get to (6-connected: a
    26-connected fill would slip diagonally through walls of one voxel). All else is UNKNOWN: the inside of solids,
    what lies outside, what lies below the floor, and columns that have no ground: rooms that were cut from a larger
    capture have doorways and windows that end in nothing, and nobody flies out of them.

    Args:
        cloud: cleaned Gaussians; world frame, z up, metres.
        centre: (3,) c; the flood fill starts from the nearest place, within `CENTRE_RADIUS`, where the ball fits.
        settings: resolution, threshold, floater size.

    Raises:
        WorldError: the cloud is empty, or c is not in free space.
    """
    centre = np.asarray(centre, float)  # (3,)
    if len(cloud) == 0:
        raise WorldError("the world has no Gaussians: there is nothing to make an occupancy grid from")
    origin, shape = grid_bounds(cloud, centre, settings.resolution)
    opacity = accumulated_opacity(cloud, origin, shape, settings.resolution)
    occupied = without_floaters(opacity >= settings.opacity_threshold, settings.min_component_voxels)
    grid = OccupancyGrid(np.where(occupied, OCCUPIED, UNKNOWN).astype(np.uint8), origin, settings.resolution)
    grid = _cropped(grid, occupied)
    free = _reached(grid, groundless(grid, centre), centre)
    return _cropped(
        OccupancyGrid(np.where(free, FREE, grid.state).astype(np.uint8), grid.origin, grid.resolution), free
    )


def grid_bounds(
    cloud: GaussianCloud, centre: NDArray[np.float64], resolution: float
) -> tuple[NDArray[np.float64], tuple[int, int, int]]:
    """Origin (3,) and shape of a grid round c that holds the cloud but for stray splats, and no more than `REACH`.

    Bounds are quantiles over visible surface (opacity times cross-section), widened by the Gaussians' own extent. The
    plane z = 0 is the middle of a layer, so that a floor there fills one layer and not two.
    """
    weight = cloud.opacities * _cross_section(cloud.scales)  # (N,)
    extent = 2 * _axis_deviation(cloud)  # (N, 3)
    lower, upper = np.empty(3), np.empty(3)
    for axis in range(3):
        lower[axis] = _weighted_quantile(cloud.means[:, axis] - extent[:, axis], weight, BOUND_QUANTILE)
        upper[axis] = _weighted_quantile(cloud.means[:, axis] + extent[:, axis], weight, 1 - BOUND_QUANTILE)
    lower = np.clip(lower, centre - REACH, centre - PASSAGE_RADIUS)
    upper = np.clip(upper, centre + PASSAGE_RADIUS, centre + REACH)
    phase = np.array([0.0, 0.0, resolution / 2])
    first = np.floor((lower + phase) / resolution) - 1
    last = np.ceil((upper + phase) / resolution) + 1
    x, y, z = (last - first).astype(int)
    return first * resolution - phase, (int(x), int(y), int(z))


def accumulated_opacity(
    cloud: GaussianCloud, origin: NDArray[np.float64], shape: tuple[int, int, int], resolution: float
) -> NDArray[np.float32]:
    """(X, Y, Z) share of its light that a ray loses, on average, on its way through each voxel, 0 to 1.

    ``1 - exp(-sum_i alpha_i A_i w_i / resolution**2)``, where A_i = 2 pi s1 s2 is the area that Gaussian i covers
    when seen from its flat side (s1, s2: its two largest deviations) and w_i the share of its mass in the voxel. So a
    flat wall splat fills all the voxels that it passes through and no others, a speck of dust counts little, and haze
    counts by its depth.
    """
    depth = np.zeros(shape, np.float32)  # (X, Y, Z) optical depth
    _spread(
        cloud.means, cloud.quaternions, cloud.scales, cloud.opacities * _cross_section(cloud.scales) / resolution**2,
        origin, resolution, depth,
    )  # fmt: skip
    return np.asarray(-np.expm1(-depth), np.float32)


def without_floaters(occupied: Bool, min_voxels: int) -> Bool:
    """``occupied`` (X, Y, Z) without its 26-connected islands of fewer than ``min_voxels`` voxels."""
    labels, count = ndimage.label(occupied, structure=np.ones((3, 3, 3), int))
    large = np.bincount(labels.ravel(), minlength=count + 1) >= min_voxels
    large[0] = False
    return np.asarray(large[labels])


def floor_layer(grid: OccupancyGrid, centre: NDArray[np.float64]) -> int | None:
    """Index of the layer of voxels that is the floor: the first full one below c; None where there is no flat floor."""
    occupied = grid.state == OCCUPIED
    top = int(grid.index_of(centre - [0, 0, FLOOR_DEPTH])[2])
    counts = occupied.sum(axis=(0, 1))[: max(top, 0)]
    if len(counts) == 0 or counts.max() < MIN_FLOOR_SHARE * max(occupied.any(axis=2).sum(), 1):
        return None
    layer = int(np.flatnonzero(counts >= FLOOR_FULLNESS * counts.max())[-1])
    while layer > 0 and counts[layer - 1] > counts[layer]:
        layer -= 1  # carpets and noise above the floor
    return layer


def groundless(grid: OccupancyGrid, centre: NDArray[np.float64]) -> Bool:
    """(X, Y, Z) where nothing lies below that could carry: under the floor, and over no ground at all.

    A column's ground is its lowest matter, or the floor where matter lies in the floor's layers, or where such matter
    surrounds the column. Then ground that is higher than all round it, or missing, over less than twice `FLOOR_GAP` is
    lowered to what is round it (grey opening): no scan sees the floor below every table.
    """
    occupied = grid.state == OCCUPIED
    height = occupied.shape[2]
    ground = np.where(occupied.any(axis=2), occupied.argmax(axis=2), height)  # (X, Y) layer
    floor = floor_layer(grid, centre)
    if floor is not None:
        seen = occupied[:, :, max(floor - 1, 0) : floor + 2].any(axis=2)  # (X, Y)
        ground = np.where(ndimage.binary_fill_holes(seen), floor, np.maximum(ground, floor))
    disc = _disc(FLOOR_GAP / grid.resolution)
    pad = len(disc)  # outside of the grid there is no ground, and the opening must see so
    ground = ndimage.grey_opening(np.pad(ground, pad, constant_values=height), footprint=disc)[pad:-pad, pad:-pad]
    return np.asarray(np.arange(height) <= ground[:, :, None])


def _reached(grid: OccupancyGrid, forbidden: Bool, centre: NDArray[np.float64]) -> Bool:
    """(X, Y, Z) what a ball that starts at c can sweep without touching matter or forbidden space."""
    radius = PASSAGE_RADIUS / grid.resolution  # voxels
    empty = (grid.state != OCCUPIED) & ~forbidden
    touching = voxels_near(np.pad(~empty, 1, constant_values=True), radius + 0.5 - 2e-6)[1:-1, 1:-1, 1:-1]
    labels, _ = ndimage.label(~touching)  # 6-connected
    start = _seed(grid, ~touching, centre)
    return np.asarray(empty & voxels_near(labels == labels[start], radius + 0.5 - 1e-6))


def _seed(grid: OccupancyGrid, passable: Bool, centre: NDArray[np.float64]) -> tuple[int, int, int]:
    """The voxel nearest to c in which the ball fits."""
    slack = CENTRE_RADIUS + grid.resolution * np.sqrt(3) / 2  # voxel centres: c itself may sit in a corner of its voxel
    first, end = (np.clip(grid.index_of(centre + d) + (d > 0), 0, passable.shape) for d in (-slack, slack))
    block = passable[first[0] : end[0], first[1] : end[1], first[2] : end[2]]
    candidates = np.argwhere(block) + first  # (M, 3)
    distances = np.linalg.norm(grid.centre_of(candidates) - centre, axis=1)  # (M,)
    if len(distances) == 0 or distances.min() > slack:
        x, y, z = centre
        raise WorldError(
            f"the scene centre ({x:.2f}, {y:.2f}, {z:.2f}) is not in free space: there is matter within "
            f"{PASSAGE_RADIUS:g} m of it, or it lies below the floor or outside of the world; give another centre, or "
            "check the up axis and scale with `flymirage doctor`"
        )
    i, j, k = candidates[int(distances.argmin())]
    return int(i), int(j), int(k)


def _cropped(grid: OccupancyGrid, kept: Bool) -> OccupancyGrid:
    """The part of the grid within `MARGIN` of the box round ``kept`` (X, Y, Z); all of it if nothing is kept."""
    if not kept.any():
        return grid
    margin = int(np.ceil(MARGIN / grid.resolution))
    layers = [np.flatnonzero(kept.any(axis=others)) for others in ((1, 2), (0, 2), (0, 1))]
    first = np.maximum([of_axis[0] - margin for of_axis in layers], 0)
    last = np.minimum([of_axis[-1] + 1 + margin for of_axis in layers], grid.state.shape)
    part = grid.state[first[0] : last[0], first[1] : last[1], first[2] : last[2]]
    return OccupancyGrid(np.ascontiguousarray(part), grid.origin + first * grid.resolution, grid.resolution)


def _disc(radius: float) -> Bool:
    """Cells (2m + 1, 2m + 1) whose centre lies within ``radius`` cells of the middle one."""
    steps = np.arange(-int(radius), int(radius) + 1)
    return np.asarray(steps[:, None] ** 2 + steps**2 <= radius**2)


def _cross_section(scales: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N,) m^2 that each Gaussian covers at full opacity when seen from its flat side: 2 pi s1 s2."""
    ordered = np.sort(scales, axis=1)  # (N, 3)
    return np.asarray(2 * np.pi * ordered[:, 1] * ordered[:, 2], np.float32)


def _axis_deviation(cloud: GaussianCloud) -> NDArray[np.float32]:
    """(N, 3) standard deviation of each Gaussian along the world's axes."""
    x, y, z, w = cloud.quaternions.T
    rows = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )  # (3, 3, N)
    return np.asarray(np.sqrt(((rows * cloud.scales.T[None]) ** 2).sum(axis=1)).T, np.float32)


def _weighted_quantile(values: NDArray[np.float32], weights: NDArray[np.float32], share: float) -> float:
    order = np.argsort(values, kind="stable")
    cumulative = np.cumsum(weights[order], dtype=np.float64)
    return float(values[order[min(np.searchsorted(cumulative, share * cumulative[-1]), len(order) - 1)]])


@numba.njit(cache=True, nogil=True)
def _spread(
    means: NDArray[np.float32],  # (N, 3)
    quaternions: NDArray[np.float32],  # (N, 4) xyzw
    scales: NDArray[np.float32],  # (N, 3)
    depths: NDArray[np.float32],  # (N,) optical depth if all of it were in one voxel
    origin: NDArray[np.float64],  # (3,)
    resolution: float,
    field: NDArray[np.float32],  # (X, Y, Z) is added to
) -> None:
    """Break each Gaussian into grains on a lattice along its own axes, and drop each grain into its voxel."""
    nx, ny, nz = field.shape
    axes = np.empty((3, 3))  # row k: axis k, a step long, in voxels
    half = np.empty(3, np.int64)
    rate = np.empty(3)  # a step, in standard deviations
    for n in range(len(means)):
        # Flat Gaussians need two grains a voxel to leave no hole; those that are thick anyway get one.
        step = resolution / 2 if scales[n].min() < resolution else resolution
        x, y, z, w = quaternions[n, 0], quaternions[n, 1], quaternions[n, 2], quaternions[n, 3]
        axes[0] = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)
        axes[1] = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
        axes[2] = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
        axes *= step / resolution
        norm = 1.0
        for k in range(3):
            half[k] = int(SPREAD * scales[n, k] / step)
            rate[k] = step / max(scales[n, k], 1e-9)
            total = 1.0
            for i in range(1, half[k] + 1):
                total += 2 * np.exp(-0.5 * (i * rate[k]) ** 2)
            norm *= total
        cx = (means[n, 0] - origin[0]) / resolution
        cy = (means[n, 1] - origin[1]) / resolution
        cz = (means[n, 2] - origin[2]) / resolution
        for i in range(-half[0], half[0] + 1):
            for j in range(-half[1], half[1] + 1):
                for k in range(-half[2], half[2] + 1):
                    u = int(np.floor(cx + i * axes[0, 0] + j * axes[1, 0] + k * axes[2, 0]))
                    v = int(np.floor(cy + i * axes[0, 1] + j * axes[1, 1] + k * axes[2, 1]))
                    t = int(np.floor(cz + i * axes[0, 2] + j * axes[1, 2] + k * axes[2, 2]))
                    if 0 <= u < nx and 0 <= v < ny and 0 <= t < nz:
                        power = (i * rate[0]) ** 2 + (j * rate[1]) ** 2 + (k * rate[2]) ** 2
                        field[u, v, t] += depths[n] / norm * np.exp(-0.5 * power)
