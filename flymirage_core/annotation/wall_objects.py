"""Flat things on walls (pictures, mirrors, screens, boards) and ceilings (lights), by colour and relief in a raster."""

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.room_structure import HeightMap, RoomStructure, Wall

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
Bool = NDArray[np.bool_]

CELL: Final = 0.04
"""Metres; cells of a wall's raster."""
MAX_DEPTH: Final = 0.07
"""Metres behind the wall's plane, or below the ceiling's."""
MAX_CEILING_DEPTH: Final = 0.12
"""Metres below the ceiling; what reaches lower hangs."""
AROUND: Final = 13
"""Cells (2 m) of the ceiling's map, of whose heights ..."""
HIGH: Final = 80
"""... this percentile is the ceiling round a light, which the map itself follows."""
MAX_LIGHT: Final = 2.0
MIN_POINTS: Final = 200
"""Of a wall or ceiling, for it to be looked at."""
MAX_PAINT_STEP: Final = 3.0
"""Colour step between neighbouring cells up to which both are bare wall ..."""
MAX_RELIEF: Final = 0.007
"""... if one is no more metres before the other: a white board on a white wall is not."""
MIN_BARE_SHARE: Final = 0.3
"""Of the cells of a stretch of wall seen in one piece; its largest region is bare wall if it has this share."""
NECK: Final = 5
"""Cells; what is narrower joins two things, ..."""
ROUNDED: Final = 2.5
"""... but so near to a wider part it is a corner of that."""
REFITS: Final = 4
MOST: Final = 2.0
"""Of the median step: what is farther from the usual looks of a stretch tells nothing of them."""
PATTERN: Final = 3
"""Cells over which bricks and the pattern of wallpaper are evened out."""
MAX_PATTERN: Final = 3.0
"""Step from the usual looks of a stretch without such a region, over the median of all: bricks, wallpaper."""
COATS: Final = 3
"""Kinds of bare wall that one wall may show, ..."""
MAX_AREA: Final = 4.0
"""... each of more square metres than a thing has."""
FRONT_PERCENTILE: Final = 60
MIN_AREA: Final = 0.06
"""Square metres."""
MIN_SIDE: Final = 0.15
MAX_SHORT_SIDE: Final = 2.0
"""Metres; what is larger both ways is a part of the wall."""
MIN_FILL: Final = 0.55
"""Least share of the bounding rectangle: flat things are rectangles or discs, shadows are not."""
MIN_LINE: Final = 0.35
"""Of the median line's cells, that the outermost lines of a thing have; fewer are those of a shadow that joins it."""
MIN_HEIGHT: Final = 0.25
"""Metres above the floor; lower down it is a skirting board, or the colour of furniture on the wall behind it."""
MIN_TALL: Final = 1.6
"""... unless it is as high as a door."""
MAX_BOTTOM_OUTDOORS: Final = 2.6
"""Metres above the ground; farther up on house fronts are windows."""
MIN_THICKNESS: Final = 0.03


def wall_objects(points: Float32, colours: Float32, flat: Bool, structure: RoomStructure) -> list[FittedBox]:
    """Boxes of what differs in colour or depth from the wall it lies on.

    ``points``: (N, 3) world, metres. ``colours``: (N, 3) shading-free Lab. ``flat``: (N,) which are the building, or
    lie close before a wall and face as it does.
    """
    found = []
    for wall in structure.walls:
        members = np.flatnonzero(flat & wall.spans(points) & (wall.distance(points) > -MAX_DEPTH))
        if len(members) >= MIN_POINTS:
            found += _on_wall(wall, members, points[members], colours[members], structure.floor)
    if structure.ceiling_map is None:
        return [box for box in found if box.bottom - structure.floor < MAX_BOTTOM_OUTDOORS]
    return found


def ceiling_objects(points: Float32, colours: Float32, structure: RoomStructure) -> list[FittedBox]:
    """Boxes of flat things under the ceiling that differ from it in colour: light panels, vents; arguments as above."""
    if structure.ceiling_map is None:
        return []
    around = HeightMap(
        structure.ceiling_map.origin, ndimage.percentile_filter(structure.ceiling_map.heights, HIGH, AROUND)
    )
    depth = around.at(points) - points[:, 2]
    members = np.flatnonzero((depth < MAX_CEILING_DEPTH) & (depth > -MAX_DEPTH))
    if len(members) < MIN_POINTS:
        return []
    c, s = np.cos(structure.yaw), np.sin(structure.yaw)
    axes = np.array([[c, s], [-s, c]])
    along, across = (points[members, :2] @ axis for axis in axes)
    boxes = []
    for mine, (x, y), (w, h) in flat_things(along, across, depth[members], colours[members]):
        if min(w, h) < MIN_SIDE or max(w, h) > MAX_LIGHT:
            continue
        xy = np.array([x + w / 2, y + h / 2]) @ axes
        around = xy + max(w, h) * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
        top = float(structure.ceiling_map.at(around).max())  # over the thing itself the map is the thing
        bottom = min(top - MIN_THICKNESS, float(np.percentile(points[members[mine], 2], 100 - FRONT_PERCENTILE)))
        centre = (float(xy[0]), float(xy[1]), (top + bottom) / 2)
        boxes.append(FittedBox(centre, (w, h, top - bottom), structure.yaw, members[mine], hanging=True))
    return boxes


