"""The hierarchy of scene types, and the two-step pick of paper section III-A: a category, then a subcategory in it."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from flymirage_core.errors import InputError
from flymirage_core.scene.keys import rng

STANDARD = ("paper", "site")
"""The paper's six categories, and the newer six of the project's site."""
EXPECTED = (
    'expected JSON like {"version": "lab 1", "extends": "paper", "categories": [{"name": "caves", "subcategories": '
    '["grotto", {"name": "old mine", "like": "mine gallery"}]}]}; without "extends" it replaces the standard one'
)


@dataclass(frozen=True)
class Category:
    """A broad kind of place and its subcategories."""

    name: str
    subcategories: tuple[str, ...]


@dataclass(frozen=True)
class Taxonomy:
    """A versioned list of categories; their order does not matter to anybody but a seeded pick.

    ``like`` names, for a subcategory of the user's own, a known one that the offline writer may take it after.
    """

    version: str
    categories: tuple[Category, ...]
    like: Mapping[str, str] = field(default_factory=dict)

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

    def extended(self, other: "Taxonomy") -> "Taxonomy":
        """This taxonomy with the other's categories added; where names agree, their subcategories are joined."""
        joined = {c.name: list(c.subcategories) for c in self.categories}
        for category in other.categories:
            known = joined.setdefault(category.name, [])
            known += [s for s in category.subcategories if s not in known]
        categories = tuple(Category(name, tuple(subs)) for name, subs in joined.items())
        return Taxonomy(f"{self.version} + {other.version}", categories, {**self.like, **other.like})


def _draw_rarest(counts: list[int], generator: np.random.Generator) -> int:
    """A seeded choice among the places where ``counts`` is least. One draw in any case, so seeds stay aligned."""
    share = generator.uniform()
    rarest = np.flatnonzero(np.asarray(counts) == min(counts))
    return int(rarest[int(share * len(rarest))])


def taxonomy_named(name: str) -> Taxonomy:
    """A standard taxonomy ("paper", "site"), or the one in a file; raises `InputError` if it is neither."""
    return standard_taxonomy(name) if name in STANDARD else load_taxonomy(Path(name))


def load_taxonomy(path: Path) -> Taxonomy:
    """Read a taxonomy file of the user's own, which replaces a standard one or extends it."""
    try:
        data = json.loads(path.read_text())
        own = _parse(str(data["version"]), [(c["name"], c["subcategories"]) for c in data["categories"]])
        base = data.get("extends", "")
        return standard_taxonomy(base).extended(own) if base else own
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"taxonomy {path} cannot be read ({error!r}); {EXPECTED}") from error


@cache
def standard_taxonomy(name: str = "paper") -> Taxonomy:
    """One of `STANDARD`, with the project's own subcategories; raises `ValueError` for another name."""
    data = json.loads(resources.files("flymirage_core.scene").joinpath("taxonomy.json").read_text())
    if name not in data["taxonomies"]:
        raise ValueError(f"no standard taxonomy {name!r}; there are {list(data['taxonomies'])}")
    return _parse(f"{name} {data['version']}", list(data["taxonomies"][name].items()))


def _parse(version: str, categories: list[tuple[str, list[Any]]]) -> Taxonomy:
    like: dict[str, str] = {}
    parsed = []
    for name, subcategories in categories:
        rows = [{"name": s} if isinstance(s, str) else s for s in subcategories]
        like.update({str(r["name"]): str(r["like"]) for r in rows if "like" in r})
        parsed.append(Category(str(name), tuple(str(r["name"]) for r in rows)))
    if not parsed or not all(c.subcategories for c in parsed):
        raise ValueError("every taxonomy needs a category, and every category a subcategory")
    return Taxonomy(version, tuple(parsed), like)
