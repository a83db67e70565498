"""English instructions to phrases: what each thing named in them is called, and how it is tied to others.

A small grammar for commands ("fly to", "your goal is"), noun phrases and what follows them. What it does not know it
does not guess: `UnreadableError` names the words. What is true is decided elsewhere.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from flymirage_core.language import lexicon
from flymirage_core.language.lexicon import phrases
from flymirage_core.language.meaning import (
    UNNAMED,
    Colour,
    Located,
    Material,
    Most,
    Placed,
    Shaped,
    Sized,
    Superlative,
    Term,
)
from flymirage_core.language.nouns import singular
from flymirage_core.language.scene_relations import Relation, Side

T = TypeVar("T")

LONGEST_PHRASE = 6
"""Words."""
EGOCENTRIC_WORDS = frozenset({"left", "right", "ahead", "behind", "front", "back", "rear"})


class UnreadableError(ValueError):
    """The text is outside the grammar; the message says where."""


@dataclass(frozen=True)
class Link:
    """One thing said after a noun: a term, or a relation to one landmark, or to two."""

    term: Term | None = None
    relation: Relation | Superlative | None = None  # `Superlative.CLOSEST_TO`; None with landmarks: between them
    landmarks: tuple["Phrase", ...] = ()
    of_head: bool = False  # set apart by a comma or "and": it is said of the first noun


@dataclass
class Phrase:
    """A noun phrase: terms said before its noun, the noun, what follows it, and what cannot be checked."""

    noun: str = ""
    terms: list[Term] = field(default_factory=list)
    words: list[str] = field(default_factory=list)  # that said the first of the terms: some are part of a name
    links: list[Link] = field(default_factory=list)
    unchecked: list[str] = field(default_factory=list)
    bare: bool = False  # without "the" or "a"
    passed: bool = False  # on the way, not the goal


@dataclass
class Command:
    """The things that an instruction names, in order, and the side to which it first turns the drone."""

    goals: list[Phrase] = field(default_factory=list)
    turn: Side | None = None


_RELATIONS = phrases(lexicon.RELATIONS, lexicon.ALSO_RELATIONS)
_SIDES = phrases(lexicon.SIDES, lexicon.ALSO_SIDES)
_TURNS = phrases(lexicon.TURNS)
_ADJECTIVES: dict[tuple[str, ...], Term] = {
    **{words: Most(by) for words, by in phrases(lexicon.SUPERLATIVES, lexicon.ALSO_SUPERLATIVES).items()},
    **{words: Sized(size) for words, size in phrases(lexicon.SIZES, lexicon.ALSO_SIZES).items()},
    **{words: Shaped(shape) for words, shape in phrases(lexicon.SHAPES, lexicon.ALSO_SHAPES).items()},
    **{words: Colour(name) for words, name in phrases(lexicon.COLOURS, lexicon.ALSO_COLOURS).items()},
    **{words: Material(name) for words, name in phrases(lexicon.MATERIALS).items()},
}
_BEHIND_NOUN: dict[tuple[str, ...], Term] = {
    **{words: Located(side) for words, side in _SIDES.items()},
    **{words: Placed(level) for words, level in phrases(lexicon.LEVELS, lexicon.ALSO_LEVELS).items()},
    **{words: Most(by) for words, by in phrases(lexicon.SUPERLATIVES_BEHIND).items()},
}
_COUNTED = phrases(lexicon.COUNTED_FROM)
_ORDINALS = phrases(lexicon.ORDINALS)
_CLOSEST = {tuple(words.split()): Superlative.CLOSEST_TO for words in (*lexicon.CLOSEST_TO, "nearest", "closest")}
_DETERMINERS: dict[tuple[str, ...], str] = {(word,): word for word in lexicon.DETERMINERS}
_MOTION: dict[tuple[str, ...], str] = {(word,): word for word in (*lexicon.MOTION, ".", ",", ";", ":", "!", "?")}
_PRONOUNS: dict[tuple[str, ...], str] = {tuple(words.split()): words for words in lexicon.PRONOUNS}
_PASSING: dict[tuple[str, ...], str] = {tuple(words.split()): words for words in lexicon.PASSING}
_LINKS: dict[tuple[str, ...], str] = {tuple(words.split()): words for words in (*lexicon.LINKS, *lexicon.LINKS_MORE)}
_LEADS: dict[tuple[str, ...], str] = {(word,): word for word in lexicon.UNCHECKED_LEADS}
_STOPS = {
    ".": "",
    ",": "",
    ";": "",
    ":": "",
    "!": "",
    "?": "",
    "and": "",
    "then": "",
    "that": "",
    "which": "",
    "between": "",
}


class _Cursor:
    """Words of a text, and how far they have been read."""

    def __init__(self, text: str) -> None:
        plain = text.lower().replace("\u2019", "'").replace("\u2011", "-")
        self.words = re.findall(r"[a-z0-9]+(?:[-'][a-z0-9]+)*|[.,;:!?]", plain)
        self.at = 0

    @property
    def word(self) -> str:
        return self.words[self.at] if self.at < len(self.words) else ""

    def match(self, table: Mapping[tuple[str, ...], object]) -> int:
        """How many words the longest of the table's phrases has that begins here; 0 if none does."""
        counts = range(min(LONGEST_PHRASE, len(self.words) - self.at), 0, -1)
        return next((n for n in counts if tuple(self.words[self.at : self.at + n]) in table), 0)

    def take(self, table: Mapping[tuple[str, ...], T]) -> T | None:
        """What that phrase stands for; reads on behind it."""
        count = self.match(table)
        if not count:
            return None
        self.at += count
        return table[tuple(self.words[self.at - count : self.at])]


