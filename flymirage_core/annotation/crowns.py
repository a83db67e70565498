"""Tall things under an open sky, whose upper parts are beyond the distance at which pixels are looked at: trees, lamps.

What stands near enough is one thing up to its top; the coarse cloud of the whole place tells how far that goes on.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from flymirage_core.annotation.box_fitting import FittedBox, fit_footprint, on_floor
from flymirage_core.annotation.room_structure import RoomStructure

Float32 = NDArray[np.float32]

TALL: Final = 2.2
"""Metres above the ground that a thing was seen up to, to go on above."""
WALL_CLEARANCE: Final = 0.6
"""Metres to house fronts; what stands nearer would grow into balconies."""
REACH: Final = 2.4
"""Metres in plan that a crown reaches from the middle of its trunk."""
CROWN: Final = 1.2
"""Metres above the ground from which it does."""
TOUCHING: Final = 0.13
"""Metres between points of one thing."""
MARGIN: Final = 0.1
"""Metres round other things within which points are theirs."""
TRIM: Final = 1.0
"""Per cent of the points beyond each side."""


def with_crowns(boxes: Sequence[FittedBox], points: Float32, structure: RoomStructure) -> list[FittedBox]:
    """The boxes, tall ones on the ground with what goes on above them in ``points`` (N, 3), seen from any distance."""
    if structure.ceiling is not None:
        return list(boxes)
    points = points[~structure.contains(points) & (points[:, 2] > structure.floor + CROWN)]
    owner = np.full(len(points), -1)
    for k, box in enumerate(boxes):
        owner[_inside(box, points)] = k
    return [
        _with_crown(box, points[(owner < 0) | (owner == k)], structure) if _is_cut(box, structure) else box
        for k, box in enumerate(boxes)
    ]


def _is_cut(box: FittedBox, structure: RoomStructure) -> bool:
    clear = structure.wall_gap(box.centre, min(box.size[:2])) > WALL_CLEARANCE
    return on_floor(box, structure) and box.top - structure.floor > TALL and clear


def _inside(box: FittedBox, points: Float32) -> NDArray[np.bool_]:
    c, s = np.cos(box.yaw), np.sin(box.yaw)
    radius = np.hypot(*box.size[:2]) / 2 + 2 * MARGIN  # in plan
    inside = (np.abs(points[:, :2] - np.array(box.centre[:2])) < radius).all(axis=1)
    local = (points[inside] - np.array(box.centre)) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    inside[inside] = (np.abs(local) < np.array(box.size) / 2 + MARGIN).all(axis=1)
    return np.asarray(inside)


def _with_crown(box: FittedBox, points: Float32, structure: RoomStructure) -> FittedBox:
    near = points[np.hypot(*(points[:, :2] - np.array(box.centre[:2])).T) < REACH]
    own = _inside(box, near)
    if not own.any():
        return box
    pairs = cKDTree(near).query_pairs(TOUCHING, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(near), len(near)))
    labels = connected_components(graph, directed=False)[1]
    crown = near[np.isin(labels, np.unique(labels[own]))]
    top = float(np.percentile(crown[:, 2], 100 - TRIM / 2))
    plan = fit_footprint(crown, structure.yaw, TRIM)
    if top < box.top or plan.area < box.size[0] * box.size[1]:
        return box
    size = (float(plan.size[0]), float(plan.size[1]), top - box.bottom)
    centre = (float(plan.centre[0]), float(plan.centre[1]), (top + box.bottom) / 2)
    return replace(box, centre=centre, size=size, yaw=plan.yaw)
