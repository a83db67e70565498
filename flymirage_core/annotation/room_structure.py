"""What is the building and not an object: floor, ceiling, walls, and the direction they run in.

Estimated from a coarse cloud of fused points without a range limit; a room has few planes and they are large, so it
does not matter that far points are noisy.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
Bool = NDArray[np.bool_]

HORIZONTAL: Final = 0.92
"""|n_z| from which a surface counts as level."""
VERTICAL: Final = 0.25
"""|n_z| up to which a surface counts as upright."""
ALONG_WALL: Final = 0.93
"""Cosine from which an upright surface faces a given direction."""
HEIGHT_STEP: Final = 0.02
"""Metres; bins of the height histograms."""
FLOOR_PEAK: Final = 0.35
"""The floor is the lowest height whose level area is this share of the largest."""
CEILING_PEAK: Final = 0.5
MIN_ROOM_HEIGHT: Final = 1.9
DEFAULT_ROOM_HEIGHT: Final = 2.6
"""Where no ceiling is seen: how high up something must reach to be a wall."""
MIN_WALL_TOP: Final = 1.5
"""Metres of length along which a wall reaches the ceiling ..."""
UPPER_PART: Final = 1.2
"""... and so many metres below, of which ..."""
MIN_FILLED: Final = 0.6
"""... this share is seen."""
MAX_FURNITURE_DEPTH: Final = 0.7
"""Metres between a wall and the face of what stands at it, as high as the wall."""
MIN_TRIM: Final = 0.9
"""Metres along which trim reaches the ceiling ..."""
MAX_TRIM_DEPTH: Final = 0.25
"""... so far before it at most; it and what is below in its plane, panelling and headboards, count as wall."""
MAX_WALL_GAP: Final = 3.0
"""Metres of a wall that windows and cupboards may take."""
CEILING_REACH: Final = 0.45
"""Metres below the ceiling that count as reaching it."""
ABOVE_FURNITURE: Final = 2.3
"""Metres above the floor to which only walls reach, in rooms that are higher."""
MIN_TOP_AREA: Final = 0.4
"""Square metres up there from which much of a wall is seen there."""
MAX_BEHIND: Final = (0.004, 0.06)
"""Share of all points that may lie behind the outermost wall: if little of it is seen up there, and if much is."""
WALL_THICKNESS: Final = 0.12
"""Metres behind a wall's plane that still are the wall."""
WALL_CLEARANCE: Final = 0.06
"""Metres before it."""
WALL_SKIN: Final = 0.10
FLOOR_CLEARANCE: Final = 0.045
CEILING_CLEARANCE: Final = 0.07
BACK_PERCENTILE: Final = 25
"""Of the distances of points seen squarely: the wall itself, behind the flat things on it."""
MIN_SQUARE_POINTS: Final = 50
MAP_CELL: Final = 0.15
"""Metres; cells of the floor's and ceiling's height maps, which follow rugs, steps and coffers."""
SEEN_TOO_HIGH: Final = 0.018
"""Metres by which level surfaces are seen too high: of splats the nearer ones hide the others."""
FLOOR_RELIEF: Final = 0.09
"""Metres by which the floor may rise (rugs, a step) or fall."""
CEILING_RELIEF: Final = 0.7
MAX_YAW_SAMPLES: Final = 20_000
WALL_BIN: Final = 0.03
PEAK_WINDOW: Final = 9
"""Bins, of which a wall's is the fullest."""
MIN_PEAK_AREA: Final = 0.8
"""Square metres in three bins."""
ON_PLANE: Final = 0.05
"""Metres within which points belong to a plane that is being measured."""
MIN_OUTER_HEIGHT: Final = 1.2
"""Metres of height that the outermost plane shows at least."""
WALL_END: Final = 0.1
"""Metres that a wall's slab goes on beyond the points seen of it."""
REACH_ON: Final = 0.5
"""Metres beyond its seen end that a wall is taken to go on behind things that stand there."""
MAX_TURN: Final = 0.06
"""Radians; walls that would turn the yaw by more are not straight."""
SHARPNESS_BIN: Final = 0.04
MIN_LEVEL_POINTS: Final = 50


