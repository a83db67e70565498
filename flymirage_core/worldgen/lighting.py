"""Baked light: sun, windows and lamps with soft shadows by ray casting, bounces, exposure and film. Linear RGB.

`bake` looks at the whole place once; `BakedLight` then answers for any spot of any surface: for the surfels that become
Gaussians, and for the pixels of a reference picture.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

from flymirage_core.worldgen.bounces import Patches, gathered, hemispheres
from flymirage_core.worldgen.meshes import TexturedMesh
from flymirage_core.worldgen.rays import NEVER, RayCaster
from flymirage_core.worldgen.sky import Sky, Sun
from flymirage_core.worldgen.surfaces import Surfels

Float = NDArray[np.float64]

BOUNCES: Final = 3
NEAR_LAMP: Final = 0.2
"""Square metres added to the squared distance to a lamp: lamps are not points."""
FAINT: Final = 0.015
"""A lamp that gives a spot less than this share of all lamps' light there gives it none."""
STRONG: Final = 0.2
"""A lamp that gives more than this share casts `CORNERS` shadow rays, others one."""
LIFT: Final = 0.012
"""Metres along the normal at which a shadow ray begins."""
SHORT: Final = 0.12
"""Shadow rays end this far from a lamp, so that its own fitting does not hide it."""
SUN_RADIUS: Final = 0.018
"""Radians: half of the sun's width, and of the haze round it."""
CORNERS: Final = ((-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5))
"""Where in a lamp's two half extents the shadow rays end."""
CHUNK: Final = 60_000
"""Spots that are lit at once."""
GLOWS: Final = 0.02
"""Emission above which a face casts no shadow: light passes through panes and shades."""
EXPOSURE: Final = 0.72
"""Of a white surface in the light that half of the place's area exceeds, before the film curve."""
OPEN_SHARE: Final = 0.5
"""In the open air pictures are exposed for at least this share of the light of open ground: crowns hold much shade."""
EXPOSED_FOR: Final = 9.0
"""Metres from the origin within which surface counts most for the exposure."""
THROUGH: Final = 0.4
"""Of the light that a leaf gives off, what came in on its other side."""
SKY_FILTER: Final = 0.55
"""Share of the sky's radiance that reaches the film."""
FILM_TOE, FILM_SHOULDER, FILM_SLOPE, FILM_BASE = 0.06, 1.0, 0.34, 0.16
"""A rational curve (x^2 + toe x) / (shoulder x^2 + slope x + base): dark toe, long shoulder, 1 at infinity."""


@dataclass(frozen=True, eq=False)
class Lamps:
    """L area lights: middle, normal (zero: shines all round), half extents u and v, and radiant intensity."""

    positions: Float  # (L, 3)
    normals: Float  # (L, 3)
    u: Float  # (L, 3)
    v: Float  # (L, 3)
    intensities: Float  # (L, 3)

    @staticmethod
    def of(rows: list[tuple[Float, Float, Float, Float, Float]]) -> "Lamps":
        """Of (position, normal, u, v, intensity) rows, each (3,); none is allowed."""
        columns = np.array(rows, float).reshape(-1, 5, 3)
        return Lamps(*(columns[:, i] for i in range(5)))

    def __len__(self) -> int:
        return len(self.positions)


@dataclass(frozen=True, eq=False)
class Illumination:
    """All that lights a place. ``sky`` is seen by rays that leave it; indoors there is none, windows are lamps."""

    lamps: Lamps
    sun: Sun | None
    sky: Sky | None
    brightness: float = 1.0  # of the finished picture: less at night


@dataclass(frozen=True, eq=False)
class BakedLight:
    """The light in a place, ready to be asked anywhere on its surfaces."""

    illumination: Illumination
    shadows: RayCaster
    patches: Patches
    indirect: Float  # (P, 3) irradiance of patches from other surfaces and the sky
    exposure: float

    def irradiance(self, points: Float, normals: Float) -> Float:
        """(N, 3) at surface points (N, 3) with unit normals (N, 3)."""
        direct = direct_light(points, normals, self.illumination, self.shadows)
        return direct + self.patches.between(self.indirect, points, normals)

    def through(self, points: Float, normals: Float, leaf: NDArray[np.bool_]) -> Float:
        """(N, 3) irradiance; of what is ``leaf`` (N,) a share `THROUGH` is that of its other side."""
        result = self.irradiance(points, normals)
        back = self.irradiance(points[leaf], -normals[leaf])
        result[leaf] += THROUGH * (back - result[leaf])
        return result

    def seen_sky(self, directions: Float) -> Float:
        """Display colours (N, 3) of the sky along unit ``directions`` (N, 3), through a filter that darkens it alone.

        Pictures are exposed for what stands in the shade; photographers put a graduated filter before the sky.
        """
        sky = self.illumination.sky
        return np.zeros((len(directions), 3)) if sky is None else self.seen(SKY_FILTER * sky.radiance(directions))

    def seen(self, radiance: Float) -> Float:
        """Display colours (N, 3), sRGB coded in [0, 1], of linear radiance (N, 3)."""
        return display(radiance * self.exposure)


