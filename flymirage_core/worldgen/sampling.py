"""From a furnished room to Gaussians: every surface cut into surfels, lit, and made flat, opaque splats."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from flymirage_core.scene.description import SceneDescription
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.lighting import DAYLIGHT, LAMP_BOOST, LAMPLIGHT, WINDOW_RADIANCE, Lights, lit_colours
from flymirage_core.worldgen.materials import material_named
from flymirage_core.worldgen.parts import Finish, paint
from flymirage_core.worldgen.room import SKIRTING, Room, fixtures, shell
from flymirage_core.worldgen.surfaces import Part, Surfels, surfels_of, upright
from flymirage_core.worldgen.truth import PlacedObject, WorldTruth

OVERLAP = 0.72
"""A splat's standard deviation as a share of its surfel's side: four neighbours leave 1 % of the light at a corner."""
THICKNESS = 0.002
"""Standard deviation along the normal, metres."""
OPACITY = 0.99
SH_C0 = 0.28209479177387814
"""Real spherical harmonic of degree 0: colour = 0.5 + SH_C0 * coefficient."""
FIRST_SPACING = 0.07
"""Metres, of the trial cut that tells how many surfels a spacing gives."""
SMALL_OBJECT = 1.1
"""Metres; objects smaller than this are cut finer, down to `FINEST` of the spacing."""
FINEST = 0.45
COVER_GAP, COVER_REACH, NEIGHBOURS = 0.016, 0.05, 14
"""Metres before a surfel within which another hides it, how far off that one's middle may be, how many are asked."""
FLAT = 0.1
"""Metres; what hangs on a wall and is no deeper hides the wall behind it."""
HIDDEN = 0.05
"""Metres: faces this close to the wall or floor they look at cannot be seen."""
SECOND = {"wood": "walnut brown", "metal": "charcoal", "fabric": "chocolate", "plain": "charcoal", "stone": "charcoal"}
LAMP_POWER = 0.05
"""Objects that glow less (emission times square metres) light nothing: screens, small signs."""


def gaussians(description: SceneDescription, room: Room, truth: WorldTruth, count: int) -> GaussianCloud:
    """About ``count`` flat Gaussians of the lit room, world frame."""
    empty = EmptyRoom(shell(room, description), fixtures(room, description))
    objects = [(o, object_parts(o)) for o in truth.objects]
    spacing = FIRST_SPACING
    for _ in range(2):  # the edges' extra surfels make the count fall slower than the area over spacing^2
        found = sum(len(s) for s in _cut(empty, objects, spacing))
        spacing *= float(np.sqrt(found / count))
    pieces = _cut(empty, objects, spacing)
    lights = _lights(room, pieces[2:])
    pieces[0] = pieces[0][_uncovered(pieces[0], room, truth)]
    surfels = Surfels.joined(pieces)
    return splats(surfels, lit_colours(surfels, lights, room.dimensions))


def object_parts(placed: PlacedObject) -> list[Part]:
    """The parts of one placed object, in its own frame."""
    main = material_named(placed.material, placed.colour, placed.seed % 9973)
    accent = paint(
        SECOND.get(main.texture, "charcoal"),
        "wood" if main.texture in ("wood", "fabric") else "metal",
        seed=placed.seed % 997,
    )
    return kind_of(placed.noun).build(placed.size, Finish(main, accent, placed.seed))


def splats(surfels: Surfels, colours: NDArray[np.float64]) -> GaussianCloud:
    """Flat Gaussians of surfels and their sRGB colours (N, 3) in [0, 1]."""
    long = np.linalg.norm(surfels.along, axis=1)
    wide = np.linalg.norm(surfels.across, axis=1)
    x = surfels.along / np.maximum(long, 1e-12)[:, None]
    z = surfels.normals
    y = np.cross(z, x)
    y /= np.maximum(np.linalg.norm(y, axis=1, keepdims=True), 1e-12)
    quaternions = Rotation.from_matrix(np.stack([x, y, np.cross(x, y)], axis=2)).as_quat()  # (N, 4) xyzw
    scales = np.stack([OVERLAP * long, OVERLAP * wide, np.full(len(long), THICKNESS)], 1)  # (N, 3)
    return GaussianCloud(
        surfels.points.astype(np.float32),
        quaternions.astype(np.float32),
        np.maximum(scales, 5e-4).astype(np.float32),
        (OPACITY * surfels.opacity).astype(np.float32),
        ((colours - 0.5) / SH_C0).astype(np.float32)[:, None, :],
    )


@dataclass(frozen=True, eq=False)
class EmptyRoom:
    """The parts of the room before anything is in it, world coordinates."""

    structure: list[Part]
    fixtures: list[list[Part]]


def _cut(empty: EmptyRoom, objects: list[tuple[PlacedObject, list[Part]]], spacing: float) -> list[Surfels]:
    """Surfels of the room itself, of its fixtures, then of each object, in world coordinates."""
    pieces = [Surfels.joined([surfels_of(p, spacing) for p in empty.structure])]
    pieces.append(Surfels.joined([_visible(parts, spacing) for parts in empty.fixtures]))
    for placed, parts in objects:
        fine = spacing * float(np.clip(np.sqrt(max(placed.size) / SMALL_OBJECT), FINEST, 1.0))
        own = _visible(parts, fine)
        own = own[~_hidden(own, placed)]
        pieces.append(own.moved(upright(placed.yaw), (*placed.centre[:2], placed.bottom)))
    return pieces


