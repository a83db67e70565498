"""EGO-Planner's costs of control points and their gradients (arXiv 2008.08835, section IV), as compiled kernels.

Each function returns the cost and adds ``weight`` times its gradient to ``gradient`` (N, 3). Two deliberate differences
from the original: limits are on norms instead of on each axis, and jerk has one.
"""

from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.navigation.bspline import FIXED

Float64 = NDArray[np.float64]

ALONG_WEIGHT: Final = 1 / 25
"""1 / a^2 of the anisotropic fit (a = 5): deviation along the path is nearly free ..."""
ACROSS_WEIGHT: Final = 1.0
"""1 / b^2 (b = 1): ... deviation across it is not."""


@numba.njit(cache=True, nogil=True)
def smoothness(points: Float64, weight: float, gradient: Float64) -> float:
    """J_s: sum of squared third differences of the control points (N, 3)."""
    cost = 0.0
    for i in range(len(points) - 3):
        for k in range(3):
            third = points[i + 3, k] - 3 * points[i + 2, k] + 3 * points[i + 1, k] - points[i, k]
            cost += third * third
            slope = 2 * weight * third
            gradient[i, k] -= slope
            gradient[i + 1, k] += 3 * slope
            gradient[i + 2, k] -= 3 * slope
            gradient[i + 3, k] += slope
    return cost


@numba.njit(cache=True, nogil=True)
def collision(
    points: Float64,
    pair_index: NDArray[np.int64],  # (P,) control point of each pair
    pair_p: Float64,  # (P, 3) on the obstacle's surface
    pair_v: Float64,  # (P, 3) unit, out of the obstacle
    margin: float,  # s_f, metres
    weight: float,
    gradient: Float64,
) -> float:
    """J_d, of c = s_f - (Q_i - p) . v: nothing below 0, c^3 up to s_f, then a parabola that joins it smoothly."""
    cost = 0.0
    for n in range(len(pair_index)):
        i = pair_index[n]
        if i < FIXED or i >= len(points) - FIXED:
            continue
        distance = 0.0
        for k in range(3):
            distance += (points[i, k] - pair_p[n, k]) * pair_v[n, k]
        lack = margin - distance
        if lack <= 0:
            continue
        if lack < margin:
            cost += lack**3
            slope = 3 * lack**2
        else:
            cost += 3 * margin * lack**2 - 3 * margin**2 * lack + margin**3
            slope = 6 * margin * lack - 3 * margin**2
        for k in range(3):
            gradient[i, k] -= weight * slope * pair_v[n, k]
    return cost


@numba.njit(cache=True, nogil=True)
def feasibility(points: Float64, dt: float, limits: Float64, weight: float, gradient: Float64) -> float:
    """J_f: squared excess of the norms of velocity, acceleration and jerk points over ``limits`` (3,).

    The factors dt^-2, 1, dt^2 bring the three to one magnitude.
    """
    n = len(points)
    cost = 0.0
    d = np.zeros(3)
    for i in range(n - 1):
        for k in range(3):
            d[k] = (points[i + 1, k] - points[i, k]) / dt
        norm = np.sqrt((d * d).sum())
        excess = norm - limits[0]
        if excess > 0:
            cost += excess**2 / dt**2
            slope = weight * 2 * excess / norm / dt**3
            for k in range(3):
                gradient[i, k] -= slope * d[k]
                gradient[i + 1, k] += slope * d[k]
    for i in range(n - 2):
        for k in range(3):
            d[k] = (points[i + 2, k] - 2 * points[i + 1, k] + points[i, k]) / dt**2
        norm = np.sqrt((d * d).sum())
        excess = norm - limits[1]
        if excess > 0:
            cost += excess**2
            slope = weight * 2 * excess / norm / dt**2
            for k in range(3):
                gradient[i, k] += slope * d[k]
                gradient[i + 1, k] -= 2 * slope * d[k]
                gradient[i + 2, k] += slope * d[k]
    for i in range(n - 3):
        for k in range(3):
            d[k] = (points[i + 3, k] - 3 * points[i + 2, k] + 3 * points[i + 1, k] - points[i, k]) / dt**3
        norm = np.sqrt((d * d).sum())
        excess = norm - limits[2]
        if excess > 0:
            cost += excess**2 * dt**2
            slope = weight * 2 * excess / norm / dt
            for k in range(3):
                gradient[i, k] -= slope * d[k]
                gradient[i + 1, k] += 3 * slope * d[k]
                gradient[i + 2, k] -= 3 * slope * d[k]
                gradient[i + 3, k] += slope * d[k]
    return cost


@numba.njit(cache=True, nogil=True)
def anisotropic_fit(points: Float64, reference: Float64, weight: float, gradient: Float64) -> float:
    """The refinement's fit to ``reference`` (N - 2, 3): stiff across the path, nearly free along it."""
    cost = 0.0
    x = np.zeros(3)
    v = np.zeros(3)
    for i in range(2, len(points) - 2):
        length = 0.0
        for k in range(3):
            x[k] = (points[i - 1, k] + 4 * points[i, k] + points[i + 1, k]) / 6 - reference[i - 1, k]
            v[k] = reference[i, k] - reference[i - 2, k]
            length += v[k] * v[k]
        length = max(np.sqrt(length), 1e-12)  # a resting stretch of the path has no direction
        along = 0.0
        for k in range(3):
            v[k] /= length
            along += x[k] * v[k]
        for k in range(3):
            across = x[k] - along * v[k]
            cost += across * across * ACROSS_WEIGHT
            slope = 2 * weight * (ACROSS_WEIGHT * across + ALONG_WEIGHT * along * v[k]) / 6
            gradient[i - 1, k] += slope
            gradient[i, k] += 4 * slope
            gradient[i + 1, k] += slope
        cost += along * along * ALONG_WEIGHT
    return cost
