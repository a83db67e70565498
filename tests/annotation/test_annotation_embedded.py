"""The embedded annotator on small rooms that are ray cast exactly; truth is for scoring only."""

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest
from analytic_room import Body, Room, Thing, block, chair, lamp, make_box, picture, sweep, table, views_of

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.fused_points import Frame, frames_of
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.rendering.rasterizer import Rendering
from flymirage_core.rendering.views import View
from flymirage_core.settings import AnnotationSettings

ANNOTATOR = EmbeddedAnnotator(AnnotationSettings())
BROWN, GREEN, BLUE, RED, GREY = (120, 70, 40), (40, 90, 60), (40, 70, 150), (150, 40, 40), (70, 70, 75)
EYES = ((0.0, 0.0, 1.4), (0.9, -1.2, 1.2), (-0.9, -0.9, 1.6), (0.0, 1.0, 1.1))


def all_boxes(frames: Sequence[Frame], max_distance: float = math.inf) -> list[FittedBox]:
    return [thing.box for thing, _ in ANNOTATOR.observations(ANNOTATOR.evidence(frames, max_distance))]


def turned(thing: Thing, yaw: float) -> Thing:
    c, s = np.cos(yaw), np.sin(yaw)
    x, y, z = thing.place
    return Thing(thing.name, (c * x - s * y, s * x + c * y, z), thing.yaw + yaw, thing.bodies)


@cache
def annotated(*things: Thing, yaw: float = 0.0, max_distance: float = math.inf) -> BoxMap:
    """Boxes found in a 5 x 4.4 x 2.6 m room with these things, all turned by ``yaw``, from a few places in it."""
    room = Room((5, 4.4, 2.6), tuple(turned(t, yaw) for t in things), yaw)
    return ANNOTATOR.annotate(room_views(room), max_distance)


def room_views(room: Room) -> list[View]:
    return [view for eye in EYES for view in views_of(room, sweep(eye, yaws=6, pitches=(-35, 5)))]


def best(boxes: BoxMap, truth: ObjectBox) -> tuple[float, ObjectBox]:
    return max(((yaw_iou(truth, box), box) for box in boxes), key=lambda pair: pair[0], default=(0.0, truth))


def test_a_chair_at_a_table_becomes_its_own_box():
    things = table((1.0, 0.6, 0), BROWN), chair((1.0, 0.1, 0), GREEN)
    frames = frames_of(room_views(Room((5, 4.4, 2.6), things, 0.0)))
    boxes = all_boxes(frames)  # whatever the recogniser thinks of it
    found = [best(boxes, t.box) for t in things]
    assert min(iou for iou, _ in found) > 0.4
    assert found[0][1] != found[1][1]


def test_a_chair_of_the_tables_colour_becomes_its_own_box():
    things = table((1.0, 0.8, 0), BROWN), chair((1.0, -0.1, 0), BROWN)
    boxes = annotated(*things)
    assert min(best(boxes, t.box)[0] for t in things) > 0.4


def test_a_lamp_is_split_from_the_desk_it_stands_on():
    desk, light = block("desk", (-1.7, 0.8, 0), (0.7, 1.4, 0.75), GREY), lamp((-1.7, 1.0, 0.75))
    boxes = annotated(desk, light)
    assert best(boxes, light.box)[0] > 0.5
    assert best(boxes, desk.box)[0] > 0.7


def test_a_thing_of_the_desks_own_colour_is_split_from_it():
    desk, radio = (
        block("desk", (-1.7, 0.8, 0), (0.7, 1.4, 0.75), GREY),
        block("radio", (-1.7, 0.6, 0.75), (0.3, 0.3, 0.3), GREY),
    )
    boxes = annotated(desk, radio)
    assert best(boxes, radio.box)[0] > 0.5
    assert best(boxes, desk.box)[0] > 0.7


