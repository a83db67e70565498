"""The picture that splats should give: the mesh ray-traced, materials and baked light evaluated at every pixel."""

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera
from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.sampling import LitWorld, light_unit

Float = NDArray[np.float64]

LAYERS: Final = 4
"""Panes of glass that one pixel sees through."""
STEP: Final = 1e-3
"""Metres past a pane at which its ray goes on."""
CELL: Final = 0.011
"""Radians: the width of a cell that is lit as one, as seen from the eye."""
FACINGS: Final = 3
"""Steps between facing along and facing across an axis, in telling cells apart."""
HASH: Final = np.random.default_rng(0).integers(2**62, size=8) | 1
"""Odd factors that make one number of a cell's eight."""


class ReferenceTracer:
    """Ray-traced pictures of one lit world."""

    def __init__(self, world: LitWorld) -> None:
        self.world = world
        triangles = world.mesh.vertices[world.mesh.faces]  # (F, 3, 3)
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        self.normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        self.caster = RayCaster(triangles)

    def render(self, camera: Camera, samples: int) -> Float:
        """(H, W, 3) display colours in [0, 1]: the mean of ``samples`` x ``samples`` rays a pixel."""
        k, rays = camera.intrinsics, _rays(camera, samples)
        colours = self.colours(np.tile(camera.position, (len(rays), 1)), rays)
        return np.asarray(colours.reshape(k.height, samples, k.width, samples, 3).mean(axis=(1, 3)))

    def pictures(self, cameras: list[Camera]) -> list[NDArray[np.float32]]:
        """Each (H, W, 3), one ray a pixel; all are traced at once."""
        rays = [_rays(camera, 1) for camera in cameras]
        origins = [np.tile(c.position, (len(r), 1)) for c, r in zip(cameras, rays, strict=True)]
        colours = self.colours(np.concatenate(origins), np.concatenate(rays)).astype(np.float32)
        ends = np.cumsum([len(r) for r in rays])
        sizes = [(c.intrinsics.height, c.intrinsics.width, 3) for c in cameras]
        return [part.reshape(size) for part, size in zip(np.split(colours, ends[:-1]), sizes, strict=True)]

    def colours(self, origins: Float, rays: Float) -> Float:
        """(N, 3) what unit ``rays`` from ``origins`` (N, 3) see."""
        result, left = np.zeros((len(rays), 3)), np.ones(len(rays))
        active = np.arange(len(rays))
        for _ in range(LAYERS):
            hits = self.caster.hits(origins[active], rays[active])
            missed = active[hits.face < 0]
            result[missed] += left[missed, None] * self.world.light.seen_sky(rays[missed])
            met = hits.face >= 0
            active, faces, distance, weights = active[met], hits.face[met], hits.distance[met], hits.weights[met]
            if len(active) == 0:
                break
            points = origins[active] + distance[:, None] * rays[active]
            opacity = self.world.mesh.opacity(faces)
            result[active] += (left[active] * opacity)[:, None] * self._surface(
                points, faces, weights, rays[active], distance
            )
            left[active] *= 1 - opacity
            origins = origins.copy()
            origins[active] = points + STEP * rays[active]
            active = active[left[active] > 0.02]
        return result

    def _surface(self, points: Float, faces: NDArray[np.int64], weights: Float, rays: Float, distance: Float) -> Float:
        normals = self.normals[faces]
        normals = normals * -np.sign((normals * rays).sum(axis=1))[:, None]
        albedo = self.world.mesh.albedo(faces, weights)
        glow = self.world.mesh.emission(faces)[:, None] * light_unit(self.world.light)
        light = self._light(points, normals, self.world.mesh.face_part[faces], distance)
        return self.world.light.seen(albedo * (light / np.pi + glow))

    def _light(self, points: Float, normals: Float, parts: NDArray[np.int64], distance: Float) -> Float:
        """(N, 3) irradiance of ``points`` (N, 3) on ``parts`` (N,), ``distance`` (N,) metres from the eye."""
        return self.world.light.through(points, normals, self.world.mesh.leaves[parts])


def _rays(camera: Camera, samples: int) -> Float:
    """(H S W S, 3) unit rays through the middles of S x S parts of each pixel, by rows."""
    k = camera.intrinsics
    u = (np.arange(k.width * samples) + 0.5) / samples
    v = (np.arange(k.height * samples) + 0.5) / samples
    x, y = np.meshgrid((u - k.cx) / k.fx, (v - k.cy) / k.fy)
    rays = np.stack([x, y, np.ones_like(x)], axis=2).reshape(-1, 3) @ camera.T_world_camera[:3, :3].T
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))


class SharedLightTracer(ReferenceTracer):
    """Lights one place of each small cell of a surface and takes it for the whole cell: a third of the time a ray.

    Cells are `CELL` wide as seen from the eye, one part's, and faced alike. Shadows' edges are that much blurred.
    """

    def _light(self, points: Float, normals: Float, parts: NDArray[np.int64], distance: Float) -> Float:
        level = np.round(np.log2(np.maximum(distance, 1e-3)))
        cells = np.column_stack([points / (CELL * np.exp2(level))[:, None], FACINGS * normals, level, parts])
        hashes = np.rint(cells).astype(np.int64) @ HASH  # (N,); collisions are rarer than 1 in 10^7
        cell, _ = pd.factorize(hashes)
        first = np.empty(cell.max(initial=-1) + 1, np.int64)
        first[cell[::-1]] = np.arange(len(cell))[::-1]
        light = super()._light(points[first], normals[first], parts[first], distance[first])
        return np.asarray(light[cell])
