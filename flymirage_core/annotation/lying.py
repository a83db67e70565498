"""What lies flat: rugs on the floor, keyboards on desks, and the plates that cones, signs and trolleys stand on.

Their height drowns in the noise of what they lie on, so they are found by colour and relief, like pictures on a wall.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox, Footprint, fit_footprint, on_floor
from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.fusion import convex_overlap, footprint_corners
from flymirage_core.annotation.room_structure import SEEN_TOO_HIGH, RoomStructure
from flymirage_core.annotation.supports import Face
from flymirage_core.annotation.wall_objects import MIN_POINTS, flat_things

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
Bool = NDArray[np.bool_]

MAX_LYING: Final = 0.045
"""Metres above or below a level face within which something lies flat on it."""
FLOOR_DEPTH: Final = 0.2
"""Metres below the upper limit of a floor within which its points are."""
RUG_THICKNESS: Final = 0.015
RIM: Final = (0.08, 0.3)
"""Metres beyond a flat region between which that is."""
MIN_MAT: Final = 0.025
"""Metres above what is beside it from which what lies on the floor is a mat, as thick as that."""
MIN_RUG: Final = 0.4
MAX_RUG: Final = 2.6
"""Metres of a rug's shorter side, at least and at most."""
THICKNESS: Final = 0.03
"""Metres, at least, of what lies on a table."""
MIN_SIDE: Final = 0.1
MIN_AREA: Final = 0.025
"""Metres of its shorter side and square metres."""
MIN_FACE_POINTS: Final = 100
MAX_FACE_SHARE: Final = 0.5
"""Of a face's area; what takes more of it is its own pattern."""
COVERED: Final = 0.5
"""Share of a flat region's plan under a thing, from which it is that thing's foot or shadow."""
MAX_BASE: Final = 1.1
"""Metres of a plate that something stands on."""
MAX_BASE_GROWTH: Final = 3.5
"""Area in plan of a thing with its plate over that without, ..."""
THIN: Final = 0.1
"""... to whose sides so many metres are added: signs are nearly nothing in plan."""
BASE_RIM: Final = 0.3
"""Metres beyond a thing's sides: a plate reaches half as far, and farther out is the ground, ..."""
MIN_CONTRAST: Final = 10.0
"""... from whose colour the thing's must differ by so much; ..."""
SAME: Final = 0.25
"""... the plate's differs by this share of it at most. Shadows are in between."""
LOWER_PART: Final = 0.3
"""Metres of a thing above the floor, whose colour its plate has."""
MIN_FOOT_POINTS: Final = 8


@dataclass(frozen=True, eq=False)
class Region:
    """A flat region of another colour on a level face: its plan, metres, and the fused points that it was seen by."""

    plan: Footprint
    members: NDArray[np.intp]
    height: float  # world z of its points, ...
    around: float  # ... and of what is beside it


def floor_regions(points: Float32, colours: Float32, structure: RoomStructure) -> list[Region]:
    """Regions of the floor; ``points``: (N, 3) fused. ``colours``: (N, 3) shading-free Lab."""
    height = points[:, 2] - structure.floor_top.at(points)
    seen = (height < 0) & (height > -FLOOR_DEPTH)
    if seen.sum() < MIN_POINTS:
        return []
    height -= np.median(height[seen])
    members = np.flatnonzero(np.abs(height) < MAX_LYING)
    return list(_regions(members, points, height, colours, structure.yaw))


def on_plates(
    boxes: Sequence[FittedBox], points: Float32, colours: Float32, building: Bool, structure: RoomStructure
) -> list[FittedBox]:
    """The boxes, those on the floor with the plate or feet that were culled with the floor, known by their colour."""
    floor = np.flatnonzero(building & (points[:, 2] < structure.floor_top.at(points)))
    floor = floor[np.argsort(points[floor, 0], kind="stable")]
    east = points[floor, 0]

    def beside(box: FittedBox) -> NDArray[np.intp]:
        """Floor as far east as a box and what is round it."""
        reach = max(box.size[:2]) + 2 * BASE_RIM
        return np.sort(floor[slice(*np.searchsorted(east, (box.centre[0] - reach, box.centre[0] + reach)))])

    return [_on_plate(box, beside(box), points, colours) if on_floor(box, structure) else box for box in boxes]


