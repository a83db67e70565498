"""Camera paths to Algorithm 1's targets: A* on an inflated grid, smoothed, with a four-view rig at each position."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter1d

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.annotation.targets import Targets
from flymirage_core.errors import PlanningError
from flymirage_core.occupancy.distance import inflate
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.search import nearest_free, reachable, shortest_path
from flymirage_core.occupancy.smoothing import resample_path, smooth_path
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.placements import four_view_rig
from flymirage_core.settings import ExplorationSettings

Bool = NDArray[np.bool_]
Float64 = NDArray[np.float64]

CENTRE_TOLERANCE: Final = 0.5
"""Metres by which a path's start may be moved from c if c itself lies within an inflated obstacle."""
CLEARANCE_STEPS: Final = (1.0, 0.75, 0.5)
"""Shares of the clearance that are tried in turn when c has no room for all of it."""
HEADING_SMOOTHING: Final = 1.0
"""Standard deviation, in rig positions, of the smoothing of the tangent."""


@dataclass(frozen=True, eq=False)
class ExplorationPath:
    """Where rigs are placed on the way from c to a target."""

    target: ObjectBox
    positions: Float64  # (K, 3) world, metres
    headings: Float64  # (K,) radians, counter-clockwise from +x
    gap: float  # metres from the last position to the target's box
    reached: bool  # whether the gap is within the stand-off

    @property
    def name(self) -> str:
        """The group's name in `PosedViews`; says how far from its target the path had to end."""
        name = f"target {self.target.object_id} {self.target.label}"
        return name if self.reached else f"{name} (path ends {self.gap:.1f} m before it)"


def explore(
    grid: OccupancyGrid, centre: ArrayLike, targets: Targets, settings: ExplorationSettings, intrinsics: Intrinsics
) -> tuple[list[Camera], list[str]]:
    """Cameras of the exploration pass and the group of each (section III-B).

    Four cameras (front, left, right, back) at each position of `exploration_paths`; groups are named
    "target <object_id> <label>". No targets: two empty lists.

    Raises:
        PlanningError: c has no free space round it.
    """
    cameras: list[Camera] = []
    groups: list[str] = []
    for path in exploration_paths(grid, centre, targets, settings):
        for position, heading in zip(path.positions, path.headings, strict=True):
            rig = four_view_rig(position, float(heading), intrinsics)
            cameras += rig
            groups += [path.name] * len(rig)
    return cameras, groups


def exploration_paths(
    grid: OccupancyGrid, centre: ArrayLike, targets: Targets, settings: ExplorationSettings
) -> list[ExplorationPath]:
    """One path from c for each target: A* in the inflated grid, collision-aware Laplacian smoothing, equal spacing.

    A path ends at the free place nearest to c from which the target's box is within ``stand_off``; where no such place
    can be reached, at the reachable place nearest to the box, and `ExplorationPath.reached` is False.

    Raises:
        PlanningError: c has no free space round it.
    """
    if not targets.boxes:
        return []
    inflated, start = _inflated_round(grid, np.asarray(centre, float), settings.clearance)
    places = reachable(inflated, start)  # (X, Y, Z)
    return [_path_to(box, inflated, start, places, settings) for box in targets.boxes]


def _inflated_round(grid: OccupancyGrid, centre: Float64, clearance: float) -> tuple[OccupancyGrid, Float64]:
    """The inflated grid and a free start near c, with less clearance if c has no room for all of it."""
    for share in CLEARANCE_STEPS:
        inflated = inflate(grid, share * clearance)
        try:
            return inflated, nearest_free(inflated, centre, CENTRE_TOLERANCE)
        except PlanningError:
            continue
    raise PlanningError(
        f"exploration: nowhere within {CENTRE_TOLERANCE:g} m of the scene centre is "
        f"{CLEARANCE_STEPS[-1] * clearance:g} m clear of obstacles; give another centre, or lower exploration.clearance"
    )


def _path_to(
    box: ObjectBox, inflated: OccupancyGrid, start: Float64, places: Bool, settings: ExplorationSettings
) -> ExplorationPath:
    goal = _viewpoint(box, inflated, start, places, settings.stand_off)
    path = smooth_path(inflated, shortest_path(inflated, start, goal))
    positions = resample_path(path, settings.rig_spacing)  # (K, 3)
    gap = float(box.distance(positions[-1]))
    return ExplorationPath(
        box, positions, smooth_headings(positions), gap, gap <= settings.stand_off + inflated.resolution
    )


def _viewpoint(box: ObjectBox, grid: OccupancyGrid, start: Float64, places: Bool, stand_off: float) -> Float64:
    """The place (3,) to look from: of those within the stand-off the nearest to c, else the nearest to the box.

    ``places``: (X, Y, Z) which voxels can be reached; some can. They are looked for ever farther from the box, as in
    the open air there are millions.
    """
    reach = stand_off
    while True:
        candidates = _places_near(box, grid, places, reach)  # (M, 3)
        gaps = box.distance(candidates)  # (M,)
        if (gaps <= stand_off).any():
            candidates = candidates[gaps <= stand_off]
            return np.asarray(candidates[int(np.argmin(np.linalg.norm(candidates - start, axis=1)))])
        if (gaps <= reach).any():
            return np.asarray(candidates[int(np.argmin(gaps))])
        reach *= 2


def _places_near(box: ObjectBox, grid: OccupancyGrid, places: Bool, reach: float) -> Float64:
    """Centres (M, 3) of the ``places`` in the upright block of voxels round the box grown by ``reach`` metres."""
    lower, upper = box.corners.min(axis=0) - reach, box.corners.max(axis=0) + reach
    first = np.clip(grid.index_of(lower), 0, grid.state.shape)
    last = np.clip(grid.index_of(upper) + 1, 0, grid.state.shape)
    block = places[first[0] : last[0], first[1] : last[1], first[2] : last[2]]
    return grid.centre_of(np.argwhere(block) + first)


def smooth_headings(positions: Float64) -> Float64:
    """(K,) azimuth of the temporally smoothed tangent at each position (K, 3); 0 where the path has no horizontal part.

    Unit tangents are averaged, not angles, so that nothing happens at +-pi; where a path climbs straight up, the
    heading of its neighbours holds.
    """
    if len(positions) < 2:
        return np.zeros(len(positions))
    tangents = np.gradient(positions[:, :2], axis=0)  # (K, 2)
    lengths = np.linalg.norm(tangents, axis=1, keepdims=True)
    units = np.divide(tangents, lengths, out=np.zeros_like(tangents), where=lengths > 1e-6)
    smoothed = gaussian_filter1d(units, HEADING_SMOOTHING, axis=0, mode="nearest")  # (K, 2)
    return np.arctan2(smoothed[:, 1], smoothed[:, 0])
