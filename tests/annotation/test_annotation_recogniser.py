"""Names: what the recogniser says and when it is silent, what the 2D detector may overrule, and who is dropped."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.annotation.appearance import FEATURES, Observation, mirrored, reversed_depth
from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.fused_points import Frame, FusedPoints
from flymirage_core.annotation.labels import UNKNOWN, Support
from flymirage_core.annotation.naming import BESIDE_DETECTOR, Name, agree, chosen_name, is_bare_front, is_believed
from flymirage_core.annotation.picture_joins import join_pieces
from flymirage_core.annotation.picture_votes import Vote, visible_windows, votes
from flymirage_core.annotation.recogniser import Recogniser, Recognition, trained_recogniser
from flymirage_core.annotation.room_structure import HeightMap, RoomStructure
from flymirage_core.annotation.yolox import PictureDetection
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along


def recogniser(logits: list[float]) -> Recogniser:
    """One that says the same of everything: armchair, office chair, vase, or no object."""
    zeros = np.zeros((1, FEATURES, 4), np.float32)
    return Recogniser(
        mean=np.zeros(FEATURES, np.float32),
        scale=np.ones(FEATURES, np.float32),
        hidden=((zeros, np.zeros((1, 1, 4), np.float32)),),
        noun_head=(np.zeros((1, 4, 4), np.float32), np.array([[logits]], np.float32)),
        material_head=(np.zeros((1, 4, 2), np.float32), np.array([[[0.0, 4.0]]], np.float32)),
        nouns=("dining chair", "office chair", "vase"),
        families=("chair", "chair", "vase"),
        materials=("wood", "metal"),
        min_noun=0.6,
        min_family=0.7,
        min_material=0.8,
    )


def said(*logits: float) -> str:
    return recogniser(list(logits)).recognise(np.zeros((1, FEATURES), np.float32))[0].noun


def test_a_sure_noun_is_said():
    assert said(5, 0, 0, 0) == "dining chair"


def test_two_nouns_of_one_family_give_the_familys_name():
    assert said(5, 5, 0, 0) == "chair"


def test_what_may_be_anything_is_an_object():
    assert said(1, 1, 1, 1) == UNKNOWN


def test_a_material_is_guessed_where_it_is_sure():
    (answer,) = recogniser([5, 0, 0, 0]).recognise(np.zeros((1, FEATURES), np.float32))
    assert answer.material == "metal"
    (unsure,) = replace(recogniser([5, 0, 0, 0]), min_material=0.99).recognise(np.zeros((1, FEATURES), np.float32))
    assert unsure.material == ""


def test_the_trained_weights_fit_the_features_and_are_small():
    trained = trained_recogniser()
    nouns, materials = trained.probabilities(np.zeros((3, FEATURES), np.float32))
    assert nouns.shape == (3, len(trained.nouns) + 1)
    assert np.allclose(nouns.sum(axis=1), 1, atol=1e-3)
    assert np.allclose(materials.sum(axis=1), 1, atol=1e-3)
    assert len(trained.nouns) >= 50


def test_features_that_never_occurred_do_not_run_away():
    nouns, _ = trained_recogniser().probabilities(np.full((1, FEATURES), 1e6, np.float32))
    assert np.isfinite(nouns).all()


@given(st.integers(0, 1000))
def test_what_is_mirrored_twice_is_as_before(seed):
    features = np.random.default_rng(seed).normal(size=(2, FEATURES)).astype(np.float32)
    assert np.array_equal(mirrored(mirrored(features)), features)
    assert np.array_equal(reversed_depth(reversed_depth(features)), features)
    assert not np.array_equal(mirrored(features), features)


def test_a_kind_of_chair_agrees_with_a_chair():
    assert agree("office chair", "chair")
    assert agree("chair", "office chair")
    assert not agree("chairlift", "chair")
    assert not agree("television", "painting")


# --- the 2D detector's votes


INTRINSICS = Intrinsics.from_horizontal_fov(160, 120, math.radians(90))


def frame(distance: float, wall: float = 9.0) -> Frame:
    """A view along +y at the origin's height, from so many metres before it; all is at y = 0 and nothing else shows."""
    camera = Camera(INTRINSICS, look_along([0, -distance, 0], [0, 1, 0]))
    depth = np.full((120, 160), min(distance, wall), np.float32)
    return Frame(camera, np.zeros((120, 160, 3), np.uint8), depth, depth)


def box(x: float, size: tuple[float, float, float] = (0.6, 0.6, 0.9), points: int = 100) -> FittedBox:
    return FittedBox((x, 0.0, 0.0), size, 0.0, np.arange(points))


