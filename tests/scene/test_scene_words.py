"""English in descriptions: articles, plurals, what is said of a thing, agreement."""

import numpy as np
import pytest

from flymirage_core.scene.design import PlannedObject
from flymirage_core.scene.grammar import frame, rules, sentence
from flymirage_core.scene.inflection import article, listing, phrase, plural
from flymirage_core.scene.knowledge import nouns


def thing(noun: str, count: int = 1, colour: str = "teal", material: str = "oak", **more: str) -> PlannedObject:
    return PlannedObject(noun=noun, count=count, colour=colour, material=material, placement="on_floor", **more)


def test_words_are_inflected():
    assert [plural(n) for n in ("bookshelf", "bench", "dining table")] == ["bookshelves", "benches", "dining tables"]
    assert [plural(n) for n in ("stack of books", "battery", "cactus")] == ["stacks of books", "batteries", "cacti"]
    assert article("ochre vase") == "an"
    assert article("university courtyard") == "a"
    assert listing(["a", "b", "c"]) == "a, b and c"


def test_every_noun_has_a_plural_that_differs_from_it_but_aircraft():
    assert [noun for noun in nouns() if plural(noun) == noun] == ["light aircraft"]


@pytest.mark.parametrize(
    ("groups", "said"),
    [
        ([thing("desk", 1, "oak brown", "oak")], "a brown oak desk"),
        (
            [thing("desk", 2, "navy", "painted wood", size="large", state="dusty")],
            "two large dusty navy painted wood desks",
        ),
        ([thing("desk", 1, "tan"), thing("desk", 2, "sand")], "three oak desks in tan and sand"),
        ([thing("desk", 1, "tan"), thing("desk", 1, "tan", "steel")], "two tan desks"),
        ([thing("desk", 1, "tan"), thing("desk", 1, "tan", size="large")], "two tan oak desks"),
        ([thing("painting", 2, "black", "walnut")], "two paintings in black walnut frames"),
        ([thing("cardboard box", 1, "tan", "cardboard")], "a tan cardboard box"),
        ([thing("stack of books", 2, "navy", "paper")], "two stacks of navy books"),
        ([thing("pallet of sacks", 1, "tan", "burlap")], "a pallet of tan sacks"),
    ],
)
def test_things_are_named_as_people_would(groups, said):
    assert phrase(groups)[0] == said


def test_every_frame_can_be_filled_in_both_numbers():
    slots = dict.fromkeys(
        [
            "things",
            "anchor",
            "walls_word",
            "ground_word",
            "side",
            "style",
            "place",
            "era",
            "x",
            "y",
            "z",
            "floor",
            "walls",
            "ceiling",
            "ground",
            "facades",
            "light",
            "time",
            "when",
        ],
        "thing",
    )
    starts = [r for r in rules() if any("{" in alternative and alternative.endswith(".") for alternative in rules()[r])]
    assert len(starts) >= 14
    generator = np.random.default_rng(0)
    for rule in starts:
        for _ in range(100):
            for many in (False, True):
                text = sentence(rule, slots, many, generator)
                assert text[0].isupper()
                assert text.endswith(".")
                assert not set("<>[]{}|") & set(text), text


def test_a_rule_makes_very_many_frames():
    generator = np.random.default_rng(0)
    assert len({frame("opening", generator) for _ in range(400)}) > 150


def test_verbs_agree_with_their_subject():
    generator = np.random.default_rng(0)
    said = {
        sentence("on_floor", {"things": "THEM", "walls_word": "walls", "ground_word": "floor"}, True, generator)
        for _ in range(300)
    }
    assert not [s for s in said if "THEM stands" in s or "THEM is" in s or "THEM has" in s]
