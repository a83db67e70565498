"""Rows of like things that stand so near each other that blur joined them: drums, bins, cones, barriers.

Between two of them little is seen, or both their ends are, and each looks like the next; few single things are so.
"""

from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, median_filter, minimum_filter1d

from flymirage_core.annotation.box_fitting import fit_footprint

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
Index = NDArray[np.intp]

SLICE: Final = 0.03
"""Metres: slices across the row, whose points are counted."""
DIP: Final = 0.7
"""Difference of log counts between a slice and fuller ones on both sides, from which a row may be cut there ..."""
REACH: Final = 10
"""... within so many slices (0.3 m); two dips are half as far apart at least."""
NECK: Final = 0.4
"""Of the median slice of the things on both sides: where that little is seen they are two."""
MIN_LENGTH: Final = 0.2
"""Metres of the row that one thing takes; shorter ones are pickets and rungs."""
MIN_SHAPE: Final = 0.4
"""That length over the row's width; what is cut thinner are the two faces of one thing."""
MAX_GAP: Final = 0.75
"""Of a thing's length: what is farther apart is held together by something else."""
TAIL: Final = 0.2
"""Of the largest piece's points: smaller ones are blur beyond the row's ends."""
ALIKE: Final = (1.6, 1.6, 1.2, 4.0)
"""Ratio of lengths, widths, heights and numbers of points up to which pieces are alike; ends of a bicycle are not."""
MIN_EVEN: Final = 0.4
"""Metres of each thing from which three or more are known by dips at equal distances ..."""
LONG: Final = 4.0
"""Metres; what is longer and has no dips is cut where many points show the ends of its pieces ..."""
ENDS: Final = 1.25
"""... by their number over the median of what is round there."""
SHIFT: Final = 0.06
"""Of a thing's length by which a cut may be off."""


def in_row(points: Float32, yaw: float) -> list[Index]:
    """Indices of the points (M, 3) of each thing of a row, or of all of them if they are none. ``yaw``: the room's."""
    plan = fit_footprint(points, yaw)
    local = plan.local(points)
    for axis in np.argsort(-plan.size):
        slices = np.floor((local[:, axis] - local[:, axis].min()) / SLICE).astype(int)  # (M,)
        counts = np.convolve(np.bincount(slices), np.ones(3) / 3, "same")
        dips = _dips(counts)
        width = float(plan.size[1 - axis])
        section = np.stack([local[:, 1 - axis], points[:, 2]], axis=1)  # (M, 2)
        pieces = _between_necks(slices, counts, section, dips, max(MIN_LENGTH, MIN_SHAPE * width))
        pieces = pieces or _even(slices, counts, dips, max(MIN_EVEN, width))
        if pieces:
            return [piece[again] for piece in pieces for again in in_row(points[piece], yaw)]
    return [np.arange(len(points))]


def _dips(counts: Float64) -> Index:
    """Slices with fewer points than others on both sides near by; of equal neighbours the first."""
    logs = np.log(counts + 1)
    before = maximum_filter1d(logs, REACH + 1, origin=REACH // 2)
    after = maximum_filter1d(logs, REACH + 1, origin=-(REACH // 2))
    dip = (logs == minimum_filter1d(logs, REACH - 1)) & (np.minimum(before, after) - logs > DIP)
    return np.flatnonzero(dip[1:] & ~dip[:-1]) + 1


def _between_necks(slices: Index, counts: Float64, section: Float64, dips: Index, min_length: float) -> list[Index]:
    """Pieces between those dips that are necks, if all are alike. ``section``: (M, 2) across the row, and height."""
    while len(dips):
        ends = [0, *dips, len(counts)]
        usual = [float(np.median(counts[a:b])) for a, b in pairwise(ends)]
        necks = [counts[d] / max(min(pair), 1.0) for d, pair in zip(dips, pairwise(usual), strict=True)]
        if max(necks) < NECK:
            break
        dips = np.delete(dips, int(np.argmax(necks)))
    pieces = _cut(slices, dips)
    largest = max(len(piece) for piece in pieces)
    pieces = [piece for piece in pieces if len(piece) > TAIL * largest]
    return pieces if len(pieces) > 1 and _alike(pieces, slices, counts, section, min_length) else []


def _cut(slices: Index, cuts: Index | list[int]) -> list[Index]:
    piece = np.searchsorted(cuts, slices)
    return [np.flatnonzero(piece == k) for k in range(len(cuts) + 1)]


def _alike(pieces: list[Index], slices: Index, counts: Float64, section: Float64, min_length: float) -> bool:
    """Whether pieces are of one length, width, height and number of points, and near each other."""
    full = [np.unique(slices[piece]) for piece in pieces]
    full = [s[counts[s] > NECK * np.median(counts[s])] for s in full]  # without what lies in the gaps
    lengths = np.array([SLICE * (s[-1] - s[0] + 1) for s in full])
    gaps = [SLICE * (b[0] - a[-1]) for a, b in pairwise(full)]
    ends = np.array([np.percentile(section[piece], (2, 98), axis=0) for piece in pieces])  # (P, 2, 2)
    widths, tops = ends[:, 1, 0] - ends[:, 0, 0] + SLICE, ends[:, 1, 1] - section[:, 1].min()
    measures = (lengths, widths, tops, np.array([len(piece) for piece in pieces]))
    alike = all(m.max() < ratio * m.min() for m, ratio in zip(measures, ALIKE, strict=True))
    return bool(alike and lengths.min() >= min_length and max(gaps) < MAX_GAP * lengths.min())


def _even(slices: Index, counts: Float64, dips: Index, min_length: float) -> list[Index]:
    """Pieces of one length: as many as fit to the dips, or in a long thing to the ends that it shows."""
    body = np.flatnonzero(counts > NECK * np.median(counts))
    start, length = body[0], body[-1] + 1 - body[0]
    usual = np.maximum(median_filter(counts, size=max(3, length // 4)), 1)
    ends = np.flatnonzero(counts > ENDS * usual) if length * SLICE > LONG else dips[:0]
    for number in range(int(length * SLICE / (0.8 * min_length)), 1, -1):
        joints = start + np.arange(1, number) * length / number
        for known in (dips, ends) if number > 2 else (ends,):
            if len(known) and all(np.abs(known - j).min() <= SHIFT * length / number for j in joints):
                return _cut(slices, [start, *(int(j) for j in joints), start + length])[1:-1]
    return []
