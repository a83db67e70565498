"""`Evidence`: all that boxes of one place are judged by, and what it says of a box, fitted or merely thought of."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.appearance import Observation, observe, window_of
from flymirage_core.annotation.box_fitting import FittedBox, on_floor
from flymirage_core.annotation.carving import Detections, detections, hits
from flymirage_core.annotation.colours import shading_free, to_lab
from flymirage_core.annotation.fused_points import Frame, FusedPoints
from flymirage_core.annotation.fusion import plan_gap
from flymirage_core.annotation.labels import Support
from flymirage_core.annotation.light import Light, light_of, seen_colour
from flymirage_core.annotation.normals import surface_shape
from flymirage_core.annotation.room_structure import RoomStructure
from flymirage_core.annotation.surroundings import REACH, surroundings

Float32 = NDArray[np.float32]
Index = NDArray[np.intp]

RESTING: Final = 0.1
"""Metres between a thing and what carries it."""
AT_WALL: Final = 0.15
VIEWS_TRIED: Final = 16
"""Frames with the most points of a box, among which the best views are sought: those that show most of it."""
VIEWS_KEPT: Final = 3
CELL: Final = 0.5
"""Metres: side of the cells of the plan in which points are found."""
NEIGHBOURHOOD: Final = 0.09
"""Metres within which a surface's direction and roughness are judged."""
NEIGHBOURS: Final = 16


@dataclass(frozen=True, eq=False)
class Evidence:
    """What was seen of a place."""

    cloud: FusedPoints  # solid points, that the boxes' members number
    coarse: Float32  # (K, 3) points of the whole place, seen from any distance
    structure: RoomStructure
    frames: Sequence[Frame]
    max_distance: float  # metres from a box's centre to a camera beyond which a view does not count
    proposals: Sequence[FittedBox]  # what geometry and colour give; whatever else is thought of is made of their points

    @cached_property
    def plain(self) -> Float32:
        """(N, 3) shading-free Lab of the points."""
        return shading_free(to_lab(self.cloud.colours))

    @cached_property
    def building(self) -> NDArray[np.bool_]:
        """(N,) which points are the building's."""
        return self.structure.contains(self.cloud.points)

    @cached_property
    def light(self) -> Light:
        return light_of(self.cloud.colours)

    def colour_of(self, box: FittedBox) -> str:
        """The colour that most of a box has, by name, in white light."""
        return seen_colour(self.cloud.colours[box.members], self.light)

    def observed(
        self, boxes: Sequence[FittedBox], rivals: Sequence[Sequence[FittedBox]]
    ) -> list[tuple[Observation, Detections] | None]:
        """How each box looks and was seen, None if no view saw it; ``rivals`` are the other boxes, for each box."""
        return [self._observed(box, others) for box, others in zip(boxes, rivals, strict=True)]

    def _observed(self, box: FittedBox, others: Sequence[FittedBox]) -> tuple[Observation, Detections] | None:
        rows = self._row[box.members]
        found = detections(box, rows, self._hits, self._eyes, self.max_distance)
        if not found.views:
            return None
        rivals = [other for other in others if _meet(box, other)]
        around = surroundings(box, found, rivals, self._near(box), self.cloud.points, self.plain, self.building)
        best = [self.frames[i] for i in best_views(box, found.hits, self.frames)]
        normals, variation = self._shape
        support = support_of(box, rivals, self.structure)
        seen = self.cloud[box.members]
        return observe(box, support, seen, normals[rows], variation[rows], self.structure, best, around), found

    @cached_property
    def _proposed(self) -> Index:
        """(K,) ascending, the points of all proposals."""
        return np.unique(np.concatenate([np.zeros(0, np.intp), *(box.members for box in self.proposals)]))

    @cached_property
    def _row(self) -> Index:
        """(N,) where among the proposals' points each point is."""
        rows = np.full(len(self.cloud), -1)
        rows[self._proposed] = np.arange(len(self._proposed))
        return rows

    @cached_property
    def _hits(self) -> NDArray[np.bool_]:
        """(K, F) which frames hit which of the proposals' points."""
        return hits(self.cloud.points[self._proposed], self.frames)

    @cached_property
    def _eyes(self) -> NDArray[np.float64]:
        return np.array([frame.camera.position for frame in self.frames]).reshape(-1, 3)  # (F, 3)

    @cached_property
    def _shape(self) -> tuple[Float32, Float32]:
        """Normals (K, 3) and `surface_variation` (K,) of the proposals' points."""
        seen = self.cloud[self._proposed]
        return surface_shape(seen.points, seen.to_camera, NEIGHBOURHOOD, NEIGHBOURS)

    def _near(self, box: FittedBox) -> Index:
        """Points in the cells of the plan that the box and what is round it reach into."""
        order, keys, origin, rows = self._cells
        reach = np.hypot(*box.size[:2]) / 2 + REACH
        centre = np.array(box.centre[:2]) - origin
        (west, south), (east, north) = (np.floor((centre + d) / CELL).astype(int) for d in (-reach, reach))
        columns = np.arange(max(west, 0), east + 1) * rows
        first = np.searchsorted(keys, columns + np.clip(south, 0, rows - 1))
        last = np.searchsorted(keys, columns + np.clip(north, 0, rows - 1), side="right")
        return np.concatenate([order[a:b] for a, b in zip(first, last, strict=True)])

    @cached_property
    def _cells(self) -> tuple[Index, Index, Float32, int]:
        """(N,) points cell by cell, (N,) each one's cell, (2,) the south-western corner, and cells from there north."""
        origin = self.cloud.points[:, :2].min(axis=0)
        cells = np.floor((self.cloud.points[:, :2] - origin) / CELL).astype(np.intp)
        rows = int(cells[:, 1].max()) + 1
        keys = cells[:, 0] * rows + cells[:, 1]
        order = np.argsort(keys, kind="stable")
        return order, keys[order], origin, rows


def _meet(a: FittedBox, b: FittedBox) -> bool:
    """Whether two boxes may touch, or rest on each other."""
    return a is not b and plan_gap(a, b) < RESTING


def best_views(box: FittedBox, hits: NDArray[np.int64], frames: Sequence[Frame]) -> list[int]:
    """Indices of the frames that show most of the box: many of its points (``hits`` (F,)) and large, best first."""
    candidates = [int(i) for i in np.argsort(-hits, kind="stable")[:VIEWS_TRIED] if hits[i]]

    def shown(i: int) -> float:
        window = window_of(box, frames[i])
        return 0.0 if window is None else float(hits[i] * np.sqrt((window[2] - window[0]) * (window[3] - window[1])))

    return sorted(candidates, key=shown, reverse=True)[:VIEWS_KEPT]


def support_of(box: FittedBox, boxes: Sequence[FittedBox], structure: RoomStructure) -> Support:
    """What a box rests on, judged from its place."""
    if box.on_wall:
        return Support.WALL
    if box.hanging:
        return Support.CEILING
    if on_floor(box, structure):
        return Support.FLOOR
    carried = any(other is not box and abs(other.top - box.bottom) < RESTING and _over(box, other) for other in boxes)
    near_wall = any(
        abs(float(np.dot(w.normal, box.centre[:2])) - w.offset) - max(box.size[:2]) / 2 < AT_WALL
        for w in structure.walls_at(box.centre)
    )
    return Support.WALL if near_wall and not carried else Support.SURFACE


def _over(box: FittedBox, other: FittedBox) -> bool:
    return bool(
        np.hypot(box.centre[0] - other.centre[0], box.centre[1] - other.centre[1]) < max(other.size[:2]) / 2 + RESTING
    )
