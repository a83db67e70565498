"""The English that `wording.py` writes and `reading.py` reads: words and phrases for each term of a meaning.

The first table of each kind is what prompts are written with; what others may write besides is in the ``ALSO_`` tables.
"""

from collections.abc import Iterable, Mapping
from typing import TypeVar

from flymirage_core.language.meaning import Shape, Size, Superlative
from flymirage_core.language.scene_relations import Level, Relation, Side

T = TypeVar("T")


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


RELATIONS: Mapping[Relation, tuple[str, ...]] = {
    Relation.ON: ("on", "on top of"),
    Relation.UNDER: ("under", "underneath"),
    Relation.ABOVE: ("above",),
    Relation.BELOW: ("below", "beneath"),
    Relation.NEXT_TO: ("next to", "beside", "right next to"),
    Relation.NEAR: ("near", "close to"),
    Relation.IN_FRONT_OF: ("in front of",),
    Relation.BEHIND: ("behind",),
    Relation.LEFT_OF: ("to the left of", "left of"),
    Relation.RIGHT_OF: ("to the right of", "right of"),
}
ALSO_RELATIONS: Mapping[Relation, tuple[str, ...]] = {
    Relation.ON: ("atop", "upon", "resting on", "sitting on", "on the top of"),
    Relation.UNDER: (),
    Relation.ABOVE: ("over",),
    Relation.NEXT_TO: ("adjacent to", "alongside", "by", "by the side of", "on the side of", "at the side of"),
    Relation.NEAR: ("nearby", "not far from"),
    Relation.IN_FRONT_OF: ("before", "at the front of"),
    Relation.BEHIND: ("at the back of", "in back of"),
    Relation.LEFT_OF: ("on the left of", "on the left side of", "to the left side of", "on the left-hand side of"),
    Relation.RIGHT_OF: ("on the right of", "on the right side of", "to the right side of", "on the right-hand side of"),
}

SIDES: Mapping[Side, tuple[str, ...]] = {
    Side.LEFT: ("on your left", "to your left", "on your left-hand side", "off to your left"),
    Side.RIGHT: ("on your right", "to your right", "on your right-hand side", "off to your right"),
    Side.AHEAD: ("straight ahead", "straight ahead of you", "directly ahead", "right in front of you"),
    Side.REAR: ("behind you", "at your back"),
    Side.AHEAD_LEFT: ("ahead of you on the left", "ahead on your left"),
    Side.AHEAD_RIGHT: ("ahead of you on the right", "ahead on your right"),
    Side.REAR_LEFT: ("behind you on the left", "behind you to the left"),
    Side.REAR_RIGHT: ("behind you on the right", "behind you to the right"),
}
ALSO_SIDES: Mapping[Side, tuple[str, ...]] = {
    Side.LEFT: ("on the left", "to the left", "on the left side", "on your left side", "to the left of you", "at left"),
    Side.RIGHT: ("on the right", "to the right", "on the right side", "on your right side", "to the right of you"),
    Side.AHEAD: ("ahead", "ahead of you", "in front of you", "directly in front of you", "directly ahead of you"),
    Side.REAR: ("directly behind you", "in back of you"),
    Side.AHEAD_LEFT: ("ahead to your left", "in front of you on the left", "ahead and to your left"),
    Side.AHEAD_RIGHT: ("ahead to your right", "in front of you on the right", "ahead and to your right"),
    Side.REAR_LEFT: ("behind you and to the left", "behind and to your left"),
    Side.REAR_RIGHT: ("behind you and to the right", "behind and to your right"),
}
LEVELS: Mapping[Level, tuple[str, ...]] = {
    Level.GROUND: ("on the ground",),
    Level.WALL: ("on the wall", "hanging on the wall"),
    Level.OVERHEAD: ("overhead", "high up"),
}
ALSO_LEVELS: Mapping[Level, tuple[str, ...]] = {
    Level.GROUND: (
        "on the floor",
        "standing on the ground",
        "standing on the floor",
        "at ground level",
        "at floor level",
    ),
    Level.WALL: ("mounted on the wall", "fixed to the wall", "attached to the wall"),
    Level.OVERHEAD: ("above your head", "on the ceiling", "hanging from the ceiling"),
}

