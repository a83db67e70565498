"""Flat things on walls (pictures, mirrors, screens, boards, windows): found by their colour in a raster of each wall."""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.room_structure import RoomStructure, Wall

Float32 = NDArray[np.float32]

CELL: Final = 0.04
"""Metres; cells of a wall's raster."""
MAX_DEPTH: Final = 0.07
"""Metres before or behind the wall's plane; what stands out further is a thing of its own."""
MIN_COLOUR_STEP: Final = 9.0
MIN_AREA: Final = 0.06
"""Square metres."""
MIN_SIDE: Final = 0.15
MIN_FILL: Final = 0.55
"""Least share of the bounding rectangle: flat things are rectangles or discs, shadows are not."""
MIN_HEIGHT: Final = 0.25
"""Metres above the floor; lower down it is a skirting board, or the colour of furniture on the wall behind it."""
MIN_TALL: Final = 1.6
"""... unless it is as high as a door."""
MAX_WALL_SHARE: Final = 0.5
"""A region that covers more of the wall's length and height is paint."""
MIN_THICKNESS: Final = 0.03


def wall_objects(points: Float32, colours: Float32, structure: RoomStructure) -> list[FittedBox]:
    """Boxes of what differs in colour from the wall it lies on.

    ``points``: (N, 3) world, metres, structure included. ``colours``: (N, 3) shading-free Lab.
    """
    found = []
    for wall in structure.walls:
        members = np.flatnonzero(wall.contains(points) & (np.abs(wall.distance(points)) < MAX_DEPTH))
        if len(members) >= 200:
            found += _on_wall(wall, members, points[members], colours[members], structure.floor)
    return found


def _on_wall(wall: Wall, members: NDArray[np.intp], points: Float32, colours: Float32, floor: float) -> list[FittedBox]:
    along, height, depth = points[:, :2] @ wall.direction, points[:, 2], wall.distance(points)
    origin = np.array([along.min(), height.min()])
    column = ((along - origin[0]) / CELL).astype(int)
    row = ((height - origin[1]) / CELL).astype(int)
    shape = (int(row.max()) + 1, int(column.max()) + 1)
    seen, image = _raster(row, column, colours, shape)
    paint = np.median(image[seen], axis=0)
    different = (seen & (colour_step(image, paint) > MIN_COLOUR_STEP)).astype(np.uint8)
    kernel = np.ones((3, 3), np.uint8)
    closed = cv2.morphologyEx(different, cv2.MORPH_CLOSE, kernel)
    opened = cv2.morphologyEx(closed, cv2.MORPH_OPEN, kernel)
    count, regions, stats, _ = cv2.connectedComponentsWithStats(opened, connectivity=8)
    boxes = []
    for k in range(1, count):
        x, y, w, h, cells = (int(v) for v in stats[k])
        bottom = origin[1] + y * CELL
        if not _is_flat_thing(w * CELL, h * CELL, cells * CELL**2, float(bottom) - floor):
            continue
        if w > MAX_WALL_SHARE * shape[1] and h > MAX_WALL_SHARE * shape[0]:
            continue
        mine = regions[row, column] == k
        thickness = max(MIN_THICKNESS, float(np.percentile(depth[mine], 95)))
        xy = wall.normal * (wall.offset + thickness / 2) + wall.direction * (origin[0] + (x + w / 2) * CELL)
        yaw = float(np.arctan2(wall.direction[1], wall.direction[0]))
        centre = (float(xy[0]), float(xy[1]), float(bottom + h * CELL / 2))
        boxes.append(FittedBox(centre, (w * CELL, thickness, h * CELL), yaw, members[mine], on_wall=True))
    return boxes


def _raster(
    row: NDArray[np.int64], column: NDArray[np.int64], colours: Float32, shape: tuple[int, int]
) -> tuple[NDArray[np.bool_], Float32]:
    """Which cells were seen (H, W) and their mean colour (H, W, 3)."""
    counts = np.zeros(shape, np.float32)
    image = np.zeros((*shape, 3), np.float32)
    np.add.at(counts, (row, column), 1)
    np.add.at(image, (row, column), colours)
    return counts > 0, image / np.maximum(counts, 1)[..., None]


def _is_flat_thing(width: float, height: float, area: float, clearance: float) -> bool:
    large = area >= MIN_AREA and min(width, height) >= MIN_SIDE
    return large and area >= MIN_FILL * width * height and (clearance >= MIN_HEIGHT or height >= MIN_TALL)