@dataclass(frozen=True, eq=False)
class Wall:
    """An upright plane ``normal . xy = offset``; the room is on the side that the normal points to."""

    normal: Float64  # (2,) unit
    offset: float
    start: float  # extent along `direction`
    end: float
    back: (
        float  # offset of the plane as seen straight on; `offset` is that of most of its points, which come out nearer
    )
    thickness: float = WALL_THICKNESS  # metres behind the plane that still are the wall
    clearance: float = WALL_CLEARANCE  # metres before it that are
    skin: float = WALL_SKIN  # metres before it where what faces as the wall does is the wall, seen askance

    @property
    def direction(self) -> Float64:
        return np.array([-self.normal[1], self.normal[0]])  # (2,)

    def distance(self, points: Float32 | Float64) -> Float64:
        """Metres (N,) from the plane into the room, of points (N, 2 or 3)."""
        return np.asarray(points[:, :2] @ self.normal - self.offset, np.float64)

    def contains(self, points: Float32 | Float64) -> Bool:
        """(N,) whether points (N, 3) belong to the wall's slab."""
        return np.asarray(self.spans(points) & (self.distance(points) < self.clearance))

    def spans(self, points: Float32 | Float64) -> Bool:
        """(N,) whether points (N, 3) lie in the wall or before it within its skin."""
        along = points[:, :2] @ self.direction
        distance = self.distance(points)
        near = (distance < self.skin) & (distance > -self.thickness)
        return np.asarray(near & (along > self.start - WALL_END) & (along < self.end + WALL_END))


@dataclass(frozen=True, eq=False)
class HeightMap:
    """Heights on a grid of cells of `MAP_CELL`; constant beyond its edges."""

    origin: Float64  # (2,)
    heights: Float64  # (X, Y) metres

    def at(self, points: Float32 | Float64) -> Float64:
        """(N,) heights at points (N, 2 or 3)."""
        cells = np.clip(((points[:, :2] - self.origin) / MAP_CELL).astype(int), 0, np.array(self.heights.shape) - 1)
        return np.asarray(self.heights[cells[:, 0], cells[:, 1]])

    def raised(self, by: float) -> "HeightMap":
        return HeightMap(self.origin, self.heights + by)


@dataclass(frozen=True, eq=False)
class RoomStructure:
    """The building round the objects. World frame, metres; ``yaw`` in [0, pi/2) is the direction of its walls."""

    floor: float
    ceiling: float | None
    yaw: float
    walls: tuple[Wall, ...]
    floor_map: HeightMap  # what things stand on
    floor_top: HeightMap  # below this all is floor
    ceiling_map: HeightMap | None

    def contains(self, points: Float32) -> Bool:
        """(N,) whether points (N, 3) belong to the floor, the ceiling or a wall.

        Only slabs belong to it, never all that is behind a wall: a flat has more than one room.
        """
        inside = points[:, 2] <= self.floor_top.at(points)
        if self.ceiling_map is not None:
            inside |= points[:, 2] >= self.ceiling_map.at(points) - CEILING_CLEARANCE
        for wall in self.walls:
            inside |= wall.contains(points)
        return np.asarray(inside)

    def is_wall_skin(self, points: Float32, normals: Float32) -> Bool:
        """(N,) whether points (N, 3) with ``normals`` (N, 3) lie just before a wall and face as it does: its noise."""
        skin = np.zeros(len(points), bool)
        for wall in self.walls:
            skin |= wall.spans(points) & (normals[:, :2] @ wall.normal > ALONG_WALL)
        return skin

    def walls_at(self, centre: tuple[float, float, float]) -> list[Wall]:
        """The walls that go on as far along as a thing at ``centre``; the others end somewhere else."""
        along = [float(np.dot(w.direction, centre[:2])) for w in self.walls]
        return [w for w, a in zip(self.walls, along, strict=True) if w.start - REACH_ON < a < w.end + REACH_ON]

    def wall_gap(self, centre: tuple[float, float, float], depth: float) -> float:
        """Metres between the nearest wall and a thing of ``depth`` metres at ``centre``; inf without walls."""
        gaps = [float(np.dot(w.normal, centre[:2])) - w.back - depth / 2 for w in self.walls_at(centre)]
        return min((abs(gap) for gap in gaps), default=float("inf"))


