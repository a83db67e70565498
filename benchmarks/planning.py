"""How well and how fast `plan_flight` plans: success, time, length, limits, clearance, beside the original's figures.

    python benchmarks/planning.py [ROOM.npz] [CAPTURED.spz ...]

Worlds: a corridor with pillars, a forest of cylinders, a flat of four rooms, a generated world, and the files that are
given: rooms as .npz (arrays grid, origin, resolution, starts, goals) and captured worlds as .spz or .ply; 20 pairs
each, at 1, 2 and 3 voxels of inflation. Times are CPU milliseconds on one core, seed path included, after compilation;
making a world's `FlightSpace` is not in them, it is made once per scene. Every flight is looked at once more at 1 kHz,
by nothing that the planner or its checker uses. Exits with 1 if a requirement is not met.
"""

import re
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from planning_worlds import (
    Case,
    captured,
    connected,
    corridor,
    flat,
    forest,
    generated,
    room,
    with_pairs,
)
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.bspline import SplinePiece, UniformBSpline
from flymirage_core.navigation.flight_space import FlightSpace
from flymirage_core.navigation.planner import PlannedFlight, plan_flight_in
from flymirage_core.navigation.replanner import replan_flight_in
from flymirage_core.occupancy.grid import FREE, OccupancyGrid
from flymirage_core.settings import PlannerSettings

Planner = Callable[..., PlannedFlight]
GENERATED_KEY = "bench-planning"
SENSING_RANGES = (5.0, 1.5)
SECOND_LOOK_RATE = 1000.0
ORIGINAL = """The original (C++, 2 m/s and 3 m/s^2 per axis, replanning on the way; worlds like these):
  at 1 voxel : within 0.1 m of the goal: room 20/20, corridor 17/20, forest 15/20, flat 14/20; 0 collisions
  at 2 voxels: room 17/20, corridor 19/20, forest 16/20, flat 14/20; at 3 voxels: 45/68 of what is connected
  at 1 voxel : length ratio median 1.057, duration median 2.98 s, speed norm max 2.99 m/s, acceleration norm max
               6.44 m/s^2, clearance median 0.205 m, min 0.113 m; goal missed by 0.027 m (median), 0.163 m (max);
               position jumps at a replan by up to 0.114 m; 0.12 / 1.15 ms a call (median / p95), 12 calls a flight"""


@dataclass
class Totals:
    """What the requirements ask about, over all worlds."""

    flown: dict[int, int] = field(default_factory=lambda: dict.fromkeys((1, 2, 3), 0))
    solvable: dict[int, int] = field(default_factory=lambda: dict.fromkeys((1, 2, 3), 0))
    milliseconds: list[float] = field(default_factory=list)
    end_errors: list[float] = field(default_factory=list)
    faults: dict[str, int] = field(
        default_factory=lambda: dict.fromkeys(("collisions", "discontinuities", "limit violations", "too near"), 0)
    )


def main() -> None:
    cases = {"corridor": corridor(), "forest": forest(), "flat": flat()}
    cases["generated"] = with_pairs(generated(GENERATED_KEY).grid, seed=4)
    for path in map(Path, sys.argv[1:]):
        cases[path.stem] = room(path) if path.suffix == ".npz" else with_pairs(captured(path), seed=5)
    warm_up = cases["corridor"]
    plan_all(Case(warm_up.grid, warm_up.starts[:2], warm_up.goals[:2]), PlannerSettings())
    print("world               voxels  flown  fallback  ms median    p95    max  length ratio  seconds  ", end="")
    print("max m/s  m/s^2  m/s^3  clearance median    min  end mm")
    totals = Totals()
    for name, case in cases.items():
        for voxels in (1, 2, 3):
            inflation = voxels * case.grid.resolution
            report(name, voxels, case, PlannerSettings(inflation=inflation, min_inflation=inflation), totals)
    print(ORIGINAL)
    print("receding horizon at 3 voxels; jumps at replans of position, velocity and acceleration")
    print("world               sensing m  flown  plans  failed  stops  ms median    p95  seconds  ", end="")
    print("clearance min  jump 1e-9 SI  faults")
    for name, case in cases.items():
        for sensing_range in SENSING_RANGES:
            receding(name, case, sensing_range)
    sys.exit(0 if judged(totals) else 1)


