"""Which boxes are things and which are left-overs of the building: trim, ledges, panels, frames, slivers."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.fusion import footprint_overlap
from flymirage_core.annotation.merging import ENCLOSED
from flymirage_core.annotation.room_structure import RoomStructure

Float32 = NDArray[np.float32]

MIN_OBJECT_POINTS: Final = 25
LONGEST: Final = 4.5
"""Metres; larger things are a part of the building that was not recognised ..."""
LONGEST_OUTDOORS: Final = 6.5
"""... and under an open sky, where vans and containers stand, of the place."""
SHORTEST: Final = 0.08
"""Metres; a box whose longest side is less is noise."""
HIGH: Final = 1.9
"""Metres above the floor from which what does not hang freely is trim, or a part of the ceiling."""
CEILING_TRIM: Final = 0.9
"""Metres below the ceiling where trim begins in higher rooms."""
TRIM_HEIGHT: Final = 0.16
TRIM_DEPTH: Final = 0.2
"""Metres that trim stands out from its wall at most; balconies, window boxes and lamps reach farther."""
TRIM_GAP: Final = 0.15
"""Metres to a wall or to the ceiling within which a high thing is fixed to it."""
MAX_BRACKET: Final = 0.6
"""Metres to a house front that a dish or a sign is held away from it, or that its back is hidden."""
LEDGE_HEIGHT: Final = 0.12
LEDGE_RATIO: Final = 5.0
"""Length against depth from which a flat thing at a wall is a sill or a skirting board."""
PANEL_HEIGHT: Final = 1.9
PANEL_DEPTH: Final = 0.2
PANEL_GAP: Final = 0.3
"""Metres to the wall that a panel runs along."""
PIPE: Final = 0.4
"""Metres; what is no wider is a pipe, where it runs up a house front."""
FRAME_SIDE: Final = 0.16
"""Metres; what is as high as a panel and thinner than this both ways is a door frame or the edge of a pillar."""
SKIN_HEIGHT: Final = 0.05
"""Metres; the upper face of a support, left over above it."""
STRIP_DEPTH: Final = 0.05
STRIP_HEIGHT: Final = 0.35
STICK_SIDE: Final = 0.14
"""Metres; thinner things both ways are legs (low), or need many points to be believed (high)."""
LEG_HEIGHT: Final = 0.4
LEG_CLEARANCE: Final = 0.3
MIN_STICK_POINTS: Final = 150
SPECK_VOLUME: Final = 0.004
"""Cubic metres of which little evidence is no evidence."""

MIN_VOLUME_RATIO: Final = 4.0
"""Volume of a bookcase against that of one of its contents."""
HELD_SHARE: Final = 0.8
"""Of the content's plan, that lies inside of the bookcase's."""


def is_thing(box: FittedBox, structure: RoomStructure) -> bool:
    """Whether a box made from parts is an object, rather than a left-over."""
    longest = LONGEST if structure.ceiling is not None else LONGEST_OUTDOORS
    if not SHORTEST <= max(box.size) <= longest:
        return False
    clearance = box.bottom - structure.floor
    building = _is_trim(box, clearance, structure) or _is_ledge(box, structure) or _is_panel(box, structure)
    return not (building or _is_sliver(box, clearance))


def without_contents(boxes: Sequence[FittedBox], points: Float32) -> list[FittedBox]:
    """The boxes but for those inside of another that encloses them: books, boards and backs of a bookcase.

    ``points``: (N, 3) that the boxes' members number. What stands under a table stays: a table has only legs beside it.
    """
    return [box for box in boxes if not any(_holds(other, box, points) for other in boxes)]


def _holds(body: FittedBox, box: FittedBox, points: Float32) -> bool:
    if body.volume < MIN_VOLUME_RATIO * box.volume or box.bottom < body.bottom or box.top > body.top:
        return False
    if footprint_overlap(body, box) < HELD_SHARE * box.size[0] * box.size[1]:
        return False
    heights = points[body.members, 2]
    beside = ((heights > box.bottom) & (heights < box.top)).mean()
    return bool(beside > ENCLOSED * box.size[2] / body.size[2])


def _is_trim(box: FittedBox, clearance: float, structure: RoomStructure) -> bool:
    """High up at a wall, or flat up there, or with nothing above to hang from; what hangs freely is not."""
    depth = min(box.size[:2])
    at_wall = structure.wall_gap(box.centre, depth) < TRIM_GAP
    afloat = structure.ceiling is None and structure.wall_gap(box.centre, depth) > MAX_BRACKET
    high = HIGH if structure.ceiling is None else max(HIGH, structure.ceiling - structure.floor - CEILING_TRIM)
    flat = box.size[2] < TRIM_HEIGHT or (at_wall and depth < TRIM_DEPTH)
    return clearance > high and not box.hanging and (flat or afloat)


def _is_ledge(box: FittedBox, structure: RoomStructure) -> bool:
    short, long = sorted(box.size[:2])
    at_wall = structure.wall_gap(box.centre, short) < TRIM_GAP
    return box.size[2] < LEDGE_HEIGHT and long > LEDGE_RATIO * short and at_wall


def _is_panel(box: FittedBox, structure: RoomStructure) -> bool:
    short, long = sorted(box.size[:2])
    if box.size[2] < PANEL_HEIGHT:
        return False
    at_wall = short < PANEL_DEPTH and structure.wall_gap(box.centre, short) < PANEL_GAP
    if structure.ceiling is None:
        return at_wall and long > PIPE
    return at_wall or long < FRAME_SIDE


def _is_sliver(box: FittedBox, clearance: float) -> bool:
    short, long = sorted(box.size[:2])
    height, points = box.size[2], len(box.members)
    skin = height < SKIN_HEIGHT and not box.hanging
    rim = height < LEDGE_HEIGHT and clearance < SHORTEST
    strip = short < STRIP_DEPTH and height < STRIP_HEIGHT
    leg = long < STICK_SIDE and height < LEG_HEIGHT and clearance < LEG_CLEARANCE
    stick = long < STICK_SIDE and height > LEG_HEIGHT and points < MIN_STICK_POINTS
    speck = points < 2 * MIN_OBJECT_POINTS and box.volume < SPECK_VOLUME
    return skin or rim or strip or leg or stick or speck
