"""Reading an instruction's text back: which objects a listener at the drone's start could take it to mean.

For prompts of any writer. `read_back` says whether it is exactly the target, ambiguous, of something else, of something
that is not there, or unreadable.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import product

from flymirage_core.language.lexicon import ROOM_PARTS
from flymirage_core.language.meaning import (
    UNNAMED,
    Between,
    Located,
    Meaning,
    Most,
    Nameless,
    Noun,
    Related,
    Term,
)
from flymirage_core.language.nouns import is_generic, named
from flymirage_core.language.parsing import Command, Link, Phrase, UnreadableError, parse
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import Relation, Truth


class Outcome(Enum):
    TARGET = "target"  # it is read as the target and as nothing else
    AMBIGUOUS = "ambiguous"  # as the target or as something else
    OTHER = "other"  # as something else
    ABSENT = "absent"  # as nothing that is there
    UNREADABLE = "unreadable"


@dataclass(frozen=True)
class Reading:
    """What a text was understood as."""

    outcome: Outcome
    objects: tuple[int, ...]  # ids of all that it may mean, ascending
    reason: str  # a sentence; "" where the outcome is TARGET
    certain: bool = False  # TARGET, and nothing said of it is borderline ("couch" of a "sofa" is not, "seat" is)
    unchecked: tuple[str, ...] = ()  # words that no box can confirm ("cosy"); the target is singled out without them


def read_back(text: str, resolver: Resolver, target_id: int) -> Reading:
    """How ``text`` is understood among the resolver's objects, seen from its start pose."""
    try:
        command = parse(text)
        return _read_goal(_only_goal(command), command, resolver, target_id)
    except UnreadableError as error:
        return _unreadable(error)


def read_itinerary(text: str, resolver: Resolver, target_ids: Sequence[int]) -> list[Reading]:
    """How each goal of an instruction over several is understood; one `Reading` if it names another number of them."""
    try:
        command = parse(text)
        goals = [goal for goal in command.goals if not goal.passed]
        if len(goals) != len(target_ids):
            raise UnreadableError(f"it names {len(goals)} goals, there are {len(target_ids)}")
        return [_read_goal(goal, command, resolver, i) for goal, i in zip(goals, target_ids, strict=True)]
    except UnreadableError as error:
        return [_unreadable(error)]


def _unreadable(error: UnreadableError) -> Reading:
    return Reading(Outcome.UNREADABLE, (), f"the prompt cannot be read: {error}")


def _only_goal(command: Command) -> Phrase:
    if not command.goals:
        raise UnreadableError("it names no thing to fly to")
    first, *more = [g for g in command.goals if not g.passed] or command.goals[-1:]
    others = [goal for goal in more if not _refers_back(goal, first)]
    if others:
        raise UnreadableError(f"it names two goals, the {first.noun} and the {others[0].noun}")
    return first


def _read_goal(goal: Phrase, command: Command, resolver: Resolver, target_id: int) -> Reading:
    """What one goal's phrase may mean. Raises `UnreadableError`."""
    reader = _Reader(resolver)
    reader.check_passed(command)
    names = {box.object_id: box.label for box in resolver.boxes}
    meanings = list(reader.meanings(goal, is_generic(names.get(target_id, UNNAMED))))
    if command.turn is not None:
        meanings = [Meaning((*m.terms, Located(command.turn))) for m in meanings]
    unchecked = (*reader.unchecked, *goal.unchecked)
    truths: dict[int, Truth] = {}
    for meaning in meanings:
        for object_id, truth in resolver.readings(meaning).items():
            truths[object_id] = max(truth, truths.get(object_id, Truth.NO))
    found = tuple(sorted(truths))
    if not found:
        return Reading(Outcome.ABSENT, (), _what_is_missing(goal, resolver), unchecked=unchecked)
    if found == (target_id,):
        return Reading(Outcome.TARGET, found, "", truths[target_id] is Truth.YES, unchecked)
    said = ", ".join(f"{names[i]} {i}" for i in found)
    if target_id in found:
        return Reading(Outcome.AMBIGUOUS, found, f"the prompt may mean any of: {said}", unchecked=unchecked)
    reason = f"the prompt means {said}, not {names.get(target_id, UNNAMED)} {target_id}"
    return Reading(Outcome.OTHER, found, reason, unchecked=unchecked)


