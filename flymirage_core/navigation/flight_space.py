"""`FlightSpace`: a scene's grid made ready for planning: where drones of the radii that are used may be."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flymirage_core.occupancy.distance import clearance_field
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.settings import PlannerSettings


@dataclass(frozen=True, eq=False)
class FlightSpace:
    """What every flight of a scene is planned in; made once for each scene."""

    grid: OccupancyGrid  # not inflated
    clearance: NDArray[np.float32]  # (X, Y, Z) metres from voxel centres to what is blocked
    inflations: tuple[float, ...]  # metres, in the order in which they are tried
    inflated: tuple[OccupancyGrid, ...]  # one for each inflation

    @staticmethod
    def of(grid: OccupancyGrid, settings: PlannerSettings) -> "FlightSpace":
        """The spaces for the planner's inflation and, as the last resort, its least inflation."""
        inflations: tuple[float, ...] = (settings.inflation,)
        if settings.min_inflation < settings.inflation:
            inflations += (settings.min_inflation,)
        inflated = tuple(keep_clear(grid, radius) for radius in inflations)
        return FlightSpace(grid, clearance_field(grid), inflations, inflated)


def keep_clear(grid: OccupancyGrid, radius: float) -> OccupancyGrid:
    """The grid in which a voxel is FREE only if each of its points keeps ``radius`` metres from all that is blocked.

    `occupancy.distance.inflate` asks this of voxel centres only, which lets a flight come up to 0.87 voxels nearer. The
    planner promises a clearance, so here the distance is from voxel to voxel: the squared gaps of the three axes add
    up, hence three passes of minima over shifted copies. At a radius of k voxels a wall grows by exactly k voxels.
    Outside of the grid is blocked.
    """
    reach = int(np.ceil(radius / grid.resolution)) + 1  # voxels
    far = np.float32(3 * reach**2)
    squared = np.where(grid.blocked, np.float32(0), far)  # (X, Y, Z) voxels^2
    for axis in range(3):
        padding = [(reach, reach) if a == axis else (0, 0) for a in range(3)]
        padded = np.moveaxis(np.pad(squared, padding), axis, 0)
        lines = np.moveaxis(squared, axis, 0)
        nearest = lines.copy()
        for shift in range(-reach, reach + 1):
            gap = np.float32(max(abs(shift) - 1, 0) ** 2)
            np.minimum(nearest, padded[reach + shift : reach + shift + len(lines)] + gap, out=nearest)
        squared = np.moveaxis(nearest, 0, axis)
    limit = radius / grid.resolution - 1e-4
    near = (grid.state == FREE) & (squared < limit * limit if limit > 0 else squared <= 0)
    state = np.where(near, OCCUPIED, grid.state).astype(np.uint8)
    return OccupancyGrid(np.ascontiguousarray(state), grid.origin, grid.resolution)
