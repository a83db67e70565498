"""The CPU rasterizer against the float64 oracle, and what it promises whatever it is given."""

from pathlib import Path

import numpy as np
import pytest
from clouds import camera, cloud_of, random_cloud
from hypothesis import given, settings
from hypothesis import strategies as st
from oracle import splat

from flymirage_core.rendering import cpu_kernels as kernels
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import CpuRasterizer, FloatPicture
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import read_cloud

FLIP = 1 / 255 + 1e-3
"""A Gaussian whose alpha is within rounding of 1/255 may be drawn by one side and skipped by the other."""


def picture(cloud: GaussianCloud, view: Camera) -> FloatPicture:
    return next(CpuRasterizer(1).render_float(cloud, [view]))


def assert_equal_to_the_oracle(cloud: GaussianCloud, view: Camera) -> None:
    found, (rgb, depth, alpha) = picture(cloud, view), splat(cloud, view)
    error = np.abs(found.rgb - rgb).max(axis=2) / max(rgb.max(), 1)
    assert np.quantile(error, 0.999) < 1e-4 and np.mean(error > 1e-3) < 1e-3 and error.max() < FLIP
    assert np.quantile(np.abs(found.alpha - alpha), 0.999) < 1e-4 and np.abs(found.alpha - alpha).max() < FLIP
    solid = alpha > 0.5
    if solid.any():
        assert np.quantile(np.abs(found.depth - depth)[solid], 0.999) < 1e-3


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_a_cloud_of_all_shapes_seen_from_outside_equals_the_oracle(degree):
    assert_equal_to_the_oracle(random_cloud(degree, 20_000, degree), camera([-4, -6, 2], [0.5, 1, -0.3]))


@pytest.mark.parametrize("seed", range(3))
def test_a_camera_amid_gaussians_behind_it_and_on_the_near_plane_equals_the_oracle(seed):
    direction = np.random.default_rng(seed).normal(size=3)
    assert_equal_to_the_oracle(random_cloud(10 + seed, 2000, 1), camera([0.2, -0.1, 0.3], direction, 81, 61))


@pytest.mark.parametrize(("cx", "cy", "fy"), [(10.0, 50.0, 60.0), (90.0, -5.0, 90.0)])
def test_uneven_intrinsics_equal_the_oracle(cx, cy, fy):
    pose = look_along([-4, -5, 1], [0.6, 1, -0.1])
    assert_equal_to_the_oracle(random_cloud(5, 1500, 0), Camera(Intrinsics(75, 53, 70.0, fy, cx, cy), pose))


@pytest.mark.parametrize("room", ["bedroom_sw_lod2.spz", "family_dining_lod2.spz"])
def test_a_captured_room_equals_the_oracle(captured_worlds: Path, room: str):
    cloud = read_cloud(captured_worlds / room)[::8]
    view = Camera(Intrinsics.from_horizontal_fov(120, 90, 1.4), np.eye(4))
    found, (rgb, depth, alpha) = picture(cloud, view), splat(cloud, view)
    error = np.abs(found.rgb - rgb)
    assert -10 * np.log10(np.mean(error**2)) > 80
    assert np.mean(error < 2 / 255) > 0.995
    assert np.quantile(np.abs(found.depth - depth)[alpha > 0.5], 0.999) < 0.005


def test_the_same_bytes_come_from_one_thread_and_from_two():
    cloud = random_cloud(7, 3000, 1)
    views = [camera([-5, 0, 0], [1, y, 0.1]) for y in np.linspace(-0.5, 0.5, 7)]
    one, two, again = (list(CpuRasterizer(n).render(cloud, views)) for n in (1, 2, 2))
    for a, b, c in zip(one, two, again, strict=True):
        for name in ("rgb", "depth", "alpha"):
            assert getattr(a, name).tobytes() == getattr(b, name).tobytes() == getattr(c, name).tobytes()


def test_gsplats_constants_are_what_they_were():
    found = (kernels.NEAR, kernels.FAR, kernels.BLUR, kernels.MAX_ALPHA, kernels.T_STOP, kernels.EXTENT)
    assert found == (0.01, 1e10, 0.3, 0.99, 1e-4, 3.33) and pytest.approx(1 / 255) == kernels.MIN_ALPHA


def test_depth_is_the_distance_along_the_axis_and_zero_where_hardly_anything_is():
    rendering = next(CpuRasterizer(1).render(cloud_of({"means": [0.5, 2, 0]}), [camera()]))
    assert rendering.depth.max() == pytest.approx(2.0, abs=1e-5)  # not the ray's length
    assert (rendering.depth[rendering.alpha < 0.5] == 0).all()
    assert (rendering.depth[rendering.alpha >= 0.5] > 0).all()


