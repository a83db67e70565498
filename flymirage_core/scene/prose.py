"""A description's facts as a few sentences for people, and as a prompt for image and world models."""

import numpy as np

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.design import PlannedObject

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")
IRREGULAR = {"bookshelf": "bookshelves", "low bookshelf": "low bookshelves", "wall shelf": "wall shelves"}
PLURALS = {
    "stack of books": "stacks of books",
    "pallet of sacks": "pallets of sacks",
    "chest of drawers": "chests of drawers",
    **IRREGULAR,
}
OPENINGS = (
    "{a_style} {place}, about {x} by {y} metres under a ceiling of {z:.1f} metres.",
    "This {place} is {style} in character and measures roughly {x} by {y} metres, {z:.1f} metres high.",
    "Some {x} metres long and {y} wide, the {place} is {style}; its ceiling is {z:.1f} metres up.",
    "The {place} is {style} in style, {x} metres by {y}, with {z:.1f} metres of headroom.",
)
FLOORS = (
    "Between {wall} {walls} lies {a_floor}, and the place has {light}.",
    "Underfoot is {a_floor}; the {walls} are {wall}, and there is {light}.",
    "It has {wall} {walls}, {a_floor} and {light}.",
)
PLACES = {
    "against_wall": ("Along the walls stand {things}.", "The walls are lined with {things}."),
    "on_floor": ("On the floor there are {things}.", "The open floor holds {things}."),
    "in_row": ("Set in rows are {things}.", "There are rows of {things}."),
    "around": ("Drawn up to the furniture are {things}.", "Seats are ready: {things}."),
    "on_surface": ("On the furniture one finds {things}.", "Smaller things stand about: {things}."),
    "on_wall": ("On the walls hang {things}.", "The walls carry {things}."),
    "hanging": ("From the ceiling come {things}.", "Overhead there are {things}."),
}


def plural(noun: str) -> str:
    """
    >>> plural("wall shelf"), plural("stack of books"), plural("bench"), plural("vase")
    ('wall shelves', 'stacks of books', 'benches', 'vases')
    """
    if noun in PLURALS:
        return PLURALS[noun]
    if noun.endswith(("s", "x", "ch", "sh")):
        return noun + "es"
    if noun.endswith("y") and noun[-2] not in "aeiou":
        return noun[:-1] + "ies"
    return noun + "s"


def article(phrase: str) -> str:
    """ "a" or "an", by the first letter.

    >>> article("oak desk"), article("pine desk")
    ('an', 'a')
    """
    return "an" if phrase[:1].lower() in "aeiou" else "a"


def phrase_for(planned: PlannedObject) -> str:
    """
    >>> phrase_for(PlannedObject(noun="vase", count=2, colour="teal", material="stoneware", placement="on_surface"))
    'two teal stoneware vases'
    """
    said = planned.material in (planned.colour, planned.noun.split()[0]) or " of " in planned.noun
    words = planned.colour if said else f"{planned.colour} {planned.material}"
    if planned.count == 1:
        return f"{article(words)} {words} {planned.noun}"
    return f"{count(planned.count)} {words} {plural(planned.noun)}"


def count(number: float) -> str:
    """The nearest whole number, in words up to twelve.

    >>> count(10.6), count(40)
    ('eleven', '40')
    """
    whole = round(number)
    return NUMBERS[whole] if whole < len(NUMBERS) else str(whole)


def listing(things: list[str]) -> str:
    """
    >>> listing(["a lamp", "two vases", "a bowl"])
    'a lamp, two vases and a bowl'
    """
    return things[0] if len(things) == 1 else ", ".join(things[:-1]) + " and " + things[-1]


def prose_of(description: SceneDescription, generator: np.random.Generator) -> str:
    """What a person would read: the place, its surfaces and light, then what is where."""

    def one(frames: tuple[str, ...]) -> str:
        return frames[int(generator.integers(len(frames)))]

    x, y, z = description.dimensions
    floor, walls = (f"{s.material} {s.part}" for s in description.zones[0].surfaces[:2])
    style, place, ground = description.style, description.subcategory, f"{description.palette[1]} {floor}"
    sentences = [
        one(OPENINGS).format(
            a_style=f"{article(style).capitalize()} {style}", style=style, place=place, x=count(x), y=count(y), z=z
        ),
        one(FLOORS).format(
            wall=description.palette[0],
            walls=walls,
            a_floor=f"{article(ground)} {ground}",
            light=description.light.words,
        ),
    ]
    for placement, frames in PLACES.items():
        things = [phrase_for(o) for o in description.objects if o.placement == placement]
        if things:
            sentences.append(one(frames).format(things=listing(things)))
    return " ".join(sentences)
