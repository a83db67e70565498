"""Which colours one may say of a true object as it is seen, in white light; for scoring the annotator's words."""

from collections import Counter
from typing import Any

import numpy as np

from flymirage_core.annotation.colours import colour_name, to_lab
from flymirage_core.language.looks import coloured
from flymirage_core.language.scene_relations import Truth

SURFEL_SPACING = 0.04  # metres between the surfels, and edge of the cells, by which a true object's colour is taken
COLOUR_SAMPLES = 500  # of those cells are asked for their colour


def share_called(seen: str, colours: Counter[str]) -> float:
    """The share of ``colours`` for which the ``seen`` word may be used; no word is right for none."""
    if not seen:
        return 0.0
    called = sum(count for name, count in colours.items() if coloured(name, seen) is not Truth.NO)
    return called / max(colours.total(), 1)


def colour_of_paint(paint: str) -> str:
    """The basic name of a paint's own colour; `coloured` says whether the seen name may be used for it."""
    from flymirage_core.worldgen.colours import linear_rgb

    return _names_of_linear(np.array([linear_rgb(paint)]))[0]


def colours_of_surface(thing: Any, scene: str) -> Counter[str]:
    """How much of what is seen of a true object from outside has which basic colour, in white light.

    From above and from all sides; of what is on a wall, from the front. A plant's paint is its pot's, a picture's its
    frame's; this is what one may say of the whole.
    """
    from flymirage_core.worldgen.assembly import object_parts
    from flymirage_core.worldgen.surfaces import Surfels, surfels_of

    surfels = Surfels.joined([surfels_of(part, SURFEL_SPACING) for part in object_parts(thing, scene)])
    away = surfels.points - np.array(thing.centre)
    local = np.column_stack([away[:, :2] @ thing.axes.T, away[:, 2]])  # (N, 3), y to the front
    sides = [(1, 1)] if thing.placement == "on_wall" else [(0, 1), (0, -1), (1, 1), (1, -1), (2, 1)]
    seen = np.concatenate([_met_first(local, axis, sign) for axis, sign in sides])
    return Counter(_names_of_linear(surfels.albedo[seen[:: max(1, len(seen) // COLOUR_SAMPLES)]]))


def _met_first(points: np.ndarray, axis: int, sign: int) -> np.ndarray:
    """Indices of the points (N, 3) farthest along ``sign`` times an axis, one for each cell of the other two."""
    cells = np.floor(np.delete(points, axis, axis=1) / SURFEL_SPACING).astype(int)  # (N, 2)
    order = np.lexsort((-sign * points[:, axis], cells[:, 1], cells[:, 0]))
    first = np.append(True, (np.diff(cells[order], axis=0) != 0).any(axis=1))
    return order[first]


def _names_of_linear(linear: np.ndarray) -> list[str]:
    """The names of linear RGB colours (N, 3)."""
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0) ** (1 / 2.4) - 0.055)
    return [colour_name(lab) for lab in to_lab(255 * np.clip(srgb, 0, 1))]
