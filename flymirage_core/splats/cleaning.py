"""What is taken out of a world before use: numbers that are not finite, and Gaussians that only spoil it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.errors import WorldError
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.cloud import GaussianCloud


def clean(cloud: GaussianCloud, centre: ArrayLike, settings: CleaningSettings) -> tuple[GaussianCloud, dict[str, int]]:
    """``cloud`` (world frame, metres) without its bad Gaussians, and how many were removed for which reason.

    In turn: not finite (or with a quaternion of length 0), nearly invisible, giant (haze, sky painted near), far from c
    (captured rooms have outliers hundreds of metres away). Each is counted once, for the first reason that holds.

    Raises:
        WorldError: nothing is left.
    """
    reasons = {
        "removed_not_finite": ~finite(cloud),
        "removed_invisible": cloud.opacities < settings.min_opacity,
        "removed_giant": cloud.scales.max(axis=1, initial=0) > settings.max_scale,
        "removed_far": np.linalg.norm(cloud.means - np.asarray(centre, np.float32), axis=1) > settings.max_distance,
    }
    keep = np.ones(len(cloud), bool)
    counts = {}
    for reason, holds in reasons.items():
        counts[reason] = int((keep & holds).sum())
        keep &= ~holds
    if not keep.any():
        told = ", ".join(f"{count} {reason.removeprefix('removed_')}" for reason, count in counts.items() if count)
        raise WorldError(
            f"nothing is left of the world's {len(cloud)} Gaussians after cleaning ({told or 'it is empty'})"
        )
    return cloud[keep], counts


def finite(cloud: GaussianCloud) -> NDArray[np.bool_]:
    """(N,) True for the Gaussians all of whose numbers are finite."""
    rows = [
        cloud.means,
        cloud.quaternions,
        cloud.scales,
        cloud.opacities[:, None],
        cloud.sh.reshape(len(cloud), cloud.sh.shape[1] * 3),
    ]
    return np.asarray(np.logical_and.reduce([np.isfinite(row).all(axis=1) for row in rows]))
