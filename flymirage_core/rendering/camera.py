"""Pinhole cameras. OpenCV axes: x right, y down, z forward; a pose is T_world_camera (4x4, camera to world)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float64 = NDArray[np.float64]


@dataclass(frozen=True)
class Intrinsics:
    """A pinhole without distortion; pixel centres lie at +0.5. All in pixels."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    @staticmethod
    def from_horizontal_fov(width: int, height: int, fov: float) -> "Intrinsics":
        """Square pixels, principal point in the middle; ``fov`` in radians."""
        f = width / (2.0 * np.tan(fov / 2.0))
        return Intrinsics(width, height, f, f, width / 2.0, height / 2.0)

    @property
    def matrix(self) -> Float64:
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])  # (3, 3)


@dataclass(frozen=True, eq=False)
class Camera:
    """Where a picture is taken from. ``T_world_camera`` maps camera coordinates to the world frame (z up, metres)."""

    intrinsics: Intrinsics
    T_world_camera: Float64  # (4, 4)

    @property
    def position(self) -> Float64:
        return self.T_world_camera[:3, 3]  # (3,)

    @property
    def forward(self) -> Float64:
        return self.T_world_camera[:3, 2]  # (3,) unit

    @cached_property
    def T_camera_world(self) -> Float64:  # noqa: N802 - the field's name for it
        rotation = self.T_world_camera[:3, :3].T
        inverse = np.eye(4)
        inverse[:3, :3] = rotation
        inverse[:3, 3] = -rotation @ self.position
        return inverse  # (4, 4)

    def project(self, points: ArrayLike) -> tuple[Float64, Float64]:
        """Pixels (N, 2) and z-depth (N,) in metres of world ``points`` (N, 3); pixels are NaN where depth <= 0."""
        local = np.atleast_2d(np.asarray(points, float)) @ self.T_camera_world[:3, :3].T + self.T_camera_world[:3, 3]
        depth = local[:, 2]
        safe = np.where(depth > 0, depth, np.nan)
        k = self.intrinsics
        pixels = np.stack([k.fx * local[:, 0] / safe + k.cx, k.fy * local[:, 1] / safe + k.cy], axis=1)
        return pixels, depth


def look_along(position: ArrayLike, direction: ArrayLike) -> Float64:
    """T_world_camera (4, 4) at ``position`` looking along ``direction`` (any length), upright against world +z.

    Looking straight up or down, the image's up is world +y (the paper's yaw zero).
    """
    forward = np.asarray(direction, float)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    if np.linalg.norm(right) < 1e-9:
        right = np.array([1.0, 0.0, 0.0])
    right = right / np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, np.cross(forward, right), forward, position
    return pose
