"""Rays against triangles: Embree through `embreex`, and nothing else of it anywhere."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

Float = NDArray[np.float64]

NEVER: Final = 1e6
"""Metres: further than anything."""
BATCH: Final = 1_000_000
"""Rays that are cast at once; bounds the memory."""


@dataclass(frozen=True, eq=False)
class Hits:
    """Where N rays end: face (-1: nowhere), distance in ray lengths, barycentric weights of the face's corners."""

    face: NDArray[np.int64]  # (N,)
    distance: Float  # (N,)
    weights: Float  # (N, 3)


class RayCaster:
    """Asks whether and where rays meet triangles (F, 3, 3). Directions are units, lengths metres."""

    def __init__(self, triangles: NDArray[np.floating]) -> None:
        self.empty = len(triangles) == 0
        self.scene = EmbreeScene()
        if not self.empty:
            TriangleMesh(self.scene, np.ascontiguousarray(triangles, np.float32))

    def occluded(self, origins: Float, directions: Float, reach: Float) -> NDArray[np.bool_]:
        """(N,) True where something lies within ``reach`` (N,) metres from ``origins`` (N, 3)."""
        result = np.zeros(len(origins), bool)
        if self.empty:
            return result
        for part in _batches(len(origins)):
            far = np.ascontiguousarray(reach[part], np.float32)
            result[part] = self.scene.run(*_rays(origins, directions, part), dists=far, query="OCCLUDED") >= 0
        return result

    def hits(self, origins: Float, directions: Float) -> Hits:
        """The first hit of each ray; ``distance`` is `NEVER` where there is none."""
        count = len(origins)
        face, distance, weights = np.full(count, -1), np.full(count, NEVER), np.zeros((count, 3))
        if self.empty:
            return Hits(face, distance, weights)
        for part in _batches(count):
            found = self.scene.run(*_rays(origins, directions, part), output=True)
            face[part] = found["primID"]
            distance[part] = np.minimum(found["tfar"], NEVER)
            weights[part] = np.stack([1 - found["u"] - found["v"], found["u"], found["v"]], axis=1)
        return Hits(face, distance, weights)


def _batches(count: int) -> list[slice]:
    return [slice(start, min(start + BATCH, count)) for start in range(0, count, BATCH)]


def _rays(origins: Float, directions: Float, part: slice) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    return np.ascontiguousarray(origins[part], np.float32), np.ascontiguousarray(directions[part], np.float32)
