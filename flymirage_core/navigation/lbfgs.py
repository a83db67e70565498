"""L-BFGS over a flight's control points, compiled together with the costs, and EGO-Planner's rebound test inside of it.

Variables are the control points between the three fixed ones at each end. Written out here, not taken from scipy,
because a flight needs a few hundred evaluations of some microseconds each, and because the rebound (arXiv 2008.08835,
Algorithm 2) must look at every iterate.
"""

from typing import Final, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.navigation import costs
from flymirage_core.navigation.bspline import FIXED
from flymirage_core.navigation.obstacle_pairs import Voxels, is_blocked

Float64 = NDArray[np.float64]

MEMORY: Final = 16
MAX_ITERATIONS: Final = 200
MAX_TRIALS: Final = 40
"""Steps tried in one line search."""
SUFFICIENT_DECREASE: Final = 1e-4
CURVATURE: Final = 0.9
SETTLED_ITERATIONS: Final = 3
SETTLED_SMOOTHNESS: Final = 0.1
"""New obstacles are looked for after some iterations, once the smoothness cost per control point is below this."""

CONVERGED: Final = 0
REBOUND: Final = 1
"""A control point has met an obstacle that no pair knows."""
STUCK: Final = 2
"""The line search found no lower cost."""


class Problem(NamedTuple):
    """What the cost of control points (N, 3) is made of; weights: smoothness, collision, feasibility, fit."""

    dt: float  # seconds
    limits: Float64  # (3,) m/s, m/s^2, m/s^3
    pair_index: NDArray[np.int64]  # (P,)
    pair_p: Float64  # (P, 3)
    pair_v: Float64  # (P, 3)
    margin: float  # s_f, metres
    reference: Float64  # (N - 2, 3) positions at the knots to fit to; not read if the fit's weight is 0
    weights: Float64  # (4,)


@numba.njit(cache=True, nogil=True)
def total_cost(points: Float64, problem: Problem, gradient: Float64) -> tuple[float, float]:
    """The weighted sum, and smoothness alone; ``gradient`` (N, 3) is overwritten, zero at the fixed points."""
    gradient[:] = 0.0
    w = problem.weights
    smooth = costs.smoothness(points, w[0], gradient)
    total = w[0] * smooth
    total += w[1] * costs.collision(
        points, problem.pair_index, problem.pair_p, problem.pair_v, problem.margin, w[1], gradient
    )
    total += w[2] * costs.feasibility(points, problem.dt, problem.limits, w[2], gradient)
    if w[3] > 0:
        total += w[3] * costs.anisotropic_fit(points, problem.reference, w[3], gradient)
    gradient[:FIXED] = 0.0
    gradient[len(points) - FIXED :] = 0.0
    return total, smooth


@numba.njit(cache=True, nogil=True)
def minimise(points: Float64, problem: Problem, voxels: Voxels, tolerance: float) -> int:
    """Moves ``points`` (N, 3) to a minimum of `total_cost`; CONVERGED, REBOUND or STUCK.

    Stops when |gradient| <= tolerance * max(1, |points|), with points measured from the flight's start so that it does
    not depend on where the world's origin is.
    """
    shape = points.shape
    steps = np.zeros((MEMORY, *shape))
    changes = np.zeros((MEMORY, *shape))
    gradient = np.zeros(shape)
    trial = points.copy()
    trial_gradient = np.zeros(shape)
    cost, _ = total_cost(points, problem, gradient)
    direction = np.zeros(shape)
    for iteration in range(MAX_ITERATIONS):
        norm = np.sqrt(_dot(gradient, gradient))
        if norm <= tolerance * max(1.0, _extent(points)):
            return CONVERGED
        _descent_direction(gradient, steps, changes, iteration, direction)
        slope = _dot(gradient, direction)
        step = 1.0 if iteration > 0 else min(1.0, 1.0 / norm)
        low, high = 0.0, np.inf  # a bracket that is halved until both Wolfe conditions hold (Lewis and Overton)
        for _ in range(MAX_TRIALS):
            _move(points, step, direction, trial)
            trial_cost, smooth = total_cost(trial, problem, trial_gradient)
            if trial_cost > cost + SUFFICIENT_DECREASE * step * slope:
                high = step
            elif _dot(trial_gradient, direction) < CURVATURE * slope:
                low = step
            else:
                break
            step = 0.5 * (low + high) if high < np.inf else 2.0 * low
        if trial_cost > cost:
            return STUCK
        slot = iteration % MEMORY
        _move(trial, -1.0, points, steps[slot])
        _move(trial_gradient, -1.0, gradient, changes[slot])
        _move(trial, 0.0, trial, points)
        _move(trial_gradient, 0.0, trial_gradient, gradient)
        cost = trial_cost
        settled = iteration >= SETTLED_ITERATIONS and smooth < SETTLED_SMOOTHNESS * (len(points) - 2 * FIXED)
        if settled and meets_new_obstacle(points, problem, voxels):
            return REBOUND
    return CONVERGED


@numba.njit(cache=True, nogil=True)
def meets_new_obstacle(points: Float64, problem: Problem, voxels: Voxels) -> bool:
    """Whether a control point is blocked though it is a voxel or more on the right side of all its pairs."""
    for i in range(FIXED, len(points) - FIXED):
        if not is_blocked(voxels, points[i]):
            continue
        known = False
        for n in range(len(problem.pair_index)):
            if problem.pair_index[n] == i:
                distance = 0.0
                for k in range(3):
                    distance += (points[i, k] - problem.pair_p[n, k]) * problem.pair_v[n, k]
                known = known or distance < voxels.resolution
        if not known:
            return True
    return False


@numba.njit(cache=True, nogil=True)
def _descent_direction(gradient: Float64, steps: Float64, changes: Float64, count: int, out: Float64) -> None:
    """The two-loop recursion (Nocedal and Wright, algorithm 7.4) over the last ``count`` steps that are remembered."""
    _move(gradient, -2.0, gradient, out)  # -gradient
    first = max(0, count - MEMORY)
    shares = np.zeros(MEMORY)
    for n in range(count - 1, first - 1, -1):
        m = n % MEMORY
        curvature = _dot(steps[m], changes[m])
        if curvature > 0:
            shares[m] = _dot(steps[m], out) / curvature
            _move(out, -shares[m], changes[m], out)
    if count > 0:
        m = (count - 1) % MEMORY
        square = _dot(changes[m], changes[m])
        if square > 0:
            _move(out, _dot(steps[m], changes[m]) / square - 1.0, out, out)
    for n in range(first, count):
        m = n % MEMORY
        curvature = _dot(steps[m], changes[m])
        if curvature > 0:
            _move(out, shares[m] - _dot(changes[m], out) / curvature, steps[m], out)


@numba.njit(cache=True, nogil=True)
def _dot(a: Float64, b: Float64) -> float:
    total = 0.0
    for i in range(a.shape[0]):
        for k in range(3):
            total += a[i, k] * b[i, k]
    return total


@numba.njit(cache=True, nogil=True)
def _move(a: Float64, step: float, b: Float64, out: Float64) -> None:
    """out = a + step * b, all (N, 3)."""
    for i in range(a.shape[0]):
        for k in range(3):
            out[i, k] = a[i, k] + step * b[i, k]


@numba.njit(cache=True, nogil=True)
def _extent(points: Float64) -> float:
    """Norm of all points (N, 3) together, measured from the first."""
    total = 0.0
    for i in range(points.shape[0]):
        for k in range(3):
            total += (points[i, k] - points[0, k]) ** 2
    return float(np.sqrt(total))
