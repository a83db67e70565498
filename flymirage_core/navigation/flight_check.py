"""The independent check of a flight: shares no code with the planner, and only what passes here leaves the planner.

Curves are evaluated by scipy, distances to obstacles are exact and found by search, and continuity is judged from
samples.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline

from flymirage_core.errors import PlanningError
from flymirage_core.occupancy.grid import FREE, OccupancyGrid
from flymirage_core.settings import PlannerSettings

Float64 = NDArray[np.float64]

SAMPLE_RATE: Final = 100.0
"""Hz ..."""
SAMPLE_SPACING: Final = 0.02
"""... or this many metres between samples, whichever is denser."""
MAX_END_ERROR: Final = 0.01
"""Metres between where a flight should begin or end and where it does."""
RELATIVE_TOLERANCE: Final = 1e-6
"""Rounding is forgiven: limits and clearance."""


@dataclass(frozen=True)
class FlightMeasures:
    """What the sampled curve measures; metres and seconds, norms."""

    duration: float
    length: float
    max_speed: float
    max_acceleration: float
    max_jerk: float
    min_clearance: float  # to the nearest blocked voxel's face, exact
    end_error: float  # the larger one of both ends


Piece = tuple[ArrayLike, float, float]
"""Control points (N, 3) of a uniform cubic B-spline, its knot interval, and for how many seconds it is flown."""


def check_flight(
    pieces: Sequence[Piece],
    ends: tuple[ArrayLike, ArrayLike],  # where it should start and stop, (3,) each
    grid: OccupancyGrid,
    inflated: OccupancyGrid,
    inflation: float,
    settings: PlannerSettings,
) -> FlightMeasures:
    """Measures a flight along one or more uniform cubic B-splines, flown one after the other, and accepts it.

    Accepted is: no sample in a blocked voxel of either grid; exact clearance at least ``inflation``; speed,
    acceleration and jerk within the limits; both ends within `MAX_END_ERROR` and at rest; position, velocity and
    acceleration continuous.

    Raises:
        PlanningError: the first of these that fails, with place and value.
    """
    curve = _Curve(pieces)
    times = _sample_times(curve)
    position, velocity, acceleration, jerk = (curve(times, nu) for nu in range(4))  # (M, 3) each
    clearance = exact_clearance(grid, position)
    measures = FlightMeasures(
        duration=float(times[-1]),
        length=float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum()),
        max_speed=_largest(velocity),
        max_acceleration=_largest(acceleration),
        max_jerk=_largest(jerk),
        min_clearance=float(clearance.min()),
        end_error=max(_largest(position[0] - ends[0]), _largest(position[-1] - ends[1])),
    )
    for name, g in (("an obstacle", grid), ("an inflated obstacle", inflated)):
        touched = np.flatnonzero(g.state_at(position) != FREE)
        if len(touched):
            raise PlanningError(f"in {name} at t={times[touched[0]]:.2f} s")
    if measures.min_clearance < inflation * (1 - RELATIVE_TOLERANCE):
        raise PlanningError(f"clearance {measures.min_clearance:.3f} m is less than {inflation:g} m")
    _check_limits(measures, settings)
    if measures.end_error > MAX_END_ERROR:
        raise PlanningError(f"an end is missed by {measures.end_error:.3f} m")
    _check_continuity(times, position, velocity, acceleration, measures.max_jerk)
    return measures


def exact_clearance(grid: OccupancyGrid, points: ArrayLike) -> Float64:
    """Metres (M,) from world points (M, 3) to the nearest blocked voxel's face; 0 in blocked voxels.

    Exact, where `occupancy.distance.clearance_at` knows voxel centres only. Outside of the grid is blocked.
    """
    cells = (np.asarray(points, float) - grid.origin) / grid.resolution  # (M, 3) in voxels
    return _clearances(grid.state, np.ascontiguousarray(cells)) * grid.resolution


class _Curve:
    """The pieces in scipy's hands."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self.splines = []
        for points, interval, _ in pieces:
            knots = (np.arange(len(np.asarray(points)) + 4) - 3) * interval
            self.splines.append(BSpline(knots, np.asarray(points, float), 3))
        self.starts = np.concatenate([[0.0], np.cumsum([duration for *_, duration in pieces])])

    def __call__(self, times: Float64, derivative: int = 0) -> Float64:
        which = np.clip(np.searchsorted(self.starts, times, side="right") - 1, 0, len(self.splines) - 1)
        out = np.empty((len(times), 3))
        for n, spline in enumerate(self.splines):
            here = which == n
            out[here] = spline(times[here] - self.starts[n], derivative)
        return out


