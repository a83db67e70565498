"""The picture that splats should give: the mesh ray-traced, materials and baked light evaluated at every pixel."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera
from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.sampling import LitWorld, light_unit

Float = NDArray[np.float64]

LAYERS: Final = 4
"""Panes of glass that one pixel sees through."""
STEP: Final = 1e-3
"""Metres past a pane at which its ray goes on."""


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
        k = camera.intrinsics
        u = (np.arange(k.width * samples) + 0.5) / samples
        v = (np.arange(k.height * samples) + 0.5) / samples
        x, y = np.meshgrid((u - k.cx) / k.fx, (v - k.cy) / k.fy)
        local = np.stack([x, y, np.ones_like(x)], axis=2).reshape(-1, 3)
        rays = local @ camera.T_world_camera[:3, :3].T
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        colours = self.colours(np.tile(camera.position, (len(rays), 1)), rays)
        return np.asarray(colours.reshape(k.height, samples, k.width, samples, 3).mean(axis=(1, 3)))

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
            result[active] += (left[active] * opacity)[:, None] * self._surface(points, faces, weights, rays[active])
            left[active] *= 1 - opacity
            origins = origins.copy()
            origins[active] = points + STEP * rays[active]
            active = active[left[active] > 0.02]
        return result

    def _surface(self, points: Float, faces: NDArray[np.int64], weights: Float, rays: Float) -> Float:
        normals = self.normals[faces]
        normals = normals * -np.sign((normals * rays).sum(axis=1))[:, None]
        albedo = self.world.mesh.albedo(faces, weights)
        glow = self.world.mesh.emission(faces)[:, None] * light_unit(self.world.light)
        light = self.world.light.through(points, normals, self.world.mesh.leaves[self.world.mesh.face_part[faces]])
        return self.world.light.seen(albedo * (light / np.pi + glow))