def test_two_things_on_one_desk_are_two_boxes():
    desk = block("desk", (-1.7, 0.4, 0), (0.7, 1.6, 0.75), GREY)
    pair = (
        block("vase", (-1.7, 0.0, 0.75), (0.2, 0.2, 0.3), RED),
        block("box", (-1.7, 0.6, 0.75), (0.3, 0.3, 0.25), BLUE),
    )
    boxes = annotated(desk, *pair)
    assert min(best(boxes, t.box)[0] for t in pair) > 0.5


@pytest.mark.parametrize("yaw", [0.35, 0.9])
def test_the_yaw_of_things_in_a_turned_room_is_recovered(yaw):
    sofa = block("sofa", (0.6, 1.4, 0), (1.8, 0.8, 0.7), RED)
    iou, box = best(annotated(sofa, yaw=yaw), turned(sofa, yaw).box)
    assert iou > 0.75
    assert (box.yaw - yaw + np.pi / 4) % (np.pi / 2) - np.pi / 4 == pytest.approx(0, abs=np.radians(3))


def test_a_box_askew_to_the_room_keeps_its_own_yaw():
    askew = block("chest", (-1.2, 0.9, 0), (0.9, 0.5, 0.6), BROWN, yaw=0.5)
    iou, box = best(annotated(askew), askew.box)
    assert iou > 0.75
    assert (box.yaw - 0.5 + np.pi / 4) % (np.pi / 2) - np.pi / 4 == pytest.approx(0, abs=np.radians(5))


def test_a_picture_is_found_on_its_wall_with_the_right_size():
    painting = picture((0.5, 2.2, 1.5), BLUE)
    iou, box = best(annotated(painting), painting.box)
    assert iou > 0.4
    assert sorted(box.size)[1:] == pytest.approx([0.65, 0.9], abs=0.08)
    assert min(box.size) < 0.12


def test_a_board_of_the_walls_own_colour_is_found_by_its_relief():
    board = picture((0.5, 2.2, 1.5), (165, 160, 150))  # lit as boards are, it looks like the wall
    frames = frames_of(room_views(Room((5, 4.4, 2.6), (board,), 0.0)))
    found = all_boxes(frames)
    assert best(found, board.box)[0] > 0.4


def test_a_box_of_the_counters_colour_near_its_rim_is_told_from_it():
    counter = block("counter", (0.9, 0.8, 0), (1.5, 0.6, 0.95), GREY)
    till = block("till", (1.4, 0.75, 0.95), (0.4, 0.38, 0.3), GREY)
    boxes = annotated(counter, till)
    assert min(best(boxes, t.box)[0] for t in (counter, till)) > 0.4


def test_the_back_of_a_counter_is_no_thing_on_it():
    back = block("counter", (0.9, 0.8, 0), (1.5, 0.6, 0.95), GREY)
    back = Thing("counter", back.place, 0.0, (*back.bodies, Body((0.0, 0.24, 1.1), (1.5, 0.12, 0.3), GREY)))
    assert len(annotated(back)) == 1


def test_a_bicycle_rack_is_one_thing():
    hoops = tuple(Body((0.7 * k, 0.0, 0.38), (0.06, 0.7, 0.76), GREY) for k in (-1, 0, 1))
    rack = Thing("rack", (0.6, 0.6, 0), 0.0, hoops)
    frames = frames_of(room_views(Room((5, 4.4, 2.6), (rack,), 0.0)))
    found = all_boxes(frames)
    assert best(found, rack.box)[0] > 0.6


def test_an_empty_room_has_no_objects_so_floor_ceiling_and_walls_are_none():
    assert len(annotated()) == 0
    assert len(annotated(yaw=0.4)) == 0


def test_every_box_is_one_of_the_things():
    things = (
        table((1.0, 0.6, 0), BROWN),
        block("desk", (-1.7, 0.8, 0), (0.7, 1.4, 0.75), GREY),
        block("sofa", (0.3, -1.6, 0), (1.8, 0.8, 0.7), RED),
        picture((0.5, 2.2, 1.5), BLUE),
    )
    boxes = annotated(*things)
    assert len(boxes) == len(things)
    assert all(max(yaw_iou(box, t.box) for t in things) > 0.4 for box in boxes)


