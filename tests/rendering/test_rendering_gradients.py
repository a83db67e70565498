"""The backward pass against finite differences of the forward one."""

from dataclasses import replace

import numpy as np
import pytest
from clouds import camera

from flymirage_core.rendering.cpu import CpuRasterizer, Scratch, SplatTable
from flymirage_core.rendering.gradients import gradients
from flymirage_core.splats.cloud import GaussianCloud

COUNT = 40
SH0 = 0.28209479177387814


def overlapping(seed: int) -> GaussianCloud:
    """Soft coloured ellipsoids, several before each other, none of them full or cut off by the picture's edge."""
    rng = np.random.default_rng(seed)
    return GaussianCloud(
        (rng.uniform([-0.3, 2, -0.25], [0.3, 3, 0.25], (COUNT, 3))).astype(np.float32),
        rng.normal(size=(COUNT, 4)).astype(np.float32),
        rng.uniform(0.04, 0.1, (COUNT, 3)).astype(np.float32),
        rng.uniform(0.2, 0.7, COUNT).astype(np.float32),
        rng.uniform(-1, 1, (COUNT, 1, 3)).astype(np.float32),
    )


def half_squared_error(cloud: GaussianCloud, view, target) -> float:
    seen = next(CpuRasterizer(1).render_float(cloud, [view])).rgb.astype(np.float64)
    return float(((seen - target) ** 2).sum() / 2)


def slope(cloud: GaussianCloud, field: str, change: np.ndarray, view, target) -> float:
    """The loss's directional derivative when ``field`` moves by ``change``."""
    step = 0.01
    ends = [replace(cloud, **{field: (getattr(cloud, field) + s * change).astype(np.float32)}) for s in (step, -step)]
    return (half_squared_error(ends[0], view, target) - half_squared_error(ends[1], view, target)) / (2 * step)


@pytest.fixture(params=[0, 1, 2])
def scene(request):
    cloud, view = overlapping(request.param), camera(width=96, height=80, fov=0.9)
    target = np.random.default_rng(9).uniform(0, 1, (80, 96, 3)).astype(np.float32)
    table = SplatTable.of(cloud)
    found = gradients(table, view, target, Scratch.for_table(table))
    assert sorted(table.file_indices[found.rows]) == list(range(COUNT))
    return cloud, view, target, table, found


def in_file_order(values: np.ndarray, table: SplatTable, found) -> np.ndarray:
    result = np.empty_like(values)
    result[table.file_indices[found.rows]] = values
    return result


def test_the_error_is_the_pictures(scene):
    cloud, view, target, _, found = scene
    assert found.squared_error == pytest.approx(2 * half_squared_error(cloud, view, target), rel=1e-5)


@pytest.mark.parametrize("field", ["sh", "means", "opacities"])
def test_a_gradient_is_the_slope_of_the_loss(scene, field):
    cloud, view, target, table, found = scene
    gradient = {
        "sh": SH0 * found.sums[:, None, :3],
        "means": found.shapes[:, :3],
        "opacities": found.sums[:, 4] / cloud.opacities[table.file_indices[found.rows]],
    }[field]
    gradient = in_file_order(gradient, table, found)
    rng, scale = np.random.default_rng(3), {"sh": 1.0, "means": 0.2, "opacities": 0.5}[field]
    for _ in range(5):
        change = scale * rng.normal(size=gradient.shape)
        if field == "means":
            change[:, 1] = 0  # along the view: what that does to a Gaussian's size is left out
        told, size = float((gradient * change).sum()), float(np.linalg.norm(gradient) * np.linalg.norm(change))
        assert slope(cloud, field, change, view, target) == pytest.approx(told, abs=0.02 * size)


def test_the_gradient_of_half_axes_is_the_slope_of_the_loss_by_extents(scene):
    cloud, view, target, table, found = scene
    own = table.axes[:, found.rows].T.reshape(-1, 3, 3)[:, :2]  # (K, 2, 3)
    by_extent = (found.shapes[:, 3:].reshape(-1, 2, 3) * own).sum(axis=2)  # (K, 2) of the extents' logarithms
    by_extent = in_file_order(by_extent, table, found) / cloud.scales[:, :2]
    change = np.zeros((COUNT, 3))
    change[:, :2] = 0.1 * np.random.default_rng(4).normal(size=(COUNT, 2))
    told = float((by_extent * change[:, :2]).sum())
    size = float(np.linalg.norm(by_extent) * np.linalg.norm(change))
    assert slope(cloud, "scales", change, view, target) == pytest.approx(told, abs=0.02 * size)
