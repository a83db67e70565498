"""Cameras and where they are put: projection, the paper's orbit, the four-view rig, psi against ENU yaw."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.placements import (
    four_view_rig,
    orbit,
    orbit_direction,
    orbit_pose,
    psi_of_yaw,
    view_intrinsics,
    yaw_of_psi,
)
from flymirage_core.settings import ViewSettings

INTRINSICS = Intrinsics.from_horizontal_fov(320, 240, 1.5)
coordinates = st.floats(-20, 20)
points = st.tuples(coordinates, coordinates, coordinates).map(np.array)
angles = st.floats(-10, 10)
elevations = st.floats(-math.pi / 2, math.pi / 2)


def assert_is_a_pose(pose: np.ndarray) -> None:
    np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-9)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1)
    np.testing.assert_array_equal(pose[3], [0, 0, 0, 1])


@given(points, points)
def test_looking_along_a_direction_gives_an_upright_pose_with_that_forward(position, direction):
    assume(np.linalg.norm(direction) > 1e-3)
    pose = look_along(position, direction)
    assert_is_a_pose(pose)
    np.testing.assert_allclose(pose[:3, 2], direction / np.linalg.norm(direction), atol=1e-9)
    assert pose[2, 0] == pytest.approx(0, abs=1e-9) and pose[2, 1] <= 1e-9  # right is level, down is not up
    np.testing.assert_array_equal(pose[:3, 3], position)


@given(points, points, st.tuples(st.floats(1, 319), st.floats(1, 239)), st.floats(0.1, 30))
def test_a_point_laid_out_along_a_pixels_ray_projects_back_to_it(position, direction, pixel, depth):
    assume(np.linalg.norm(direction) > 1e-3)
    camera = Camera(INTRINSICS, look_along(position, direction))
    ray = np.linalg.solve(INTRINSICS.matrix, [*pixel, 1.0])
    point = camera.T_world_camera @ [*(ray * depth), 1.0]
    pixels, depths = camera.project(point[:3])
    np.testing.assert_allclose(pixels[0], pixel, atol=1e-6)
    assert depths[0] == pytest.approx(depth)


def test_points_behind_the_camera_have_no_pixel():
    pixels, depth = Camera(INTRINSICS, np.eye(4)).project([[0, 0, -1]])
    assert np.isnan(pixels).all() and depth[0] == -1


def test_the_orbit_is_the_papers_formulas():
    settings = ViewSettings(orbit_elevations_deg=(-35.0, 10.0), orbit_yaws=8, orbit_radius=0.1)
    centre = np.array([1.0, 2.0, 1.5])
    cameras, groups = orbit(centre, settings)
    assert groups == ["elevation -35"] * 8 + ["elevation 10"] * 8
    for i, camera in enumerate(cameras):
        psi, theta = 2 * math.pi * (i % 8) / 8, math.radians((-35, 10)[i // 8])
        d = np.array([math.sin(psi) * math.cos(theta), math.cos(psi) * math.cos(theta), math.sin(theta)])
        np.testing.assert_allclose(camera.forward, d, atol=1e-12)
        np.testing.assert_allclose(camera.position, centre - 0.1 * d, atol=1e-12)
        assert camera.intrinsics == view_intrinsics(settings)


@given(points, angles, elevations, st.floats(0.01, 1))
def test_orbit_cameras_look_through_the_centre_upright_at_any_elevation(centre, psi, theta, radius):
    pose = orbit_pose(centre, psi, theta, radius)
    assert_is_a_pose(pose)
    np.testing.assert_allclose(pose[:3, 3] + radius * pose[:3, 2], centre, atol=1e-9)
    assert pose[2, 1] <= 1e-9
    if abs(theta) < math.radians(89):
        np.testing.assert_allclose(pose[:3, :3], look_along(centre, pose[:3, 2])[:3, :3], atol=1e-9)


@pytest.mark.parametrize("elevation", [-90.0, 90.0])
def test_straight_up_and_down_the_yaw_sweep_turns_the_picture(elevation):
    cameras, _ = orbit([0, 0, 1], ViewSettings(orbit_elevations_deg=(elevation,), orbit_yaws=4))
    for camera in cameras:
        assert_is_a_pose(camera.T_world_camera)
        np.testing.assert_allclose(camera.forward, [0, 0, math.copysign(1, elevation)], atol=1e-12)
    rights = [camera.T_world_camera[:3, 0] for camera in cameras]
    np.testing.assert_allclose(rights, [[1, 0, 0], [0, -1, 0], [-1, 0, 0], [0, 1, 0]], atol=1e-12)


@given(angles)
def test_psi_and_enu_yaw_are_one_direction_and_convert_back(psi):
    yaw = yaw_of_psi(psi)
    assert -math.pi < yaw <= math.pi
    np.testing.assert_allclose([math.cos(yaw), math.sin(yaw), 0], orbit_direction(psi, 0.0), atol=1e-9)
    np.testing.assert_allclose(orbit_direction(psi_of_yaw(yaw), 0.0), orbit_direction(psi, 0.0), atol=1e-9)


@given(points, angles)
def test_the_rig_sees_front_left_right_and_back_from_one_place(position, heading):
    front, left, right, back = four_view_rig(position, heading, INTRINSICS)
    np.testing.assert_allclose(front.forward, [math.cos(heading), math.sin(heading), 0], atol=1e-9)
    np.testing.assert_allclose(left.forward, [-math.sin(heading), math.cos(heading), 0], atol=1e-9)
    np.testing.assert_allclose(right.forward, -left.forward, atol=1e-9)
    np.testing.assert_allclose(back.forward, -front.forward, atol=1e-9)
    for camera in (front, left, right, back):
        assert_is_a_pose(camera.T_world_camera)
        np.testing.assert_array_equal(camera.position, position)
