"""Rows of like things are cut between them; single things with a waist, two faces or ribs are not."""

import numpy as np
import pytest

from flymirage_core.annotation.rows import in_row

STEP = 0.02


def shell(origin, size) -> np.ndarray:
    """Points (N, 3) on the top and the four sides of a box with its lowest corner at ``origin``."""
    axes = [np.arange(0, s + STEP / 2, STEP) for s in size]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    end = np.array([axis[-1] for axis in axes])
    on = (grid[:, :2] == 0).any(axis=1) | (grid == end).any(axis=1)
    return (grid[on] + origin).astype(np.float32)


def blur(start, end, width, points=20) -> np.ndarray:
    """A few points (N, 3) in a gap along x."""
    return np.random.default_rng(1).uniform((start, 0, 0), (end, width, 0.3), (points, 3)).astype(np.float32)


@pytest.mark.parametrize("count", [2, 3, 5])
def test_bins_in_a_row_are_cut_in_the_gaps_between_them(count):
    bins = [shell((0.75 * k, 0, 0), (0.6, 0.7, 1.0)) for k in range(count)]
    gaps = [blur(0.75 * k + 0.6, 0.75 * k + 0.75, 0.7) for k in range(count - 1)]
    points = np.concatenate([*bins, *gaps])
    found = in_row(points, 0.0)
    assert len(found) == count
    assert sorted(np.concatenate(found)) == list(range(len(points)))
    assert all(0.55 < np.ptp(points[piece, 0]) < 0.8 for piece in found)


def test_a_bicycle_is_not_cut_between_its_wheels():
    rear, front = shell((0, 0.22, 0), (0.7, 0.12, 1.0)), shell((0.95, 0, 0), (0.7, 0.56, 1.0))
    bicycle = np.concatenate([rear, blur(0.7, 0.95, 0.2), front])
    assert len(in_row(bicycle, 0.0)) == 1


def test_barriers_end_to_end_are_cut_where_their_ends_show():
    points = np.concatenate([shell((2.1 * k, 0, 0), (2.04, 0.4, 0.8)) for k in range(3)])
    assert sorted(round(float(points[piece, 0].min()), 1) for piece in in_row(points, 0.0)) == [0.0, 2.1, 4.2]


@pytest.mark.parametrize(
    "thing",
    [
        [shell((0, 0, 0), (2.0, 0.9, 0.5))],
        [shell((0, 0, 0.7), (1.6, 0.8, 0.06)), shell((0, 0, 0), (0.4, 0.8, 0.7)), shell((1.2, 0, 0), (0.4, 0.8, 0.7))],
        [shell((0, 0, 0), (2.0, 0.06, 0.8)), shell((0, 0.5, 0), (2.0, 0.06, 0.8))],
        [shell((0.12 * k, 0, 0), (0.03, 0.03, 1.0)) for k in range(12)] + [shell((0, 0, 0.97), (1.4, 0.03, 0.03))],
    ],
    ids=["chest", "desk with two pedestals", "two faces of one thing", "railing"],
)
def test_a_single_thing_stays_whole(thing):
    points = np.concatenate(thing)
    assert [len(piece) for piece in in_row(points, 0.0)] == [len(points)]
