"""What the offline writer knows of places and things, as data: nouns, kits, looks, lights and subcategories.

The files beside this one say in their "about" what their fields mean; here they are read and checked.
"""

import json
from functools import cache
from importlib import resources
from typing import Any, NamedTuple, get_args

from pydantic import BaseModel, ConfigDict

from flymirage_core.scene.design import OUTDOOR_KINDS, LightSource, Placement, SurfacePart, TimeOfDay, ZoneKind

Range = tuple[float, float]


class Datum(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Noun(Datum):
    """A kind of thing: where it may go, its typical size (x, y, z) in metres, what it is made of."""

    placements: tuple[Placement, ...]
    size: tuple[float, float, float]
    finish: str
    holds: int = 0
    plural: str = ""
    states: tuple[str, ...] = ()
    strung: bool = False  # it may hang where there is no ceiling

    @property
    def unsaid(self) -> bool:
        """Whether nobody names its material: a red car, a green tree."""
        return self.finish in _unsaid()

    @property
    def finishes(self) -> dict[str, list[str]]:
        """Material -> its colours."""
        return finishes()[self.finish]


class Want(NamedTuple):
    """A kind of thing at a kind of spot."""

    noun: str
    placement: Placement
    relative_to: str = ""


class Row(NamedTuple):
    """One line of a kit."""

    least: int
    most: int
    want: Want


class Side(Datum):
    """A small space beside the main one."""

    name: str
    kind: ZoneKind
    range: tuple[Range, Range, Range]
    kits: tuple[str, ...]


class Place(Datum):
    """What a subcategory is like."""

    kind: ZoneKind
    range: tuple[Range, Range, Range]
    look: str
    light: tuple[str, ...]
    fillers: str
    kits: tuple[str, ...]
    options: tuple[str, ...]
    notes: tuple[str, ...]
    side: Side | None = None

    @property
    def outdoor(self) -> bool:
        return self.kind in OUTDOOR_KINDS


class Look(Datum):
    """Styles and eras that go together, and what surfaces are made of: part -> material -> colours.

    Things in an ``aged`` one show their age more often.
    """

    styles: tuple[str, ...]
    eras: tuple[str, ...]
    surfaces: dict[SurfacePart, dict[str, tuple[str, ...]]]
    aged: bool = False


class LightProfile(Datum):
    """A way of lighting a place."""

    times: tuple[TimeOfDay, ...]
    skies: tuple[str, ...]
    sources: tuple[LightSource, ...]
    words: tuple[str, ...]


@cache
def _file(name: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(resources.files("flymirage_core.scene").joinpath(name).read_text())
    return data


@cache
def finishes() -> dict[str, dict[str, list[str]]]:
    """Finish -> material -> colours."""
    found: dict[str, dict[str, list[str]]] = _file("nouns.json")["finishes"]
    return found


@cache
def _unsaid() -> frozenset[str]:
    return frozenset(_file("nouns.json")["unsaid"])


def ageing(material: str) -> list[str]:
    """The states that show the age of a material: rusty steel, worn oak."""
    found: list[str] = _file("nouns.json")["ageing"].get(material, [])
    return found


def part_of(noun: str) -> str:
    """The part that a noun's finish is about, if it is not the whole: a plant's pot, a painting's frame."""
    known = nouns().get(noun)
    return str(_file("nouns.json")["parts"].get(known.finish, "")) if known else ""


@cache
def nouns() -> dict[str, Noun]:
    """All nouns that the writer uses. The embedded world can build each (tests/scene/test_scene_nouns.py)."""
    return {name: Noun(**fields) for name, fields in _file("nouns.json")["nouns"].items()}


@cache
def kits() -> dict[str, tuple[Row, ...]]:
    """Kit -> its rows."""
    return {name: tuple(_row(text) for text in texts) for name, texts in _file("kits.json")["kits"].items()}


def _row(text: str) -> Row:
    """ "2-3 armchair facing coffee table" """
    span, *words = text.split()
    least, most = (int(n) for n in span.split("-"))
    for i in range(1, len(words)):
        noun, placement, anchor = " ".join(words[:i]), words[i], " ".join(words[i + 1 :])
        if noun in nouns() and placement in get_args(Placement) and (not anchor or anchor in nouns()):
            return Row(least, most, Want(noun, placement, anchor))  # type: ignore[arg-type]
    raise ValueError(f"kit row {text!r}: expected least-most, a known noun, a placement and perhaps another noun")


@cache
def places() -> dict[str, Place]:
    """Subcategory -> what it is like."""
    return {name: Place(**fields) for name, fields in _file("places.json")["places"].items()}


@cache
def looks() -> dict[str, Look]:
    return {name: Look(**fields) for name, fields in _file("places.json")["looks"].items()}


def eras_of(style: str, look: Look) -> tuple[str, ...]:
    """The decades in which a style was built; of a timeless one, the look's."""
    return tuple(_file("places.json")["dated"].get(style, look.eras))


@cache
def lights() -> dict[str, LightProfile]:
    return {name: LightProfile(**fields) for name, fields in _file("places.json")["lights"].items()}


@cache
def fillers() -> dict[str, tuple[str, ...]]:
    """Name -> nouns that may be added until a place is full."""
    return {name: tuple(found) for name, found in _file("places.json")["fillers"].items()}
