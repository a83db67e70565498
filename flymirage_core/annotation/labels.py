"""Names for boxes from what geometry and colour can tell: usual sizes, what a thing stands on, whether it has leaves.

A noun is given only if the sizes fit it; if nouns of one family fit alike, the family's name is; all else is "object".
The sizes are those of furniture catalogues; a trained recogniser is a later, better source.
"""

from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

UNKNOWN: Final = "object"
MAX_MISFIT: Final = 2.6
"""Root of the summed squared deviations, in standard deviations, beyond which sizes do not fit a noun."""
CLEAR_MARGIN: Final = 0.45
"""By so much smaller a misfit must one noun win over another family's to be believed."""
GREEN_HUE: Final = (100.0, 165.0)
"""Degrees, atan2(b, a) of CIELAB, of leaves."""
GREEN_CHROMA: Final = 14.0
MIN_GREEN_SHARE: Final = 0.35
"""Of its points, for a thing to be a plant ..."""
MIN_LEAF_VARIATION: Final = 0.065
"""... whose green points have at least this median `surface_variation`: leaves are rough, green cabinets are not."""


class Support(Enum):
    """What a thing rests on."""

    FLOOR = "floor"
    SURFACE = "surface"
    WALL = "wall"
    CEILING = "ceiling"


@dataclass(frozen=True)
class UsualSize:
    """Median sizes in metres of a kind of thing (longer side, shorter side, height), and how much they vary."""

    noun: str
    family: str  # name to fall back on when several of it fit
    support: Support
    size: tuple[float, float, float]
    spread: tuple[float, float, float] = (0.2, 0.2, 0.2)  # standard deviations of the logarithms
    rarity: float = 0.0  # added to the misfit: by so much better must a rare thing fit than a common one


