"""Object boxes drawn into a view as wireframes with their labels."""

from collections.abc import Iterable

import cv2
import numpy as np

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.pictures.canvas import Colour, Picture, hue, put_text
from flymirage_core.rendering.camera import Camera

_EDGES = [(a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1]  # corners differ in one axis
_NEAR = 0.05  # metres: edges are cut here rather than thrown through the camera


def draw_boxes(picture: Picture, camera: Camera, boxes: Iterable[ObjectBox], max_distance: float = np.inf) -> Picture:
    """A copy of ``picture`` with the boxes whose centre lies within ``max_distance`` metres of the camera."""
    out = np.ascontiguousarray(picture).copy()
    for box in sorted(boxes, key=lambda b: -float(np.linalg.norm(np.subtract(b.centre, camera.position)))):
        if np.linalg.norm(np.subtract(box.centre, camera.position)) <= max_distance:
            draw_box(out, camera, box, hue(box.object_id))
    return out


def draw_box(picture: Picture, camera: Camera, box: ObjectBox, colour: Colour) -> None:
    """Draw one wireframe and its label into ``picture``, in place."""
    local = box.corners @ camera.T_camera_world[:3, :3].T + camera.T_camera_world[:3, 3]  # (8, 3)
    if local[:, 2].max() < _NEAR:
        return
    for a, b in _EDGES:
        _draw_edge(picture, camera, local[a], local[b], colour)
    pixel, depth = camera.project(box.centre)
    if depth[0] > _NEAR and (pixel[0] >= 0).all() and (pixel[0] < picture.shape[1::-1]).all():
        x, y = int(pixel[0, 0]), int(pixel[0, 1])
        put_text(picture, box.label, (x + 1, y + 1), 0.36, (0, 0, 0))
        put_text(picture, box.label, (x, y), 0.36, (255, 255, 255))


def _draw_edge(picture: Picture, camera: Camera, start: np.ndarray, end: np.ndarray, colour: Colour) -> None:
    if start[2] < _NEAR and end[2] < _NEAR:
        return
    if min(start[2], end[2]) < _NEAR:
        near, far = (start, end) if start[2] < end[2] else (end, start)
        t = (_NEAR - near[2]) / (far[2] - near[2])
        start, end = near + t * (far - near), far
    k = camera.intrinsics
    ends = [
        (int(np.clip(k.fx * p[0] / p[2] + k.cx, -1e5, 1e5)), int(np.clip(k.fy * p[1] / p[2] + k.cy, -1e5, 1e5)))
        for p in (start, end)
    ]
    cv2.line(picture, ends[0], ends[1], colour, 1, cv2.LINE_AA)
