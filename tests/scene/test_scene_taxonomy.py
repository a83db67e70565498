"""The taxonomy and the two-step pick of paper section III-A."""

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.errors import InputError
from flymirage_core.scene.taxonomy import load_taxonomy, standard_taxonomy

KEYS = st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True)


def test_the_taxonomy_has_the_papers_six_categories_with_twelve_subcategories_each():
    taxonomy = standard_taxonomy()
    assert len(taxonomy.categories) == 6
    assert all(len(set(c.subcategories)) >= 12 for c in taxonomy.categories)


@given(KEYS)
def test_a_pick_depends_on_the_key_alone_and_lies_in_the_taxonomy(key):
    taxonomy = standard_taxonomy()
    category, subcategory = taxonomy.pick(key)
    assert taxonomy.pick(key) == (category, subcategory)
    assert subcategory in next(c for c in taxonomy.categories if c.name == category).subcategories


def test_growing_scene_by_scene_keeps_categories_and_subcategories_even():
    taxonomy, counts = standard_taxonomy(), Counter()
    for i in range(144):
        counts[taxonomy.pick(f"scene-{i:04d}", counts)] += 1
    per_category = Counter()
    for (category, _), n in counts.items():
        per_category[category] += n
    assert set(per_category.values()) == {24}
    assert set(counts.values()) == {2}


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


def test_a_users_own_taxonomy_is_read(tmp_path: Path):
    path = tmp_path / "mine.json"
    path.write_text('{"version": "lab 1", "categories": [{"name": "caves", "subcategories": ["grotto"]}]}')
    assert load_taxonomy(path).pick("scene-1") == ("caves", "grotto")
