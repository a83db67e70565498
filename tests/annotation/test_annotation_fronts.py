"""Pieces of one panel at a wall are one; two alike things hung side by side are two."""

import numpy as np

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.fused_points import FusedPoints
from flymirage_core.annotation.room_structure import HeightMap, RoomStructure, Wall
from flymirage_core.annotation.wall_fronts import join_fronts

WALL = Wall(np.array([1.0, 0.0]), 0.0, -3.0, 3.0, 0.0)
FLAT = HeightMap(np.zeros(2), np.zeros((1, 1)))
ROOM = RoomStructure(0.0, None, 0.0, (WALL,), FLAT, FLAT, None)


def pieces(*spans: tuple[float, float], depth: float = 0.12, top: float = 1.2) -> tuple[FusedPoints, list[FittedBox]]:
    """A cloud, and boxes at the wall x = 0: from y to y each, 20 cm high."""
    clouds, boxes, count = [], [], 0
    for start, end in spans:
        y, z = np.meshgrid(np.arange(start, end + 1e-6, 0.03), np.arange(top - 0.2, top + 1e-6, 0.03))
        clouds.append(np.stack([np.full(y.size, depth), y.ravel(), z.ravel()], axis=1))
        centre = (depth / 2, (start + end) / 2, top - 0.1)
        boxes.append(FittedBox(centre, (depth, end - start, 0.2), 0.0, np.arange(count, count + y.size)))
        count += y.size
    points = np.concatenate(clouds).astype(np.float32)
    blank = np.zeros_like(points)
    to_camera = np.tile(np.array([1.0, 0.0, 0.0], np.float32), (count, 1))
    return FusedPoints(points.astype(int), points, blank, to_camera, blank[:, 0], blank[:, 0].astype(np.int32)), boxes


def test_a_headboard_that_shows_between_pillows_is_one():
    cloud, boxes = pieces((-1.2, -0.8), (-0.5, -0.1), (0.2, 0.6))
    (whole,) = join_fronts(boxes, cloud, ROOM)
    assert sorted(whole.size)[2] > 1.7


def test_two_cabinets_side_by_side_are_two():
    cloud, boxes = pieces((-1.2, -0.8), (-0.5, -0.1))
    assert join_fronts(boxes, cloud, ROOM) == boxes


def test_what_is_not_flush_or_not_level_is_apart():
    cloud, boxes = pieces((-1.2, -0.8), (-0.5, -0.1), (0.2, 0.6))
    lower = FittedBox((0.06, 0.4, 0.9), (0.12, 0.4, 0.2), 0.0, boxes[2].members)
    deeper = FittedBox((0.09, 0.4, 1.1), (0.18, 0.4, 0.2), 0.0, boxes[2].members)
    for other in (lower, deeper):
        assert len(join_fronts([*boxes[:2], other], cloud, ROOM)) == 3


def test_far_pieces_are_apart():
    cloud, boxes = pieces((-2.6, -2.2), (-0.5, -0.1), (1.6, 2.0))
    assert len(join_fronts(boxes, cloud, ROOM)) == 3