def report(name: str, voxels: int, case: Case, settings: PlannerSettings, totals: Totals) -> None:
    flights, milliseconds, failures, solvable = plan_all(case, settings)
    m = [flight.measures for flight in flights]
    straight = [np.linalg.norm(np.subtract(*f.spline.at([0, f.spline.duration]))) for f in flights]
    ratio = np.median([a.length / b for a, b in zip(m, straight, strict=True)])
    fallback = sum(flight.attempts != "path_seed:ok" for flight in flights)
    print(
        f"{name:19} {voxels:6} {len(flights):3}/{solvable:2} {fallback:9} {np.median(milliseconds):10.1f} "
        f"{np.percentile(milliseconds, 95):6.1f} {max(milliseconds):6.1f} {ratio:13.3f} "
        f"{np.median([a.duration for a in m]):8.2f} {max(a.max_speed for a in m):9.3f} "
        f"{max(a.max_acceleration for a in m):6.3f} {max(a.max_jerk for a in m):6.3f} "
        f"{np.median([a.min_clearance for a in m]):17.3f} {min(a.min_clearance for a in m):6.3f} "
        f"{1000 * max(a.end_error for a in m):7.3f}"
    )
    for failure in failures:
        print("   ", failure)
    totals.flown[voxels] += len(flights)
    totals.solvable[voxels] += solvable
    totals.milliseconds += milliseconds
    totals.end_errors += [a.end_error for a in m]
    tree = blocked_tree(case.grid)
    for flight in flights:
        for fault in second_look(flight, case.grid, tree, settings):
            totals.faults[fault] += 1


def plan_all(
    case: Case, settings: PlannerSettings, plan: Planner = plan_flight_in
) -> tuple[list[PlannedFlight], list[float], list[str], int]:
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
            flights.append(plan(space, start, goal, settings, np.random.default_rng(n)))
        except PlanningError as error:
            failures.append(f"pair {n}: {error}")
        milliseconds.append(1000 * (time.thread_time() - began))
    return flights, milliseconds, failures, solvable


def receding(name: str, case: Case, sensing_range: float) -> None:
    """One line for the receding horizon, at 3 voxels."""
    inflation = 3 * case.grid.resolution
    settings = PlannerSettings(
        mode="receding", sensing_range=sensing_range, inflation=inflation, min_inflation=inflation
    )
    flights, milliseconds, failures, solvable = plan_all(case, settings, replan_flight_in)
    records = [[int(n) for n in re.findall(r"\d+", flight.attempts)] for flight in flights]
    plans, failed, stops = np.sum(records, axis=0)
    tree = blocked_tree(case.grid)
    faults = [fault for flight in flights for fault in second_look(flight, case.grid, tree, settings)]
    jumps = max(joint_jump(flight) for flight in flights)
    print(
        f"{name:19} {sensing_range:9.1f} {len(flights):3}/{solvable:2} {plans:6} {failed:7} {stops:6} "
        f"{np.median(milliseconds):10.1f} "
        f"{np.percentile(milliseconds, 95):6.1f} {np.median([f.measures.duration for f in flights]):8.2f} "
        f"{min(f.measures.min_clearance for f in flights):14.3f} {1e9 * jumps:13.3f}  {' '.join(faults) or 'none'}"
    )
    for failure in failures:
        print("   ", failure)


def joint_jump(flight: PlannedFlight) -> float:
    """Largest step of position (m), velocity (m/s) and acceleration (m/s^2) at a replan."""
    pieces = flight.spline.pieces
    return max(
        (
            float(np.abs(b.spline.at(0.0, order) - a.spline.at(a.duration, order)).max())
            for a, b in pairwise(pieces)
            for order in range(3)
        ),
        default=0.0,
    )


