"""Depth pictures and the poses between them: what one camera sees, carried to the other, must lie there."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.rendering.camera import Camera, Intrinsics

Depth = NDArray[np.uint16]

STRIDE = 6
"""Every so many pixels in each direction one is carried over."""
NEAR = 0.1
"""Metres: nearer returns are within the drone."""


def depth_disagreement(first: Depth, first_camera: Camera, second: Depth, second_camera: Camera) -> float:
    """Median of \\|predicted - seen\\| / predicted z-depth over the first picture's points that the second shows.

    Depths (H, W) in millimetres, 0 = no return. The median forgives occlusion and edges; NaN if nothing is shared.
    """
    points = points_of(first, first_camera, STRIDE).reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)]
    pixels, predicted = second_camera.project(points)
    height, width = second.shape
    shown = (predicted > NEAR) & (pixels >= 0).all(axis=1) & (pixels < (width, height)).all(axis=1)
    if not shown.any():
        return float("nan")
    column, row = pixels[shown].astype(int).T
    seen = second[row, column] / 1000.0
    returned = seen > 0
    if not returned.any():
        return float("nan")
    return float(np.median(np.abs(predicted[shown] - seen)[returned] / predicted[shown][returned]))


def points_of(depth: Depth, camera: Camera, stride: int = 1) -> NDArray[np.float64]:
    """World points (H/stride, W/stride, 3) of the pixels of ``depth`` (H, W) in millimetres; NaN without a return."""
    k = camera.intrinsics
    v, u = np.mgrid[0 : depth.shape[0] : stride, 0 : depth.shape[1] : stride]
    z = depth[::stride, ::stride] / 1000.0
    z = np.where(z > 0, z, np.nan)
    local = np.stack([(u + 0.5 - k.cx) / k.fx * z, (v + 0.5 - k.cy) / k.fy * z, z], axis=-1)
    return np.asarray(local @ camera.T_world_camera[:3, :3].T + camera.position)


def camera_of(state: NDArray[Any], described: dict[str, Any]) -> Camera:
    """The camera of a row of the state (7 or more,) [x y z qx qy qz qw ...], by an entry of conventions.json."""
    body = np.eye(4)
    body[:3, :3], body[:3, 3] = Rotation.from_quat(state[3:7]).as_matrix(), state[:3]
    (fx, _, cx), (_, fy, cy), _ = described["K"]
    intrinsics = Intrinsics(described["width"], described["height"], fx, fy, cx, cy)
    return Camera(intrinsics, body @ np.array(described["T_body_camera"]))
