"""Who writes the instructions: the port `Prompter`, and `OfflinePrompter`, which refuses whatever is ambiguous."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, islice
from typing import Protocol

import numpy as np

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.language.prompts import Prompt, PromptKind, Prompts
from flymirage_core.language.referring import (
    UNNAMED,
    Between,
    Colour,
    Located,
    Meaning,
    Most,
    Noun,
    Related,
    Shape,
    Shaped,
    Superlative,
    Term,
    picks,
    readings,
    shaped,
)
from flymirage_core.language.scene_relations import Relation, Side, StartPose, Truth, on_side, outline_gap, related
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.language.wording import Landmarks, sentence
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.rendering.frames import Frames
from flymirage_core.scene.keys import rng

NEAREST_LANDMARKS = 8
"""How many landmarks are tried for a target, most sensible first."""
LANDMARK_REACH = 2.5
"""Metres between outlines beyond which nothing is a landmark."""
LEAST_LANDMARK = 0.3
"""Metres: a thing whose longest side is shorter is too small to steer by."""
VARIETY = 3
"""Among this many best unambiguous phrases one is drawn, so that not all prompts use the same relation."""


class Prompter(Protocol):
    """Writes up to three instructions for each kept flight (section III-C); all are read back before they count."""

    @property
    def name(self) -> str: ...

    def write(
        self, scene: str, frames: Frames, boxes: BoxMap, flights: Trajectories, verdicts: QualityVerdicts
    ) -> Prompts: ...


@dataclass(frozen=True)
class OfflinePrompter:
    """Referring expressions from boxes: nouns, seen colours, proportions and relations; no model is asked.

    A prompt is written only if the resolver, reading its meaning back against all boxes, finds it certainly true of
    the target and certainly false of everything else; otherwise it is refined, and at last refused.
    """

    name: str = "offline 1"

    def write(
        self, scene: str, frames: Frames, boxes: BoxMap, flights: Trajectories, verdicts: QualityVerdicts
    ) -> Prompts:
        """Prompts in the order of flights, then kinds; a kept flight of which nothing sure can be said has none."""
        kept = set(verdicts.kept)
        written: list[Prompt] = []
        for flight in (f for f in flights if f.flight_id in kept):
            start = StartPose.of_flight(flight)
            written += self._flight_prompts(scene, flight, boxes, start)
        return Prompts(tuple(written))

    def _flight_prompts(self, scene: str, flight: Flight, boxes: BoxMap, start: StartPose) -> list[Prompt]:
        generator = rng(scene, "prompts", flight.flight_id)
        said: dict[frozenset[Term], Prompt] = {}
        for kind, meaning in expressions(boxes, flight.object_id, start, generator):
            if frozenset(meaning.terms) not in said:
                text = sentence(kind, meaning, _unique_landmarks(meaning, boxes, start), generator)
                said[frozenset(meaning.terms)] = Prompt(flight.flight_id, kind, text, self.name)
        return list(said.values())


def expressions(
    boxes: BoxMap, target_id: int, start: StartPose, generator: np.random.Generator
) -> Iterator[tuple[PromptKind, Meaning]]:
    """At most one unambiguous meaning for each kind of prompt, in the paper's order."""
    target = boxes.by_id(target_id)
    object_centred = _first(_object_centred(target, start), boxes, start, target, 1)
    if object_centred:
        yield "object_centred", object_centred[0]
    related_phrases = _first(_relative(target, boxes, start), boxes, start, target, VARIETY)
    if related_phrases:
        yield "relative", related_phrases[int(generator.integers(len(related_phrases)))]
    appearance = _first(_appearance(target, start), boxes, start, target, 1)
    if appearance:
        yield "appearance", appearance[0]


def _first(
    candidates: Iterator[Meaning], boxes: BoxMap, start: StartPose, target: ObjectBox, count: int
) -> list[Meaning]:
    """The first ``count`` candidates that the resolver reads as the target and nothing else."""
    return list(islice((m for m in candidates if picks(m, boxes, start, target.object_id)), count))


def _object_centred(target: ObjectBox, start: StartPose) -> Iterator[Meaning]:
    """The bare noun, then the noun refined by size or by where the drone sees it; nothing for a thing without name."""
    if target.label == UNNAMED:
        return
    noun = Noun(target.label)
    yield Meaning((noun,))
    for by in (Superlative.LARGEST, Superlative.TALLEST, Superlative.SMALLEST):
        yield Meaning((Most(by), noun))
    for side in _sides(target, start):
        yield Meaning((noun, Located(side)))
    yield Meaning((Most(Superlative.NEAREST), noun))