SUPERLATIVES: Mapping[Superlative, tuple[str, ...]] = {
    Superlative.LARGEST: ("largest", "biggest"),
    Superlative.SMALLEST: ("smallest",),
    Superlative.TALLEST: ("tallest",),
    Superlative.SHORTEST: ("shortest",),
    Superlative.LONGEST: ("longest",),
    Superlative.HIGHEST: ("highest",),
    Superlative.LOWEST: ("lowest",),
    Superlative.NEAREST: ("nearest", "closest"),
    Superlative.FARTHEST: ("farthest", "most distant"),
    Superlative.LEFTMOST: ("leftmost",),
    Superlative.RIGHTMOST: ("rightmost",),
}
ALSO_SUPERLATIVES: Mapping[Superlative, tuple[str, ...]] = {
    Superlative.FARTHEST: ("furthest",),
    Superlative.HIGHEST: ("topmost", "uppermost"),
    Superlative.LEFTMOST: ("left", "left-hand", "far left"),
    Superlative.RIGHTMOST: ("right", "right-hand", "far right"),
}
SUPERLATIVES_BEHIND: Mapping[Superlative, tuple[str, ...]] = {
    Superlative.NEAREST: ("closest to you", "nearest to you", "nearest you"),
    Superlative.FARTHEST: ("farthest from you", "furthest from you", "farthest away", "furthest away"),
    Superlative.LEFTMOST: ("farthest to the left", "furthest to the left"),
    Superlative.RIGHTMOST: ("farthest to the right", "furthest to the right"),
}
"""Said after the noun."""
CLOSEST_TO = ("closest to", "nearest to")
COUNTED_FROM: Mapping[Superlative, tuple[str, ...]] = {
    Superlative.LEFTMOST: ("from the left", "counted from the left"),
    Superlative.RIGHTMOST: ("from the right", "counted from the right"),
}
ORDINALS: Mapping[int, tuple[str, ...]] = {1: ("first",), 2: ("second",), 3: ("third",), 4: ("fourth",)}

SHAPES: Mapping[Shape, tuple[str, ...]] = {
    Shape.TALL: ("tall",),
    Shape.SLIM: ("slim", "slender", "narrow"),
    Shape.LOW: ("low",),
    Shape.LONG: ("long",),
    Shape.FLAT: ("flat",),
    Shape.THIN: ("thin",),
    Shape.BOXY: ("boxy", "box-shaped"),
    Shape.KNEE_HIGH: ("knee-high",),
    Shape.WAIST_HIGH: ("waist-high",),
    Shape.HEAD_HIGH: ("head-high",),
}
ALSO_SHAPES: Mapping[Shape, tuple[str, ...]] = {
    Shape.TALL: ("high", "vertical"),
    Shape.BOXY: ("cubic", "cube-shaped", "cube-like"),
    Shape.LONG: ("elongated",),
}
SIZES: Mapping[Size, tuple[str, ...]] = {Size.LARGE: ("large", "big"), Size.SMALL: ("small", "little")}
ALSO_SIZES: Mapping[Size, tuple[str, ...]] = {
    Size.LARGE: ("huge", "bigger", "larger", "big"),
    Size.SMALL: ("tiny", "smaller"),
}

