"""`fly_task_sets`: every task planned, given attitude and yaw, sampled and measured."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.errors import PlanningError
from flymirage_core.navigation.flatness import BodyMotion, FlatMotion, body_motion
from flymirage_core.navigation.flight_check import exact_clearance
from flymirage_core.navigation.flight_space import FlightSpace
from flymirage_core.navigation.planner import PlannedFlight, plan_flight_in
from flymirage_core.navigation.replanner import replan_flight_in
from flymirage_core.navigation.task_sets import Task, TaskSets
from flymirage_core.navigation.tracking import TrackingMeasures, track
from flymirage_core.navigation.trajectories import Flight, FlightReport, RejectedTask, Trajectories
from flymirage_core.navigation.yaw import SUBSTEPS, plan_yaw
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.settings import PlannerSettings, QuadrotorSettings

Float64 = NDArray[np.float64]

PLANNERS: Final = {"one_shot": plan_flight_in, "receding": replan_flight_in}
ROUNDING: Final = 1e-6
"""States: a flight ends with a state, or just after it."""
HOVER_DERIVATIVES: Final = 4
"""Position, velocity, acceleration, jerk; all but the first are zero in hover."""


def fly_task_sets(
    task_sets: TaskSets,
    grid: OccupancyGrid,
    boxes: BoxMap,
    settings: PlannerSettings,
    quadrotor: QuadrotorSettings,
    generator: np.random.Generator,
) -> Trajectories:
    """Flies all tasks, each set in one run: a leg begins where, and looking as, the leg before it ended.

    A set's first leg begins looking along its flight. If a task is rejected the drone stays where it is, and the next
    task of the set is planned from there: its start is then the last point reached, not the rejected target point.
    A flight that asks a rotor for more or less than it can give, or that the simulated quadrotor does not keep to, is
    rejected like one that cannot be planned. Each task has its own stream of random numbers, so one task's attempts
    change no other task's flight.
    """
    space = FlightSpace.of(grid, settings)
    flights: list[Flight] = []
    rejected: list[RejectedTask] = []
    set_index, position, yaw = -1, np.zeros(3), None
    for task, stream in zip(task_sets, generator.spawn(len(task_sets)), strict=True):
        if task.set_index != set_index:
            set_index, position, yaw = task.set_index, np.array(task.start), None
        target_centre = np.array(boxes.by_id(task.object_id).centre)
        try:
            planned = PLANNERS[settings.mode](space, position, task.target_point, settings, stream)
            states = _sampled(planned, target_centre, yaw, settings, quadrotor)
            tracking = _flyable(states, quadrotor)
        except PlanningError as error:
            rejected.append(RejectedTask(task.set_index, task.leg_index, task.object_id, str(error)))
            continue
        flights.append(_recorded(len(flights), task, planned, states, tracking, grid))
        position, yaw = states.positions[-1], float(states.motion.yaw[-1])
    return Trajectories(tuple(flights), tuple(rejected))


@dataclass(frozen=True, eq=False)
class _States:
    """A flight at the recorded times, with the hovers that its yaw needs."""

    times: Float64  # (T,)
    positions: Float64  # (T, 3)
    motion: FlatMotion
    body: BodyMotion


def _sampled(
    planned: PlannedFlight,
    target_centre: Float64,
    first_yaw: float | None,
    settings: PlannerSettings,
    quadrotor: QuadrotorSettings,
) -> _States:
    """The planned flight at ``settings.state_rate``."""
    spline, rate = planned.spline, settings.state_rate
    count = int(np.ceil(spline.duration * rate - ROUNDING))
    fine = spline.at(np.arange(count * SUBSTEPS + 1) / (rate * SUBSTEPS))
    turn = plan_yaw(fine, target_centre, first_yaw, settings)
    clock = np.arange(-turn.before, count + turn.after + 1)  # (T,) states from departure on
    moving = (clock >= 0) & (clock <= spline.duration * rate + ROUNDING)
    position, velocity, acceleration, jerk = (spline.at(clock / rate, n) for n in range(HOVER_DERIVATIVES))
    for derivative in (velocity, acceleration, jerk):
        derivative[~moving] = 0.0
    motion = FlatMotion(velocity, acceleration, jerk, turn.yaws, turn.rates)
    return _States(np.arange(len(clock)) / rate, position, motion, body_motion(motion, 1 / rate, quadrotor))


def _flyable(states: _States, quadrotor: QuadrotorSettings) -> TrackingMeasures:
    """How well the simulated quadrotor keeps to the states.

    Raises:
        PlanningError: it does not, or a rotor cannot do what they ask of it.
    """
    least, most = quadrotor.rotor_limits
    low, high = states.body.rotor_thrusts.min(), states.body.rotor_thrusts.max()
    if low < least or high > most:
        raise PlanningError(
            f"not flyable: rotors would give {low:.2f} to {high:.2f} N, they can give {least:.2f} to {most:.2f} N"
        )
    tracking = track(states.times, states.positions, states.motion.yaw, states.body.quaternions, quadrotor)
    strayed, tilted = tracking.position_rms, np.degrees(tracking.attitude_rms)
    if not strayed <= quadrotor.max_position_rms:
        raise PlanningError(
            f"not tracked: the simulated quadrotor strays by {strayed:.3f} m (RMS), "
            f"{quadrotor.max_position_rms:g} m are allowed"
        )
    if not tilted <= quadrotor.max_attitude_rms_deg:
        raise PlanningError(
            f"not tracked: the simulated quadrotor is tilted away by {tilted:.2f} degrees (RMS), "
            f"{quadrotor.max_attitude_rms_deg:g} are allowed"
        )
    return tracking


def _recorded(
    flight_id: int,
    task: Task,
    planned: PlannedFlight,
    states: _States,
    tracking: TrackingMeasures,
    grid: OccupancyGrid,
) -> Flight:
    """The accepted flight with its report."""
    clearances = exact_clearance(grid, states.positions)
    target_point = np.array(task.target_point)
    measures, motion, body = planned.measures, states.motion, states.body
    report = FlightReport(
        duration=float(states.times[-1]),
        length=measures.length,
        straight_distance=float(np.linalg.norm(target_point - states.positions[0])),
        max_speed=measures.max_speed,
        max_acceleration=measures.max_acceleration,
        max_jerk=measures.max_jerk,
        max_body_rate=float(np.linalg.norm(body.body_rates, axis=1).max()),
        max_angular_acceleration=float(np.linalg.norm(body.angular_accelerations, axis=1).max()),
        max_yaw_rate=float(np.abs(motion.yaw_rate).max()),
        min_rotor_thrust=float(body.rotor_thrusts.min()),
        max_rotor_thrust=float(body.rotor_thrusts.max()),
        tracking_position_rms=tracking.position_rms,
        tracking_attitude_rms=tracking.attitude_rms,
        min_clearance=min(measures.min_clearance, float(clearances.min())),
        end_error=float(np.linalg.norm(states.positions[-1] - target_point)),
        inflation=planned.inflation,
        planner=planned.planner,
        attempts=planned.attempts,
    )
    return Flight(
        flight_id=flight_id,
        set_index=task.set_index,
        leg_index=task.leg_index,
        object_id=task.object_id,
        target_point=target_point,
        times=states.times,
        positions=states.positions,
        velocities=motion.velocity,
        accelerations=motion.acceleration,
        quaternions=body.quaternions,
        body_rates=body.body_rates,
        angular_accelerations=body.angular_accelerations,
        specific_forces=body.specific_forces,
        rotor_thrusts=body.rotor_thrusts,
        yaws=np.angle(np.exp(1j * motion.yaw)),
        clearances=clearances,
        report=report,
    )
