"""What changes between two neighbouring frames once the camera's own motion is taken out, by depth and pose.

Pictures are shrunk first: flicker and floaters are larger than pixels, and it is an eighth of the work.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.language.evidence import Sighting
from flymirage_core.rendering.views import DEPTH_UNIT

GRID = 160
"""Pixels across of the shrunk pictures."""
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
    shrunk, other = _shrunk(first), _shrunk(second)
    points = shrunk.points()  # (N, 3) world
    pixels, expected = second.camera.project(points)  # (N, 2), (N,)
    scale = other.depth.shape[1] / second.camera.intrinsics.width
    columns, rows = np.floor(np.nan_to_num(pixels, nan=-1e6) * scale).astype(int).T
    height, width = other.depth.shape
    inside = (expected > 0) & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    if inside.sum() < LEAST_COMMON * len(points) or not inside.any():
        return None
    rows, columns, expected = rows[inside], columns[inside], expected[inside]
    tolerance = DEPTH_TOLERANCE[0] + DEPTH_TOLERANCE[1] * expected
    same = (other.nearest[rows, columns] <= expected + tolerance) & (
        other.farthest[rows, columns] >= expected - tolerance
    )
    before, after = shrunk.luma[shrunk.depth > 0][inside], other.luma[rows, columns]
    steps = np.abs(before - after)[same]
    return Change(float(np.median(steps)) if steps.size else 255.0, float(1 - same.mean()))


@dataclass(frozen=True, eq=False)
class _Shrunk:
    sighting: Sighting
    luma: NDArray[np.float32]  # (h, w)
    depth: NDArray[np.float32]  # (h, w) metres, of the middle pixel
    nearest: NDArray[np.float32]  # (h, w) metres, of the 3 x 3 neighbours
    farthest: NDArray[np.float32]

    def points(self) -> NDArray[np.float64]:
        """World points (N, 3) of the pixels with a return, row by row."""
        rows, columns = np.nonzero(self.depth)
        camera = self.sighting.camera
        k, scale = camera.intrinsics, camera.intrinsics.width / self.depth.shape[1]
        z = self.depth[rows, columns].astype(float)
        x = (_middle(columns, scale) + 0.5 - k.cx) / k.fx * z
        y = (_middle(rows, scale) + 0.5 - k.cy) / k.fy * z
        pose = camera.T_world_camera
        return np.asarray(np.stack([x, y, z], axis=1) @ pose[:3, :3].T + pose[:3, 3])


def _shrunk(sighting: Sighting) -> _Shrunk:
    height, width = sighting.depth.shape
    size = min(GRID, width), max(1, round(height * min(GRID, width) / width))
    scale = width / size[0]
    rows, columns = (
        np.minimum(_middle(np.arange(n), scale), m - 1) for n, m in zip(size[::-1], (height, width), strict=True)
    )
    depth = sighting.depth[np.ix_(rows, columns)].astype(np.float32) * np.float32(DEPTH_UNIT)
    window = np.ones((3, 3), np.uint8)
    far = np.where(depth > 0, depth, np.float32(np.inf))
    return _Shrunk(
        sighting,
        np.asarray(cv2.resize(sighting.luma, size, interpolation=cv2.INTER_AREA), np.float32),
        depth,
        np.asarray(cv2.erode(far, window), np.float32),
        np.asarray(cv2.dilate(depth, window), np.float32),
    )


def _middle(index: NDArray[np.intp], scale: float) -> NDArray[np.intp]:
    """The full picture's pixel in the middle of a shrunk one."""
    return np.asarray(np.floor((index + 0.5) * scale), np.intp)
