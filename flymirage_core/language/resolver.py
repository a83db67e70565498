"""The resolver: reads a meaning against the boxes, as seen from where the drone starts.

Every statement is judged YES, MAYBE or NO (`Truth`), so that a prompt counts only if it is certainly true of its target
and certainly false of everything else.
"""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.looks import coloured, made_of, shaped
from flymirage_core.language.meaning import (
    Between,
    Colour,
    Located,
    Material,
    Meaning,
    Most,
    Nameless,
    Noun,
    Placed,
    Related,
    Shaped,
    Size,
    Sized,
    Superlative,
    Term,
    egocentric,
)
from flymirage_core.language.nouns import is_generic, named
from flymirage_core.language.scene_relations import StartPose, Truth, at_level, between, on_side, outline_gap, related

Truths = NDArray[np.int8]
Measure = Callable[[ObjectBox], float]

SUPERLATIVE_MARGIN = 0.2
"""Share of the winner's measure by which it must beat the next best ..."""
DISTANCE_MARGIN = 0.3
"""... and metres on top, where distances and heights are compared ..."""
BEARING_MARGIN = np.radians(7.0)
"""... or, from left to right, the angle between two neighbours."""
FRONT = (np.radians(60.0), np.radians(90.0))
"""Bearings within which a thing is among those that have a left and a right one: certainly, and possibly."""
CONTRAST = 1.4
"""Ratio of mean edge lengths from which on two things of a kind are a large and a small one."""


