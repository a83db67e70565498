"""Baked light: lamps and windows with soft shadows, two bounces through probes, and contact shading. Linear RGB.

The room is a distance field on a voxel grid, made from its surfels; shadows and gathers are rays stepped through it
(sphere tracing). Direct light is evaluated at every surfel. The radiance that it gives the voxels is gathered at a
lattice of probes (ambient cubes: irradiance along the six axes), which surfels interpolate; a second round adds the
second bounce.
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
PROBE_INSET = 0.1
"""Metres from the walls to the outermost probes."""
MAX_STEPS = 80
"""Of a probe's ray."""
NEAR_LAMP = 0.2
"""Square metres added to the squared distance to a light: lamps are not points."""
FAINT = 2e-4
"""Irradiance below which a light is not asked for its shadow."""
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
LAMP_BOOST = 5.0
"""A lamp gives this many times the light that its visible shade alone would."""
CONTACT = ((0.10, 0.35), (0.18, 0.3), (0.32, 0.2), (0.55, 0.15))
"""Distances along the normal and weights at which the field is asked how open the place is."""
EXPOSURE = 0.72
"""Of a white surface in the light that half of the room's area exceeds, before the film curve."""
FILM_TOE, FILM_SHOULDER, FILM_SLOPE, FILM_BASE = 0.06, 1.0, 0.34, 0.16
"""A rational curve (x^2 + toe x) / (shoulder x^2 + slope x + base): dark toe, long shoulder, 1 at infinity."""


@dataclass(frozen=True, eq=False)
class Lights:
    """L small light sources: position, normal (zero: shines all round), and radiant intensity."""

    positions: Float  # (L, 3)
    normals: Float  # (L, 3)
    intensities: Float  # (L, 3)


@dataclass(frozen=True, eq=False)
class Field:
    """Distance to the nearest surface (metres) at voxel centres; ``origin`` is the first voxel's centre.

    ``to_things`` leaves out the room's own surfaces: they shade nothing, since the room is convex.
    """

    distance: Float32  # (X, Y, Z)
    to_things: Float32  # (X, Y, Z)
    origin: Float  # (3,)

    def index(self, points: Float) -> NDArray[np.intp]:
        """(N, 3) the voxel that holds each point, clipped to the grid."""
        raw = np.rint((points - self.origin) / VOXEL).astype(np.intp)
        return np.clip(raw, 0, np.array(self.distance.shape) - 1)


def lit_colours(surfels: Surfels, lights: Lights, dimensions: tuple[float, float, float]) -> Float:
    """Display colours (N, 3) in [0, 1], sRGB coded: direct light, bounces, contact shading, exposure, film curve."""
    field = distance_field(surfels, dimensions)
    direct = _direct(
        surfels.points,
        surfels.normals,
        lights.positions,
        lights.normals,
        lights.intensities,
        field.to_things,
        field.origin,
    )
    openness = _openness(surfels, field)
    glow = surfels.albedo * surfels.emission[:, None]
    probes, voxels = Probes.traced(field, dimensions), field.index(surfels.points)
    irradiance = direct
    for _ in range(BOUNCES):
        radiance = _voxel_radiance(surfels.albedo * irradiance / np.pi, voxels, field)
        gathered = probes.irradiance(radiance, surfels.points, surfels.normals)
        irradiance = direct * (0.6 + 0.4 * openness[:, None]) + gathered * openness[:, None]
    order = np.argsort(irradiance.sum(axis=1), kind="stable")
    half = np.searchsorted(np.cumsum(surfels.areas[order]), surfels.areas.sum() / 2)
    usual = float(irradiance[order[half]].mean())
    return display((glow + surfels.albedo * irradiance / np.pi) * (np.pi / max(usual, 1e-9)))


def distance_field(surfels: Surfels, dimensions: tuple[float, float, float]) -> Field:
    """The field of a closed room with the floor's middle at the origin; outside of it is solid."""
    x, y, z = dimensions
    origin = np.array([-x / 2, -y / 2, 0.0]) - 1.5 * VOXEL
    shape = np.ceil((np.array([x, y, z]) + 3 * VOXEL) / VOXEL).astype(int) + 1
    blank = np.zeros(shape, np.float32)
    solid = np.zeros(shape, bool)
    solid[tuple(Field(blank, blank, origin).index(surfels.points).T)] = True
    things = solid.copy()
    for axis, (low, high) in enumerate([(-x / 2, x / 2), (-y / 2, y / 2), (0.0, z)]):
        at = origin[axis] + VOXEL * np.arange(shape[axis])
        solid[(slice(None),) * axis + ((at < low) | (at > high),)] = True
        things[(slice(None),) * axis + ((at < low + VOXEL) | (at > high - VOXEL),)] = False
    return Field(_distance(solid), _distance(things), origin)


