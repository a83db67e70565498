"""The hierarchy of scene types, and the two-step pick of paper section III-A: a category, then a subcategory in it."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np

from flymirage_core.errors import InputError
from flymirage_core.scene.keys import rng


@dataclass(frozen=True)
class Category:
    """A broad kind of place and its subcategories."""

    name: str
    subcategories: tuple[str, ...]


@dataclass(frozen=True)
class Taxonomy:
    """A versioned list of categories; their order does not matter to anybody but a seeded pick."""

    version: str
    categories: tuple[Category, ...]

    def pick(self, scene_key: str, counts_so_far: Mapping[tuple[str, str], int] | None = None) -> tuple[str, str]:
        """(category, subcategory) for a scene, seeded by its key.

        Among the categories that ``counts_so_far`` ((category, subcategory) -> scenes) shows least often, one is drawn;
        then likewise a subcategory. So the first pick of an empty data set is uniform, and growth evens itself out.
        """
        counts = counts_so_far or {}
        generator = rng(scene_key, "taxonomy")
        totals = [sum(n for (c, _), n in counts.items() if c == category.name) for category in self.categories]
        category = self.categories[_draw_rarest(totals, generator)]
        within = [counts.get((category.name, name), 0) for name in category.subcategories]
        return category.name, category.subcategories[_draw_rarest(within, generator)]


def _draw_rarest(counts: list[int], generator: np.random.Generator) -> int:
    """A seeded choice among the places where ``counts`` is least. One draw in any case, so seeds stay aligned."""
    share = generator.uniform()
    rarest = np.flatnonzero(np.asarray(counts) == min(counts))
    return int(rarest[int(share * len(rarest))])


def load_taxonomy(path: Path) -> Taxonomy:
    """Read a taxonomy file: {"version": ..., "categories": [{"name": ..., "subcategories": [...]}]}."""
    try:
        return _parse(path.read_text())
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"taxonomy {path} cannot be read ({error!r}); expected JSON with a version and categories that each have "
            "a name and a list of subcategories"
        ) from error


@cache
def standard_taxonomy() -> Taxonomy:
    """The paper's six categories, with the project's own subcategories."""
    return _parse(resources.files("flymirage_core.scene").joinpath("taxonomy.json").read_text())


def _parse(text: str) -> Taxonomy:
    data = json.loads(text)
    categories = tuple(Category(c["name"], tuple(c["subcategories"])) for c in data["categories"])
    if not categories or not all(c.subcategories for c in categories):
        raise ValueError("every taxonomy needs a category, and every category a subcategory")
    return Taxonomy(str(data["version"]), categories)
