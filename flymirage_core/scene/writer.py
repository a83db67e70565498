"""Who writes scene descriptions: the port that an LLM fills, and its offline twin, which composes them from furnishing data."""

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any, Protocol

import numpy as np

from flymirage_core.scene.description import PlannedObject, Provenance, SceneDescription
from flymirage_core.scene.keys import check_scene_key, rng
from flymirage_core.scene.prose import prose_of
from flymirage_core.scene.taxonomy import Taxonomy, standard_taxonomy

NAME = "offline 1"
OBJECTS_WANTED = (82, 95)
"""How many objects a description asks for; the paper's scenes have 60 to 100, and not all of them can be found again."""
SIZE_RANGE = ((9.6, 12.0), (8.4, 10.0), (2.9, 3.5))
"""Metres: length, width and height of rooms."""
FILLERS = (
    "painting",
    "small plant",
    "vase",
    "stack of books",
    "storage box",
    "poster",
    "candle holder",
    "potted plant",
)
"""What is added where a place's own sets ask for too little."""
FILLER_PLACES = {"painting": "on_wall", "poster": "on_wall", "potted plant": "on_floor"}


class SceneWriter(Protocol):
    """Describes the scene of a key: what kind of place, and what is in it (paper section III-A)."""

    name: str

    def describe(self, scene_key: str) -> SceneDescription: ...


class OfflineSceneWriter:
    """Composes descriptions from the taxonomy and the furnishing data: same key and counts, same description."""

    name = NAME

    def __init__(
        self, taxonomy: Taxonomy | None = None, counts_so_far: Mapping[tuple[str, str], int] | None = None
    ) -> None:
        self.taxonomy = taxonomy or standard_taxonomy()
        self.counts_so_far = dict(counts_so_far or {})

    def describe(self, scene_key: str) -> SceneDescription:
        """The description of a scene; raises `SceneKeyError` for a key that may not name one."""
        check_scene_key(scene_key)
        category, subcategory = self.taxonomy.pick(scene_key, self.counts_so_far)
        generator = rng(scene_key, "description")
        data = _furnishing()
        look = data["categories"].get(category) or _any(generator, list(data["categories"].values()))
        kits = data["subcategories"].get(subcategory) or _any(generator, list(data["subcategories"].values()))
        wall, floor = _any(generator, look["wall_colours"]), _any(generator, look["floor_colours"])
        style = (
            f"{_any(generator, look['styles'])}, {_any(generator, look['floors'])}, {_any(generator, look['walls'])}"
        )
        objects = _objects(data, kits, generator)
        accents = [o.colour for o in objects if o.placement in ("against_wall", "on_floor")][:3]
        x, y, z = (round(float(generator.uniform(a, b)), 1) for a, b in SIZE_RANGE)
        description = SceneDescription(
            scene=scene_key,
            title=f"{style.split(',')[0].capitalize()} {subcategory}",
            category=category,
            subcategory=subcategory,
            setting="indoor",
            dimensions=(x, y, z),
            style=style,
            palette=(wall, floor, *dict.fromkeys(accents)),
            light=_any(generator, data["lights"]),
            objects=objects,
            prose="",
            provenance=Provenance(kind="generated", writer=NAME),
        )
        return description.model_copy(update={"prose": prose_of(description, generator)})


def _objects(data: dict[str, Any], kits: list[str], generator: np.random.Generator) -> tuple[PlannedObject, ...]:
    """What stands in the room: the sets' things, in two finishes where there are many, filled up to what is wanted."""
    wanted = int(generator.integers(*OBJECTS_WANTED))
    counts: dict[tuple[str, str, str], int] = {}
    for kit in kits:
        for row in data["sets"][kit]:
            key = row["noun"], row["placement"], row["relative_to"]
            counts[key] = counts.get(key, 0) + int(generator.integers(row["least"], row["most"] + 1))
    while sum(counts.values()) < wanted:
        noun = str(generator.choice(FILLERS))
        key = noun, FILLER_PLACES.get(noun, "on_surface"), ""
        counts[key] = counts.get(key, 0) + 1
    planned = []
    for (noun, placement, relative_to), count in counts.items():
        finish = data["finishes"][data["nouns"][noun]]
        colours = generator.permutation(finish["colours"])
        groups = 1 if placement in ("around", "in_row") or count < 2 else min(count, len(colours), 3)
        for i in range(groups):
            share = count // groups + (i < count % groups)
            if share:
                material = _any(generator, finish["materials"])
                planned.append(
                    PlannedObject(
                        noun=noun,
                        count=share,
                        colour=str(colours[i]),
                        material=material,
                        placement=placement,  # type: ignore[arg-type]
                        relative_to=relative_to,
                    )
                )
    return tuple(planned)


def _any(generator: np.random.Generator, choices: list[Any]) -> Any:
    return choices[int(generator.integers(len(choices)))]


@cache
def _furnishing() -> dict[str, Any]:
    """Sets of furniture for each subcategory, and the finishes of each noun."""
    data: dict[str, Any] = json.loads(resources.files("flymirage_core.scene").joinpath("furnishing.json").read_text())
    return data
