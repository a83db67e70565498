"""Which object a pixel shows: against asking each pixel's point, one by one, which boxes it lies in."""

import numpy as np
from filmed_room import box, furnished_room, ray_cast
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.annotation.instances import instance_ids, oriented_boxes
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.instances import MARGIN, STANDS_ON, seen_share

INTRINSICS = Intrinsics(60, 44, 40.0, 42.0, 31.0, 20.0)


def pixel_by_pixel(depth: np.ndarray, camera: Camera, boxes) -> np.ndarray:
    k = camera.intrinsics
    ids = np.zeros(depth.shape, np.uint16)
    for (row, column), z in np.ndenumerate(depth):
        ray = [(column + 0.5 - k.cx) / k.fx, (row + 0.5 - k.cy) / k.fy, 1.0]
        point = camera.T_world_camera[:3, :3] @ (np.array(ray) * z) + camera.position
        for item in sorted(boxes, key=lambda b: -np.prod(b.size)):
            local, half = item.to_local(point), np.array(item.size) / 2
            low = np.array([-half[0] - MARGIN, -half[1] - MARGIN, -half[2] + STANDS_ON])
            if z > 0 and (local >= low).all() and (local <= half + MARGIN).all():
                ids[row, column] = item.object_id + 1
    return ids


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_any_camera_amid_any_boxes_sees_what_asking_every_pixel_says(seed):
    rng = np.random.default_rng(seed)
    boxes = [
        box(i, "thing", tuple(rng.uniform(-3, 3, 3)), tuple(rng.uniform(0.1, 3, 3)), yaw=rng.uniform(-4, 4))
        for i in range(6)
    ]
    camera = Camera(INTRINSICS, look_along(rng.uniform(-3, 3, 3), rng.normal(size=3)))
    depth = rng.uniform(0, 6, (44, 60)).astype(np.float32) * (rng.random((44, 60)) > 0.1)
    np.testing.assert_array_equal(
        instance_ids(depth.astype(np.float32), camera, boxes),
        pixel_by_pixel(depth.astype(np.float32), camera, boxes),
    )


def test_a_red_chair_is_where_the_red_pixels_are():
    boxes = furnished_room()
    camera = Camera(Intrinsics.from_horizontal_fov(160, 120, 1.4), look_along([0, 0, 1.2], [3, 2, -0.6]))
    rgb, depth = ray_cast(camera, boxes)
    r, g, b = np.moveaxis(rgb.astype(int), 2, 0)
    red = (r > 3 * g) & (r > 3 * b)
    chair = instance_ids((depth / 1000).astype(np.float32), camera, boxes) == 1
    assert red.sum() > 300 and np.mean(chair[red]) > 0.95 and np.mean(red[chair]) > 0.95


def test_the_lamp_on_the_table_is_the_lamp():
    boxes = [box(0, "table", (3, 0, 0.75), (2, 2, 1.5)), box(1, "lamp", (3, 0, 1.3), (0.4, 0.4, 0.4))]
    camera = Camera(INTRINSICS, look_along([0, 0, 1.3], [1, 0, 0]))
    ids = instance_ids(np.full((44, 60), 2.9, np.float32), camera, boxes)
    assert ids[20, 31] == 2 and ids[20, 42] == 1


def test_the_floor_under_a_chair_is_not_the_chair():
    camera = Camera(INTRINSICS, look_along([0, 0, 3], [0, 0, -1]))
    seat = [box(4, "chair", (0, 0, 0.5), (1, 1, 1))]
    assert not instance_ids(np.full((44, 60), 3.0, np.float32), camera, seat).any()
    assert instance_ids(np.full((44, 60), 2.0, np.float32), camera, seat)[20, 31] == 5


def test_no_boxes_no_depth_and_boxes_behind_the_camera_give_nothing():
    camera = Camera(INTRINSICS, look_along([0, 0, 1], [1, 0, 0]))
    depth = np.full((44, 60), 2.0, np.float32)
    behind = [box(0, "chair", (-2, 0, 1), (1, 1, 1))]
    assert not instance_ids(depth, camera, []).any() and not instance_ids(depth, camera, behind).any()
    assert not instance_ids(0 * depth, camera, [box(0, "room", (0, 0, 1), (9, 9, 9))]).any()


def test_the_seen_share_counts_the_targets_pixels():
    camera = Camera(INTRINSICS, look_along([0, 0, 1], [1, 0, 0]))
    door = box(3, "door", (2, 0, 1), (0.5, 0.9, 1.1))
    depth = np.full((44, 60), 2.0, np.float32)
    share = seen_share(depth, camera, oriented_boxes([door]))
    assert share == np.mean(instance_ids(depth, camera, [door]) == 4) > 0.1
    assert seen_share(depth / 2, camera, oriented_boxes([door])) == 0  # something stands before it
