"""Broad level faces (table tops, seats, shelves) and what stands on them, whatever its colour."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from flymirage_core.annotation.box_fitting import Footprint, fit_footprint
from flymirage_core.annotation.fusion import convex_overlap

Float32 = NDArray[np.float32]
Index = NDArray[np.intp]

LEVEL: Final = 0.85
"""n_z from which a point lies on a level face that looks up."""
MIN_FACE_AREA: Final = 0.10
"""Square metres from which a level face carries things."""
MIN_FACE_HEIGHT: Final = 0.2
"""Metres above the floor."""
FACE_THICKNESS: Final = 0.03
"""Metres from a face's main height within which points belong to it."""
FACE_GAP: Final = 0.02
"""Metres above a face's points where things on it begin."""
CELL: Final = 0.03
HEIGHT_BIN: Final = 0.01
FACE_TRIM: Final = 1.0
"""Per cent of a face's points beyond each side of its rectangle."""
SURROUNDINGS: Final = 0.5
"""Metres round a face in which things on it are followed, so that what only leans over it is seen to be larger."""
BASE_HEIGHT: Final = 0.10
"""Metres above the face within which a thing on it must begin, and where its base is judged."""
MAX_THING_HEIGHT: Final = 1.3
MIN_THING_HEIGHT: Final = 0.05
MIN_THING_POINTS: Final = 25
EDGE: Final = 0.02
"""Metres in from the face's rim where the base must lie: backs and arms of seats rise from the rim."""
MIN_BASE_INSIDE: Final = 0.55
MIN_INSIDE: Final = 0.6
"""Share of the whole thing over the face: leaves and lamp shades overhang."""
MAX_SHARE: Final = 0.6
"""Of the face's area; what covers more of it is its upper part."""
COMPARTMENT: Final = (0.12, 0.75)
"""Metres above a face: another level face at this height over most of it makes it the inside of a shelf, not a top."""
COVERED: Final = 0.5


@dataclass(frozen=True)
class Face:
    """A level face: its height, the upper edge of it, and the rectangle round it. World frame, metres."""

    height: float
    level: float  # where most of it is
    plan: Footprint


def standing_things(points: Float32, edges: Index, faces: Sequence[Face]) -> Index:
    """(N,) number of the thing on a support that each point belongs to; 0 for what stands on the floor.

    Things are connected where their points are (``edges`` (E, 2)) once the support is cut away, so two that touch have
    one number; colour tells them apart later. What stands on a thing on a table has its own number.
    """
    things = np.zeros(len(points), np.intp)
    number = 0
    for face in _tops(faces):
        for members in _on_face(face, points, edges):
            number += 1
            things[members] = number
    return things


def level_faces(points: Float32, normals: Float32, edges: Index, floor: float, yaw: float) -> list[Face]:
    """All broad level faces, the lowest first."""
    up = (normals[:, 2] > LEVEL) & (points[:, 2] > floor + MIN_FACE_HEIGHT)
    kept = edges[up[edges[:, 0]] & up[edges[:, 1]]]
    labels = _components(len(points), kept)
    faces = []
    for k in np.flatnonzero(np.bincount(labels[up], minlength=1) * CELL**2 >= MIN_FACE_AREA):
        members = np.flatnonzero(up & (labels == k))
        heights = points[members, 2]
        counts, bins = np.histogram(heights, np.arange(heights.min(), heights.max() + 2 * CELL, HEIGHT_BIN))
        main = bins[int(np.convolve(counts, [1, 1, 1], "same").argmax())] + HEIGHT_BIN / 2
        flat = members[np.abs(heights - main) < FACE_THICKNESS]
        cells = np.unique(np.floor(points[flat, :2] / CELL), axis=0)
        if len(cells) * CELL**2 >= MIN_FACE_AREA:
            top = float(np.percentile(points[flat, 2], 80))
            faces.append(Face(top, float(main), fit_footprint(points[flat], yaw, FACE_TRIM)))
    return sorted(faces, key=lambda f: (f.height, tuple(f.plan.centre)))


def _tops(faces: Sequence[Face]) -> list[Face]:
    """The faces without those that have another over most of them: the boards of a bookcase, but for the uppermost."""

    def compartment(face: Face) -> bool:
        return any(
            COMPARTMENT[0] < other.height - face.height < COMPARTMENT[1]
            and convex_overlap(face.plan.corners, other.plan.corners) > COVERED * face.plan.area
            for other in faces
        )

    return [face for face in faces if not compartment(face)]


def _on_face(face: Face, points: Float32, edges: Index) -> list[Index]:
    """Point indices of each thing that stands on a face."""
    bottom = face.height + FACE_GAP
    above = (points[:, 2] > bottom) & (points[:, 2] < bottom + MAX_THING_HEIGHT)
    reach = np.linalg.norm(face.plan.size) / 2 + 2 * SURROUNDINGS
    above &= (np.abs(points[:, :2] - face.plan.centre) < reach).all(axis=1)
    index = np.flatnonzero(above)
    local = np.zeros((len(points), 2))
    local[index] = face.plan.local(points[index])  # (N, 2), where it is asked for
    index = index[(np.abs(local[index]) < face.plan.size / 2 + SURROUNDINGS).all(axis=1)]
    if len(index) < MIN_THING_POINTS:
        return []
    position = np.full(len(points), -1, np.intp)
    position[index] = np.arange(len(index))
    above = position >= 0
    inner = position[edges[above[edges[:, 0]] & above[edges[:, 1]]]]
    labels = _components(len(index), inner)
    order = np.argsort(labels, kind="stable")
    groups = np.split(index[order], np.flatnonzero(np.diff(labels[order])) + 1)
    return [members for members in groups if _stands(members, face, points, local)]


def _stands(members: Index, face: Face, points: Float32, local: NDArray[np.float64]) -> bool:
    """Whether a cluster above a face is a thing of its own on it."""
    heights = points[members, 2] - face.height
    if len(members) < MIN_THING_POINTS or np.ptp(heights) < MIN_THING_HEIGHT or heights.min() > BASE_HEIGHT:
        return False
    base = local[members[heights < heights.min() + BASE_HEIGHT]]
    half = face.plan.size / 2
    if (np.abs(base) < half - EDGE).all(axis=1).mean() < MIN_BASE_INSIDE:
        return False
    if (np.abs(local[members]) < half).all(axis=1).mean() < MIN_INSIDE:
        return False
    area = float(np.maximum(np.ptp(base, axis=0), CELL).prod())
    return area <= MAX_SHARE * face.plan.area


def _components(n: int, edges: Index) -> Index:
    graph = coo_matrix((np.ones(len(edges), np.int8), (edges[:, 0], edges[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], np.intp)
