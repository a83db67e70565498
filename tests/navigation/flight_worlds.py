"""Small voxel worlds to fly in, and objects that stand in them."""

import numpy as np

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid

RESOLUTION = 0.1


def empty_room(x: float, y: float, z: float) -> OccupancyGrid:
    """Free space from the origin to (x, y, z) metres; outside of the grid is blocked."""
    shape = tuple(round(side / RESOLUTION) for side in (x, y, z))
    return OccupancyGrid(np.full(shape, FREE, np.uint8), np.zeros(3), RESOLUTION)


def fill(grid: OccupancyGrid, lower: tuple[float, float, float], upper: tuple[float, float, float]) -> OccupancyGrid:
    """Matter in the block between two world points; changes and returns ``grid``."""
    first, last = (np.rint((np.array(p) - grid.origin) / grid.resolution).astype(int) for p in (lower, upper))
    grid.state[first[0] : last[0], first[1] : last[1], first[2] : last[2]] = OCCUPIED
    return grid


def thing(object_id: int, centre: tuple[float, float, float], size: tuple[float, float, float]) -> ObjectBox:
    return ObjectBox(object_id, f"thing {object_id}", centre, size, 0.0, 1.0, "test", "", "", 3, 1.0, "test")


def put(grid: OccupancyGrid, box: ObjectBox) -> OccupancyGrid:
    """Matter in an axis-aligned box."""
    centre, half = np.array(box.centre), np.array(box.size) / 2
    return fill(grid, tuple(centre - half), tuple(centre + half))


def pillar_corridor() -> OccupancyGrid:
    """8 x 3 x 2.6 m with three pillars that stand in the way in turn."""
    grid = empty_room(8, 3, 2.6)
    fill(grid, (2.0, 0.0, 0.0), (2.4, 1.8, 2.6))
    fill(grid, (4.0, 1.2, 0.0), (4.4, 3.0, 2.6))
    return fill(grid, (6.0, 0.0, 0.0), (6.4, 1.6, 2.6))


def furnished_room() -> tuple[OccupancyGrid, BoxMap]:
    """8 x 6 x 2.8 m with furniture along its walls and two pillars in it."""
    grid = empty_room(8, 6, 2.8)
    boxes = (
        thing(0, (0.4, 3.0, 0.9), (0.8, 1.2, 1.8)),
        thing(1, (7.6, 1.0, 0.5), (0.8, 0.8, 1.0)),
        thing(2, (7.5, 5.4, 1.0), (0.6, 0.6, 2.0)),
        thing(3, (1.0, 5.5, 0.4), (0.8, 0.6, 0.8)),
        thing(4, (4.0, 0.4, 0.6), (1.4, 0.8, 1.2)),
        thing(5, (4.0, 5.7, 1.5), (0.8, 0.4, 0.6)),
        thing(6, (1.2, 0.5, 0.8), (0.6, 0.6, 1.6)),
        thing(7, (2.6, 3.6, 1.4), (0.4, 0.4, 2.8)),
        thing(8, (5.4, 2.4, 1.4), (0.4, 0.4, 2.8)),
    )
    for box in boxes:
        put(grid, box)
    return grid, BoxMap(boxes)
