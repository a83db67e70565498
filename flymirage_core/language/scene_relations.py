"""Spatial relations between objects as people use them, each judged YES, MAYBE or NO from boxes.

Vague words have a borderline: "next to" is certain at 0.4 m and arguable at 0.8 m. A prompt may only say of its target
what is certain, and must be wrong of every other object beyond argument; `Truth` keeps the two apart.
World frame (z up), metres; a pair of numbers below is (certain within, possible within).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum, IntEnum

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.navigation.trajectories import Flight

SUPPORT_GAP = (0.12, 0.3)
"""Metres between a thing's underside and the top of what it stands on: about twice the error of a box's faces."""
OVERHANG = (0.0, 0.15)
"""Metres by which a thing's centre may lie outside of what it stands on."""
PICTURE_DEPTH, PICTURE_HEIGHT = 0.1, 0.3
"""Metres: at most, and at least, of what may hang on a wall."""
UNDER_RISE = (0.15, 0.3)
"""Metres by which a thing under a table may reach into the table's lower half, or stand above the table's foot."""
ABOVE_GAP = (1.2, 2.0)
ABOVE_OFFSET = (0.3, 0.7)
"""Metres between the outlines, seen from above: a picture hangs above a sofa that stands before the wall."""
NEXT_TO_GAP = (0.5, 1.0)
NEAR_GAP = (1.0, 1.8)
NEAR_RISE = (0.6, 1.2)
"""Metres between the heights of two things that are near each other."""
BETWEEN_MARGIN = (0.25, 0.1)
"""Share of the way at either end that does not count as between."""
BETWEEN_OFFSET = (0.4, 0.9)
BETWEEN_LENGTH = (4.0, 6.0)
LINE_UP_ANGLE = (np.radians(12.0), np.radians(25.0))
"""In front of and behind: bearings from the start that count as one line."""
BESIDE_ANGLE = (np.radians(12.0), np.radians(3.0))
BESIDE_ANGLE_MOST = (np.radians(70.0), np.radians(100.0))
DEPTH_STEP = (0.4, 0.1)
"""Metres by which a thing must be nearer (or farther) than its landmark to be in front of (or behind) it."""
NEIGHBOURHOOD = (2.0, 3.5)
"""Metres between centres beyond which nobody relates two things by view."""
LEAST_RANGE = 0.3
"""Metres, horizontally, from the drone within which a thing has no side."""
SIDE_ANGLE = (np.radians(20.0), np.radians(8.0))
SIDE_ANGLE_MOST = (np.radians(145.0), np.radians(170.0))
AHEAD_ANGLE = (np.radians(15.0), np.radians(28.0))
REAR_ANGLE = (np.radians(155.0), np.radians(135.0))
HALF_AHEAD_MOST = (np.radians(65.0), np.radians(85.0))
HALF_REAR = (np.radians(115.0), np.radians(95.0))
HALF_REAR_MOST = (np.radians(162.0), np.radians(174.0))
"""Ahead, or behind, and to one side."""
ON_GROUND = (0.15, 0.3)
"""Metres of a thing's underside above the ground."""
ON_WALL = (1.0, 0.5)
OVERHEAD = (2.0, 1.6)
WALL_DEPTH = (0.15, 0.3)
"""Metres from front to back of what hangs on a wall."""

OPEN_BENEATH = ("table", "desk", "bench", "counter", "workbench", "piano", "awning", "canopy")
"""Head nouns of things that one can be under although their boxes reach the floor."""


class Truth(IntEnum):
    """How a statement about boxes stands; `min` is "and", `max` is "or"."""

    NO = 0
    MAYBE = 1
    YES = 2


class Relation(Enum):
    """Between a thing and one landmark; the last four are seen from the drone's start."""

    ON = "on"
    UNDER = "under"
    ABOVE = "above"
    BELOW = "below"
    NEXT_TO = "next to"
    NEAR = "near"
    IN_FRONT_OF = "in front of"
    BEHIND = "behind"
    LEFT_OF = "to the left of"
    RIGHT_OF = "to the right of"


SEEN_FROM_START = (Relation.IN_FRONT_OF, Relation.BEHIND, Relation.LEFT_OF, Relation.RIGHT_OF)


class Side(Enum):
    """Where a thing is for the drone at its start."""

    LEFT = "on your left"
    RIGHT = "on your right"
    AHEAD = "straight ahead"
    REAR = "behind you"
    AHEAD_LEFT = "ahead of you on the left"
    AHEAD_RIGHT = "ahead of you on the right"
    REAR_LEFT = "behind you on the left"
    REAR_RIGHT = "behind you on the right"


class Level(Enum):
    """At what height a thing is, and on what."""

    GROUND = "on the ground"
    WALL = "on the wall"
    OVERHEAD = "overhead"


