"""Referring expressions: the shortest meanings of each kind that certainly pick the target and nothing else.

Candidates are tried from the plainest to the most laboured; the resolver decides. After R. Dale and E. Reiter,
"Computational interpretations of the Gricean maxims in the generation of referring expressions", Cognitive Science
19 (1995).
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, islice, product

import numpy as np

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.looks import HEIGHTS, shaped
from flymirage_core.language.meaning import (
    UNNAMED,
    Between,
    Colour,
    Located,
    Material,
    Meaning,
    Most,
    Noun,
    Placed,
    Related,
    Shape,
    Shaped,
    Size,
    Sized,
    Superlative,
    Term,
    egocentric,
)
from flymirage_core.language.nouns import is_generic
from flymirage_core.language.prompts import PromptKind
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import Level, Relation, Side, Truth, outline_gap

NEAREST_LANDMARKS = 8
"""How many landmarks are tried for a target, most sensible first."""
LANDMARK_REACH = 2.5
"""Metres between outlines beyond which nothing is a landmark."""
LEAST_LANDMARK = 0.3
"""Metres: a thing whose longest side is shorter is too small to steer by."""
NAMELESS_COST = 1.5
"""Metres by which a landmark without a name must be nearer to be preferred."""
UNSURE_COST = 1.5
"""Metres for a label of no certainty at all: what may not be a pump is a poor thing to steer by."""
MANY_COLOURED = ("painting", "poster", "picture", "mirror", "window", "tapestry", "bookshelf", "bookcase")
"""Head nouns of things whose one measured colour is a mean of many, or of what they reflect."""
VARIETY = 3
"""Among this many best unambiguous phrases one is drawn, so that not all prompts use the same relation."""
MOST_TRIED = 3000
"""Candidates of one kind, after which nothing better is hoped for."""
SEVERAL = 2
"""Fewer prompts than this are filled up with a second one of a kind."""

BY_SIZE = (
    Superlative.LARGEST,
    Superlative.TALLEST,
    Superlative.SMALLEST,
    Superlative.LONGEST,
    Superlative.SHORTEST,
    Superlative.HIGHEST,
    Superlative.LOWEST,
)
LONGISH = 1.5
"""Ratio of longer side to height from which on a thing has a length to speak of."""
TELLING_SHAPES = (Shape.TALL, Shape.LOW, Shape.LONG)
"""Of things with a name: every picture is thin, and hardly anybody calls an armchair boxy."""
FIRSTS: Sequence[Term] = [
    Most(by) for by in (Superlative.NEAREST, Superlative.FARTHEST, Superlative.LEFTMOST, Superlative.RIGHTMOST)
]
"""From the drone; of what is on one side of it, only the first two are said."""
COUNTED: Sequence[Term] = [
    Most(by, rank=n) for by in (Superlative.NEAREST, Superlative.LEFTMOST, Superlative.RIGHTMOST) for n in (2, 3)
]
RELATIONS_BY_SENSE = (
    Relation.ON,
    Relation.UNDER,
    Relation.ABOVE,
    Relation.BELOW,
    Relation.NEXT_TO,
    Relation.IN_FRONT_OF,
    Relation.BEHIND,
    Relation.LEFT_OF,
    Relation.RIGHT_OF,
    Relation.NEAR,
)
"""What holds from everywhere first, the vague last."""

Terms = tuple[Term, ...]


def expressions(
    resolver: Resolver, target_id: int, generator: np.random.Generator
) -> Iterator[tuple[PromptKind, Meaning]]:
    """Up to three unambiguous meanings, one for each kind of prompt in the paper's order; where only one kind can be
    had, two of that kind."""
    target = next(box for box in resolver.boxes if box.object_id == target_id)
    description = _Description(resolver, target)
    found: list[tuple[PromptKind, Meaning]] = []
    kinds: tuple[tuple[PromptKind, Iterable[Meaning], int], ...] = (
        ("object_centred", description.object_centred(), 1),
        ("relative", description.relative(), VARIETY),
        ("appearance", description.appearance(), 1),
    )
    spare: list[tuple[PromptKind, Meaning]] = []
    for kind, candidates, variety in kinds:
        fresh = (m for m in candidates if not any(_same(m, other) for _, other in found))
        sure = list(
            islice((m for m in islice(fresh, MOST_TRIED) if resolver.picks(m, target_id)), max(variety, SEVERAL))
        )
        if sure:
            chosen = int(generator.integers(min(variety, len(sure))))
            found.append((kind, sure.pop(chosen)))
            spare += [(kind, m) for m in sure]
    others = [(kind, m) for kind, m in spare if not any(_same(m, other) for _, other in found)]
    yield from found + others[: max(0, SEVERAL - len(found))]


def lasting_expression(resolver: Resolver, target_id: int) -> Meaning | None:
    """The plainest sure meaning that does not depend on where the drone is: for one goal among several."""
    target = next(box for box in resolver.boxes if box.object_id == target_id)
    description = _Description(resolver, target)
    for candidates in (description.object_centred(), description.appearance(), description.relative()):
        lasting = (m for m in candidates if not any(egocentric(t) for t in m.terms))
        sure = next((m for m in islice(lasting, MOST_TRIED) if resolver.picks(m, target_id)), None)
        if sure is not None:
            return sure
    return None


def unique_landmarks(meaning: Meaning, resolver: Resolver) -> frozenset[Meaning]:
    """The landmarks in ``meaning`` that are one thing only, and so take "the"."""
    return frozenset(m for m in meaning.landmarks if np.count_nonzero(resolver.truths(m)) == 1)


class _Description:
    """All that is certainly true of one target, and the ways to put it together, plainest first."""

    def __init__(self, resolver: Resolver, target: ObjectBox) -> None:
        self.resolver, self.target = resolver, target
        self.nameless = is_generic(target.label)
        self.noun = Noun(UNNAMED if self.nameless else target.label)
        self.sides: list[Term] = [s for side in Side if self._holds(s := Located(side))]
        self.looks = _looks(target)
        longish = max(target.size[:2]) >= LONGISH * target.size[2]
        largest: list[Term] = [
            Most(by) for by in (BY_SIZE[:3] if self.nameless else BY_SIZE) if longish or by is not Superlative.LONGEST
        ]
        sized: list[Term] = [Sized(size) for size in Size]
        # Of a thing without a name the largest is looked for among all things, seen or not: when nothing else is left.
        self.sizes, self.last_sizes = (sized, largest) if self.nameless else ([*largest, *sized], [])
        self.levels: list[Term] = [p for level in Level if self._holds(p := Placed(level))]
        self._place_list: list[Term] | None = None

    def object_centred(self) -> Iterator[Meaning]:
        """The noun, refined by size or by where the drone sees it; a thing without name has its shape and colour."""
        colours = [look for look in self.looks if isinstance(look, Colour)]
        kernels: list[Terms] = [(self.noun,)]
        if self.nameless:
            kernels = [(shape, *colours, self.noun) for shape in self._shapes()]
        yield from (Meaning(kernel) for kernel in kernels)
        yield from _with(kernels, self.sizes)
        yield from _with(kernels, [*self.levels, *self.sides])
        yield from _with(kernels, FIRSTS)
        yield from self._picked_among(kernels)

    def relative(self) -> Iterator[Meaning]:
        """The noun with a relation to the most sensible landmarks; refined by looks, a side, or a second relation."""
        kernels: list[Terms] = [(self.noun,), *((look, self.noun) for look in self.looks[:3])]
        places, parts = self._places(), [*self.sides, *self.levels]
        for kernel in kernels:
            yield from _with([kernel], places)
        yield from _with(kernels, [Most(Superlative.CLOSEST_TO, m) for m, _ in self._landmarks()])
        kernels += [(*pair, self.noun) for pair in self._pairs()]
        for kernel in kernels[4:]:
            yield from _with([kernel], places)
        for kernel in kernels:
            yield from (Meaning((*kernel, part, place)) for part in parts for place in places)
        near_it: list[Terms] = [(*kernel, place) for kernel in kernels for place in places[:8]]
        for sizes in ([*self.sizes, *FIRSTS], self.last_sizes):
            yield from _with(near_it, sizes)
        for kernel in kernels:
            pairs = combinations(places[:10], 2)
            yield from (Meaning((*kernel, one, other)) for one, other in pairs if _landmarks_differ(one, other))

    def appearance(self) -> Iterator[Meaning]:
        """Always something seen on the thing: colour, material, shape, then size among its like, or a side as well."""
        looks: list[Terms] = [*((look,) for look in self.looks), *self._pairs()]
        guessed = [look for look in looks if any(isinstance(term, Material) for term in look)]
        for chosen in ([look for look in looks if look not in guessed], guessed):
            kernels: list[Terms] = [(*look, self.noun) for look in chosen]
            yield from (Meaning(kernel) for kernel in kernels)
            yield from _with(kernels, self.sizes)
            yield from _with(kernels, [*self.levels, *self.sides])
            yield from _with(kernels, FIRSTS)
            if not self.nameless:
                yield from _with([(self.noun,)], self.sizes[:3])
            yield from self._picked_among(kernels)

    def _pairs(self) -> list[Terms]:
        """Two looks of different kinds."""
        return [pair for pair in combinations(self.looks, 2) if type(pair[0]) is not type(pair[1])]

    def _picked_among(self, kernels: list[Terms]) -> Iterator[Meaning]:
        """One by its size or place among its like on one side of the drone or at one height, or counted among all."""
        parts: list[Term] = [*self.sides, *self.levels]
        for part in parts:
            yield from _with([(*kernel, part) for kernel in kernels], [*self.sizes, *FIRSTS[:2]])
        yield from _with(
            [(*kernel, *both) for kernel in kernels for both in product(self.sides, self.levels)], FIRSTS[:2]
        )
        yield from _with(kernels, COUNTED)
        yield from _with(kernels, self.last_sizes)
        for part in parts:
            yield from _with([(*kernel, part) for kernel in kernels], self.last_sizes)

    def _shapes(self) -> list[Term]:
        return [look for look in self.looks if isinstance(look, Shaped)]

    def _holds(self, term: Term) -> bool:
        return self.resolver.judge(term)(self.target) is Truth.YES

    def _places(self) -> list[Term]:
        """True relations of the target to its landmarks, most sensible first."""
        if self._place_list is None:
            marks = self._landmarks()
            related: list[Term] = [Related(r, m) for r, (m, _) in product(RELATIONS_BY_SENSE, marks)]
            sure = [m for m, box in marks if self.resolver.picks(m, box.object_id)]
            middle: list[Term] = [Between(one, other) for one, other in combinations(sure[:5], 2)]
            at = RELATIONS_BY_SENSE.index(Relation.IN_FRONT_OF) * len(marks)
            self._place_list = [t for t in (*related[:at], *middle, *related[at:]) if self._holds(t)]
        return self._place_list

    def _landmarks(self) -> list[tuple[Meaning, ObjectBox]]:
        """Things of another kind that are near and big enough, most sensible first, by the shortest sure phrase.

        A thing with a name that no phrase singles out is "a" such thing; one without a name is then no landmark.
        """
        near: list[tuple[float, int, ObjectBox]] = []
        for box in self.resolver.boxes:
            gap = outline_gap(box, self.target)
            if box is self.target or gap > LANDMARK_REACH or max(box.size) < LEAST_LANDMARK:
                continue
            if self.nameless or box.label != self.target.label:
                rise = max(box.bottom - self.target.top, self.target.bottom - box.top, 0.0)
                cost = gap + rise + 0.5 / max(box.size) + _doubt(box)
                near.append((cost, box.object_id, box))
        near.sort(key=lambda entry: entry[:2])
        called = ((_landmark_phrase(box, self.resolver), box) for _, _, box in near)
        return list(islice(((m, box) for m, box in called if m is not None), NEAREST_LANDMARKS))


def _doubt(box: ObjectBox) -> float:
    """Metres by which a landmark must be nearer because of what it is called."""
    return NAMELESS_COST if is_generic(box.label) else UNSURE_COST * (1.0 - box.label_score)


def _looks(box: ObjectBox) -> list[Term]:
    """What is seen on the box itself, the surest first: colour, shapes, and the material, which is a guess.

    Of a thing with a name only the shapes that it might not have; of none that it is boxy, which its box always is.
    """
    shapes = [shape for shape in Shape if shape is not Shape.BOXY and shaped(shape, box) is Truth.YES]
    if Shape.SLIM in shapes and Shape.TALL in shapes:
        shapes.remove(Shape.SLIM)
    telling: list[Term] = [Shaped(s) for s in shapes if is_generic(box.label) or s in TELLING_SHAPES]
    colours: list[Term] = [Colour(box.colour)] if box.colour else []
    materials: list[Term] = [Material(box.material)] if box.material else []
    if box.label.split()[-1] in MANY_COLOURED:
        return [*telling, *materials, *colours]
    return [*colours, *telling, *materials]


def _landmark_phrase(box: ObjectBox, resolver: Resolver) -> Meaning | None:
    nameless = is_generic(box.label)
    noun: Term = Noun(UNNAMED if nameless else box.label)
    looks = _looks(box)
    refined: list[Terms] = [(noun,), *((noun, look) for look in looks), *((noun, *p) for p in combinations(looks, 2))]
    refined += [] if nameless else [(noun, Most(by)) for by in BY_SIZE[:3]]
    sure = next((m for m in map(Meaning, refined) if resolver.picks(m, box.object_id)), None)
    return sure or (None if nameless else Meaning((noun,)))


def _with(kernels: Iterable[Terms], refinements: Iterable[Term]) -> Iterator[Meaning]:
    refined = list(refinements)
    return (Meaning((*kernel, term)) for kernel in kernels for term in refined if not _clashes(term, kernel))


def _clashes(term: Term, kernel: Terms) -> bool:
    """ "The shortest tall lamp" says one dimension twice, and "the small flat box" nearly so."""
    shapes = {t.shape for t in kernel if isinstance(t, Shaped)}
    match term:
        case Most(Superlative.TALLEST | Superlative.SHORTEST):
            return bool(shapes & {Shape.TALL, Shape.SLIM, Shape.LOW, Shape.FLAT, *HEIGHTS})
        case Most(Superlative.LONGEST):
            return Shape.LONG in shapes
        case Sized():
            return bool(shapes & {Shape.TALL, Shape.SLIM, *HEIGHTS})
    return False


def _landmarks_differ(one: Term, other: Term) -> bool:
    return not set(Meaning((one,)).landmarks) & set(Meaning((other,)).landmarks)


def _same(one: Meaning, other: Meaning) -> bool:
    return frozenset(one.terms) == frozenset(other.terms)
