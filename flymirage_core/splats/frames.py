"""From a splat file's frame to the world frame: right-handed, z up, metres, ground near z = 0, and the centre c.

Marble says its scale and ground height (`MarbleSemantics`); other files say nothing, and their up axis and floor are
estimated from the flat Gaussians, which are pieces of floors, walls and ceilings.
"""

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.errors import WorldError
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.spherical_harmonics import rotate_sh

Float64 = NDArray[np.float64]
Up = Literal["auto", "y", "z", "-y"]
"""The file's axis that points up. Marble's files and OpenCV's frame have y down, so "-y"."""

Z_UP_FROM: Final[dict[str, Float64]] = {
    "-y": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "z": np.eye(3),
}
"""Rotations that turn a file's frame to z up. "-y" is map B of Marble's frame: forward becomes +y, the paper's yaw
0."""

FACING: Final = 0.9
"""A Gaussian is part of a level surface if the cosine between its normal and the vertical is at least this."""
BIN: Final = 0.02
"""Metres. Heights are counted in bins of this size and smoothed over `SMOOTHED` of them: floors are some cm thick."""
SMOOTHED: Final = 5
FLOOR_SHARE: Final = 0.6
"""The floor is the first level below c whose surface is at least this share of the largest one's there: no table is."""
FLOOR_DEPTH: Final = 0.3
"""The floor lies at least this far below c, in the file's units times the scale."""
PLAUSIBLE_CEILING: Final = (2.0, 6.0)
"""Metres from floor to ceiling that need no comment."""
TYPICAL_CEILING: Final = 2.6
"""Metres. A guess of the scale from the ceiling's height takes it for this."""
STANDING_HEIGHT: Final = 1.5
"""Metres above the floor at which c is put if the file's origin lies outside of the world."""
CORE: Final = (0.05, 0.3)
"""Shares of the world's height and of its width and length that are cut off on each side to leave its core."""
FLIP_EVIDENCE: Final = 0.05
"""The usual sense of an axis is turned round if the matter's balance (see `_balance`) speaks against it by this
much."""


@dataclass(frozen=True)
class MarbleSemantics:
    """``semantics_metadata`` of a Marble world."""

    metric_scale_factor: float  # metres per unit of the file
    ground_plane_offset: float  # metres from the camera down to the ground


@dataclass(frozen=True)
class Framing:
    """A cloud in the world frame, c in it, and how they were found."""

    cloud: GaussianCloud
    centre: Float64  # (3,)
    notes: dict[str, str | int | float]


def transformed(cloud: GaussianCloud, rotation: ArrayLike, scale: float, translation: ArrayLike) -> GaussianCloud:
    """The cloud under ``p -> scale * rotation @ p + translation``; sizes, orientations and SH follow.

    Args:
        rotation: (3, 3), determinant +1.
        scale: metres per unit.
        translation: (3,) metres.
    """
    R, t = np.asarray(rotation, float), np.asarray(translation, float)
    turn = Rotation.from_matrix(R).as_quat()  # (4,) xyzw
    return GaussianCloud(
        (scale * cloud.means.astype(np.float64) @ R.T + t).astype(np.float32),
        _multiplied(turn, cloud.quaternions).astype(np.float32),
        (cloud.scales * scale).astype(np.float32),
        cloud.opacities,
        rotate_sh(cloud.sh, R),
    )


def frame_from_marble(cloud: GaussianCloud, semantics: MarbleSemantics) -> Framing:
    """Marble's frame (x right, y down, z forward, camera at the origin) to the world's: map B of the vendor's frame.

    ``(X, Y, Z) = (s x, s z, g - s y)``: the camera, which is c, comes to (0, 0, g), the ground to z = 0.
    """
    s, g = semantics.metric_scale_factor, semantics.ground_plane_offset
    if not (np.isfinite([s, g]).all() and s > 0):
        raise WorldError(f"Marble's semantics_metadata: scale {s}, ground {g}; expected a positive and a finite number")
    notes: dict[str, str | int | float] = {"up": "-y", "up_source": "Marble", "scale": s, "scale_source": "Marble"}
    notes |= {"floor_source": "Marble", "centre_source": "Marble's camera"}
    return Framing(transformed(cloud, Z_UP_FROM["-y"], s, [0, 0, g]), np.array([0.0, 0.0, g]), notes)


