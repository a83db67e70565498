"""Where cameras are put: the paper's inward orbit and its four-view rig (section III-B), and its yaw against ours."""

import math

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.rendering.camera import Camera, Float64, Intrinsics, look_along
from flymirage_core.settings import ViewSettings

RIG_OFFSETS = {"front": 0.0, "left": math.pi / 2, "right": -math.pi / 2, "back": math.pi}
"""Yaw of each camera of the four-view rig against the heading, counter-clockwise, radians; in the rig's order."""


def yaw_of_psi(psi: float) -> float:
    """ENU yaw (counter-clockwise from +x) of the paper's psi (clockwise from +y, seen from above), in (-pi, pi].

    >>> yaw_of_psi(0.0) == math.pi / 2, yaw_of_psi(math.pi / 2)
    (True, 0.0)
    """
    return _wrapped(math.pi / 2 - psi)


def psi_of_yaw(yaw: float) -> float:
    """The paper's psi of an ENU yaw, in (-pi, pi]; inverse of `yaw_of_psi`."""
    return _wrapped(math.pi / 2 - yaw)


def orbit_direction(psi: float, theta: float) -> Float64:
    """The paper's d(psi, theta) (3,): unit, psi from +y towards +x, theta upwards.

    >>> orbit_direction(0.0, 0.0).tolist()
    [0.0, 1.0, 0.0]
    """
    return np.array([math.sin(psi) * math.cos(theta), math.cos(psi) * math.cos(theta), math.sin(theta)])


def orbit(centre: ArrayLike, settings: ViewSettings) -> tuple[list[Camera], list[str]]:
    """The inward orbit: cameras at p = c - r_orb d(psi, theta) that look along d, and a group name for each.

    A whole yaw sweep at each elevation, the elevations in the settings' order. ``centre`` (3,) is c in the world frame.
    """
    intrinsics = view_intrinsics(settings)
    cameras, groups = [], []
    for elevation in settings.orbit_elevations_deg:
        for step in range(settings.orbit_yaws):
            psi = 2 * math.pi * step / settings.orbit_yaws
            cameras.append(Camera(intrinsics, orbit_pose(centre, psi, math.radians(elevation), settings.orbit_radius)))
            groups.append(f"elevation {elevation:g}")
    return cameras, groups


def orbit_pose(centre: ArrayLike, psi: float, theta: float, radius: float) -> Float64:
    """T_world_camera (4, 4) of one camera of the inward orbit. Straight up and down, the image still turns with psi."""
    forward = orbit_direction(psi, theta)
    right = np.array([math.cos(psi), -math.sin(psi), 0.0])
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = right, np.cross(forward, right), forward
    pose[:3, 3] = np.asarray(centre, float) - radius * forward
    return pose


def four_view_rig(position: ArrayLike, heading: float, intrinsics: Intrinsics) -> list[Camera]:
    """Level cameras at ``position`` (3,) to the front, left, right and back of ``heading`` (ENU yaw, radians)."""
    yaws = [heading + offset for offset in RIG_OFFSETS.values()]
    return [Camera(intrinsics, look_along(position, [math.cos(yaw), math.sin(yaw), 0.0])) for yaw in yaws]


def view_intrinsics(settings: ViewSettings) -> Intrinsics:
    """The camera that annotation's pictures are taken with."""
    return Intrinsics.from_horizontal_fov(settings.width, settings.height, math.radians(settings.horizontal_fov_deg))


def _wrapped(angle: float) -> float:
    """``angle`` brought into (-pi, pi]."""
    return math.pi - (math.pi - angle) % (2 * math.pi)
