"""What is the place and not an object under an open sky: the ground, house fronts, fences and parapets.

There is no ceiling for a wall to reach; what closes an open-air place are upright faces longer than any object.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from flymirage_core.annotation.fused_points import Frame
from flymirage_core.annotation.room_structure import (
    ALONG_WALL,
    MAP_CELL,
    MIN_LEVEL_POINTS,
    PEAK_WINDOW,
    VERTICAL,
    WALL_BIN,
    WALL_THICKNESS,
    HeightMap,
    RoomStructure,
    Wall,
    aligned,
    floor_height,
    floor_relief,
    goes_on_behind,
    room_yaw,
    with_back,
)

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
Bool = NDArray[np.bool_]

UPWARDS: Final = 0.5
"""Sine of the elevation from which a ray looks up: at the sky, or at a ceiling."""
SKY_DISTANCE: Final = 25.0
"""Metres along such a ray; no ceiling is so far away."""
MIN_SKY: Final = 0.04
"""Share of sky among all that is seen upwards, from which a place is open."""
RAY_STEP: Final = 8
"""Every eighth pixel, both ways, is asked."""
MIN_FACE_POINTS: Final = 600
"""Points in three bins of offset (5 cm apart: 1.5 square metres) from which a face is looked at."""
FACE_DEPTH: Final = 0.07
"""Metres to both sides of a face within which its points lie: boards and courses of brick."""
FOOT: Final = 0.15
"""Metres above the ground where a face's columns begin ..."""
COLUMN_HEIGHT: Final = 2.4
"""... and end."""
BREAST: Final = 0.9
"""Metres above the ground that a column reaches: parapets do, counters do not."""
MIN_FILLED: Final = 3
"""Cells of a column in which the face is seen."""
MAX_GAP: Final = 1.65
"""Metres of a face that something before it may hide."""
MIN_LENGTH: Final = 6.5
"""Metres; shorter faces may be those of objects."""
MIN_SEEN: Final = 0.5
"""Share of a face's columns that are seen; rows of stalls have gaps, and posts above their counters."""
BEHIND: Final = 0.3
"""Metres behind a face from which a camera was behind it."""
HOUSE: Final = 3.0
"""Metres: what is lower, and has a camera on both sides, is a row of things."""
MAX_ROW_DEPTH: Final = 3.0
"""Metres before the face that ends the place, in which fences and stalls stand in rows as long as faces."""
FACE_CLEARANCE: Final = 0.08
FACE_SKIN: Final = 0.16
"""Metres, as of `Wall`; large places have large splats, whose faces are uneven, and the ground ..."""
GROUND_CLEARANCE: Final = 0.09
GROUND_RELIEF: Final = 0.22
"""... is seen higher than it is, by up to so many metres, ..."""
GROUND_SMOOTHING: Final = 11
"""... over many cells of its map (1.7 m): what is high over fewer is an object."""
GROUND_REACH: Final = 21
"""Cells (3.2 m), of whose heights ..."""
LOW: Final = 10
"""... this percentile is where things stand."""


def sees_sky(frames: Sequence[Frame]) -> bool:
    """Whether much of what is seen upwards is farther than any ceiling; what returns no depth says nothing."""
    sky = cover = 0
    for frame in frames:
        k = frame.camera.intrinsics
        u = (np.arange(0, k.width, RAY_STEP) + 0.5 - k.cx) / k.fx
        v = (np.arange(0, k.height, RAY_STEP) + 0.5 - k.cy) / k.fy
        rays = np.stack(np.broadcast_arrays(u[None], v[:, None], 1.0), axis=-1)  # (h, w, 3)
        length = np.linalg.norm(rays, axis=-1)
        depth = frame.depth[::RAY_STEP, ::RAY_STEP]
        up = (rays @ frame.camera.T_world_camera[2, :3] > UPWARDS * length) & (depth > 0)
        far = up & (depth * length > SKY_DISTANCE)
        sky += int(far.sum())
        cover += int(up.sum())
    return sky > MIN_SKY * cover


