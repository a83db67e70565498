"""`fly_task_sets`: every task planned, given attitude and yaw, sampled and measured."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.errors import PlanningError
from flymirage_core.navigation.flatness import attitude_and_rates
from flymirage_core.navigation.flight_check import exact_clearance
from flymirage_core.navigation.flight_space import FlightSpace
from flymirage_core.navigation.planner import PLANNER, PlannedFlight, plan_flight_in
from flymirage_core.navigation.task_sets import Task, TaskSets
from flymirage_core.navigation.trajectories import Flight, FlightReport, RejectedTask, Trajectories
from flymirage_core.navigation.yaw import SUBSTEPS, plan_yaw
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.settings import PlannerSettings

Float64 = NDArray[np.float64]

HOVER_DERIVATIVES: Final = 4
"""Position, velocity, acceleration, jerk; all but the first are zero in hover."""


def fly_task_sets(
    task_sets: TaskSets,
    grid: OccupancyGrid,
    boxes: BoxMap,
    settings: PlannerSettings,
    generator: np.random.Generator,
) -> Trajectories:
    """Flies all tasks, each set in one run: a leg begins where, and looking as, the leg before it ended.

    A set's first leg begins looking along its flight. If a task is rejected the drone stays where it is, and the next
    task of the set is planned from there: its start is then the last point reached, not the rejected target point.
    Each task has its own stream of random numbers, so one task's attempts change no other task's flight.
    """
    space = FlightSpace.of(grid, settings)
    flights: list[Flight] = []
    rejected: list[RejectedTask] = []
    set_index, position, yaw = -1, np.zeros(3), None
    for task, stream in zip(task_sets, generator.spawn(len(task_sets)), strict=True):
        if task.set_index != set_index:
            set_index, position, yaw = task.set_index, np.array(task.start), None
        try:
            planned = plan_flight_in(space, position, task.target_point, settings, stream)
        except PlanningError as error:
            rejected.append(RejectedTask(task.set_index, task.leg_index, task.object_id, str(error)))
            continue
        target_centre = np.array(boxes.by_id(task.object_id).centre)
        flight = _recorded(len(flights), task, planned, target_centre, yaw, grid, settings)
        flights.append(flight)
        position, yaw = flight.positions[-1], float(flight.yaws[-1])
    return Trajectories(tuple(flights), tuple(rejected))


def _recorded(
    flight_id: int,
    task: Task,
    planned: PlannedFlight,
    target_centre: Float64,
    first_yaw: float | None,
    grid: OccupancyGrid,
    settings: PlannerSettings,
) -> Flight:
    """The flight's states at ``settings.state_rate``, with the hovers that its yaw needs, and their report."""
    spline, rate = planned.spline, settings.state_rate
    count = round(spline.duration * rate)
    fine = spline.at(np.linspace(0, spline.duration, count * SUBSTEPS + 1))
    turn = plan_yaw(fine, target_centre, first_yaw, settings)
    clock = np.arange(-turn.before, count + turn.after + 1)  # (T,) states from departure on
    moving = (clock >= 0) & (clock <= count)
    position, velocity, acceleration, jerk = (spline.at(clock / rate, n) for n in range(HOVER_DERIVATIVES))
    for derivative in (velocity, acceleration, jerk):
        derivative[~moving] = 0.0
    quaternions, body_rates = attitude_and_rates(acceleration, jerk, turn.yaws, turn.rates)
    clearances = exact_clearance(grid, position)
    target_point = np.array(task.target_point)
    measures = planned.measures
    report = FlightReport(
        duration=(len(clock) - 1) / rate,
        length=measures.length,
        straight_distance=float(np.linalg.norm(target_point - position[0])),
        max_speed=measures.max_speed,
        max_acceleration=measures.max_acceleration,
        max_jerk=measures.max_jerk,
        max_body_rate=float(np.linalg.norm(body_rates, axis=1).max()),
        max_yaw_rate=float(np.abs(turn.rates).max()),
        min_clearance=min(measures.min_clearance, float(clearances.min())),
        end_error=float(np.linalg.norm(position[-1] - target_point)),
        inflation=planned.inflation,
        planner=PLANNER,
        attempts=planned.attempts,
    )
    return Flight(
        flight_id=flight_id,
        set_index=task.set_index,
        leg_index=task.leg_index,
        object_id=task.object_id,
        target_point=target_point,
        times=np.arange(len(clock)) / rate,
        positions=position,
        velocities=velocity,
        accelerations=acceleration,
        quaternions=quaternions,
        body_rates=body_rates,
        yaws=np.angle(np.exp(1j * turn.yaws)),
        clearances=clearances,
        report=report,
    )