def _distance(solid: NDArray[np.bool_]) -> Float32:
    """Metres to the nearest solid voxel's surface, 0 in it; far where nothing is solid."""
    if not solid.any():
        return np.full(solid.shape, 1e3, np.float32)
    distance = ndimage.distance_transform_edt(~solid, sampling=VOXEL) - 0.5 * VOXEL
    return np.maximum(distance, 0.0).astype(np.float32)


def display(radiance: Float) -> Float:
    """sRGB-coded colours (N, 3) of linear ``radiance`` (N, 3), in which a white surface in the usual light has 1.

    Exposure, then a filmic curve for each channel: bright colours grow pale, as on film.
    """
    x = np.maximum(radiance, 0.0) * EXPOSURE
    toe, shoulder = x * (x + FILM_TOE), x * (FILM_SHOULDER * x + FILM_SLOPE) + FILM_BASE
    colour = np.clip(toe / shoulder, 0.0, 1.0)
    return np.where(colour <= 0.0031308, 12.92 * colour, 1.055 * np.maximum(colour, 1e-9) ** (1 / 2.4) - 0.055)


def _openness(surfels: Surfels, field: Field) -> Float:
    """(N,) how little the surroundings close in on a surfel: 1 in the open, towards 0 in a corner."""
    total = np.zeros(len(surfels))
    for reach, weight in CONTACT:
        at = (surfels.points + surfels.normals * reach - field.origin) / VOXEL
        distance = ndimage.map_coordinates(field.distance, at.T, order=1, mode="nearest")
        total += weight * np.clip((distance + 0.4 * VOXEL) / reach, 0.0, 1.0)
    return 0.1 + 0.9 * total**1.5


@dataclass(frozen=True, eq=False)
class Probes:
    """A lattice of light probes: which voxel each of their rays sees."""

    counts: NDArray[np.int64]  # (3,)
    low: Float  # (3,) the first probe, metres
    step: Float  # (3,)
    rays: Float  # (R, 3)
    hits: NDArray[np.int32]  # (P, R) flat voxel index, -1 in solids

    @staticmethod
    def traced(field: Field, dimensions: tuple[float, float, float]) -> "Probes":
        counts = np.maximum(2, np.ceil(np.array(dimensions) / PROBE_SPACING).astype(np.int64))
        low = np.array([-dimensions[0] / 2, -dimensions[1] / 2, 0.0]) + PROBE_INSET
        step = (np.array(dimensions) - 2 * PROBE_INSET) / (counts - 1)
        rays = _sphere(GATHER_RAYS)
        return Probes(counts, low, step, rays, _trace(low, step, counts, field.distance, field.origin, rays))

    def irradiance(self, radiance: Float, points: Float, normals: Float) -> Float:
        """Irradiance (N, 3) at points with normals, when voxels have ``radiance`` (V, 3): ambient cubes."""
        inside = self.hits[:, 0] >= 0  # (P,)
        seen = radiance[np.maximum(self.hits, 0)]  # (P, R, 3)
        facing = np.maximum(np.concatenate([self.rays, -self.rays], 1), 0.0) * (4 * np.pi / len(self.rays))  # (R, 6)
        cubes = np.einsum("prc,rs->psc", seen * inside[:, None, None], facing)  # (P, 6, 3)
        cubes = cubes.reshape(*self.counts, 6, 3)
        at = ((points + 0.12 * normals - self.low) / self.step).T  # (3, N)
        known = ndimage.map_coordinates(inside.astype(float).reshape(self.counts), at, order=1, mode="nearest")
        total = np.zeros((len(points), 3))
        for axis in range(3):
            for side, chosen in ((axis, normals[:, axis] > 0), (axis + 3, normals[:, axis] <= 0)):
                share = normals[chosen, axis] ** 2 / np.maximum(known[chosen], 1e-3)
                for c in range(3):
                    value = ndimage.map_coordinates(cubes[..., side, c], at[:, chosen], order=1, mode="nearest")
                    total[chosen, c] += share * value
        return total


def _voxel_radiance(radiance: Float, voxels: NDArray[np.intp], field: Field) -> Float:
    """(V, 3) mean radiance of the surfels in each voxel; a voxel without any takes the mean of its neighbours."""
    shape = field.distance.shape
    flat = np.ravel_multi_index(tuple(voxels.T), shape)
    count = np.bincount(flat, minlength=field.distance.size).astype(float).reshape(shape)
    sums = [np.bincount(flat, radiance[:, c], field.distance.size).reshape(shape) for c in range(3)]
    near = ndimage.uniform_filter(np.minimum(count, 1.0), 3, mode="constant")
    result = []
    for total in sums:
        own = total / np.maximum(count, 1.0)
        spread = ndimage.uniform_filter(own, 3, mode="constant") / np.maximum(near, 1e-9)
        result.append(np.where(count > 0, own, np.where(near > 1e-6, spread, 0.0)).ravel())
    return np.stack(result, axis=1)


def _sphere(count: int) -> Float:
    """Even directions (count, 3): a Fibonacci sphere."""
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    angle = np.pi * (1 + 5**0.5) * i
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


