"""From an assembled world to Gaussians: surfaces cut into surfels, lit, and made flat splats; and the sky's dome."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.worldgen.assembly import Assembly
from flymirage_core.worldgen.backdrop import BEYOND
from flymirage_core.worldgen.lighting import BakedLight, bake, opaque_faces, solid_faces
from flymirage_core.worldgen.meshes import TexturedMesh, textured_mesh
from flymirage_core.worldgen.place import Place
from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.spacing import coarseness, spacing_for
from flymirage_core.worldgen.surfaces import Leaves, Part, Sheet, Surfels, surfels_of, vector
from flymirage_core.worldgen.windows import illumination_of

Float = NDArray[np.float64]

OVERLAP: Final = 0.55
"""A splat's standard deviation as a share of its surfel's side: the least that leaves no pinholes at corners."""
THICKNESS: Final = 0.002
"""Standard deviation along the normal, metres."""
OPACITY, LEAF_OPACITY = 0.99, 0.93
SH_C0: Final = 0.28209479177387814
"""Real spherical harmonic of degree 0: colour = 0.5 + SH_C0 * coefficient."""
TOLERANCE: Final = 0.12
"""Share by which the count may miss what is asked for before the cut is made again."""
RESPONSE: Final = 0.62
"""The count falls with about this root of the spacing: 0.5 were areas alone."""
COVER: Final = 0.045
"""Metres: what has a surface this close before it cannot be seen."""
FLUSH: Final = 0.02
"""Metres."""
BACKING_SIDES: Final = 4.0
"""Side of a splat that backs a face, as a multiple of the spacing."""
BACKING_MOST: Final = 0.45
"""Metres: no such splat is larger, or it would reach out past its face's edges like fog."""
BEHIND, MARGIN = 0.1, 0.14
"""Metres from a face to what backs it, and from a face's edges to the edges of that."""
DOME_SPLATS: Final = 9000
SKY_SIDES: Final = 1.45
"""Side of a sky splat as a share of what would just tile the dome."""


@dataclass(frozen=True, eq=False)
class LitWorld:
    """A world cut and lit; the mesh and the light answer for any other spot of it as well."""

    cloud: GaussianCloud
    mesh: TexturedMesh
    light: BakedLight


def lit_world(assembly: Assembly, count: int) -> LitWorld:
    """About ``count`` Gaussians of the assembled world, world frame."""
    mesh = textured_mesh(assembly.parts)
    opaque = opaque_faces(mesh)
    factors = coarseness(assembly, mesh, opaque)
    spacing = spacing_for(assembly, mesh, factors, count)
    pieces, leaf = _cut(assembly, factors, spacing, opaque)
    share = sum(map(len, pieces)) / count
    if abs(share - 1) > TOLERANCE:  # places of many small curved things have more surfels than their areas say
        pieces, leaf = _cut(assembly, factors, spacing * share**RESPONSE, opaque)
    illumination, lamps = illumination_of(assembly, pieces)
    surfels = Surfels.joined(pieces)
    is_lamp = np.repeat(np.array(lamps, bool), [len(p) for p in pieces])
    light = bake(surfels, is_lamp, mesh, solid_faces(mesh), illumination)
    glow = surfels.emission[:, None] * light_unit(light)
    radiance = surfels.albedo * (light.through(surfels.points, surfels.normals, leaf) / np.pi + glow)
    cloud = _joined(
        splats(surfels, light.seen(radiance), np.where(leaf, LEAF_OPACITY, OPACITY)),
        _backing(assembly, spacing * factors, light),
    )
    if illumination.sky is not None:
        cloud = _joined(cloud, dome(light))
    return LitWorld(cloud, mesh, light)


def _cut(
    assembly: Assembly, factors: Float, spacing: float, opaque: RayCaster
) -> tuple[list[Surfels], NDArray[np.bool_]]:
    """The surfels of each thing that can be seen, and (N,) which of them all are leaves."""
    parts = assembly.parts
    cut = [surfels_of(p, spacing * float(f)) for p, f in zip(parts, factors, strict=True)]
    surfels = Surfels.joined(cut)
    leaf = np.repeat([isinstance(p.surface, Leaves) for p in parts], [len(c) for c in cut])
    seen = _seen(surfels, leaf, opaque, assembly.place)
    thing = np.repeat(np.arange(len(assembly.things)), [len(t.parts) for t in assembly.things])
    ends = np.cumsum(np.bincount(np.repeat(thing, [len(c) for c in cut])[seen], minlength=len(assembly.things)))
    kept = surfels[seen]
    pieces = [kept[np.arange(a, b)] for a, b in zip([0, *ends[:-1]], ends, strict=True)]
    return pieces, leaf[seen]


def _backing(assembly: Assembly, spacings: Float, light: BakedLight) -> GaussianCloud:
    """Coarse splats a little behind the building's large faces, of their colours; ``spacings`` (M,) are the parts'.

    Between the splats of a face a few per cent of what is behind shows, which would be nothing: a dark grid.
    """
    sides = iter(np.minimum(BACKING_SIDES * spacings, BACKING_MOST))
    parts = [(p, float(next(sides)), t.object_id) for t in assembly.things for p in t.parts]
    inner = [(_inset(p), side) for p, side, owner in parts if owner < 0 and _is_face(p)]
    surfels = Surfels.joined([surfels_of(p, side) for p, side in inner if p])
    colours = light.seen(surfels.albedo * light.irradiance(surfels.points, surfels.normals) / np.pi)
    behind = replace(surfels, points=surfels.points - BEHIND * surfels.normals)
    return splats(behind, colours, np.full(len(surfels), OPACITY))


