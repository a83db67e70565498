"""`OccupancyGrid`: a voxel grid with three states, and the arithmetic between points and voxels."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

FREE: Final = 0
OCCUPIED: Final = 1
UNKNOWN: Final = 2
"""Not reached by the flood fill from c: inside solids, or outside of the world. It may not be flown in."""


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """Voxel (i, j, k) covers ``origin + resolution * [i, i+1) x [j, j+1) x [k, k+1)``; world frame, metres.

    Everything outside of the array counts as UNKNOWN, and so as blocked.
    """

    state: NDArray[np.uint8]  # (X, Y, Z) FREE | OCCUPIED | UNKNOWN
    origin: NDArray[np.float64]  # (3,) lower corner of voxel (0, 0, 0)
    resolution: float  # metres

    @property
    def blocked(self) -> NDArray[np.bool_]:
        """True where one may not fly: occupied or unknown."""
        return np.asarray(self.state != FREE)  # (X, Y, Z)

    def index_of(self, points: ArrayLike) -> NDArray[np.intp]:
        """Voxel indices (..., 3) of world points (..., 3); may lie outside of the array."""
        return np.floor((np.asarray(points, float) - self.origin) / self.resolution).astype(np.intp)

    def centre_of(self, indices: ArrayLike) -> NDArray[np.float64]:
        """World coordinates (..., 3) of voxel centres."""
        return (np.asarray(indices) + 0.5) * self.resolution + self.origin

    def contains(self, indices: ArrayLike) -> NDArray[np.bool_]:
        """True (...,) where voxel indices (..., 3) lie inside of the array."""
        indices = np.asarray(indices)
        return np.asarray(((indices >= 0) & (indices < self.state.shape)).all(axis=-1))

    def window(self, low: ArrayLike, high: ArrayLike) -> "OccupancyGrid":
        """The voxels between two corners (3,), world points, as a grid of its own; what lies outside is left out."""
        first = np.clip(self.index_of(low), 0, self.state.shape)
        end = np.clip(self.index_of(high) + 1, 0, self.state.shape)
        block = self.state[first[0] : end[0], first[1] : end[1], first[2] : end[2]]
        return OccupancyGrid(np.ascontiguousarray(block), self.origin + first * self.resolution, self.resolution)

    def state_at(self, points: ArrayLike) -> NDArray[np.uint8]:
        """State (...,) at world points (..., 3); UNKNOWN outside of the array."""
        indices = self.index_of(points)
        inside = self.contains(indices)
        i, j, k = np.moveaxis(np.where(inside[..., None], indices, 0), -1, 0)
        return np.where(inside, self.state[i, j, k], UNKNOWN).astype(np.uint8)
