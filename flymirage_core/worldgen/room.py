"""The empty room: its walls as lines to put things along, its openings, its surfaces."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.design import Surface
from flymirage_core.scene.keys import rng as seeded
from flymirage_core.worldgen.colours import linear_rgb
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, paint, picture
from flymirage_core.worldgen.surfaces import Part, Sheet, upright

SILL, LINTEL = 0.95, 2.25
DOOR_WIDTH, DOOR_HEIGHT = 1.0, 2.1
SKIRTING = 0.09
DOOR_COLOURS = ("walnut brown", "chalk", "oak brown", "slate grey", "honey brown")
FLOORS = {
    "plank": Material((1, 1, 1), "planks", joints=(0.0, 0.16, 0.012), stretch=3.0, detail=1.15),
    "tile": Material((1, 1, 1), "tiles", joints=(0.5, 0.5, 0.012), detail=1.5),
    "carpet": Material((1, 1, 1), "carpet", detail=1.35),
    "concrete": Material((1, 1, 1), "stone", detail=1.5),
    "terrazzo": Material((1, 1, 1), "stone", detail=1.4),
}
WALLS = {
    "brick": Material((1, 1, 1), "bricks", joints=(0.0, 0.1, 0.012), stretch=2.2, detail=1.4),
    "tile": Material((1, 1, 1), "tiles", joints=(0.5, 0.5, 0.012), detail=2.0),
    "concrete": Material((1, 1, 1), "stone", detail=2.2),
    "plaster": Material((1, 1, 1), "plaster", detail=2.2),
}


@dataclass(frozen=True, eq=False)
class Wall:
    """A wall as a line: ``origin`` (2,) is its left end seen from inside; ``along`` and ``inward`` (2,) are units."""

    origin: NDArray[np.float64]
    along: NDArray[np.float64]
    inward: NDArray[np.float64]
    length: float

    @property
    def yaw(self) -> float:
        """Turn of an object whose back is to this wall (its +y points inward)."""
        return float(np.arctan2(-self.inward[0], self.inward[1]))

    def at(self, along: float, depth: float) -> NDArray[np.float64]:
        """(2,) the spot ``along`` metres from the left end and ``depth`` metres into the room."""
        return self.origin + along * self.along + depth * self.inward


@dataclass(frozen=True)
class Opening:
    """A window or door in wall number ``wall``, from ``left`` to ``right`` and ``bottom`` to ``top`` metres."""

    wall: int
    left: float
    right: float
    bottom: float
    top: float


@dataclass(frozen=True, eq=False)
class Room:
    """Four walls (south, east, north, west), windows and doors. The floor's middle is the world's origin."""

    dimensions: tuple[float, float, float]
    walls: tuple[Wall, ...]
    windows: tuple[Opening, ...]
    doors: tuple[Opening, ...]


def room_for(description: SceneDescription) -> Room:
    """The room of a description: dimensions as described, windows where its light comes from, one or two doors."""
    x, y, z = description.dimensions
    corners = np.array([[x, -y], [x, y], [-x, y], [-x, -y]]) / 2  # left ends, seen from inside: S, E, N, W
    inward = np.array([[0, 1], [-1, 0], [0, -1], [1, 0]], float)
    walls = []
    for corner, normal in zip(corners, inward, strict=True):
        along = np.array([-normal[1], normal[0]])
        walls.append(Wall(corner, along, normal, x if normal[0] == 0 else y))
    rng = seeded(description.scene, "room")
    window_walls = [int(w) for w in rng.permutation(4)[:2]] if description.zones[0].windows else []
    windows = []
    for wall in window_walls:
        count = 2 if walls[wall].length > 8.5 else 1
        for i in range(count):
            width = rng.uniform(1.3, 1.9)
            middle = walls[wall].length * (i + 0.5) / count + rng.uniform(-0.5, 0.5)
            windows.append(Opening(wall, middle - width / 2, middle + width / 2, SILL, LINTEL))
    doors = []
    for wall in [w for w in range(4) if w not in window_walls][: int(rng.integers(1, 3))]:
        left = rng.uniform(0.6, walls[wall].length - DOOR_WIDTH - 0.6)
        doors.append(Opening(wall, left, left + DOOR_WIDTH, 0.0, DOOR_HEIGHT))
    return Room((x, y, z), tuple(walls), tuple(windows), tuple(doors))


def shell(room: Room, description: SceneDescription) -> list[Part]:
    """Floor, ceiling, walls and skirting, closed, in world coordinates."""
    x, y, z = room.dimensions
    surfaces = {s.part: s for s in description.zones[0].surfaces}
    seed = int(seeded(description.scene, "shell").integers(1 << 16))
    floor = _finish(FLOORS, surfaces.get("floor") or surfaces["ground"], seed)
    wall = _finish(WALLS, surfaces.get("walls") or surfaces["facades"], seed + 1)
    parts = [
        Part(Sheet((-x / 2, -y / 2, 0.0), (x, 0.0, 0.0), (0.0, y, 0.0)), floor),
        Part(Sheet((-x / 2, y / 2, z), (x, 0.0, 0.0), (0.0, -y, 0.0)), paint("white", "plaster", detail=2.6)),
    ]
    for line in room.walls:
        a, b = (*line.origin, 0.0), (*(line.along * line.length), 0.0)
        parts.append(Part(Sheet(a, b, (0.0, 0.0, z)), wall))
    for number, line in enumerate(room.walls):
        gaps = [(d.left, d.right) for d in room.doors if d.wall == number]
        parts += _skirting(line, gaps)
    return parts


def fixtures(room: Room, description: SceneDescription) -> list[list[Part]]:
    """The parts of each window and each door, in world coordinates."""
    seed = int(seeded(description.scene, "shell").integers(1 << 16))
    windows = [_window(room.walls[w.wall], w, seed) for w in room.windows]
    return windows + [_door(room.walls[d.wall], d, DOOR_COLOURS[seed % len(DOOR_COLOURS)]) for d in room.doors]


def _finish(choices: dict[str, Material], surface: Surface, seed: int) -> Material:
    """The finish that the surface's material ("oak plank") names, else the last, plainest choice."""
    base = next((m for name, m in choices.items() if name in surface.material), list(choices.values())[-1])
    return replace(base, colour=linear_rgb(surface.colour), seed=seed)