def _sample_times(curve: _Curve) -> Float64:
    end = float(curve.starts[-1])
    coarse = np.linspace(0, end, 200)
    length = float(np.linalg.norm(np.diff(curve(coarse), axis=0), axis=1).sum())
    fastest = max(_largest(curve(coarse, 1)), length / end)
    count = int(np.ceil(end * max(SAMPLE_RATE, fastest / SAMPLE_SPACING))) + 1
    return np.linspace(0, end, count)


def _largest(vectors: Float64) -> float:
    return float(np.linalg.norm(vectors, axis=-1).max())


def _check_limits(measures: FlightMeasures, settings: PlannerSettings) -> None:
    for name, value, limit in (
        ("speed", measures.max_speed, settings.max_speed),
        ("acceleration", measures.max_acceleration, settings.max_acceleration),
        ("jerk", measures.max_jerk, settings.max_jerk),
    ):
        if not value <= limit * (1 + RELATIVE_TOLERANCE):
            raise PlanningError(f"{name} {value:.3f} exceeds {limit:g}")


def _check_continuity(
    times: Float64, position: Float64, velocity: Float64, acceleration: Float64, max_jerk: float
) -> None:
    """Steps of each quantity must be what its derivative explains, up to what the jerk can do within one step."""
    dt = float(times[1] - times[0])
    for name, values, slopes, rest in (
        ("position", position, velocity, max_jerk * dt**3),
        ("velocity", velocity, acceleration, max_jerk * dt**2),
    ):
        explained = (slopes[1:] + slopes[:-1]) / 2 * dt
        gap = _largest(np.diff(values, axis=0) - explained)
        if gap > rest + 1e-9:
            raise PlanningError(f"{name} jumps by {gap:.2e}")
    if _largest(np.diff(acceleration, axis=0)) > max_jerk * dt * (1 + RELATIVE_TOLERANCE) + 1e-9:
        raise PlanningError("acceleration jumps")
    moving = max(_largest(velocity[[0, -1]]), _largest(acceleration[[0, -1]]))
    if moving > 1e-6:
        raise PlanningError(f"not at rest at an end ({moving:.2e})")


@numba.njit(cache=True, nogil=True)
def _clearances(state: NDArray[np.uint8], cells: Float64) -> Float64:
    """Distances (M,) in voxels: shells of voxels round each point are searched until none can be nearer."""
    out = np.empty(len(cells))
    for m in range(len(cells)):
        px, py, pz = cells[m, 0], cells[m, 1], cells[m, 2]
        ci, cj, ck = int(np.floor(px)), int(np.floor(py)), int(np.floor(pz))
        inset = min(px - ci, ci + 1 - px, py - cj, cj + 1 - py, pz - ck, ck + 1 - pz)
        best = np.inf  # squared
        shell = 0
        while best > max(0.0, shell - 1 + inset) ** 2 or shell == 0:
            for i in range(ci - shell, ci + shell + 1):
                dx = max(i - px, px - i - 1, 0.0)
                for j in range(cj - shell, cj + shell + 1):
                    dy = max(j - py, py - j - 1, 0.0)
                    if dx * dx + dy * dy >= best:
                        continue
                    on_side = abs(i - ci) == shell or abs(j - cj) == shell
                    for k in range(ck - shell, ck + shell + 1, 1 if on_side or shell == 0 else 2 * shell):
                        blocked = True  # outside of the grid
                        if 0 <= i < state.shape[0] and 0 <= j < state.shape[1] and 0 <= k < state.shape[2]:
                            blocked = state[i, j, k] != FREE
                        if blocked:
                            dz = max(k - pz, pz - k - 1, 0.0)
                            best = min(best, dx * dx + dy * dy + dz * dz)
            shell += 1
        out[m] = np.sqrt(best)
    return out
