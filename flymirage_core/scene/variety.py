"""How various descriptions are: figures as the paper gives them for its scenes, and how often a sentence is re-used."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.inflection import count, plural

LISTED = re.compile(r"_(?:(?:,| and| of| in|, and) _| _)+")


@dataclass(frozen=True)
class Variety:
    """Of many descriptions."""

    scenes: int
    nouns: int
    labels: int  # distinct (colour, material, noun)
    coloured_nouns: int  # distinct (colour, noun)
    objects_least: int  # instances in the poorest scene
    objects_median: int
    objects_most: int
    same_objects: int  # scenes whose object multiset another scene has too
    frames: int  # distinct sentence frames
    widest_frame: str
    widest_share: float  # of scenes that the widest-spread frame occurs in
    category_spread: float  # largest relative distance of a category's scenes from the mean


def variety_of(descriptions: Sequence[SceneDescription]) -> Variety:
    """The figures of ``descriptions``; the category spread is over the categories that occur."""
    objects = [o for d in descriptions for o in d.objects]
    multisets = Counter(frozenset(multiset(d).items()) for d in descriptions)
    sizes = sorted(sum(o.count for o in d.objects) for d in descriptions)
    frames = Counter(f for d in descriptions for f in frames_of(d))
    widest, times = frames.most_common(1)[0]
    categories = Counter(d.category for d in descriptions)
    mean = len(descriptions) / len(categories)
    return Variety(
        scenes=len(descriptions),
        nouns=len({o.noun for o in objects}),
        labels=len({(o.colour, o.material, o.noun) for o in objects}),
        coloured_nouns=len({(o.colour, o.noun) for o in objects}),
        objects_least=sizes[0],
        objects_median=sizes[len(sizes) // 2],
        objects_most=sizes[-1],
        same_objects=sum(n for n in multisets.values() if n > 1),
        frames=len(frames),
        widest_frame=widest,
        widest_share=times / len(descriptions),
        category_spread=max(abs(n - mean) / mean for n in categories.values()),
    )


def multiset(description: SceneDescription) -> Counter[tuple[str, str, str]]:
    """(noun, colour, material) -> how many pieces."""
    counts: Counter[tuple[str, str, str]] = Counter()
    for o in description.objects:
        counts[o.noun, o.colour, o.material] += o.count
    return counts


def frames_of(description: SceneDescription) -> set[str]:
    """The sentences of the prose without their facts: every noun, colour, number... and every list of them is a "_"."""
    text = _masked(description.prose, _facts(description))
    return {LISTED.sub("_", s).strip().lower() for s in re.split(r"(?<=\.) ", text) if s.strip()}


def _masked(text: str, facts: Iterable[str]) -> str:
    words = sorted({f for f in facts if f}, key=len, reverse=True)
    pattern = r"(?:\b(?:an?|the) )?(?:\b(?:" + "|".join(map(re.escape, words)) + r")\b[ ]?)+"
    return re.sub(pattern, lambda m: "_ " if m[0].endswith(" ") else "_", text, flags=re.IGNORECASE)


def _facts(d: SceneDescription) -> Iterable[str]:
    light = d.light
    yield from (d.subcategory, d.style, d.era, light.words, light.time_of_day, *map(count, range(100)))
    for zone in d.zones:
        yield zone.name
        for s in zone.surfaces:
            yield from (s.material, s.material + "s", *s.colour.split(), *s.material.split())
    for o in d.objects:
        yield from (o.noun, plural(o.noun), o.state, *o.colour.split(), o.material, *o.material.split())
        if o.size != "medium":
            yield o.size
        if " of " in o.noun:
            yield from (o.noun.split(" of ")[0], plural(o.noun.split(" of ")[0]), o.noun.split(" of ")[1])