@numba.njit(cache=True, nogil=True)
def _distance_at(field: Float32, x: float, y: float, z: float) -> float:
    """Trilinear distance in metres at a position in voxel units; 0 outside."""
    nx, ny, nz = field.shape
    if x < 0 or y < 0 or z < 0 or x > nx - 1.001 or y > ny - 1.001 or z > nz - 1.001:
        return 0.0
    i, j, k = int(x), int(y), int(z)
    u, v, w = x - i, y - j, z - k
    a = (field[i, j, k] * (1 - u) + field[i + 1, j, k] * u) * (1 - v)
    a += (field[i, j + 1, k] * (1 - u) + field[i + 1, j + 1, k] * u) * v
    b = (field[i, j, k + 1] * (1 - u) + field[i + 1, j, k + 1] * u) * (1 - v)
    b += (field[i, j + 1, k + 1] * (1 - u) + field[i + 1, j + 1, k + 1] * u) * v
    return float(a * (1 - w) + b * w)


@numba.njit(cache=True, nogil=True)
def _lit_share(
    field: Float32, x: float, y: float, z: float, dx: float, dy: float, dz: float, far: float, slope: float
) -> float:
    """Share of a small light seen from (x, y, z), in voxel units, along the unit direction d over ``far`` metres.

    ``slope`` is how fast the ray leaves the plane of its surface: the cosine to its normal.
    """
    share, t, scale = 1.0, 0.0, 1.0 / VOXEL
    while t < far:
        clear = _distance_at(field, x + dx * t * scale, y + dy * t * scale, z + dz * t * scale)
        if clear < 0.8 * (SHADOW_START + t * slope):  # else what is near is the surface that the ray left
            share = min(share, PENUMBRA * (clear + 0.01) / max(t, 0.25))
        if share < 0.02:
            return 0.0
        t += max(clear, 0.5 * VOXEL)
    return share


@numba.njit(cache=True, nogil=True)
def _direct(
    points: Float, normals: Float, lamps: Float, facings: Float, powers: Float, field: Float32, origin: Float
) -> Float:
    """Irradiance (N, 3) straight from the lights, with soft shadows."""
    result = np.zeros((len(points), 3))
    for n in range(len(points)):
        nx, ny, nz = normals[n, 0], normals[n, 1], normals[n, 2]
        px, py, pz = (
            points[n, 0] + SHADOW_START * nx,
            points[n, 1] + SHADOW_START * ny,
            points[n, 2] + SHADOW_START * nz,
        )
        x, y, z = (px - origin[0]) / VOXEL, (py - origin[1]) / VOXEL, (pz - origin[2]) / VOXEL
        for m in range(len(lamps)):
            dx, dy, dz = lamps[m, 0] - px, lamps[m, 1] - py, lamps[m, 2] - pz
            far = max(np.sqrt(dx * dx + dy * dy + dz * dz), 1e-6)
            dx, dy, dz = dx / far, dy / far, dz / far
            slope = dx * nx + dy * ny + dz * nz
            cosine = slope
            if cosine <= 0.0:
                continue
            if facings[m, 0] != 0.0 or facings[m, 1] != 0.0 or facings[m, 2] != 0.0:
                cosine *= max(-(dx * facings[m, 0] + dy * facings[m, 1] + dz * facings[m, 2]), 0.0)
            strength = cosine / (far * far + NEAR_LAMP)
            if strength * powers[m].max() < FAINT:
                continue
            strength *= _lit_share(field, x, y, z, dx, dy, dz, far - LIGHT_RADIUS, slope)
            for c in range(3):
                result[n, c] += strength * powers[m, c]
    return result


@numba.njit(cache=True, nogil=True)
def _trace(
    low: Float, step: Float, counts: NDArray[np.int64], field: Float32, origin: Float, rays: Float
) -> NDArray[np.int32]:
    """(P, R) flat index of the voxel that each probe's ray ends in; -1 throughout for a probe inside of something."""
    _, ny, nz = field.shape
    hits = np.full((counts[0] * counts[1] * counts[2], len(rays)), -1, np.int32)
    for probe in range(len(hits)):
        i, j, k = probe // (counts[1] * counts[2]), (probe // counts[2]) % counts[1], probe % counts[2]
        px = (low[0] + step[0] * i - origin[0]) / VOXEL
        py = (low[1] + step[1] * j - origin[1]) / VOXEL
        pz = (low[2] + step[2] * k - origin[2]) / VOXEL
        if _distance_at(field, px, py, pz) < 0.5 * VOXEL:
            continue
        for r in range(len(rays)):
            x, y, z = px, py, pz
            for _ in range(MAX_STEPS):
                clear = _distance_at(field, x, y, z)
                if clear < 0.35 * VOXEL:
                    break
                stride = max(clear / VOXEL, 0.5)
                x, y, z = x + rays[r, 0] * stride, y + rays[r, 1] * stride, z + rays[r, 2] * stride
            hits[probe, r] = (int(np.rint(x)) * ny + int(np.rint(y))) * nz + int(np.rint(z))
    return hits