def solid_faces(mesh: TexturedMesh) -> RayCaster:
    """What casts shadows: all faces but panes of glass and what glows."""
    every = np.arange(len(mesh.faces))
    solid = (mesh.emission(every) < GLOWS) & (mesh.opacity(every) > 0.5)
    return RayCaster(mesh.vertices[mesh.faces[solid]])


def opaque_faces(mesh: TexturedMesh) -> RayCaster:
    """What hides what is behind it; its faces are those that ``mesh.opaque()`` numbers."""
    return RayCaster(mesh.vertices[mesh.faces[mesh.opaque()]])


def bake(
    surfels: Surfels,
    lamp_surfels: NDArray[np.bool_],
    mesh: TexturedMesh,
    shadows: RayCaster,
    illumination: Illumination,
) -> BakedLight:
    """Light the place that ``surfels`` cover and ``mesh`` is made of; ``shadows`` are its `solid_faces`.

    ``lamp_surfels`` (N,) marks those whose glow is already in ``illumination.lamps``.
    """
    triangles = mesh.vertices[mesh.faces]  # (F, 3, 3)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    glow = surfels.albedo * (surfels.emission * ~lamp_surfels)[:, None]
    patches = Patches.of(surfels, glow)
    direct = direct_light(patches.points, patches.normals, illumination, shadows)
    indirect = gathered(patches, direct, RayCaster(triangles), normals, illumination.sky, BOUNCES)
    usual = max(_usual(direct + indirect, patches, surfels), OPEN_SHARE * _open_ground(illumination))
    return BakedLight(illumination, shadows, patches, indirect, illumination.brightness * np.pi / max(usual, 1e-9))


def _open_ground(illumination: Illumination) -> float:
    """Irradiance of level ground on which nothing casts a shadow; 0 indoors."""
    if illumination.sky is None:
        return 0.0
    up = hemispheres(np.array([[0.0, 0.0, 1.0]]), 0)[0]  # (R, 3)
    light = np.pi * illumination.sky.radiance(up).mean()
    if illumination.sun is not None:
        light += illumination.sun.irradiance.mean() * max(float(illumination.sun.towards[2]), 0.0)
    return float(light)


def _usual(irradiance: Float, patches: Patches, surfels: Surfels) -> float:
    """The irradiance that half of the surface exceeds, near surface counting more: pictures are exposed for it."""
    own = np.maximum(patches.at(surfels.points, surfels.normals), 0)
    level = irradiance.mean(axis=1)[own]
    weight = surfels.areas / (1 + (surfels.points[:, :2] ** 2).sum(axis=1) / EXPOSED_FOR**2) ** 2
    order = np.argsort(level, kind="stable")
    half = np.searchsorted(np.cumsum(weight[order]), weight.sum() / 2)
    return float(level[order[half]])


def direct_light(points: Float, normals: Float, illumination: Illumination, shadows: RayCaster) -> Float:
    """(N, 3) irradiance straight from sun and lamps."""
    result = np.zeros((len(points), 3))
    for start in range(0, len(points), CHUNK):
        part = slice(start, start + CHUNK)
        if illumination.sun is not None:
            result[part] += _from_sun(points[part], normals[part], illumination.sun, shadows)
        if len(illumination.lamps):
            result[part] += _from_lamps(points[part], normals[part], illumination.lamps, shadows)
    return result


