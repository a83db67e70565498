"""Fitting splats to traced pictures: nearer to what they picture, flat where they were, and repeatable."""

from dataclasses import replace

import numpy as np
import pytest
from generated_places import flat
from scipy.spatial.transform import Rotation

from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.worldgen import fitting
from flymirage_core.worldgen.assembly import assemble
from flymirage_core.worldgen.fitting import cameras, fitted
from flymirage_core.worldgen.reference import ReferenceTracer, SharedLightTracer
from flymirage_core.worldgen.sampling import lit_world


@pytest.fixture(scope="module")
def place():
    return assemble(flat())


@pytest.fixture(scope="module")
def lit(place):
    return lit_world(place, 40_000)


@pytest.fixture(scope="module")
def fit(place, lit):
    return fitted(lit, place.truth, 60)


@pytest.fixture(scope="module")
def unseen(place, lit):
    """Views that nothing was fitted to, and what they should show."""
    views = cameras(place.truth, 8, np.random.default_rng(123))
    return views, ReferenceTracer(lit).pictures(views)


def psnr(cloud, unseen) -> float:
    views, pictures = unseen
    seen = [p.rgb for p in CpuRasterizer().render_float(cloud, views)]
    return float(-10 * np.log10(np.mean([(np.clip(a, 0, 1) - b) ** 2 for a, b in zip(seen, pictures, strict=True)])))


def test_fitted_splats_show_unseen_views_better(lit, fit, unseen):
    assert psnr(fit, unseen) > psnr(lit.cloud, unseen) + 0.4


def test_depth_hardly_suffers(lit, fit, unseen):
    views, _ = unseen
    tracer = ReferenceTracer(lit)
    errors = []
    for cloud in (lit.cloud, fit):
        error = []
        for view, picture in zip(views, CpuRasterizer().render_float(cloud, views), strict=True):
            k = view.intrinsics
            x, y = np.meshgrid((np.arange(k.width) + 0.5 - k.cx) / k.fx, (np.arange(k.height) + 0.5 - k.cy) / k.fy)
            local = np.stack([x, y, np.ones_like(x)], axis=2).reshape(-1, 3)
            rays = local @ view.T_world_camera[:3, :3].T
            far = np.linalg.norm(rays, axis=1)
            hits = tracer.caster.hits(np.tile(view.position, (len(rays), 1)), rays / far[:, None])
            error.append(np.abs(picture.depth.ravel() - hits.distance / far))
        errors.append(np.concatenate(error))
    before, after = errors
    assert np.median(after) < np.median(before) + 0.005
    assert (after > 0.2).mean() < (before > 0.2).mean() + 0.01


def test_splats_stay_in_their_faces_planes(lit, fit):
    normals = Rotation.from_quat(lit.cloud.quaternions).as_matrix()[:, :, 2]  # (N, 3)
    turned = Rotation.from_quat(fit.quaternions).as_matrix()[:, :, 2]
    shift = fit.means - lit.cloud.means
    assert np.abs((normals * turned).sum(axis=1) - 1).max() < 1e-5
    assert np.abs((normals * shift).sum(axis=1)).max() < 1e-4
    assert (np.linalg.norm(shift, axis=1) <= 0.4 * lit.cloud.scales.max(axis=1) + 1e-5).all()
    assert np.abs(shift).max() > 0.001
    assert (fit.scales[:, 2] == lit.cloud.scales[:, 2]).all()


def test_the_same_world_gives_the_same_bytes_on_any_number_of_cores(place, lit, fit, monkeypatch):
    monkeypatch.setattr(fitting, "usable_cores", lambda: 1)
    again = fitted(lit, place.truth, 60)
    for name in ("means", "quaternions", "scales", "opacities", "sh"):
        assert getattr(again, name).tobytes() == getattr(fit, name).tobytes(), name


def test_without_pictures_nothing_is_fitted(place, lit):
    assert fitted(lit, place.truth, 0) is lit.cloud


def test_splats_that_no_picture_shows_stay_as_they_are(lit, place):
    """A world with a copy of a splat far outside, in nobody's view."""
    away = lit.cloud
    means = away.means.copy()
    means[0] = [0, 0, -500]
    fit = fitted(replace(lit, cloud=replace(away, means=means)), place.truth, 10)
    assert (fit.means[0] == means[0]).all() and (fit.sh[0] == away.sh[0]).all()


def test_light_shared_by_small_cells_is_nearly_the_light_of_each_pixel(lit, unseen):
    views, exact = unseen
    shared = SharedLightTracer(lit).pictures(views)
    error = np.abs(np.stack(shared) - np.stack(exact))
    assert error.mean() < 0.006 and np.quantile(error, 0.95) < 0.03


def test_no_splat_leaves_a_crack(lit, fit, unseen):
    """None shrinks, so that views nearer than those it was fitted to show no gap either."""
    assert (fit.scales >= lit.cloud.scales - 1e-7).all()
    near = [
        replace(v, intrinsics=replace(v.intrinsics, fx=4 * v.intrinsics.fx, fy=4 * v.intrinsics.fy)) for v in unseen[0]
    ]
    lacking = [np.mean([1 - p.alpha for p in CpuRasterizer().render_float(cloud, near)]) for cloud in (lit.cloud, fit)]
    assert lacking[1] < lacking[0] + 0.002
