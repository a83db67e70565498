"""Colours in white light: what lamps, shade and several colours in one thing would make of them."""

import numpy as np
import pytest

from flymirage_core.annotation.light import in_white_light, light_of, seen_colour
from flymirage_core.language.looks import coloured
from flymirage_core.language.scene_relations import Truth

DAYLIGHT, LAMPLIGHT, SKYLIGHT = (1.0, 1.0, 1.0), (1.0, 0.86, 0.66), (0.78, 0.9, 1.0)
PAINTS = {"white": (0.8, 0.79, 0.77), "grey": (0.27, 0.28, 0.28), "red": (0.4, 0.05, 0.04), "blue": (0.05, 0.12, 0.4),
          "green": (0.06, 0.2, 0.08), "black": (0.025, 0.025, 0.026), "brown": (0.16, 0.08, 0.04)}  # fmt: skip


def seen_in(light, *reflectances):
    """Pixels (N, 3), 0..255, of surfaces in a light, each a little uneven."""
    shading = np.random.default_rng(1).uniform(0.85, 1.0, (200, 1))
    linear = np.concatenate([shading * np.multiply(light, each) for each in reflectances])
    return 255 * np.clip(1.055 * linear ** (1 / 2.4) - 0.055, 0, 1)


def may_be_called(word, colour):
    return coloured(word, colour) is not Truth.NO


@pytest.mark.parametrize("light", [DAYLIGHT, LAMPLIGHT, SKYLIGHT, tuple(0.3 * x for x in LAMPLIGHT)])
@pytest.mark.parametrize("paint", PAINTS)
def test_a_thing_has_its_own_colour_in_any_light(light, paint):
    place = light_of(seen_in(light, *PAINTS.values()))
    assert may_be_called(paint, seen_colour(seen_in(light, PAINTS[paint]), place))


def test_the_light_is_that_of_the_bright_surfaces():
    red, green, blue = light_of(seen_in(LAMPLIGHT, *PAINTS.values())).colour
    assert green == 1.0
    assert red > 1.1
    assert blue < 0.85


def test_a_thing_of_several_colours_has_its_commonest_and_not_their_mean():
    place = light_of(seen_in(DAYLIGHT, *PAINTS.values()))
    assert seen_colour(seen_in(DAYLIGHT, *[PAINTS["red"]] * 3, *[PAINTS["white"]] * 2), place) == "red"


def test_a_lamp_that_shines_has_the_colour_of_its_shade():
    place = light_of(seen_in(DAYLIGHT, *PAINTS.values()))
    shining = np.full((300, 3), 254.0)
    assert seen_colour(np.concatenate([shining, seen_in(DAYLIGHT, PAINTS["green"])]), place) == "green"
    assert seen_colour(shining, place) == "white"


def test_no_colour_is_said_of_what_was_not_seen():
    assert seen_colour(np.zeros((0, 3)), light_of(np.zeros((0, 3)))) == ""


def test_a_white_thing_in_dark_pictures_is_bright_in_white_light():
    dark = (0.1, 0.1, 0.1)
    place = light_of(seen_in(dark, *PAINTS.values()))
    assert np.median(in_white_light(seen_in(dark, PAINTS["white"]), place)[:, 0]) > 72
