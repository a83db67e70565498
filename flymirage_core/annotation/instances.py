"""Object boxes as the renderer takes them, and the instance picture that comes of them."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.rendering import instances
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.instances import OrientedBoxes


def instance_ids(depth: NDArray[np.float32], camera: Camera, boxes: Iterable[ObjectBox]) -> NDArray[np.uint16]:
    """``object_id + 1`` of the box that each pixel's point lies in (H, W); 0 where there is none or no depth.

    ``depth`` (H, W) is z-depth in metres, 0 = no return. Where boxes overlap, the smallest wins.
    """
    return instances.instance_ids(depth, camera, oriented_boxes(boxes))


def oriented_boxes(boxes: Iterable[ObjectBox]) -> OrientedBoxes:
    """The geometry of ``boxes``, numbered ``object_id + 1``."""
    listed = list(boxes)
    return OrientedBoxes(
        np.array([box.centre for box in listed], float).reshape(-1, 3),
        np.array([box.rotation for box in listed], float).reshape(-1, 3, 3),
        np.array([box.size for box in listed], float).reshape(-1, 3),
        np.array([box.object_id + 1 for box in listed], np.uint16),
    )