def _on_wall(wall: Wall, members: NDArray[np.intp], points: Float32, colours: Float32, floor: float) -> list[FittedBox]:
    along, depth = points[:, :2] @ wall.direction, wall.distance(points)
    boxes = []
    for mine, (x, bottom), (w, h) in flat_things(along, points[:, 2], depth, colours):
        if not MIN_SIDE <= min(w, h) <= MAX_SHORT_SIDE or (bottom - floor < MIN_HEIGHT and h < MIN_TALL):
            continue
        front = wall.offset + float(np.percentile(depth[mine], FRONT_PERCENTILE))
        thickness = max(MIN_THICKNESS, front - wall.back)
        xy = wall.normal * (wall.back + thickness / 2) + wall.direction * (x + w / 2)
        yaw = float(np.arctan2(wall.direction[1], wall.direction[0]))
        centre = (float(xy[0]), float(xy[1]), bottom + h / 2)
        boxes.append(FittedBox(centre, (w, thickness, h), yaw, members[mine], on_wall=True))
    return boxes


def flat_things(
    x: Float64 | Float32,
    y: Float64 | Float32,
    depth: Float64 | Float32,
    colours: Float32,
    min_area: float = MIN_AREA,
    framed: bool = True,
) -> Iterator[tuple[Bool, tuple[float, float], tuple[float, float]]]:
    """Of points at (x, y) (N,) metres in a plane, ``depth`` (N,) before it: of each thing the points, the lowest corner
    and the sides. ``framed``: rims may have gaps and still surround a thing."""
    origin = np.array([x.min(), y.min()])
    column, row = ((x - origin[0]) / CELL).astype(int), ((y - origin[1]) / CELL).astype(int)
    relief = np.float32(MAX_PAINT_STEP / MAX_RELIEF) * depth[:, None].astype(np.float32)
    looks = np.concatenate([colours, relief], axis=1)  # (N, 4), in colour steps
    seen, image = _raster(row, column, looks, (int(row.max()) + 1, int(column.max()) + 1))
    regions = _things(seen, image, framed)
    for k in np.unique(regions[regions > 0]):
        rows, columns = (_full(a) for a in np.nonzero(regions == k))
        corner = float(origin[0] + columns[0] * CELL), float(origin[1] + rows[0] * CELL)
        sides = float(len(columns) * CELL), float(len(rows) * CELL)
        area = np.count_nonzero(regions[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] == k) * CELL**2
        if area >= max(min_area, MIN_FILL * sides[0] * sides[1]):
            yield regions[row, column] == k, corner, sides


def _full(lines: NDArray[np.intp]) -> NDArray[np.intp]:
    """All numbers from the first to the last line that is nearly as full as most; ``lines``: (M,) those of cells."""
    counts = np.bincount(lines)
    full = np.flatnonzero(counts >= MIN_LINE * np.median(counts[counts > 0]))
    return np.arange(full[0], full[-1] + 1)


def _raster(
    row: NDArray[np.int64], column: NDArray[np.int64], looks: Float32, shape: tuple[int, int]
) -> tuple[Bool, Float32]:
    """Which cells were seen (H, W) and their mean looks (H, W, 4)."""
    counts = np.zeros(shape, np.float32)
    image = np.zeros((*shape, looks.shape[1]), np.float32)
    np.add.at(counts, (row, column), 1)
    np.add.at(image, (row, column), looks)
    return counts > 0, np.asarray(image / np.maximum(counts, 1)[..., None], np.float32)


def _step(a: Float32, b: Float32) -> Float32:
    """Colour step, or step in depth if that is larger, (...,) between looks (..., 4)."""
    return np.asarray(np.maximum(colour_step(a[..., :3], b[..., :3]), np.abs(a[..., 3] - b[..., 3])), np.float32)