def _on_plate(box: FittedBox, floor: NDArray[np.intp], points: Float32, colours: Float32) -> FittedBox:
    if max(box.size[:2]) > MAX_BASE:
        return box
    plan = Footprint(np.array(box.centre[:2]), np.array(box.size[:2]), box.yaw)
    near = floor[(np.abs(points[floor, :2] - plan.centre) < max(box.size[:2]) + 2 * BASE_RIM).all(axis=1)]
    away = (np.abs(plan.local(points[near])) - plan.size / 2).max(axis=1)  # (K,) metres beyond the sides
    ground = near[(away > BASE_RIM) & (away < 2 * BASE_RIM)]
    lower = box.members[points[box.members, 2] < box.bottom + LOWER_PART]
    if len(ground) < MIN_FOOT_POINTS or len(lower) < MIN_FOOT_POINTS:
        return box
    own, under = np.median(colours[lower], axis=0), np.median(colours[ground], axis=0)
    contrast = float(colour_step(own, under))
    if contrast < MIN_CONTRAST:
        return box
    near = near[away < BASE_RIM / 2]
    foot = near[colour_step(colours[near], own) < SAME * contrast]
    if len(foot) < MIN_FOOT_POINTS:
        return box
    grown = fit_footprint(points[np.concatenate([lower, foot])], box.yaw)
    if grown.area < plan.area or grown.area > MAX_BASE_GROWTH * float(np.prod(plan.size + THIN)):
        return box
    x, y = (float(c) for c in grown.centre)
    size = (float(grown.size[0]), float(grown.size[1]), box.size[2])
    return replace(box, centre=(x, y, box.centre[2]), size=size, yaw=grown.yaw)


def rugs(regions: Sequence[Region], boxes: Sequence[FittedBox], structure: RoomStructure) -> list[FittedBox]:
    """Boxes of regions of the floor that nothing covers."""
    found = []
    for region in regions:
        if not MIN_RUG <= min(region.plan.size) <= MAX_RUG:
            continue
        if any(on_floor(box, structure) and _covers(box, region) for box in boxes):
            continue
        raised = region.height - region.around
        bottom, thickness = (region.around, raised) if raised > MIN_MAT else (region.height, RUG_THICKNESS)
        found.append(_flat_box(region, bottom - SEEN_TOO_HIGH, thickness))
    return found


def lying_on(
    faces: Sequence[Face], boxes: Sequence[FittedBox], points: Float32, colours: Float32, building: Bool
) -> list[FittedBox]:
    """Boxes of what lies flat on level faces of things where nothing stands; ``building``: (N,) of the points."""
    found = []
    for face in faces:
        height = points[:, 2] - face.level
        members = np.flatnonzero(~building & (np.abs(height) < MAX_LYING))
        members = members[(np.abs(face.plan.local(points[members])) < face.plan.size / 2).all(axis=1)]
        if len(members) < MIN_FACE_POINTS:
            continue
        for region in _regions(members, points, height, colours, face.plan.yaw):
            if min(region.plan.size) < MIN_SIDE or region.plan.area > MAX_FACE_SHARE * face.plan.area:
                continue
            if any(
                box.bottom > face.level - MAX_LYING and box.bottom < face.level + MAX_LYING and _covers(box, region)
                for box in boxes
            ):
                continue
            bottom = face.level - SEEN_TOO_HIGH
            found.append(_flat_box(region, bottom, max(THICKNESS, region.height - SEEN_TOO_HIGH - bottom)))
    return found


def _regions(
    members: NDArray[np.intp], points: Float32, height: Float32 | Float64, colours: Float32, yaw: float
) -> Iterator[Region]:
    """Flat regions of those ``members`` of the points that lie in a level face, whose axes run at ``yaw``."""
    c, s = np.cos(yaw), np.sin(yaw)
    axes = np.array([[c, s], [-s, c]])
    along, across = (points[members, :2] @ axis for axis in axes)
    for mine, (x, y), (w, h) in flat_things(along, across, height[members], colours[members], MIN_AREA, framed=False):
        plan = Footprint(np.array([x + w / 2, y + h / 2]) @ axes, np.array([w, h]), float(yaw % (np.pi / 2)))
        chosen = members[mine]
        away = (np.abs(plan.local(points[members])) - plan.size / 2).max(axis=1)  # metres beyond its sides
        beside = members[(away > RIM[0]) & (away < RIM[1])]
        height_of = [float(np.median(points[m, 2])) if len(m) else np.inf for m in (chosen, beside)]
        yield Region(plan, chosen, *height_of)


def _covers(box: FittedBox, region: Region) -> bool:
    return convex_overlap(footprint_corners(box), region.plan.corners) > COVERED * region.plan.area


def _flat_box(region: Region, bottom: float, thickness: float) -> FittedBox:
    x, y = (float(c) for c in region.plan.centre)
    size = (float(region.plan.size[0]), float(region.plan.size[1]), thickness)
    return FittedBox((x, y, bottom + thickness / 2), size, region.plan.yaw, region.members)
