"""Upright boxes in plan: do two of them come closer than a gap? Separating axes, against everything placed at once."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

TOUCH = 1e-3
"""Metres that two things may overlap in height and still only touch: placed sizes are rounded."""


@dataclass(frozen=True)
class Solid:
    """An upright box: middle of its plan, ``width`` and ``depth`` along its own x and y, metres; yaw in radians."""

    x: float
    y: float
    width: float
    depth: float
    bottom: float
    top: float
    yaw: float

    @property
    def axes(self) -> NDArray[np.float64]:
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return np.array([[c, s], [-s, c]])  # (2, 2) its x and y axes, as rows

    @property
    def reach(self) -> NDArray[np.float64]:
        """(2,) half extent along world x and y."""
        return np.abs(self.axes).T @ (np.array([self.width, self.depth]) / 2)

    def shifted(self, right: float, forward: float, width: float, depth: float) -> "Solid":
        """Moved along its own axes, with another plan size."""
        x, y = np.array([self.x, self.y]) + np.array([right, forward]) @ self.axes
        return Solid(float(x), float(y), width, depth, self.bottom, self.top, self.yaw)

    def distance_to(self, point: ArrayLike) -> float:
        """Metres from a world point (3,) to the box; 0 inside."""
        p = np.asarray(point, float)
        local = self.axes @ (p[:2] - [self.x, self.y])
        outside = np.maximum(np.abs(local) - [self.width / 2, self.depth / 2], 0.0)
        above = max(self.bottom - p[2], p[2] - self.top, 0.0)
        return float(np.sqrt((outside**2).sum() + above**2))


@dataclass
class Occupied:
    """Boxes that are taken, and whether a new one would come too near."""

    rows: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, solid: Solid) -> None:
        self.rows.append((solid.x, solid.y, solid.width / 2, solid.depth / 2, solid.bottom, solid.top, solid.yaw))

    def solids(self) -> list[Solid]:
        """All boxes that are taken."""
        return [Solid(x, y, 2 * w, 2 * d, bottom, top, yaw) for x, y, w, d, bottom, top, yaw in self.rows]

    def hits(self, solid: Solid, gap: float) -> bool:
        """True where the plans, grown by ``gap``, overlap and the height ranges do too (touching is allowed)."""
        if not self.rows:
            return False
        t = np.array(self.rows)  # (M, 7)
        t = t[(t[:, 4] < solid.top - TOUCH) & (t[:, 5] > solid.bottom + TOUCH)]
        if len(t) == 0:
            return False
        offset = t[:, :2] - [solid.x, solid.y]  # (M, 2)
        c, s = np.cos(t[:, 6]), np.sin(t[:, 6])
        others = np.stack([np.stack([c, s], 1), np.stack([-s, c], 1)], 1)  # (M, 2, 2) rows are axes
        mine = solid.axes
        half = np.array([solid.width, solid.depth]) / 2
        cross = np.abs(np.einsum("ik,mjk->mij", mine, others))  # (M, 2, 2) |cos| between axes
        on_mine = np.abs(offset @ mine.T) - half - np.einsum("mij,mj->mi", cross, t[:, 2:4])
        on_others = np.abs(np.einsum("mjk,mk->mj", others, offset)) - t[:, 2:4] - np.einsum("mij,i->mj", cross, half)
        apart = np.maximum(on_mine.max(axis=1), on_others.max(axis=1))
        return bool((apart < gap).any())