def _visible(parts: list[Part], spacing: float) -> Surfels:
    """The surfels of one thing's parts, less those that its other parts cover."""
    cut = [surfels_of(p, spacing) for p in parts]
    own = Surfels.joined(cut)
    return own[~_covered(own, np.repeat(np.arange(len(cut)), [len(c) for c in cut]))]


def _hidden(own: Surfels, placed: PlacedObject) -> NDArray[np.bool_]:
    """(N,) undersides of what stands, and backs of what hangs on a wall or stands at one."""
    hidden = np.zeros(len(own), bool)
    if placed.placement not in ("on_wall", "hanging"):
        hidden |= (own.normals[:, 2] < -0.9) & (own.points[:, 2] < HIDDEN)
    if placed.placement in ("on_wall", "against_wall"):
        hidden |= (own.normals[:, 1] < -0.9) & (own.points[:, 1] < -placed.size[1] / 2 + HIDDEN / 2)
    return hidden


def _covered(own: Surfels, part: NDArray[np.intp]) -> NDArray[np.bool_]:
    """(N,) surfels that another part's surfel hides, lying flat before them: they would shine through at a slant."""
    tree = cKDTree(own.points)
    _, near = tree.query(own.points, k=NEIGHBOURS, distance_upper_bound=COVER_REACH)  # (N, K); N where there is none
    covered = np.zeros(len(own), bool)
    lengths = np.linalg.norm(own.along, axis=1), np.linalg.norm(own.across, axis=1)
    for column in np.asarray(near).T[1:]:
        i = np.flatnonzero((column < len(own)) & ~covered)
        j = column[i]
        i, j = i[part[i] != part[j]], j[part[i] != part[j]]
        step = own.points[j] - own.points[i]
        ahead = (step * own.normals[i]).sum(axis=1)
        hides = (ahead > 1e-4) & (ahead < COVER_GAP) & ((own.normals[i] * own.normals[j]).sum(axis=1) > 0.9)
        for edge, length in ((own.along, lengths[0]), (own.across, lengths[1])):
            hides &= np.abs((step * edge[j]).sum(axis=1)) <= 0.55 * length[j] ** 2
        covered[i[hides]] = True
    return covered


def _uncovered(structure: Surfels, room: Room, truth: WorldTruth) -> NDArray[np.bool_]:
    """(N,) False for what windows, doors, pictures, rugs and skirting cover.

    Large splats that are nearly in one plane are not sorted reliably: the covered ones would shine through at a slant.
    """
    seen = np.ones(len(structure), bool)
    for opening in (*room.windows, *room.doors):
        wall = room.walls[opening.wall]
        local = structure.points[:, :2] - wall.origin
        along, height = local @ wall.along, structure.points[:, 2]
        behind = (local @ wall.inward < 1e-3) & (along > opening.left + 0.04) & (along < opening.right - 0.04)
        seen &= ~(
            behind & (height > opening.bottom + (0.04 if opening.bottom else -1.0)) & (height < opening.top - 0.04)
        )
    for flat in (
        o for o in truth.objects if o.placement == "on_wall" and o.size[1] < FLAT and not kind_of(o.noun).square
    ):
        local = (structure.points - flat.centre) @ upright(flat.yaw)
        seen &= ~(np.abs(local) < np.array(flat.size) / 2 + [-0.02, 0.05, -0.02]).all(axis=1)
    seen &= ~((structure.points[:, 2] < SKIRTING) & _on_a_wall(structure.points, room))
    for rug in (o for o in truth.objects if kind_of(o.noun).flat):
        local = (structure.points[:, :2] - rug.centre[:2]) @ rug.axes.T
        below = (np.abs(local) < np.array(rug.size[:2]) / 2 - 0.01).all(axis=1)
        seen &= ~(below & (structure.points[:, 2] < 1e-3))
    return seen


def _on_a_wall(points: NDArray[np.float64], room: Room) -> NDArray[np.bool_]:
    x, y, _ = room.dimensions
    return np.asarray(np.minimum(x / 2 - np.abs(points[:, 0]), y / 2 - np.abs(points[:, 1])) < 1e-3)


def _lights(room: Room, objects: list[Surfels]) -> Lights:
    """Windows as four patches of sky each, and every object that glows enough as a lamp at its glow's middle."""
    positions, normals, powers = [], [], []
    for w in room.windows:
        wall = room.walls[w.wall]
        area = (w.right - w.left) * (w.top - w.bottom)
        for a in (0.25, 0.75):
            for b in (0.25, 0.75):
                spot = wall.at(w.left + a * (w.right - w.left), 0.1)
                positions.append([*spot, w.bottom + b * (w.top - w.bottom)])
                normals.append([*wall.inward, 0.0])
                powers.append(DAYLIGHT * WINDOW_RADIANCE * area / 4)
    for own in objects:
        glow = own.emission * own.areas
        if glow.sum() > LAMP_POWER:
            middle = (own.points * glow[:, None]).sum(axis=0) / glow.sum()
            positions.append(list(middle - [0.0, 0.0, 0.08]))
            normals.append([0.0, 0.0, 0.0])
            powers.append(LAMPLIGHT * LAMP_BOOST * glow.sum() / np.pi)
    return Lights(np.array(positions).reshape(-1, 3), np.array(normals).reshape(-1, 3), np.array(powers).reshape(-1, 3))
