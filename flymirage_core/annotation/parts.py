"""`PartSet`: the coloured surface cut in parts, while they are split and joined into objects."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import Footprint, fit_footprint
from flymirage_core.annotation.supports import LEVEL

Float32 = NDArray[np.float32]
Index = NDArray[np.intp]

TABLE_BIN = 0.04
"""Metres; heights within two bins are one level face."""
TOP_SHARE = 0.4
"""Of the broadest face's area, that a top has at least."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Fused points that are no structure, as a graph. World frame, metres; z here is height above world zero."""

    points: Float32  # (N, 3)
    colours: Float32  # (N, 3) shading-free Lab
    normals: Float32  # (N, 3), zero where unknown
    things: Index  # (N,) number of the thing on a support that a point belongs to, 0 = stands on the floor
    edges: Index  # (E, 2) neighbouring points (26-neighbourhood of voxels) of the same thing
    steps: Float32  # (E,) colour step along each edge
    voxel: float
    floor: float
    yaw: float  # the room's


class Part:
    """Some points of a surface that belong together. Its measures are worked out when asked for."""

    def __init__(self, surface: Surface, members: Index) -> None:
        self.surface = surface
        self.members = members  # (M,) ascending
        self.thing = int(surface.things[members[0]])  # all members' number

    def __len__(self) -> int:
        return len(self.members)

    @cached_property
    def points(self) -> Float32:
        return np.asarray(self.surface.points[self.members])  # (M, 3)

    @cached_property
    def colour(self) -> Float32:
        return np.asarray(np.median(self.surface.colours[self.members], axis=0))  # (3,) shading-free Lab

    @cached_property
    def bounds(self) -> Float32:
        return np.asarray(np.percentile(self.points, (1, 99), axis=0))  # (2, 3)

    @cached_property
    def lower(self) -> Float32:
        return np.asarray(self.bounds[0])

    @cached_property
    def upper(self) -> Float32:
        return np.asarray(self.bounds[1])

    @cached_property
    def centre(self) -> Float32:
        return np.asarray(self.bounds.mean(axis=0))

    @cached_property
    def extent(self) -> Float32:
        return np.asarray(self.bounds[1] - self.bounds[0])

    @property
    def clearance(self) -> float:
        """Metres between the floor and its lowest point."""
        return float(self.lower[2]) - self.surface.floor

    @cached_property
    def footprint(self) -> Footprint:
        return fit_footprint(self.points, self.surface.yaw)

    @cached_property
    def _levels(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(K,) square metres of level surface that looks up, and the upper edge of its height."""
        up = self.members[self.surface.normals[self.members, 2] > LEVEL]
        if len(up) < 6:
            return np.zeros(1), np.full(1, -np.inf)
        heights = self.surface.points[up, 2]
        counts, edges = np.histogram(
            heights, np.arange(heights.min() - TABLE_BIN, heights.max() + 2 * TABLE_BIN, TABLE_BIN)
        )
        pairs = counts + np.append(counts[1:], 0)
        return pairs * self.surface.voxel**2, edges[:-1] + TABLE_BIN

    @property
    def table(self) -> tuple[float, float]:
        """Its broadest level face that looks up: (square metres, upper edge of its height)."""
        areas, heights = self._levels
        k = int(areas.argmax())
        return float(areas[k]), float(heights[k])

    @property
    def top(self) -> tuple[float, float]:
        """Its highest level face of some breadth: of a bookcase the uppermost board, of which things hide much."""
        areas, heights = self._levels
        k = int(np.flatnonzero(areas >= TOP_SHARE * areas.max())[-1])
        k -= int(k > 0 and areas[k - 1] > areas[k])  # two bins overlap: the fuller of both
        return float(areas[k]), float(heights[k])


class PartSet:
    """All parts of a surface; joining keeps the larger part's number."""

    def __init__(self, surface: Surface, labels: Index, min_points: int) -> None:
        self.surface = surface
        self.labels = labels.copy()  # (N,) part of each point; numbers without a part are too small to be one
        order = np.argsort(labels, kind="stable")
        starts = np.searchsorted(labels[order], np.arange(labels.max() + 2)) if len(labels) else np.zeros(1, int)
        groups = [order[a:b] for a, b in pairwise(starts)]
        self.parts = {k: Part(surface, members) for k, members in enumerate(groups) if len(members) >= min_points}
        self._count = len(groups)

    def join(self, i: int, j: int) -> int:
        """Make parts ``i`` and ``j`` one; its number."""
        if len(self.parts[i]) < len(self.parts[j]):
            i, j = j, i
        a, b = self.parts[i], self.parts.pop(j)
        self.labels[b.members] = i
        self.parts[i] = Part(self.surface, np.sort(np.concatenate([a.members, b.members])))
        return i

    def split(self, i: int, members: Index) -> int:
        """Make ``members`` (M,), ascending, of part ``i`` a part of their own; its number."""
        number = self._count
        self._count += 1
        self.labels[members] = number
        self.parts[number] = Part(self.surface, members)
        self.parts[i] = Part(self.surface, np.setdiff1d(self.parts[i].members, members, assume_unique=True))
        return number

    def contacts(self) -> list[tuple[int, int, int]]:
        """(i, j, number of edges between them) for all parts that touch, the longest contact first."""
        a, b = self.labels[self.surface.edges[:, 0]], self.labels[self.surface.edges[:, 1]]
        different = a != b
        low, high = np.minimum(a, b)[different].astype(np.int64), np.maximum(a, b)[different].astype(np.int64)
        pairs, counts = np.unique(low * self._count + high, return_counts=True)
        order = np.argsort(-counts, kind="stable")
        found = [
            (int(p // self._count), int(p % self._count), int(c))
            for p, c in zip(pairs[order], counts[order], strict=True)
        ]
        return [(i, j, c) for i, j, c in found if i in self.parts and j in self.parts]