def far_and_near() -> tuple[Room, list[View]]:
    """A long room seen from one end: a chest 1.5 m and a wardrobe 6 m away."""
    near, far = block("near", (-3.5, 0.5, 0), (0.6, 0.5, 0.8), RED), block("far", (2.2, 0, 0), (0.6, 1.2, 1.6), BLUE)
    room = Room((10, 3, 2.6), (near, far))
    return room, views_of(room, sweep((-4.5, 0, 1.4), yaws=12) + sweep((-4.2, 0, 1.4), yaws=12))


def test_an_object_seen_only_from_beyond_the_distance_is_not_in_the_map():
    room, views = far_and_near()
    frames = frames_of(views)  # whatever the recogniser thinks of them
    everything, close = (all_boxes(frames, limit) for limit in (math.inf, 3.0))
    wardrobe = room.truth[1]
    assert any(wardrobe.contains(np.array(box.centre), margin=0.3) for box in everything)
    assert all(wardrobe.distance(np.array(box.centre)) > 1.0 for box in close)
    assert best(close, room.truth[0])[0] > 0.5


def test_nearest_camera_distance_and_supporting_frames_are_those_of_views_within_the_distance():
    room, views = far_and_near()
    _, box = best(ANNOTATOR.annotate(views, 3.0), room.truth[0])
    distances = [float(np.linalg.norm(np.subtract(box.centre, v.camera.position))) for v in views]
    assert box.nearest_camera_distance == pytest.approx(min(distances))
    assert 2 <= box.supporting_frames < len(views)


def test_no_views_give_an_empty_map():
    assert len(ANNOTATOR.annotate([], math.inf)) == 0


def test_views_without_any_depth_give_an_empty_map():
    (camera,) = sweep((0, 0, 1), yaws=1, pitches=(0,))
    k = camera.intrinsics
    nothing = np.zeros((k.height, k.width), np.float32)
    assert (
        len(
            ANNOTATOR.annotate(
                [View(camera, Rendering(np.zeros((*nothing.shape, 3), np.uint8), nothing, nothing))], 3.0
            )
        )
        == 0
    )


def test_depth_that_is_not_finite_is_no_evidence():
    room = Room((5, 4.4, 2.6), (block("chest", (1.2, 0.5, 0), (0.6, 0.5, 0.8), RED),))
    views = room_views(room)
    broken = []
    for view in views:
        depth = view.picture.depth.copy()
        depth[::7], depth[3::7] = np.nan, np.inf
        broken.append(View(view.camera, Rendering(view.picture.rgb, depth, view.picture.alpha)))
    assert all(np.isfinite(frame.depth).all() for frame in frames_of(broken))
    assert all(np.isfinite([*b.centre, *b.size, b.yaw]).all() for b in ANNOTATOR.annotate(broken, math.inf))


def test_the_same_views_give_the_same_boxes_to_the_last_bit():
    things = table((1.0, 0.6, 0), BROWN), chair((1.0, 0.1, 0), GREEN), lamp((1.0, 0.8, 0.74))
    views = room_views(Room((5, 4.4, 2.6), things))
    assert ANNOTATOR.annotate(views, 3.0) == ANNOTATOR.annotate(iter(views), 3.0)


def test_ids_count_from_zero_and_every_box_names_its_annotator():
    boxes = annotated(table((1.0, 0.6, 0), BROWN), block("desk", (-1.7, 0.8, 0), (0.7, 1.4, 0.75), GREY))
    assert [b.object_id for b in boxes] == list(range(len(boxes)))
    assert {b.annotator for b in boxes} == {f"embedded {EmbeddedAnnotator.version}"}
    assert all(0 <= b.score <= 1 for b in boxes)


def test_colours_are_named_as_seen():
    _, box = best(
        annotated(block("sofa", (0.6, 1.4, 0), (1.8, 0.8, 0.7), RED)), make_box(0, (0.6, 1.4, 0.35), (1.8, 0.8, 0.7))
    )
    assert "red" in box.colour
