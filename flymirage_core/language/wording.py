"""English for meanings: noun phrases with articles and plurals, and the sentences around them.

What is true is decided in `resolver.py`; nothing here looks at a box. Words come from `lexicon.py`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from flymirage_core.language import lexicon
from flymirage_core.language.meaning import (
    Between,
    Colour,
    Located,
    Material,
    Meaning,
    Most,
    Placed,
    Related,
    Shaped,
    Sized,
    Superlative,
)
from flymirage_core.language.prompts import PromptKind

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
    "Fly over to {the}.",
    "Your goal is {the}.",
    "Search for {the}, then approach {it}.",
    "Take me to {the}.",
    "Steer towards {the}.",
    "Proceed to {the}.",
    "Bring the drone to {the}.",
    "Find {the} and fly to {it}.",
    "Please fly to {the}.",
    "Could you go to {the}?",
    "Fly towards {the} and stop there.",
    "Your target is {the}.",
    "Head over to {the}.",
    "Go and find {the}.",
    "Seek out {the}.",
    "Navigate towards {the} and wait there.",
    "Set course for {the}.",
    "Move closer to {the}.",
    "Now fly to {the}.",
    "Travel to {the} and hover.",
    "The drone should fly to {the}.",
    "I want you to fly to {the}.",
    "Guide the drone to {the}.",
)
"""Sentences round a definite noun phrase; ``{it}`` agrees with it."""

INTRODUCED = (
    "There {is} {a}. Fly to {it}.",
    "You can see {a}. Go to {it}.",
    "Look for {a}, then approach {it}.",
    "Spot {a}, then head for {it}.",
    "There {is} {a}. Make {it} your goal.",
    "Somewhere there {is} {a}. Find {it}.",
)
"""Sentences that introduce the thing before sending the drone there; they need an indefinite noun phrase."""

FIRST_LEG = ("Fly to {}", "First go to {}", "Start by flying to {}", "Begin by going to {}", "Head for {}", "Find {}")
NEXT_LEG = ("then go to {}", "then fly to {}", "next head for {}", "after that move to {}", "then find {}")
LAST_LEG = ("and finally stop at {}", "and finish at {}", "and at last fly to {}", "and then go to {}")
"""Parts of an instruction over several legs."""

Pick = Callable[[Sequence[str]], str]


def plainest(choices: Sequence[str]) -> str:
    """The first of several ways to say something."""
    return choices[0]


def drawn(generator: np.random.Generator) -> Pick:
    """Any of several ways to say something."""
    return lambda choices: choices[int(generator.integers(len(choices)))]


@dataclass(frozen=True)
class Speaker:
    """Says meanings; landmarks in ``unique`` are the only such thing in the scene, and so take "the"."""

    unique: frozenset[Meaning] = frozenset()
    pick: Pick = plainest

    def sentence(self, kind: PromptKind, meaning: Meaning) -> str:
        """A prompt that says ``meaning``, its sentence picked from those that suit the kind."""
        can_introduce = kind == "relative" and not any(isinstance(t, Most | Sized) for t in meaning.terms)
        plural = is_plural(meaning.noun)
        return self.pick(DIRECT + INTRODUCED if can_introduce else DIRECT).format(
            the=self.definite(meaning),
            a=self.indefinite(meaning),
            it="them" if plural else "it",
            **{"is": "are" if plural else "is"},
        )

    def itinerary(self, meanings: Sequence[Meaning]) -> str:
        """One instruction over several goals, in their order."""
        first, *middle, last = (self.definite(m) for m in meanings)
        parts = [self.pick(FIRST_LEG).format(first), *(self.pick(NEXT_LEG).format(m) for m in middle)]
        return ", ".join([*parts, self.pick(LAST_LEG).format(last)]) + "."

    def definite(self, meaning: Meaning) -> str:
        """
        >>> from flymirage_core.language.meaning import Noun
        >>> chair = Meaning((Most(Superlative.TALLEST), Colour("dark green"), Noun("chair")))
        >>> Speaker().definite(chair)
        'the tallest dark green chair'
        """
        return f"the {self._core(meaning)}{self._place(meaning)}"

    def indefinite(self, meaning: Meaning) -> str:
        """
        >>> from flymirage_core.language.meaning import Noun
        >>> Speaker().indefinite(Meaning((Noun("armchair"),)))
        'an armchair'
        """
        core = self._core(meaning)
        article = "some" if is_plural(meaning.noun) else article_of(core)
        return f"{article} {core}{self._place(meaning)}"

    def _core(self, meaning: Meaning) -> str:
        """Ordinal, then adjectives in English order (size, shape, colour, material), then the noun."""
        words: list[str] = []
        behind = ""
        for term in meaning.terms:
            match term:
                case Most(by, None, rank) if rank > 1:
                    counted = lexicon.COUNTED_FROM.get(by)
                    words.append(lexicon.ORDINALS[rank][0])
                    if counted:
                        behind = f" {self.pick(counted)}"
                    else:
                        words.append(self.pick(lexicon.SUPERLATIVES[by]))
                case Most(by, None):
                    words.append(self.pick(lexicon.SUPERLATIVES[by]))
        words += [self.pick(lexicon.SIZES[t.size]) for t in meaning.terms if isinstance(t, Sized)]
        words += [self.pick(lexicon.SHAPES[t.shape]) for t in meaning.terms if isinstance(t, Shaped)]
        words += [t.name for t in meaning.terms if isinstance(t, Colour)]
        words += [lexicon.MATERIALS[t.name][0] for t in meaning.terms if isinstance(t, Material)]
        return " ".join([*words, _spelled(meaning.noun)]) + behind

    def _place(self, meaning: Meaning) -> str:
        """What follows the noun, a blank before it; the drone's side first, lest it seem the landmark's."""
        places = [self.pick(lexicon.SIDES[t.side]) for t in meaning.terms if isinstance(t, Located)]
        places += [self.pick(lexicon.LEVELS[t.level]) for t in meaning.terms if isinstance(t, Placed)]
        for term in meaning.terms:
            match term:
                case Related(relation, landmark):
                    places.append(f"{self.pick(lexicon.RELATIONS[relation])} {self._landmark(landmark)}")
                case Between(one, other):
                    places.append(f"between {self._landmark(one)} and {self._landmark(other)}")
                case Most(Superlative.CLOSEST_TO, landmark) if landmark:
                    places.append(f"{self.pick(lexicon.CLOSEST_TO)} {self._landmark(landmark)}")
        return " " + ", ".join(places) if places else ""

    def _landmark(self, meaning: Meaning) -> str:
        return self.definite(meaning) if meaning in self.unique else self.indefinite(meaning)


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


def _spelled(noun: str) -> str:
    return " ".join(SPELLED.get(word, word) for word in noun.split())