def front(box: FittedBox) -> np.ndarray:
    """Points (N, 3) of the face in which the box's middle lies."""
    x, z = np.meshgrid(
        np.linspace(-0.5, 0.5, 25) * box.size[0] + box.centre[0], np.linspace(-0.5, 0.5, 25) * box.size[2]
    )
    return np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3).astype(np.float32)


FRAMES = [frame(2.0), frame(2.2), frame(2.4)]


def windows(*boxes: FittedBox) -> np.ndarray:
    return visible_windows([front(box) for box in boxes], FRAMES)


def found(label: str, of: FittedBox, score: float = 0.8) -> list[list[PictureDetection]]:
    (seen,) = windows(of)
    return [[PictureDetection(label, score, tuple(map(float, window)))] for window in seen]


def test_views_that_agree_name_a_box():
    (vote,) = votes([box(0)], windows(box(0)), found("couch", box(0, (1.6, 0.8, 0.8))))
    assert vote is None  # a window that does not fit says nothing
    sofa = box(0, (1.6, 0.8, 0.8))
    (vote,) = votes([sofa], windows(sofa), found("couch", sofa))
    assert vote is not None
    assert vote.noun == "sofa"
    assert vote.weight == pytest.approx(2.4)
    assert vote.views == 3


def test_one_doubtful_view_is_not_enough():
    detections = found("chair", box(0), score=0.3)
    assert votes([box(0)], windows(box(0)), [detections[0], [], []]) == [None]


@pytest.mark.parametrize("label", ["person", "umbrella", "cat"])
def test_what_lives_or_flies_is_not_believed(label):
    assert votes([box(0)], windows(box(0)), found(label, box(0))) == [None]


def test_a_noun_that_the_size_forbids_is_not_believed():
    assert votes([box(0)], windows(box(0)), found("bed", box(0))) == [None]


def test_a_hidden_box_is_not_voted_for():
    hidden = visible_windows([front(box(0))], [frame(2.0, wall=1.0)] * 3)
    assert np.isnan(hidden).all()
    assert votes([box(0)], hidden, found("chair", box(0))) == [None]


def test_what_is_hidden_of_a_thing_is_not_in_its_window():
    half = frame(2.0)
    half.depth[60:] = 1.0  # a table before its lower half
    (whole, upper) = visible_windows([front(box(0))], [frame(2.0), half])[0]
    assert upper[3] == pytest.approx(60, abs=2)
    assert upper[:3] == pytest.approx(whole[:3], abs=2)


def test_of_rivals_the_one_that_fits_best_gets_the_vote():
    left, right, both = box(-0.5), box(0.5), box(0, (1.6, 0.6, 0.9))
    said = votes([left, right, both], windows(left, right, both), found("couch", both))
    assert said[0] is said[1] is None
    assert said[2].weight == pytest.approx(2.4)


def points_of(left: FittedBox, right: FittedBox) -> tuple[FusedPoints, list[FittedBox]]:
    """A cloud of two boxes' fronts, and the boxes made from it."""
    points = np.concatenate([front(left), front(right)])
    blank = np.zeros_like(points)
    cloud = FusedPoints(np.zeros((len(points), 3), int), points, blank, blank - [0, 1, 0], blank[:, 0], blank[:, 0])
    half = len(points) // 2
    return cloud, [replace(left, members=np.arange(half)), replace(right, members=np.arange(half, 2 * half))]


FLAT = HeightMap(np.zeros(2), np.full((1, 1), -0.45))
EMPTY = RoomStructure(-0.45, None, 0.0, (), FLAT, FLAT, None)


def test_halves_of_a_thing_that_the_detector_sees_whole_become_one():
    cloud, halves = points_of(box(-0.4, (0.78, 0.6, 0.9)), box(0.4, (0.78, 0.6, 0.9)))
    sofa = found("couch", box(0, (1.6, 0.6, 0.9)))
    (whole,) = join_pieces(halves, cloud, EMPTY, FRAMES, sofa)
    assert whole.size[0] == pytest.approx(1.58, abs=0.05)


@pytest.mark.parametrize("label", ["chair", "dining table"])
def test_two_chairs_and_what_stands_round_a_table_stay_apart(label):
    cloud, chairs = points_of(box(-0.4, (0.78, 0.6, 0.9)), box(0.4, (0.78, 0.6, 0.9)))
    each = [a + b for a, b in zip(found("chair", chairs[0]), found("chair", chairs[1]), strict=True)]
    said = each if label == "chair" else found(label, box(0, (1.6, 0.6, 0.9)))
    assert len(join_pieces(chairs, cloud, EMPTY, FRAMES, said)) == 2


