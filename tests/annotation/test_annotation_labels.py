"""Names of colours and things: right where it is clear, "object" where it is not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.annotation.colours import colour_name, colour_step, shading_free, to_lab
from flymirage_core.annotation.labels import UNKNOWN, USUAL_SIZES, Support, is_plant, name_box, name_plant

LEAF, TABLE_TOP = (60, 120, 50), (140, 100, 70)


def lab(*rgb: int) -> np.ndarray:
    return to_lab([rgb])[0]


@pytest.mark.parametrize(
    ("rgb", "name"),
    [
        ((255, 255, 255), "white"), ((10, 10, 12), "black"), ((128, 128, 128), "grey"), ((60, 60, 62), "dark grey"),
        ((200, 30, 35), "red"), ((240, 130, 20), "orange"), ((240, 215, 40), "yellow"), ((50, 150, 60), "green"),
        ((25, 70, 30), "dark green"), ((40, 80, 180), "blue"), ((20, 30, 80), "dark blue"), ((120, 60, 150), "purple"),
        ((110, 70, 40), "brown"), ((225, 205, 175), "beige"), ((235, 150, 180), "pink"), ((30, 130, 130), "teal"),
    ],
)  # fmt: skip
def test_colours_have_their_everyday_names(rgb, name):
    assert colour_name(lab(*rgb)) == name


@given(st.tuples(*[st.integers(0, 255)] * 3))
def test_every_colour_has_a_name_of_words(rgb):
    assert colour_name(lab(*rgb)).replace(" ", "").isalpha()


@given(st.tuples(*[st.integers(120, 255)] * 3), st.floats(0.6, 1.0))
def test_shade_changes_a_colour_less_than_hue_does(rgb, shade):
    whole, shaded = (shading_free(to_lab([np.multiply(rgb, k)])) for k in (1.0, shade))
    assert colour_step(whole, shaded)[0] < 20
    assert colour_step(shading_free(to_lab([(180, 60, 60)])), shading_free(to_lab([(60, 60, 180)])))[0] > 40


@pytest.mark.parametrize(
    ("size", "support", "noun"),
    [
        ((2.05, 0.9, 0.82), Support.FLOOR, "sofa"),
        ((0.45, 2.0, 0.9), Support.SURFACE, UNKNOWN),
        ((1.75, 0.92, 0.75), Support.FLOOR, "dining table"),
        ((0.9, 0.04, 0.65), Support.WALL, "picture"),
        ((0.42, 0.41, 1.62), Support.FLOOR, "floor lamp"),
        ((3.5, 3.0, 2.0), Support.FLOOR, UNKNOWN),
    ],
)
def test_usual_sizes_name_a_thing_and_unusual_ones_do_not(size, support, noun):
    assert name_box(size, support).noun == noun


def test_the_longer_side_may_lie_along_either_axis():
    assert name_box((0.9, 2.05, 0.82), Support.FLOOR) == name_box((2.05, 0.9, 0.82), Support.FLOOR)


@given(st.tuples(*[st.floats(0.01, 5)] * 3), st.sampled_from(Support))
def test_a_name_is_a_known_noun_its_family_or_object(size, support):
    label = name_box(size, support)
    assert label.noun in {UNKNOWN} | {k.noun for k in USUAL_SIZES} | {k.family for k in USUAL_SIZES}
    assert 0 <= label.fit <= 1


def test_two_kinds_of_one_family_that_fit_alike_get_the_familys_name():
    dining, desk = (next(k.size for k in USUAL_SIZES if k.noun == n) for n in ("dining table", "desk"))
    between = np.sqrt(np.multiply(dining, desk))
    assert name_box(between, Support.FLOOR).noun == "table"


def test_a_plant_is_green_and_rough():
    leaves, cabinet = to_lab([LEAF] * 50), np.zeros(50, np.float32)
    rough = np.full(50, 0.1, np.float32)
    assert is_plant(leaves, rough)
    assert not is_plant(leaves, cabinet)
    assert not is_plant(to_lab([TABLE_TOP] * 50), rough)


def test_a_plant_in_a_pot_is_a_plant():
    pot_and_leaves = to_lab([TABLE_TOP] * 50 + [LEAF] * 50)
    assert is_plant(pot_and_leaves, np.repeat(np.array([0.02, 0.1], np.float32), 50))


def test_plants_are_named_by_where_they_are():
    assert name_plant((0.3, 0.3, 0.4), Support.SURFACE).noun == "small plant"
    assert name_plant((0.6, 0.6, 1.2), Support.FLOOR).noun == "potted plant"
    assert name_plant((0.5, 0.5, 0.8), Support.CEILING).noun == "hanging plant"
