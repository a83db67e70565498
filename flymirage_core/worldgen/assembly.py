"""From a description to all things of its world, in world coordinates: building, objects, and what holds them up."""

from dataclasses import dataclass

import numpy as np

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.keys import rng as seeded
from flymirage_core.worldgen.backdrop import beyond
from flymirage_core.worldgen.building import ceiling_at, indoor
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.furnishing import furnish
from flymirage_core.worldgen.materials import material_named
from flymirage_core.worldgen.outdoors import outdoor
from flymirage_core.worldgen.parts import Finish, paint, tube
from flymirage_core.worldgen.place import Opening, Place, Space, Wall, place_for
from flymirage_core.worldgen.sky import Sky, exposure_of, sky_of
from flymirage_core.worldgen.structure import Structure, placed
from flymirage_core.worldgen.surfaces import Part
from flymirage_core.worldgen.truth import FreeBox, PlacedObject, Point, WorldTruth

SECOND = {"wood": "walnut brown", "metal": "charcoal", "fabric": "chocolate", "plain": "charcoal", "stone": "charcoal"}
"""Colours of legs and frames by the main material's texture."""
ROD = 0.012
"""Metres: radius of what hanging things hang by."""


@dataclass(frozen=True, eq=False)
class Thing:
    """What is cut and lit as one: a piece of the building, or an object (``object_id`` >= 0). World coordinates."""

    parts: list[Part]
    object_id: int = -1
    shines: bool = True  # as a lamp, if it glows


@dataclass(frozen=True, eq=False)
class Assembly:
    """A whole world before it is cut into surfels."""

    place: Place
    truth: WorldTruth
    things: list[Thing]
    sky: Sky
    brightness: float

    @property
    def parts(self) -> list[Part]:
        return [p for t in self.things for p in t.parts]


def assemble(description: SceneDescription) -> Assembly:
    """The world of a description. All randomness comes from the scene's key."""
    place, sky, structures, truth = _planned(description)
    rng = seeded(description.scene, "beyond")
    if place.open_air:
        structures = structures + beyond(place, daylight_of(sky), rng)
    things = [Thing(s.parts, shines=s.shines) for s in structures]
    for placed_object in truth.objects:
        parts = object_parts(placed_object, description.scene)
        things.append(Thing(parts, placed_object.object_id))
        rod = _rod(placed_object, place)
        if rod:
            things.append(Thing(rod))
    return Assembly(place, truth, things, sky, exposure_of(place.light))


def build_truth(description: SceneDescription) -> WorldTruth:
    """What the embedded world model puts where, for measuring; the world itself never carries it."""
    return _planned(description)[3]


def _planned(description: SceneDescription) -> tuple[Place, Sky, list[Structure], WorldTruth]:
    place = place_for(description)
    sky = sky_of(place.light, place.seed)
    structures = structures_of(place, sky, seeded(description.scene, "structure"))
    found = furnish(place, structures, description.objects, seeded(description.scene, "layout"))
    size = place.bounds[1] - place.bounds[0]
    truth = WorldTruth(
        description.scene,
        (float(size[0]), float(size[1]), float(size[2])),
        found.centre,
        found.objects,
        (*place.unplaced, *found.unplaced),
        tuple(_free_box(s) for s in place.spaces),
        tuple(s for structure in structures for s in structure.solids),
        tuple(_corners(w, o) for s in place.spaces for w in s.walls for o in w.openings),
    )
    return place, sky, structures, truth


def structures_of(place: Place, sky: Sky, rng: np.random.Generator) -> list[Structure]:
    """All that is built of the place's spaces, which drones fly in and between."""
    result: list[Structure] = []
    for space in place.spaces:
        build = outdoor if space.open_air else indoor
        result += build(space, place, daylight_of(sky), rng)
    return result


def daylight_of(sky: Sky) -> float:
    """The sky's brightness: 1 on a clear day."""
    return float(sky.zenith.mean() / 3.6)


def object_parts(o: PlacedObject, scene: str) -> list[Part]:
    """The parts of one placed object, in world coordinates. Things of one kind and colour in a scene share a style."""
    main = material_named(f"{o.state} {o.material}", o.colour, o.seed % 9973)
    texture = "wood" if main.texture in ("wood", "fabric") else "metal"
    accent = paint(SECOND.get(main.texture, "charcoal"), texture, seed=o.seed % 997)
    style = int(seeded(scene, f"style of {o.colour} {o.noun}").integers(1 << 30))
    finish = Finish(main, accent, o.seed, style)
    return placed(kind_of(o.noun).build(o.size, finish), (*o.centre[:2], o.bottom), o.yaw)


def _rod(o: PlacedObject, place: Place) -> list[Part]:
    """What a thing hangs by if it does not touch the ceiling: a rod, in the open air a cable across the space."""
    space = place.space(o.zone)
    if o.placement != "hanging" or space is None:
        return []
    x, y, _ = o.centre
    black = paint("charcoal", "metal")
    if not space.open_air:
        ceiling = ceiling_at(space, np.array(o.centre[:2]))
        return tube(black, [(x, y, o.top - 0.02), (x, y, ceiling)], ROD) if ceiling - o.top > 0.05 else []
    across = int(np.argmin(space.size))
    ends = np.tile([x, y, o.top + 0.25], (2, 1))
    ends[:, across] = space.low[across], space.high[across]
    return tube(black, [ends[0], (x, y, o.top), ends[1]], ROD)


def _free_box(space: Space) -> FreeBox:
    low, high = space.low, space.high
    top = max(space.height, 10.0) if space.open_air else space.height
    return FreeBox(
        space.zone.name, space.zone.kind, (float(low[0]), float(low[1]), 0.0), (float(high[0]), float(high[1]), top)
    )


def _corners(wall: Wall, o: Opening) -> tuple[Point, Point]:
    a, b = wall.at(o.left, 0.0), wall.at(o.right, 0.0)
    low, high = np.minimum(a, b), np.maximum(a, b)
    return (float(low[0]), float(low[1]), o.bottom), (float(high[0]), float(high[1]), o.top)
