"""The texts for other models: what an image model paints one view from, and a world model a whole place."""

from collections.abc import Iterable

from flymirage_core.scene.design import PlannedObject, SceneDesign, Zone
from flymirage_core.scene.inflection import article, capitalised, count, phrase, surface_words, things
from flymirage_core.scene.knowledge import nouns

MOST_IN_PICTURE = 9
"""Kinds of things that an image prompt names: those that take most of a view."""
MOST_IN_WORLD = 26
"""Kinds of things in one space that a world prompt names."""


def image_prompt(design: SceneDesign, place: str) -> str:
    """One wide view: what it is, its surfaces, its light, what takes most of the view; no people."""
    chosen = _weightiest(by_noun(in_zone(design, design.zones[0])), MOST_IN_PICTURE)
    whole = f"{design.style} {place}"
    return (
        f"Wide-angle photograph at eye level of {article(whole)} {whole}, {design.era}, "
        f"{surfaces_of(design.zones[0])}. {capitalised(design.light.words)}. "
        f"In view: {things(phrase(g) for g in chosen)[0]}. "
        "The whole space is visible from one end; natural colours, sharp focus throughout, level horizon, no people, "
        "no text overlays."
    )


def world_prompt(design: SceneDesign, place: str) -> str:
    """The whole place, zone by zone: its shape and size in metres, surfaces, light, everything in it."""
    x, y, z = design.zones[0].dimensions
    kind = design.zones[0].kind.replace("_", " ")
    space = f"{article(design.style)} {design.style} {place} ({kind}), {design.era}"
    height = "facades" if design.setting == "outdoor" else "ceiling"
    parts = [
        f"{capitalised(space)}: {count(x)} by {count(y)} metres, {height} {z:.1f} metres high, "
        f"{surfaces_of(design.zones[0])}. Light: {design.light.words}.",
        *(_contents(design, zone) for zone in design.zones),
        "Real scale, free space to move through the middle, no people, no animals.",
    ]
    return " ".join(parts)


def surfaces_of(zone: Zone) -> str:
    """As in "walls of cream plaster, a floor of light grey terrazzo, a ceiling of white plaster"."""
    names = {s.part: surface_words(s.colour, s.material) for s in zone.surfaces}
    order = [part for part in ("walls", "facades", "floor", "ground", "ceiling") if part in names]
    with_article = {
        "walls": "walls",
        "facades": "facades",
        "floor": "a floor",
        "ground": "ground",
        "ceiling": "a ceiling",
    }
    return ", ".join(f"{with_article[part]} of {names[part]}" for part in order)


def in_zone(design: SceneDesign, zone: Zone) -> list[PlannedObject]:
    """What a zone holds; things that name no zone are in the first."""
    return [o for o in design.objects if (o.zone or design.zones[0].name) == zone.name]


def by_noun(objects: Iterable[PlannedObject]) -> list[list[PlannedObject]]:
    """Groups of one noun and placement together, in order of appearance."""
    found: dict[tuple[str, str, str], list[PlannedObject]] = {}
    for one in objects:
        found.setdefault((one.noun, one.placement, one.relative_to), []).append(one)
    return list(found.values())


def _contents(design: SceneDesign, zone: Zone) -> str:
    groups = by_noun(in_zone(design, zone))
    if not groups:
        return ""
    where = f"Through a doorway, the {zone.name}" if zone is not design.zones[0] else "It"
    return f"{where} contains {things(phrase(g) for g in _weightiest(groups, MOST_IN_WORLD))[0]}."


def _weightiest(groups: list[list[PlannedObject]], number: int) -> list[list[PlannedObject]]:
    return sorted(groups, key=lambda g: -_weight(g))[:number]


def _weight(groups: list[PlannedObject]) -> float:
    """How much of a picture a kind of thing takes."""
    known = nouns().get(groups[0].noun)
    x, y, z = known.size if known else (0.5, 0.5, 0.5)
    return float((x + y) * z * min(sum(g.count for g in groups), 4) ** 0.5)
