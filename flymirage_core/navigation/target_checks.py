"""The paper's four checks of a candidate target (section III-C), in its order, each with its reason to reject.

Position: the drone is not inside of the object's box. Visibility: no occupied point in a cylinder round the ray from
the drone to the box, before the ray reaches the box. Waypoint safety: no occupied point round the target point.
Distance: the way there is at most 10 m long, and 2 m or more even as the crow flies.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.errors import PlanningError
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.queries import cylinder_is_clear, segment_is_free, sphere_is_clear
from flymirage_core.occupancy.search import shortest_path
from flymirage_core.occupancy.smoothing import smooth_path
from flymirage_core.settings import TaskSettings

Float64 = NDArray[np.float64]
Reason = Literal["inside_box", "occluded", "unsafe_waypoint", "distance"]

MAX_TARGET_SIZE: Final = 3.0
"""Metres. Longer boxes are walls, floors, counters round a room: one cannot be said to be in front of them."""
UNNAMED: Final = "object"
"""What annotators call a thing they cannot name."""
UNNAMED_SIZES: Final = (0.15, 1.8)
"""Metres: least second longest side and greatest longest side of an unnamed target. Slivers of edges and the panels of
walls and curtains, which captured rooms are full of, lie outside."""
FRAMING_STEPS: Final = 3
"""Distances tried between the one from which the whole object is seen and the least."""
STRUCTURE: Final = frozenset({"", "wall", "floor", "ceiling", "room", "unknown", "background"})
"""Labels that name no object to fly to."""
MAX_FINAL_ELEVATION: Final = np.tan(np.radians(18))
"""Slope. The target point sees the object's centre no further off the horizon than this: the camera is level."""
STEPS_LONGER: Final = 1.25
"""A shortest way in steps from voxel to voxel is up to an eighth longer than a smooth one, beside corners some more."""


@dataclass(frozen=True, eq=False)
class TaskSpace:
    """Where tasks are made."""

    grid: OccupancyGrid  # not inflated
    passable: OccupancyGrid  # free for the drone's centre
    reachable: NDArray[np.bool_]  # (X, Y, Z) the part of ``passable`` that c belongs to

    @cached_property
    def places(self) -> NDArray[np.intp]:
        """Flat indices (M,) of the voxels that can be reached."""
        return np.flatnonzero(self.reachable)


def is_sensible_target(box: ObjectBox) -> bool:
    """Whether one would send a drone there at all: neither the room nor as large, nor an unnamed sliver or panel."""
    if box.label == UNNAMED:
        _, second, longest = sorted(box.size)
        return UNNAMED_SIZES[0] <= second and longest <= UNNAMED_SIZES[1]
    return box.label not in STRUCTURE and max(box.size) <= MAX_TARGET_SIZE


def check_target(box: ObjectBox, drone: Float64, space: TaskSpace, settings: TaskSettings) -> Float64 | Reason:
    """The target point (3,) in front of ``box`` for a drone at ``drone`` (3,), or why there is none."""
    if box.contains(drone):
        return "inside_box"
    if not is_visible(box, drone, space.grid, settings.sight_radius):
        return "occluded"
    safe = [p for p in target_points(box, drone, settings, space.grid) if _is_safe(p, space, settings)]
    if not safe:
        return "unsafe_waypoint"
    seeing = [p for p in safe if is_visible(box, p, space.grid, settings.sight_radius)]
    if not seeing:
        return "occluded"
    best_at = {(float(p[0]), float(p[1])): p for p in reversed(seeing)}  # the best height at each distance from the box
    for point in reversed(best_at.values()):
        straight = float(np.linalg.norm(point - drone))
        if straight >= settings.min_distance and can_travel(space.passable, drone, point, settings.max_distance):
            return point
    return "distance"


def is_visible(box: ObjectBox, drone: Float64, grid: OccupancyGrid, sight_radius: float) -> bool:
    """The visibility check, along the ray to the box's centre.

    The ray counts as having reached the object one voxel before its box: voxels of its own surface stand out by up to
    that much, as boxes and voxels are measured apart.
    """
    centre = np.array(box.centre)
    start, half = box.to_local(drone), np.array(box.size) / 2 + grid.resolution
    outside = np.abs(start) > half
    if not outside.any():
        return True
    entry = float(((np.abs(start) - half)[outside] / np.abs(start)[outside]).max())  # share of the way to the centre
    return cylinder_is_clear(grid, drone, drone + entry * (centre - drone), sight_radius)


def target_points(box: ObjectBox, drone: Float64, settings: TaskSettings, grid: OccupancyGrid) -> list[Float64]:
    """Candidate target points (3,), best first: before the box, horizontally towards the drone.

    They stand off far enough to see all of a large object, else at less and at least at ``settings.stand_off``. Their
    heights are the object's centre's and others, nearest first, from which a level camera still sees it. None if the
    drone is right above or below the object.
    """
    centre = np.array(box.centre)
    towards = drone[:2] - centre[:2]
    horizontal = float(np.linalg.norm(towards))
    if horizontal < grid.resolution:
        return []
    towards = np.array([*(towards / horizontal), 0.0])
    along = np.abs(towards @ box.rotation)[:2]  # (2,) the direction along the box's own x and y
    half_depth = float(np.min(np.array(box.size[:2]) / 2 / np.maximum(along, 1e-9)))
    whole = max(settings.stand_off, settings.stand_off_per_size * max(box.size))
    points: list[Float64] = []
    for stand_off in np.unique(np.linspace(settings.stand_off, whole, FRAMING_STEPS))[::-1]:
        reach = half_depth + float(stand_off)
        steps = int(reach * MAX_FINAL_ELEVATION / grid.resolution)
        heights = sorted(range(-steps, steps + 1), key=lambda n: (abs(n), -n))
        points += [centre + towards * reach + [0.0, 0.0, n * grid.resolution] for n in heights]
    return points


def can_travel(passable: OccupancyGrid, start: Float64, end: Float64, max_distance: float) -> bool:
    """Whether the drone's way has at most ``max_distance`` metres: straight if that is free, else round things.

    No such way leaves the ball of that diameter round the middle (it stays in an ellipsoid whose foci are the ends), so
    nothing else is searched: the open air has millions of voxels.
    """
    if segment_is_free(passable, start, end):
        return float(np.linalg.norm(end - start)) <= max_distance
    middle, reach = (start + end) / 2, STEPS_LONGER * max_distance / 2
    near = passable.window(middle - reach, middle + reach)
    try:
        path = shortest_path(near, start, end)
    except PlanningError:
        return False
    return _length(path) <= max_distance or _length(smooth_path(near, path)) <= max_distance


def _length(path: Float64) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def _is_safe(point: Float64, space: TaskSpace, settings: TaskSettings) -> bool:
    """The waypoint safety check, and that the drone can get there."""
    cell = space.grid.index_of(point)
    inside = bool(space.grid.contains(cell))
    return inside and bool(space.reachable[tuple(cell)]) and sphere_is_clear(space.grid, point, settings.safety_radius)
