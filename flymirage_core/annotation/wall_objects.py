"""Flat things on walls (pictures, mirrors, screens, boards, windows), found by colour in a raster of each wall."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.room_structure import RoomStructure, Wall

Float32 = NDArray[np.float32]

CELL: Final = 0.04
"""Metres; cells of a wall's raster."""
MAX_DEPTH: Final = 0.07
"""Metres before or behind the wall's plane; what stands out further is a thing of its own."""
MAX_PAINT_STEP: Final = 3.0
"""Colour step between neighbouring cells up to which both are bare wall."""
MIN_BARE_SHARE: Final = 0.3
"""Of the cells of a stretch of wall seen in one piece; its largest region is bare wall if it has this share."""
FRONT_PERCENTILE: Final = 60
MIN_AREA: Final = 0.06
"""Square metres."""
MIN_SIDE: Final = 0.15
MAX_SHORT_SIDE: Final = 1.6
"""Metres; what is larger both ways is a part of the wall."""
MIN_FILL: Final = 0.55
"""Least share of the bounding rectangle: flat things are rectangles or discs, shadows are not."""
MIN_HEIGHT: Final = 0.25
"""Metres above the floor; lower down it is a skirting board, or the colour of furniture on the wall behind it."""
MIN_TALL: Final = 1.6
"""... unless it is as high as a door."""
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
    seen, image = _raster(row, column, colours, (int(row.max()) + 1, int(column.max()) + 1))
    regions = _things(seen, image)
    boxes = []
    for k in range(1, regions.max() + 1):
        rows, columns = np.nonzero(regions == k)
        (y, x), (h, w) = (rows.min(), columns.min()), (np.ptp(rows) + 1, np.ptp(columns) + 1)
        bottom = float(origin[1] + y * CELL)
        if not _is_flat_thing(w * CELL, h * CELL, len(rows) * CELL**2, bottom - floor):
            continue
        mine = regions[row, column] == k
        front = wall.offset + float(np.percentile(depth[mine], FRONT_PERCENTILE))
        thickness = max(MIN_THICKNESS, front - wall.back)
        xy = wall.normal * (wall.back + thickness / 2) + wall.direction * (origin[0] + (x + w / 2) * CELL)
        yaw = float(np.arctan2(wall.direction[1], wall.direction[0]))
        centre = (float(xy[0]), float(xy[1]), bottom + h * CELL / 2)
        size = (w * CELL, thickness, h * CELL)
        boxes.append(FittedBox(centre, size, yaw, members[mine], on_wall=True))
    return boxes


def _raster(
    row: NDArray[np.int64], column: NDArray[np.int64], colours: Float32, shape: tuple[int, int]
) -> tuple[NDArray[np.bool_], Float32]:
    """Which cells were seen (H, W) and their mean colour (H, W, 3)."""
    counts = np.zeros(shape, np.float32)
    image = np.zeros((*shape, 3), np.float32)
    np.add.at(counts, (row, column), 1)
    np.add.at(image, (row, column), colours)
    return counts > 0, np.asarray(image / np.maximum(counts, 1)[..., None], np.float32)


def _things(seen: NDArray[np.bool_], image: Float32) -> NDArray[np.intp]:
    """(H, W) number of the thing that each cell of a wall's raster belongs to, 0 = bare wall or not seen.

    The bare wall is the largest region whose neighbouring cells differ little: light may fade across it as it likes. A
    thing is what is left, with what it surrounds.
    """
    numbers = np.arange(seen.size).reshape(seen.shape)
    pairs = []
    for a, b in (
        ((slice(1, None), slice(None)), (slice(None, -1), slice(None))),
        ((slice(None), slice(1, None)), (slice(None), slice(None, -1))),
    ):
        alike = seen[a] & seen[b] & (colour_step(image[a], image[b]) < MAX_PAINT_STEP)
        pairs.append(np.stack([numbers[a][alike], numbers[b][alike]], axis=1))
    edges = np.concatenate(pairs)
    graph = coo_matrix((np.ones(len(edges), np.int8), (edges[:, 0], edges[:, 1])), shape=(seen.size, seen.size))
    labels = connected_components(graph, directed=False)[1].reshape(seen.shape)
    bare = seen & np.isin(labels, _bare_regions(seen, labels))
    kernel = np.ones((3, 3), bool)
    other = ndimage.binary_opening(ndimage.binary_fill_holes(seen & ~bare), kernel)
    return np.asarray(ndimage.label(other, kernel)[0], np.intp)


def _bare_regions(seen: NDArray[np.bool_], labels: NDArray[np.int32]) -> list[int]:
    """Numbers of the regions that are bare wall: the largest of each stretch of wall that is seen in one piece."""
    stretches, count = ndimage.label(seen, np.ones((3, 3), bool))
    bare = []
    for k in range(1, count + 1):
        found, counts = np.unique(labels[stretches == k], return_counts=True)
        if counts.max() >= MIN_BARE_SHARE * counts.sum():
            bare.append(int(found[counts.argmax()]))
    return bare


def _is_flat_thing(width: float, height: float, area: float, clearance: float) -> bool:
    sizes = area >= MIN_AREA and min(width, height) >= MIN_SIDE and min(width, height) <= MAX_SHORT_SIDE
    return sizes and area >= MIN_FILL * width * height and (clearance >= MIN_HEIGHT or height >= MIN_TALL)