def test_a_ball_appears_where_the_camera_projects_its_centre():
    view = camera([1, -2, 0.5], [0.2, 1, -0.1])
    alpha = next(CpuRasterizer(1).render(cloud_of({"means": [1.5, 1, 0.4]}), [view])).alpha
    rows, columns = np.indices(alpha.shape) + 0.5
    centre = [np.sum(columns * alpha) / alpha.sum(), np.sum(rows * alpha) / alpha.sum()]
    np.testing.assert_allclose(centre, view.project([[1.5, 1, 0.4]])[0][0], atol=0.2)


def test_quaternions_are_xyzw():
    half = np.sqrt(0.5)
    stick = cloud_of({"scales": [0.5, 0.02, 0.02], "quaternions": [0, half, 0, half]})  # x axis turned about y: upright
    alpha = next(CpuRasterizer(1).render(stick, [camera()])).alpha
    assert np.ptp(np.nonzero(alpha > 0.5)[0]) > 3 * np.ptp(np.nonzero(alpha > 0.5)[1])


def test_the_nearer_of_two_balls_hides_the_other_whatever_their_order_in_the_file():
    near, far = {"sh": [[1.5, -2, -2]]}, {"means": [0, 3, 0], "sh": [[-2, -2, 1.5]], "scales": [0.15] * 3}
    for cloud in (cloud_of(near, near, far, far), cloud_of(far, far, near, near)):
        red, _, blue = next(CpuRasterizer(1).render(cloud, [camera()])).rgb[36, 48]
        assert red > 200 and blue < 20


def test_equally_deep_gaussians_are_drawn_in_the_files_order():
    first, second = {"sh": [[1.5, -2, -2]], "means": [0.01, 2, 0]}, {"sh": [[-2, -2, 1.5]], "means": [-0.01, 2, 0]}
    red_first, blue_first = (
        picture(c, camera()).rgb[36, 48] for c in (cloud_of(first, second), cloud_of(second, first))
    )
    assert red_first[0] > red_first[2] and blue_first[2] > blue_first[0]


def test_colour_is_rounded_and_clipped_to_eight_bits():
    cloud = cloud_of({"sh": [[10, 0, -10]]})
    red, green, blue = next(CpuRasterizer(1).render(cloud, [camera()])).rgb[36, 48]
    assert (red, blue) == (255, 0) and green == round(255 * float(picture(cloud, camera()).rgb[36, 48, 1]))


SPOILS = {
    "means": [np.nan, np.inf, -np.inf, 3e38],
    "scales": [np.nan, np.inf, 3e38, -1.0, 0.0],
    "quaternions": [np.nan, np.inf, 0.0, 1e-30],
    "opacities": [np.nan, np.inf, -1.0, 0.0, 2.0],
    "sh": [np.nan, np.inf],
}


@pytest.mark.parametrize(("field", "value"), [(f, v) for f, values in SPOILS.items() for v in values])
def test_a_broken_gaussian_neither_crashes_nor_shows_in_its_neighbours(field, value):
    good = random_cloud(3, 200, 0)
    arrays = {name: np.concatenate([getattr(good, name)[:1], getattr(good, name)]) for name in vars(good)}
    arrays[field][0] = value
    found = picture(GaussianCloud(**arrays), camera([0, -6, 0]))
    assert np.isfinite(found.rgb).all() and np.isfinite(found.depth).all() and np.isfinite(found.alpha).all()
    if not (np.isfinite(value) and field in ("opacities", "scales")):
        np.testing.assert_array_equal(found.rgb, picture(good, camera([0, -6, 0])).rgb)


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.floats(-30, 4), st.floats(-2, 3), st.integers(1, 40), st.integers(1, 40))
def test_any_scale_and_distance_gives_a_finite_picture(seed, log_scale, log_distance, width, height):
    rng = np.random.default_rng(seed)
    splats = [
        {"means": rng.normal(size=3) * 10**log_distance, "scales": 10 ** (log_scale + rng.normal(size=3))}
        for _ in range(20)
    ]
    found = picture(cloud_of(*splats), camera([0, 0, 0], rng.normal(size=3), width, height))
    assert found.rgb.shape == (height, width, 3) and np.isfinite(found.rgb).all() and np.isfinite(found.depth).all()
    assert (found.alpha >= 0).all() and (found.alpha <= 1).all()


def test_an_empty_cloud_and_no_cameras_are_fine():
    empty = random_cloud(0, 3, 0)[:0]
    assert not next(CpuRasterizer(1).render(empty, [camera()])).rgb.any()
    assert list(CpuRasterizer(1).render(random_cloud(0, 3, 0), [])) == []


def test_only_a_few_frames_are_ever_made_ahead_of_the_reader():
    asked = []

    class Watched(list):
        def __iter__(self):
            for view in super().__iter__():
                asked.append(view)
                yield view

    views = Watched([camera()] * 50)
    pictures = CpuRasterizer(2).render(cloud_of({}), views)
    for read in range(1, 11):
        next(pictures)
        assert len(asked) <= read + 4
    pictures.close()
    assert len(asked) < 20
