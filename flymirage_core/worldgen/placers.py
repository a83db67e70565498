"""Where each kind of placement goes: along walls, in rows, on the floor, round and on other things, overhead.

Each thing is tried at seeded random spots; the first that is free is taken. What finds no spot is reported, not
squeezed in.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from flymirage_core.scene.design import PlannedObject
from flymirage_core.worldgen.building import ceiling_at
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.footprints import Solid
from flymirage_core.worldgen.kinds import Kind
from flymirage_core.worldgen.layout import Layout, Size
from flymirage_core.worldgen.place import Space, Wall
from flymirage_core.worldgen.truth import PlacedObject

CHAIR_SPACE = 0.5
"""Metres kept free round a table in the open, on top of the walkway."""
WALL_GAP = 0.03
"""Between furniture and its wall, and between a picture's back and the wall's face."""
SIDE_GAP = 0.14
"""Between neighbours along a wall."""
PASSAGE = 1.0
"""Between tall groups in the open: a drone's corridor at any height."""
WALKWAY = 0.6
"""Between a low group in the open and anything else; half of it where there is no room for more."""
TALL = 1.0
"""Metres; higher things need a `PASSAGE` round them unless they stand at a wall."""
TABLE_GAP = 0.05
"""Between a chair and its table, and between things on a table."""
PICTURE_GAP = 0.12
FRONT_OF_PICTURE = 0.35
"""Nothing stands this close before a thing on the wall."""
HIGH_UP = {
    "balcony": 2.75,
    "awning": 2.2,
    "shop sign": 2.2,
    "basketball hoop": 2.3,
    "loudspeaker": 2.4,
    "satellite dish": 2.3,
}
"""Metres: undersides of what is on a wall over people's heads, where the wall is high enough."""
LOW_HANGING = 1.95
"""Nothing hangs lower than this, except over a table."""
HANGING_AT = (2.1, 3.0)
"""Heights of the undersides of what hangs in high spaces and in the open air."""
TRIES = 250
"""Random spots that are tried for one object or group."""


def _solid_walls(space: Space) -> list[Wall]:
    return [w for w in space.walls if w.enclosure != "open"]