def frame_by_estimate(cloud: GaussianCloud, up: Up = "auto", scale: float | None = None) -> Framing:
    """The world frame of a cloud that says nothing of its own; finite Gaussians only.

    Up as given or by `estimate_up`, floor by `estimate_floor`, scale as given or 1. c is the file's origin, as in
    Marble's files and in captures about a camera; if the origin lies outside of the world, the middle of the world at
    `STANDING_HEIGHT`. A ceiling at an implausible height only adds a note with the scale that it would suggest.
    """
    axis, source = (up, "given") if up != "auto" else estimate_up(_matter(cloud))
    factor = 1.0 if scale is None else scale
    if not (np.isfinite(factor) and factor > 0):
        raise WorldError(f"scale {factor} cannot be used: give metres per unit of the file, a positive number")
    turned = transformed(cloud, Z_UP_FROM[axis], factor, np.zeros(3))
    matter = _matter(turned)
    centre, centre_source = _centre(matter)
    floor, floor_source = estimate_floor(matter, float(centre[2]))
    if centre_source != "origin":
        centre[2] = floor + STANDING_HEIGHT
    notes: dict[str, str | int | float] = {
        "up": axis,
        "up_source": source,
        "scale": factor,
        "scale_source": "assumed" if scale is None else "given",
        "floor_source": floor_source,
        "centre_source": centre_source,
    }
    ceiling = _ceiling(matter, float(centre[2]))
    if ceiling is not None:
        notes["ceiling_height"] = round(ceiling - floor, 3)
        if scale is None and not PLAUSIBLE_CEILING[0] <= ceiling - floor <= PLAUSIBLE_CEILING[1]:
            notes["suggested_scale"] = round(TYPICAL_CEILING / (ceiling - floor), 3)
    shift = np.array([0, 0, -floor])
    return Framing(transformed(turned, np.eye(3), 1.0, shift), centre + shift, notes)


def estimate_up(cloud: GaussianCloud) -> tuple[str, str]:
    """Which axis of the file points up ("-y", "y" or "z"), and the evidence in words.

    The largest level surface in a world is its floor or ceiling, so the axis is the one of y and z across which more
    surface lies in one plane. Furniture stands on the floor, so the side towards which the contents are shifted
    is down; "-y" (Marble, OpenCV) stands unless that says otherwise.
    """
    peaks = {axis: float(_levels(cloud, axis)[1].max(initial=0)) for axis in (1, 2)}
    if peaks[2] > peaks[1]:
        ratio = peaks[2] / max(peaks[1], 1e-9)
        return "z", f"estimated: the largest plane across z has {ratio:.1f} times the surface of that across y"
    ratio, balance = peaks[1] / max(peaks[2], 1e-9), _balance(cloud, 1)
    axis, side = "y" if balance < -FLIP_EVIDENCE else "-y", "+y" if balance > 0 else "-y"
    return axis, (
        f"estimated: the largest plane across y has {ratio:.1f} times the surface of that across z, and the contents "
        f"are shifted by {abs(balance):.3f} of the height towards {side}"
    )


def estimate_floor(cloud: GaussianCloud, centre_z: float) -> tuple[float, str]:
    """Height of the floor of a z-up cloud, and how it was found.

    The first level below c whose surface is at least `FLOOR_SHARE` of the largest one's; if there is no level surface
    there at all, the height below which only 1 % of the matter lies.
    """
    heights, areas = _levels(cloud, 2)
    below = heights < centre_z - FLOOR_DEPTH
    floor = _first_level(heights[below][::-1], areas[below][::-1])
    if floor is None:
        return _quantile(cloud.means[:, 2], _area(cloud), 0.01), "lowest matter"
    return floor, "estimated"


def _matter(cloud: GaussianCloud) -> GaussianCloud:
    """The cloud without far outliers and without Gaussians half as large as the world: sky, haze."""
    distance = np.linalg.norm(cloud.means - np.median(cloud.means, axis=0), axis=1)  # (N,)
    radius = np.quantile(distance, 0.95)
    return cloud[(distance <= 2 * radius) & (cloud.scales.max(axis=1) <= radius / 2)]


def _ceiling(cloud: GaussianCloud, centre_z: float) -> float | None:
    """Height of the first large level surface above c, by the floor's rule; None if there is none."""
    heights, areas = _levels(cloud, 2)
    above = heights > centre_z + FLOOR_DEPTH
    return _first_level(heights[above], areas[above])


