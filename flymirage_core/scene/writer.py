"""Who writes scene descriptions: the port that an LLM fills, and its offline twin, which composes them from data."""

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import Light, PlannedObject, SceneDesign, Size, Surface, Zone
from flymirage_core.scene.furnish import fill_zone, in_finishes, pick
from flymirage_core.scene.inflection import capitalised
from flymirage_core.scene.keys import check_scene_key, rng
from flymirage_core.scene.knowledge import Look, Place, Range, eras_of, lights, looks, places
from flymirage_core.scene.prompts import image_prompt, world_prompt
from flymirage_core.scene.prose import prose_of, when
from flymirage_core.scene.taxonomy import STANDARD, Taxonomy, standard_taxonomy

NAME = "offline 2"
OBJECTS_WANTED = (76, 100)
"""How many objects a description asks for; the paper's scenes have 60 to 100, and not all may find a place."""
SIDE_OBJECTS = 14
"""Of them, in a side space."""
ACCENTS = (
    "navy", "teal", "mustard", "rust", "forest green", "burgundy", "sage", "terracotta", "charcoal", "powder blue",
    "plum", "ochre", "olive", "denim blue", "coral", "white", "black", "sky blue", "orange", "honey brown", "brass",
)  # fmt: skip
TITLES = ("{style} {place}", "{place}, {era}", "{style} {place}, {era}", "{place} {when}", "{style} {place}, {time}")


class SceneWriter(Protocol):
    """Describes the scene of a key: what kind of place, and what is in it (paper section III-A).

    ``place`` is (category, subcategory) where growth chose it for balance; else the writer picks by the key.
    """

    name: str

    def describe(self, scene_key: str, place: tuple[str, str] | None = None) -> SceneDescription: ...


class OfflineSceneWriter:
    """Composes descriptions from the taxonomy and what is known of places: same key and counts, same description."""

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
        known = _known_place(category, subcategory, self.taxonomy, generator)
        return SceneDescription(
            **dict(_design(subcategory, known, generator)),
            scene=scene_key,
            category=category,
            subcategory=subcategory,
            provenance=Provenance(kind="generated", writer=NAME),
        )


def _known_place(category: str, subcategory: str, taxonomy: Taxonomy, generator: np.random.Generator) -> Place:
    """What is known of a subcategory; of one of the user's own, what it is like, else one of its category, else any.

    What is said of the stand-in (its notes) is not said of the user's.
    """
    found = places().get(subcategory)
    if found:
        return found
    standard = [c for name in STANDARD for c in standard_taxonomy(name).categories if c.name == category]
    candidates = [s for c in standard for s in c.subcategories] or list(places())
    like = taxonomy.like.get(subcategory, "")
    stand_in = like if like in places() else str(pick(generator, candidates))
    return places()[stand_in].model_copy(update={"notes": ()})


def _design(subcategory: str, known: Place, generator: np.random.Generator) -> SceneDesign:
    look = looks()[known.look]
    style = str(pick(generator, look.styles))
    era = str(pick(generator, eras_of(style, look)))
    light = _light(known, generator)
    zones = _zones(subcategory, known, look, light, generator)
    surfaces = [s.colour for s in zones[0].surfaces]
    accents = [str(c) for c in generator.permutation(list(ACCENTS))[: int(generator.integers(3, 5))]]
    palette = tuple(dict.fromkeys([surfaces[1], surfaces[0], *accents]))
    objects = _objects(known, zones, palette, generator)
    title = str(pick(generator, TITLES)).format(
        style=style, place=subcategory, era=era, time=light.time_of_day, when=when(light)
    )
    design = SceneDesign(
        title=capitalised(title),
        setting="outdoor" if known.outdoor else "indoor",
        dimensions=_overall(zones),
        zones=zones,
        style=style,
        era=era,
        palette=palette,
        light=light,
        objects=objects,
        prose="",
        image_prompt="",
        world_prompt="",
    )
    texts = {
        "prose": prose_of(design, subcategory, known.notes, generator),
        "image_prompt": image_prompt(design, subcategory),
        "world_prompt": world_prompt(design, subcategory),
    }
    return design.model_copy(update=texts)


def _light(known: Place, generator: np.random.Generator) -> Light:
    profile = lights()[str(pick(generator, known.light))]
    time, sky = pick(generator, profile.times), str(pick(generator, profile.skies))
    words = str(pick(generator, profile.words)).format(time=time, sky="grey" if sky == "overcast" else "clear")
    return Light(time_of_day=time, sky=sky, sources=profile.sources, words=words)  # type: ignore[arg-type]


def _zones(name: str, known: Place, look: Look, light: Light, generator: np.random.Generator) -> tuple[Zone, ...]:
    surfaces = tuple(
        Surface(part=part, colour=str(pick(generator, choices[material])), material=material)
        for part, choices in look.surfaces.items()
        for material in [str(pick(generator, list(choices)))]
    )
    windows = _windows(known, light, generator)
    side = known.side
    main = Zone(
        name=name,
        kind=known.kind,
        dimensions=_size(known.range, generator),
        surfaces=surfaces,
        connects_to=(side.name,) if side else (),
        windows=windows,
    )
    if side is None:
        return (main,)
    small = _size(side.range, generator)
    return main, main.model_copy(
        update={"name": side.name, "kind": side.kind, "dimensions": small, "connects_to": (name,), "windows": 0}
    )


def _windows(known: Place, light: Light, generator: np.random.Generator) -> int:
    """Facades of streets and courtyards have many; rooms have some if their light comes through them."""
    least, most = {"street": (10, 24), "courtyard": (10, 20), "yard": (3, 8), "rooftop": (0, 3)}.get(known.kind, (2, 6))
    wanted = int(generator.integers(least, most + 1))
    return wanted if known.outdoor or "windows" in light.sources else 0


def _size(ranges: Sequence[Range], generator: np.random.Generator) -> Size:
    x, y, z = (round(float(generator.uniform(a, b)), 1) for a, b in ranges)
    return x, y, z


def _overall(zones: tuple[Zone, ...]) -> Size:
    """Of zones side by side along x."""
    x = round(sum(z.dimensions[0] for z in zones), 1)
    return x, max(z.dimensions[1] for z in zones), max(z.dimensions[2] for z in zones)


def _objects(
    known: Place, zones: tuple[Zone, ...], palette: tuple[str, ...], generator: np.random.Generator
) -> tuple[PlannedObject, ...]:
    wanted, aged = int(generator.integers(*OBJECTS_WANTED)), looks()[known.look].aged
    objects: list[PlannedObject] = []
    if known.side:
        counts = fill_zone(zones[1], known.side.kits, (), known.fillers, SIDE_OBJECTS, generator)
        objects = in_finishes(counts, zones[1].name, palette, aged, generator)
        wanted -= sum(o.count for o in objects)
    counts = fill_zone(zones[0], known.kits, known.options, known.fillers, wanted, generator)
    return (*in_finishes(counts, zones[0].name, palette, aged, generator), *objects)
