"""The surface cut in parts of one colour."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components

from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.parts import PartSet, Surface

Float32 = NDArray[np.float32]
Index = NDArray[np.intp]
Bool = NDArray[np.bool_]

MAX_STEP: Final = 5.0
"""Colour step between neighbours up to which they are one part."""
SMOOTHING_SCALE: Final = 8.0
"""Colour step over which neighbours stop smoothing each other."""
OVERSIZE: Final = 2.7
"""Metres in plan beyond which a part is cut again ..."""
STRICTER: Final = (0.6, 0.38, 0.25)
"""... with these shares of `MAX_STEP`, in turn."""
MIN_OVERSIZE_POINTS: Final = 400
ABSORB_SCALE: Final = 14.0
"""Colour step over which a small part stops resembling its neighbour."""
LEAST_SIMILARITY: Final = 1e-3
MIN_PART_POINTS: Final = 12
"""Smaller parts go to the neighbour of the most similar colour."""


def neighbour_edges(voxels: NDArray[np.int64]) -> Index:
    """(E, 2) pairs of points in neighbouring voxels (26-neighbourhood), each once. ``voxels``: (N, 3), unique."""
    if len(voxels) == 0:
        return np.zeros((0, 2), np.intp)
    local = voxels - voxels.min(axis=0) + 1
    shape = local.max(axis=0) + 2
    keys = (local[:, 0] * shape[1] + local[:, 1]) * shape[2] + local[:, 2]
    order = np.argsort(keys)
    ordered = keys[order]
    pairs = []
    for dx, dy, dz in np.ndindex(3, 3, 3):
        shift = ((dx - 1) * shape[1] + dy - 1) * shape[2] + dz - 1
        if shift <= 0:
            continue
        other = np.minimum(np.searchsorted(ordered, keys + shift), len(keys) - 1)
        found = ordered[other] == keys + shift
        pairs.append(np.stack([np.flatnonzero(found), order[other[found]]], axis=1))
    return np.concatenate(pairs)


def smoothed_colours(colours: Float32, edges: Index) -> Float32:
    """Colours (N, 3) averaged twice with similar neighbours: texture and noise go, borders stay."""
    weights = np.exp(-((colour_step(colours[edges[:, 0]], colours[edges[:, 1]]) / SMOOTHING_SCALE) ** 2))
    n = len(colours)
    both = np.concatenate([edges, edges[:, ::-1]])
    graph = csr_matrix((np.concatenate([weights, weights]), (both[:, 0], both[:, 1])), shape=(n, n))
    total = np.asarray(graph.sum(axis=1)).reshape(-1, 1) + 1
    for _ in range(2):
        colours = ((graph @ colours + colours) / total).astype(np.float32)
    return colours


def colour_parts(surface: Surface) -> PartSet:
    """Connected parts of one colour; those that are larger than furniture are cut again more strictly."""
    n = len(surface.points)
    if n == 0:
        return PartSet(surface, np.zeros(0, np.intp), MIN_PART_POINTS)
    labels = _components(n, surface.edges[surface.steps < MAX_STEP])
    for share in STRICTER:
        oversize = _oversize(surface, labels)
        if not oversize.any():
            break
        a, b = labels[surface.edges[:, 0]], labels[surface.edges[:, 1]]
        kept = (a == b) & oversize[a] & (surface.steps < share * MAX_STEP)
        finer = labels.max() + 1 + _components(n, surface.edges[kept])
        labels = _renumbered(np.where(oversize[labels], finer, labels))
    for _ in range(3):
        labels = _small_absorbed(surface, labels)
    return PartSet(surface, labels, MIN_PART_POINTS)


def _components(n: int, edges: Index) -> Index:
    graph = coo_matrix((np.ones(len(edges), np.int8), (edges[:, 0], edges[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], np.intp)


def _renumbered(labels: Index) -> Index:
    return np.asarray(np.unique(labels, return_inverse=True)[1].reshape(-1), np.intp)


def _oversize(surface: Surface, labels: Index) -> Bool:
    """(K,) which parts are longer in plan than `OVERSIZE`."""
    c, s = np.cos(surface.yaw), np.sin(surface.yaw)
    plan = surface.points[:, :2] @ np.array([[c, -s], [s, c]], np.float32)  # (N, 2)
    count = labels.max() + 1
    lower, upper = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(lower, labels, plan)
    np.maximum.at(upper, labels, plan)
    return np.asarray(((upper - lower).max(axis=1) > OVERSIZE) & (np.bincount(labels) > MIN_OVERSIZE_POINTS))


def _small_absorbed(surface: Surface, labels: Index) -> Index:
    """Parts below `MIN_PART_POINTS` given to the neighbouring part that is most similar, summed over edges."""
    counts = np.bincount(labels)
    a, b = labels[surface.edges[:, 0]], labels[surface.edges[:, 1]]
    border = a != b
    a, b, steps = a[border], b[border], surface.steps[border]
    sources, targets = np.concatenate([a, b]), np.concatenate([b, a])
    similarity = np.tile(np.exp(-((steps / ABSORB_SCALE) ** 2)) + LEAST_SIMILARITY, 2)
    small = counts[sources] < MIN_PART_POINTS
    if not small.any():
        return labels
    graph = csr_matrix((similarity[small], (sources[small], targets[small])), shape=(len(counts), len(counts)))
    best = np.asarray(graph.argmax(axis=1)).reshape(-1)
    number = np.arange(len(counts))
    larger = (counts[best] > counts) | ((counts[best] == counts) & (best < number))
    moved = (np.diff(graph.indptr) > 0) & (counts < MIN_PART_POINTS) & larger
    goal = np.where(moved, best, number)
    for _ in range(4):  # chains of small parts
        goal = goal[goal]
    return _renumbered(goal[labels])
