"""What is round a box: does its surface go on beyond it, and into what; do other boxes share its room; who saw it.

A piece of a larger thing goes on into the rest of it, a left-over of the building into the building, in its colour;
a thing of its own mostly ends. The recogniser judges by these numbers, beside looks, whether a box is an object.
"""

from collections.abc import Sequence
from typing import Final

import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.fusion import footprint_overlap

Float32 = NDArray[np.float32]
Bool = NDArray[np.bool_]
Index = NDArray[np.intp]

REACH: Final = 0.12
"""Metres beyond a face within which its surroundings lie, ..."""
SLACK: Final = 0.02
"""... and within which a point still belongs to the face itself."""
INSIDE: Final = 6
ELSEWHERE: Final = 7
POINT_AREA: Final = 0.03**2
"""Square metres that a fused point stands for."""
STEP_SCALE: Final = 10.0
MAX_STEPS: Final = 3.0
FAR: Final = 5.0
"""Metres; cameras farther away are not told apart."""

FEATURES: Final = 6 * 3 + 1 + 3 + 3


def surroundings(
    box: FittedBox,
    seen: Detections,
    rivals: Sequence[FittedBox],
    near: Index,
    points: Float32,
    colours: Float32,
    building: Bool,
) -> Float32:
    """(FEATURES,): what goes on beyond a box, what shares its room, and how it was seen.

    Beyond the top, the bottom, the ends and the broad sides (the fuller one of two first): surface of things and of the
    building for a square metre of the face, and its step in colour. Then surface inside that is not the box's own; the
    room it shares with its ``rivals``; its views, the nearest camera, and the share of it that a view shows.

    ``points``: (N, 3) fused, that the box's members number; ``near``: those that may lie within `REACH` of it.
    ``colours``: (N, 3) shading-free Lab. ``building``: (N,).
    """
    hits = seen.hits[seen.hits > 0]
    shown = float(np.median(hits)) / len(box.members) if len(hits) else 0.0
    seen_by = np.array([np.log1p(seen.views), min(seen.nearest, FAR), shown], np.float32)
    return np.concatenate([_beyond(box, near, points, colours, building), _shared_room(box, rivals), seen_by])


def _beyond(box: FittedBox, near: Index, points: Float32, colours: Float32, building: Bool) -> Float32:
    turn = box.yaw + (np.pi / 2 if box.size[1] > box.size[0] else 0.0)
    half = np.array([max(box.size[:2]), min(box.size[:2]), box.size[2]]) / 2
    where = _sides(points, near, np.array(box.centre), turn, half)
    foreign = np.ones(len(points), bool)
    foreign[box.members] = False
    own = np.median(colours[box.members], axis=0)
    areas = [float(4 * half.prod() / max(h, 1e-9)) for h in half]
    sides = np.zeros((3, 2, 3), np.float32)  # axis, direction: surface of things, of the building, step of colour
    for axis, direction in np.ndindex(3, 2):
        mine = near[where == 2 * axis + direction]
        mine = mine[foreign[mine]]
        if not len(mine):
            continue
        share = len(mine) * POINT_AREA / max(areas[axis], POINT_AREA)
        flat = float(building[mine].mean())
        step = float(colour_step(np.median(colours[mine], axis=0), own)) / STEP_SCALE
        sides[axis, direction] = np.log1p(share * (1 - flat)), np.log1p(share * flat), min(step, MAX_STEPS)
    for axis in (0, 1):
        if sides[axis, 0, 0] > sides[axis, 1, 0]:
            sides[axis] = sides[axis, ::-1].copy()
    inside = int(foreign[near[where == INSIDE]].sum())
    return np.append(sides.ravel(), np.log1p(inside / len(box.members))).astype(np.float32)


@numba.njit(cache=True, nogil=True)
def _sides(
    points: Float32, near: Index, centre: NDArray[np.float64], turn: float, half: NDArray[np.float64]
) -> NDArray[np.int8]:
    """(K,) beyond which face the points ``near`` lie: twice its axis, and one if ahead; or `INSIDE`, `ELSEWHERE`."""
    c, s = np.cos(turn), np.sin(turn)
    where = np.full(len(near), ELSEWHERE, np.int8)
    local = np.zeros(3)
    for k in range(len(near)):
        x, y = points[near[k], 0] - centre[0], points[near[k], 1] - centre[1]
        local[0], local[1], local[2] = c * x + s * y, c * y - s * x, points[near[k], 2] - centre[2]
        face, beyond, within = 0, 0, True
        for axis in range(3):
            out = abs(local[axis]) - half[axis]
            within &= out < 0
            if out >= REACH:
                beyond = 3
            elif out >= SLACK:
                beyond += 1
                face = 2 * axis + int(local[axis] > 0)
        if within:
            where[k] = INSIDE
        elif beyond == 1:
            where[k] = face
    return where


def _shared_room(box: FittedBox, rivals: Sequence[FittedBox]) -> Float32:
    """(3,) largest share of the box's room that lies in a rival, of a rival's in it, and log of those that touch it."""
    of_own, of_rival, touching = 0.0, 0.0, 0
    for rival in rivals:
        height = min(box.top, rival.top) - max(box.bottom, rival.bottom)
        plan = footprint_overlap(box, rival) if height > -REACH else 0.0
        if plan <= 0:
            continue
        room = plan * max(height, 0.0)
        of_own = max(of_own, room / max(box.volume, 1e-6))
        of_rival = max(of_rival, room / max(rival.volume, 1e-6))
        touching += 1
    return np.array([of_own, of_rival, np.log1p(touching)], np.float32)