_F, _S, _W, _C = Support.FLOOR, Support.SURFACE, Support.WALL, Support.CEILING
USUAL_SIZES: Final = (
    UsualSize("dining table", "table", _F, (1.75, 0.92, 0.75), (0.2, 0.18, 0.06)),
    UsualSize("table", "table", _F, (1.05, 0.98, 0.74), (0.18, 0.2, 0.06)),
    UsualSize("desk", "table", _F, (1.45, 0.7, 0.75), (0.15, 0.13, 0.06)),
    UsualSize("coffee table", "table", _F, (1.1, 0.62, 0.4), (0.2, 0.2, 0.15)),
    UsualSize("side table", "table", _F, (0.5, 0.47, 0.55), (0.15, 0.15, 0.12)),
    UsualSize("console table", "table", _F, (1.2, 0.37, 0.8), (0.2, 0.15, 0.1)),
    UsualSize("counter", "table", _F, (2.0, 0.65, 0.95), (0.2, 0.15, 0.08)),
    UsualSize("chair", "chair", _F, (0.52, 0.48, 0.9), (0.12, 0.12, 0.09)),
    UsualSize("office chair", "chair", _F, (0.66, 0.62, 1.05), (0.1, 0.1, 0.1)),
    UsualSize("armchair", "chair", _F, (0.92, 0.85, 0.85), (0.1, 0.1, 0.12)),
    UsualSize("stool", "seat", _F, (0.39, 0.37, 0.55), (0.12, 0.12, 0.2)),
    UsualSize("pouf", "seat", _F, (0.57, 0.53, 0.4), (0.15, 0.15, 0.1)),
    UsualSize("bench", "bench", _F, (1.4, 0.42, 0.46), (0.2, 0.12, 0.08)),
    UsualSize("sofa", "sofa", _F, (2.05, 0.9, 0.82), (0.15, 0.12, 0.12)),
    UsualSize("bed", "bed", _F, (2.1, 1.6, 0.9), (0.08, 0.2, 0.3)),
    UsualSize("bookshelf", "cabinet", _F, (1.0, 0.33, 1.85), (0.2, 0.13, 0.13)),
    UsualSize("wardrobe", "cabinet", _F, (1.25, 0.6, 2.0), (0.2, 0.1, 0.08)),
    UsualSize("cabinet", "cabinet", _F, (1.0, 0.46, 0.95), (0.2, 0.13, 0.15)),
    UsualSize("sideboard", "cabinet", _F, (1.6, 0.46, 0.82), (0.15, 0.12, 0.1)),
    UsualSize("filing cabinet", "cabinet", _F, (0.6, 0.47, 1.2), (0.12, 0.1, 0.15)),
    UsualSize("nightstand", "cabinet", _F, (0.5, 0.42, 0.55), (0.12, 0.1, 0.1)),
    UsualSize("tv stand", "cabinet", _F, (1.5, 0.42, 0.5), (0.18, 0.12, 0.12)),
    UsualSize("refrigerator", "refrigerator", _F, (0.74, 0.68, 1.8), (0.12, 0.1, 0.1)),
    UsualSize("floor lamp", "lamp", _F, (0.42, 0.4, 1.6), (0.15, 0.15, 0.1)),
    UsualSize("vase", "vase", _F, (0.36, 0.34, 0.68), (0.15, 0.15, 0.2)),
    UsualSize("basket", "container", _F, (0.44, 0.42, 0.38), (0.15, 0.15, 0.15)),
    UsualSize("box", "container", _F, (0.52, 0.42, 0.4), (0.18, 0.18, 0.18)),
    UsualSize("waste bin", "container", _F, (0.35, 0.33, 0.6), (0.15, 0.15, 0.17)),
    UsualSize("barrel", "barrel", _F, (0.6, 0.58, 0.88), (0.08, 0.08, 0.08), rarity=0.8),
    UsualSize("machine", "machine", _F, (1.45, 0.9, 1.4), (0.2, 0.15, 0.15), rarity=0.8),
    UsualSize("suitcase", "suitcase", _F, (0.46, 0.28, 0.8), (0.12, 0.15, 0.18)),
    UsualSize("sign", "sign", _F, (0.8, 0.38, 1.6), (0.2, 0.25, 0.1), rarity=0.8),
    UsualSize("traffic cone", "traffic cone", _F, (0.37, 0.36, 0.7), (0.08, 0.08, 0.1), rarity=0.8),
    UsualSize("gas cylinder", "gas cylinder", _F, (0.29, 0.28, 1.35), (0.1, 0.1, 0.12), rarity=0.8),
    UsualSize("column", "column", _F, (0.46, 0.44, 2.8), (0.15, 0.15, 0.08), rarity=0.8),
    UsualSize("table lamp", "lamp", _S, (0.3, 0.29, 0.48), (0.15, 0.15, 0.15)),
    UsualSize("vase", "vase", _S, (0.21, 0.2, 0.34), (0.18, 0.18, 0.18)),
    UsualSize("bowl", "bowl", _S, (0.32, 0.31, 0.14), (0.15, 0.15, 0.2)),
    UsualSize("books", "books", _S, (0.28, 0.22, 0.19), (0.15, 0.15, 0.3), rarity=0.5),
    UsualSize("monitor", "screen", _S, (0.58, 0.19, 0.46), (0.12, 0.2, 0.12)),
    UsualSize("television", "screen", _S, (1.15, 0.2, 0.7), (0.15, 0.4, 0.15)),
    UsualSize("laptop", "laptop", _S, (0.36, 0.26, 0.24), (0.1, 0.12, 0.12)),
    UsualSize("printer", "appliance", _S, (0.46, 0.38, 0.27), (0.12, 0.12, 0.12)),
    UsualSize("microwave", "appliance", _S, (0.5, 0.36, 0.29), (0.08, 0.08, 0.08)),
    UsualSize("box", "container", _S, (0.34, 0.26, 0.22), (0.15, 0.15, 0.18)),
    UsualSize("clock", "clock", _S, (0.24, 0.12, 0.26), (0.15, 0.15, 0.15)),
    UsualSize("bottle", "bottle", _S, (0.13, 0.12, 0.34), (0.2, 0.2, 0.15)),
    UsualSize("pillow", "pillow", _S, (0.55, 0.38, 0.16), (0.18, 0.18, 0.25)),
    UsualSize("picture", "picture", _W, (0.85, 0.05, 0.68), (0.25, 0.5, 0.2)),
    UsualSize("poster", "picture", _W, (0.62, 0.03, 0.85), (0.2, 0.5, 0.18)),
    UsualSize("mirror", "picture", _W, (0.65, 0.05, 1.05), (0.2, 0.5, 0.18)),
    UsualSize("television", "screen", _W, (1.2, 0.07, 0.69), (0.13, 0.5, 0.12)),
    UsualSize("clock", "clock", _W, (0.38, 0.06, 0.38), (0.15, 0.4, 0.12)),
    UsualSize("wall shelf", "wall shelf", _W, (0.95, 0.24, 0.35), (0.2, 0.2, 0.35)),
    UsualSize("wall lamp", "lamp", _W, (0.23, 0.21, 0.37), (0.15, 0.2, 0.18)),
    UsualSize("window", "window", _W, (1.5, 0.06, 1.35), (0.25, 0.6, 0.15)),
    UsualSize("door", "door", _W, (0.9, 0.06, 2.05), (0.12, 0.6, 0.06)),
    UsualSize("pendant lamp", "lamp", _C, (0.45, 0.44, 0.6), (0.2, 0.2, 0.3)),
    UsualSize("ceiling light", "lamp", _C, (1.0, 0.45, 0.08), (0.25, 0.4, 0.4)),
)  # fmt: skip
PLANTS: Final = {_F: "potted plant", _S: "small plant", _W: "plant", _C: "hanging plant"}
PLANT_SHRUB: Final = 0.6
"""Metres of height from which a plant on a surface is not small."""


