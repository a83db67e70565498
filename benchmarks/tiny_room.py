"""The smallest world that goes through every product: a coloured room of some 20,000 splats, and the settings for it.

The benchmarks of the machine room (rebuild, crash, scale_out) use it, so that a scene takes seconds and what is
measured is the machine room.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.files import write_ply

TINY = {
    "FLYMIRAGE_VIEWS__WIDTH": "80",
    "FLYMIRAGE_VIEWS__HEIGHT": "60",
    "FLYMIRAGE_VIEWS__ORBIT_YAWS": "6",
    "FLYMIRAGE_VIEWS__ORBIT_ELEVATIONS_DEG": "[-20.0]",
    "FLYMIRAGE_EXPLORATION__RIG_SPACING": "2.0",
    "FLYMIRAGE_TARGETS__MAX_TARGETS": "1",
    "FLYMIRAGE_ANNOTATION__VOXEL": "0.06",
    "FLYMIRAGE_TASKS__SETS": "1",
    "FLYMIRAGE_TASKS__TARGETS_PER_SET": "2",
    "FLYMIRAGE_FRAMES__WIDTH": "64",
    "FLYMIRAGE_FRAMES__HEIGHT": "48",
    "FLYMIRAGE_FRAMES__RATE": "5",
}
"""Environment of every command on a tiny scene."""

SH_0 = 0.28209479177387814
WALLS = ((0, 0, 0), (6, 5, 2.6))
FURNITURE = (  # low corner, high corner, RGB
    ((0.3, 0.4, 0.0), (1.3, 1.2, 0.8), (200, 40, 40)),
    ((4.6, 0.4, 0.0), (5.6, 1.4, 1.0), (40, 70, 200)),
    ((0.3, 3.8, 0.0), (1.2, 4.7, 1.5), (40, 160, 60)),
    ((4.5, 3.6, 0.0), (5.6, 4.7, 0.7), (220, 180, 40)),
)
CENTRE = (3.0, 2.5, 1.2)


def box(low: ArrayLike, high: ArrayLike, rgb: ArrayLike, step: float) -> GaussianCloud:
    """The six faces of a box, flat splats every ``step`` metres."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    means, scales = [], []
    for axis in range(3):
        others = [i for i in range(3) if i != axis]
        grids = [np.arange(low[i] + step / 2, high[i], step) for i in others]
        a, b = np.meshgrid(*grids, indexing="ij")
        for level in (low[axis], high[axis]):
            face = np.empty((a.size, 3))
            face[:, axis], face[:, others[0]], face[:, others[1]] = level, a.ravel(), b.ravel()
            flat = np.full((a.size, 3), 0.7 * step)
            flat[:, axis] = 0.004
            means.append(face)
            scales.append(flat)
    centres = np.concatenate(means)  # (N, 3)
    n = len(centres)
    colour = (np.asarray(rgb, float) / 255 - 0.5) / SH_0
    return GaussianCloud(
        centres.astype(np.float32),
        np.tile(np.array([0, 0, 0, 1], np.float32), (n, 1)),
        np.concatenate(scales).astype(np.float32),
        np.full(n, 0.95, np.float32),
        np.tile(colour.astype(np.float32), (n, 1, 1)),
    )


def tiny_room(variant: int = 0) -> GaussianCloud:
    """A furnished room, c at the origin of the file; ``variant`` moves the furniture by a few centimetres."""
    parts = [box(*WALLS, (215, 205, 190), 0.1)]
    for i, (low, high, rgb) in enumerate(FURNITURE):
        shift = np.array([0.02 * ((variant + i) % 5), 0.02 * ((variant // 5 + i) % 5), 0.0])
        parts.append(box(np.add(low, shift), np.add(high, shift), rgb, 0.06))
    joined = [np.concatenate([getattr(p, f) for p in parts]) for f in GaussianCloud.__dataclass_fields__]
    joined[0] = (joined[0] - np.asarray(CENTRE)).astype(np.float32)
    return GaussianCloud(*joined)


if __name__ == "__main__":
    write_ply(tiny_room(), Path(sys.argv[1]))