def _against(line: Wall, parts: list[Part], along: float, bottom: float = 0.0) -> list[Part]:
    """Parts made with their back at y = 0, put on a wall."""
    turn = upright(line.yaw)
    spot = np.array([*line.at(along, 0.0), bottom])
    return [Part(p.surface, p.material, tuple(turn @ np.asarray(p.offset) + spot), turn @ p.rotation) for p in parts]


def _skirting(line: Wall, gaps: list[tuple[float, float]]) -> list[Part]:
    parts, start = [], 0.0
    for left, right in [*sorted(gaps), (line.length, line.length)]:
        if left - start > 0.1:
            board = box(paint("white"), (left - start, 0.02, SKIRTING), (0, 0.01, 0))
            parts += _against(line, [board], (left + start) / 2)
        start = right
    return parts


def _window(line: Wall, w: Opening, seed: int) -> list[Part]:
    width, height, bar = w.right - w.left, w.top - w.bottom, 0.07
    frame = paint("white")
    sky = Material((0.9, 0.9, 0.9), "sky", emission=0.7, detail=1.2, seed=seed)
    parts = [picture(sky, width - 0.04, height - 0.04, (0, 0.015, 0.02))]
    parts += [box(frame, (bar, 0.06, height), (s * (width - bar) / 2, 0.03, 0)) for s in (-1, 0, 1)]
    parts += [box(frame, (width, 0.06, bar), (0, 0.03, h)) for h in (0.0, height - bar)]
    parts.append(box(frame, (width + 0.16, 0.14, 0.04), (0, 0.07, -0.04), 0.008))
    return _against(line, parts, (w.left + w.right) / 2, w.bottom)


def _door(line: Wall, d: Opening, colour: str) -> list[Part]:
    width, height = d.right - d.left, d.top
    leaf = paint(colour, "wood", seed=d.wall)
    frame = paint("white")
    parts = [box(leaf, (width - 0.14, 0.04, height - 0.08), (0, 0.02, 0.01))]
    parts += [box(leaf.shaded(0.85), (width - 0.4, 0.012, h), (0, 0.045, b)) for b, h in ((0.2, 0.7), (1.1, 0.75))]
    parts += [box(frame, (0.08, 0.06, height), (s * (width - 0.08) / 2, 0.03, 0)) for s in (-1, 1)]
    parts += [
        box(frame, (width, 0.06, 0.08), (0, 0.03, height - 0.08)),
        box(paint("silver", "metal"), (0.13, 0.04, 0.025), (width / 2 - 0.18, 0.07, 1.0), 0.008),
    ]
    return _against(line, parts, (d.left + d.right) / 2)
