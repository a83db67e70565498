"""What a prompt means, as a structure: terms that all hold of the one object meant. Nothing here looks at a box.

At most one superlative (`Most`) picks among what the other terms leave. `resolver.py` reads a meaning against boxes,
`wording.py` says it in English, `reading.py` makes it from English.
"""

from dataclasses import dataclass
from enum import Enum

from flymirage_core.language.scene_relations import SEEN_FROM_START, Level, Relation, Side

UNNAMED = "object"
"""The noun of things for which nothing better is known; as a word it may mean anything."""


class Shape(Enum):
    """Proportions that one sees on a single object, and its height beside a person's."""

    TALL = "tall"
    SLIM = "slim"
    LOW = "low"
    LONG = "long"
    FLAT = "flat"
    THIN = "thin"
    KNEE_HIGH = "knee-high"  # of what stands on the ground, as are the next two
    WAIST_HIGH = "waist-high"
    HEAD_HIGH = "head-high"
    BOXY = "boxy"  # read, not written: what is in a box need not be


class Size(Enum):
    """Beside others of its kind."""

    LARGE = "large"
    SMALL = "small"


class Superlative(Enum):
    LARGEST = "largest"
    SMALLEST = "smallest"
    TALLEST = "tallest"
    SHORTEST = "shortest"
    LONGEST = "longest"
    HIGHEST = "highest"
    LOWEST = "lowest"
    NEAREST = "nearest"  # to the drone at its start, as are the next three
    FARTHEST = "farthest"
    LEFTMOST = "leftmost"
    RIGHTMOST = "rightmost"
    CLOSEST_TO = "closest to"  # a landmark


SEEN_FROM_START_MOST = frozenset(
    {Superlative.NEAREST, Superlative.FARTHEST, Superlative.LEFTMOST, Superlative.RIGHTMOST}
)


@dataclass(frozen=True)
class Noun:
    word: str


@dataclass(frozen=True)
class Nameless:
    """A thing without a name, called by one that fits no named thing."""


@dataclass(frozen=True)
class Colour:
    name: str


@dataclass(frozen=True)
class Material:
    name: str  # "wood"


@dataclass(frozen=True)
class Shaped:
    shape: Shape


@dataclass(frozen=True)
class Sized:
    """Clearly larger or smaller than every other object of which the other terms hold."""

    size: Size


@dataclass(frozen=True)
class Located:
    """On a side of the drone at its start."""

    side: Side


@dataclass(frozen=True)
class Placed:
    """On the ground, on a wall, or overhead."""

    level: Level


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
    rank: int = 1  # 2: the second nearest, the second from the left


Term = Noun | Nameless | Colour | Material | Shaped | Sized | Located | Placed | Related | Between | Most


@dataclass(frozen=True)
class Meaning:
    """The object of which all terms hold."""

    terms: tuple[Term, ...]

    @property
    def noun(self) -> str:
        return next((t.word for t in self.terms if isinstance(t, Noun)), UNNAMED)

    @property
    def landmarks(self) -> tuple["Meaning", ...]:
        """The meanings that the terms mention."""
        return tuple(landmark for term in self.terms for landmark in landmarks_of(term))


def landmarks_of(term: Term) -> tuple[Meaning, ...]:
    match term:
        case Related(_, landmark):
            return (landmark,)
        case Most(_, landmark) if landmark is not None:
            return (landmark,)
        case Between(one, other):
            return (one, other)
    return ()


def egocentric(term: Term) -> bool:
    """Whether it depends on where the drone starts."""
    match term:
        case Located():
            return True
        case Most(by) if by in SEEN_FROM_START_MOST:
            return True
        case Related(relation) if relation in SEEN_FROM_START:
            return True
    return any(egocentric(t) for landmark in landmarks_of(term) for t in landmark.terms)