@dataclass(frozen=True)
class StartPose:
    """Where the drone is when it reads the prompt, before it moves; its camera looks along its yaw."""

    position: tuple[float, float, float]
    yaw: float  # radians, ENU: counter-clockwise from +x

    @staticmethod
    def of_flight(flight: Flight) -> "StartPose":
        x, y, z = (float(v) for v in flight.positions[0])
        return StartPose((x, y, z), float(flight.yaws[0]))

    def bearing(self, box: ObjectBox) -> float:
        """Angle from straight ahead to the box's centre, radians in (-pi, pi], positive to the left."""
        direction = np.arctan2(box.centre[1] - self.position[1], box.centre[0] - self.position[0])
        return _wrap(float(direction) - self.yaw)

    def range(self, box: ObjectBox) -> float:
        """Horizontal metres to the box's centre."""
        return float(np.hypot(box.centre[0] - self.position[0], box.centre[1] - self.position[1]))


def related(relation: Relation, thing: ObjectBox, landmark: ObjectBox, start: StartPose) -> Truth:
    """Whether ``thing`` stands in ``relation`` to ``landmark``."""
    match relation:
        case Relation.ON:
            return on(thing, landmark)
        case Relation.UNDER:  # people say "under" and "below" for one another
            return max(under(thing, landmark), min(Truth.MAYBE, above(landmark, thing)))
        case Relation.ABOVE:
            return above(thing, landmark)
        case Relation.BELOW:
            return max(above(landmark, thing), min(Truth.MAYBE, under(thing, landmark)))
        case Relation.NEXT_TO:
            return next_to(thing, landmark)
        case Relation.NEAR:
            return near(thing, landmark)
        case Relation.IN_FRONT_OF:
            return _lined_up(thing, landmark, start)
        case Relation.BEHIND:
            return _lined_up(landmark, thing, start)
        case Relation.LEFT_OF:
            return _left_of(thing, landmark, start)
        case Relation.RIGHT_OF:
            return _left_of(landmark, thing, start)


def on(thing: ObjectBox, landmark: ObjectBox) -> Truth:
    """It rests on the landmark's top, its centre over it, and is not the larger of the two.

    A thin upright thing there may as well hang on the wall behind.
    """
    hangs = min(thing.size[:2]) <= PICTURE_DEPTH and thing.size[2] >= PICTURE_HEIGHT
    return min(
        at_most(abs(thing.bottom - landmark.top), SUPPORT_GAP),
        at_most(_outside_outline(thing, landmark), OVERHANG),
        Truth.MAYBE if hangs else Truth.YES,
        Truth.YES if _area(thing) <= _area(landmark) else Truth.NO,
    )


def under(thing: ObjectBox, landmark: ObjectBox) -> Truth:
    """It is smaller, within the outline, and below the underside or between the legs of a thing open beneath."""
    smaller = Truth.YES if _area(thing) <= _area(landmark) else Truth.NO
    within = min(at_most(_outside_outline(thing, landmark), OVERHANG), smaller)
    clear = min(at_most(thing.top - landmark.bottom, UNDER_RISE), at_most(landmark.bottom - thing.top, ABOVE_GAP))
    if landmark.label.split()[-1] in OPEN_BENEATH:
        low = at_most(thing.top - landmark.centre[2], UNDER_RISE)
        foot = at_most(abs(thing.bottom - landmark.bottom), UNDER_RISE)
        clear = max(clear, min(low, foot, Truth.YES if thing.top < landmark.top else Truth.NO))
    return min(within, clear)


def above(thing: ObjectBox, landmark: ObjectBox) -> Truth:
    """It hangs higher than the landmark's top without touching it, over or nearly over it."""
    gap = thing.bottom - landmark.top
    lifted = at_least(gap, (SUPPORT_GAP[1], 0.0))
    return min(lifted, at_most(gap, ABOVE_GAP), at_most(outline_gap(thing, landmark), ABOVE_OFFSET))


def next_to(thing: ObjectBox, landmark: ObjectBox) -> Truth:
    """Beside each other at one height; not on, under or above."""
    shared = min(thing.top, landmark.top) - max(thing.bottom, landmark.bottom)
    if max(on(thing, landmark), on(landmark, thing), under(thing, landmark), under(landmark, thing)) > Truth.NO:
        return Truth.NO
    return min(at_most(outline_gap(thing, landmark), NEXT_TO_GAP), at_least(shared, (0.05, -0.15)))


def near(thing: ObjectBox, landmark: ObjectBox) -> Truth:
    """Close by, whether beside, on or under."""
    rise = max(thing.bottom, landmark.bottom) - min(thing.top, landmark.top)
    return min(at_most(outline_gap(thing, landmark), NEAR_GAP), at_most(rise, NEAR_RISE))


def between(thing: ObjectBox, one: ObjectBox, other: ObjectBox) -> Truth:
    """Seen from above it is near the line between two landmarks, away from its ends."""
    a, b, p = (np.array(box.centre[:2]) for box in (one, other, thing))
    length = float(np.linalg.norm(b - a))
    if length < 1e-6:
        return Truth.NO
    along = float((p - a) @ (b - a)) / length**2
    return min(
        at_least(min(along, 1.0 - along), BETWEEN_MARGIN),
        at_most(_line_offset(a, b, p), BETWEEN_OFFSET),
        at_most(length, BETWEEN_LENGTH),
    )


