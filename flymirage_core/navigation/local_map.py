"""What a drone has seen of a scene so far: the map of the receding-horizon planner. No planning here."""

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.navigation.obstacle_pairs import Voxels, voxels_of
from flymirage_core.occupancy.grid import FREE, OccupancyGrid


class LocalMap:
    """An inflated grid that is revealed along the way; what has not been seen counts as free, as in the original.

    Seen is what lies within the sensing range, through obstacles too: the original's simulator reveals its point cloud
    like this. Ranges are measured to the voxels of the inflated grid, so obstacles are seen the inflation earlier.
    """

    def __init__(self, inflated: OccupancyGrid, sensing_range: float) -> None:
        self.truth = inflated
        self.sensing_range = sensing_range
        self.known = OccupancyGrid(np.full_like(inflated.state, FREE), inflated.origin, inflated.resolution)

    @property
    def voxels(self) -> Voxels:
        return voxels_of(self.known)

    def look_from(self, position: ArrayLike) -> bool:
        """Reveals what is within range of ``position`` (3,); whether anything blocked is new."""
        p = np.asarray(position, float)
        lower = np.clip(self.truth.index_of(p - self.sensing_range), 0, self.truth.state.shape)
        upper = np.clip(self.truth.index_of(p + self.sensing_range) + 1, 0, self.truth.state.shape)
        window = tuple(slice(a, b) for a, b in zip(lower, upper, strict=True))
        squared = [
            ((np.arange(a, b) + 0.5) * self.truth.resolution + o - x) ** 2
            for a, b, o, x in zip(lower, upper, self.truth.origin, p, strict=True)
        ]
        near = np.add.outer(np.add.outer(squared[0], squared[1]), squared[2]) <= self.sensing_range**2
        new = near & (self.truth.state[window] != self.known.state[window])
        self.known.state[window][new] = self.truth.state[window][new]
        return bool(new.any())
