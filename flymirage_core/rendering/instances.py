"""Which object each pixel shows: from a picture's depth and the objects' oriented boxes, no second rendering."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering import picture_kernels as kernels
from flymirage_core.rendering.camera import Camera

Float64 = NDArray[np.float64]

MARGIN = 0.03
"""Metres by which a box reaches out to its sides and its top: splats are soft, and boxes are measured."""
STANDS_ON = 0.03
"""Metres above a box's bottom up to which a surface belongs to what the object stands on."""


@dataclass(frozen=True, eq=False)
class OrientedBoxes:
    """Boxes as the renderer knows them: geometry and a number each. World frame, metres."""

    centres: Float64  # (B, 3)
    rotations: Float64  # (B, 3, 3) world from box
    sizes: Float64  # (B, 3) full lengths along the box's own axes
    ids: NDArray[np.uint16]  # (B,) from 1; 0 means no object

    def __len__(self) -> int:
        return len(self.ids)

    def __getitem__(self, index: slice | NDArray[np.intp]) -> "OrientedBoxes":
        return OrientedBoxes(self.centres[index], self.rotations[index], self.sizes[index], self.ids[index])


def instance_ids(depth: NDArray[np.float32], camera: Camera, boxes: OrientedBoxes) -> NDArray[np.uint16]:
    """The id (H, W) of the box that each pixel's point lies in; 0 where there is none or no depth.

    ``depth`` (H, W) is z-depth in metres, 0 = no return. Where boxes overlap the smallest wins: the lamp, not the table
    whose box it stands in.
    """
    ids = np.zeros(depth.shape, np.uint16)
    for box in np.argsort(-boxes.sizes.prod(axis=1), kind="stable"):  # the smallest is written last
        _mark(depth, camera, boxes, int(box), ids)
    return ids


def seen_share(depth: NDArray[np.float32], camera: Camera, boxes: OrientedBoxes) -> float:
    """Share of the picture's pixels that show a point in any of ``boxes``; arguments as in `instance_ids`."""
    ids = np.zeros(depth.shape, np.uint16)
    counts = [_mark(depth, camera, boxes, box, ids) for box in range(len(boxes))]
    return (counts[0] if len(counts) == 1 else int(np.count_nonzero(ids))) / ids.size


def _mark(depth: NDArray[np.float32], camera: Camera, boxes: OrientedBoxes, box: int, ids: NDArray[np.uint16]) -> int:
    """Write one box's id into the pixels that show it; how many those are."""
    half = boxes.sizes[box] / 2
    low = -half - MARGIN
    low[2] = -half[2] + min(STANDS_ON, half[2])
    high = half + MARGIN
    rectangle = _rectangle(camera, boxes.centres[box], boxes.rotations[box], low, high)
    if rectangle is None:
        return 0
    k, R_box_camera = camera.intrinsics, boxes.rotations[box].T @ camera.T_world_camera[:3, :3]  # (3, 3)
    inverse = np.array([[-k.cx / k.fx, -k.cy / k.fy, 1.0], [1 / k.fx, 0.0, 0.0], [0.0, 1 / k.fy, 0.0]])
    start = boxes.rotations[box].T @ (camera.position - boxes.centres[box])  # (3,)
    ray = np.vstack([start, inverse @ R_box_camera.T])  # (4, 3)
    return int(kernels.mark_box(depth, ray, rectangle, low, high, boxes.ids[box], ids))


def _rectangle(
    camera: Camera, centre: Float64, rotation: Float64, low: Float64, high: Float64
) -> tuple[int, int, int, int] | None:
    """First and end row, first and end column of the pixels that can show the box; None if there are none."""
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, 8).T @ rotation.T + centre  # (8, 3)
    pixels, depth = camera.project(corners)
    height, width = camera.intrinsics.height, camera.intrinsics.width
    if (depth <= 0).all():
        return None
    if (depth <= 0).any():
        return 0, height, 0, width  # the box reaches behind the camera: no bound
    (left, top), (right, bottom) = np.floor(pixels.min(axis=0)), np.ceil(pixels.max(axis=0))
    rows, columns = np.clip([top, bottom], 0, height).astype(int), np.clip([left, right], 0, width).astype(int)
    if rows[0] >= rows[1] or columns[0] >= columns[1]:
        return None
    return int(rows[0]), int(rows[1]), int(columns[0]), int(columns[1])