def _refers_back(phrase: Phrase, first: Phrase) -> bool:
    """ "Find a red chair. Fly to the chair." names one thing."""
    return phrase.noun == first.noun and not phrase.links and set(phrase.terms) <= set(first.terms)


class _Reader:
    """Phrases to meanings, among the objects of one scene."""

    def __init__(self, resolver: Resolver) -> None:
        self.resolver = resolver
        self.labels = {box.label for box in resolver.boxes}
        self.unchecked: list[str] = []

    def check_passed(self, command: Command) -> None:
        """Things on the way must be there. Raises `UnreadableError`."""
        for passed in (goal for goal in command.goals if goal.passed):
            is_room = passed.noun.split()[-1] in ROOM_PARTS
            if not is_room and not any(self.resolver.truths(m).any() for m in self.meanings(passed, True)):
                raise UnreadableError(f"the {passed.noun} on the way is not there")
        self.unchecked.clear()

    def meanings(self, phrase: Phrase, may_be_nameless: bool) -> Iterator[Meaning]:
        """One for each way in which what follows the noun may hang together."""
        base = self._core(phrase, may_be_nameless)
        links = [self._read(link) for link in phrase.links]
        for parents in product(*(self._parents(phrase.links, i) for i in range(len(links)))):
            yield Meaning((*base, *_children(-1, links, parents)))

    def _parents(self, links: list[Link], i: int) -> list[int]:
        """What the i-th link may be said of: the head (-1), or the landmark of the link before it."""
        return [-1, i - 1] if i and links[i - 1].landmarks and not links[i].of_head else [-1]

    def _read(self, link: Link) -> tuple[Link, tuple[Meaning, ...]]:
        return link, tuple(Meaning(self._core(mark, True)) for mark in link.landmarks)

    def _core(self, phrase: Phrase, may_be_nameless: bool) -> tuple[Term, ...]:
        """Noun and adjectives; those that are part of a name here ("cardboard box", "low bookshelf") say no more."""
        said = phrase.words if not is_generic(phrase.noun) else []
        for i in range(len(said)):
            name = " ".join([*said[i:], phrase.noun])
            if any(named(name, label) is Truth.YES for label in self.labels):
                return (Noun(name), *phrase.terms[:i], *phrase.terms[len(said) :])
        return (*self._noun(phrase, may_be_nameless), *phrase.terms)

    def _noun(self, phrase: Phrase, may_be_nameless: bool) -> tuple[Term, ...]:
        """The longest end of the noun's words that names something here; words before it cannot be checked.

        A noun that fits nothing may be another's name for a thing without one. Raises `UnreadableError` if it seems
        to be no noun at all.
        """
        words = phrase.noun.split()
        for least in (Truth.YES, Truth.MAYBE):
            for i in range(len(words)):
                noun = " ".join(words[i:])
                if is_generic(noun) or any(named(noun, label) >= least for label in self.labels):
                    self.unchecked += words[:i]
                    return (Noun(noun),)
        if phrase.bare:
            raise UnreadableError(f"{phrase.noun!r} is not understood")
        return (Nameless(),) if may_be_nameless else (Noun(phrase.noun),)


def _children(parent: int, links: list[tuple[Link, tuple[Meaning, ...]]], parents: tuple[int, ...]) -> Iterator[Term]:
    """The terms of all links that are said of ``parent``."""
    for i, (link, marks) in enumerate(links):
        if parents[i] != parent:
            continue
        if link.term is not None:
            yield link.term
            continue
        *others, last = marks
        last = Meaning((*last.terms, *_children(i, links, parents)))
        if others:
            yield Between(others[0], last)
        elif isinstance(link.relation, Relation):
            yield Related(link.relation, last)
        elif link.relation is not None:
            yield Most(link.relation, last)


def _what_is_missing(goal: Phrase, resolver: Resolver) -> str:
    """A sentence about a noun that names nothing here, or about what is not as described."""
    labels = {box.label for box in resolver.boxes}
    for phrase in (goal, *(mark for link in goal.links for mark in link.landmarks)):
        if phrase.noun != UNNAMED and not any(named(phrase.noun, label) for label in labels):
            return f"there is no {phrase.noun} among the objects"
    return f"there is a {goal.noun}, but none as described"