def _from_sun(points: Float, normals: Float, sun: Sun, shadows: RayCaster) -> Float:
    cosine = np.maximum(normals @ sun.towards, 0.0)
    facing = np.flatnonzero(cosine > 0)
    side = np.cross(sun.towards, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side)
    over = np.cross(side, sun.towards)
    lit = np.zeros(len(facing))
    origins = points[facing] + LIFT * normals[facing]
    for a, b in CORNERS:
        towards = sun.towards + 2 * SUN_RADIUS * (a * side + b * over)
        directions = np.tile(towards / np.linalg.norm(towards), (len(facing), 1))
        lit += ~shadows.occluded(origins, directions, np.full(len(facing), NEVER)) / len(CORNERS)
    result = np.zeros((len(points), 3))
    result[facing] = (cosine[facing] * lit)[:, None] * sun.irradiance
    return result


def _from_lamps(points: Float, normals: Float, lamps: Lamps, shadows: RayCaster) -> Float:
    powers = lamps.intensities.mean(axis=1)
    strength, rays = _lamp_strengths(points, normals, lamps.positions, lamps.normals, powers)  # (N, L) both
    strong = np.nonzero(rays == 2)
    visible = np.zeros(len(strong[0]))
    for a, b in CORNERS:
        visible += _sees(points, normals, strong, lamps, (a, b), shadows) / len(CORNERS)
    strength[strong] *= visible
    weak = np.nonzero(rays == 1)
    strength[weak] *= _sees(points, normals, weak, lamps, (0.0, 0.0), shadows)
    strength[rays == 0] = 0.0
    return np.asarray(strength @ lamps.intensities)


@njit(cache=True, nogil=True)
def _lamp_strengths(
    points: Float, normals: Float, positions: Float, lamp_normals: Float, powers: Float
) -> tuple[Float, NDArray[np.uint8]]:
    """What each lamp would give each spot if nothing were in the way, as a factor on its intensity, (N, L).

    And the shadow rays that it is worth, (N, L): 0, less than `FAINT`; 1; or 2, `STRONG`: several.
    """
    strength = np.zeros((len(points), len(positions)))
    rays = np.zeros(strength.shape, np.uint8)
    for i in range(len(points)):
        total = 0.0
        for j in range(len(positions)):
            x = positions[j, 0] - points[i, 0]
            y = positions[j, 1] - points[i, 1]
            z = positions[j, 2] - points[i, 2]
            squared = x * x + y * y + z * z
            distance = np.sqrt(max(squared, 1e-9))
            cosine = (x * normals[i, 0] + y * normals[i, 1] + z * normals[i, 2]) / distance
            facing = -(x * lamp_normals[j, 0] + y * lamp_normals[j, 1] + z * lamp_normals[j, 2]) / distance
            if not lamp_normals[j].any():  # shines all round
                facing = 1.0
            strength[i, j] = max(cosine, 0.0) * max(facing, 0.0) / (squared + NEAR_LAMP)
            total += strength[i, j] * powers[j]
        for j in range(len(positions)):
            share = strength[i, j] * powers[j] / max(total, 1e-12)
            rays[i, j] = 2 if share > STRONG else 1 if share > FAINT else 0
    return strength, rays


def _sees(
    points: Float,
    normals: Float,
    pairs: tuple[NDArray[np.intp], ...],
    lamps: Lamps,
    where: tuple[float, float],
    shadows: RayCaster,
) -> NDArray[np.bool_]:
    """Whether, for each (spot, lamp) pair, nothing is in the way to a place in the lamp's extents."""
    spot, lamp = pairs
    origins = points[spot] + LIFT * normals[spot]
    way = (lamps.positions + where[0] * lamps.u + where[1] * lamps.v)[lamp] - origins
    distance = np.maximum(np.linalg.norm(way, axis=1), 1e-6)
    return ~shadows.occluded(origins, way / distance[:, None], np.maximum(distance - SHORT, 1e-3))


def display(radiance: Float) -> Float:
    """sRGB-coded colours (N, 3) of linear ``radiance`` (N, 3), in which a white surface in the usual light has 1.

    Exposure, then a filmic curve for each channel: bright colours grow pale, as on film.
    """
    x = np.maximum(radiance, 0.0) * EXPOSURE
    toe, shoulder = x * (x + FILM_TOE), x * (FILM_SHOULDER * x + FILM_SLOPE) + FILM_BASE
    colour = np.clip(toe / shoulder, 0.0, 1.0)
    return np.where(colour <= 0.0031308, 12.92 * colour, 1.055 * np.maximum(colour, 1e-9) ** (1 / 2.4) - 0.055)