class Resolver:
    """All objects of a scene, and the pose from which "left", "nearest" and "behind" are meant.

    What a term is true of is worked out once; `seen_from` shares it, as far as it does not depend on the pose.
    """

    def __init__(self, boxes: Iterable[ObjectBox], start: StartPose) -> None:
        self.boxes, self.start = tuple(boxes), start
        self._anywhere = dict[Term, NDArray[Any]]()
        self._from_here = dict[Term, NDArray[Any]]()
        self._edges = np.array([_mean_edge(box) for box in self.boxes])  # (N,)
        self._bearings = np.array([start.bearing(box) for box in self.boxes])  # (N,)

    def seen_from(self, start: StartPose) -> "Resolver":
        """The same objects from another pose."""
        other = Resolver(self.boxes, start)
        other._anywhere = self._anywhere
        return other

    def picks(self, meaning: Meaning, object_id: int) -> bool:
        """Whether ``meaning`` is certainly true of this object and certainly false of every other."""
        return self.readings(meaning) == {object_id: Truth.YES}

    def readings(self, meaning: Meaning) -> dict[int, Truth]:
        """How ``meaning`` stands of each object, by object id, of which it may be true."""
        truths = self.truths(meaning)
        return {self.boxes[i].object_id: Truth(truths[i]) for i in np.flatnonzero(truths).tolist()}

    def truths(self, meaning: Meaning) -> Truths:
        """How ``meaning`` stands of each object (N,), in the boxes' order."""
        truths = np.full(len(self.boxes), Truth.YES, np.int8)
        for term in meaning.terms:
            if not isinstance(term, Sized | Most):
                truths = np.minimum(truths, self.term_truths(term))
        for choice in meaning.terms:
            if isinstance(choice, Sized):
                truths = self._contrasted(choice, truths)
        for choice in meaning.terms:
            if isinstance(choice, Most):
                truths = self._superlative(choice, truths)
        return truths

    def term_truths(self, term: Term) -> Truths:
        """How one term, no superlative, stands of each object (N,)."""
        return self._remembered(term, lambda: self.judge(term), np.int8)

    def _remembered(self, term: Term, measure: Callable[[], Measure], dtype: type) -> NDArray[Any]:
        known = self._from_here if egocentric(term) else self._anywhere
        if term not in known:
            of = measure()
            known[term] = np.array([of(box) for box in self.boxes], dtype)
        return known[term]

    def judge(self, term: Term) -> Callable[[ObjectBox], Truth]:
        """How one term, no superlative, stands of an object."""
        match term:
            case Noun(word):
                return lambda box: named(word, box.label)
            case Nameless():
                return lambda box: Truth.MAYBE if is_generic(box.label) else Truth.NO
            case Colour(name):
                return lambda box: coloured(name, box.colour)
            case Material(name):
                return lambda box: made_of(name, box.material)
            case Shaped(shape):
                return lambda box: shaped(shape, box)
            case Located(side):
                return lambda box: on_side(side, box, self.start)
            case Placed(level):
                return lambda box: at_level(level, box, self.boxes)
            case Related(relation, landmark):
                marks = self._marks(landmark)
                return lambda box: max(
                    (min(t, related(relation, box, mark, self.start)) for mark, t in marks if mark is not box),
                    default=Truth.NO,
                )
            case Between(one, other):
                ones, others = self._marks(one), self._marks(other)
                return lambda box: max(
                    (
                        min(truth_a, truth_b, between(box, a, b))
                        for a, truth_a in ones
                        for b, truth_b in others
                        if a is not b and box is not a and box is not b
                    ),
                    default=Truth.NO,
                )
        raise AssertionError(f"{term} compares objects; it does not hold of one")

    def _marks(self, landmark: Meaning) -> list[tuple[ObjectBox, Truth]]:
        """What the landmark may be."""
        truths = self.truths(landmark)
        return [(self.boxes[i], Truth(truths[i])) for i in np.flatnonzero(truths).tolist()]

    def _contrasted(self, term: Sized, truths: Truths) -> Truths:
        """Of several candidates those that are clearly the large (or small) one; a single one is neither, but meant."""
        candidates = np.flatnonzero(truths)
        if len(candidates) < 2:
            return truths
        edges = self._edges[candidates]
        costs = 1 / edges if term.size is Size.LARGE else edges
        possible = costs <= costs.min() * CONTRAST
        return _chosen(truths, candidates[possible], bool(possible.sum() == 1))

    def _superlative(self, term: Most, truths: Truths) -> Truths:
        """Those that may be the most: the one of that rank among the candidates, and whatever comes near it.

        Nothing is certain where there is nothing to compare, or where the landmark itself is in doubt.
        """
        candidates, certain = self._compared(term, truths)
        if len(candidates) < term.rank:
            return np.zeros_like(truths)
        measure = Most(term.by, term.landmark)
        costs = self._remembered(measure, lambda: self._measure(measure), float)[candidates]
        ranked = float(np.sort(costs)[term.rank - 1])
        with np.errstate(invalid="ignore"):  # nothing to be close to: infinitely far
            near = np.abs(costs - ranked) <= _margin(term.by, ranked)
        if term.rank > 1:  # whoever may not be a candidate at all shifts the count
            certain = certain and bool((truths[candidates[costs <= ranked]] == Truth.YES).all())
        return _chosen(truths, candidates[near], certain and bool(near.sum() == 1) and len(candidates) > 1)

    def _compared(self, term: Most, truths: Truths) -> tuple[NDArray[np.intp], bool]:
        """Indices of what is compared, and whether that, and what they are compared by, is beyond doubt."""
        candidates = np.flatnonzero(truths)
        if term.by is Superlative.CLOSEST_TO:
            return candidates, term.landmark is not None and bool(np.count_nonzero(self.truths(term.landmark)) == 1)
        if term.by in (Superlative.LEFTMOST, Superlative.RIGHTMOST):
            bearings = np.abs(self._bearings[candidates])
            inside = bearings <= FRONT[1]
            return candidates[inside], bool((bearings[inside] <= FRONT[0]).all())
        return candidates, True

    def _measure(self, term: Most) -> Measure:
        """Less is more: metres, or minus metres, or radians from the left."""
        match term.by:
            case Superlative.LARGEST:
                return lambda box: -_mean_edge(box)
            case Superlative.SMALLEST:
                return _mean_edge
            case Superlative.TALLEST:
                return lambda box: -box.size[2]
            case Superlative.SHORTEST:
                return lambda box: box.size[2]
            case Superlative.LONGEST:
                return lambda box: -max(box.size[:2])
            case Superlative.HIGHEST:
                return lambda box: -box.centre[2]
            case Superlative.LOWEST:
                return lambda box: box.centre[2]
            case Superlative.NEAREST:
                return self.start.range
            case Superlative.FARTHEST:
                return lambda box: -self.start.range(box)
            case Superlative.LEFTMOST:
                return lambda box: -self.start.bearing(box)
            case Superlative.RIGHTMOST:
                return self.start.bearing
            case Superlative.CLOSEST_TO:
                marks = self._marks(term.landmark) if term.landmark else []
                return lambda box: min(
                    (outline_gap(box, mark) for mark, _ in marks if mark is not box), default=float("inf")
                )


_BY_METRES = (Superlative.NEAREST, Superlative.FARTHEST, Superlative.CLOSEST_TO)


def _margin(by: Superlative, cost: float) -> float:
    if by in (Superlative.LEFTMOST, Superlative.RIGHTMOST):
        return float(BEARING_MARGIN)
    if by in (Superlative.HIGHEST, Superlative.LOWEST):
        return DISTANCE_MARGIN
    return abs(cost) * SUPERLATIVE_MARGIN + (DISTANCE_MARGIN if by in _BY_METRES else 0.0)


def _chosen(truths: Truths, indices: NDArray[np.intp], certain: bool) -> Truths:
    """``truths`` where chosen, at most MAYBE if the choice is in doubt, and NO elsewhere."""
    chosen = np.zeros_like(truths)
    chosen[indices] = truths[indices] if certain else np.minimum(truths[indices], Truth.MAYBE)
    return chosen


def _mean_edge(box: ObjectBox) -> float:
    return float(np.cbrt(box.size[0] * box.size[1] * box.size[2]))
