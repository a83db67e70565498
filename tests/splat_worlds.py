"""Builders of small splat worlds for the tests."""

import numpy as np

from flymirage_core.splats.cloud import GaussianCloud


def random_cloud(rng, n=50, degree=0):
    quaternions = rng.normal(size=(n, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    return GaussianCloud(
        rng.uniform(-5, 5, (n, 3)).astype(np.float32),
        quaternions.astype(np.float32),
        np.exp(rng.uniform(-6, 0, (n, 3))).astype(np.float32),
        rng.uniform(0.01, 0.99, n).astype(np.float32),
        rng.normal(0, 0.3, (n, (degree + 1) ** 2, 3)).astype(np.float32),
    )


def panel(corner, u, v, step=0.08, opacity=0.9, thickness=0.004):
    """A flat rectangle of flat splats; ``corner`` (3,), sides ``u`` and ``v`` (3,) along two of the axes."""
    corner, u, v = (np.asarray(x, float) for x in (corner, u, v))
    a, b = (max(int(np.ceil(np.linalg.norm(side) / step)), 1) for side in (u, v))
    i, j = (((np.arange(k) + 0.5) / k)[:, None] for k in (a, b))
    means = (corner + (i * u)[:, None] + (j * v)[None]).reshape(-1, 3)
    scales = np.where((u != 0) | (v != 0), 0.7 * step, thickness)
    n = len(means)
    return GaussianCloud(
        means.astype(np.float32),
        np.tile(np.array([0, 0, 0, 1], np.float32), (n, 1)),
        np.tile(scales.astype(np.float32), (n, 1)),
        np.full(n, opacity, np.float32),
        np.zeros((n, 1, 3), np.float32),
    )


def joined(*clouds):
    fields = ("means", "quaternions", "scales", "opacities", "sh")
    return GaussianCloud(*(np.concatenate([getattr(cloud, f) for cloud in clouds]) for f in fields))


def box(low, high, **look):
    """The six faces of a box."""
    (x, y, z), (a, b, c) = low, np.subtract(high, low)
    return joined(
        *(panel(corner, [a, 0, 0], [0, b, 0], **look) for corner in ([x, y, z], [x, y, z + c])),
        *(panel(corner, [a, 0, 0], [0, 0, c], **look) for corner in ([x, y, z], [x, y + b, z])),
        *(panel(corner, [0, b, 0], [0, 0, c], **look) for corner in ([x, y, z], [x + a, y, z])),
    )
