"""`furnish`: a description's objects placed in its spaces, honouring its words, never through each other.

Large things first: along the walls, then groups in the open, then what belongs to them, stands on them, and hangs on
walls and overhead.
"""

from dataclasses import dataclass

import numpy as np

from flymirage_core.scene.design import PlannedObject
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.footprints import Occupied, Solid
from flymirage_core.worldgen.layout import FREE_BALL, Layout
from flymirage_core.worldgen.place import Place
from flymirage_core.worldgen.placers import PLACERS
from flymirage_core.worldgen.structure import Structure
from flymirage_core.worldgen.truth import PlacedObject, Unplaced

TRIES = 250
"""Random spots that are tried for c."""


@dataclass(frozen=True)
class Furnished:
    """What `furnish` found: c, the objects in their places, and those without one."""

    centre: tuple[float, float, float]
    objects: tuple[PlacedObject, ...]
    unplaced: tuple[Unplaced, ...]


def furnish(
    place: Place, structures: list[Structure], objects: tuple[PlannedObject, ...], rng: np.random.Generator
) -> Furnished:
    """Put the planned objects into the place, round what the building takes up. c comes first."""
    occupied, clear = Occupied(), Occupied()
    for structure in structures:
        for solid in structure.solids:
            occupied.add(solid)
        for solid in structure.clear:
            clear.add(solid)
    layout = Layout(place, _centre(place, occupied, rng), rng, occupied=occupied, kept_clear=clear)
    _keep_ways_clear(layout)
    for placement, placer in PLACERS.items():
        for planned in sorted((o for o in objects if o.placement == placement), key=_footprint, reverse=True):
            space = place.space(planned.zone)
            if space is None:
                layout.miss(planned.noun, "no free spot for its zone", planned.count)
            else:
                placer(layout, space, planned, kind_of(planned.noun))
    missing = tuple(Unplaced(noun, count, reason) for (noun, reason), count in layout.missing.items())
    return Furnished(layout.centre, tuple(layout.objects), missing)


def _centre(place: Place, occupied: Occupied, rng: np.random.Generator) -> tuple[float, float, float]:
    """c: near the main space's middle, at a head's height, clear of the building itself."""
    main = place.spaces[0]
    height = min(1.5, main.height - 1.2)
    best, most = (0.0, 0.0, height), -1.0
    for _ in range(TRIES):
        share = rng.uniform(-0.12, 0.12, 2)
        spot = main.middle + share * main.size * (main.size > 4.0)
        point = (round(float(spot[0]), 3), round(float(spot[1]), 3), round(height + float(rng.uniform(-0.1, 0.1)), 3))
        free = min((s.distance_to(point) for s in occupied.solids()), default=9.0)
        if free > most:
            best, most = point, free
        if free > FREE_BALL + 0.1:
            break
    return best


def _keep_ways_clear(layout: Layout) -> None:
    """From every door and doorway to the middle of its space there is a way."""
    for space in layout.place.spaces:
        for wall in space.walls:
            for opening in (o for o in wall.openings if o.kind == "doorway"):
                start = wall.at((opening.left + opening.right) / 2, 0.0)
                way = space.middle - start
                length = float(np.hypot(*way))
                x, y = start + way / 2
                yaw = float(np.arctan2(way[1], way[0]))
                layout.kept_clear.add(Solid(float(x), float(y), length, 0.8, 0.0, 2.0, yaw))


def _footprint(planned: PlannedObject) -> float:
    """Floor area and height: what is placed first. Rugs come last, when it is known what stands on them."""
    kind = kind_of(planned.noun)
    x, y, z = kind.largest
    return 0.0 if kind.flat else x * y * (1 + z)
