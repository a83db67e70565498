"""The taxonomy and the two-step pick of paper section III-A."""

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.errors import InputError
from flymirage_core.scene.knowledge import kits, places
from flymirage_core.scene.taxonomy import STANDARD, load_taxonomy, standard_taxonomy, taxonomy_named

KEYS = st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True)


@pytest.mark.parametrize("name", STANDARD)
def test_each_standard_taxonomy_has_six_categories_with_twelve_subcategories_or_more(name):
    taxonomy = standard_taxonomy(name)
    assert len(taxonomy.categories) == 6
    assert all(len(set(c.subcategories)) >= 12 for c in taxonomy.categories)


@pytest.mark.parametrize("name", STANDARD)
def test_every_subcategory_has_knowledge_of_its_own(name):
    for category in standard_taxonomy(name).categories:
        for subcategory in category.subcategories:
            place = places()[subcategory]
            assert set(place.kits) | set(place.options) <= set(kits())
            assert place.notes


def test_every_category_has_places_under_a_roof_and_most_have_some_under_the_sky():
    for name in STANDARD:
        outdoors = [sum(places()[s].outdoor for s in c.subcategories) for c in standard_taxonomy(name).categories]
        assert min(outdoors) >= 1


@given(KEYS)
def test_a_pick_depends_on_the_key_alone_and_lies_in_the_taxonomy(key):
    taxonomy = standard_taxonomy()
    category, subcategory = taxonomy.pick(key)
    assert taxonomy.pick(key) == (category, subcategory)
    assert subcategory in next(c for c in taxonomy.categories if c.name == category).subcategories


@pytest.mark.parametrize("name", STANDARD)
def test_six_hundred_draws_that_each_know_the_earlier_ones_spread_within_ten_percent(name):
    taxonomy, counts = standard_taxonomy(name), Counter()
    for i in range(600):
        counts[taxonomy.pick(f"scene-{i:04d}", counts)] += 1
    for category in taxonomy.categories:
        own = [counts[category.name, s] for s in category.subcategories]
        assert 90 <= sum(own) <= 110
        assert max(own) - min(own) <= 1


def test_a_night_evens_out_what_earlier_nights_left_uneven():
    taxonomy = standard_taxonomy()
    counts = Counter({(c.name, c.subcategories[0]): 10 * i for i, c in enumerate(taxonomy.categories)})
    for i in range(150):
        counts[taxonomy.pick(f"night-{i:04d}", counts)] += 1
    totals = Counter()
    for (category, _), n in counts.items():
        totals[category] += n
    assert set(totals.values()) == {50}


def test_picks_without_history_reach_every_category():
    picked = {standard_taxonomy().pick(f"k{i}")[0] for i in range(80)}
    assert len(picked) == 6


def test_a_category_that_is_behind_is_picked_next():
    taxonomy = standard_taxonomy()
    counts = {(c.name, c.subcategories[0]): 3 for c in taxonomy.categories[1:]}
    assert all(taxonomy.pick(f"k{i}", counts)[0] == taxonomy.categories[0].name for i in range(20))


@pytest.mark.parametrize("text", ["{", '{"version": 1}', '{"version": 1, "categories": []}', "[]"])
def test_a_broken_taxonomy_file_gets_one_sentence_that_names_it(tmp_path: Path, text: str):
    path = tmp_path / "mine.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"mine\.json cannot be read .* expected JSON"):
        load_taxonomy(path)


def test_a_users_own_taxonomy_replaces_the_standard_one(tmp_path: Path):
    path = tmp_path / "mine.json"
    path.write_text('{"version": "lab 1", "categories": [{"name": "caves", "subcategories": ["grotto"]}]}')
    assert taxonomy_named(str(path)).pick("scene-1") == ("caves", "grotto")


def test_a_users_own_taxonomy_may_extend_a_standard_one(tmp_path: Path):
    path = tmp_path / "mine.json"
    path.write_text(
        '{"version": "lab 1", "extends": "site", "categories": ['
        '{"name": "Residential", "subcategories": ["igloo"]},'
        '{"name": "caves", "subcategories": [{"name": "old mine", "like": "mine gallery"}]}]}'
    )
    mine, site = taxonomy_named(str(path)), standard_taxonomy("site")
    assert len(mine.categories) == 7
    residential = {c.name: c.subcategories for c in mine.categories}["Residential"]
    assert residential == (*{c.name: c.subcategories for c in site.categories}["Residential"], "igloo")
    assert mine.like == {"old mine": "mine gallery"}
    assert mine.version == "site 2 + lab 1"
