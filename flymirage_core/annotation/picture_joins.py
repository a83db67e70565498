"""Pieces of one thing, joined because the 2D detector sees the whole: a bed and its pillows' row, halves of a sofa."""

from collections.abc import Sequence
from itertools import combinations
from typing import Final

import numpy as np

from flymirage_core.annotation.box_fitting import MAX_WALL_GAP, FittedBox, fit_box, grown
from flymirage_core.annotation.fused_points import Frame, FusedPoints
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.picture_votes import MIN_WINDOW_IOU, Overlaps, overlaps, visible_windows
from flymirage_core.annotation.room_structure import RoomStructure
from flymirage_core.annotation.yolox import PictureDetection

MAX_ROUNDS: Final = 3
TOUCH: Final = 0.08
"""Metres between pieces that may be one thing."""
LARGEST: Final = 3.2
"""Metres of the longest side of what may be one thing."""
MIN_WEIGHT: Final = 0.6
"""Votes for the whole, from which it may be one ..."""
BETTER: Final = 1.1
"""... if it fits the same detections so much better than its pieces do."""
HOSTS: Final = frozenset({"table"})
"""Nouns whose windows hold what stands on and round the thing too: no reason to join that to it."""


def join_pieces(
    boxes: Sequence[FittedBox],
    cloud: FusedPoints,
    structure: RoomStructure,
    frames: Sequence[Frame],
    found: Sequence[Sequence[PictureDetection]],
) -> list[FittedBox]:
    """The boxes, pieces replaced by the whole wherever the detections ``found`` in each frame fit the whole better."""
    boxes = list(boxes)
    for _ in range(MAX_ROUNDS):
        pairs = [(i, j) for i, j in combinations(range(len(boxes)), 2) if _may_be_one(boxes[i], boxes[j])]
        wholes = [_whole(boxes[i], boxes[j], cloud, structure) for i, j in pairs]
        rivals = [*boxes, *wholes]
        windows = visible_windows([cloud.points[box.members] for box in rivals], frames)
        seen = overlaps(rivals, windows, found)
        joined = _accepted([_gain(seen, len(boxes), k, pair) for k, pair in enumerate(pairs)], pairs)
        if not joined:
            break
        pieces = {i for k in joined for i in pairs[k]}
        boxes = [box for i, box in enumerate(boxes) if i not in pieces] + [wholes[k] for k in joined]
    return boxes


def _gain(seen: Overlaps, boxes: int, number: int, pair: tuple[int, int]) -> float:
    """How much better the whole, ``number`` behind the ``boxes``, fits the detections that are about it; 0 = no vote.

    Those are the detections that fit the whole or one of its pieces, and no other box better.
    """
    pieces = seen.ious[list(pair)].max(axis=0)  # (D,)
    whole = seen.ious[boxes + number]
    others = np.delete(seen.ious[:boxes], pair, axis=0).max(axis=0, initial=0.0)
    about = np.maximum(pieces, whole) >= np.maximum(others, MIN_WINDOW_IOU)
    best = 0.0, ""
    apart = 0.0
    for noun in sorted(set(seen.nouns)):
        mine = about & (np.array(seen.nouns) == noun)
        best = max(best, (_weight(whole[mine], seen.scores[mine]), noun))
        apart = max(apart, _weight(pieces[mine], seen.scores[mine]))
    return best[0] / max(apart, 1e-9) if best[0] >= MIN_WEIGHT and best[1] not in HOSTS else 0.0


def _weight(ious: np.ndarray, scores: np.ndarray) -> float:
    return float((scores * ious)[ious >= MIN_WINDOW_IOU].sum())


def _accepted(gains: Sequence[float], pairs: Sequence[tuple[int, int]]) -> list[int]:
    """Numbers of the pairs that become one, the clearest first; each piece in one of them at most."""
    taken: set[int] = set()
    accepted = []
    for k in sorted(range(len(pairs)), key=lambda k: -gains[k]):
        if gains[k] > BETTER and not taken & set(pairs[k]):
            taken |= set(pairs[k])
            accepted.append(k)
    return accepted


def _may_be_one(a: FittedBox, b: FittedBox) -> bool:
    if a.on_wall or b.on_wall or a.hanging or b.hanging:
        return False
    gap = max(a.bottom, b.bottom) - min(a.top, b.top)
    far = np.hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1]) > LARGEST
    return not far and gap < TOUCH and yaw_iou(grown(a, TOUCH), grown(b, TOUCH)) > 0


def _whole(a: FittedBox, b: FittedBox, cloud: FusedPoints, structure: RoomStructure) -> FittedBox:
    members = np.sort(np.concatenate([a.members, b.members]))
    return fit_box(cloud.points, cloud.to_camera, members, structure, MAX_WALL_GAP)
