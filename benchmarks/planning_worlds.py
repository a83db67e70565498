"""Worlds to plan flights in, with start and goal pairs: files, rooms made of blocks, generated and captured worlds."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.navigation.flight_space import keep_clear
from flymirage_core.occupancy.distance import clearance_field
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.occupancy.search import reachable
from flymirage_core.occupancy.voxelise import occupancy_from_splats
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import Settings
from flymirage_core.splats.imports import import_world
from flymirage_core.worldgen.assembly import build_truth
from flymirage_core.worldgen.model import OfflineWorldModel

RESOLUTION = 0.1
PAIRS = 20
END_CLEARANCE = 0.3
SETTINGS = Settings()


@dataclass(frozen=True, eq=False)
class Case:
    grid: OccupancyGrid
    starts: NDArray[np.float64]  # (P, 3)
    goals: NDArray[np.float64]  # (P, 3)


@dataclass(frozen=True, eq=False)
class FurnishedWorld:
    """A generated world and, in place of what annotation finds, the boxes of what was put there."""

    grid: OccupancyGrid
    centre: NDArray[np.float64]  # (3,)
    boxes: BoxMap


def generated(key: str) -> FurnishedWorld:
    """The offline pipeline's world of a scene key."""
    description = OfflineSceneWriter().describe(key)
    world = OfflineWorldModel(SETTINGS.generation).build(description)
    boxes = [
        ObjectBox(o.object_id, o.noun, o.centre, o.size, o.yaw, 1.0, "truth", o.colour, o.material, 1, 1.0, "truth")
        for o in build_truth(description).objects
    ]
    return FurnishedWorld(
        occupancy_from_splats(world.cloud, world.centre, SETTINGS.occupancy), world.centre, BoxMap(tuple(boxes))
    )


def captured(path: Path) -> OccupancyGrid:
    """The grid of a splat file, taken to be in metres."""
    world = import_world(path, "auto", None, SETTINGS.cleaning)
    return occupancy_from_splats(world.cloud, world.centre, SETTINGS.occupancy)


def with_pairs(grid: OccupancyGrid, seed: int) -> Case:
    return Case(grid, *random_pairs(grid, np.random.default_rng(seed)))


def connected(grid: OccupancyGrid, start: NDArray[np.float64], goal: NDArray[np.float64]) -> bool:
    return bool(grid.state_at(goal) == FREE and reachable(grid, start)[tuple(grid.index_of(goal))])


def room(path: Path) -> Case:
    data = np.load(path)
    grid = OccupancyGrid(data["grid"].astype(np.uint8), data["origin"], float(data["resolution"]))
    return Case(grid, data["starts"], data["goals"])


def corridor() -> Case:
    """14 x 3 x 3 m with 12 square pillars."""
    rng = np.random.default_rng(1)
    grid = free_space(14, 3, 3)
    x, y, _ = columns(grid)
    for centre_x in np.linspace(1.2, 12.8, 12):
        centre_y = rng.uniform(0.3, 2.7)
        block(grid, (np.abs(x - centre_x) < 0.2) & (np.abs(y - centre_y) < 0.2))
    return Case(grid, *random_pairs(grid, rng))


def forest() -> Case:
    """10 x 10 x 3 m with 35 round trunks."""
    rng = np.random.default_rng(2)
    grid = free_space(10, 10, 3)
    x, y, _ = columns(grid)
    for _ in range(35):
        centre = rng.uniform(0, 10, 2)
        block(grid, np.hypot(x - centre[0], y - centre[1]) < rng.uniform(0.15, 0.4))
    return Case(grid, *random_pairs(grid, rng))


def flat() -> Case:
    """10 x 8 x 2.8 m: four rooms, doors of 0.9 x 2 m between them, and blocks of furniture."""
    rng = np.random.default_rng(3)
    grid = free_space(10, 8, 2.8)
    x, y, z = columns(grid)
    door_x = (np.abs(x - 2.5) < 0.45) | (np.abs(x - 7.5) < 0.45)
    door_y = (np.abs(y - 2.0) < 0.45) | (np.abs(y - 6.0) < 0.45)
    walls = ((np.abs(x - 5) < 0.1) & ~door_y) | ((np.abs(y - 4) < 0.1) & ~door_x)
    block(grid, walls)
    block(grid, ((np.abs(x - 5) < 0.1) | (np.abs(y - 4) < 0.1)) & (z > 2.0))
    for _ in range(16):
        centre, half = rng.uniform([0, 0], [10, 8]), rng.uniform(0.2, 0.5, 2)
        furniture = (np.abs(x - centre[0]) < half[0]) & (np.abs(y - centre[1]) < half[1])
        in_the_way = (door_x & (np.abs(y - 4) < 0.9)) | (door_y & (np.abs(x - 5) < 0.9))
        block(grid, furniture & ~in_the_way & (z < rng.uniform(0.5, 1.8)))
    return Case(grid, *random_pairs(grid, rng))


def free_space(x: float, y: float, z: float) -> OccupancyGrid:
    shape = tuple(round(side / RESOLUTION) for side in (x, y, z))
    return OccupancyGrid(np.full(shape, FREE, np.uint8), np.zeros(3), RESOLUTION)


def block(grid: OccupancyGrid, where: NDArray[np.bool_]) -> None:
    """Fills the voxels ``where``, broadcast over the grid."""
    grid.state[np.broadcast_to(where, grid.state.shape)] = OCCUPIED


def columns(grid: OccupancyGrid) -> tuple[NDArray[np.float64], ...]:
    """Coordinates of voxel centres, ready to be broadcast: (X, 1, 1), (1, Y, 1), (1, 1, Z)."""
    axes = [np.arange(n) * grid.resolution + grid.resolution / 2 for n in grid.state.shape]
    return tuple(np.meshgrid(*axes, sparse=True, indexing="ij"))


def random_pairs(grid: OccupancyGrid, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Starts and goals (P, 3), 2 to 10 m apart, connected, `END_CLEARANCE` metres from everything."""
    space = keep_clear(grid, RESOLUTION)
    roomy = np.argwhere((clearance_field(grid) >= END_CLEARANCE + RESOLUTION / 2) & (space.state == FREE))
    pairs = []
    while len(pairs) < PAIRS:
        start, goal = (grid.centre_of(roomy[rng.integers(len(roomy))]) for _ in range(2))
        if 2 <= np.linalg.norm(goal - start) <= 10 and connected(space, start, goal):
            pairs.append((start, goal))
    starts, goals = zip(*pairs, strict=True)
    return np.array(starts), np.array(goals)
