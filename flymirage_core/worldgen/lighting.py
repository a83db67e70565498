"""Baked light: lamps and windows with soft shadows, two bounces through probes, and contact shading. Linear RGB throughout.

The room is a signed-distance field on a voxel grid, made from its surfels; shadows and gathers are rays stepped through it.
Direct light is evaluated at every surfel. What it makes of the voxels' radiance is gathered at a lattice of probes (ambient
cubes: irradiance along the six axes), which surfels interpolate; the second round adds the second bounce.
"""

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from flymirage_core.worldgen.surfaces import Surfels

Float = NDArray[np.float64]
Float32 = NDArray[np.float32]

VOXEL = 0.06
"""Metres, of the distance field."""
PROBE_SPACING = 0.3
GATHER_RAYS = 96
"""Rays from each probe, on a Fibonacci sphere."""
BOUNCES = 2
SHADOW_START = 0.09
"""Metres along the normal at which a surfel's rays begin, clear of its own voxels."""
PENUMBRA = 7.0
"""Sharpness of shadows: the share of light is PENUMBRA * clearance / distance."""
LIGHT_RADIUS = 0.3
"""Shadow rays end this far from a lamp, so that its shade does not hide it."""
DAYLIGHT = np.array([0.97, 1.0, 1.05])
LAMPLIGHT = np.array([1.0, 0.9, 0.76])
WINDOW_RADIANCE = 5.5
"""Of the sky, in the unit in which a white lamp shade of emission 1 has radiance 1."""
LAMP_BOOST = 9.0
"""A lamp gives this many times the light that its visible shade alone would."""
CONTACT = ((0.10, 0.35), (0.18, 0.3), (0.32, 0.2), (0.55, 0.15))
"""Distances along the normal and weights at which the field is asked how open the place is."""
MID_GREY = 0.24
"""Median radiance after exposure."""
WHITE = 3.5
"""Radiance, after exposure, that becomes pure white."""


@dataclass(frozen=True, eq=False)
class Lights:
    """L small light sources: position, normal (zero: shines all round), and radiant intensity."""

    positions: Float  # (L, 3)
    normals: Float  # (L, 3)
    intensities: Float  # (L, 3)


@dataclass(frozen=True, eq=False)
class Field:
    """Distance to the nearest surface (metres) at voxel centres; ``origin`` is the first voxel's centre."""

    distance: Float32  # (X, Y, Z)
    origin: Float  # (3,)

    def index(self, points: Float) -> NDArray[np.intp]:
        """(N, 3) the voxel that holds each point, clipped to the grid."""
        raw = np.rint((points - self.origin) / VOXEL).astype(np.intp)
        return np.clip(raw, 0, np.array(self.distance.shape) - 1)


def lit_colours(surfels: Surfels, lights: Lights, dimensions: tuple[float, float, float]) -> Float:
    """Display colours (N, 3) in [0, 1], sRGB coded: direct light, two bounces, contact shading, exposure, tone curve."""
    field = distance_field(surfels, dimensions)
    direct = _direct(
        surfels.points,
        surfels.normals,
        lights.positions,
        lights.normals,
        lights.intensities,
        field.distance,
        field.origin,
    )
    openness = _openness(surfels, field)
    glow = surfels.albedo * surfels.emission[:, None]
    irradiance = direct
    for _ in range(BOUNCES):
        gathered = _gather(surfels, surfels.albedo * irradiance / np.pi, field, dimensions)
        irradiance = direct * (0.6 + 0.4 * openness[:, None]) + gathered * openness[:, None]
    return display(glow + surfels.albedo * irradiance / np.pi)


def distance_field(surfels: Surfels, dimensions: tuple[float, float, float]) -> Field:
    """The field of a closed room with the floor's middle at the origin; outside of it is solid."""
    x, y, z = dimensions
    origin = np.array([-x / 2, -y / 2, 0.0]) - 1.5 * VOXEL
    shape = np.ceil((np.array([x, y, z]) + 3 * VOXEL) / VOXEL).astype(int) + 1
    empty = Field(np.zeros(shape, np.float32), origin)
    solid = np.zeros(shape, bool)
    solid[tuple(empty.index(surfels.points).T)] = True
    axes = [origin[i] + VOXEL * np.arange(shape[i]) for i in range(3)]
    for axis, (low, high) in enumerate([(-x / 2, x / 2), (-y / 2, y / 2), (0.0, z)]):
        outside = (axes[axis] < low) | (axes[axis] > high)
        solid[(slice(None),) * axis + (outside,)] = True
    distance = ndimage.distance_transform_edt(~solid, sampling=VOXEL) - 0.5 * VOXEL
    return Field(np.maximum(distance, 0.0).astype(np.float32), origin)