def parse(text: str) -> Command:
    """What an instruction names. Raises `UnreadableError`."""
    cursor, command, passing = _Cursor(text), Command(), False
    if not cursor.words:
        raise UnreadableError("there are no words in it")
    while cursor.word:
        turn = cursor.take(_TURNS)
        if turn is not None:
            command.turn = turn
        elif cursor.take(_PASSING) is not None:
            passing = True
        elif cursor.match(_PRONOUNS) and not _noun_follows(cursor):
            cursor.take(_PRONOUNS)
        elif cursor.match(_DETERMINERS) or not (cursor.match(_MOTION) or cursor.match(_RELATIONS)):
            command.goals.append(_phrase(cursor))
            command.goals[-1].passed, passing = passing, False
        elif cursor.take(_RELATIONS) is None:
            cursor.take(_MOTION)
    return command


def _noun_follows(cursor: _Cursor) -> bool:
    """ "the drone" is a pronoun, "the drone charger" is not."""
    behind = cursor.at + cursor.match(_PRONOUNS)
    following = cursor.words[behind] if behind < len(cursor.words) else "."
    return cursor.word in lexicon.DETERMINERS and following not in (*lexicon.MOTION, *_STOPS)


def _phrase(cursor: _Cursor) -> Phrase:
    """A noun phrase and all that is tied to it."""
    phrase = _core(cursor)
    while True:
        before, apart = cursor.at, False
        while cursor.word in (",", "and"):
            cursor.at, apart = cursor.at + 1, True
        while cursor.match(_LINKS) > max(cursor.match(_RELATIONS), cursor.match(_BEHIND_NOUN)):
            cursor.take(_LINKS)
        if not _link(cursor, phrase, apart):
            cursor.at = before
            return phrase


def _core(cursor: _Cursor) -> Phrase:
    """Determiner, adjectives, noun."""
    phrase = Phrase()
    determiner = cursor.take(_DETERMINERS)
    phrase.bare = determiner is None
    rank = cursor.take(_ORDINALS) or 1
    while True:
        separated = 1 if cursor.word in (",", "and") else 0
        cursor.at += separated
        begun = cursor.at
        term = cursor.take(_ADJECTIVES)
        if term is None:
            cursor.at -= separated
            break
        phrase.terms.append(Most(term.by, rank=rank) if isinstance(term, Most) else term)
        phrase.words.append(" ".join(cursor.words[begun : cursor.at]))
    words: list[str] = []
    while cursor.word and not _noun_ends(cursor, words):
        term = cursor.take(_ADJECTIVES)  # "cosy red chair": after a word that is none
        if term is not None and (not cursor.word or _noun_ends(cursor, words)):
            words.append(cursor.words[cursor.at - 1])
        elif term is not None:
            phrase.terms.append(term)
        else:
            words.append(cursor.word)
            cursor.at += 1
    _undo_adjective(phrase, words)
    phrase.noun = singular(" ".join(words)) if words else UNNAMED
    if not words and (determiner is None or not phrase.terms):
        raise UnreadableError(f"a noun was expected before {cursor.word or 'the end'!r}")
    counted = cursor.take(_COUNTED)
    if counted is not None:
        phrase.terms.append(Most(counted, rank=rank))
    elif rank > 1 and not any(isinstance(t, Most) for t in phrase.terms):
        raise UnreadableError(f"it does not say from where the {phrase.noun} is counted")
    return phrase


