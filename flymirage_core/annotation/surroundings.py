"""What is round a box: does its surface go on beyond it, and into what; do other boxes share its room; who saw it.

A piece of a larger thing goes on into the rest of it, a left-over of the building into the building, in its colour;
a thing of its own mostly ends. The recogniser judges by these numbers, beside looks, whether a box is an object.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.fusion import footprint_overlap

Float32 = NDArray[np.float32]
Bool = NDArray[np.bool_]

REACH: Final = 0.12
"""Metres beyond a face within which its surroundings lie, ..."""
SLACK: Final = 0.02
"""... and within which a point still belongs to the face itself."""
POINT_AREA: Final = 0.03**2
"""Square metres that a fused point stands for."""
STEP_SCALE: Final = 10.0
MAX_STEPS: Final = 3.0
FAR: Final = 5.0
"""Metres; cameras farther away are not told apart."""

FEATURES: Final = 6 * 3 + 1 + 3 + 3


def surroundings(
    boxes: Sequence[FittedBox], seen: Sequence[Detections], points: Float32, colours: Float32, building: Bool
) -> Float32:
    """(B, FEATURES): what goes on beyond each box, what shares its room, and how it was seen.

    Beyond the top, the bottom, the ends and the broad sides (the fuller one of two first): surface of things and of the
    building for a square metre of the face, and its step in colour. Then surface inside that is not the box's own; the
    room it shares with other boxes; its views, the nearest camera, and the share of it that a view shows.

    ``points``: (N, 3) fused, that the boxes' members number. ``colours``: (N, 3) shading-free Lab. ``building``: (N,).
    """
    out = np.zeros((len(boxes), FEATURES), np.float32)
    shared = _shared_room(boxes)
    order = np.argsort(points[:, 0], kind="stable")
    east = points[order, 0]
    for k, (box, found) in enumerate(zip(boxes, seen, strict=True)):
        radius = np.hypot(*box.size[:2]) / 2 + REACH
        strip = order[slice(*np.searchsorted(east, (box.centre[0] - radius, box.centre[0] + radius)))]
        out[k, :19] = _beyond(box, strip, points, colours, building)
        out[k, 19:22] = shared[k]
        hits = found.hits[found.hits > 0]
        shown = float(np.median(hits)) / len(box.members) if len(hits) else 0.0
        out[k, 22:] = np.log1p(found.views), min(found.nearest, FAR), shown
    return out


def _beyond(box: FittedBox, strip: NDArray[np.intp], points: Float32, colours: Float32, building: Bool) -> Float32:
    turn = box.yaw + (np.pi / 2 if box.size[1] > box.size[0] else 0.0)
    c, s = np.cos(turn), np.sin(turn)
    half = np.array([max(box.size[:2]), min(box.size[:2]), box.size[2]]) / 2
    centre = np.array(box.centre)
    radius = np.array([np.hypot(half[0], half[1]), np.hypot(half[0], half[1]), half[2]]) + REACH
    near = strip[(np.abs(points[strip] - centre) < radius).all(axis=1)]
    near = np.setdiff1d(near, box.members, assume_unique=True)
    local = (points[near] - centre) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    beyond = np.abs(local) - half  # (K, 3)
    own = np.median(colours[box.members], axis=0)
    areas = np.array([half[1] * half[2], half[0] * half[2], half[0] * half[1]]) * 4
    sides = np.zeros((3, 2, 3), np.float32)  # axis, direction: surface of things, of the building, step of colour
    for axis in range(3):
        within = (np.delete(beyond, axis, axis=1) < SLACK).all(axis=1)
        within &= (beyond[:, axis] > SLACK) & (beyond[:, axis] < REACH)
        for direction in (0, 1):
            mine = near[within & ((local[:, axis] > 0) == (direction == 1))]
            if not len(mine):
                continue
            share = len(mine) * POINT_AREA / max(areas[axis], POINT_AREA)
            flat = float(building[mine].mean())
            step = float(colour_step(np.median(colours[mine], axis=0), own)) / STEP_SCALE
            sides[axis, direction] = np.log1p(share * (1 - flat)), np.log1p(share * flat), min(step, MAX_STEPS)
        if axis < 2 and sides[axis, 0, 0] > sides[axis, 1, 0]:
            sides[axis] = sides[axis, ::-1].copy()
    inside = int((beyond < 0).all(axis=1).sum())
    return np.append(sides.ravel(), np.log1p(inside / len(box.members))).astype(np.float32)


def _shared_room(boxes: Sequence[FittedBox]) -> Float32:
    """(B, 3) largest share of each box's room that lies in another, of another's in it, and boxes that touch it."""
    out = np.zeros((len(boxes), 3), np.float32)
    for i, a in enumerate(boxes):
        for j, b in enumerate(boxes[:i]):
            apart = np.hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1])
            if apart > (np.hypot(*a.size[:2]) + np.hypot(*b.size[:2])) / 2:
                continue
            height = min(a.top, b.top) - max(a.bottom, b.bottom)
            plan = footprint_overlap(a, b) if height > -REACH else 0.0
            if plan <= 0:
                continue
            room = plan * max(height, 0.0)
            of_a, of_b = room / max(a.volume, 1e-6), room / max(b.volume, 1e-6)
            out[i] = max(out[i, 0], of_a), max(out[i, 1], of_b), out[i, 2] + 1
            out[j] = max(out[j, 0], of_b), max(out[j, 1], of_a), out[j, 2] + 1
    out[:, 2] = np.log1p(out[:, 2])
    return out
