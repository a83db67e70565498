"""How well and how fast `plan_flight` plans: success, time, length, limits, clearance, beside the original's figures.

    python benchmarks/planning.py [ROOM.npz]

Worlds: the room that is given (arrays grid, origin, resolution, starts, goals), a corridor with pillars, a forest of
cylinders and a flat of four rooms, 20 pairs each, at 1, 2 and 3 voxels of inflation. Times are CPU milliseconds on one
core, seed path included, after compilation; making a world's `FlightSpace` is not in them, it is made once per scene.
"""

import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.flight_space import FlightSpace, keep_clear
from flymirage_core.navigation.planner import PlannedFlight, plan_flight_in
from flymirage_core.occupancy.distance import clearance_field
from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.occupancy.search import reachable
from flymirage_core.settings import PlannerSettings

RESOLUTION = 0.1
PAIRS = 20
END_CLEARANCE = 0.3
ORIGINAL = """The original (C++, 2 m/s and 3 m/s^2 per axis, replanning on the way; worlds like these):
  at 1 voxel : within 0.1 m of the goal: room 20/20, corridor 17/20, forest 15/20, flat 14/20; 0 collisions
  at 2 voxels: room 17/20, corridor 19/20, forest 16/20, flat 14/20; at 3 voxels: 45/68 of what is connected
  at 1 voxel : length ratio median 1.057, speed norm max 2.99 m/s, acceleration norm max 6.44 m/s^2,
               clearance median 0.205 m, min 0.113 m; goal missed by 0.027 m (median), 0.163 m (max);
               position jumps at a replan by up to 0.114 m; 0.12 / 1.15 ms a call (median / p95), 12 calls a flight"""


@dataclass(frozen=True, eq=False)
class Case:
    grid: OccupancyGrid
    starts: NDArray[np.float64]  # (P, 3)
    goals: NDArray[np.float64]  # (P, 3)


def main() -> None:
    cases = {"corridor": corridor(), "forest": forest(), "flat": flat()}
    if len(sys.argv) > 1:
        cases = {"room": room(Path(sys.argv[1])), **cases}
    warm_up = cases["corridor"]
    plan_all(Case(warm_up.grid, warm_up.starts[:2], warm_up.goals[:2]), PlannerSettings())
    print("world     voxels  flown  fallback  ms median    p95    max  length ratio  seconds  ", end="")
    print("max m/s  m/s^2  m/s^3  clearance median    min  end mm")
    for name, case in cases.items():
        for voxels in (1, 2, 3):
            inflation = voxels * case.grid.resolution
            report(name, voxels, case, PlannerSettings(inflation=inflation, min_inflation=inflation))
    print(ORIGINAL)


def report(name: str, voxels: int, case: Case, settings: PlannerSettings) -> None:
    flights, milliseconds, failures, solvable = plan_all(case, settings)
    m = [flight.measures for flight in flights]
    straight = [np.linalg.norm(np.subtract(*f.spline.control_points[[0, -1]])) for f in flights]
    ratio = np.median([a.length / b for a, b in zip(m, straight, strict=True)])
    fallback = sum(flight.attempts != "path_seed:ok" for flight in flights)
    print(
        f"{name:9} {voxels:6} {len(flights):3}/{solvable:2} {fallback:9} {np.median(milliseconds):10.1f} "
        f"{np.percentile(milliseconds, 95):6.1f} {max(milliseconds):6.1f} {ratio:13.3f} "
        f"{np.median([a.duration for a in m]):8.2f} {max(a.max_speed for a in m):9.3f} "
        f"{max(a.max_acceleration for a in m):6.3f} {max(a.max_jerk for a in m):6.3f} "
        f"{np.median([a.min_clearance for a in m]):17.3f} {min(a.min_clearance for a in m):6.3f} "
        f"{1000 * max(a.end_error for a in m):7.3f}"
    )
    for failure in failures:
        print("   ", failure)


def plan_all(case: Case, settings: PlannerSettings) -> tuple[list[PlannedFlight], list[float], list[str], int]:
    """Flights, CPU milliseconds of each solvable pair, failures, and how many pairs are solvable: ends connected."""
    space = FlightSpace.of(case.grid, settings)
    flights, milliseconds, failures = [], [], []
    solvable = 0
    for n, (start, goal) in enumerate(zip(case.starts, case.goals, strict=True)):
        if not connected(space.inflated[0], start, goal):
            continue
        solvable += 1
        began = time.thread_time()
        try:
            flights.append(plan_flight_in(space, start, goal, settings, np.random.default_rng(n)))
        except PlanningError as error:
            failures.append(f"pair {n}: {error}")
        milliseconds.append(1000 * (time.thread_time() - began))
    return flights, milliseconds, failures, solvable


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


if __name__ == "__main__":
    main()
