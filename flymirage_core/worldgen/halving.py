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
DOWN, OVER, CROSSED = (-0.5, -0.5, 0.5, 0.5), (-0.5, 0.5, -0.5, 0.5), (0.5, -0.5, -0.5, 0.5)
"""Differences between the quarters along u, along v, and of a chequer."""


def textured_cells(cells: Float, material: Material, extent: Extent, spacing: float) -> tuple[Float, Float]:
    """Cells (M, 11) and their linear albedo (M, 3) out of cells (N, 11): some of them halved, again and again.

    A cell is its middle, its edge vectors u and v (full lengths, metres), and the surface coordinates (2,) of its
    middle; these run with the edges. Its colour is the mean of its four quarters', so that no texture is finer than it.
    ``spacing`` is in metres; infinite: no cell is halved.
    """
    done, colours = [], []
    for last in [*[False] * HALVINGS, True]:
        quarters, corners = (_albedo(cells, share, material, extent) for share in (QUARTER, CORNER))
        gain_u, gain_v = np.maximum(_gains(quarters, cells, spacing), _gains(corners, cells, spacing))
        coarse = (np.maximum(gain_u, gain_v) > CONTRAST) & (not last)
        done.append(cells[~coarse])
        colours.append(quarters[:, ~coarse].mean(axis=0))
        cells = _halved(cells[coarse], gain_u[coarse] >= gain_v[coarse])
        if len(cells) == 0:
            break
    return np.concatenate(done), np.concatenate(colours)


def _albedo(cells: Float, share: float, material: Material, extent: Extent) -> Float:
    """Albedo (4, N, 3) at a share of the edges from the middle, towards each corner."""
    middle, u, v, uv = cells[:, :3], cells[:, 3:6], cells[:, 6:9], cells[:, 9:]
    steps = share * np.stack([np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)], 1)  # (N, 2)
    return np.stack([albedo(material, uv + steps * (a, b), extent, middle + share * (a * u + b * v)) for a, b in SIGNS])


def _gains(colours: Float, cells: Float, spacing: float) -> Float:
    """(2, N) contrast of ``colours`` (4, N, 3) times length of each cell along u, and along v."""
    tone = np.sqrt(colours)  # about as bright as they look
    down, over, crossed = (np.abs(np.tensordot(signs, tone, 1)).max(axis=1) for signs in (DOWN, OVER, CROSSED))
    u, v = (np.linalg.norm(cells[:, i : i + 3], axis=1) / spacing for i in (3, 6))
    return np.stack([np.maximum(down, crossed) * u, np.maximum(over, crossed) * v])


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