# --- which boxes are believed


def name(noun: str = UNKNOWN, source: str = "recogniser", left_over: float = 0.1) -> Name:
    return Name(noun, source, 0.5, "", left_over)


def seen(nearest: float = 1.0, views: int = 9) -> Detections:
    return Detections(views, nearest, np.zeros(0, int))


def test_what_looks_like_a_left_over_is_dropped_unless_the_detector_knows_it_and_more_gently_from_afar():
    assert not is_believed(box(0), name(left_over=0.85), seen())
    assert is_believed(box(0), name("chair", "detector", 0.9), seen())
    assert is_believed(box(0), name(left_over=0.85), seen(4.0))
    assert not is_believed(box(0), name(left_over=0.95), seen(4.0))
    assert is_believed(box(0), name(left_over=0.9), seen(views=30))  # bulky and seen from everywhere


def test_a_flat_thing_on_a_wall_is_no_television_because_the_detector_says_so():
    unsure = Recognition(UNKNOWN, 0.2, "", 0.0)
    on_wall = replace(box(0, (0.9, 0.05, 0.6)), on_wall=True)
    assert chosen_name(unsure, Vote("television", 3.0, 8), on_wall).noun == UNKNOWN
    assert chosen_name(unsure, Vote("television", 3.0, 8), box(0)).noun == "television"


def test_nameless_slats_and_wall_panels_are_dropped_but_nameless_things_stay():
    assert is_believed(box(0), name(left_over=0.73), seen())
    assert not is_believed(box(0, (0.9, 0.03, 0.6)), name(left_over=0.73), seen())
    assert is_believed(box(0, (0.9, 0.05, 0.6)), name(), seen())  # surely a thing, though a thin one
    panel = replace(box(0, (0.9, 0.05, 2.5)), on_wall=True)
    assert not is_believed(panel, name(), seen())
    assert not is_believed(panel, replace(name("notice board"), score=0.3), seen())  # a mere guess
    assert is_believed(panel, name("notice board"), seen())
    assert is_believed(replace(box(0, (0.9, 0.05, 0.6)), on_wall=True), name(), seen())


@pytest.mark.parametrize("size", [(0.4, 0.6, 2.4), (0.7, 0.7, 2.3)])
def test_nameless_pillars_are_dropped_and_named_tall_things_stay(size):
    assert not is_believed(box(0, size), name(left_over=0.5), seen())
    assert is_believed(box(0, size), name("wardrobe", left_over=0.5), seen())
    assert is_believed(box(0, size), name(), seen())  # surely a thing: a column that stands free
    assert is_believed(box(0, (1.0, 1.2, 2.4)), name(left_over=0.5), seen())


def observed(relief: float, support: Support = Support.SURFACE) -> Observation:
    nothing = np.zeros(0, np.float32)
    return Observation(box(0), support, nothing, relief, nothing)


def test_of_a_nameless_thing_at_a_wall_more_than_a_flat_face_must_be_seen():
    assert is_bare_front(observed(0.03), name(left_over=0.55))
    assert not is_bare_front(observed(0.2), name(left_over=0.55))
    assert not is_bare_front(observed(0.03, Support.FLOOR), name(left_over=0.55))
    assert not is_bare_front(observed(0.03), name("wall shelf", left_over=0.55))
    assert not is_bare_front(observed(0.03), name(left_over=0.1))


def test_where_a_detector_looked_too_and_knew_nothing_less_is_believed():
    doubtful = name(left_over=0.74)
    assert is_believed(box(0), doubtful, seen())
    assert not is_believed(box(0), doubtful, seen(), BESIDE_DETECTOR)
    assert is_believed(box(0), replace(name("chair", left_over=0.74), source="detector"), seen(), BESIDE_DETECTOR)
    assert is_bare_front(observed(0.03), name(left_over=0.4), BESIDE_DETECTOR)
    assert not is_bare_front(observed(0.03), name(left_over=0.4))


def test_a_nameless_thing_needs_several_views_and_a_named_one_or_what_surely_is_a_thing_does_not():
    assert not is_believed(box(0), name(left_over=0.73), seen(views=3))
    assert is_believed(box(0), name(left_over=0.73), seen(views=4))
    assert is_believed(box(0), name(left_over=0.1), seen(views=2))
    assert is_believed(box(0), name("vase"), seen(views=1))


def test_a_window_is_no_thing():
    assert not is_believed(box(0), name("window"), seen())
