"""The scene from above, and from the side: what is occupied, the boxes, camera paths and flights."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.pictures.canvas import INK, PAPER, Colour, Picture, hue, put_text

_PIXELS_PER_METRE = 70
_MAX_SIDE = 1100


@dataclass(frozen=True, eq=False)
class FloorPlan:
    """A drawing that looks down along -z, +x to the right, +y up, or from the side. Draw through its methods."""

    picture: Picture
    lower: NDArray[np.float64]  # (2,) world coordinates of the lower left corner
    scale: float  # pixels per metre
    axes: tuple[int, int] = (0, 1)  # world axes that point to the right and up

    @staticmethod
    def of(grid: OccupancyGrid, heights: tuple[float, float]) -> "FloorPlan":
        """Grey where something is occupied between the two ``heights`` (metres), white where one could fly there."""
        low, high = (int(np.clip(i, 0, grid.state.shape[2])) for i in grid.index_of([[0, 0, h] for h in heights])[:, 2])
        return _drawing(grid, grid.state[:, :, low : max(high, low + 1)], (0, 1))

    @staticmethod
    def from_the_side(grid: OccupancyGrid) -> "FloorPlan":
        """Looks along +y through everything: +x to the right, +z up; the darker, the more of the way is occupied."""
        return _drawing(grid, grid.state, (0, 2))

    def pixel(self, points: ArrayLike) -> NDArray[np.int32]:
        """Pixels (N, 2) of world points (N, 3)."""
        xy = (np.atleast_2d(np.asarray(points, float))[:, list(self.axes)] - self.lower) * self.scale
        pixels: NDArray[np.int32] = np.rint(np.stack([xy[:, 0], self.picture.shape[0] - xy[:, 1]], 1)).astype(np.int32)
        return pixels

    def path(self, points: ArrayLike, colour: Colour, thickness: int = 2) -> None:
        cv2.polylines(self.picture, [self.pixel(points)], False, colour, thickness, cv2.LINE_AA)

    def coloured_path(self, points: ArrayLike, colours: Sequence[Colour], thickness: int = 2) -> None:
        """A path (K, 3) whose leg k has colour k, of K - 1."""
        pixels = self.pixel(points).tolist()
        for a, b, colour in zip(pixels[:-1], pixels[1:], colours, strict=True):
            cv2.line(self.picture, a, b, colour, thickness, cv2.LINE_AA)

    def dot(self, point: ArrayLike, colour: Colour, radius: int = 5) -> None:
        x, y = self.pixel(point)[0]
        cv2.circle(self.picture, (int(x), int(y)), radius, colour, -1, cv2.LINE_AA)

    def boxes(self, boxes: Iterable[ObjectBox]) -> None:
        for box in boxes:
            corners = self.pixel(box.corners[[0, 4, 6, 2]])
            cv2.polylines(self.picture, [corners], True, hue(box.object_id), 1, cv2.LINE_AA)
            x, y = self.pixel(box.centre)[0]
            put_text(self.picture, box.label, (int(x) - 3 * len(box.label), int(y)), 0.33, INK)

    def with_caption(self, lines: Sequence[str]) -> Picture:
        """The drawing with lines of text below it."""
        strip = np.full((10 + 18 * len(lines), self.picture.shape[1], 3), PAPER, np.uint8)
        for i, line in enumerate(lines):
            put_text(strip, line, (8, 18 + 18 * i), 0.42)
        return np.concatenate([self.picture, strip], axis=0)


def _drawing(grid: OccupancyGrid, layer: NDArray[np.uint8], axes: tuple[int, int]) -> FloorPlan:
    """The part ``layer`` of the grid, seen along the axis that is not in ``axes``."""
    along = ({0, 1, 2} - set(axes)).pop()
    share = (layer == OCCUPIED).mean(axis=along)  # (A, B)
    free = (layer == FREE).any(axis=along)
    shade = np.where(free, 255 - 150 * share, np.where(share > 0, 120 - 60 * share, 216))
    size = np.array(share.shape) * grid.resolution
    scale = min(_PIXELS_PER_METRE, _MAX_SIDE / float(size.max()))
    image = cv2.resize(
        np.flipud(shade.T).astype(np.uint8),
        (max(1, int(size[0] * scale)), max(1, int(size[1] * scale))),
        interpolation=cv2.INTER_NEAREST,
    )
    return FloorPlan(np.repeat(image[:, :, None], 3, axis=2).astype(np.uint8), grid.origin[list(axes)], scale, axes)
