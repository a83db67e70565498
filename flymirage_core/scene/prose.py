"""A description's facts as a few sentences for people, and as a prompt for image and world models."""

import numpy as np

from flymirage_core.scene.description import PlannedObject, SceneDescription

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")
IRREGULAR = {"bookshelf": "bookshelves", "low bookshelf": "low bookshelves", "wall shelf": "wall shelves"}
PLURALS = {
    "stack of books": "stacks of books",
    "pallet of sacks": "pallets of sacks",
    "chest of drawers": "chests of drawers",
    **IRREGULAR,
}
OPENINGS = (
    "{article} {style} {place}, about {x:.0f} by {y:.0f} metres under a ceiling of {z:.1f} metres.",
    "This {place} is {style} in character and measures roughly {x:.0f} by {y:.0f} metres, {z:.1f} metres high.",
    "Some {x:.0f} metres long and {y:.0f} wide, the {place} is {style}; its ceiling is {z:.1f} metres up.",
    "The {place} is a {x:.0f} by {y:.0f} metre room, {style} in style, with {z:.1f} metres of headroom.",
)
FLOORS = (
    "Between {wall} {walls} lies a {colour} {floor}, and the place has {light}.",
    "Underfoot is a {colour} {floor}; the {walls} are {wall}, and there is {light}.",
    "It has {wall} {walls}, a {colour} {floor} and {light}.",
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
    count = NUMBERS[planned.count] if planned.count < len(NUMBERS) else str(planned.count)
    return f"{count} {words} {plural(planned.noun)}"


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
    style, floor, walls = (part.strip() for part in description.style.split(","))
    place = description.subcategory
    sentences = [
        one(OPENINGS).format(article=article(style).capitalize(), style=style, place=place, x=x, y=y, z=z),
        one(FLOORS).format(
            wall=description.palette[0],
            walls=walls,
            colour=description.palette[1],
            floor=floor,
            light=description.light,
        ),
    ]
    for placement, frames in PLACES.items():
        things = [phrase_for(o) for o in description.objects if o.placement == placement]
        if things:
            sentences.append(one(frames).format(things=listing(things)))
    return " ".join(sentences)
