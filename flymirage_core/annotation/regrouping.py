"""Boxes cut in two and joined to one where the recogniser knows the pieces, or the whole, better than what there was.

Colour and contact alone leave bicycles in halves and benches in one box with what stands beside them. Here each
doubtful box is cut where its outline or colour changes most, then neighbours are joined; what is tried is observed as
a box is, and kept if its name is likelier and it is less of a left-over.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.appearance import Observation
from flymirage_core.annotation.box_fitting import MAX_WALL_GAP, FittedBox, between, fit_box, grown
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.evidence import Evidence
from flymirage_core.annotation.fusion import footprint_overlap, yaw_iou
from flymirage_core.annotation.plausibility import LONGEST, LONGEST_OUTDOORS, MIN_OBJECT_POINTS
from flymirage_core.annotation.recogniser import trained_recogniser

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]
Bool = NDArray[np.bool_]

ROUNDS: Final = 2
"""Of cuts, the second of what came of the first, and of joins."""
DOUBTED: Final = 0.2
"""Probability of being a left-over from which a box may be cut, ..."""
WELL_KNOWN: Final = 0.7
"""... unless its name is likelier than this."""
HOPELESS: Final = 0.88
"""Probability of being left-overs from which nothing comes of boxes."""
CERTAIN: Final = 0.95
"""Probability of a name that nothing makes likelier."""
MIN_CUT: Final = 0.4
"""Metres of the longest side of what may be cut."""
MIN_CUT_POINTS: Final = 80
LESS_LEFT_OVER: Final = 0.12
"""By which one piece must be less of a left-over than the whole was."""
SLICE: Final = 0.03
"""Metres: slices across a box between which it may be cut, ..."""
WINDOW: Final = 4
"""... by what changes from so many slices before to as many after: ..."""
OUTLINE: Final = 0.15
"""... metres by which a side of the outline moves, or ..."""
COLOUR: Final = 15.0
"""... step in Lab, that count as one."""
MIN_CHANGE: Final = 3.0
APART: Final = 6
"""Slices between two cuts."""
CUTS: Final = 3
"""Places at which a box is cut on trial, at most, ..."""
CUTS_AN_AXIS: Final = 2
"""... and of those along one axis."""
TOUCH: Final = 0.1
"""Metres between what may be one thing."""
KNOWN: Final = 0.3
"""Up to this probability of being left-overs two boxes of different names are two things."""
LIKELIER: Final = 0.05
"""By which the name of a whole must be likelier than those of its pieces ..."""
MORE_LEFT_OVER: Final = 0.1
"""... if it is no more of a left-over than this; or just likelier, if it is less of one by ..."""
CLEARLY_LESS: Final = 0.02
KNOWN_WHOLE: Final = 0.15
"""Probability of the name of a whole, at least."""
LIKE_THINGS: Final = 0.45
"""Up to this probability of being left-overs a box and what stands on it are two things ..."""
STANDING: Final = 0.7
"""... if that much of the upper one's plan is over the lower one, and it has at most that share of its area."""
SETTLED: Final = 0.12
"""Metres between what is seen of a piece and the bottom of the whole, within which it stands where that does."""


@dataclass(frozen=True)
class Belief:
    """What the recogniser thinks of a box."""

    noun: str
    name: float  # probability of the likeliest noun
    left_over: float  # probability of being no object of its own


UNSEEN: Final = Belief("", 0.0, 1.0)
Known = list[tuple[FittedBox, Belief]]
Judge = Callable[[Sequence[tuple[Observation, Detections] | None]], list[Belief]]


def believed(observed: Sequence[tuple[Observation, Detections] | None]) -> list[Belief]:
    """What the recogniser thinks of each box, from how it looks."""
    seen = [k for k, pair in enumerate(observed) if pair is not None]
    beliefs = [UNSEEN] * len(observed)
    if seen:
        recogniser = trained_recogniser()
        features = np.stack([pair[0].features for pair in observed if pair is not None])
        for k, p in zip(seen, recogniser.probabilities(features)[0], strict=True):
            best = int(p[:-1].argmax())
            beliefs[k] = Belief(recogniser.nouns[best], float(p[best]), float(p[-1]))
    return beliefs


def regrouped(evidence: Evidence, judge: Judge = believed) -> list[FittedBox]:
    """The proposals, doubtful ones cut and pieces joined wherever that makes better known things.

    ``judge``: what thinks of all that is tried.
    """
    boxes = evidence.proposals
    known = list(zip(boxes, judge(evidence.observed(boxes, [boxes] * len(boxes))), strict=True))
    fresh = list(range(len(known)))
    for _ in range(ROUNDS):
        known, fresh = _cut(known, fresh, evidence, judge)
    fresh = list(range(len(known)))
    for _ in range(ROUNDS):
        known, fresh = _joined(known, fresh, evidence, judge)
    return [box for box, _ in known]


