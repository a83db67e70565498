"""English as far as descriptions need it: articles, plurals, numbers, lists, and a thing's phrase."""

import re
from collections.abc import Iterable, Sequence

from flymirage_core.scene.design import PlannedObject
from flymirage_core.scene.knowledge import nouns, part_of

ONES = (
    "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve",
    "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen",
)  # fmt: skip
TENS = ("", "", "twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
SOUNDS_LIKE_YOU = re.compile(r"(uni(?!n)|util|use|euro|one\b|u-)", re.IGNORECASE)
MEASURES = ("stack of ", "pallet of ", "row of ", "string of ")
"""Attributes belong to what is measured: a stack of navy books."""


def article(phrase: str) -> str:
    """ "a" or "an", by the first sound as its letters tell.

    >>> article("oak desk"), article("pine desk"), article("utilitarian hall"), article("university courtyard")
    ('an', 'a', 'a', 'a')
    """
    return "an" if phrase[:1].lower() in "aeiou" and not SOUNDS_LIKE_YOU.match(phrase) else "a"


def plural(noun: str) -> str:
    """
    >>> plural("wall shelf"), plural("stack of books"), plural("bench"), plural("battery")
    ('wall shelves', 'stacks of books', 'benches', 'batteries')
    """
    known = nouns().get(noun)
    if known and known.plural:
        return known.plural
    head, of, rest = noun.partition(" of ")
    if of:
        return plural(head) + of + rest
    if noun.endswith("shelf"):
        return noun[:-1] + "ves"
    if noun.endswith(("s", "x", "ch", "sh")):
        return noun + "es"
    if noun.endswith("y") and noun[-2] not in "aeiou":
        return noun[:-1] + "ies"
    return noun + "s"


def count(number: float) -> str:
    """The nearest whole number, in words below a hundred.

    >>> count(10.6), count(40), count(22), count(120)
    ('eleven', 'forty', 'twenty-two', '120')
    """
    whole = round(number)
    if whole >= 100:
        return str(whole)
    tens, ones = divmod(whole, 10)
    return ONES[whole] if whole < 20 else TENS[tens] + (f"-{ONES[ones]}" if ones else "")


def listing(things: Sequence[str]) -> str:
    """
    >>> listing(["a lamp", "two vases", "a bowl"])
    'a lamp, two vases and a bowl'
    """
    return things[0] if len(things) == 1 else ", ".join(things[:-1]) + " and " + things[-1]


def attributes(colour: str, material: str, noun: str = "") -> str:
    """Colour and material as they are said before a noun, no word twice.

    >>> attributes("oak brown", "oak", "desk"), attributes("tan", "cardboard", "cardboard box")
    ('brown oak', 'tan')
    >>> attributes("brick red", "brick"), attributes("orange", "plastic", "traffic cone")
    ('red brick', 'orange')
    """
    taken = set(noun.split())
    known = nouns().get(noun)
    stuff = "" if (known and known.unsaid) or set(material.split()) & taken else material
    hue = " ".join(w for w in colour.split() if w not in stuff.split() and w not in taken)
    return f"{hue} {stuff}".strip()


def surface_words(colour: str, material: str) -> str:
    """
    >>> surface_words("oak brown", "oak plank"), surface_words("chalk", "plaster")
    ('brown oak planks', 'chalk plaster')
    """
    words = attributes(colour, material)
    return words + "s" if words.endswith(("plank", "tile", "panel", "board")) else words


def phrase(groups: Sequence[PlannedObject]) -> tuple[str, int]:
    """What is said of one or several groups of the same noun, and how many things that is.

    >>> at = {"noun": "vase", "material": "stoneware", "placement": "on_surface"}
    >>> phrase([PlannedObject(count=2, colour="teal", **at)])
    ('two teal stoneware vases', 2)
    >>> phrase([PlannedObject(count=2, colour="teal", **at), PlannedObject(count=1, colour="rust", **at)])
    ('three stoneware vases in teal and rust', 3)
    """
    first, total = groups[0], sum(g.count for g in groups)
    material, size, state = (_shared(getattr(g, name) for g in groups) for name in ("material", "size", "state"))
    words = [size if size != "medium" else "", state]
    colours = list(dict.fromkeys(_hue(g.colour, g.material) for g in groups))
    part = part_of(first.noun)
    if part:
        stuff = listing(colours) if material in colours else _spaced([listing(colours), material])
        after = f" in {article(stuff)} {stuff} {part}" if total == 1 else f" in {stuff} {part}s"
        return _counted(total, _spaced(words), first.noun) + after, total
    stuff = attributes(colours[0] if len(colours) == 1 else "", material, first.noun)
    after = f" in {listing(colours)}" if len(colours) > 1 else ""
    return _counted(total, _spaced([*words, stuff]), first.noun) + after, total


def _spaced(words: Sequence[str]) -> str:
    return " ".join(w for w in words if w)


def _shared(values: Iterable[str]) -> str:
    """What all have in common, else nothing."""
    found = set(values)
    return found.pop() if len(found) == 1 else ""


def _hue(colour: str, material: str) -> str:
    """The colour without words that the material says."""
    return " ".join(w for w in colour.split() if w not in material.split()) or colour


def capitalised(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]


def things(phrases: Iterable[tuple[str, int]]) -> tuple[str, bool]:
    """A list of phrases, and whether a verb before or after it is in the plural."""
    found = list(phrases)
    return listing([p for p, _ in found]), len(found) > 1 or found[0][1] > 1


def _counted(total: int, words: str, noun: str) -> str:
    measure = next((m for m in MEASURES if noun.startswith(m)), "")
    if measure and words:
        inner = f"{words} {noun.removeprefix(measure)}"
        head = measure.removesuffix(" of ")
        return f"{article(head)} {measure}{inner}" if total == 1 else f"{count(total)} {plural(head)} of {inner}"
    if total == 1:
        whole = f"{words} {noun}".strip()
        return f"{article(whole)} {whole}"
    return f"{count(total)} {words} {plural(noun)}".replace("  ", " ")
