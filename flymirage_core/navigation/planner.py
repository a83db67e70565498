"""EGO-Planner with a known map (arXiv 2008.08835): one flight from rest to rest, in one shot, over its full length.

Each attempt: seed, B-spline fit with exact ends, {p, v} pairs, rebound optimisation, refinement of time and shape,
check by `flight_check`. Attempts are made in a fixed order and each is recorded. Written from the paper's equations;
differences to the authors' program are deliberate and listed in the functions' docstrings.
"""

from dataclasses import dataclass
from typing import Final, Literal

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.errors import PlanningError
from flymirage_core.navigation import lbfgs
from flymirage_core.navigation.bspline import JoinedSplines, UniformBSpline, fit_bspline
from flymirage_core.navigation.flight_check import FlightMeasures, check_flight
from flymirage_core.navigation.flight_space import FlightSpace
from flymirage_core.navigation.obstacle_pairs import ObstaclePairs, Voxels, find_pairs, is_blocked, voxels_of
from flymirage_core.navigation.seed_path import bow_seed, path_seed, timed_samples
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.settings import PlannerSettings

Float64 = NDArray[np.float64]

PLANNER: Final = "ego-planner 1"
SMOOTHNESS_WEIGHT: Final = 1.0
FEASIBILITY_WEIGHT: Final = 0.1
FIT_WEIGHT: Final = 1.0
TOLERANCE: Final = 0.01
REFINE_TOLERANCE: Final = 0.001
MAX_REBOUNDS: Final = 20
MAX_OPTIMISATIONS: Final = 3
"""Each one after the first has twice the collision weight."""
NO_REFERENCE: Final = np.zeros((0, 3))
CRUISE_SHARE: Final = 0.93
RAMP_SHARE: Final = 0.8
"""The seed flies at these shares of the speed and acceleration limits."""
MIN_DISTANCE: Final = 0.05
"""Metres: nothing shorter is a flight."""
CHECK_STEP: Final = 0.002
"""Metres between the points of a spline that are tested against the inflated grid: much denser than what the checker
tests, so that it hardly ever finds a corner cut between them."""
LIMIT_SHARE: Final = 0.999
"""Accepted flights stay below this share of each limit."""


@dataclass(frozen=True)
class Attempt:
    """One way to try; lengths in metres."""

    name: str
    seed: Literal["path", "bow"]
    margin: float  # s_f: distance from the inflated surface below which the collision cost acts
    collision_weight: float
    spacing: float  # between samples of the seed at cruise


PORTFOLIO: Final = (
    Attempt("path_seed", "path", margin=0.5, collision_weight=0.5, spacing=0.4),
    Attempt("fine_knots", "path", margin=0.2, collision_weight=5.0, spacing=0.25),
    Attempt("short_margin", "path", margin=0.2, collision_weight=0.5, spacing=0.4),
    Attempt("random_bow", "bow", margin=0.2, collision_weight=5.0, spacing=0.25),
)
"""The order of attempts at each inflation."""


@dataclass(frozen=True, eq=False)
class PlannedFlight:
    """A flight that passed every check."""

    spline: UniformBSpline | JoinedSplines
    inflation: float  # metres by which obstacles were grown
    attempts: str  # "path_seed:still in an obstacle; short_margin:ok"
    measures: FlightMeasures
    planner: str = PLANNER


def plan_flight(
    grid: OccupancyGrid,
    start: ArrayLike,
    goal: ArrayLike,
    settings: PlannerSettings,
    generator: np.random.Generator,
) -> PlannedFlight:
    """A feasible flight from rest at ``start`` (3,) to rest at ``goal`` (3,), world metres; ``grid`` is not inflated.

    For many flights in one grid, make a `FlightSpace` once and call `plan_flight_in`.

    Raises:
        PlanningError: no attempt gave an acceptable flight; the text has each attempt's reason.
    """
    return plan_flight_in(FlightSpace.of(grid, settings), start, goal, settings, generator)


def plan_flight_in(
    space: FlightSpace,
    start: ArrayLike,
    goal: ArrayLike,
    settings: PlannerSettings,
    generator: np.random.Generator,
) -> PlannedFlight:
    """`plan_flight` in a scene that is already prepared."""
    a, b = np.array(start, float), np.array(goal, float)
    if np.linalg.norm(b - a) < MIN_DISTANCE:
        raise PlanningError("the drone is already there")
    record: list[str] = []
    for inflation, inflated in zip(space.inflations, space.inflated, strict=True):
        suffix = "" if inflation == space.inflations[0] else f"@{inflation:g}m"
        try:
            path = path_seed(inflated, space.clearance, a, b)
        except PlanningError as error:
            record.append(f"seed{suffix}:{error}")
            continue
        for attempt in PORTFOLIO:
            seed = path if attempt.seed == "path" else bow_seed(a, b, generator)
            try:
                spline = _attempted(seed, attempt, inflated, settings)
                whole = [(spline.control_points, spline.interval, spline.duration)]
                measures = check_flight(whole, (a, b), space.grid, inflated, inflation, settings)
            except PlanningError as error:
                record.append(f"{attempt.name}{suffix}:{error}")
                continue
            record.append(f"{attempt.name}{suffix}:ok")
            return PlannedFlight(spline, inflation, "; ".join(record), measures)
    raise PlanningError("; ".join(record))


