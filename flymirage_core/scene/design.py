"""`SceneDesign`: a place in words and numbers, the one schema that an LLM and the offline writer both fill.

The fields' descriptions are what an LLM reads (`asking.strict_schema`). Lengths in metres; zones and the whole are
given as (x, y, z) = length, width, height.
"""

from collections import Counter
from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

ZoneKind = Literal[
    "room", "corridor", "hall", "gallery", "industrial_floor", "tunnel", "courtyard", "street", "yard", "rooftop"
]
Placement = Literal[
    "against_wall", "on_floor", "on_surface", "on_wall", "hanging", "around", "in_row", "facing", "beside"
]
SurfacePart = Literal["floor", "walls", "ceiling", "ground", "facades", "roof"]
LightSource = Literal[
    "sun",
    "sky",
    "windows",
    "skylights",
    "ceiling_lamps",
    "hanging_lamps",
    "wall_lamps",
    "street_lamps",
    "neon",
    "work_lights",
]
TimeOfDay = Literal["dawn", "morning", "noon", "afternoon", "dusk", "night"]
OUTDOOR_KINDS = frozenset({"courtyard", "street", "yard", "rooftop"})
NEEDS_ANOTHER = frozenset({"around", "facing", "beside"})
"""Placements that mean nothing without `PlannedObject.relative_to`."""
MOST_OBJECTS = 250
"""In all; the paper's scenes have 60 to 100."""
Size = tuple[float, float, float]


class Part(BaseModel):
    """A part of a design: immutable, and unknown fields are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Surface(Part):
    """What one kind of surface of a zone is made of."""

    part: SurfacePart = Field(description="floor, walls, ceiling indoors; ground, facades, roof outdoors")
    colour: str = Field(min_length=1, description='plain colour name, e.g. "terracotta", "light grey"')
    material: str = Field(min_length=1, description='what it is made of, e.g. "brick", "oak plank", "asphalt"')


class Zone(Part):
    """One connected space of the scene."""

    name: str = Field(min_length=1, description='unique short name, e.g. "main hall"')
    kind: ZoneKind = Field(description="what sort of space it is; courtyard, street, yard and rooftop are open air")
    dimensions: Size = Field(description="length x, width y and clear height z in metres (open air: height of facades)")
    surfaces: tuple[Surface, ...] = Field(description="its floor or ground, its walls or facades, its ceiling")
    connects_to: tuple[str, ...] = Field(description="names of the zones that one can walk (and fly) into from here")
    windows: int = Field(ge=0, le=60, description="how many windows its walls or facades have")


class Light(Part):
    """What lights the scene."""

    time_of_day: TimeOfDay
    sky: Literal["clear", "overcast", "none"] = Field(description='"none" where no sky is seen, as underground')
    sources: tuple[LightSource, ...] = Field(min_length=1, description="all that gives light, the strongest first")
    words: str = Field(min_length=1, description='the light in a few words, e.g. "low sun through tall windows"')


class PlannedObject(Part):
    """One kind of thing, of one colour and material, and where its pieces go."""

    noun: str = Field(min_length=1, description='singular common noun, no colour or material in it, e.g. "bookshelf"')
    count: int = Field(ge=1, le=60, description="how many of them")
    colour: str = Field(min_length=1, description='plain colour name, e.g. "forest green"')
    material: str = Field(min_length=1, description='what it is made of, e.g. "oak", "painted steel"')
    size: Literal["small", "medium", "large"] = Field(default="medium", description="compared with others of its kind")
    state: str = Field(default="", description='a visible condition, e.g. "open", "rusty", "half full"; "" if none')
    placement: Placement = Field(
        description="against_wall: its back to a wall; on_floor: in the open, also on the ground; on_surface: on "
        "something; on_wall: fixed to a wall; hanging: from the ceiling or overhead; around: seats round a thing; "
        "in_row: in straight rows; facing: turned to a thing; beside: next to a thing"
    )
    relative_to: str = Field(
        default="", description='noun of another listed object it is on, around, facing, beside or over; "" if none'
    )
    zone: str = Field(default="", description='name of its zone; "" for the first')


class SceneDesign(Part):
    """A place that an aerial robot could fly through, in words and numbers."""

    title: str = Field(min_length=1, description='a few words, e.g. "Post-war boiler room"')
    setting: Literal["indoor", "outdoor"] = Field(description="outdoor where the main zone is open air")
    dimensions: Size = Field(description="length x, width y and height z in metres of the whole")
    zones: tuple[Zone, ...] = Field(description="the spaces it consists of, the main one first; often only one")
    style: str = Field(description='architectural or decorative style, e.g. "art deco"')
    era: str = Field(description='when it was made or refurbished, e.g. "1970s"')
    palette: tuple[str, ...] = Field(description="three to six colour names that set its mood, the walls' first")
    light: Light
    objects: tuple[PlannedObject, ...] = Field(description="everything in it, 60 to 100 pieces in all, near and high")
    prose: str = Field(description="what a person would read: one paragraph of plain whole sentences")
    image_prompt: str = Field(description="prompt for an image model: one wide eye-level view of it without people")
    world_prompt: str = Field(description="prompt for a 3D world model: space, layout, materials, light; no people")

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        self.check()
        return self

    def check(self) -> None:
        """Raise `ValueError` with one sentence for the first thing that does not fit together."""
        if not self.zones:
            raise ValueError("zones is empty; a scene needs at least one zone")
        for where, size in [("the scene", self.dimensions), *((f"zone {z.name!r}", z.dimensions) for z in self.zones)]:
            if not all(0 < length <= 300 for length in size):
                raise ValueError(f"dimensions {size} of {where}: expected metres above 0 and up to 300")
        _check_zones(self.zones)
        _check_objects(self.objects, {z.name for z in self.zones})


def _check_zones(zones: tuple[Zone, ...]) -> None:
    names = Counter(z.name for z in zones)
    twice = [name for name, n in names.items() if n > 1]
    if twice:
        raise ValueError(f"zone name {twice[0]!r} is used {names[twice[0]]} times; every zone needs its own name")
    for zone in zones:
        for other in zone.connects_to:
            if other not in names or other == zone.name:
                raise ValueError(f"zone {zone.name!r} connects to {other!r}; expected another of {sorted(names)}")


def _check_objects(objects: tuple[PlannedObject, ...], zones: set[str]) -> None:
    total = sum(o.count for o in objects)
    if total > MOST_OBJECTS:
        raise ValueError(f"{total} objects are planned; at most {MOST_OBJECTS} are allowed")
    nouns = {o.noun for o in objects}
    for planned in objects:
        if planned.zone and planned.zone not in zones:
            raise ValueError(f"object {planned.noun!r} is in zone {planned.zone!r}; expected one of {sorted(zones)}")
        if planned.relative_to and planned.relative_to not in nouns:
            raise ValueError(
                f"object {planned.noun!r} is {planned.placement} {planned.relative_to!r}, which is not among the "
                "objects; name a listed noun exactly"
            )
        if planned.placement in NEEDS_ANOTHER and not planned.relative_to:
            raise ValueError(f"object {planned.noun!r} is placed {planned.placement!r}; relative_to must say of what")
