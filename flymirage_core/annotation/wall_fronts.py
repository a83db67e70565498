"""Pieces of one front at a wall: a headboard that shows between pillows, a panel behind the things before it."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from flymirage_core.annotation.box_fitting import MAX_WALL_GAP, FittedBox, fit_box
from flymirage_core.annotation.fused_points import FusedPoints
from flymirage_core.annotation.room_structure import RoomStructure, Wall

THICKNESS: Final = 0.2
"""Metres of a front at most, the gap to its wall included."""
FLUSH: Final = 0.03
"""Metres by which the faces of pieces of one front differ."""
LEVEL: Final = 0.05
"""Metres by which their tops differ."""
HIDDEN: Final = 0.5
"""Metres between two pieces that something before them may hide."""
LEAST_PIECES: Final = 3
"""Two alike may be two things, hung side by side; more that are level and flush are one."""


def join_fronts(boxes: Sequence[FittedBox], cloud: FusedPoints, structure: RoomStructure) -> list[FittedBox]:
    """The boxes, those that are pieces of one front replaced by the whole."""
    left = list(boxes)
    for wall in structure.walls:
        pieces = sorted((box for box in left if _is_flat_on(box, wall)), key=lambda box: _span(box, wall))
        while pieces:
            front = [pieces.pop(0)]
            for box in list(pieces):
                if _goes_on(front, box, wall):
                    front.append(box)
                    pieces.remove(box)
            if len(front) >= LEAST_PIECES:
                members = np.sort(np.concatenate([box.members for box in front]))
                whole = fit_box(cloud.points, cloud.to_camera, members, structure, MAX_WALL_GAP)
                left = [box for box in left if all(box is not piece for piece in front)] + [whole]
    return left


def _is_flat_on(box: FittedBox, wall: Wall) -> bool:
    if box.on_wall or box.hanging:
        return False
    first, last = _span(box, wall)
    middle = (first + last) / 2
    return 0 < _face(box, wall) < THICKNESS and wall.start < middle < wall.end and last - first > min(box.size[:2])


def _goes_on(front: Sequence[FittedBox], box: FittedBox, wall: Wall) -> bool:
    level = abs(front[-1].top - box.top) < LEVEL
    flush = abs(_face(front[-1], wall) - _face(box, wall)) < FLUSH
    return level and flush and _span(box, wall)[0] - max(_span(piece, wall)[1] for piece in front) < HIDDEN


def _reach(box: FittedBox, direction: np.ndarray) -> float:
    """Half of what a box takes up along a unit direction (2,) of the plan."""
    x, y = np.array([np.cos(box.yaw), np.sin(box.yaw)]), np.array([-np.sin(box.yaw), np.cos(box.yaw)])
    return float(abs(direction @ x) * box.size[0] + abs(direction @ y) * box.size[1]) / 2


def _face(box: FittedBox, wall: Wall) -> float:
    """Metres of the box's face before the wall's plane."""
    return float(np.dot(wall.normal, box.centre[:2])) - wall.back + _reach(box, wall.normal)


def _span(box: FittedBox, wall: Wall) -> tuple[float, float]:
    """Where a box begins and ends along the wall."""
    middle, half = float(np.dot(wall.direction, box.centre[:2])), _reach(box, wall.direction)
    return middle - half, middle + half
