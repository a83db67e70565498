"""English for meanings: noun phrases with articles and plurals, and the sentences around them.

What is true is decided in `referring.py`; nothing here looks at a box.
"""

from dataclasses import dataclass

import numpy as np

from flymirage_core.language.prompts import PromptKind
from flymirage_core.language.referring import (
    Between,
    Colour,
    Located,
    Meaning,
    Most,
    Noun,
    Related,
    Shaped,
    Superlative,
)

VOWEL_SOUNDS = ("hour", "honest", "heir", "led ", "mri", "x-ray", "lcd")
CONSONANT_SOUNDS = ("uni", "use", "usb", "usual", "euro", "one", "ukulele", "uten", "urin", "ufo")
PLURAL_ONLY = ("stairs", "drawers", "shelves", "scissors", "curtains", "blinds", "books", "headphones", "glasses")
SINGULAR_IN_S = ("glass", "ss", "us", "is", "gas", "bias", "canvas", "lens", "atlas")
SPELLED = {"tv": "TV", "lcd": "LCD", "usb": "USB", "atm": "ATM", "pc": "PC", "led": "LED", "mri": "MRI"}
"""Labels are lower case; these are not words."""

DIRECT = (
    "Find {the}.",
    "Fly to {the}.",
    "Go to {the}.",
    "Navigate to {the}.",
    "Head for {the}.",
    "Move to {the}.",
    "Approach {the}.",
    "Locate {the}, then fly to {it}.",
    "Make your way to {the}.",
    "Look for {the}.",
    "Fly up to {the}, then stop.",
    "Stop in front of {the}.",
    "Your goal is {the}.",
    "Search for {the}, then approach {it}.",
    "Take me to {the}.",
    "Steer towards {the}.",
    "Proceed to {the}.",
    "Bring the drone to {the}.",
)
"""Sentences round a definite noun phrase; ``{it}`` agrees with it."""

INTRODUCED = (
    "There {is} {a}. Fly to {it}.",
    "You can see {a}. Go to {it}.",
    "Look for {a}, then approach {it}.",
    "Spot {a}, then head for {it}.",
)
"""Sentences that introduce the thing before sending the drone there; they need an indefinite noun phrase."""


@dataclass(frozen=True)
class Landmarks:
    """Which landmark meanings are unique in the scene and so take "the"."""

    unique: frozenset[Meaning]


def sentence(kind: PromptKind, meaning: Meaning, landmarks: Landmarks, generator: np.random.Generator) -> str:
    """A prompt that says ``meaning``, its sentence drawn from the kind's."""
    can_introduce = kind == "relative" and not any(isinstance(t, Most) for t in meaning.terms)
    frames = DIRECT + INTRODUCED if can_introduce else DIRECT
    frame = frames[int(generator.integers(len(frames)))]
    plural = is_plural(_noun(meaning))
    return frame.format(
        the=definite(meaning, landmarks),
        a=indefinite(meaning, landmarks),
        it="them" if plural else "it",
        **{"is": "are" if plural else "is"},
    )


def definite(meaning: Meaning, landmarks: Landmarks) -> str:
    """
    >>> chair = Meaning((Most(Superlative.TALLEST), Colour("dark green"), Noun("chair")))
    >>> definite(chair, Landmarks(frozenset()))
    'the tallest dark green chair'
    """
    return f"the {_core(meaning)}{_place(meaning, landmarks)}"


def indefinite(meaning: Meaning, landmarks: Landmarks) -> str:
    """
    >>> indefinite(Meaning((Noun("armchair"),)), Landmarks(frozenset()))
    'an armchair'
    """
    core = _core(meaning)
    article = "" if is_plural(_noun(meaning)) else f"{article_of(core)} "
    return f"{article}{core}{_place(meaning, landmarks)}"


def article_of(phrase: str) -> str:
    """ "a" or "an", by sound as far as spelling tells.

    >>> [article_of(w) for w in ("office chair", "unit", "hourglass", "TV", "umbrella stand", "one-seater")]
    ['an', 'a', 'an', 'a', 'an', 'a']
    """
    word = phrase.lower()
    if word.startswith(VOWEL_SOUNDS):
        return "an"
    return "a" if word.startswith(CONSONANT_SOUNDS) or word[0] not in "aeiou" else "an"


def is_plural(noun: str) -> bool:
    """
    >>> [is_plural(w) for w in ("curtains", "wine glass", "books", "chest of drawers", "canvas")]
    [True, False, True, False, False]
    """
    head = noun.split(" of ")[0].split()[-1]
    return head in PLURAL_ONLY or (head.endswith("s") and not head.endswith(SINGULAR_IN_S))


def _core(meaning: Meaning) -> str:
    """Adjectives in English order (size, shape, colour), then the noun."""
    words = [t.by.value for t in meaning.terms if isinstance(t, Most) and t.by is not Superlative.CLOSEST_TO]
    words += [t.shape.value for t in meaning.terms if isinstance(t, Shaped)]
    words += [t.name for t in meaning.terms if isinstance(t, Colour)]
    return " ".join([*words, _spelled(_noun(meaning))])


def _place(meaning: Meaning, landmarks: Landmarks) -> str:
    """Everything that follows the noun, with a blank before it; the drone's side first, lest it seem the landmark's."""
    places = [t.side.value for t in meaning.terms if isinstance(t, Located)]
    for term in meaning.terms:
        match term:
            case Related(relation, landmark):
                places.append(f"{relation.value} {_landmark(landmark, landmarks)}")
            case Between(one, other):
                places.append(f"between {_landmark(one, landmarks)} and {_landmark(other, landmarks)}")
            case Most(Superlative.CLOSEST_TO, landmark) if landmark:
                places.append(f"closest to {_landmark(landmark, landmarks)}")
    return " " + ", ".join(places) if places else ""


def _landmark(meaning: Meaning, landmarks: Landmarks) -> str:
    return definite(meaning, landmarks) if meaning in landmarks.unique else indefinite(meaning, landmarks)


def _noun(meaning: Meaning) -> str:
    return next(t.word for t in meaning.terms if isinstance(t, Noun))


def _spelled(noun: str) -> str:
    return " ".join(SPELLED.get(word, word) for word in noun.split())
