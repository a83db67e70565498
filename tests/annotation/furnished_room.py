"""Rooms full of analytic furniture by seed, for the benchmark: things along the walls, a dining set, things on tops."""

import numpy as np
from analytic_room import Room, Thing, block, chair, lamp, picture, table

from flymirage_core.occupancy.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from flymirage_core.scene.keys import rng

ALONG_WALLS = {
    "sofa": (2.0, 0.9, 0.8), "cabinet": (1.0, 0.45, 0.9), "wardrobe": (1.2, 0.6, 2.0), "desk": (1.4, 0.7, 0.74),
    "bookshelf": (0.9, 0.35, 1.8), "chest": (0.9, 0.5, 0.8), "nightstand": (0.5, 0.42, 0.55), "bin": (0.35, 0.35, 0.5),
    "armchair": (0.85, 0.85, 0.8), "box": (0.5, 0.4, 0.4),
}  # fmt: skip
ON_TOPS = {"vase": (0.2, 0.2, 0.35), "radio": (0.3, 0.15, 0.2), "books": (0.28, 0.22, 0.2)}
ROOM = (8.0, 6.5, 2.7)
CENTRE_CLEARANCE = 1.0


def furnished_room(seed: int) -> Room:
    """About 30 things in a room of `ROOM` metres, turned by up to 34 degrees."""
    random = rng("analytic", "room", seed)
    yaw = float(random.uniform(-0.6, 0.6))
    things = _along_walls(random) + _dining_set(random) + _pictures(random)
    turned = tuple(_turned(t, yaw) for t in things)
    return Room(ROOM, turned, yaw, walls=_colour(random, 190, 235), floor=_colour(random, 90, 160))


def grid_of(room: Room, resolution: float) -> OccupancyGrid:
    """Free space of the room: inside and outside of all boxes."""
    reach = np.hypot(*room.size[:2]) / 2 + 0.3
    shape = np.ceil(np.array([2 * reach, 2 * reach, room.size[2] + 0.4]) / resolution).astype(int)
    origin = np.array([-reach, -reach, -0.2])
    grid = OccupancyGrid(np.full(shape, UNKNOWN, np.uint8), origin, resolution)
    centres = grid.centre_of(np.stack(np.indices(shape), axis=-1))  # (X, Y, Z, 3)
    c, s = np.cos(room.yaw), np.sin(room.yaw)
    local = centres @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    half = np.divide(room.size, 2)
    inside = (np.abs(local[..., :2]) < half[:2]).all(axis=-1) & (local[..., 2] > 0) & (local[..., 2] < room.size[2])
    grid.state[inside] = FREE
    for box in room.truth:
        grid.state[box.contains(centres)] = OCCUPIED
    return grid


def _along_walls(random: np.random.Generator) -> list[Thing]:
    things: list[Thing] = []
    names = list(ALONG_WALLS)
    for wall in range(4):
        length, depth = (ROOM[0], ROOM[1]) if wall % 2 == 0 else (ROOM[1], ROOM[0])
        along = -length / 2 + 1.0
        while True:
            name = names[random.integers(len(names))]
            w, d, h = ALONG_WALLS[name]
            if along + w > length / 2 - 1.0:
                break
            place = (along + w / 2, -depth / 2 + d / 2 + 0.02, 0.0)
            thing = block(name, place, (w, d, h), _colour(random))
            things.append(_turned(thing, wall * np.pi / 2))
            if h < 1.0 and min(w, d) > 0.4 and random.random() < 0.7:
                things.append(_turned(_on_top(random, (place[0], place[1], h)), wall * np.pi / 2))
            along += w + random.uniform(0.3, 0.8)
    return things


def _on_top(random: np.random.Generator, place: tuple[float, float, float]) -> Thing:
    if random.random() < 0.3:
        return lamp(place)
    name = list(ON_TOPS)[random.integers(len(ON_TOPS))]
    return block(name, place, ON_TOPS[name], _colour(random))


def _dining_set(random: np.random.Generator) -> list[Thing]:
    middle = np.array([random.choice([-1, 1]) * 2.1, random.uniform(-0.6, 0.6), 0.0])
    colour, seat = _colour(random), _colour(random)
    things = [table(middle, colour), _on_top(random, (middle[0] + 0.3, middle[1], 0.74))]
    for x in (-0.35, 0.35):
        things.append(chair((middle[0] + x, middle[1] - 0.5, 0.0), seat))
        things.append(chair((middle[0] + x, middle[1] + 0.5, 0.0), seat, yaw=np.pi))
    return things


def _pictures(random: np.random.Generator) -> list[Thing]:
    return [
        _turned(
            picture((random.uniform(-1.5, 1.5), (ROOM[1] if k % 2 == 0 else ROOM[0]) / 2, 1.6), _colour(random)),
            k * np.pi / 2,
        )
        for k in range(4)
    ]


def _colour(random: np.random.Generator, low: int = 30, high: int = 225) -> tuple[int, int, int]:
    r, g, b = (int(v) for v in random.integers(low, high, 3))
    return r, g, b


def _turned(thing: Thing, angle: float) -> Thing:
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = thing.place
    return Thing(thing.name, (c * x - s * y, s * x + c * y, z), thing.yaw + angle, thing.bodies)
