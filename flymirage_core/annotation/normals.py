"""Surface normals of fused points, by principal components of each point's neighbourhood."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Float32 = NDArray[np.float32]

MIN_NEIGHBOURS: Final = 5
"""Points with fewer, themselves included, get the zero vector."""
BATCH: Final = 100_000
"""Points at a time, which bounds the memory."""


def surface_normals(points: Float32, to_camera: Float32, radius: float, neighbours: int) -> Float32:
    """(N, 3) unit normals on the side that the cameras saw, or zero where too few points are near.

    Args:
        points: (N, 3) metres.
        to_camera: (N, 3) mean direction to the cameras that saw each point.
        radius: metres within which points are neighbours.
        neighbours: most that are used.
    """
    normals = np.zeros((len(points), 3), np.float32)
    if len(points) < MIN_NEIGHBOURS:
        return normals
    tree = cKDTree(points)
    for first in range(0, len(points), BATCH):
        part = slice(first, first + BATCH)
        distances, index = tree.query(points[part], k=neighbours, distance_upper_bound=radius)  # (B, k)
        found = np.isfinite(distances)
        counts = found.sum(axis=1)  # (B,)
        near = points[np.where(found, index, 0)]  # (B, k, 3)
        mean = (near * found[..., None]).sum(axis=1) / counts[:, None]
        spread = (near - mean[:, None]) * found[..., None]
        _, vectors = np.linalg.eigh(np.swapaxes(spread, 1, 2) @ spread)  # (B, 3, 3) ascending
        normal = vectors[:, :, 0]
        normal *= np.where((normal * to_camera[part]).sum(axis=1) < 0, -1, 1)[:, None]
        normals[part] = np.where((counts >= MIN_NEIGHBOURS)[:, None], normal, 0)
    return normals
