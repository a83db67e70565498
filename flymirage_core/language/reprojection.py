"""What changes between two neighbouring frames once the camera's own motion is taken out, by depth and pose.

Pictures are shrunk first: flicker and floaters are larger than pixels, and it is an eighth of the work.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.language.evidence import Sighting
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.views import DEPTH_UNIT

GRID = 160
"""Pixels across of the shrunk pictures."""
POINT_STEP = 2
"""Of the first shrunk picture every second pixel in every second row is followed: some thousands are a fair sample."""
DEPTH_TOLERANCE = (0.03, 0.04)
"""Metres, and share of the depth, by which a point may be off: half a shrunk pixel on a slanted floor."""
LEAST_COMMON = 0.2
"""Share of the first picture's points that the second must show for the two to be compared."""


@dataclass(frozen=True)
class Change:
    """Between two neighbouring frames."""

    colour: float  # grey levels, median over points seen at the same depth: flicker
    depth: float  # share of points in both views that the second sees at another depth: floaters, popping surfaces


def change(first: Sighting, second: Sighting) -> Change | None:
    """How the first frame's points look in the second; None if hardly any of them is in it."""
    before, here, expected = _followed(first, second.camera)  # (N,) grey levels, (N, 2) pixels, (N,) metres
    other = _shrunk(second)
    height, width = other.luma.shape
    columns, rows = np.floor(np.nan_to_num(here, nan=-1e6) * (width / second.camera.intrinsics.width)).astype(int).T
    inside = (expected > 0) & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    if inside.sum() < LEAST_COMMON * len(expected) or not inside.any():
        return None
    rows, columns, expected = rows[inside], columns[inside], expected[inside]
    tolerance = DEPTH_TOLERANCE[0] + DEPTH_TOLERANCE[1] * expected
    same = (other.nearest[rows, columns] <= expected + tolerance) & (
        other.farthest[rows, columns] >= expected - tolerance
    )
    steps = np.abs(before[inside] - other.luma[rows, columns])[same]
    return Change(float(np.median(steps)) if steps.size else 255.0, float(1 - same.mean()))


@dataclass(frozen=True, eq=False)
class _Shrunk:
    """The picture that is looked into."""

    luma: NDArray[np.float32]  # (h, w)
    nearest: NDArray[np.float32]  # (h, w) metres, of the 3 x 3 neighbours
    farthest: NDArray[np.float32]


def _followed(first: Sighting, second: Camera) -> tuple[NDArray[np.float32], NDArray[np.float64], NDArray[np.float64]]:
    """Points of the first picture: grey level (N,), and pixel (N, 2) and z-depth (N,) in the second camera."""
    depth, rows, columns = _thinned(first.depth)
    luma = _small(first.luma)[::POINT_STEP, ::POINT_STEP]
    depth, rows, columns = depth[::POINT_STEP, ::POINT_STEP], rows[::POINT_STEP], columns[::POINT_STEP]
    k, returns = first.camera.intrinsics, depth > 0
    x, y = depth * ((columns + 0.5 - k.cx) / k.fx), depth * ((rows + 0.5 - k.cy) / k.fy)[:, None]
    local = np.stack([x[returns], y[returns], depth[returns]], axis=1)  # (N, 3)
    pose = first.camera.T_world_camera
    pixels, expected = second.project(local @ pose[:3, :3].T + pose[:3, 3])
    return luma[returns], pixels, expected


def _shrunk(sighting: Sighting) -> _Shrunk:
    depth, _, _ = _thinned(sighting.depth)
    window = np.ones((3, 3), np.uint8)
    far = np.where(depth > 0, depth, np.float32(np.inf))
    nearest, farthest = cv2.erode(far, window), cv2.dilate(depth, window)
    return _Shrunk(_small(sighting.luma), np.asarray(nearest, np.float32), np.asarray(farthest, np.float32))


def _size(height: int, width: int) -> tuple[int, int]:
    """Columns and rows of a shrunk picture."""
    return min(GRID, width), max(1, round(height * min(GRID, width) / width))


def _small(luma: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.asarray(cv2.resize(luma, _size(*luma.shape), interpolation=cv2.INTER_AREA), np.float32)


def _thinned(depth: NDArray[np.uint16]) -> tuple[NDArray[np.float32], NDArray[np.intp], NDArray[np.intp]]:
    """Depth (h, w) in metres of the full picture's pixels in the middle of the shrunk ones; their rows and columns."""
    size, (height, width) = _size(*depth.shape), depth.shape
    rows, columns = (
        np.minimum(np.floor((np.arange(n) + 0.5) * (width / size[0])).astype(np.intp), m - 1)
        for n, m in zip(size[::-1], (height, width), strict=True)
    )
    return depth[np.ix_(rows, columns)].astype(np.float32) * np.float32(DEPTH_UNIT), rows, columns
