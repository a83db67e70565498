"""Small clouds and cameras that the renderer's tests share."""

import numpy as np

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.splats.cloud import GaussianCloud


def random_cloud(seed: int, count: int, degree: int) -> GaussianCloud:
    """Gaussians round the origin: most of them small, some huge, some needles, some plates, of all opacities."""
    rng = np.random.default_rng(seed)
    scales = np.exp(rng.uniform(np.log(0.005), np.log(0.2), (count, 3)))
    kind = rng.integers(0, 10, count)
    scales[kind == 0] = rng.uniform(0.5, 3, (np.sum(kind == 0), 3))
    scales[kind == 1] = [1.5, 0.001, 0.001]
    scales[kind == 2] = [0.4, 0.4, 1e-5]
    opacities = np.where(kind == 0, rng.uniform(0, 0.2, count), rng.uniform(0, 1, count))
    return GaussianCloud(
        rng.uniform(-3, 3, (count, 3)).astype(np.float32),
        rng.normal(size=(count, 4)).astype(np.float32),
        scales.astype(np.float32),
        opacities.astype(np.float32),
        rng.normal(0, 0.3, (count, (degree + 1) ** 2, 3)).astype(np.float32),
    )


def cloud_of(*splats: dict, degree: int = 0) -> GaussianCloud:
    """A cloud of hand-made Gaussians; by default an opaque white ball of 10 cm, two metres along +y."""
    ball = {
        "means": [0, 2, 0],
        "quaternions": [0, 0, 0, 1],
        "scales": [0.1] * 3,
        "opacities": 1,
        "sh": np.full(((degree + 1) ** 2, 3), 0.5 / 0.28209479),
    }
    rows = [{**ball, **splat} for splat in splats]
    return GaussianCloud(**{name: np.array([row[name] for row in rows], np.float32) for name in ball})


def camera(position=(0, 0, 0), direction=(0, 1, 0), width=96, height=72, fov=1.4) -> Camera:
    return Camera(Intrinsics.from_horizontal_fov(width, height, fov), look_along(position, direction))
