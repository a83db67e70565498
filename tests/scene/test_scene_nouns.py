"""The writer's nouns and the catalogue that builds them: the two rooms do not know each other, this test does."""

import numpy as np

from flymirage_core.scene.knowledge import fillers, finishes, kits, nouns
from flymirage_core.worldgen.catalogue import KINDS
from flymirage_core.worldgen.colours import NAMED


def test_everything_that_the_writer_may_ask_for_can_be_built():
    assert set(nouns()) <= set(KINDS)
    assert len(nouns()) >= 150


def test_small_things_stand_on_what_has_a_top():
    assert not [noun for noun, known in nouns().items() if known.holds and not KINDS[noun].top]


def test_sizes_in_words_and_in_the_catalogue_agree():
    """Within a factor of two on each side: the writer keeps room by its own sizes."""
    for noun, known in nouns().items():
        if not KINDS[noun].full_height and not KINDS[noun].flat:
            middle = (np.array(KINDS[noun].smallest) + KINDS[noun].largest) / 2
            ratio = np.prod(np.array(known.size[:2]) / middle[:2]) ** 0.5
            assert 0.5 <= ratio <= 2.0, (noun, known.size, middle)


def test_every_colour_has_a_paint():
    colours = {colour for finish in finishes().values() for found in finish.values() for colour in found}
    assert colours <= set(NAMED)


def test_every_noun_stands_in_some_kit_or_is_a_filler():
    used = {row.want.noun for rows in kits().values() for row in rows}
    assert not set(nouns()) - used.union(*fillers().values())