def _first_level(heights: Float64, areas: Float64) -> float | None:
    """The first height at which a level surface is large, taken at the middle of that surface's thickness."""
    if areas.max(initial=0) <= 0:
        return None
    first = int(np.argmax(areas >= FLOOR_SHARE * areas.max()))
    peak = first
    while peak + 1 < len(areas) and areas[peak + 1] > areas[peak]:
        peak += 1
    last = peak
    while last + 1 < len(areas) and areas[last + 1] >= FLOOR_SHARE * areas[peak]:
        last += 1
    while areas[first] < FLOOR_SHARE * areas[peak]:
        first += 1
    return float(np.average(heights[first : last + 1], weights=areas[first : last + 1]))


def _centre(cloud: GaussianCloud) -> tuple[Float64, str]:
    """c in a z-up cloud: the file's origin if matter surrounds it, else the matter's middle."""
    weight = _area(cloud)
    low, middle, high = (np.array([_quantile(x, weight, q) for x in cloud.means.T]) for q in (0.01, 0.5, 0.99))
    if (low < 0).all() and (high > 0).all():
        return np.zeros(3), "origin"
    return middle, "middle of the world"


def _levels(cloud: GaussianCloud, axis: int) -> tuple[Float64, Float64]:
    """Heights (B,) along ``axis`` and the area (B,) in m^2 of surface that faces along it near each height."""
    flat = np.abs(_normals(cloud)[:, axis]) >= FACING
    heights = cloud.means[flat, axis]
    if len(heights) == 0:
        return np.empty(0), np.empty(0)
    weight = _area(cloud)[flat]
    low, high = _quantile(heights, weight, 0.001), _quantile(heights, weight, 0.999)
    first = np.floor(low / BIN) - SMOOTHED
    count = int(np.ceil(high / BIN) + SMOOTHED - first) + 1
    bins = np.floor(heights / BIN) - first  # (M,)
    inside = (bins >= 0) & (bins < count)
    areas = np.bincount(bins[inside].astype(int), weight[inside], count)
    return (first + np.arange(count) + 0.5) * BIN, np.convolve(areas, np.ones(SMOOTHED), "same")


def _balance(cloud: GaussianCloud, axis: int) -> float:
    """How far the world's contents lie above the middle along ``axis``, as a share of its height.

    Contents are the Gaussians in its core (`CORE`), away from walls, floor and ceiling. Each counts the same, for
    furniture is finer than a tray ceiling; measured on captured rooms, surface does not tell the two apart.
    """
    weight = _area(cloud)
    inside = np.ones(len(cloud), bool)
    middle, height = 0.0, 1.0
    for k in range(3):
        low, high = _quantile(cloud.means[:, k], weight, 0.01), _quantile(cloud.means[:, k], weight, 0.99)
        margin = CORE[int(k != axis)] * (high - low)
        inside &= (cloud.means[:, k] > low + margin) & (cloud.means[:, k] < high - margin)
        if k == axis:
            middle, height = (low + high) / 2, max(high - low, BIN)
    return float((cloud.means[inside, axis] - middle).mean() / height) if inside.any() else 0.0


def _area(cloud: GaussianCloud) -> Float64:
    """(N,) m^2: cross-section from the flat side, times opacity."""
    ordered = np.sort(cloud.scales, axis=1).astype(np.float64)
    return np.asarray(2 * np.pi * ordered[:, 1] * ordered[:, 2] * cloud.opacities)


def _normals(cloud: GaussianCloud) -> Float64:
    """(N, 3) direction of each Gaussian's shortest axis."""
    rotations = Rotation.from_quat(cloud.quaternions).as_matrix()  # (N, 3, 3)
    return np.asarray(np.take_along_axis(rotations, cloud.scales.argmin(axis=1)[:, None, None], axis=2)[:, :, 0])


def _quantile(values: NDArray[np.float32], weight: Float64, share: float) -> float:
    order = np.argsort(values, kind="stable")
    cumulative = np.cumsum(weight[order])
    return float(values[order[min(int(np.searchsorted(cumulative, share * cumulative[-1])), len(order) - 1)]])


def _multiplied(left: Float64, right: NDArray[np.float32]) -> Float64:
    """Quaternion products (N, 4), xyzw: the rotation ``right`` first, then ``left`` (4,)."""
    a, b = left[:3], right[:, :3].astype(np.float64)
    w = right[:, 3].astype(np.float64)
    vector = left[3] * b + w[:, None] * a + np.cross(a, b)
    return np.concatenate([vector, (left[3] * w - b @ a)[:, None]], axis=1)