def _place_against_wall(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    for _ in range(planned.count):
        size = layout.size(space, planned, kind)
        solid = layout.first(space, _spots_along_walls(layout, space, size, 0.0), SIDE_GAP)
        if solid is None:
            layout.miss(planned.noun, "no free stretch of wall")
        else:
            layout.put(planned, space, solid)


def _spots_along_walls(layout: Layout, space: Space, size: Size, bottom: float) -> Iterator[Solid]:
    walls = [w for w in _solid_walls(space) if bottom == 0 or bottom + size[2] <= w.height]
    lengths = np.array([w.length for w in walls])
    for _ in range(TRIES if walls else 0):
        wall = walls[int(layout.rng.choice(len(walls), p=lengths / lengths.sum()))]
        along = layout.rng.uniform(size[0] / 2 + 0.1, max(wall.length - size[0] / 2 - 0.1, size[0] / 2 + 0.11))
        x, y = wall.at(along, WALL_GAP + size[1] / 2)
        yield Solid(float(x), float(y), size[0], size[1], bottom, bottom + size[2], wall.yaw)


def _place_in_row(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """Side by side, as many in one row as find room: six at most, else fewer."""
    size = layout.size(space, planned, kind)
    left = planned.count
    while left > 0:
        for count in range(min(left, 6), 0, -1):
            pitch = size[0] + SIDE_GAP
            row = (count * pitch - SIDE_GAP, size[1], size[2])
            if max(row[:2]) > max(space.size):
                continue
            spots = _spots_in_the_open(layout, space, row) if count > 1 else _spots_anywhere(layout, space, row)
            solid = layout.first(space, spots, PASSAGE if size[2] > TALL else WALKWAY)
            if solid is not None:
                for i in range(count):
                    shift = (i - (count - 1) / 2) * pitch
                    layout.put(planned, space, solid.shifted(shift, 0.0, size[0], size[1]))
                left -= count
                break
        else:
            layout.miss(planned.noun, "no free floor for a row", left)
            return


def _spots_in_the_open(layout: Layout, space: Space, size: Size) -> Iterator[Solid]:
    """Anywhere on the floor, square to the walls."""
    for _ in range(TRIES):
        yaw = float(layout.rng.integers(4)) * np.pi / 2
        spot = space.middle + layout.rng.uniform(-0.5, 0.5, 2) * (space.size - 0.3)
        yield Solid(float(spot[0]), float(spot[1]), size[0], size[1], 0.0, size[2], yaw)


def _spots_anywhere(layout: Layout, space: Space, size: Size) -> Iterator[Solid]:
    """For things that stand alone: tall ones near the walls, low ones anywhere."""
    walls = _solid_walls(space)
    for solid in _spots_in_the_open(layout, space, size):
        if size[2] <= TALL or not walls:
            yield solid
            continue
        wall = walls[int(layout.rng.integers(len(walls)))]
        along = layout.rng.uniform(0.1, 0.9) * wall.length
        x, y = wall.at(along, max(size[:2]) / 2 + layout.rng.uniform(0.05, 0.35))
        yield Solid(float(x), float(y), size[0], size[1], 0.0, size[2], wall.yaw)


def _place_on_floor(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """Large things in the open with a passage round them; small ones wherever there is a gap; rugs under things."""
    if kind.flat:
        _spread_rugs(layout, space, planned, kind)
        return
    for _ in range(planned.count):
        own = layout.size(space, planned, kind)
        small = max(own[:2]) < 0.9 or kind.full_height
        gap = PASSAGE if own[2] > TALL or kind.full_height else WALKWAY
        spots = _spots_in_the_open(layout, space, own)
        if small and not kind.full_height:
            spots, gap = _spots_anywhere(layout, space, own), SIDE_GAP if own[2] < TALL else 0.2
        elif 0.6 <= own[2] <= TALL:  # a table: keep its chairs' places free as well
            gap += CHAIR_SPACE
        solid = layout.first(space, spots, gap)
        if solid is None:
            nearer = max(gap / 2, SIDE_GAP) if own[2] <= TALL else WALKWAY
            solid = layout.first(space, _spots_in_the_open(layout, space, own), nearer)
        if solid is None:
            layout.miss(planned.noun, "no free floor")
        else:
            layout.put(planned, space, solid)


def _spread_rugs(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """Centred under the named things, else in the space's middle; a rug takes nobody's place."""
    spots = [(o.centre[0], o.centre[1], o.yaw) for o in layout.named(planned, space)]
    spots.append((float(space.middle[0]), float(space.middle[1]), 0.0))
    for i in range(planned.count):
        x, y, z = layout.size(space, planned, kind)
        u, v, yaw = spots[min(i, len(spots) - 1)]
        reach = Solid(u, v, x, y, 0.0, z, yaw).reach + 0.05
        if (2 * reach > space.size).any():
            layout.miss(planned.noun, "no free floor")
            continue
        u, v = np.clip([u, v], space.low + reach, space.high - reach)
        layout.put(planned, space, Solid(float(u), float(v), x, y, 0.0, z, yaw))


def _place_around(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """On the sides of what it belongs to, facing it, evenly shared among all of its kind."""
    size, left = layout.size(space, planned, kind), planned.count
    anchors = layout.named(planned, space)
    for number, anchor in enumerate(sorted(anchors, key=lambda o: layout.anchored.get(o.object_id, 0))):
        share = int(np.ceil(left / (len(anchors) - number)))
        for solid in _seats(anchor, size, share, layout.rng):
            if share == 0 or left == 0:
                break
            if layout.fits_clear(space, solid, TABLE_GAP * 0.9):
                layout.put(planned, space, solid)
                layout.anchored[anchor.object_id] = layout.anchored.get(anchor.object_id, 0) + 1
                share, left = share - 1, left - 1
    if left:
        layout.miss(planned.noun, f"no free place at a {planned.relative_to}", left)


def _seats(anchor: PlacedObject, size: Size, wanted: int, rng: np.random.Generator) -> Iterator[Solid]:
    """Places round an anchor for ``wanted`` seats: its long sides first, then its ends."""
    for side in range(4):
        turn = (0, 2, 1, 3)[side] * np.pi / 2
        length = anchor.size[0] if side < 2 else anchor.size[1]
        reach = (anchor.size[1] if side < 2 else anchor.size[0]) / 2
        count = max(1, min(int(length / (size[0] + 0.12)), (wanted + 1) // 2))
        for i in range(count):
            shift = (i + 0.5) * length / count - length / 2
            distance = reach + size[1] / 2 + TABLE_GAP + 0.03 + rng.uniform(0.0, 0.08)
            yield _near(anchor, shift, distance, turn, anchor.yaw + turn + np.pi + rng.uniform(-0.1, 0.1), size)


def _near(anchor: PlacedObject, shift: float, distance: float, turn: float, yaw: float, size: Size) -> Solid:
    """A thing on the floor ``distance`` from an anchor's middle, on the side that ``turn`` turns its front to."""
    c, s = np.cos(turn), np.sin(turn)
    local = np.array([shift * c - distance * s, shift * s + distance * c])
    x, y = np.asarray(anchor.centre[:2]) + local @ anchor.axes
    return Solid(float(x), float(y), size[0], size[1], 0.0, size[2], float(yaw))


def _place_facing(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """Turned to the named thing, at its front first, a step or two away."""
    for _ in range(planned.count):
        size, anchors = layout.size(space, planned, kind), layout.named(planned, space)
        spots = (s for a in anchors for s in _opposite(a, size, layout.rng))
        solid = layout.first(space, spots, SIDE_GAP)
        if solid is None:
            layout.miss(planned.noun, f"no free place before a {planned.relative_to}")
        else:
            layout.put(planned, space, solid)


def _opposite(anchor: PlacedObject, size: Size, rng: np.random.Generator) -> Iterator[Solid]:
    for n in range(TRIES // 4):
        turn = (0.0, np.pi / 2, -np.pi / 2, np.pi)[min(n // 24, 3)] + rng.uniform(-0.35, 0.35)
        distance = max(anchor.size[:2]) / 2 + size[1] / 2 + rng.uniform(0.5, 2.4)
        yield _near(anchor, 0.0, distance, turn, anchor.yaw + turn + np.pi, size)


def _place_beside(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """Next to the named thing, looking the way it does."""
    for _ in range(planned.count):
        size, anchors = layout.size(space, planned, kind), layout.named(planned, space)
        spots = (s for a in anchors for s in _next_to(a, size, layout.rng))
        solid = layout.first(space, spots, 0.02)
        if solid is None:
            layout.miss(planned.noun, f"no free place beside a {planned.relative_to}")
        else:
            layout.put(planned, space, solid)


def _next_to(anchor: PlacedObject, size: Size, rng: np.random.Generator) -> Iterator[Solid]:
    """At its right or left, backs in line; then anywhere close round it."""
    axes, middle = anchor.axes, np.asarray(anchor.centre[:2])
    for n in range(TRIES // 4):
        side = (-1, 1)[int(rng.integers(2))]
        right = side * (anchor.size[0] / 2 + size[0] / 2 + rng.uniform(0.06, 0.25 + 0.01 * n))
        back = (size[1] - anchor.size[1]) / 2
        if n > TRIES // 8:
            right, back = (
                rng.uniform(-1, 1) * anchor.size[0] / 2,
                anchor.size[1] / 2 + size[1] / 2 + rng.uniform(0.1, 0.5),
            )
        x, y = middle + np.array([right, back]) @ axes
        yield Solid(float(x), float(y), size[0], size[1], 0.0, size[2], anchor.yaw)


def _place_on_surface(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """On top of what the description names, else of anything that has a top; emptiest first."""
    for _ in range(planned.count):
        own = layout.size(space, planned, kind)
        supports = [o for o in layout.objects if _top_share(o) > 0 and o.zone == space.zone.name]
        supports = [o for o in supports if planned.relative_to in ("", o.noun)]
        carried = {o.object_id: sum(p.support == o.object_id for p in layout.objects) for o in supports}
        for support in sorted(supports, key=lambda o: carried[o.object_id] / (o.size[0] * o.size[1])):
            spots = _spots_on(support, own, layout.rng)
            solid = next((s for s in spots if layout.fits(space, s, TABLE_GAP)), None)
            if solid is not None:
                layout.put(planned, space, solid, support.object_id)
                break
        else:
            layout.miss(planned.noun, f"no free place on a {planned.relative_to or 'surface'}")


def _top_share(placed: PlacedObject) -> float:
    return kind_of(placed.noun).top


def _spots_on(support: PlacedObject, size: Size, rng: np.random.Generator) -> Iterator[Solid]:
    """On the support, facing its front."""
    free = np.asarray(support.size[:2]) - size[:2] - 0.04
    if (free < 0).any():
        return
    base = support.bottom + support.size[2] * _top_share(support)
    for _ in range(TRIES // 4):
        local = rng.uniform(-0.5, 0.5, 2) * free
        x, y = np.asarray(support.centre[:2]) + local @ support.axes
        yield Solid(float(x), float(y), size[0], size[1], base, base + size[2], support.yaw)


def _place_on_wall(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """Fixed to a wall at about the height of eyes, big things lower, never over an opening."""
    for _ in range(planned.count):
        size = layout.size(space, planned, kind)
        for _ in range(TRIES):
            bottom = _height_on_wall(layout.rng, space, planned.noun, size[2])
            solid = next(_spots_along_walls(layout, space, size, bottom), None)
            if solid is None:
                break
            front = solid.shifted(0.0, FRONT_OF_PICTURE / 2, size[0], size[1] + FRONT_OF_PICTURE)
            if layout.fits_clear(space, solid, PICTURE_GAP) and not layout.occupied.hits(front, 0.0):
                layout.put(planned, space, solid.shifted(0.0, -WALL_GAP, size[0], size[1]))  # flat on the wall
                break
        else:
            solid = None
        if solid is None:
            layout.miss(planned.noun, "no free stretch of wall")


def _height_on_wall(rng: np.random.Generator, space: Space, noun: str, height: float) -> float:
    """Metres: the underside of a thing on a wall."""
    middle, over = rng.normal(1.62, 0.15 if space.height < 4 else 0.4), HIGH_UP.get(noun, np.inf)
    if over + height < space.height - 0.2:
        return float(over + abs(middle - 1.62))
    return float(np.clip(middle - height / 2, 0.9, max(space.height - height - 0.2, 0.9)))


def _place_hanging(layout: Layout, space: Space, planned: PlannedObject, kind: Kind) -> None:
    """From the ceiling, a rod or a cable; over the things that are named, or spread over the space."""
    over = layout.named(planned, space)
    for number in range(planned.count):
        size = layout.size(space, planned, kind)
        spots = [np.asarray(o.centre[:2]) for o in over[number:]]
        spots += [space.middle + layout.rng.uniform(-0.44, 0.44, 2) * space.size for _ in range(TRIES)]
        solids = (s for spot in spots for s in _hung(space, spot, size, layout.rng))
        solid = layout.first(space, solids, 0.25)
        if solid is None:
            layout.miss(planned.noun, "no free ceiling")
        else:
            layout.put(planned, space, solid)


def _hung(space: Space, spot: NDArray[np.float64], size: Size, rng: np.random.Generator) -> Iterator[Solid]:
    """At the ceiling, or lower where that is high."""
    ceiling = (
        max(space.height, 4.0) if space.open_air else ceiling_at(space, spot) - 0.01 * (space.zone.kind == "tunnel")
    )
    z = min(size[2], ceiling - LOW_HANGING) if size[2] > 0.2 else size[2]
    if z < 0.5 * size[2]:
        return
    lowest = float(rng.uniform(*HANGING_AT))
    top = ceiling if ceiling - z < lowest or (size[2] <= 0.2 and not space.open_air) else lowest + z
    yaw = 0.0 if space.size[0] >= space.size[1] else np.pi / 2
    yield Solid(float(spot[0]), float(spot[1]), size[0], size[1], top - z, top, yaw)


PLACERS = {
    "against_wall": _place_against_wall,
    "in_row": _place_in_row,
    "on_floor": _place_on_floor,
    "around": _place_around,
    "facing": _place_facing,
    "beside": _place_beside,
    "on_surface": _place_on_surface,
    "on_wall": _place_on_wall,
    "hanging": _place_hanging,
}
"""In the order in which a place is furnished."""
