import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from splat_worlds import box, joined, random_cloud

from flymirage_core.errors import WorldError
from flymirage_core.splats.files import read_cloud
from flymirage_core.splats.frames import (
    Z_UP_FROM,
    MarbleSemantics,
    frame_by_estimate,
    frame_from_marble,
    transformed,
)
from flymirage_core.splats.spherical_harmonics import sh_basis

FROM_Z_UP = {"-y": Z_UP_FROM["-y"].T, "y": Z_UP_FROM["y"].T, "z": np.eye(3)}


def covariances(cloud):
    R = Rotation.from_quat(cloud.quaternions).as_matrix()
    return R @ (cloud.scales.astype(float)[:, :, None] ** 2 * R.transpose(0, 2, 1))


def furnished_room():
    """A room whose origin is c, 1.4 m above its floor, with a table and a bed; z up."""
    shell = box([-2.5, -2, -1.4], [2.5, 2, 1.2])
    return joined(
        shell, box([-1.5, -1, -1.4], [0.5, 0.5, -0.9], step=0.05), box([0.8, 0, -1.4], [1.5, 1, -0.6], step=0.05)
    )


@given(st.integers(0, 2**32 - 1), st.floats(0.1, 10))
@settings(max_examples=30)
def test_turning_and_scaling_a_cloud_turns_and_scales_each_covariance(seed, scale):
    rng = np.random.default_rng(seed)
    cloud, R, t = random_cloud(rng, 10), Rotation.random(random_state=seed).as_matrix(), rng.normal(size=3)
    moved = transformed(cloud, R, scale, t)
    np.testing.assert_allclose(moved.means, scale * cloud.means @ R.T + t, atol=1e-4)
    expected = scale**2 * R @ covariances(cloud) @ R.T
    np.testing.assert_allclose(covariances(moved), expected, rtol=1e-4, atol=1e-5 * scale**2)
    np.testing.assert_allclose(np.linalg.norm(moved.quaternions, axis=1), 1, atol=1e-6)


@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
@settings(max_examples=20)
def test_a_turned_cloud_looks_the_same_from_a_turned_eye(seed, degree):
    rng = np.random.default_rng(seed)
    cloud, R = random_cloud(rng, 4, degree), Rotation.random(random_state=seed).as_matrix()
    directions = rng.normal(size=(9, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    before = np.einsum("mk,nkc->nmc", sh_basis(directions, degree), cloud.sh)
    after = np.einsum("mk,nkc->nmc", sh_basis(directions @ R.T, degree), transformed(cloud, R, 1, np.zeros(3)).sh)
    np.testing.assert_allclose(after, before, atol=1e-5)


def test_sh_basis_is_orthonormal_over_the_sphere():
    n = np.arange(20_000)
    z, a = 1 - (2 * n + 1) / len(n), n * np.pi * (3 - np.sqrt(5))
    directions = np.stack([np.sqrt(1 - z * z) * np.cos(a), np.sqrt(1 - z * z) * np.sin(a), z], axis=1)
    basis = sh_basis(directions, 3)
    np.testing.assert_allclose(4 * np.pi * basis.T @ basis / len(n), np.eye(16), atol=1e-3)


def test_marbles_camera_comes_above_the_ground_and_its_forward_is_plus_y():
    rng = np.random.default_rng(0)
    cloud = random_cloud(rng, 4)
    cloud.means[:] = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1.5 / 1.2, 0]]
    framing = frame_from_marble(cloud, MarbleSemantics(metric_scale_factor=1.2, ground_plane_offset=1.5))
    expected = [[0, 0, 1.5], [0, 1.2, 1.5], [1.2, 0, 1.5], [0, 0, 0]]  # camera, forward, right, ground under it
    np.testing.assert_allclose(framing.cloud.means, expected, atol=1e-6)
    np.testing.assert_allclose(framing.centre, [0, 0, 1.5])
    np.testing.assert_allclose(framing.cloud.scales, 1.2 * cloud.scales, rtol=1e-6)
    half = np.sqrt(0.5)  # map B turns by -90 degrees about x
    turned = (Rotation.from_quat([-half, 0, 0, half]) * Rotation.from_quat(cloud.quaternions)).as_quat()
    assert np.abs((framing.cloud.quaternions * turned).sum(axis=1)).min() > 1 - 1e-6


@pytest.mark.parametrize("factor", [0.0, -1.0, float("nan")])
def test_impossible_scales_are_refused(factor):
    cloud = furnished_room()
    with pytest.raises(WorldError, match="scale"):
        frame_from_marble(cloud, MarbleSemantics(factor, 1.5))
    with pytest.raises(WorldError, match="scale"):
        frame_by_estimate(cloud, "z", factor)


@pytest.mark.parametrize("axis", ["-y", "y", "z"])
def test_up_and_floor_of_a_furnished_room_are_found(axis):
    room = transformed(furnished_room(), FROM_Z_UP[axis], 1.0, np.zeros(3))
    framing = frame_by_estimate(room)
    assert framing.notes["up"] == axis
    np.testing.assert_allclose(framing.centre, [0, 0, 1.4], atol=0.03)
    np.testing.assert_allclose(np.sort(framing.cloud.means[:, 2])[[0, -1]], [0, 2.6], atol=0.03)


def test_a_far_outlier_and_a_sky_do_not_move_the_floor():
    room = transformed(furnished_room(), FROM_Z_UP["-y"], 1.0, np.zeros(3))
    stray = random_cloud(np.random.default_rng(0), 20)
    stray.means[:] *= 100
    stray.scales[:10] = 50
    np.testing.assert_allclose(frame_by_estimate(joined(room, stray)).centre, [0, 0, 1.4], atol=0.03)


def test_an_implausible_ceiling_only_suggests_a_scale():
    small = transformed(furnished_room(), np.eye(3), 0.1, np.zeros(3))
    assert frame_by_estimate(small, "z").notes["scale"] == 1.0
    large = transformed(furnished_room(), np.eye(3), 10.0, np.zeros(3))
    framing = frame_by_estimate(large, "z")
    assert framing.notes["scale"] == 1.0 and framing.notes["suggested_scale"] == pytest.approx(0.1, rel=0.05)
    assert "suggested_scale" not in frame_by_estimate(large, "z", 0.1).notes


def test_a_world_far_from_its_origin_gets_a_centre_in_its_middle():
    room = transformed(furnished_room(), np.eye(3), 1.0, [30, 0, 5])
    framing = frame_by_estimate(room, "z")
    assert framing.notes["centre_source"] == "middle of the world"
    np.testing.assert_allclose(framing.centre, [30, 0, 1.5], atol=0.6)


@pytest.mark.parametrize("name", ["bedroom_sw", "family_dining"])
@pytest.mark.parametrize("axis", ["-y", "y", "z"])
def test_captured_room_stands_on_its_floor_whatever_its_axes(captured_worlds, name, axis):
    room = transformed(
        read_cloud(captured_worlds / f"{name}_lod2.spz"), FROM_Z_UP[axis] @ Z_UP_FROM["-y"], 1.0, np.zeros(3)
    )
    framing = frame_by_estimate(room)
    assert framing.notes["up"] == axis
    np.testing.assert_allclose(framing.centre, [0, 0, 1.6], atol=0.06)