def find_open_air(points: Float32, normals: Float32, square: Float32, eyes: Float64) -> RoomStructure:
    """Ground, yaw and what closes the place; arguments as of `find_structure`.

    ``eyes``: (E, 3) where the cameras were. Behind a face that none of them was behind, all is out of reach: rooms that
    show through windows, the town beyond a fence.
    """
    floor = floor_height(points, normals)
    upright = (np.abs(normals[:, 2]) < VERTICAL) & (normals != 0).any(axis=1)
    yaw = room_yaw(points[upright], normals[upright])
    walls = [w for k in range(4) for w in _faces(points, normals, upright, yaw + k * np.pi / 2, floor)]
    walls = [wall for wall in walls if not any(goes_on_behind(other, wall, MAX_ROW_DEPTH) for other in walls)]
    yaw, walls = aligned(points, normals, upright, yaw, walls)
    closing = [_closing(with_back(wall, square), eyes, points) for wall in walls]
    relief = floor_relief(points, normals, floor, GROUND_RELIEF)
    seen = HeightMap(relief.origin, ndimage.median_filter(relief.heights, GROUND_SMOOTHING))
    ground = HeightMap(relief.origin, ndimage.percentile_filter(seen.heights, LOW, GROUND_REACH))
    top = seen.raised(GROUND_CLEARANCE)
    known = tuple(wall for wall in closing if wall is not None)
    return RoomStructure(floor, None, float(yaw % (np.pi / 2)), known, ground, top, None)


def _faces(points: Float32, normals: Float32, upright: Bool, azimuth: float, floor: float) -> list[Wall]:
    """Long upright faces whose normal has this azimuth."""
    normal = np.array([np.cos(azimuth), np.sin(azimuth)])
    direction = np.array([-normal[1], normal[0]])
    facing = upright & (normals[:, :2] @ normal > ALONG_WALL)
    if facing.sum() < 2 * MIN_LEVEL_POINTS:
        return []
    offsets, along = points[:, :2] @ normal, points[:, :2] @ direction  # (N,)
    mine = offsets[facing]
    counts, edges = np.histogram(mine, np.arange(mine.min() - 2 * WALL_BIN, mine.max() + 3 * WALL_BIN, WALL_BIN))
    counts = np.convolve(counts, [1, 1, 1], "same") - 1e-6 * np.arange(len(counts))  # of equal ones the first
    peaks = (counts >= ndimage.maximum_filter1d(counts, PEAK_WINDOW)) & (counts > MIN_FACE_POINTS)
    walls = []
    for j in np.flatnonzero(peaks):
        offset = float((edges[j] + edges[j + 1]) / 2)
        on = facing & (np.abs(offsets - offset) < FACE_DEPTH)
        offset = float(np.median(offsets[on]))
        stretches = _stretches(along[on], points[on, 2] - floor)
        slab = (WALL_THICKNESS, FACE_CLEARANCE, FACE_SKIN)
        walls += [Wall(normal, offset, start, end, offset, *slab) for start, end in stretches]
    return walls


def _stretches(along: Float32, heights: Float32) -> list[tuple[float, float]]:
    """Where a face goes on for longer than objects do: (start, end) along it; heights are above the ground."""
    origin = float(along.min()) - MAX_GAP
    columns = int((along.max() - origin + MAX_GAP) / MAP_CELL) + 1
    filled = np.zeros((columns, int(COLUMN_HEIGHT / MAP_CELL)), bool)
    row = np.floor((heights - FOOT) / MAP_CELL).astype(int)
    inside = (row >= 0) & (row < filled.shape[1])
    filled[((along[inside] - origin) / MAP_CELL).astype(int), row[inside]] = True
    tall = (filled.sum(axis=1) >= MIN_FILLED) & filled[:, int((BREAST - FOOT) / MAP_CELL) :].any(axis=1)
    numbers, count = ndimage.label(ndimage.binary_closing(tall, np.ones(int(MAX_GAP / MAP_CELL), bool)))
    found = []
    for k in range(1, count + 1):
        run = np.flatnonzero(numbers == k)
        if len(run) * MAP_CELL > MIN_LENGTH and tall[run].mean() > MIN_SEEN:
            found.append((origin + float(run[0]) * MAP_CELL, origin + float(run[-1] + 1) * MAP_CELL))
    return found


def _closing(wall: Wall, eyes: Float64, points: Float32) -> Wall | None:
    """The wall, without an end behind if no camera was there; else none, unless it is as high as a house."""
    along = eyes[:, :2] @ wall.direction
    if not ((wall.distance(eyes) < -BEHIND) & (along > wall.start) & (along < wall.end)).any():
        return replace(wall, thickness=np.inf)
    top = float(np.percentile(points[wall.contains(points), 2], 95))
    return wall if top > HOUSE else None
