"""Yaw IoU, the pruning of detections by distance, and the fusion of clusters."""

import numpy as np
import pytest
from analytic_room import make_box
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.annotation.fusion import Detection, fuse_detections, prune_by_distance, yaw_iou
from flymirage_core.settings import AnnotationSettings

SETTINGS = AnnotationSettings(min_detections=2)
angle = st.floats(-np.pi, np.pi)
length = st.floats(0.1, 2)
place = st.floats(-1, 1)
boxes = st.builds(
    lambda x, y, z, w, d, h, a: make_box(0, (x, y, z), (w, d, h), a), place, place, place, length, length, length, angle
)


def seen(centre, size=(1.0, 0.5, 1.0), yaw=0.0, score=0.8, view=0, label="chair", camera=(0.0, 0.0, 1.5)) -> Detection:
    return Detection(label, centre, size, yaw, score, view, camera)


@given(boxes)
def test_a_box_overlaps_itself_wholly(box):
    assert yaw_iou(box, box) == pytest.approx(1.0)


@given(boxes, boxes, angle, place)
def test_iou_is_symmetric_and_does_not_change_when_both_boxes_move_and_turn_together(a, b, turn, shift):
    def moved(box):
        c, s = np.cos(turn), np.sin(turn)
        x, y, z = box.centre
        return make_box(0, (c * x - s * y + 7 * shift, s * x + c * y - shift, z + shift), box.size, box.yaw + turn)

    iou = yaw_iou(a, b)
    assert 0 <= iou <= 1
    assert yaw_iou(b, a) == pytest.approx(iou, abs=1e-9)
    assert yaw_iou(moved(a), moved(b)) == pytest.approx(iou, abs=1e-9)


@given(boxes, boxes)
def test_iou_agrees_with_points_thrown_at_random(a, b):
    points = np.random.default_rng(0).uniform(-2.5, 2.5, (20_000, 3))
    in_a, in_b = a.contains(points), b.contains(points)
    union = (in_a | in_b).sum()
    if union > 200:
        assert yaw_iou(a, b) == pytest.approx((in_a & in_b).sum() / union, abs=4 * 0.5 / np.sqrt(union))


@given(length, length, length, length, st.sampled_from([-1, 0, 1]), st.sampled_from([-1, 0, 1]), angle)
def test_boxes_that_share_a_part_of_an_edge_overlap_exactly(w1, d1, w2, d2, side_x, side_y, yaw):
    # rectangles with flush edges: where OpenCV's polygon clipping fails
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = side_x * (w1 - w2) / 2, side_y * (d1 - d2) / 2
    a = make_box(0, (0, 0, 0), (w1, d1, 1), yaw)
    b = make_box(0, (c * x - s * y, s * x + c * y, 0), (w2, d2, 1), yaw)
    shared = min(w1, w2) * min(d1, d2)
    assert yaw_iou(a, b) == pytest.approx(shared / (w1 * d1 + w2 * d2 - shared), abs=1e-9)


def test_boxes_above_each_other_do_not_overlap():
    assert yaw_iou(make_box(0, (0, 0, 0)), make_box(0, (0, 0, 1))) == 0.0


def test_a_detection_beyond_the_distance_from_its_own_camera_is_pruned():
    near = seen((2.9, 0, 1.5))
    same_place_seen_from_afar = seen((2.9, 0, 1.5), camera=(-1, 0, 1.5))
    at_the_limit = seen((3.0, 0, 1.5))
    assert prune_by_distance([near, same_place_seen_from_afar, at_the_limit], 3.0) == [near, at_the_limit]


def test_detections_of_one_object_become_one_box_weighted_by_score():
    fused = fuse_detections(
        [seen((1, 0, 0.5), score=0.9, view=1), seen((1.1, 0, 0.5), score=0.3, view=2)], SETTINGS, "d 1", "d"
    )
    (box,) = fused
    assert box.centre == pytest.approx((1.025, 0, 0.5))
    assert box.supporting_frames == 2
    assert box.score == pytest.approx(0.6)
    assert box.nearest_camera_distance == pytest.approx(np.sqrt(2))
    assert (box.annotator, box.label_source) == ("d 1", "d")


def test_boxes_with_swapped_axes_are_turned_before_they_are_averaged():
    swapped = seen((0, 0, 0), (0.5, 1.0, 1.0), yaw=np.pi / 2, view=1)
    (box,) = fuse_detections([seen((0, 0, 0), score=0.9), swapped], SETTINGS, "d", "d")
    assert box.size == pytest.approx((1.0, 0.5, 1.0))
    assert abs(np.sin(box.yaw)) < 1e-9


def test_yaws_half_a_turn_apart_are_the_same_box():
    (box,) = fuse_detections([seen((0, 0, 0), yaw=0.1), seen((0, 0, 0), yaw=0.1 + np.pi, view=1)], SETTINGS, "d", "d")
    assert np.sin(box.yaw - 0.1) == pytest.approx(0, abs=1e-9)


def test_the_label_with_the_largest_sum_of_scores_wins():
    three = [
        seen((0, 0, 0), label="sofa", score=0.9),
        seen((0, 0, 0), view=1, score=0.5),
        seen((0, 0, 0), view=2, score=0.5),
    ]
    assert fuse_detections(three, SETTINGS, "d", "d").boxes[0].label == "chair"


def test_an_object_that_too_few_views_saw_is_dropped():
    twice_in_one_view = [seen((0, 0, 0)), seen((0.05, 0, 0))]
    assert len(fuse_detections(twice_in_one_view, SETTINGS, "d", "d")) == 0


def test_separate_objects_stay_separate_and_are_numbered_in_order():
    detections = [seen((x, 0, 0), view=v) for v in (0, 1) for x in (0.0, 3.0)]
    fused = fuse_detections(detections, SETTINGS, "d", "d")
    assert [b.object_id for b in fused] == [0, 1]
    assert [b.centre[0] for b in fused] == pytest.approx([0, 3])


def test_no_detections_give_an_empty_map():
    assert len(fuse_detections([], SETTINGS, "d", "d")) == 0