def _cut(known: Known, fresh: Sequence[int], evidence: Evidence, judge: Judge) -> tuple[Known, list[int]]:
    """One round over the ``fresh`` boxes: the boxes after it, and which of them are new."""
    pieces, wholes = [], []
    for k in fresh:
        box, belief = known[k]
        if _may_be_cut(box, belief):
            for side in _cuts(box, evidence.cloud.points[box.members], evidence.plain[box.members]):
                pieces += [_piece(box, box.members[half], evidence) for half in (side, ~side)]
                wholes.append(k)
    boxes = [box for box, _ in known]
    rivals = [[*boxes[:k], *boxes[k + 1 :], *pieces[2 * n : 2 * n + 2]] for n, k in enumerate(wholes)]
    beliefs = judge(evidence.observed(pieces, [rivals[n // 2] for n in range(len(pieces))]))
    gains = [_gain_of_cut(known[k][1], *beliefs[2 * n : 2 * n + 2]) for n, k in enumerate(wholes)]
    best: dict[int, int] = {}
    for n, k in enumerate(wholes):
        if gains[n] > max(0.0, gains[best[k]] if k in best else 0.0):
            best[k] = n
    kept = [pair for k, pair in enumerate(known) if k not in best]
    halves = [(pieces[i], beliefs[i]) for n in best.values() for i in (2 * n, 2 * n + 1)]
    return kept + halves, list(range(len(kept), len(kept) + len(halves)))


def _may_be_cut(box: FittedBox, belief: Belief) -> bool:
    large = max(box.size) > MIN_CUT and len(box.members) > MIN_CUT_POINTS and not box.on_wall
    return large and DOUBTED < belief.left_over < HOPELESS and belief.name < WELL_KNOWN


def _gain_of_cut(whole: Belief, a: Belief, b: Belief) -> float:
    """How much better known the better piece is than the whole was; 0 if that is not enough."""
    likelier = max(a.name, b.name) - whole.name
    less = whole.left_over - min(a.left_over, b.left_over)
    return likelier + less if likelier > 0 and less > LESS_LEFT_OVER else 0.0


def _cuts(box: FittedBox, points: Float32, colours: Float32) -> list[Bool]:
    """(M,) the points (M, 3) on one side, for each place at which the box may be cut. ``colours``: (M, 3) Lab."""
    c, s = np.cos(box.yaw), np.sin(box.yaw)
    local = (points - np.array(box.centre)) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])  # (M, 3)
    found = []
    for axis in range(3):
        slices = ((local[:, axis] - local[:, axis].min()) / SLICE).astype(int)  # (M,)
        changes, wider = _changes(slices, np.delete(local, axis, axis=1), colours)
        taken: list[int] = []
        for k in np.argsort(-changes, kind="stable"):
            if changes[k] < MIN_CHANGE or len(taken) == CUTS_AN_AXIS:
                break
            if all(abs(k - other) >= APART for other in taken):
                taken.append(int(k))
        found += [(float(changes[k]), slices < k - wider[k]) for k in taken]
    found.sort(key=lambda cut: -cut[0])
    return [side for _, side in found[:CUTS] if min(side.sum(), (~side).sum()) >= MIN_OBJECT_POINTS]


def _changes(slices: NDArray[np.intp], across: Float64, colours: Float32) -> tuple[Float64, NDArray[np.int64]]:
    """(K,) how much outline, colour and fullness change where each of the K slices begins; 0 near both ends.

    And (K,) 1 where the outline is wider behind that, else -1: the end of the wider side is about there.
    ``across``: (M, 2) the other two coordinates.
    """
    count = int(slices.max()) + 1
    values = np.column_stack([np.ones(len(slices)), across, across**2, colours])  # (M, 8)
    sums = np.stack([np.bincount(slices, weights=column, minlength=count) for column in values.T], axis=1)
    until = np.concatenate([np.zeros((1, 8)), np.cumsum(sums, axis=0)])  # (K + 1, 8)
    k = np.arange(count)
    before = until[k] - until[np.maximum(k - WINDOW, 0)]
    after = until[np.minimum(k + WINDOW, count)] - until[k]
    (low_a, high_a, colour_a), (low_b, high_b, colour_b) = _outline(before), _outline(after)
    moved = np.maximum(np.abs(low_a - low_b), np.abs(high_a - high_b)).max(axis=1) / OUTLINE
    step = np.linalg.norm(colour_a - colour_b, axis=1) / COLOUR
    logs = np.log1p(sums[:, 0])
    reach = 2 * WINDOW
    fuller = np.array([min(logs[max(0, j - reach) : j + 1].max(), logs[j : j + reach].max()) for j in k])
    dip = fuller - np.minimum(logs, np.append(logs[0], logs[:-1]))
    changes = np.asarray(moved + step + np.maximum(dip, 0))
    changes[: WINDOW + 1] = 0
    changes[-WINDOW:] = 0
    wider = np.where((high_b - low_b).prod(axis=1) > (high_a - low_a).prod(axis=1), 1, -1)
    return changes, wider


def _outline(sums: Float64) -> tuple[Float64, Float64, Float64]:
    """(K, 2) where points spread evenly would begin and end that have these sums (K, 8), and their mean colour."""
    n = np.maximum(sums[:, :1], 1)
    mean = sums[:, 1:3] / n
    reach = np.sqrt(3 * np.maximum(sums[:, 3:5] / n - mean**2, 0))
    return mean - reach, mean + reach, sums[:, 5:] / n


def _piece(whole: FittedBox, members: NDArray[np.intp], evidence: Evidence) -> FittedBox:
    """The box of a part of a box; it stands where that does, and ends where that does, if it nearly does."""
    box = fit_box(evidence.cloud.points, evidence.cloud.to_camera, members, evidence.structure, MAX_WALL_GAP)
    bottom = whole.bottom if box.bottom < whole.bottom + SETTLED else box.bottom
    top = whole.top if box.top > whole.top - SETTLED / 2 else box.top
    return replace(between(box, bottom, top), hanging=whole.hanging and top == whole.top)


def _joined(known: Known, fresh: Sequence[int], evidence: Evidence, judge: Judge) -> tuple[Known, list[int]]:
    """One round over pairs with a ``fresh`` box: the boxes after it, and which of them are new."""
    new = set(fresh)
    longest = LONGEST if evidence.structure.ceiling is not None else LONGEST_OUTDOORS
    pairs = [
        (i, j)
        for i, j in combinations(range(len(known)), 2)
        if (i in new or j in new) and _may_be_one(known[i], known[j], longest)
    ]
    wholes = [_whole(known[i][0], known[j][0], evidence) for i, j in pairs]
    boxes = [box for box, _ in known]
    rivals = [[box for k, box in enumerate(boxes) if k not in pair] for pair in pairs]
    beliefs = judge(evidence.observed(wholes, rivals))
    gains = [_gain_of_join(b, known[i][1], known[j][1]) for b, (i, j) in zip(beliefs, pairs, strict=True)]
    taken: set[int] = set()
    joined: Known = []
    for n in sorted(range(len(pairs)), key=lambda n: -gains[n]):
        if gains[n] > 0 and not taken & set(pairs[n]):
            taken |= set(pairs[n])
            joined.append((wholes[n], beliefs[n]))
    kept = [pair for k, pair in enumerate(known) if k not in taken]
    return kept + joined, list(range(len(kept), len(kept) + len(joined)))


def _may_be_one(a: tuple[FittedBox, Belief], b: tuple[FittedBox, Belief], longest: float) -> bool:
    (box, belief), (other, view) = a, b
    if np.hypot(box.centre[0] - other.centre[0], box.centre[1] - other.centre[1]) > longest:
        return False
    if max(box.bottom, other.bottom) - min(box.top, other.top) >= TOUCH:
        return False
    if min(belief.left_over, view.left_over) > HOPELESS or max(belief.name, view.name) > CERTAIN:
        return False
    if belief.noun != view.noun and max(belief.left_over, view.left_over) < KNOWN:
        return False
    if max(belief.left_over, view.left_over) < LIKE_THINGS and (_stands_on(box, other) or _stands_on(other, box)):
        return False
    return yaw_iou(grown(box, TOUCH), grown(other, TOUCH)) > 0


def _stands_on(upper: FittedBox, lower: FittedBox) -> bool:
    area, under = upper.size[0] * upper.size[1], lower.size[0] * lower.size[1]
    if upper.bottom < lower.top - TOUCH or area > STANDING * under:
        return False
    return footprint_overlap(upper, lower) > STANDING * area


def _gain_of_join(whole: Belief, a: Belief, b: Belief) -> float:
    """How much better known the whole is than the better piece; 0 if that is not enough."""
    likelier = whole.name - max(a.name, b.name)
    less = min(a.left_over, b.left_over) - whole.left_over
    known = (likelier > LIKELIER and less > -MORE_LEFT_OVER) or (likelier > 0 and less > CLEARLY_LESS)
    return likelier + less if known and whole.name > KNOWN_WHOLE else 0.0


def _whole(a: FittedBox, b: FittedBox, evidence: Evidence) -> FittedBox:
    """The box of two boxes' points, as high and as low as they are."""
    members = np.union1d(a.members, b.members)
    box = fit_box(evidence.cloud.points, evidence.cloud.to_camera, members, evidence.structure, MAX_WALL_GAP)
    box = between(box, min(box.bottom, a.bottom, b.bottom), max(box.top, a.top, b.top))
    return replace(box, on_wall=a.on_wall and b.on_wall, hanging=a.hanging or b.hanging)
