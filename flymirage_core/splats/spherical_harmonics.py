"""Real spherical harmonics of degree 0 to 3 in the splat files' order and signs, and what a rotation does to them."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

Float64 = NDArray[np.float64]

SAMPLES: Final = 64
"""Directions from which a rotation's matrices are solved; 7 would do for the widest band."""


def sh_basis(directions: Float64, degree: int) -> Float64:
    """Basis values (M, (degree + 1)**2) in unit ``directions`` (M, 3), from the camera to the Gaussian.

    Order and signs (Condon-Shortley phase included) as in 3DGS and gsplat; the constants are the usual normalisations.
    """
    x, y, z = directions.T
    xx, yy, zz = x * x, y * y, z * z
    bands = [[np.full_like(x, 0.28209479177387814)]]
    bands.append([-0.4886025119029199 * y, 0.4886025119029199 * z, -0.4886025119029199 * x])
    bands.append(
        [
            1.0925484305920792 * x * y,
            -1.0925484305920792 * y * z,
            0.31539156525252005 * (2 * zz - xx - yy),
            -1.0925484305920792 * x * z,
            0.5462742152960396 * (xx - yy),
        ]
    )
    bands.append(
        [
            -0.5900435899266435 * y * (3 * xx - yy),
            2.890611442640554 * x * y * z,
            -0.4570457994644658 * y * (4 * zz - xx - yy),
            0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
            -0.4570457994644658 * x * (4 * zz - xx - yy),
            1.445305721320277 * z * (xx - yy),
            -0.5900435899266435 * x * (xx - 3 * yy),
        ]
    )
    return np.stack([value for band in bands[: degree + 1] for value in band], axis=1)


def rotate_sh(sh: NDArray[np.float32], rotation: Float64) -> NDArray[np.float32]:
    """Coefficients (N, K, 3) of the same colours after the scene was turned by ``rotation`` (3, 3).

    In each band the new coefficients are a matrix times the old ones: the one for which the basis in any direction d,
    times it, is the basis in the direction R^T d that d had before. Solved by least squares over sampled directions.
    """
    degree = int(np.sqrt(sh.shape[1])) - 1
    out = sh.copy()
    if degree == 0:
        return out
    directions = np.random.default_rng(0).normal(size=(SAMPLES, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    after, before = sh_basis(directions, degree), sh_basis(directions @ rotation, degree)  # rows: d and R^T d
    for band in range(1, degree + 1):
        own = slice(band**2, (band + 1) ** 2)
        matrix = np.linalg.lstsq(after[:, own], before[:, own], rcond=None)[0]  # (2 band + 1, 2 band + 1)
        out[:, own] = np.einsum("ij,njc->nic", matrix, sh[:, own]).astype(np.float32)
    return out
