"""Whole scenes: task sets, flights and their closed-loop check in generated worlds; lengths beside the paper's.

    python benchmarks/flights.py [SCENE_KEY ...]

Ten scenes of the offline world model if no keys are given. Targets are the boxes of what the world model put there, so
that annotation has no part in the figures. CPU seconds are of one core, after compilation; "plan" is the planner alone,
"all" also has yaw, attitude, clearance and the simulated quadrotor. Exits with 1 if a requirement is not met.
"""

import sys
import time

import numpy as np
from planning_worlds import SETTINGS, FurnishedWorld, generated

from flymirage_core.navigation.flight_space import FlightSpace
from flymirage_core.navigation.fly import fly_task_sets
from flymirage_core.navigation.planner import plan_flight_in
from flymirage_core.navigation.task_sets import TaskSets, generate_task_sets
from flymirage_core.navigation.trajectories import Trajectories

BINS = (2.0, 4.0, 6.0, 8.0, 10.0)
"""Metres; of the paper's histogram of trajectory lengths."""
PAPER = (42.7, 31.6, 16.2, 8.5, 1.1)
"""Per cent in each bin, and beyond 10 m; mean 4.33 m, median 4.06 m."""


def main() -> None:
    keys = sys.argv[1:] or [f"bench-{n}" for n in range(10)]
    quick = SETTINGS.tasks.model_copy(update={"sets": 1})
    warm_up = generated(keys[0])
    fly(warm_up, generate_task_sets(warm_up.grid, warm_up.boxes, warm_up.centre, quick, np.random.default_rng(0)))
    print("scene          tasks  flown  objects  most used  rejections inside/occluded/unsafe/distance  ", end="")
    print("plan s  all s  strayed mm median  max  tilted deg max  rotor N min  max  rad/s  rad/s^2")
    everything, seconds = [], []
    for key in keys:
        flights, spent = scene(key)
        everything += flights.flights
        seconds.append(100 * spent / len(flights))
    lengths = np.array([f.report.length for f in everything])
    histogram(lengths, np.array([f.report.straight_distance for f in everything]))
    reasons = [
        ("100 flights planned in under 2 s", max(seconds) < 2, f"at most {max(seconds):.2f} s"),
        ("strayed <= 5 cm RMS", *worst([f.report.tracking_position_rms for f in everything], 0.05, "m")),
        ("tilted <= 3 deg RMS", *worst([np.degrees(f.report.tracking_attitude_rms) for f in everything], 3, "deg")),
        ("yaw rate <= 0.8 rad/s", *worst([f.report.max_yaw_rate for f in everything], 0.8 + 1e-9, "rad/s")),
        ("ends within 1 cm", *worst([f.report.end_error for f in everything], 0.01, "m")),
    ]
    for text, met, value in reasons:
        print(f"{'met' if met else 'NOT MET':8}{text}: {value}")
    sys.exit(0 if all(met for _, met, _ in reasons) else 1)


def worst(values: list[float], limit: float, unit: str) -> tuple[bool, str]:
    return max(values) <= limit, f"at most {max(values):.4f} {unit}"


def scene(key: str) -> tuple[Trajectories, float]:
    """Flies and prints one scene; CPU seconds of the planner alone."""
    world = generated(key)
    began = time.process_time()
    tasks = generate_task_sets(world.grid, world.boxes, world.centre, SETTINGS.tasks, np.random.default_rng(1))
    drawing = time.process_time() - began
    began = time.process_time()
    flights = fly(world, tasks)
    flying = time.process_time() - began
    planning = plan_again(world, flights)
    uses = np.unique([t.object_id for t in tasks], return_counts=True)[1]
    r = [f.report for f in flights]
    print(
        f"{key:14} {len(tasks):5} {len(flights):6} {len(uses):8} {uses.max():10}  "
        f"{'/'.join(map(str, tasks.rejections.values())):>28} (drawn in {drawing:.1f} s) "
        f"{planning:11.2f} {flying:6.2f} "
        f"{1000 * np.median([x.tracking_position_rms for x in r]):18.1f} "
        f"{1000 * max(x.tracking_position_rms for x in r):4.1f} "
        f"{np.degrees(max(x.tracking_attitude_rms for x in r)):15.2f} "
        f"{min(x.min_rotor_thrust for x in r):12.2f} {max(x.max_rotor_thrust for x in r):4.2f} "
        f"{max(x.max_body_rate for x in r):6.2f} {max(x.max_angular_acceleration for x in r):8.1f}"
    )
    for task in flights.rejected:
        print(f"    set {task.set_index} leg {task.leg_index}: {task.reason}")
    return flights, planning


def fly(world: FurnishedWorld, tasks: TaskSets) -> Trajectories:
    generator = np.random.default_rng(2)
    return fly_task_sets(tasks, world.grid, world.boxes, SETTINGS.planner, SETTINGS.quadrotor, generator)


def plan_again(world: FurnishedWorld, flights: Trajectories) -> float:
    """CPU seconds of planning alone, the scene's preparation included."""
    began = time.process_time()
    space = FlightSpace.of(world.grid, SETTINGS.planner)
    for flight in flights:
        ends = flight.positions[0], flight.target_point
        plan_flight_in(space, *ends, SETTINGS.planner, np.random.default_rng(0))
    return time.process_time() - began


def histogram(lengths: np.ndarray, straight: np.ndarray) -> None:
    print(f"{len(lengths)} flights; length mean {lengths.mean():.2f} m, median {np.median(lengths):.2f} m", end="")
    print(" (the paper: 4.33 m, 4.06 m)")
    print(f"{'metres':>10}  {'ours':>6}  {'paper':>6}  {'ours, straight line':>19}")
    edges = [*BINS, np.inf]
    for low, high, paper in zip(edges[:-1], edges[1:], PAPER, strict=True):
        ours, line = (100 * np.mean((x >= low) & (x < high)) for x in (lengths, straight))
        print(f"{f'{low:g}-{high:g}':>10}  {ours:5.1f}%  {paper:5.1f}%  {line:18.1f}%")
    print(f"{'below 2':>10}  {100 * np.mean(lengths < BINS[0]):5.1f}%    0.0%")


if __name__ == "__main__":
    main()