def find_structure(points: Float32, normals: Float32, square: Float32, voxel: float) -> RoomStructure:
    """Floor, ceiling, walls and yaw of a scene; without points its floor is at 0 and there is nothing else.

    Args:
        points: (N, 3) fused points of the whole scene, ``voxel`` metres apart.
        normals: (N, 3) of theirs.
        square: (M, 3) fused points of only those pixels that saw a surface squarely.
        voxel: metres.
    """
    if len(points) == 0:
        level = HeightMap(np.zeros(2), np.zeros((1, 1)))
        return RoomStructure(0.0, None, 0.0, (), level, level.raised(FLOOR_CLEARANCE), None)
    floor = floor_height(points, normals)
    ceiling = _ceiling(points, normals, floor)
    upright = np.abs(normals[:, 2]) < VERTICAL
    upright &= (normals != 0).any(axis=1)
    yaw = room_yaw(points[upright], normals[upright])
    ceiling_reach = ceiling - CEILING_REACH if ceiling is not None else floor + DEFAULT_ROOM_HEIGHT - CEILING_REACH
    reach = (min(ceiling_reach, floor + ABOVE_FURNITURE), ceiling_reach)
    walls = [w for k in range(4) for w in _walls_facing(points, normals, upright, yaw + k * np.pi / 2, reach, voxel)]
    yaw, walls = aligned(points, normals, upright, yaw, walls)
    walls = [with_back(wall, square) for wall in walls]
    ceiling_map = None
    if ceiling is not None:
        ceiling_map = _height_map(
            points, (normals[:, 2] < -HORIZONTAL) & (points[:, 2] > ceiling - CEILING_RELIEF), ceiling
        )
    relief = floor_relief(points, normals, floor, FLOOR_RELIEF)
    top = relief.raised(FLOOR_CLEARANCE)
    ground = relief.raised(-SEEN_TOO_HIGH)
    return RoomStructure(floor, ceiling, float(yaw % (np.pi / 2)), tuple(walls), ground, top, ceiling_map)