def display(radiance: Float) -> Float:
    """Exposure to `MID_GREY`, an extended Reinhard curve on luminance, sRGB coding."""
    luminance = radiance @ [0.2126, 0.7152, 0.0722]
    exposed = radiance * (MID_GREY / max(float(np.median(luminance)), 1e-9))
    y = np.maximum(exposed @ [0.2126, 0.7152, 0.0722], 1e-9)
    mapped = y * (1 + y / WHITE**2) / (1 + y)
    colour = np.clip(exposed * (1.32 * mapped / y)[:, None], 0.0, 1.0)
    return np.where(colour <= 0.0031308, 12.92 * colour, 1.055 * np.maximum(colour, 1e-9) ** (1 / 2.4) - 0.055)


def _openness(surfels: Surfels, field: Field) -> Float:
    """(N,) how little the surroundings close in on a surfel: 1 in the open, towards 0 in a corner."""
    total = np.zeros(len(surfels))
    for reach, weight in CONTACT:
        at = (surfels.points + surfels.normals * reach - field.origin) / VOXEL
        distance = ndimage.map_coordinates(field.distance, at.T, order=1, mode="nearest")
        total += weight * np.clip((distance + 0.4 * VOXEL) / reach, 0.0, 1.0)
    return 0.15 + 0.85 * total


def _gather(surfels: Surfels, radiance: Float, field: Field, dimensions: tuple[float, float, float]) -> Float:
    """Indirect irradiance (N, 3) from the surfels' own ``radiance`` (N, 3), by way of probes."""
    voxels = field.index(surfels.points)
    flat = np.ravel_multi_index(tuple(voxels.T), field.distance.shape)
    size = field.distance.size
    count = np.bincount(flat, minlength=size)
    mean = np.stack([np.bincount(flat, radiance[:, c], size) for c in range(3)], 1) / np.maximum(count, 1)[:, None]
    glowing = mean.astype(np.float32).reshape(*field.distance.shape, 3)
    counts = np.maximum(2, np.ceil(np.array(dimensions) / PROBE_SPACING).astype(int))
    low = np.array([-dimensions[0] / 2, -dimensions[1] / 2, 0.0]) + 0.1
    step = (np.array(dimensions) - 0.2) / (counts - 1)
    cubes, valid = _probes(counts, low, step, glowing, field.distance, field.origin, _sphere(GATHER_RAYS))
    at = ((surfels.points + 0.12 * surfels.normals - low) / step).T  # (3, N)
    weight = np.maximum(ndimage.map_coordinates(valid, at, order=1, mode="nearest"), 1e-3)
    total = np.zeros((len(surfels), 3))
    for axis in range(3):
        facing = surfels.normals[:, axis]
        for side, chosen in ((2 * axis, facing > 0), (2 * axis + 1, facing <= 0)):
            where = at[:, chosen]
            for c in range(3):
                value = ndimage.map_coordinates(cubes[..., side, c], where, order=1, mode="nearest")
                total[chosen, c] += facing[chosen] ** 2 * value / weight[chosen]
    return total


def _sphere(count: int) -> Float:
    """Even directions (count, 3): a Fibonacci sphere."""
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    angle = np.pi * (1 + 5**0.5) * i
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


