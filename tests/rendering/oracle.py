"""Gaussian splatting as its formulas say it, Gaussian by Gaussian in float64: slow, obvious, the kernels' measure."""

import numpy as np
from scipy.spatial.transform import Rotation

from flymirage_core.rendering.camera import Camera
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.spherical_harmonics import sh_basis


def splat(cloud: GaussianCloud, camera: Camera) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """RGB (H, W, 3), expected z-depth (H, W) and alpha (H, W) on black, by gsplat's constants and order."""
    k, W = camera.intrinsics, camera.T_camera_world[:3, :3]
    means = cloud.means.astype(float)
    points = means @ W.T + camera.T_camera_world[:3, 3]
    directions = means - camera.position
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    basis = sh_basis(directions, cloud.sh_degree)
    colours = np.maximum(0.5 + np.einsum("nk,nkc->nc", basis, cloud.sh.astype(float)), 0)
    axes = Rotation.from_quat(cloud.quaternions).as_matrix() * cloud.scales.astype(float)[:, None, :]
    covariances = W @ (axes @ axes.transpose(0, 2, 1)) @ W.T

    light = np.ones((k.height, k.width))
    open_ = np.ones((k.height, k.width), bool)
    rgb, depth = np.zeros((k.height, k.width, 3)), np.zeros((k.height, k.width))
    for i in np.argsort(points[:, 2].astype(np.float32), kind="stable"):
        x, y, z = points[i]
        if not 0.01 <= z <= 1e10:
            continue
        tx = z * np.clip(x / z, -k.cx / k.fx - 0.15 * k.width / k.fx, (k.width - k.cx) / k.fx + 0.15 * k.width / k.fx)
        ty = z * np.clip(
            y / z, -k.cy / k.fy - 0.15 * k.height / k.fy, (k.height - k.cy) / k.fy + 0.15 * k.height / k.fy
        )
        J = np.array([[k.fx / z, 0, -k.fx * tx / z**2], [0, k.fy / z, -k.fy * ty / z**2]])
        covariance = J @ covariances[i] @ J.T + 0.3 * np.eye(2)
        reach = 3.4 * np.sqrt(np.diag(covariance)) + 1  # opacity exp(-3.4^2 / 2) is less than 1 / 255
        u, v = k.fx * x / z + k.cx, k.fy * y / z + k.cy
        columns = slice(max(0, int(min(u - reach[0], k.width))), max(0, int(min(u + reach[0] + 1, k.width))))
        rows = slice(max(0, int(min(v - reach[1], k.height))), max(0, int(min(v + reach[1] + 1, k.height))))
        dy, dx = np.mgrid[rows, columns] + 0.5 - np.array([v, u])[:, None, None]
        conic = np.linalg.inv(covariance)
        power = 0.5 * (conic[0, 0] * dx**2 + conic[1, 1] * dy**2) + conic[0, 1] * dx * dy
        alpha = np.minimum(0.99, cloud.opacities[i] * np.exp(-power))
        touched = open_[rows, columns] & (alpha >= 1 / 255)
        stopped = touched & (light[rows, columns] * (1 - alpha) <= 1e-4)
        open_[rows, columns] &= ~stopped
        weight = np.where(touched & ~stopped, alpha * light[rows, columns], 0)
        rgb[rows, columns] += weight[..., None] * colours[i]
        depth[rows, columns] += weight * z
        light[rows, columns] -= weight
    return rgb, depth / np.maximum(1 - light, 1e-10), 1 - light