def room_yaw(points: Float32, normals: Float32) -> float:
    """Direction, modulo 90 degrees, whose upright points pile up in the sharpest planes; radians.

    A histogram of normals is not enough: round things and noise smear it by many degrees.
    """
    step = max(1, len(points) // MAX_YAW_SAMPLES)
    xy, facing = points[::step, :2].astype(np.float64), normals[::step, :2].astype(np.float64)
    coarse = np.radians(np.arange(0, 90, 1.0))
    best = coarse[int(np.argmax([_sharpness(xy, facing, yaw) for yaw in coarse]))]
    fine = best + np.radians(np.arange(-1, 1.01, 0.2))
    return float(fine[int(np.argmax([_sharpness(xy, facing, yaw) for yaw in fine]))])


def _sharpness(xy: Float64, facing: Float64, yaw: float) -> float:
    """Sum of squared histogram counts of the points' offsets along the two axes at ``yaw``."""
    total = 0.0
    for angle in (yaw, yaw + np.pi / 2):
        axis = np.array([np.cos(angle), np.sin(angle)])
        offsets = xy[np.abs(facing @ axis) > ALONG_WALL] @ axis
        if len(offsets):
            counts = np.bincount(((offsets - offsets.min()) / SHARPNESS_BIN).astype(int))
            total += float((counts.astype(np.float64) ** 2).sum())
    return total


def floor_height(points: Float32, normals: Float32) -> float:
    """The lowest height at which much of the surface looks up."""
    level = points[normals[:, 2] > HORIZONTAL, 2]
    if len(level) < MIN_LEVEL_POINTS:
        return float(points[:, 2].min())
    return _first_peak(level, FLOOR_PEAK)


def _ceiling(points: Float32, normals: Float32, floor: float) -> float | None:
    level = points[normals[:, 2] < -HORIZONTAL, 2]
    if len(level) < 4 * MIN_LEVEL_POINTS:
        return None
    ceiling = -_first_peak(-level, CEILING_PEAK)
    return ceiling if ceiling - floor > MIN_ROOM_HEIGHT else None


def _first_peak(heights: Float32, share: float) -> float:
    """The lowest local maximum of the heights' histogram that starts where it passes ``share`` of its maximum."""
    counts, edges = np.histogram(
        heights, np.arange(heights.min() - 2 * HEIGHT_STEP, heights.max() + 3 * HEIGHT_STEP, HEIGHT_STEP)
    )
    i = int(np.flatnonzero(counts > share * counts.max())[0])
    while i + 1 < len(counts) and counts[i + 1] > counts[i]:
        i += 1
    return float((edges[i] + edges[i + 1]) / 2)


def _walls_facing(
    points: Float32, normals: Float32, upright: Bool, azimuth: float, reach: tuple[float, float], voxel: float
) -> list[Wall]:
    """Walls whose normal has this azimuth.

    ``reach``: metres above which only walls reach, and above which something reaches the ceiling.
    """
    normal = np.array([np.cos(azimuth), np.sin(azimuth)])
    direction = np.array([-normal[1], normal[0]])
    facing = upright & (normals[:, :2] @ normal > ALONG_WALL)
    if facing.sum() < 2 * MIN_LEVEL_POINTS:
        return []
    offsets, along, heights = points[facing, :2] @ normal, points[facing, :2] @ direction, points[facing, 2]
    all_offsets = points[:, :2] @ normal
    counts, edges = np.histogram(
        offsets, np.arange(offsets.min() - 2 * WALL_BIN, offsets.max() + 3 * WALL_BIN, WALL_BIN)
    )
    smoothed = np.convolve(counts, [1, 1, 1], "same") - 1e-6 * np.arange(len(counts))  # of equal ones the first
    peaks = (smoothed >= ndimage.maximum_filter1d(smoothed, PEAK_WINDOW)) & (smoothed * voxel**2 > MIN_PEAK_AREA)
    walls, trims = [], []
    for j in np.flatnonzero(peaks):
        offset = (edges[j] + edges[j + 1]) / 2
        on = np.abs(offsets - offset) < ON_PLANE
        offset = float(np.median(offsets[on]))
        behind = (all_offsets < offset - WALL_THICKNESS).mean()
        high = (heights[on] > reach[0]).sum() * voxel**2 > MIN_TOP_AREA
        whole = Wall(normal, offset, float(along[on].min()), float(along[on].max()), offset)
        if behind < MAX_BEHIND[int(high)] and np.ptp(heights[on]) > MIN_OUTER_HEIGHT:
            walls.append(whole)
            continue
        walls += [Wall(normal, offset, *ends, offset) for ends in _stretches(along[on], heights[on], reach[0])]
        if len(np.unique((along[on][heights[on] > reach[1]] / MAP_CELL).astype(int))) * MAP_CELL > MIN_TRIM:
            trims.append(whole)
    walls = [wall for wall in walls if not any(goes_on_behind(other, wall, MAX_FURNITURE_DEPTH) for other in walls)]
    return walls + [trim for trim in trims if any(goes_on_behind(w, trim, MAX_TRIM_DEPTH) for w in walls)]


def goes_on_behind(other: Wall, wall: Wall, depth: float) -> bool:
    """Whether another wall goes on within ``depth`` metres behind one, which then is something before it."""
    parallel = other.normal @ wall.normal > ALONG_WALL and 0 < wall.offset - other.offset < depth
    return bool(parallel and other.start - REACH_ON < wall.start and wall.end < other.end + REACH_ON)


def _stretches(along: Float32, heights: Float32, top: float) -> list[tuple[float, float]]:
    """Where a plane goes on from breast height to above ``top``: (start, end) along it.

    Beams lie in one plane with the furniture below them; between the two there is nothing.
    """
    origin, foot = float(along.min()) - MAX_WALL_GAP, top - UPPER_PART  # room for the closing at both ends
    columns = int((along.max() - origin + MAX_WALL_GAP) / MAP_CELL) + 1
    filled = np.zeros((columns, int(UPPER_PART / MAP_CELL) + 1), bool)
    row = np.floor((heights - foot) / MAP_CELL).astype(int)
    inside = row >= 0
    filled[((along[inside] - origin) / MAP_CELL).astype(int), np.minimum(row[inside], filled.shape[1] - 1)] = True
    tall = filled[:, -1] & (filled.mean(axis=1) >= MIN_FILLED)
    numbers, count = ndimage.label(ndimage.binary_closing(tall, np.ones(int(MAX_WALL_GAP / MAP_CELL), bool)))
    runs = [np.flatnonzero(numbers == k) for k in range(1, count + 1)]
    return [
        (origin + float(run[0]) * MAP_CELL, origin + float(run[-1] + 1) * MAP_CELL)
        for run in runs
        if tall[run].sum() * MAP_CELL > MIN_WALL_TOP
    ]


def aligned(
    points: Float32, normals: Float32, upright: Bool, yaw: float, walls: list[Wall]
) -> tuple[float, list[Wall]]:
    """The yaw refined by straight lines through the walls' own points, and the walls turned accordingly."""
    turns, weights = [], []
    for wall in walls:
        on = points[
            upright & (np.abs(wall.distance(points)) < ON_PLANE) & (normals[:, :2] @ wall.normal > ALONG_WALL), :2
        ]
        if len(on) < MIN_SQUARE_POINTS:
            continue
        centred = (on - on.mean(axis=0)).astype(np.float64)
        values, vectors = np.linalg.eigh(centred.T @ centred)
        run = np.arctan2(vectors[1, 1], vectors[0, 1]) - yaw
        turns.append((run + np.pi / 4) % (np.pi / 2) - np.pi / 4)
        weights.append(values[1])
    turn = float(np.average(turns, weights=weights)) if turns else 0.0
    if abs(turn) > MAX_TURN or turn == 0.0:
        return yaw, walls
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    turned = []
    for wall in walls:
        normal = rotation @ wall.normal
        facing = (
            upright
            & (np.abs(points[:, :2] @ normal - wall.offset) < 2 * ON_PLANE)
            & (normals[:, :2] @ normal > ALONG_WALL)
        )
        offset = float(np.median(points[facing, :2] @ normal)) if facing.any() else wall.offset
        turned.append(replace(wall, normal=normal, offset=offset, back=offset))
    return yaw + turn, turned


def with_back(wall: Wall, square: Float32) -> Wall:
    """The wall with its plane measured by points (N, 3) that cameras looked at squarely, if there are some."""
    distance = wall.distance(square)
    along = square[:, :2] @ wall.direction
    near = (np.abs(distance) < WALL_THICKNESS) & (along > wall.start) & (along < wall.end)
    if near.sum() < MIN_SQUARE_POINTS:
        return wall
    return replace(wall, back=wall.offset + float(np.percentile(distance[near], BACK_PERCENTILE)))


def floor_relief(points: Float32, normals: Float32, floor: float, relief: float) -> HeightMap:
    """The heights of a floor within ``relief`` of ``floor``, of points (N, 3) with ``normals`` (N, 3)."""
    level = (normals[:, 2] > HORIZONTAL) & (np.abs(points[:, 2] - floor) < relief)
    return _height_map(points, level, floor)


def _height_map(points: Float32, level: Bool, default: float) -> HeightMap:
    """Median heights of the ``level`` points in each cell, gaps filled from the nearest cell, smoothed."""
    origin = points[:, :2].min(axis=0).astype(np.float64)
    shape = ((points[:, :2].max(axis=0) - origin) / MAP_CELL).astype(int) + 1
    cells = ((points[level, :2] - origin) / MAP_CELL).astype(int)
    flat, heights = cells[:, 0] * shape[1] + cells[:, 1], points[level, 2]
    order = np.lexsort((heights, flat))
    flat, heights = flat[order], heights[order]
    found, starts, counts = np.unique(flat, return_index=True, return_counts=True)
    grid = np.full(int(shape.prod()), np.nan)
    known = counts >= 2
    grid[found[known]] = heights[(starts + counts // 2)[known]]
    grid = grid.reshape(shape)
    if np.isnan(grid).all():
        return HeightMap(origin, np.full(shape, default))
    nearest = ndimage.distance_transform_edt(np.isnan(grid), return_distances=False, return_indices=True)
    return HeightMap(origin, ndimage.median_filter(grid[tuple(nearest)], 5))