@numba.njit(cache=True, nogil=True)
def _distance_at(field: Float32, x: float, y: float, z: float) -> float:
    """Trilinear, in voxel units of position; 0 outside."""
    nx, ny, nz = field.shape
    if x < 0 or y < 0 or z < 0 or x > nx - 1.001 or y > ny - 1.001 or z > nz - 1.001:
        return 0.0
    i, j, k = int(x), int(y), int(z)
    u, v, w = x - i, y - j, z - k
    a = (field[i, j, k] * (1 - u) + field[i + 1, j, k] * u) * (1 - v)
    a += (field[i, j + 1, k] * (1 - u) + field[i + 1, j + 1, k] * u) * v
    b = (field[i, j, k + 1] * (1 - u) + field[i + 1, j, k + 1] * u) * (1 - v)
    b += (field[i, j + 1, k + 1] * (1 - u) + field[i + 1, j + 1, k + 1] * u) * v
    return a * (1 - w) + b * w


@numba.njit(cache=True, nogil=True)
def _direct(
    points: Float, normals: Float, lamps: Float, facings: Float, powers: Float, field: Float32, origin: Float
) -> Float:
    """Irradiance (N, 3) straight from the lights, with soft shadows."""
    result = np.zeros((len(points), 3))
    for n in range(len(points)):
        p = points[n] + SHADOW_START * normals[n]
        for m in range(len(lamps)):
            d = lamps[m] - p
            far = np.sqrt((d * d).sum())
            d = d / max(far, 1e-6)
            cosine = (d * normals[n]).sum()
            if cosine <= 0.0:
                continue
            face = facings[m]
            if face[0] != 0.0 or face[1] != 0.0 or face[2] != 0.0:
                cosine *= max(-(d * face).sum(), 0.0)
            strength = cosine / (far * far + 0.05)
            if strength * powers[m].max() < 2e-4:
                continue
            share, t, end = 1.0, 0.0, far - LIGHT_RADIUS
            while t < end:
                q = (p + d * t - origin) / VOXEL
                clear = _distance_at(field, q[0], q[1], q[2])
                share = min(share, PENUMBRA * (clear + 0.01) / max(t, 0.25))
                if share < 0.02:
                    share = 0.0
                    break
                t += max(clear, 0.5 * VOXEL)
            result[n] += share * strength * powers[m]
    return result


@numba.njit(cache=True, nogil=True)
def _probes(
    counts: NDArray[np.int64], low: Float, step: Float, glowing: Float32, field: Float32, origin: Float, rays: Float
) -> tuple[Float32, Float32]:
    """Ambient cubes (PX, PY, PZ, 6, 3) of irradiance along +x, -x, +y, -y, +z, -z; zero, and validity 0, inside of solids."""
    cubes = np.zeros((counts[0], counts[1], counts[2], 6, 3), np.float32)
    valid = np.zeros((counts[0], counts[1], counts[2]), np.float32)
    area = 4 * np.pi / len(rays)
    for i in range(counts[0]):
        for j in range(counts[1]):
            for k in range(counts[2]):
                p = (low + step * np.array([i, j, k]) - origin) / VOXEL
                if _distance_at(field, p[0], p[1], p[2]) < 0.5 * VOXEL:
                    continue
                valid[i, j, k] = 1.0
                for r in range(len(rays)):
                    d = rays[r]
                    t = 0.0
                    q = p.copy()
                    for _ in range(80):
                        clear = _distance_at(field, q[0], q[1], q[2])
                        if clear < 0.35 * VOXEL:
                            break
                        t += max(clear / VOXEL, 0.5)
                        q = p + d * t
                    light = _radiance_near(glowing, q)
                    for axis in range(3):
                        side = 2 * axis if d[axis] > 0 else 2 * axis + 1
                        for c in range(3):
                            cubes[i, j, k, side, c] += light[c] * abs(d[axis]) * area
    return cubes, valid


@numba.njit(cache=True, nogil=True)
def _radiance_near(glowing: Float32, q: Float) -> Float:
    """Mean radiance (3,) of the voxels that have any, in the 3x3x3 round a position in voxel units."""
    nx, ny, nz, _ = glowing.shape
    total = np.zeros(3)
    found = 0
    x, y, z = int(np.rint(q[0])), int(np.rint(q[1])), int(np.rint(q[2]))
    for i in range(max(x - 1, 0), min(x + 2, nx)):
        for j in range(max(y - 1, 0), min(y + 2, ny)):
            for k in range(max(z - 1, 0), min(z + 2, nz)):
                v = glowing[i, j, k]
                if v[0] + v[1] + v[2] > 0:
                    found += 1
                    total += v
    return total / max(found, 1)