def _relative(target: ObjectBox, boxes: BoxMap, start: StartPose) -> Iterator[Meaning]:
    """The noun with a relation to the most sensible landmarks; refined by colour, closeness and side."""
    landmarks = _landmarks(target, boxes, start)
    core: tuple[Term, ...] = (Noun(target.label),)
    coloured: tuple[Term, ...] = (*core, Colour(target.colour)) if target.colour else core
    places = list(_places(target, landmarks, boxes, start))
    for terms in dict.fromkeys((core, coloured)):
        yield from (Meaning((*terms, place)) for place in places)
    for terms in dict.fromkeys((core, coloured)):
        yield from (Meaning((*terms, Most(Superlative.CLOSEST_TO, m))) for m, _ in landmarks)
    for side in _sides(target, start):
        yield from (Meaning((*coloured, place, Located(side))) for place in places)


def _places(
    target: ObjectBox, landmarks: list[tuple[Meaning, ObjectBox]], boxes: BoxMap, start: StartPose
) -> Iterator[Term]:
    """True relations of the target to its landmarks: those that hold from everywhere before those of the start."""
    fixed = [r for r in Relation if r not in _SEEN_FROM_START]
    for relation in (*fixed, *_SEEN_FROM_START):
        for meaning, landmark in landmarks:
            if related(relation, target, landmark, start) is Truth.YES:
                yield Related(relation, meaning)
        if relation is Relation.BELOW:
            sure = [m for m, landmark in landmarks if picks(m, boxes, start, landmark.object_id)]
            yield from (Between(one, other) for one, other in combinations(sure[:5], 2))


_SEEN_FROM_START = (Relation.IN_FRONT_OF, Relation.BEHIND, Relation.LEFT_OF, Relation.RIGHT_OF)


def _appearance(target: ObjectBox, start: StartPose) -> Iterator[Meaning]:
    """Colour, proportions, then size among its like; always something seen on the thing, at last with its side too."""
    noun = Noun(target.label)
    colours: list[tuple[Term, ...]] = [(Colour(target.colour),)] if target.colour else []
    shapes: list[tuple[Term, ...]] = [(Shaped(s),) for s in Shape if shaped(s, target) is Truth.YES]
    sizes: list[tuple[Term, ...]] = [
        (Most(s),) for s in (Superlative.LARGEST, Superlative.TALLEST, Superlative.SMALLEST)
    ]
    looks = [*colours, *(s + c for s in shapes for c in colours), *shapes, *(s + c for s in sizes for c in colours)]
    if target.label != UNNAMED:
        looks += sizes
    yield from (Meaning((*look, noun)) for look in looks)
    if target.colour:
        yield from (Meaning((*colours[0], noun, Located(side))) for side in _sides(target, start))
        yield Meaning((Most(Superlative.NEAREST), *colours[0], noun))


def _sides(target: ObjectBox, start: StartPose) -> list[Side]:
    return [side for side in Side if on_side(side, target, start) is Truth.YES]


def _landmarks(target: ObjectBox, boxes: BoxMap, start: StartPose) -> list[tuple[Meaning, ObjectBox]]:
    """Named things of another kind that are near and big enough, most sensible first, by the shortest sure phrase.

    A landmark that its noun does not single out gets its colour; failing that it is "a" such thing.
    """
    near = []
    for box in boxes:
        gap = outline_gap(box, target)
        if box is target or box.label in (UNNAMED, target.label) or gap > LANDMARK_REACH:
            continue
        if max(box.size) >= LEAST_LANDMARK:
            near.append((gap + 0.5 / max(box.size), box.object_id, box))
    near.sort(key=lambda entry: entry[:2])
    return [(_landmark_phrase(box, boxes, start), box) for _, _, box in near[:NEAREST_LANDMARKS]]


def _landmark_phrase(box: ObjectBox, boxes: BoxMap, start: StartPose) -> Meaning:
    plain = Meaning((Noun(box.label),))
    coloured = Meaning((Noun(box.label), Colour(box.colour)))
    if box.colour and not picks(plain, boxes, start, box.object_id) and picks(coloured, boxes, start, box.object_id):
        return coloured
    return plain


def _unique_landmarks(meaning: Meaning, boxes: BoxMap, start: StartPose) -> Landmarks:
    """The landmarks in ``meaning`` that are one thing only, and so take "the"."""
    inner: list[Meaning] = []
    for term in meaning.terms:
        match term:
            case Related(_, landmark) | Most(_, landmark) if landmark:
                inner.append(landmark)
            case Between(one, other):
                inner += [one, other]
    return Landmarks(frozenset(m for m in inner if len(readings(m, tuple(boxes), start)) == 1))