def _attempted(seed: Float64, attempt: Attempt, space: OccupancyGrid, settings: PlannerSettings) -> UniformBSpline:
    """One attempt: fit, rebound, refinement, time; free in the inflated ``space`` and within the limits."""
    limits = np.array([settings.max_speed, settings.max_acceleration, settings.max_jerk])
    samples, interval = timed_samples(seed, CRUISE_SHARE * limits[0], RAMP_SHARE * limits[1], attempt.spacing)
    spline = rebounded(fit_bspline(samples, interval), attempt, space, limits)
    return _timed(_refined(spline, space, limits), limits, settings.state_rate)


def rebounded(spline: UniformBSpline, attempt: Attempt, space: OccupancyGrid, limits: Float64) -> UniformBSpline:
    """The optimisation with pairs added whenever a new obstacle is met (Algorithm 2 of the paper).

    Differences to the original: all of the flight is looked at instead of two thirds, and the curve is tested, not only
    its control points.
    """
    points = spline.control_points.copy()
    voxels = voxels_of(space)
    weights = np.array([SMOOTHNESS_WEIGHT, attempt.collision_weight, FEASIBILITY_WEIGHT, 0.0])
    pairs = find_pairs(points, space)
    rebounds, optimisations = 0, 0
    while True:
        problem = lbfgs.Problem(
            spline.interval, limits, pairs.index, pairs.p, pairs.v, attempt.margin, NO_REFERENCE, weights
        )
        status = lbfgs.minimise(points, problem, voxels, TOLERANCE)
        if status == lbfgs.REBOUND and rebounds < MAX_REBOUNDS:
            rebounds += 1
            pairs += find_pairs(points, space)
            continue
        if is_free(voxels, points):
            return UniformBSpline(points, spline.interval)
        optimisations += 1
        if optimisations == MAX_OPTIMISATIONS:
            raise PlanningError(f"still in an obstacle after {optimisations} optimisations")
        weights[1] *= 2
        pairs += find_pairs(points, space)


def _refined(spline: UniformBSpline, space: OccupancyGrid, limits: Float64) -> UniformBSpline:
    """The paper's refinement: flown slower and fitted to itself, stiff across the path and loose along it.

    Returns what needs less time to keep the limits: the refined flight or, if that is no faster or meets an obstacle,
    the given one. (The original rejects a flight whose refinement meets an obstacle.)
    """
    ratio = limit_ratio(spline, limits)
    if ratio <= 1:
        return spline
    slower = spline.stretched(np.sqrt(ratio))
    knots = np.arange(len(spline.control_points) - 2) * slower.interval
    nothing = ObstaclePairs.none()
    weights = np.array([SMOOTHNESS_WEIGHT, 0.0, FEASIBILITY_WEIGHT, FIT_WEIGHT])
    problem = lbfgs.Problem(
        slower.interval, limits, nothing.index, nothing.p, nothing.v, 0.0, slower.at(knots), weights
    )
    points = spline.control_points.copy()
    voxels = voxels_of(space)
    lbfgs.minimise(points, problem, voxels, REFINE_TOLERANCE)
    refined = UniformBSpline(points, slower.interval)
    shorter = refined.duration * max(1.0, limit_ratio(refined, limits)) < spline.duration * ratio
    return refined if shorter and is_free(voxels, points) else spline


def limit_ratio(spline: UniformBSpline, limits: Float64) -> float:
    """By what factor the flight must take longer to keep the limits; below 1 if it could be faster."""
    speed, acceleration, jerk = spline.highest_norms()
    ratio = max(speed / limits[0], np.sqrt(acceleration / limits[1]), np.cbrt(jerk / limits[2]))
    return float(ratio / LIMIT_SHARE)


def _timed(spline: UniformBSpline, limits: Float64, state_rate: float) -> UniformBSpline:
    """The same curve, slowed down as much as the limits ask, and so that it lasts a whole number of states.

    From rest to rest that is always possible.
    """
    duration = spline.duration * max(1.0, limit_ratio(spline, limits))
    states = np.ceil(duration * state_rate - 1e-9)
    return spline.stretched(float(states / state_rate / spline.duration))


@numba.njit(cache=True, nogil=True)
def is_free(voxels: Voxels, points: Float64) -> bool:
    """Whether the spline of control points (N, 3) keeps to free voxels, sampled every `CHECK_STEP` metres or less."""
    sample = np.zeros(3)
    for i in range(len(points) - 3):
        leg = 0.0  # the longest side of the polygon bounds the speed
        for n in range(3):
            side = 0.0
            for k in range(3):
                side += (points[i + n + 1, k] - points[i + n, k]) ** 2
            leg = max(leg, side)
        steps = int(np.ceil(np.sqrt(leg) / CHECK_STEP)) + 1
        for s in range(steps):
            u = s / steps
            w0 = (1 - u) ** 3 / 6
            w1 = (3 * u**3 - 6 * u**2 + 4) / 6
            w3 = u**3 / 6
            w2 = 1 - w0 - w1 - w3
            for k in range(3):
                sample[k] = w0 * points[i, k] + w1 * points[i + 1, k] + w2 * points[i + 2, k] + w3 * points[i + 3, k]
            if is_blocked(voxels, sample):
                return False
    return True
