"""Pieces of one thing, joined because the 2D detector sees the whole: a bed and its pillows' row, halves of a sofa."""

from collections.abc import Sequence
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import MAX_WALL_GAP, FittedBox, fit_box
from flymirage_core.annotation.carving import detections
from flymirage_core.annotation.fused_points import Frame, FusedPoints
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.picture_votes import vote_weights
from flymirage_core.annotation.room_structure import RoomStructure
from flymirage_core.annotation.yolox import PictureDetection

MAX_ROUNDS: Final = 3
TOUCH: Final = 0.08
"""Metres between pieces that may be one thing."""
LARGEST: Final = 3.2
"""Metres of the longest side of what may be one thing."""
MIN_WEIGHT: Final = 0.8
"""Votes for the whole, where it and its pieces compete for each picture's windows ..."""
BETTER: Final = 1.2
"""... and by so much more than for both pieces together."""


def join_pieces(
    boxes: Sequence[FittedBox],
    cloud: FusedPoints,
    structure: RoomStructure,
    frames: Sequence[Frame],
    found: Sequence[Sequence[PictureDetection]],
    max_distance: float,
) -> list[FittedBox]:
    """The boxes, pieces replaced by the whole wherever the detections ``found`` in each frame fit the whole better."""
    boxes = list(boxes)
    for _ in range(MAX_ROUNDS):
        pairs = [(i, j) for i, j in combinations(range(len(boxes)), 2) if _may_be_one(boxes[i], boxes[j])]
        if not pairs:
            return boxes
        wholes = [_whole(boxes[i], boxes[j], cloud, structure) for i, j in pairs]
        shown = detections(cloud.points, boxes, frames, max_distance)
        hits = np.stack([s.hits for s in shown])  # (B, F)
        union_hits = np.array([hits[i] + hits[j] for i, j in pairs])
        weights = vote_weights([*boxes, *wholes], np.concatenate([hits, union_hits]), frames, found)
        joined = _accepted(weights, pairs, len(boxes))
        if not joined:
            return boxes
        pieces = {i for k in joined for i in pairs[k]}
        boxes = [box for i, box in enumerate(boxes) if i not in pieces] + [wholes[k] for k in joined]
    return boxes


def _accepted(weights: NDArray[np.float64], pairs: Sequence[tuple[int, int]], count: int) -> list[int]:
    """Numbers of the pairs that become one, the surest first; each piece in one of them at most."""
    taken: set[int] = set()
    accepted = []
    for k in np.argsort(-weights[count:], kind="stable").tolist():
        i, j = pairs[k]
        whole = weights[count + k]
        if whole < MIN_WEIGHT:
            break
        if whole > BETTER * (weights[i] + weights[j]) and not taken & {i, j}:
            taken |= {i, j}
            accepted.append(k)
    return accepted


def _may_be_one(a: FittedBox, b: FittedBox) -> bool:
    if a.on_wall or b.on_wall or a.hanging or b.hanging:
        return False
    gap = max(a.bottom, b.bottom) - min(a.top, b.top)
    far = np.hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1]) > LARGEST
    return not far and gap < TOUCH and yaw_iou(_grown(a), _grown(b)) > 0


def _grown(box: FittedBox) -> FittedBox:
    x, y, z = box.size
    return FittedBox(box.centre, (x + TOUCH, y + TOUCH, z + TOUCH), box.yaw, box.members)


def _whole(a: FittedBox, b: FittedBox, cloud: FusedPoints, structure: RoomStructure) -> FittedBox:
    members = np.sort(np.concatenate([a.members, b.members]))
    return fit_box(cloud.points, cloud.to_camera, members, structure, MAX_WALL_GAP)
