"""Lattice noise: a fixed random number for each integer point, and smooth bumps between them."""

import numba
import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

GOLDEN = 0x9E3779B97F4A7C15
MIX = 0xBF58476D1CE4E5B9
SEED_STEP = 2654435761


def value_noise(coordinates: Float, seed: int) -> Float:
    """Smooth noise (N,) in [-1, 1] with one bump a unit, over coordinates (N, D), D at most 3."""
    return np.asarray(_value_noise(np.ascontiguousarray(coordinates, float), np.uint64(seed * SEED_STEP % 2**32)))


def lattice_hash(cell: NDArray[np.int64], seed: int) -> Float:
    """A fixed uniform number in [0, 1) for each integer lattice point (N, D)."""
    return np.asarray(_hashes(np.ascontiguousarray(cell, np.int64), np.uint64(seed * SEED_STEP % 2**32)))


def fractal(coordinates: Float, seed: int) -> Float:
    """Three octaves of `value_noise`, (N,) in about [-1, 1]."""
    total = np.zeros(len(coordinates))
    for octave in range(3):
        total += 0.57 * 0.5**octave * value_noise(coordinates * 2.03**octave, seed + 31 * octave)
    return total


@numba.njit(cache=True, nogil=True)
def _mixed(state: np.uint64, column: np.int64) -> np.uint64:
    state = (state ^ (np.uint64(column) & np.uint64(0xFFFFFFFF))) * np.uint64(GOLDEN)
    return state ^ (state >> np.uint64(29))


@numba.njit(cache=True, nogil=True)
def _unit(state: np.uint64) -> float:
    return float((state * np.uint64(MIX)) >> np.uint64(40)) / 16777216.0


@numba.njit(cache=True, nogil=True)
def _hashes(cell: NDArray[np.int64], start: np.uint64) -> Float:
    result = np.empty(len(cell))
    for n in range(len(cell)):
        state = start
        for d in range(cell.shape[1]):
            state = _mixed(state, cell[n, d])
        result[n] = _unit(state)
    return result


@numba.njit(cache=True, nogil=True)
def _value_noise(at: Float, start: np.uint64) -> Float:
    count, dimensions = at.shape
    result = np.empty(count)
    for n in range(count):
        total = 0.0
        for corner in range(1 << dimensions):
            state, share = start, 1.0
            for d in range(dimensions):
                cell = np.floor(at[n, d])
                inside = at[n, d] - cell
                weight = inside * inside * (3.0 - 2.0 * inside)
                upper = (corner >> d) & 1
                share *= weight if upper == 1 else 1.0 - weight
                state = _mixed(state, np.int64(cell) + upper)
            total += share * _unit(state)
        result[n] = 2.0 * total - 1.0
    return result
