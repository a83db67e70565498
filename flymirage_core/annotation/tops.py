"""Things of the colour of what carries them, told from it by where they stand: on its top, in from its rims."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from flymirage_core.annotation.box_fitting import Footprint, fit_footprint
from flymirage_core.annotation.parts import Part, PartSet
from flymirage_core.annotation.supports import (
    BASE_HEIGHT,
    FACE_GAP,
    MAX_SHARE,
    MIN_BASE_INSIDE,
    MIN_FACE_AREA,
    MIN_INSIDE,
    MIN_THING_HEIGHT,
    MIN_THING_POINTS,
)

Float32 = NDArray[np.float32]
Index = NDArray[np.intp]

ABOVE_SEATS: Final = 0.6
"""Metres above the floor; from the rims of lower faces backs and arms rise."""
NEIGHBOURS: Final = 1.8
"""Voxels between points of one thing."""
RIM: Final = 0.03
"""Metres from a side of the carrier within which a base touches it; what touches more than ..."""
MAX_RIMS: Final = 2
"""... two sides, a corner, is an upper part of the carrier: the back of a desk, a raised counter."""


def take_off_tops(parts: PartSet) -> None:
    """Make things that stand on a part parts of their own."""
    for i, part in sorted(parts.parts.items()):
        area, height = part.top
        if not part.thing and area >= MIN_FACE_AREA and height > parts.surface.floor + ABOVE_SEATS:
            for members in _on_top(part, height, NEIGHBOURS * parts.surface.voxel):
                parts.split(i, members)


def _on_top(part: Part, height: float, reach: float) -> list[Index]:
    """Members of each thing on a part's top at ``height`` metres; points of one are within ``reach`` of each other."""
    above = part.points[:, 2] > height + FACE_GAP
    if above.sum() < MIN_THING_POINTS:
        return []
    plan = fit_footprint(part.points[~above], part.surface.yaw)
    points = part.points[above]
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    count, labels = connected_components(graph, directed=False)
    groups = [np.flatnonzero(labels == k) for k in range(count)]
    return [part.members[above][g] for g in groups if len(g) >= MIN_THING_POINTS and _stands(points[g], plan, height)]


def _stands(points: Float32, plan: Footprint, height: float) -> bool:
    heights = points[:, 2] - height
    if np.ptp(heights) < MIN_THING_HEIGHT or heights.min() > BASE_HEIGHT:
        return False
    base, half = plan.local(points[heights < heights.min() + BASE_HEIGHT]), plan.size / 2
    lower, upper = base.min(axis=0), base.max(axis=0)
    rims = int((lower < RIM - half).sum() + (upper > half - RIM).sum())
    over = (np.abs(base) < half).all(axis=1).mean() >= MIN_BASE_INSIDE and plan.share_inside(points, 0) >= MIN_INSIDE
    return bool(over and rims <= MAX_RIMS and np.prod(upper - lower) <= MAX_SHARE * plan.area)