def _things(seen: Bool, image: Float32, framed: bool) -> NDArray[np.intp]:
    """(H, W) number of the thing that each cell of a wall's raster belongs to, 0 = bare wall or not seen.

    The bare wall is the largest region whose neighbouring cells differ little: light may fade across it as it likes. A
    thing is what is left, with what it surrounds, but for what is not seen: the panes of a window.
    """
    numbers = np.arange(seen.size).reshape(seen.shape)
    pairs = []
    for a, b in (
        ((slice(1, None), slice(None)), (slice(None, -1), slice(None))),
        ((slice(None), slice(1, None)), (slice(None), slice(None, -1))),
    ):
        alike = seen[a] & seen[b] & (_step(image[a], image[b]) < MAX_PAINT_STEP)
        pairs.append(np.stack([numbers[a][alike], numbers[b][alike]], axis=1))
    edges = np.concatenate(pairs)
    graph = coo_matrix((np.ones(len(edges), np.int8), (edges[:, 0], edges[:, 1])), shape=(seen.size, seen.size))
    labels = connected_components(graph, directed=False)[1].reshape(seen.shape)
    bare = _bare(seen, labels, image)
    kernel = np.ones((3, 3), bool)
    other = seen & ~bare
    rims = ndimage.label(other | (ndimage.binary_closing(other, kernel) & seen) if framed else other, kernel)[0]
    for k, place in enumerate(ndimage.find_objects(rims), 1):
        if min(rims[place].shape) * CELL <= MAX_SHORT_SIDE:  # larger ones are corners of the room
            other[place] |= ndimage.binary_fill_holes(rims[place] == k)
    other &= ~ndimage.binary_opening(other & ~seen, kernel)
    return _apart(ndimage.binary_opening(other, kernel), kernel)


def _apart(other: Bool, kernel: Bool) -> NDArray[np.intp]:
    """(H, W) number of the thing of each cell that is none of the wall; a neck joins two things and belongs to neither.

    A clock beside a door touches it by a few cells; what is as narrow as that all over is a thing of its own.
    """
    regions = ndimage.label(other, kernel)[0]
    cores, count = ndimage.label(ndimage.binary_opening(other, np.ones((NECK, NECK), bool)), kernel)
    away, nearest = ndimage.distance_transform_edt(cores == 0, return_indices=True)
    number = np.where(away <= ROUNDED, cores[tuple(nearest)], 0) * other
    narrow = other & ~np.isin(regions, np.unique(regions[cores > 0]))
    return np.asarray(np.where(narrow, regions + count, number), np.intp)


def _bare(seen: Bool, labels: NDArray[np.int32], image: Float32) -> Bool:
    """(H, W) cells of bare wall: the usual looks of each stretch of wall that is seen in one piece.

    What is left of a stretch and too large for a thing is wall of other looks: its lower half in another paint, say.
    """
    bare = np.zeros_like(seen)
    for coat in range(COATS):
        stretches = ndimage.label(seen & ~bare, np.ones((3, 3), bool))[0]
        areas = np.bincount(stretches.ravel()) * CELL**2
        for k in range(1, len(areas)):
            if coat == 0 or areas[k] > MAX_AREA:
                bare |= _usual(stretches == k, labels, image)
    return bare


def _usual(mine: Bool, labels: NDArray[np.int32], image: Float32) -> Bool:
    """(H, W) cells of a stretch that are its largest region, or that resemble most of it: bricks make no region."""
    weights = ndimage.uniform_filter(mine.astype(np.float32), PATTERN)
    sums = ndimage.uniform_filter(np.where(mine[..., None], image, 0), (PATTERN, PATTERN, 1))
    even = (sums / np.maximum(weights, 1e-6)[..., None]).astype(np.float32)  # (H, W, 4), in which bricks are no more
    away = _from_most(mine, even)
    odd = away >= MAX_PATTERN * np.median(away[mine])
    bare = mine & ~ndimage.binary_opening(odd, np.ones((3, 3), bool))
    found, counts = np.unique(labels[mine], return_counts=True)
    if counts.max() >= MIN_BARE_SHARE * counts.sum():
        bare |= mine & (labels == found[counts.argmax()])
    return np.asarray(bare)


def _from_most(mine: Bool, image: Float32) -> Float32:
    """(H, W) step of a stretch's looks from what most of it would have there: light fades, and walls are not even."""
    row, column = (a / max(mine.shape) for a in np.nonzero(mine))
    terms = np.stack([np.ones_like(row), row, column, row**2, row * column, column**2], axis=1)  # (C, 6)
    looks = image[mine]
    most = np.ones(len(looks), bool)
    for _ in range(REFITS):
        usual = terms @ np.linalg.lstsq(terms[most], looks[most], rcond=None)[0]  # (C, 4)
        steps = _step(looks, usual.astype(np.float32))
        most = steps <= MOST * np.median(steps)
    away = np.zeros(mine.shape, np.float32)
    away[mine] = steps
    return away
