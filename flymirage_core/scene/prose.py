"""A design's facts as a paragraph for people: short sentences, each from a grammar with many frames."""

from collections.abc import Sequence

import numpy as np

from flymirage_core.scene.design import Light, PlannedObject, SceneDesign, Zone
from flymirage_core.scene.furnish import pick
from flymirage_core.scene.grammar import sentence
from flymirage_core.scene.inflection import count, phrase, plural, surface_words, things
from flymirage_core.scene.prompts import by_noun, in_zone

SENTENCES = (7, 11)
"""Of a paragraph, those about things."""
MOST_THINGS = 3
"""Kinds of things in one sentence."""
LIGHT_PLURALS = ("patches", "pools", "bands", "rows", "lamps", "shadows")
WALLS_OF = {"street": "facades", "courtyard": "facades", "yard": "walls", "rooftop": "parapets"}
NOTE_SHARE = 0.8
ANCHORED = ("around", "facing", "beside", "on_surface")
LAST = ("on_wall", "hanging", "on_any")
FIRST = ("against_wall", "on_floor", "in_row")

Groups = list[PlannedObject]
Key = tuple[str, str, int]


def prose_of(design: SceneDesign, place: str, notes: Sequence[str], generator: np.random.Generator) -> str:
    """The place, its surfaces and light, something said of such places, then what is where."""
    about = [_opening(design, place, generator)]
    facts = [_surfaces(design, generator), _light(design, generator)]
    if notes and generator.uniform() < NOTE_SHARE:
        facts.append(str(pick(generator, notes)))
    about += [facts[int(i)] for i in generator.permutation(len(facts))]
    return " ".join(about + _objects(design, generator))


def _opening(design: SceneDesign, place: str, generator: np.random.Generator) -> str:
    x, y, _ = design.zones[0].dimensions
    slots = {"style": design.style, "place": place, "era": design.era, "x": count(x), "y": count(y)}
    return sentence("opening", slots, False, generator)


def _surfaces(design: SceneDesign, generator: np.random.Generator) -> str:
    slots = {str(s.part): surface_words(s.colour, s.material) for s in design.zones[0].surfaces}
    slots["z"] = count(design.zones[0].dimensions[2])
    return sentence(f"surfaces_{design.setting}", slots, False, generator)


def _light(design: SceneDesign, generator: np.random.Generator) -> str:
    words = design.light.words
    many = " and " in words or any(word in words.split(" ", 4)[:3] for word in LIGHT_PLURALS)
    return sentence(
        "light", {"light": words, "time": design.light.time_of_day, "when": when(design.light)}, many, generator
    )


def when(light: Light) -> str:
    """ "in the morning", "at dusk" """
    return f"{'in the' if light.time_of_day in ('morning', 'afternoon') else 'at'} {light.time_of_day}"


def _objects(design: SceneDesign, generator: np.random.Generator) -> list[str]:
    """Sentences about a seeded choice of things: what stands, what is on and round it, then walls and air."""
    main, *others = design.zones
    sentences: list[str] = []
    clusters = _clusters(in_zone(design, main), generator)
    for key in _order(list(clusters), generator):
        sentences.append(_about(key, clusters[key], main, design, generator))
    for zone in others:
        groups = by_noun(o for o in in_zone(design, zone) if not o.relative_to)[:MOST_THINGS]
        if groups:
            said, many = things(phrase(g) for g in groups)
            sentences.append(sentence("side", {"side": f"the {zone.name}", "things": said}, many, generator))
    return sentences


def _clusters(objects: Sequence[PlannedObject], generator: np.random.Generator) -> dict[Key, list[Groups]]:
    """(rule, anchor, number) -> the kinds of things that one sentence speaks of."""
    by_rule: dict[tuple[str, str], list[Groups]] = {}
    for groups in by_noun(objects):
        first = groups[0]
        rule: str = "on_any" if first.placement == "on_surface" and not first.relative_to else first.placement
        by_rule.setdefault((rule, first.relative_to if rule in ANCHORED else ""), []).append(groups)
    clusters: dict[Key, list[Groups]] = {}
    for (rule, anchor), found in by_rule.items():
        shuffled = [found[int(i)] for i in generator.permutation(len(found))]
        number = 0
        while shuffled:
            size = int(generator.integers(1, MOST_THINGS + 1))
            clusters[rule, anchor, number] = shuffled[:size]
            shuffled, number = shuffled[size:], number + 1
    return clusters


def _order(keys: list[Key], generator: np.random.Generator) -> list[Key]:
    """The first of every rule before the second of any; big things, then what relates to them, then what is above."""
    rank = dict.fromkeys(FIRST, 0) | dict.fromkeys(LAST, 2)
    turn: dict[str, int] = {}
    turns = []
    for key in (keys[int(i)] for i in generator.permutation(len(keys))):
        turns.append((turn.setdefault(key[0], 0), key))
        turn[key[0]] += 1
    chosen = [key for _, key in sorted(turns, key=lambda t: t[0])][: int(generator.integers(*SENTENCES))]
    return sorted(chosen, key=lambda key: rank.get(key[0], 1))


def _about(key: Key, clusters: list[Groups], zone: Zone, design: SceneDesign, generator: np.random.Generator) -> str:
    rule, anchor, _ = key
    said, many = things(phrase(g) for g in clusters)
    number = sum(o.count for o in design.objects if o.noun == anchor)
    slots = {
        "things": said,
        "anchor": plural(anchor) if number > 1 else anchor,
        "walls_word": WALLS_OF.get(zone.kind, "walls"),
        "ground_word": "ground" if design.setting == "outdoor" else "floor",
    }
    return sentence(rule, slots, many, generator)
