"""The offline writer: descriptions that are whole, various, grammatical and the same for the same key."""

import json
import re
from importlib import resources

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.errors import SceneKeyError
from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.prose import article, listing, plural
from flymirage_core.scene.taxonomy import Category, Taxonomy, standard_taxonomy
from flymirage_core.scene.writer import OfflineSceneWriter

KEYS = st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True)
writer = OfflineSceneWriter()


@given(KEYS)
@settings(max_examples=40, deadline=None)
def test_the_same_key_gives_the_same_description_and_it_survives_its_file_format(key):
    description = writer.describe(key)
    assert description == OfflineSceneWriter().describe(key)
    assert SceneDescription.model_validate_json(description.model_dump_json()) == description


@given(KEYS)
@settings(max_examples=40, deadline=None)
def test_a_description_asks_for_a_full_room_and_names_only_what_is_there(key):
    description = writer.describe(key)
    assert 88 <= sum(o.count for o in description.objects) <= 110
    nouns = {o.noun for o in description.objects}
    assert all(o.relative_to == "" or o.relative_to in nouns for o in description.objects)
    assert 9 <= description.dimensions[0] <= 12
    assert 8 <= description.dimensions[1] <= 10
    assert 2.8 <= description.dimensions[2] <= 3.6


@given(KEYS)
@settings(max_examples=40, deadline=None)
def test_prose_is_made_of_whole_sentences_with_right_articles(key):
    prose = writer.describe(key).prose
    assert prose[0].isupper()
    assert prose.endswith(".")
    assert not re.search(r"\ba [aeio]|\ban [^aeiou ]|  | ,|\.\.|[{}]", prose)
    assert not re.search(r"\b(\w+) \1\b", prose)  # "cardboard cardboard"


def test_every_subcategory_of_the_standard_taxonomy_has_its_own_furnishing():
    data = json.loads(resources.files("flymirage_core.scene").joinpath("furnishing.json").read_text())
    known = {name for c in standard_taxonomy().categories for name in c.subcategories}
    assert set(data["subcategories"]) == known
    assert {c.name for c in standard_taxonomy().categories} == set(data["categories"])
    for rows in data["sets"].values():
        for row in rows:
            assert data["finishes"][data["nouns"][row["noun"]]]


def test_a_taxonomy_of_the_users_own_still_yields_a_furnished_room():
    own = OfflineSceneWriter(Taxonomy("lab 1", (Category("caves", ("grotto",)),)))
    description = own.describe("scene-1")
    assert description.subcategory == "grotto"
    assert sum(o.count for o in description.objects) >= 88


def test_scenes_differ_from_each_other():
    descriptions = [writer.describe(f"scene-{i:04d}") for i in range(30)]
    assert len({tuple((o.noun, o.count, o.colour) for o in d.objects) for d in descriptions}) == 30
    assert len({d.prose for d in descriptions}) == 30


def test_a_bad_key_is_refused():
    with pytest.raises(SceneKeyError):
        writer.describe("../../etc")


def test_words_are_inflected():
    assert [plural(n) for n in ("bookshelf", "bench", "dining table")] == ["bookshelves", "benches", "dining tables"]
    assert article("ochre vase") == "an"
    assert listing(["a", "b", "c"]) == "a, b and c"