def _noun_ends(cursor: _Cursor, words: list[str]) -> bool:
    if cursor.word in _STOPS or cursor.match(_COUNTED):
        return True
    if words and cursor.match(_LINKS):  # "plant hanging on"; but "hanging plant"
        return True
    if cursor.word == "of" and words:
        return False  # "chest of drawers"
    tied = cursor.match(_RELATIONS) or cursor.match(_BEHIND_NOUN) or cursor.match(_CLOSEST) or cursor.match(_LEADS)
    return tied > 0 or cursor.word in ("to", "until", "before", "when", "it", "for")


def _undo_adjective(phrase: Phrase, words: list[str]) -> None:
    """ "the light" names a light; "the glass on the table" a glass."""
    if not words and phrase.terms:
        last = phrase.terms[-1]
        nouns: dict[Term, str] = {Material(name): name for name in ("glass", "paper", "bamboo")}
        if last in nouns:
            words.append(nouns[last])
            phrase.terms.pop()
            phrase.words.pop()


def _link(cursor: _Cursor, phrase: Phrase, apart: bool) -> bool:
    """One thing said after the noun; False if nothing more is."""
    term = None if cursor.match(_RELATIONS) > cursor.match(_BEHIND_NOUN) else cursor.take(_BEHIND_NOUN)
    if term is not None:
        phrase.links.append(Link(term=term, of_head=apart))
        return True
    if cursor.word == "between":
        cursor.at += 1
        one = _core(cursor)
        if cursor.word != "and":
            raise UnreadableError(f"'between the {one.noun}' needs an 'and'")
        cursor.at += 1
        phrase.links.append(Link(landmarks=(one, _core(cursor)), of_head=apart))
        return True
    if cursor.word == "made" or (not apart and cursor.match(_LEADS) > cursor.match(_RELATIONS)):
        return _unchecked(cursor, phrase)
    relation: Relation | Superlative | None = cursor.take(_CLOSEST)
    if relation is None:
        begun = cursor.at
        relation = cursor.take(_RELATIONS)
        if relation is not None and not cursor.match(_DETERMINERS):
            cursor.at = begun  # "then stop near it"
            return False
    if relation is None:
        return False
    begun = cursor.at
    landmark = _core(cursor)
    if landmark.noun.split()[-1] in lexicon.ROOM_PARTS:
        _note_unchecked(phrase, " ".join(cursor.words[begun : cursor.at]))
    else:
        phrase.links.append(Link(relation=relation, landmarks=(landmark,), of_head=apart))
    return True


def _unchecked(cursor: _Cursor, phrase: Phrase) -> bool:
    """ "with a brass knob", "in the corner of the room": kept as said, up to the clause's end."""
    if cursor.words[cursor.at : cursor.at + 2] == ["made", "of"]:
        cursor.at += 2
        term = cursor.take(_ADJECTIVES)
        if not isinstance(term, Material):
            raise UnreadableError(f"{cursor.word!r} is no known material")
        phrase.terms.append(term)
        return True
    words: list[str] = []
    while cursor.word and cursor.word not in (".", ",", ";", "!", "?", "then") and not cursor.match(_TURNS):
        if cursor.word == "and" and cursor.words[cursor.at + 1 : cursor.at + 2] and _is_verb(cursor):
            break
        words.append(cursor.word)
        cursor.at += 1
    _note_unchecked(phrase, " ".join(words))
    return True


def _is_verb(cursor: _Cursor) -> bool:
    return cursor.words[cursor.at + 1] in lexicon.MOTION


def _note_unchecked(phrase: Phrase, words: str) -> None:
    if EGOCENTRIC_WORDS & set(words.split()):
        raise UnreadableError(f"{words!r} cannot be checked against the drone's start")
    phrase.unchecked.append(words)