def blocked_tree(grid: OccupancyGrid) -> cKDTree:
    """Of the centres of all blocked voxels, one layer outside of the grid included."""
    return cKDTree(grid.centre_of(np.argwhere(np.pad(grid.state, 1, constant_values=1) != FREE) - 1))


def second_look(flight: PlannedFlight, grid: OccupancyGrid, tree: cKDTree, settings: PlannerSettings) -> list[str]:
    """What is wrong with a flight, at 1 kHz: by scipy's splines and a k-d tree of the blocked voxels' centres."""
    times = np.linspace(0, flight.spline.duration, int(flight.spline.duration * SECOND_LOOK_RATE) + 1)
    step = times[1]
    p, v, a, j = (looked_up(flight, times, order) for order in range(4))
    faults = []
    if (grid.state_at(p) != FREE).any():
        faults.append("collisions")
    largest = [np.linalg.norm(x, axis=1).max() for x in (v, a, j)]
    if (np.array(largest) > [settings.max_speed, settings.max_acceleration, settings.max_jerk]).any():
        faults.append("limit violations")
    jumps = [np.linalg.norm(np.diff(x, axis=0), axis=1).max() for x in (p, v, a)]
    if (np.array(jumps) > 1.01 * step * np.array(largest)).any():
        faults.append("discontinuities")
    reach = flight.inflation + grid.resolution  # a voxel this near may have its face within the inflation
    for point, near in zip(p, tree.query_ball_point(p, reach), strict=True):
        gaps = np.maximum(np.abs(tree.data[near] - point) - grid.resolution / 2, 0)  # (M, 3) to the voxels' boxes
        if len(near) and np.linalg.norm(gaps, axis=1).min() < flight.inflation - 1e-6:
            faults.append("too near")
            break
    return faults


def looked_up(flight: PlannedFlight, times: NDArray[np.float64], order: int) -> NDArray[np.float64]:
    """Derivatives (T, 3) by scipy."""
    one = isinstance(flight.spline, UniformBSpline)
    pieces = [SplinePiece(flight.spline, flight.spline.duration)] if one else flight.spline.pieces
    out, begin = np.empty((len(times), 3)), 0.0
    for piece in pieces:
        points, dt = piece.spline.control_points, piece.spline.interval
        curve = BSpline((np.arange(len(points) + 4) - 3) * dt, points, 3)
        here = times >= begin
        out[here] = curve(np.minimum(times[here] - begin, piece.duration), order)
        begin += piece.duration
    return out


def judged(totals: Totals) -> bool:
    """Prints each requirement with its figure; whether all are met."""
    time_median, time_p95 = np.percentile(totals.milliseconds, (50, 95))
    share = totals.flown[3] / totals.solvable[3]
    lines = [
        ("all connected pairs at 1 voxel", totals.flown[1] == totals.solvable[1], ratio_text(totals, 1)),
        ("all connected pairs at 2 voxels", totals.flown[2] == totals.solvable[2], ratio_text(totals, 2)),
        (">= 95 % of the connected pairs at 3 voxels", share >= 0.95, ratio_text(totals, 3)),
        ("ends within 1 cm", max(totals.end_errors) <= 0.01, f"{1e6 * max(totals.end_errors):.3f} um"),
        *((f"0 {name} at 1 kHz", count == 0, str(count)) for name, count in totals.faults.items()),
        ("median <= 15 ms a flight", time_median <= 15, f"{time_median:.1f} ms"),
        ("p95 <= 60 ms a flight", time_p95 <= 60, f"{time_p95:.1f} ms"),
    ]
    for text, met, value in lines:
        print(f"{'met' if met else 'NOT MET':8}{text}: {value}")
    return all(met for _, met, _ in lines)


def ratio_text(totals: Totals, voxels: int) -> str:
    return f"{totals.flown[voxels]}/{totals.solvable[voxels]}"


if __name__ == "__main__":
    main()
