"""Names of colours and things: right where it is clear, "object" where it is not."""

from dataclasses import replace

import numpy as np
import pytest
from analytic_room import make_box
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.annotation.colours import colour_name, colour_step, shading_free, to_lab
from flymirage_core.annotation.labels import UNKNOWN, green

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
        ((112, 128, 144), "grey"), ((150, 152, 142), "grey"), ((178, 96, 60), "brown"), ((207, 118, 48), "orange"),
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


def test_leaves_are_green_and_wood_is_not():
    assert green(to_lab([LEAF, TABLE_TOP])).tolist() == [True, False]


@pytest.mark.parametrize(
    ("size", "words"),
    [((0.2, 0.2, 0.3), "small"), ((0.6, 0.5, 0.9), "medium"), ((2.0, 0.9, 0.8), "large")],
)
def test_things_have_a_size_class(size, words):
    assert make_box(0, (0, 0, 0), size).size_class == words


@pytest.mark.parametrize(
    ("size", "words"),
    [
        ((0.3, 0.3, 1.2), "tall red object"),
        ((1.2, 0.9, 0.2), "low red object"),
        ((2.0, 0.3, 0.4), "long red object"),
        ((0.5, 0.5, 0.6), "red object"),
    ],
)
def test_a_thing_without_a_name_is_told_by_its_colour_and_shape(size, words):
    assert replace(make_box(0, (0, 0, 0), size), label=UNKNOWN, colour="red").description == words


def test_a_thing_with_a_name_is_told_by_its_colour_and_name():
    assert replace(make_box(0, (0, 0, 0), (1, 1, 1)), label="stool", colour="red").description == "red stool"
