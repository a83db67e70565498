"""What a prompt means, as a structure, and the resolver that reads it back against the boxes.

A `Meaning` is a list of terms that all hold of the object meant: noun, colour, shape, relation to landmarks, side of
the drone; at most one superlative picks among what the others leave. Wording is `wording.py`'s business.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.scene_relations import (
    Relation,
    Side,
    StartPose,
    Truth,
    at_least,
    at_most,
    between,
    on_side,
    outline_gap,
    related,
)

UNNAMED = "object"
"""The label of things for which nothing better is known; as a word it may mean anything."""

SYNONYMS = (
    frozenset({"sofa", "couch", "settee", "loveseat"}),
    frozenset({"armchair", "chair", "seat"}),
    frozenset({"stool", "ottoman", "pouf", "footstool"}),
    frozenset({"cabinet", "cupboard", "wardrobe", "closet", "armoire", "locker"}),
    frozenset({"bookshelf", "bookcase", "shelf", "shelves", "shelving", "rack"}),
    frozenset({"dresser", "drawers", "sideboard", "credenza"}),
    frozenset({"lamp", "light", "lantern"}),
    frozenset({"picture", "painting", "poster", "artwork", "photo"}),
    frozenset({"plant", "houseplant", "shrub", "bush"}),
    frozenset({"rug", "carpet", "mat"}),
    frozenset({"tv", "television", "monitor", "screen", "display"}),
    frozenset({"bin", "can", "basket", "bucket"}),
    frozenset({"box", "crate", "carton", "chest"}),
    frozenset({"pillow", "cushion"}),
    frozenset({"counter", "bar", "countertop"}),
)
"""Words that people use for one another: a prompt with one of them may be read as any of its set."""

VAGUE = {
    "table": {"desk", "counter", "workbench", "nightstand"},
    "seat": {"chair", "armchair", "stool", "pouf", "ottoman", "bench", "sofa"},
    "cabinet": {"bookshelf", "wardrobe", "sideboard", "dresser", "nightstand", "tv stand", "locker"},
    "container": {"box", "basket", "bin", "waste bin", "crate", "barrel", "suitcase"},
    "lamp": {"ceiling light", "light", "lantern"},
    "picture": {"poster", "painting", "mirror"},
    "appliance": {"printer", "microwave", "refrigerator", "machine"},
    "machine": {"printer", "gas cylinder"},
}
"""Family names: a thing called by one may be any of its kinds, and each of them may be called by it."""

CONFUSABLE_COLOURS = (
    frozenset({"white", "beige", "cream", "light grey"}),
    frozenset({"black", "dark grey", "dark brown", "dark blue"}),
    frozenset({"grey", "silver"}),
    frozenset({"brown", "light brown", "beige", "tan", "dark orange", "dark yellow", "olive"}),
    frozenset({"beige", "cream", "light orange", "light yellow"}),
    frozenset({"red", "pink", "dark pink", "light red"}),
    frozenset({"purple", "pink"}),
    frozenset({"red", "orange"}),
    frozenset({"orange", "yellow", "gold"}),
    frozenset({"blue", "purple"}),
    frozenset({"blue", "cyan", "turquoise", "teal"}),
    frozenset({"green", "teal", "turquoise", "olive"}),
)
"""Colour names that light and eye do not keep apart."""

SUPERLATIVE_MARGIN = (0.2, 0.3)
"""Share, and metres for distances, by which the winner must beat the next best."""


class Shape(Enum):
    """Proportions that one sees on a single object."""

    TALL = "tall"
    LOW = "low"
    LONG = "long"


class Superlative(Enum):
    LARGEST = "largest"
    SMALLEST = "smallest"
    TALLEST = "tallest"
    NEAREST = "nearest"  # to the drone at its start
    CLOSEST_TO = "closest to"  # a landmark


@dataclass(frozen=True)
class Noun:
    word: str


@dataclass(frozen=True)
class Colour:
    name: str


@dataclass(frozen=True)
class Shaped:
    shape: Shape


@dataclass(frozen=True)
class Located:
    """On a side of the drone at its start."""

    side: Side


@dataclass(frozen=True)
class Related:
    relation: Relation
    landmark: "Meaning"


@dataclass(frozen=True)
class Between:
    one: "Meaning"
    other: "Meaning"


@dataclass(frozen=True)
class Most:
    by: Superlative
    landmark: "Meaning | None" = None  # of CLOSEST_TO


Term = Noun | Colour | Shaped | Located | Related | Between | Most


@dataclass(frozen=True)
class Meaning:
    """The object of which all terms hold."""

    terms: tuple[Term, ...]


Predicate = Callable[[ObjectBox], Truth]


def resolve(meaning: Meaning, boxes: Iterable[ObjectBox], start: StartPose) -> frozenset[int]:
    """Ids of all objects that ``meaning`` may be read to mean, borderline cases included."""
    return frozenset(readings(meaning, tuple(boxes), start))


def picks(meaning: Meaning, boxes: Iterable[ObjectBox], start: StartPose, target_id: int) -> bool:
    """Whether ``meaning`` is certainly true of the target and certainly false of every other object."""
    return readings(meaning, tuple(boxes), start) == {target_id: Truth.YES}


def readings(meaning: Meaning, boxes: tuple[ObjectBox, ...], start: StartPose) -> dict[int, Truth]:
    """How ``meaning`` stands of each object of which it may be true."""
    truths = {box.object_id: (box, Truth.YES) for box in boxes}
    for term in sorted(meaning.terms, key=lambda t: isinstance(t, Most)):
        if isinstance(term, Most):
            truths = _superlative(term, truths, boxes, start)
            continue
        holds = _predicate(term, boxes, start)
        judged = ((box, min(truth, holds(box))) for box, truth in truths.values())
        truths = {box.object_id: (box, truth) for box, truth in judged if truth > Truth.NO}
    return {object_id: truth for object_id, (_, truth) in truths.items()}


def named(word: str, label: str) -> Truth:
    """Whether a thing with this label is meant by ``word``: certainly by its own label, maybe by kin of it.

    "chair" may mean an "office chair" and, labels being what they are, "office chair" may mean a "chair".
    """
    if word == label:
        return Truth.YES
    if word == UNNAMED or label.endswith(" " + word) or word.endswith(" " + label):
        return Truth.MAYBE
    head = label.split()[-1]
    if word in VAGUE.get(label, ()) or label in VAGUE.get(word, ()):
        return Truth.MAYBE
    return Truth.MAYBE if any(word in kin and (label in kin or head in kin) for kin in SYNONYMS) else Truth.NO


def coloured(name: str, seen: str) -> Truth:
    """Whether ``name`` describes a thing of the ``seen`` colour; an unmeasured colour may be any."""
    if name == seen:
        return Truth.YES
    if not seen:
        return Truth.MAYBE
    if any(name in kin and seen in kin for kin in CONFUSABLE_COLOURS):
        return Truth.MAYBE
    opposite = {name.split()[0], seen.split()[0]} == {"dark", "light"}
    return Truth.MAYBE if name.split()[-1] == seen.split()[-1] and not opposite else Truth.NO


def shaped(shape: Shape, box: ObjectBox) -> Truth:
    """From the proportions of the box: height, longer and shorter side."""
    longer, shorter, height = max(box.size[:2]), min(box.size[:2]), box.size[2]
    match shape:
        case Shape.TALL:
            return at_least(height / longer, (1.8, 1.3))
        case Shape.LOW:
            return min(at_most(height / longer, (0.45, 0.65)), at_most(height, (0.6, 0.8)))
        case Shape.LONG:
            return min(at_least(longer / shorter, (2.5, 1.8)), at_least(longer / height, (1.5, 1.1)))


def _predicate(
    term: Noun | Colour | Shaped | Located | Related | Between, boxes: tuple[ObjectBox, ...], start: StartPose
) -> Predicate:
    match term:
        case Noun(word):
            return lambda box: named(word, box.label)
        case Colour(name):
            return lambda box: coloured(name, box.colour)
        case Shaped(shape):
            return lambda box: shaped(shape, box)
        case Located(side):
            return lambda box: on_side(side, box, start)
        case Related(relation, landmark):
            marks = _landmarks(landmark, boxes, start)
            return lambda box: max(
                (min(truth, related(relation, box, mark, start)) for mark, truth in marks if mark is not box),
                default=Truth.NO,
            )
        case Between(one, other):
            ones, others = _landmarks(one, boxes, start), _landmarks(other, boxes, start)
            return lambda box: max(
                (
                    min(truth_a, truth_b, between(box, a, b))
                    for a, truth_a in ones
                    for b, truth_b in others
                    if a is not b and box is not a and box is not b
                ),
                default=Truth.NO,
            )


def _landmarks(meaning: Meaning, boxes: tuple[ObjectBox, ...], start: StartPose) -> list[tuple[ObjectBox, Truth]]:
    truths = readings(meaning, boxes, start)
    return [(box, truths[box.object_id]) for box in boxes if box.object_id in truths]


def _superlative(
    term: Most, truths: dict[int, tuple[ObjectBox, Truth]], boxes: tuple[ObjectBox, ...], start: StartPose
) -> dict[int, tuple[ObjectBox, Truth]]:
    """Those that may be the most: the best of all candidates, and whatever comes within the margin of it.

    Nothing is certain where there is nothing to compare, or where the landmark itself is in doubt.
    """
    doubtful = {object_id: (box, min(truth, Truth.MAYBE)) for object_id, (box, truth) in truths.items()}
    if term.landmark and len(readings(term.landmark, boxes, start)) != 1:
        return doubtful
    costs = {object_id: _cost(term, box, boxes, start) for object_id, (box, _) in truths.items()}
    if not costs:
        return {}
    best = min(costs.values())
    margin = SUPERLATIVE_MARGIN[1] if term.by in (Superlative.NEAREST, Superlative.CLOSEST_TO) else 0.0
    limit = best + abs(best) * SUPERLATIVE_MARGIN[0] + margin
    near = [object_id for object_id, cost in costs.items() if cost <= limit]
    chosen = truths if len(near) == 1 and len(costs) > 1 else doubtful
    return {object_id: chosen[object_id] for object_id in near}


def _cost(term: Most, box: ObjectBox, boxes: tuple[ObjectBox, ...], start: StartPose) -> float:
    """Less is more: metres, or minus metres (of height), or minus the cube root of the volume."""
    volume = float(np.cbrt(box.size[0] * box.size[1] * box.size[2]))
    match term.by:
        case Superlative.LARGEST:
            return -volume
        case Superlative.SMALLEST:
            return volume
        case Superlative.TALLEST:
            return -box.size[2]
        case Superlative.NEAREST:
            return start.range(box)
        case Superlative.CLOSEST_TO:
            marks = _landmarks(term.landmark, boxes, start) if term.landmark else []
            return min((outline_gap(box, mark) for mark, _ in marks if mark is not box), default=float("inf"))
