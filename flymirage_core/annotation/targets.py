"""Algorithm 1 of the paper, distance-aware target selection, and `Targets`, the product of the `targets` asset."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.settings import TargetSettings


@dataclass(frozen=True)
class Targets:
    """Objects to go and look at more closely, in the order in which Algorithm 1 took them; may be empty."""

    boxes: tuple[ObjectBox, ...]

    def summary(self) -> dict[str, str | int | float]:
        return {"targets": len(self.boxes), "labels": ", ".join(b.label for b in self.boxes)}

    def save(self, folder: Path) -> None:
        BoxMap(self.boxes).save(folder)

    @staticmethod
    def load(folder: Path) -> "Targets":
        return Targets(BoxMap.load(folder).boxes)


def select_targets(boxes: BoxMap, centre: ArrayLike, settings: TargetSettings) -> Targets:
    """Algorithm 1 (section III-B): far objects, spread in distance and direction, farthest first.

    Args:
        boxes: the candidate set O.
        centre: (3,) the scene centre c, world frame, metres.
        settings: N_t, theta_th, d_th1 (also d_prune) and d_th2.

    Returns:
        At most N_t targets beyond d_th2; else the single farthest in (d_th1, d_th2]; else none. Candidates at equal
        distance are taken in the order of their ids. A candidate straight above or below c has azimuth 0.
    """
    candidates = sorted(boxes, key=lambda box: box.object_id)
    offsets = np.array([box.centre for box in candidates], float).reshape(-1, 3) - np.asarray(centre, float)  # (N, 3)
    distances = np.linalg.norm(offsets, axis=1)  # line 1: d_i
    order = np.argsort(-distances, kind="stable")  # line 2
    chosen = _far_and_spread(offsets, distances, order, settings)  # lines 3-17
    if not chosen:  # lines 18-23
        middle = (distances > settings.near_distance) & (distances <= settings.far_distance)
        chosen = [int(i) for i in order if middle[i]][:1]
    return Targets(tuple(candidates[i] for i in chosen))


def _far_and_spread(
    offsets: NDArray[np.float64], distances: NDArray[np.float64], order: NDArray[np.intp], settings: TargetSettings
) -> list[int]:
    """Lines 3 to 17: the greedy walk from the farthest candidate inwards."""
    azimuths = np.arctan2(offsets[:, 1], offsets[:, 0])  # (N,)
    min_azimuth = np.radians(settings.min_azimuth_deg)  # theta_th
    active = np.ones(len(offsets), bool)  # A
    chosen: list[int] = []
    for i in order:
        if not active[i] or distances[i] <= settings.far_distance:
            continue
        chosen.append(int(i))
        near = np.linalg.norm(offsets - offsets[i], axis=1) < settings.near_distance  # d_prune = d_th1
        active &= ~(near | (azimuth_difference(azimuths, azimuths[i]) < min_azimuth))
        if len(chosen) == settings.max_targets:
            break
    return chosen


def azimuth_difference(a: ArrayLike, b: ArrayLike) -> NDArray[np.float64]:
    """Smallest angle between two azimuths, radians in [0, pi]; broadcasts.

    >>> float(np.degrees(azimuth_difference(np.radians(175), np.radians(-175))).round(9))
    10.0
    """
    turn = np.abs(np.asarray(a, float) - np.asarray(b, float)) % (2 * np.pi)
    return np.asarray(np.minimum(turn, 2 * np.pi - turn))
