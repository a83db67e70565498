"""EGO-Planner as its authors fly it: a receding horizon over a map that is revealed on the way, as an option.

Plans are made from the state that the drone is in, with position, velocity and acceleration exactly, so the flown curve
is twice continuously differentiable through every replan. Each plan ends at rest in space that has been seen to be free
or not seen at all. Deliberate differences to the original: replans by time, and when the map says so, instead of by
distance; the local target lies on a path through the known map instead of on a polynomial that ignores it; the
emergency stop brakes within the limits instead of at once; nothing depends on a clock.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.errors import PlanningError
from flymirage_core.navigation import lbfgs
from flymirage_core.navigation.bspline import JoinedSplines, SplinePiece, UniformBSpline, fit_bspline
from flymirage_core.navigation.flight_check import check_flight
from flymirage_core.navigation.flight_space import FlightSpace
from flymirage_core.navigation.local_map import LocalMap
from flymirage_core.navigation.obstacle_pairs import ObstaclePairs
from flymirage_core.navigation.planner import (
    FIT_WEIGHT,
    MIN_DISTANCE,
    PLANNER,
    PORTFOLIO,
    RAMP_SHARE,
    REFINE_TOLERANCE,
    SMOOTHNESS_WEIGHT,
    PlannedFlight,
    is_free,
    limit_ratio,
    rebounded,
)
from flymirage_core.navigation.seed_path import path_seed, timed_samples
from flymirage_core.occupancy.distance import clearance_field
from flymirage_core.occupancy.grid import FREE
from flymirage_core.settings import PlannerSettings

Float64 = NDArray[np.float64]

CRUISE_SHARES: Final = (0.9, 0.7, 0.5)
"""Shares of the speed limit at which a plan is tried."""
SLOWDOWNS: Final = (1.0, 1.15, 1.3, 1.5, 1.8)
"""Factors by which a plan that exceeds the limits is flown slower; its start state cannot be."""
FEASIBILITY_WEIGHT: Final = 10.0
"""In the refinement: from a moving start, limits must be kept by the shape, not by time alone."""
LIMIT_TOLERANCE: Final = 1 + 5e-4
"""Of `limit_ratio`, which has more room than this below the limits."""
EMERGENCY_TIME: Final = 1.0
"""Seconds: the drone brakes if it is this close to a collision and has no other plan."""
STOP_TIMES: Final = (0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.2, 2.7, 3.3)
"""Seconds that braking may take, in the order in which they are tried."""
STOP_SAMPLES: Final = 9
LOOK_STEP: Final = 0.01
"""Seconds between the points of a plan that are looked at for the time of a collision."""
MAX_PLANS: Final = 200


@dataclass(frozen=True, eq=False)
class _State:
    position: Float64  # (3,)
    velocity: Float64  # (3,)
    acceleration: Float64  # (3,)

    @staticmethod
    def on(spline: UniformBSpline, time: float) -> "_State":
        return _State(*(spline.at(time, order) for order in range(3)))


def replan_flight_in(
    space: FlightSpace,
    start: ArrayLike,
    goal: ArrayLike,
    settings: PlannerSettings,
    generator: np.random.Generator,
) -> PlannedFlight:
    """`planner.plan_flight_in` with a receding horizon: the drone knows only what it has come near to.

    The whole flown curve is checked against the true grid before it is returned. ``generator`` is not used: the modes
    share one signature.

    Raises:
        PlanningError: no way was found, or the flown curve fails the check.
    """
    a, b = np.array(start, float), np.array(goal, float)
    if np.linalg.norm(b - a) < MIN_DISTANCE:
        raise PlanningError("the drone is already there")
    replanner = Replanner(LocalMap(space.inflated[0], settings.sensing_range), b, space.inflations[0], settings)
    flown = replanner.fly(a)
    pieces = [(p.spline.control_points, p.spline.interval, p.duration) for p in flown.pieces]
    measures = check_flight(pieces, (a, b), space.grid, space.inflated[0], space.inflations[0], settings)
    record = f"receding:{replanner.plans} plans, {replanner.failures} failed, {replanner.stops} emergency stops"
    return PlannedFlight(flown, space.inflations[0], record, measures, f"{PLANNER} receding")


class Replanner:
    """Flies to one goal, replanning on the way; counts its plans, its failures and its emergency stops."""

    def __init__(self, local_map: LocalMap, goal: Float64, inflation: float, settings: PlannerSettings) -> None:
        self.map, self.goal, self.inflation, self.settings = local_map, goal, inflation, settings
        self.limits = np.array([settings.max_speed, settings.max_acceleration, settings.max_jerk])
        self.plans, self.failures, self.stops = 0, 0, 0

    def fly(self, start: Float64) -> JoinedSplines:
        """All that is flown from rest at ``start`` (3,) to rest at the goal.

        Raises:
            PlanningError: no plan from rest succeeds, braking would end in an obstacle, or `MAX_PLANS` are not enough.
        """
        tick = 1 / self.settings.state_rate
        period = round(self.settings.replan_period / tick)
        pieces: list[SplinePiece] = []
        self.map.look_from(start)
        plan, steps, news = self._from_rest(start), 0, False
        while not (self._arrives(plan) and steps * tick >= plan.duration):
            steps += 1
            time = min(steps * tick, plan.duration)
            state = _State.on(plan, time)
            news |= self.map.look_from(state.position)
            if time == plan.duration and not self._arrives(plan):
                pieces.append(SplinePiece(plan, time))
                plan, steps, news = self._from_rest(state.position), 0, False
                continue
            collision = self._collision(plan, time) if news else np.inf
            due = steps % period == 0 and (news or not self._arrives(plan))
            if not (due or collision < np.inf) or time == plan.duration:
                continue
            other = self._instead(state, collision - time)
            if other is not None:
                pieces.append(SplinePiece(plan, time))
                plan, steps, news = other, 0, False
        return JoinedSplines((*pieces, SplinePiece(plan, plan.duration)))

    def plan(self, state: _State) -> UniformBSpline:
        """A plan from a state to rest at the goal, or at the horizon on the way there, through what is known.

        Raises:
            PlanningError: with the reason of each attempt.
        """
        self.plans += 1
        if self.plans > MAX_PLANS:
            raise PlanningError(f"receding: not there after {MAX_PLANS} plans")
        field = clearance_field(self.map.known) + np.float32(self.inflation)
        way = _first_metres(path_seed(self.map.known, field, state.position, self.goal), self.settings.horizon)
        reasons = []
        for share in CRUISE_SHARES:
            for attempt in PORTFOLIO[:2]:
                try:
                    heading = (way[1] - way[0]) / np.linalg.norm(way[1] - way[0])
                    speed = max(float(state.velocity @ heading), 0.0)
                    samples, interval = timed_samples(
                        way, share * self.limits[0], RAMP_SHARE * share * self.limits[1], attempt.spacing, speed
                    )
                    guess = fit_bspline(samples, interval, _derivatives(state))
                    return self._within_limits(rebounded(guess, attempt, self.map.known, self.limits), state)
                except PlanningError as error:
                    reasons.append(f"{attempt.name}@{share:g}:{error}")
        raise PlanningError("; ".join(reasons))

    def stop(self, state: _State) -> UniformBSpline:
        """Brakes to rest along the velocity, with limits kept, in as little time as is free of obstacles.

        Raises:
            PlanningError: every way to brake ends in an obstacle or exceeds a limit.
        """
        v, a = state.velocity, state.acceleration
        for duration in STOP_TIMES:
            s = np.linspace(0, 1, STOP_SAMPLES)[:, None]
            way = duration * (s - s**3 + s**4 / 2) * v + duration**2 * (s**2 / 2 - 2 * s**3 / 3 + s**4 / 4) * a
            spline = fit_bspline(state.position + way, duration / (STOP_SAMPLES - 1), _derivatives(state))
            if limit_ratio(spline, self.limits) <= LIMIT_TOLERANCE and is_free(self.map.voxels, spline.control_points):
                return spline
        raise PlanningError("receding: an obstacle was seen too late to stop before it")

    def _instead(self, state: _State, time_left: float) -> UniformBSpline | None:
        """What to fly instead of a plan that is due, or collides in ``time_left`` seconds; None to go on with it."""
        try:
            return self.plan(state)
        except PlanningError:
            self.failures += 1
            if time_left > EMERGENCY_TIME:
                return None
        self.stops += 1
        return self.stop(state)

    def _from_rest(self, position: Float64) -> UniformBSpline:
        return self.plan(_State(position, np.zeros(3), np.zeros(3)))

    def _within_limits(self, spline: UniformBSpline, state: _State) -> UniformBSpline:
        """The spline reshaped, and slowed down behind its start, until it keeps the limits and is free."""
        voxels, nothing = self.map.voxels, ObstaclePairs.none()
        weights = np.array([SMOOTHNESS_WEIGHT, 0.0, FEASIBILITY_WEIGHT, FIT_WEIGHT])
        knots = np.arange(len(spline.control_points) - 2) * spline.interval
        if limit_ratio(spline, self.limits) <= LIMIT_TOLERANCE:
            return spline
        for factor in SLOWDOWNS:
            slower = fit_bspline(spline.at(knots), spline.interval * factor, _derivatives(state))
            points = slower.control_points.copy()
            problem = lbfgs.Problem(
                slower.interval, self.limits, nothing.index, nothing.p, nothing.v, 0.0, spline.at(knots), weights
            )
            lbfgs.minimise(points, problem, voxels, REFINE_TOLERANCE)
            slower = UniformBSpline(points, slower.interval)
            if limit_ratio(slower, self.limits) <= LIMIT_TOLERANCE and is_free(voxels, points):
                return slower
        raise PlanningError("no speed keeps the limits")

    def _arrives(self, plan: UniformBSpline) -> bool:
        return bool(np.linalg.norm(plan.at(plan.duration) - self.goal) < MIN_DISTANCE / 2)

    def _collision(self, plan: UniformBSpline, now: float) -> float:
        """When the rest of the plan meets what is known to be blocked; inf if it does not."""
        if is_free(self.map.voxels, plan.control_points[int(now / plan.interval) :]):
            return np.inf
        times = np.arange(now, plan.duration, LOOK_STEP)
        hits = np.flatnonzero(self.map.known.state_at(plan.at(times)) != FREE)
        return float(times[hits[0]]) if len(hits) else np.inf


def _derivatives(state: _State) -> Float64:
    """For `fit_bspline`: from the state to rest (4, 3)."""
    return np.stack([state.velocity, np.zeros(3), state.acceleration, np.zeros(3)])


def _first_metres(path: Float64, length: float) -> Float64:
    """The beginning of a path (K, 3), cut after ``length`` metres; all of it if it is not much longer."""
    legs = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(legs)])
    if along[-1] <= length:
        return path
    last = int(np.searchsorted(along, length))
    share = (length - along[last - 1]) / legs[last - 1]
    return np.vstack([path[:last], path[last - 1] + share * (path[last] - path[last - 1])])
