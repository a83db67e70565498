"""The words that boxes share: what a thing rests on, the label of a thing without a name, and which green is leaves."""

from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

UNKNOWN: Final = "object"
"""The label of a thing for which nothing better is known; its colour and size still tell it from others."""
GREEN_HUE: Final = (100.0, 165.0)
"""Degrees, atan2(b, a) of CIELAB, of leaves."""
GREEN_CHROMA: Final = 14.0


class Support(Enum):
    """What a thing rests on."""

    FLOOR = "floor"
    SURFACE = "surface"
    WALL = "wall"
    CEILING = "ceiling"


def green(lab: NDArray[np.float32]) -> NDArray[np.bool_]:
    """(N,) which colours (N, 3), plain CIELAB, are those of leaves."""
    hue = np.degrees(np.arctan2(lab[:, 2], lab[:, 1]))
    chroma = np.hypot(lab[:, 1], lab[:, 2])
    return np.asarray((hue > GREEN_HUE[0]) & (hue < GREEN_HUE[1]) & (chroma > GREEN_CHROMA))
