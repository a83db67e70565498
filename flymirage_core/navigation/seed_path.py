"""Where the optimiser starts from: a path through free space, and the times at which it is flown.

The original starts from a straight line whatever lies between; with a known map the way round is known too, and a path
seed is what makes one planning call enough.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.search import clearance_weighted_path
from flymirage_core.occupancy.smoothing import resample_path, smooth_path

Float64 = NDArray[np.float64]

COMFORTABLE_CLEARANCE: Final = 0.5
"""Metres from obstacles beyond which a seed path pays nothing for being near to them."""
SMOOTHING_ITERATIONS: Final = 10
"""Enough to take the steps of the voxels out of a path, and not enough to pull it tight round corners."""
MIN_SAMPLES: Final = 7
BOW_SPACING: Final = 0.1
"""Metres between the points of a bowed line."""
SIDEWAYS_BOW: Final = 0.4
UPWARDS_BOW: Final = 0.2
"""Largest bow as a share of the distance."""


def path_seed(space: OccupancyGrid, clearance: NDArray[np.float32], start: Float64, goal: Float64) -> Float64:
    """A free path (K, 3) in the inflated ``space`` that keeps away from obstacles where there is room.

    ``clearance`` (X, Y, Z): metres, of the grid before inflation.

    Raises:
        PlanningError: the start or the goal is blocked, or nothing connects them.
    """
    path = clearance_weighted_path(space, clearance, start, goal, COMFORTABLE_CLEARANCE)
    return smooth_path(space, path, SMOOTHING_ITERATIONS)


def bow_seed(start: Float64, goal: Float64, generator: np.random.Generator) -> Float64:
    """The straight line (K, 3) bent into a random bow, whatever is in its way."""
    line = resample_path(np.stack([start, goal]), BOW_SPACING)
    along = goal - start
    distance = float(np.linalg.norm(along))
    flat = np.hypot(along[0], along[1])
    sideways = np.array([-along[1], along[0], 0.0]) / flat if flat > 0 else np.array([1.0, 0.0, 0.0])
    upwards = np.cross(along / distance, sideways)
    bow = sideways * generator.uniform(-SIDEWAYS_BOW, SIDEWAYS_BOW) * distance
    bow += upwards * generator.uniform(-UPWARDS_BOW, UPWARDS_BOW) * distance
    return np.asarray(line + np.sin(np.linspace(0, np.pi, len(line)))[:, None] ** 2 * bow)


def timed_samples(
    path: Float64, speed: float, acceleration: float, spacing: float, start_speed: float = 0.0
) -> tuple[Float64, float]:
    """Samples (K, 3) of a flight along ``path`` from ``start_speed`` to rest, and the seconds between them.

    Speed rises and falls in half cosines, which bounds jerk as well: by 2 ``acceleration``^2 / ``speed``. Samples lie
    at most ``spacing`` metres apart; there are at least `MIN_SAMPLES`.
    """
    legs = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(legs)])  # (K',)
    length = float(along[-1])
    start = min(start_speed, float(np.sqrt(4 * acceleration * length / np.pi)))  # from more one could not stop
    top = max(min(speed, float(np.sqrt(2 * acceleration * length / np.pi + start**2 / 2))), start)
    rise, fall = (np.pi * change / (2 * acceleration) for change in (top - start, top))  # seconds
    cruise = max((length - (start + top) / 2 * rise - top / 2 * fall) / top, 0.0)
    duration = rise + cruise + fall
    count = max(MIN_SAMPLES, int(np.ceil(duration * top / spacing)) + 1)
    times = np.linspace(0, duration, count)
    rising = _travelled(np.clip(times, 0, rise), start, top, rise) + top * np.clip(times - rise, 0, None)
    falling = length - _travelled(np.clip(duration - times, 0, fall), 0.0, top, fall)
    stations = np.where(times > duration - fall, falling, rising)
    samples = np.stack([np.interp(stations, along, path[:, axis]) for axis in range(3)], axis=1)
    samples[0], samples[-1] = path[0], path[-1]
    return samples, duration / (count - 1)


def _travelled(times: Float64, start: float, end: float, ramp: float) -> Float64:
    """Metres in the first ``times`` seconds of a ramp of speed, half a cosine that takes ``ramp`` seconds."""
    if ramp == 0:
        return np.zeros_like(times)
    return np.asarray((start + end) / 2 * times - (end - start) / 2 * ramp / np.pi * np.sin(np.pi * times / ramp))
