"""Uniform cubic B-splines in space: evaluation, derivatives, joining, a fit with exact ends. No planning here.

N control points Q_i and one knot interval dt; the spline lives on times [0, (N - 3) dt]. Position at time t = (i + u)
dt: p = [1 u u^2 u^3] M [Q_i .. Q_i+3]. Velocity is piecewise quadratic, acceleration piecewise linear, jerk piecewise
constant.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float64 = NDArray[np.float64]

BASIS: Final = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6  # (4, 4) powers x points
FIXED: Final = 3
"""Control points that position, velocity and acceleration at an end of the spline determine."""
SPEED_SAMPLES: Final = 8
"""Samples for each knot interval when the highest speed is looked for."""


@dataclass(frozen=True, eq=False)
class UniformBSpline:
    """A cubic B-spline with constant knot interval; twice continuously differentiable."""

    control_points: Float64  # (N, 3) metres, N >= 4
    interval: float  # seconds between knots

    @property
    def duration(self) -> float:
        return (len(self.control_points) - 3) * self.interval

    def at(self, times: ArrayLike, derivative: int = 0) -> Float64:
        """Position (..., 3), or its time derivative of order 1 to 3, at ``times`` (...,) clipped to the spline's."""
        knots = np.asarray(times, float) / self.interval
        segment = np.clip(np.floor(knots + 1e-9).astype(int), 0, len(self.control_points) - 4)
        u = np.clip(knots - segment, 0.0, 1.0)
        powers = np.stack([_power_derivative(u, k, derivative) for k in range(4)], axis=-1)  # (..., 4)
        near = self.control_points[segment[..., None] + np.arange(4)]  # (..., 4, 3)
        return np.asarray(np.einsum("...k,...kd->...d", powers @ BASIS, near) / self.interval**derivative)

    def stretched(self, factor: float) -> "UniformBSpline":
        """The same curve flown in ``factor`` times the time."""
        return UniformBSpline(self.control_points, self.interval * factor)

    def highest_norms(self) -> tuple[float, float, float]:
        """Largest speed (sampled), acceleration and jerk (exact: both are largest at a knot)."""
        points, dt = self.control_points, self.interval
        count = (len(points) - 3) * SPEED_SAMPLES + 1
        speed = np.linalg.norm(self.at(np.linspace(0, self.duration, count), 1), axis=1).max()
        acceleration = np.linalg.norm(np.diff(points, 2, axis=0), axis=1).max() / dt**2
        jerk = np.linalg.norm(np.diff(points, 3, axis=0), axis=1).max() / dt**3
        return float(speed), float(acceleration), float(jerk)


@dataclass(frozen=True, eq=False)
class SplinePiece:
    """What was flown of a spline: its first ``duration`` seconds."""

    spline: UniformBSpline
    duration: float


@dataclass(frozen=True, eq=False)
class JoinedSplines:
    """Splines that were flown one after the other, each for a while; as smooth as its joints."""

    pieces: tuple[SplinePiece, ...]

    @property
    def duration(self) -> float:
        return float(sum(piece.duration for piece in self.pieces))

    def at(self, times: ArrayLike, derivative: int = 0) -> Float64:
        """As `UniformBSpline.at`."""
        moments = np.asarray(times, float)
        starts = np.concatenate([[0.0], np.cumsum([piece.duration for piece in self.pieces])])
        which = np.clip(np.searchsorted(starts, moments, side="right") - 1, 0, len(self.pieces) - 1)  # (...,)
        out = np.empty((*moments.shape, 3))
        for n, piece in enumerate(self.pieces):
            here = which == n
            out[here] = piece.spline.at(np.clip(moments[here] - starts[n], 0.0, piece.duration), derivative)
        return out


def fit_bspline(samples: ArrayLike, interval: float, derivatives: ArrayLike | None = None) -> UniformBSpline:
    """The spline through samples (K, 3) taken every ``interval`` seconds: exactly at both ends, least squares between.

    ``derivatives`` (4, 3): first velocity, last velocity, first acceleration, last acceleration; zeros if not given. An
    end's position, velocity and acceleration fix its three control points, so flights join without a jump. (The
    original gives these six conditions no more weight than the samples, and jumps.) K >= 4, and N = K + 2.
    """
    points = np.asarray(samples, float)
    ends = np.zeros((4, 3)) if derivatives is None else np.asarray(derivatives, float)
    count = len(points) + 2
    control = np.zeros((count, 3))  # (N, 3)
    control[:FIXED] = _end_points(points[0], ends[0], ends[2], interval)
    control[-FIXED:] = _end_points(points[-1], ends[1], ends[3], interval)
    rows = np.arange(len(points))
    system = np.zeros((len(points), count))  # (K, N)
    for offset, weight in enumerate(BASIS[0, :3]):
        system[rows, rows + offset] = weight
    if count > 2 * FIXED:
        rest = points - system @ control
        inner = slice(FIXED, count - FIXED)
        control[inner] = np.linalg.lstsq(system[1:-1, inner], rest[1:-1], rcond=None)[0]
    return UniformBSpline(control, interval)


def _end_points(position: Float64, velocity: Float64, acceleration: Float64, dt: float) -> Float64:
    """The three control points (3, 3) round a knot with this position, velocity and acceleration."""
    middle = position - acceleration * dt**2 / 6
    bend = acceleration * dt**2 / 2
    return np.stack([middle - velocity * dt + bend, middle, middle + velocity * dt + bend])


def _power_derivative(u: Float64, power: int, order: int) -> Float64:
    """d^order/du^order of u^power."""
    if order > power:
        return np.zeros_like(u)
    factor = float(np.prod(np.arange(power - order + 1, power + 1)))
    return factor * u ** (power - order)