def _is_face(part: Part) -> bool:
    return isinstance(part.surface, Sheet) and part.material.opacity == 1 and part.material.emission == 0


def _inset(part: Part) -> Part | None:
    """A face less a margin all round, cut evenly, so that what backs it does not look out at its edges; or nothing."""
    assert isinstance(part.surface, Sheet)
    corner, a, b = (np.asarray(v) for v in (part.surface.corner, part.surface.a, part.surface.b))
    u, v = (MARGIN / max(float(np.linalg.norm(e)), 1e-9) for e in (a, b))
    if max(u, v) > 0.3:
        return None
    inner = Sheet(vector(corner + u * a + v * b), vector((1 - 2 * u) * a), vector((1 - 2 * v) * b))
    return replace(part, surface=inner, material=replace(part.material, joints=(0, 0, 0), stretch=1.0, detail=1.0))


def light_unit(light: BakedLight) -> float:
    """Radiance of an emission of 1 on white.

    Lamps and screens are as bright on the picture in any light: a film would be exposed for them. In the open air the
    sky's own unit holds.
    """
    return 1.0 if light.illumination.sky is not None else 1.0 / light.exposure


def splats(surfels: Surfels, colours: Float, opacity: Float) -> GaussianCloud:
    """Flat Gaussians of surfels and their sRGB colours (N, 3) in [0, 1]."""
    long = np.linalg.norm(surfels.along, axis=1)
    wide = np.linalg.norm(surfels.across, axis=1)
    x = surfels.along / np.maximum(long, 1e-12)[:, None]
    y = np.cross(surfels.normals, x)
    y /= np.maximum(np.linalg.norm(y, axis=1, keepdims=True), 1e-12)
    quaternions = Rotation.from_matrix(np.stack([x, y, np.cross(x, y)], axis=2)).as_quat()  # (N, 4) xyzw
    scales = np.stack([OVERLAP * long, OVERLAP * wide, np.full(len(long), THICKNESS)], 1)  # (N, 3)
    return GaussianCloud(
        surfels.points.astype(np.float32),
        quaternions.astype(np.float32),
        np.maximum(scales, 5e-4).astype(np.float32),
        (opacity * surfels.opacity).astype(np.float32),
        ((colours - 0.5) / SH_C0).astype(np.float32)[:, None, :],
    )


def dome(light: BakedLight) -> GaussianCloud:
    """The sky as large flat splats on a sphere of `BEYOND` metres round the origin, facing it; a bit below it too."""
    i = np.arange(2 * DOME_SPLATS) + 0.5
    z = 1 - i / DOME_SPLATS
    angle = np.pi * (1 + 5**0.5) * i
    flat = np.sqrt(1 - z * z)
    directions = np.stack([flat * np.cos(angle), flat * np.sin(angle), z], axis=1)
    directions = directions[z > -0.35]
    side = SKY_SIDES * BEYOND * np.sqrt(2 * np.pi / DOME_SPLATS)
    a = np.cross(np.where(np.abs(directions[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]]), directions)
    a *= side / np.linalg.norm(a, axis=1, keepdims=True)
    b = np.cross(directions, a)
    n = len(directions)
    blank = np.zeros((n, 3))
    surfels = Surfels(BEYOND * directions, a, b, -directions, blank, np.zeros(n), np.ones(n))
    return splats(surfels, light.seen_sky(directions), np.full(n, OPACITY))


def _joined(one: GaussianCloud, other: GaussianCloud) -> GaussianCloud:
    names = ("means", "quaternions", "scales", "opacities", "sh")
    return GaussianCloud(*(np.concatenate([getattr(one, name), getattr(other, name)]) for name in names))


def _seen(surfels: Surfels, leaf: NDArray[np.bool_], opaque: RayCaster, place: Place) -> NDArray[np.bool_]:
    """(N,) surfels that a camera in the place could see. Leaves cover each other and are seen from both sides."""
    return (leaf | (surfels.emission > 0) | ~_covered(surfels, opaque)) & ~_outward(surfels, place)


def _outward(surfels: Surfels, place: Place) -> NDArray[np.bool_]:
    """(N,) surfels on a space's bounds that look out of it: backs and undersides flush with walls and floor."""
    inside, still = np.zeros(len(surfels), bool), np.zeros(len(surfels), bool)
    ahead = surfels.points + FLUSH * surfels.normals
    for space in place.spaces:
        low = np.array([*space.low, 0.0])
        high = np.array([*space.high, np.inf if space.open_air else space.height])
        inside |= ((surfels.points > low - FLUSH / 8) & (surfels.points < high + FLUSH / 8)).all(axis=1)
        still |= ((ahead > low - FLUSH / 2) & (ahead < high + FLUSH / 2)).all(axis=1)
    return np.asarray(inside & ~still)


def _covered(surfels: Surfels, opaque: RayCaster) -> NDArray[np.bool_]:
    """(N,) surfels that something lies right before of: they would only shine through at a slant.

    Undersides of what stands, backs of what hangs, walls behind skirting, floors under rugs.
    """
    return opaque.occluded(surfels.points + 1e-3 * surfels.normals, surfels.normals, np.full(len(surfels), COVER))