def on_side(side: Side, thing: ObjectBox, start: StartPose) -> Truth:
    """Whether the drone at its start, looking ahead, has the thing on this side; one below or above may be on any."""
    if start.range(thing) < LEAST_RANGE:
        return Truth.MAYBE
    bearing = start.bearing(thing)
    match side:
        case Side.LEFT:
            return min(at_least(bearing, SIDE_ANGLE), at_most(bearing, SIDE_ANGLE_MOST))
        case Side.RIGHT:
            return min(at_least(-bearing, SIDE_ANGLE), at_most(-bearing, SIDE_ANGLE_MOST))
        case Side.AHEAD:
            return at_most(abs(bearing), AHEAD_ANGLE)
        case Side.REAR:
            return at_least(abs(bearing), REAR_ANGLE)
        case Side.AHEAD_LEFT:
            return min(at_least(bearing, SIDE_ANGLE), at_most(bearing, HALF_AHEAD_MOST))
        case Side.AHEAD_RIGHT:
            return min(at_least(-bearing, SIDE_ANGLE), at_most(-bearing, HALF_AHEAD_MOST))
        case Side.REAR_LEFT:
            return min(at_least(bearing, HALF_REAR), at_most(bearing, HALF_REAR_MOST))
        case Side.REAR_RIGHT:
            return min(at_least(-bearing, HALF_REAR), at_most(-bearing, HALF_REAR_MOST))


def at_level(level: Level, thing: ObjectBox, others: Iterable[ObjectBox]) -> Truth:
    """Whether the thing stands on the ground, hangs flat and unsupported (so on a wall), or is overhead.

    What is thin and rests on something may lean on a wall; how far the wall is no box tells.
    """
    match level:
        case Level.GROUND:
            return at_most(thing.bottom, ON_GROUND)
        case Level.OVERHEAD:
            return at_least(thing.bottom, OVERHEAD)
        case Level.WALL:
            held = any(on(thing, other) > Truth.NO for other in others if other is not thing)
            thin = at_most(min(thing.size[:2]), WALL_DEPTH)
            doubt = Truth.MAYBE if held or at_level(Level.OVERHEAD, thing, ()) > Truth.NO else Truth.YES
            return min(thin, at_least(thing.bottom, ON_WALL), doubt)


def outline_gap(one: ObjectBox, other: ObjectBox) -> float:
    """Metres between the two boxes' outlines seen from above; 0 where they overlap."""
    return min(_corner_gap(one, other), _corner_gap(other, one))


def at_most(value: float, limits: tuple[float, float]) -> Truth:
    certain, possible = limits
    return Truth.YES if value <= certain else Truth.MAYBE if value <= possible else Truth.NO


def at_least(value: float, limits: tuple[float, float]) -> Truth:
    certain, possible = limits
    return Truth.YES if value >= certain else Truth.MAYBE if value >= possible else Truth.NO


def _lined_up(near: ObjectBox, far: ObjectBox, start: StartPose) -> Truth:
    """``near`` stands between the start and ``far``."""
    return min(
        at_most(abs(_wrap(start.bearing(near) - start.bearing(far))), LINE_UP_ANGLE),
        at_least(start.range(far) - start.range(near), DEPTH_STEP),
        at_most(_centre_distance(near, far), NEIGHBOURHOOD),
    )


def _left_of(thing: ObjectBox, landmark: ObjectBox, start: StartPose) -> Truth:
    angle = _wrap(start.bearing(thing) - start.bearing(landmark))
    return min(
        at_least(angle, BESIDE_ANGLE),
        at_most(angle, BESIDE_ANGLE_MOST),
        at_most(_centre_distance(thing, landmark), NEIGHBOURHOOD),
    )


def _outside_outline(thing: ObjectBox, landmark: ObjectBox) -> float:
    """Metres by which the thing's centre lies outside of the landmark's outline, seen from above."""
    return float(landmark.distance((thing.centre[0], thing.centre[1], landmark.centre[2])))


def _corner_gap(one: ObjectBox, other: ObjectBox) -> float:
    """Least distance of ``one``'s corners and centre from ``other``'s outline: apart, a corner is always nearest."""
    points: NDArray[np.float64] = np.vstack([one.corners, one.centre])
    points[:, 2] = other.centre[2]
    return float(other.distance(points).min())


def _line_offset(a: NDArray[np.float64], b: NDArray[np.float64], p: NDArray[np.float64]) -> float:
    """Metres (2D) of ``p`` from the line through ``a`` and ``b``."""
    along, to = b - a, p - a
    return abs(float(along[0] * to[1] - along[1] * to[0])) / float(np.linalg.norm(along))


def _area(box: ObjectBox) -> float:
    return box.size[0] * box.size[1]


def _centre_distance(one: ObjectBox, other: ObjectBox) -> float:
    return float(np.hypot(one.centre[0] - other.centre[0], one.centre[1] - other.centre[1]))


def _wrap(angle: float) -> float:
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
