"""Who writes scene descriptions: the port that an LLM fills, and its offline twin, which composes them from data."""

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any, NamedTuple, Protocol

import numpy as np

from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import Light, PlannedObject, Surface, Zone
from flymirage_core.scene.keys import check_scene_key, rng
from flymirage_core.scene.prose import prose_of
from flymirage_core.scene.taxonomy import Taxonomy, standard_taxonomy

NAME = "offline 1"
OBJECTS_WANTED = (88, 98)
"""How many objects a description asks for; the paper's scenes have 60 to 100, and not all can be found again."""
SIZE_RANGE = ((9.6, 12.0), (8.4, 10.0), (2.9, 3.5))
"""Metres: length, width and height of rooms."""
WALL_SHARE = 0.2
"""Of all objects, how many hang on walls before fillers go elsewhere."""


class SceneWriter(Protocol):
    """Describes the scene of a key: what kind of place, and what is in it (paper section III-A).

    ``place`` is (category, subcategory) where growth chose it for balance; else the writer picks by the key.
    """

    name: str

    def describe(self, scene_key: str, place: tuple[str, str] | None = None) -> SceneDescription: ...


class OfflineSceneWriter:
    """Composes descriptions from the taxonomy and the furnishing data: same key and counts, same description."""

    name = NAME

    def __init__(
        self, taxonomy: Taxonomy | None = None, counts_so_far: Mapping[tuple[str, str], int] | None = None
    ) -> None:
        self.taxonomy = taxonomy or standard_taxonomy()
        self.counts_so_far = dict(counts_so_far or {})

    def describe(self, scene_key: str, place: tuple[str, str] | None = None) -> SceneDescription:
        """The description of a scene; raises `SceneKeyError` for a key that may not name one."""
        check_scene_key(scene_key)
        category, subcategory = place or self.taxonomy.pick(scene_key, self.counts_so_far)
        generator = rng(scene_key, "description")
        data = _furnishing()
        look = data["categories"].get(category) or _any(generator, list(data["categories"].values()))
        kits = data["subcategories"].get(subcategory) or _any(generator, list(data["subcategories"].values()))
        wall, floor = _any(generator, look["wall_colours"]), _any(generator, look["floor_colours"])
        floors, walls = _any(generator, look["floors"]), _any(generator, look["walls"])
        style = _any(generator, look["styles"])
        objects = _objects(data, kits, look["fillers"], generator)
        accents = [o.colour for o in objects if o.placement in ("against_wall", "on_floor")][:3]
        x, y, z = (round(float(generator.uniform(a, b)), 1) for a, b in SIZE_RANGE)
        surfaces = (
            Surface(part="floor", colour=floor, material=floors.removesuffix(" floor")),
            Surface(part="walls", colour=wall, material=walls.removesuffix(" walls")),
            Surface(part="ceiling", colour="white", material="plaster"),
        )
        description = SceneDescription(
            scene=scene_key,
            title=f"{style.capitalize()} {subcategory}",
            category=category,
            subcategory=subcategory,
            setting="indoor",
            dimensions=(x, y, z),
            zones=(
                Zone(name=subcategory, kind="room", dimensions=(x, y, z), surfaces=surfaces, connects_to=(), windows=3),
            ),
            style=style,
            era="",
            palette=(wall, floor, *dict.fromkeys(accents)),
            light=Light(
                time_of_day="afternoon",
                sky="clear",
                sources=("windows", "hanging_lamps"),
                words=_any(generator, data["lights"]),
            ),
            objects=objects,
            prose="",
            image_prompt="",
            world_prompt="",
            provenance=Provenance(kind="generated", writer=NAME),
        )
        prose = prose_of(description, generator)
        return description.model_copy(update={"prose": prose, "image_prompt": prose, "world_prompt": prose})


class Want(NamedTuple):
    """A kind of thing at a kind of place."""

    noun: str
    placement: str
    relative_to: str = ""


def _anchored(counts: dict[Want, int]) -> dict[Want, int]:
    """Without seats for what is not in the room; small things whose table is missing stand anywhere."""
    present = {want.noun for want, n in counts.items() if n}
    result: dict[Want, int] = {}
    for want, n in counts.items():
        if want.relative_to and want.relative_to not in present:
            if want.placement == "around":
                continue
            want = want._replace(relative_to="")
        if n:
            result[want] = result.get(want, 0) + n
    return result


def _fill_up(
    counts: dict[Want, int],
    wanted: int,
    fillers: dict[str, list[str]],
    holds: dict[str, int],
    generator: np.random.Generator,
) -> None:
    """Add furniture for the small things to stand on where it lacks, then things of the category up to ``wanted``."""

    def total(placement: str) -> int:
        return sum(n for want, n in counts.items() if want.placement == placement)

    def room_on_top() -> int:
        return sum(holds.get(want.noun, 0) * n for want, n in counts.items()) - total("on_surface")

    turn = 0
    while room_on_top() < 0 or sum(counts.values()) < wanted:
        if room_on_top() < 0:
            placement = "against_wall"
        elif total("on_wall") < WALL_SHARE * wanted:
            placement = "on_wall"
        elif room_on_top() > 0 and turn % 3:
            placement = "on_surface"
        else:
            placement = "on_floor" if turn % 4 else "against_wall"
        want = Want(_any(generator, fillers[placement]), placement)
        counts[want] = counts.get(want, 0) + 1
        turn += 1


def _objects(
    data: dict[str, Any], kits: list[str], fillers: dict[str, list[str]], generator: np.random.Generator
) -> tuple[PlannedObject, ...]:
    """What stands in the room: the sets' things, in two finishes where there are many, filled up to what is wanted."""
    counts: dict[Want, int] = {}
    for kit in kits:
        for row in data["sets"][kit]:
            want = Want(row["noun"], row["placement"], row["relative_to"])
            counts[want] = counts.get(want, 0) + int(generator.integers(row["least"], row["most"] + 1))
    counts = _anchored(counts)
    _fill_up(counts, int(generator.integers(*OBJECTS_WANTED)), fillers, data["holds"], generator)
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