@dataclass(frozen=True)
class Label:
    """A noun and how well the evidence fits it, 0..1."""

    noun: str
    fit: float


def name_plant(size: ArrayLike, support: Support) -> Label:
    """The noun for a plant of ``size`` (3,) metres."""
    tall = support is Support.SURFACE and float(np.asarray(size)[2]) >= PLANT_SHRUB
    return Label(PLANTS[Support.FLOOR if tall else support], 1.0)


def name_box(size: ArrayLike, support: Support) -> Label:
    """The noun for a box of ``size`` (3,) metres that is no plant.

    >>> name_box((0.9, 2.0, 0.85), Support.FLOOR).noun
    'sofa'
    >>> name_box((3.0, 3.0, 0.3), Support.FLOOR).noun
    'object'
    """
    x, y, z = (max(float(s), 0.02) for s in np.asarray(size, float))
    measured = np.log([max(x, y), min(x, y), z])
    misfits = sorted(
        (float(np.linalg.norm((measured - np.log(k.size)) / k.spread)) + k.rarity, i)
        for i, k in enumerate(USUAL_SIZES)
        if k.support is support
    )
    best = USUAL_SIZES[misfits[0][1]]
    misfit = misfits[0][0]
    if misfit > MAX_MISFIT:
        return Label(UNKNOWN, 0.0)
    rivals = [USUAL_SIZES[i] for m, i in misfits if m < misfit + CLEAR_MARGIN]
    fit = float(np.exp(-0.5 * (misfit / MAX_MISFIT) ** 2 * 2))
    if all(k.noun == best.noun for k in rivals):
        return Label(best.noun, fit)
    if all(k.family == best.family for k in rivals):
        return Label(best.family, fit)
    return Label(UNKNOWN, fit / 2)


def green(lab: NDArray[np.float32]) -> NDArray[np.bool_]:
    """(N,) which colours (N, 3), plain CIELAB, are those of leaves."""
    hue = np.degrees(np.arctan2(lab[:, 2], lab[:, 1]))
    chroma = np.hypot(lab[:, 1], lab[:, 2])
    return np.asarray((hue > GREEN_HUE[0]) & (hue < GREEN_HUE[1]) & (chroma > GREEN_CHROMA))


def is_plant(lab: NDArray[np.float32], variation: NDArray[np.float32]) -> bool:
    """Whether points with colours (N, 3), plain CIELAB, and `surface_variation` (N,) are a plant: green and rough."""
    leaves = green(lab)
    return bool(leaves.mean() >= MIN_GREEN_SHARE and np.median(variation[leaves]) >= MIN_LEAF_VARIATION)