_HUES = ("red", "orange", "yellow", "green", "teal", "blue", "purple", "pink", "brown", "grey", "cyan")
_SHADES = {"": ("", "bright ", "vivid "), "dark ": ("dark ", "deep ", "dark-"), "light ": ("light ", "pale ", "light-")}
COLOURS: Mapping[str, tuple[str, ...]] = {
    **{
        f"{shade}{hue}": tuple(
            f"{word}{spelled}{tail}"
            for tail in ("", "-colored", "-coloured")
            for spelled in ((hue, "gray") if hue == "grey" else (hue,))
            for word in words
        )
        for hue in _HUES
        for shade, words in _SHADES.items()
    },
    **{name: (name,) for name in ("black", "white", "beige", "olive", "tan", "gold", "silver", "turquoise")},
    "cream": ("cream", "off-white", "ivory", "cream-colored"),
}
ALSO_COLOURS: Mapping[str, tuple[str, ...]] = {
    "dark blue": ("navy", "navy blue"),
    "dark red": ("maroon", "burgundy"),
    "gold": ("golden",),
}
MATERIALS: Mapping[str, tuple[str, ...]] = {
    "wood": ("wooden", "wood", "timber"),
    "metal": ("metal", "metallic"),
    "fabric": ("fabric", "upholstered", "cloth"),
    **{
        name: (name,)
        for name in ("steel", "leather", "glass", "plastic", "ceramic", "stone", "marble", "concrete", "wicker")
    },
    **{name: (name,) for name in ("rubber", "cardboard", "velvet", "bamboo", "porcelain", "brass", "iron", "paper")},
}
ROOM_PARTS = frozenset(
    _words(
        "wall walls floor ground ceiling room corner space area scene place hall hallway corridor street view middle"
        " centre center side edge end background foreground distance point"
        " position start"
    )
)
"""Nouns of what has no box."""

DETERMINERS = ("the", "a", "an", "that", "this", "some")
PRONOUNS = ("it", "them", "there", "that one", "this one", "its", "their", "the drone", "the uav", "you", "yourself")
PASSING = ("past", "around", "along", "through", "from", "across", "avoiding", "beyond", "away from", "passing")
"""A thing after one of these lies on the way."""
LINKS = ("that is", "that's", "which is", "that are", "which are", "that stands", "that hangs", "located", "placed")
LINKS_MORE = _words(
    "standing sitting positioned situated hanging resting lying mounted seen visible directly just right immediately"
    " found leaning set nestled tucked"
)
UNCHECKED_LEADS = _words(
    "with in at inside against made having featuring facing opposite containing full whose used along of into out"
    " surrounded attached built"
)
"""What these begin is not checked against boxes, and so must not be what singles the target out."""

MOTION = _words(
    "fly go head move navigate proceed travel approach reach find locate search look steer hover stop halt wait stay"
    " land make take bring get spot see identify seek drift glide cruise advance come continue descend ascend climb"
    " rise turn face visit inspect drop float set aim pass follow watch keep finish end arrive return make rotate lift"
    " flying heading moving going direct guide position check show let begin start maneuver manoeuvre pilot send"
    " to toward towards for up over down forward forwards across until into out off before closer close near nearer"
    " at on in by until you've reached have reached is are can will your you me us my way course goal target"
    " destination aim there here now then next first finally after afterwards lastly and please just simply slowly"
    " carefully gently directly steadily once within when over"
    " slightly bit little upward upwards downward downwards straight ahead level altitude height"
    " speed"
    " ready so as could would its their object's position location spot i want need like should must trip flight"
    " drone uav"
)
"""Words around the names of things; none of them says which thing."""
TURNS: Mapping[Side, tuple[str, ...]] = {
    Side.LEFT: ("turn left", "turn to your left", "turn to the left", "rotate left", "veer left", "bear left"),
    Side.RIGHT: ("turn right", "turn to your right", "turn to the right", "rotate right", "veer right", "bear right"),
    Side.REAR: ("turn around", "turn round"),
    Side.AHEAD: ("fly straight ahead", "go straight ahead", "move straight ahead", "continue straight ahead"),
}


def phrases(*tables: Mapping[T, Iterable[str]]) -> dict[tuple[str, ...], T]:
    """The tables turned round: what each phrase, as its words, stands for."""
    return {tuple(phrase.split()): meant for table in tables for meant, spelled in table.items() for phrase in spelled}
