"""Boxes round points: the yaw rectangle of a plan, and where a box goes on behind what was seen."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.fusion import convex_overlap, footprint_corners, footprint_overlap
from flymirage_core.annotation.room_structure import RoomStructure, Wall

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]

TRIM: Final = 0.6
"""Per cent of the points that each side of a box may leave out: flying pixels."""
HEIGHT_TRIM: Final = 0.5
SNAP: Final = 1.08
"""The room's own direction is taken if its rectangle is at most this much larger than the smallest."""
HUGGED: Final = 1.4
"""... or at most this much, if the points are nearer to its sides ..."""
CLOSER: Final = 0.7
"""... by this factor: of a cabinet two faces are seen, and its diagonal makes as small a rectangle."""
SURFACE_MARGIN: Final = 0.03
"""Metres added to both sides when areas are compared, so that thin things have one."""
MAX_FIT_POINTS: Final = 4000
ON_FLOOR: Final = 0.115
"""Metres above what is culled with the floor within which a thing begins that stands on it."""
MIN_SUPPORT_SHARE: Final = 0.3
"""Share of a floating box's plan that must lie over another for it to stand there."""
MAX_SUPPORT_GAP: Final = 1.5
"""Metres down to which a floating thing is taken to reach: thin legs and poles are not seen."""
NEAR_WALL: Final = 0.12
PARALLEL: Final = 0.97
"""Cosine from which a side runs along a wall."""
MIN_GAP: Final = 0.02
"""Metres; smaller gaps are none."""
FACE_SLACK: Final = 0.03
"""Metres that a face may lie above the bottom of what stands on it."""
SUPPORT_SLACK: Final = 0.10
"""Metres that a support may reach above the bottom of what it carries."""
MAX_WALL_DROP: Final = 0.3
"""Metres; what is at a wall and farther above everything is fixed to the wall."""
COARSE_YAWS: Final = np.radians(np.arange(0, 90, 6.0))
FINE_YAWS: Final = np.radians([-4.5, -3, -1.5, 0, 1.5, 3, 4.5])
MAX_WALL_GAP: Final = 0.15
"""Metres to a wall that are taken to belong to the thing: its back is not seen."""
MAX_CARRIED_GAP: Final = 0.075
"""... for what stands on another thing: no more than what is culled with the wall."""
ONE_SIDED: Final = 0.8
"""Length of the mean horizontal direction to the cameras from which a thing was seen from one side only."""
MAX_ONE_SIDED: Final = 0.7
"""Metres of width up to which its back is guessed."""
UNDER_CEILING: Final = 1.2
"""Metres below the ceiling within which a thing hangs from it."""
MAX_CORD: Final = 0.6
"""Metres of cord, seen or too thin to be, that count as a part of a lamp; in high rooms cords are longer ..."""
MAX_LAMP_SIDE: Final = 0.8
"""... and what is longer than this, trays and beams, has none."""
MIN_LAMP_SHAPE: Final = 0.4
"""Width over length; flat signs have no cord."""
CORD: Final = 0.12
"""Metres; as thin as that are the slices of a cord ..."""
CORD_SLICE: Final = 0.06
"""... so many metres high."""
MIN_HANGING: Final = 1.4
"""Metres above the floor."""


@dataclass(frozen=True)
class Footprint:
    """A rectangle in the plan; metres, yaw in [0, pi/2)."""

    centre: Float64  # (2,)
    size: Float64  # (2,) full lengths along its own axes
    yaw: float

    @property
    def area(self) -> float:
        return float(self.size[0] * self.size[1])

    @property
    def corners(self) -> Float64:
        """(4, 2) world xy, counter-clockwise."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        half = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * self.size / 2
        return np.asarray(half @ np.array([[c, s], [-s, c]]) + self.centre)

    def local(self, points: Float32 | Float64) -> Float64:
        """(N, 2) plan coordinates of points (N, 2 or 3) along the rectangle's axes, from its centre."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return np.asarray((points[:, :2] - self.centre) @ np.array([[c, -s], [s, c]]))

    def share_inside(self, points: Float32 | Float64, margin: float) -> float:
        """Share of the points (N, 3) whose plan lies inside, grown by ``margin`` on each side."""
        return float((np.abs(self.local(points)) < self.size / 2 + margin).all(axis=1).mean())


class LevelFace(Protocol):
    """A broad face that looks up: its height and its plan."""

    @property
    def level(self) -> float: ...

    @property
    def plan(self) -> Footprint: ...


