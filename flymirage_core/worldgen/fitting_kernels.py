"""The compiled loops of `fitting` over splats: what one picture says is gathered, and a step is taken."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Float32 = NDArray[np.float32]

F = np.float32
SUMS = 9
"""Of each splat: colour gradient (3), weight, and the shape's gradient (5)."""
BETA, BETA_SQUARES = F(0.9), F(0.99)
"""Adam's decay of the mean gradient and of its square (Kingma & Ba 2015)."""
LOWEST = np.array([0, 0, -10, -0.25, -0.25], np.float32)
HIGHEST = np.array([0.15, 0.15, 10, 0.25, 0.25], np.float32)
"""Bounds of the shape. Splats that shrink or leave their place open cracks that only nearer views show."""
SEEN = F(1e-3)
"""Pixels: a splat that covers less in a step's pictures stays as it is."""


@njit(cache=True, nogil=True)
def gather(
    rows: NDArray[np.uint32],
    sums: Float32,
    shapes: Float32,
    first_axes: Float32,
    axes: Float32,
    total: Float32,
) -> None:
    """Add one picture's gradients, `gradient_kernels`' ``sums`` (K, 10) and ``shapes`` (K, 9), to ``total`` (N, 9).

    From means and half axes to the shape: an extent's logarithm moves along its axis, a turn moves each axis along the
    other, a shift moves the mean along the axes that the splat began with.
    """
    for i in range(len(rows)):
        n = rows[i]
        long, wide, long_wide, wide_long, along, across = F(0), F(0), F(0), F(0), F(0), F(0)
        a2, b2 = F(1e-20), F(1e-20)
        for k in range(3):
            a, b = axes[k, n], axes[3 + k, n]
            long += a * shapes[i, 3 + k]
            wide += b * shapes[i, 6 + k]
            long_wide += b * shapes[i, 3 + k]
            wide_long += a * shapes[i, 6 + k]
            along += first_axes[k, n] * shapes[i, k]
            across += first_axes[3 + k, n] * shapes[i, k]
            a2 += a * a
            b2 += b * b
        ratio = np.sqrt(a2 / b2)
        for k in range(4):
            total[n, k] += sums[i, k]
        total[n, 4] += long
        total[n, 5] += wide
        total[n, 6] += long_wide * ratio - wide_long / ratio
        total[n, 7] += along
        total[n, 8] += across


@njit(cache=True, nogil=True)
def advance(
    total: Float32,
    colours: Float32,
    shape: Float32,
    means: Float32,
    squares: Float32,
    fades: Float32,
    rates: Float32,
    colour_rate: np.float32,
    damping: np.float32,
) -> None:
    """One step of all splats that ``total`` (N, 9) tells of, which is blank after it.

    ``fades`` (N, 2) are Adam's decays to the power of the steps that each splat has taken.
    """
    for n in range(len(total)):
        weight = total[n, 3]
        if weight < SEEN:
            total[n] = F(0)
            continue
        for k in range(3):
            colour = colours[n, k] - colour_rate * total[n, k] / (weight + damping)
            colours[n, k] = min(max(colour, F(0)), F(1))
        fades[n, 0] *= BETA
        fades[n, 1] *= BETA_SQUARES
        for k in range(5):
            g = total[n, 4 + k]
            means[n, k] = BETA * means[n, k] + (F(1) - BETA) * g
            squares[n, k] = BETA_SQUARES * squares[n, k] + (F(1) - BETA_SQUARES) * g * g
            mean, square = means[n, k] / (F(1) - fades[n, 0]), squares[n, k] / (F(1) - fades[n, 1])
            moved = shape[n, k] - rates[k] * mean / (np.sqrt(square) + F(1e-8))
            shape[n, k] = min(max(moved, LOWEST[k]), HIGHEST[k])
        total[n] = F(0)


@njit(cache=True, nogil=True)
def apply(
    shape: Float32,
    moved: NDArray[np.bool_],
    first_means: Float32,
    first_axes: Float32,
    means: Float32,
    axes: Float32,
) -> None:
    """Write the shapes (N, 5) of the ``moved`` splats (N,) to the renderer's ``means`` (3, N) and ``axes`` (9, N)."""
    for n in np.flatnonzero(moved):
        long, wide, turn, along, across = shape[n]
        c, s = np.cos(turn), np.sin(turn)
        a2, b2 = F(1e-20), F(1e-20)
        for k in range(3):
            a2 += first_axes[k, n] * first_axes[k, n]
            b2 += first_axes[3 + k, n] * first_axes[3 + k, n]
        ratio = np.sqrt(b2 / a2)
        grown_long, grown_wide = np.exp(long), np.exp(wide)
        for k in range(3):
            a, b = first_axes[k, n], first_axes[3 + k, n]
            axes[k, n] = grown_long * (c * a + s * b / ratio)
            axes[3 + k, n] = grown_wide * (c * b - s * a * ratio)
            means[k, n] = first_means[k, n] + along * a + across * b
