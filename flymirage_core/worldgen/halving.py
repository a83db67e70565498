"""Cells of a surface halved where their texture changes much: plain ones stay large, letters and stripes get small."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.materials import Material, albedo

Float = NDArray[np.float64]
Extent = tuple[float, float]

CONTRAST: Final = 0.08
"""A cell is halved while its contrast times its length, in spacings, is more."""
HALVINGS: Final = 5
"""How often at most."""
SIGNS: Final = ((-1, -1), (-1, 1), (1, -1), (1, 1))
QUARTER, CORNER = 0.25, 0.45
"""Shares of a cell's edges from its middle: where its colour is taken, and where else it is looked at for changes."""


def textured_cells(cells: Float, material: Material, extent: Extent, spacing: float) -> tuple[Float, Float]:
    """Cells (M, 11) and their linear albedo (M, 3) out of cells (N, 11): some of them halved, again and again.

    A cell is its middle, its edge vectors u and v (full lengths, metres), and the surface coordinates (2,) of its
    middle; these run with the edges. Its colour is the mean of its four quarters', so that no texture is finer than it.
    ``spacing`` is in metres; infinite: no cell is halved.
    """
    done, colours = [], []
    for last in [*[False] * HALVINGS, True]:
        colours_at = _albedo(cells, material, extent)
        gain_u, gain_v = _gains(colours_at, cells, spacing)
        coarse = (np.maximum(gain_u, gain_v) > CONTRAST) & (not last)
        done.append(cells[~coarse])
        colours.append(colours_at[0][:, ~coarse].mean(axis=0))
        cells = _halved(cells[coarse], gain_u[coarse] >= gain_v[coarse])
        if len(cells) == 0:
            break
    return np.concatenate(done), np.concatenate(colours)


def _albedo(cells: Float, material: Material, extent: Extent) -> Float:
    """Albedo (2, 4, N, 3) in the middle of each quarter, and near each corner."""
    middle, u, v, uv = cells[:, :3], cells[:, 3:6], cells[:, 6:9], cells[:, 9:]
    lengths = np.stack([np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)], 1)  # (N, 2)
    where = [(share, a, b) for share in (QUARTER, CORNER) for a, b in SIGNS]
    coordinates = np.concatenate([uv + share * lengths * (a, b) for share, a, b in where])  # (8 N, 2)
    points = np.concatenate([middle + share * (a * u + b * v) for share, a, b in where])  # (8 N, 3)
    return albedo(material, coordinates, extent, points).reshape(2, 4, len(cells), 3)


def _gains(colours: Float, cells: Float, spacing: float) -> tuple[Float, Float]:
    """(N,) contrast of ``colours`` (2, 4, N, 3) times length of each cell along u, and along v."""
    tone = np.sqrt(colours)  # about as bright as they look
    low, left, right, high = tone.swapaxes(0, 1)  # (2, N, 3) each: the signs (-1, -1), (-1, 1), (1, -1), (1, 1)
    rising, falling = high - low, right - left
    down, over, crossed = rising + falling, rising - falling, high + low - left - right
    down, over, crossed = (np.abs(change).max(axis=(0, 2)) / 2 for change in (down, over, crossed))
    u, v = (np.linalg.norm(cells[:, i : i + 3], axis=1) / spacing for i in (3, 6))
    return np.maximum(down, crossed) * u, np.maximum(over, crossed) * v


def _halved(cells: Float, along_u: NDArray[np.bool_]) -> Float:
    """The two halves (2 N, 11) of cells (N, 11): of their u where ``along_u`` (N,), else of their v."""
    share = np.where(along_u[:, None], (0.5, 1.0), (1.0, 0.5))  # (N, 2)
    smaller = cells.copy()
    smaller[:, 3:6] *= share[:, :1]
    smaller[:, 6:9] *= share[:, 1:]
    step = np.zeros_like(cells)
    step[:, :3] = np.where(along_u[:, None], smaller[:, 3:6], smaller[:, 6:9]) / 2
    step[np.arange(len(cells)), np.where(along_u, 9, 10)] = np.linalg.norm(step[:, :3], axis=1)
    return np.concatenate([smaller - step, smaller + step])
