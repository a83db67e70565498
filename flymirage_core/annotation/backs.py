"""The unseen backs of tall things that stand before a wall: what no view sees through belongs to them."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import MIN_GAP, FittedBox, gap_to_wall, grown_to_wall, on_floor
from flymirage_core.annotation.carving import hidden
from flymirage_core.annotation.fused_points import Frame
from flymirage_core.annotation.room_structure import RoomStructure, Wall

Float32 = NDArray[np.float32]

TALL: Final = 1.35
"""Metres above the floor; lower things show how deep they are from above."""
MAX_BACK: Final = 0.75
"""Metres between what was seen of a thing and the wall."""
MAX_DEPTH_RATIO: Final = 1.15
"""Of its depth with the back over its width."""
MIN_HIDDEN: Final = 0.8
"""Share of the room behind it that no view sees through."""
SAMPLES: Final = (8, 5, 8)
"""Places looked at there: across, towards the wall and upwards."""


def with_backs(boxes: Sequence[FittedBox], structure: RoomStructure, frames: Sequence[Frame]) -> list[FittedBox]:
    """The boxes, tall ones on the floor grown to walls behind them if that room is hidden."""

    def is_tall(box: FittedBox) -> bool:
        return box.top - structure.floor > TALL and on_floor(box, structure)

    return [_with_back(box, structure, frames) if is_tall(box) else box for box in boxes]


def _with_back(box: FittedBox, structure: RoomStructure, frames: Sequence[Frame]) -> FittedBox:
    for wall in structure.walls_at(box.centre):
        behind = gap_to_wall(box, wall)
        if behind is None:
            continue
        axis, gap = behind
        depth, width = box.size[axis], box.size[1 - axis]
        if not MIN_GAP < gap < MAX_BACK or depth + gap > MAX_DEPTH_RATIO * width:
            continue
        if hidden(_behind(box, wall, depth, width, gap), frames).mean() > MIN_HIDDEN:
            box = grown_to_wall(box, wall, axis, gap)
    return box


def _behind(box: FittedBox, wall: Wall, depth: float, width: float, gap: float) -> Float32:
    """(N, 3) places spread over the room between a box and the wall behind it."""
    shares = [(np.arange(n) + 0.5) / n - 0.5 for n in SAMPLES]
    across, towards, up = (a.ravel() for a in np.meshgrid(*shares, indexing="ij"))
    plan = np.array(box.centre[:2]) - wall.normal * (depth + gap) / 2
    xy = plan + np.outer(across * width, wall.direction) - np.outer(towards * gap, wall.normal)
    return np.column_stack([xy, box.centre[2] + up * box.size[2]]).astype(np.float32)