@dataclass(frozen=True)
class FittedBox:
    """A box and the evidence for it. World frame, metres."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    yaw: float
    members: NDArray[np.intp]  # indices of the fused points it was made from
    on_wall: bool = False  # a flat thing found on a wall's own surface
    hanging: bool = False  # fixed to the ceiling

    @property
    def bottom(self) -> float:
        return self.centre[2] - self.size[2] / 2

    @property
    def top(self) -> float:
        return self.centre[2] + self.size[2] / 2

    @property
    def volume(self) -> float:
        return self.size[0] * self.size[1] * self.size[2]


def fit_footprint(points: Float32, room_yaw: float, trim: float = TRIM) -> Footprint:
    """The smallest rectangle round the plan of points (N, 3), in the room's direction if that costs little.

    ``trim`` per cent of the points may lie beyond each side.
    """
    step = -(-len(points) // MAX_FIT_POINTS)
    xy = points[::step, :2].astype(np.float64)
    snapped = _rectangle(xy, room_yaw % (np.pi / 2), trim)
    coarse = min((_rectangle(xy, a, trim) for a in COARSE_YAWS), key=_padded_area)
    near = coarse.yaw + FINE_YAWS
    best = min((_rectangle(xy, a % (np.pi / 2), trim) for a in near), key=_padded_area)
    ratio = _padded_area(snapped) / _padded_area(best)
    hugged = ratio < HUGGED and _from_sides(snapped, xy) < CLOSER * _from_sides(best, xy)
    return snapped if ratio < SNAP or hugged else best


def _from_sides(footprint: Footprint, xy: Float64) -> float:
    """Mean distance of points (N, 2) from the nearest side: two faces that meet in a corner hug the true sides."""
    return float(np.abs(footprint.size / 2 - np.abs(footprint.local(xy))).min(axis=1).mean())


def _rectangle(xy: Float64, yaw: float, trim: float) -> Footprint:
    c, s = np.cos(yaw), np.sin(yaw)
    rotation = np.array([[c, -s], [s, c]])  # columns are the axes
    along = xy @ rotation
    low, high = _trimmed_range(along, trim)
    return Footprint(rotation @ ((low + high) / 2), high - low, float(yaw))


def _trimmed_range(values: Float64, trim: float) -> tuple[Float64, Float64]:
    """Per column, the values that ``trim`` per cent lie below and above: order statistics, no interpolation."""
    n = len(values)
    k = round(trim / 100 * (n - 1))
    if k == 0:
        return values.min(axis=0), values.max(axis=0)
    ordered = np.partition(values, (k, n - 1 - k), axis=0)
    return ordered[k], ordered[n - 1 - k]


def _padded_area(footprint: Footprint) -> float:
    return float((footprint.size + SURFACE_MARGIN).prod())


def fit_box(
    points: Float32, to_camera: Float32, members: NDArray[np.intp], structure: RoomStructure, max_wall_gap: float
) -> FittedBox:
    """The box round some points, down to the floor if it nearly touches it, and back to a wall close behind.

    ``points``: (N, 3). ``to_camera``: (N, 3) directions to where each was seen from. ``members``: (M,) its points.
    ``max_wall_gap``: metres, `MAX_WALL_GAP` or `MAX_CARRIED_GAP`.
    """
    seen, members = len(members), _without_cord(points, members, structure)
    cloud = points[members]
    plan = _with_unseen_half(fit_footprint(cloud, structure.yaw), to_camera[members])
    low, high = _trimmed_range(cloud[:, 2:].astype(np.float64), HEIGHT_TRIM)
    bottom, top = float(low[0]), float(high[0])
    floor = float(structure.floor_map.at(plan.centre[None])[0])
    if bottom < structure.floor_top.at(plan.centre[None])[0] + ON_FLOOR:
        bottom = min(floor, bottom)
    box = FittedBox(
        (float(plan.centre[0]), float(plan.centre[1]), (bottom + top) / 2),
        (float(plan.size[0]), float(plan.size[1]), top - bottom),
        plan.yaw,
        members,
        hanging=len(members) < seen,
    )
    return _reaching_wall(box, structure, max_wall_gap)


def _without_cord(points: Float32, members: NDArray[np.intp], structure: RoomStructure) -> NDArray[np.intp]:
    """The members of what hangs high up, but for most of the thin upper end that it hangs by."""
    cloud = points[members]
    foot = float(cloud[:, 2].min())
    if foot - structure.floor < MIN_HANGING:
        return members
    slices = ((cloud[:, 2] - foot) / CORD_SLICE).astype(int)  # (M,)
    lower, upper = np.full((slices.max() + 1, 2), np.inf), np.full((slices.max() + 1, 2), -np.inf)
    np.minimum.at(lower, slices, cloud[:, :2])
    np.maximum.at(upper, slices, cloud[:, :2])
    wide = np.flatnonzero((upper - lower).max(axis=1) > CORD)
    return members[slices <= wide[-1] + MAX_CORD / CORD_SLICE] if len(wide) else members


def _with_unseen_half(plan: Footprint, to_camera: Float32) -> Footprint:
    """The plan of a small thing that was seen from one side only, its depth doubled up to its width."""
    direction = to_camera[:, :2].mean(axis=0)
    if np.linalg.norm(direction) < ONE_SIDED or plan.size.max() > MAX_ONE_SIDED:
        return plan
    c, s = np.cos(plan.yaw), np.sin(plan.yaw)
    along = direction @ np.array([[c, -s], [s, c]])  # (2,) in the plan's axes
    axis = int(np.abs(along).argmax())
    growth = min(plan.size[axis], plan.size[1 - axis] - plan.size[axis])
    if growth <= 0:
        return plan
    size = plan.size.copy()
    size[axis] += growth
    shift = np.array([[c, s], [-s, c]])[axis] * np.sign(along[axis]) * growth / 2
    return Footprint(plan.centre - shift, size, plan.yaw)


def _reaching_wall(box: FittedBox, structure: RoomStructure, max_gap: float) -> FittedBox:
    """The box grown to walls right behind it, its unseen back."""
    for wall in structure.walls_at(box.centre):
        behind = gap_to_wall(box, wall)
        if behind is not None and MIN_GAP < behind[1] < max_gap:
            box = grown_to_wall(box, wall, *behind)
    return box


def gap_to_wall(box: FittedBox, wall: Wall) -> tuple[int, float] | None:
    """The axis of the box that runs towards a wall, and the metres between the two; None where none does."""
    for axis in (0, 1):
        angle = box.yaw + axis * np.pi / 2
        if abs(np.cos(angle) * wall.normal[0] + np.sin(angle) * wall.normal[1]) >= PARALLEL:
            return axis, float(np.dot(wall.normal, box.centre[:2])) - wall.back - box.size[axis] / 2
    return None


def grown_to_wall(box: FittedBox, wall: Wall, axis: int, gap: float) -> FittedBox:
    """The box, longer along ``axis`` by the ``gap`` metres between it and the wall."""
    size = list(box.size)
    size[axis] += gap
    x, y = np.array(box.centre[:2]) - wall.normal * gap / 2
    return replace(box, centre=(float(x), float(y), box.centre[2]), size=(size[0], size[1], size[2]))


def settle(boxes: Sequence[FittedBox], structure: RoomStructure, faces: Sequence[LevelFace]) -> list[FittedBox]:
    """Nothing floats: boxes go down to the support below them, or up to the ceiling that they hang from.

    ``faces`` are the broad level ones; where a box stands on one of them, that is where its bottom is.
    """
    settled = []
    for box in boxes:
        level = _face_below(box, faces, structure)
        if level is None:
            box = _settled(box, boxes, structure)
            level = _face_below(box, faces, structure)
        settled.append(box if level is None else between(box, level, box.top))
    return settled


def on_floor(box: FittedBox, structure: RoomStructure) -> bool:
    """Whether a box begins where the floor ends."""
    return bool(box.bottom < structure.floor_top.at(np.array([box.centre[:2]]))[0] + ON_FLOOR)


def _face_below(box: FittedBox, faces: Sequence[LevelFace], structure: RoomStructure) -> float | None:
    """Height of the level face right below a box: its lowest centimetres are cut away with the face."""
    if on_floor(box, structure) or box.hanging:
        return None
    corners, area = footprint_corners(box), box.size[0] * box.size[1]
    levels = [
        face.level
        for face in faces
        if -FACE_SLACK < box.bottom - face.level < SUPPORT_SLACK
        and face.level < box.top - 2 * FACE_SLACK
        and convex_overlap(corners, face.plan.corners) > MIN_SUPPORT_SHARE * area
    ]
    return max(levels, default=None)


def _settled(box: FittedBox, boxes: Sequence[FittedBox], structure: RoomStructure) -> FittedBox:
    if on_floor(box, structure) or box.hanging:
        return box
    floor = float(structure.floor_map.at(np.array([box.centre[:2]]))[0])
    support = floor
    for other in boxes:
        around = other.top > box.top and other.bottom < box.bottom
        if other is box or (other.top > box.bottom + SUPPORT_SLACK and not around):
            continue
        if footprint_overlap(box, other) > MIN_SUPPORT_SHARE * box.size[0] * box.size[1]:
            support = max(support, min(other.top, box.bottom))
    gap = box.bottom - support
    on_wall = any(
        abs(float(np.dot(w.normal, box.centre[:2])) - w.offset) - min(box.size[:2]) / 2 < NEAR_WALL
        for w in structure.walls_at(box.centre)
    )
    if not on_wall and gap > MAX_WALL_DROP and box.bottom - floor > MIN_HANGING and structure.ceiling_map is not None:
        ceiling = float(structure.ceiling_map.at(np.array([box.centre[:2]]))[0])
        if ceiling - box.top < UNDER_CEILING:
            lamp = max(box.size[:2]) < MAX_LAMP_SIDE and min(box.size[:2]) > MIN_LAMP_SHAPE * max(box.size[:2])
            cord = min(ceiling - box.top, MAX_CORD) if lamp else 0.0
            return replace(between(box, box.bottom, box.top + cord), hanging=True)
    if gap <= MIN_GAP or gap >= MAX_SUPPORT_GAP or (on_wall and gap > MAX_WALL_DROP):
        return box
    return between(box, box.bottom - gap, box.top)


def between(box: FittedBox, bottom: float, top: float) -> FittedBox:
    """The box with another bottom and top, world z in metres."""
    x, y, _ = box.centre
    return replace(box, centre=(x, y, (bottom + top) / 2), size=(box.size[0], box.size[1], top - bottom))


def grown(box: FittedBox, by: float) -> FittedBox:
    """The box, longer by so many metres along each of its axes."""
    x, y, z = box.size
    return replace(box, size=(x + by, y + by, z + by))
