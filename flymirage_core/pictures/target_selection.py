"""Algorithm 1 as a drawing: c, d_th1 and d_th2 round it, the candidates, the targets with what each prunes, paths."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.annotation.targets import azimuth_difference
from flymirage_core.pictures.canvas import INK, Colour, Picture, put_text
from flymirage_core.pictures.floor_plan import FloorPlan
from flymirage_core.settings import TargetSettings

CENTRE: Colour = (40, 160, 70)
TARGET: Colour = (205, 60, 45)
PRUNED: Colour = (225, 150, 40)
NEAR: Colour = (120, 125, 130)
PATH: Colour = (60, 90, 190)


def draw_target_selection(
    plan: FloorPlan,
    candidates: Iterable[ObjectBox],
    targets: Sequence[ObjectBox],
    centre: ArrayLike,
    settings: TargetSettings,
    paths: Iterable[NDArray[np.float64]] = (),
) -> Picture:
    """The drawing with its legend; ``centre`` (3,) is c, ``paths`` (K, 3) camera positions, world frame, metres."""
    c = np.asarray(centre, float)
    for target in targets:
        _prunes(plan, np.asarray(target.centre), c, settings)
    for radius in (settings.near_distance, settings.far_distance):
        _circle(plan, c, radius, INK)
    for box in candidates:
        plan.dot(box.centre, PRUNED if _is_far(box, c, settings) else NEAR, 3)
    for path in paths:
        plan.path(path, PATH)
        for point in path:
            plan.dot(point, PATH, 3)
    for number, target in enumerate(targets, 1):
        plan.path(np.stack([c, target.centre]), TARGET, 1)
        plan.dot(target.centre, TARGET, 6)
        x, y = plan.pixel(target.centre)[0]
        put_text(plan.picture, f"{number} {target.label}", (int(x) + 8, int(y) - 6), 0.42, TARGET)
    plan.dot(c, CENTRE, 6)
    names = ", ".join(t.label for t in targets) or "none: every object is near enough"
    return plan.with_caption(
        [
            f"green: c, in circles of d_th1 = {settings.near_distance:g} m and d_th2 = {settings.far_distance:g} m"
            "   grey: candidates within d_th2   orange: farther ones",
            f"red: the targets of Algorithm 1, the farthest first ({names})   blue: camera paths",
            f"pink: ruled out by a target, within d_prune = d_th1 of it or {settings.min_azimuth_deg:g} deg of azimuth",
        ]
    )


def _is_far(box: ObjectBox, c: NDArray[np.float64], settings: TargetSettings) -> bool:
    return bool(np.linalg.norm(np.subtract(box.centre, c)) > settings.far_distance)


def _prunes(plan: FloorPlan, target: NDArray[np.float64], c: NDArray[np.float64], settings: TargetSettings) -> None:
    """Tint the places that a target rules out for others."""
    height, width = plan.picture.shape[:2]
    columns, rows = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    xy = np.stack([columns, height - rows], axis=-1) / plan.scale + plan.lower  # (H, W, 2)
    near = np.linalg.norm(xy - target[:2], axis=-1) < settings.near_distance
    away, to_target = xy - c[:2], (target - c)[:2]
    turn = azimuth_difference(np.arctan2(away[..., 1], away[..., 0]), np.arctan2(to_target[1], to_target[0]))
    ruled_out = near | (turn < np.radians(settings.min_azimuth_deg))
    plan.picture[ruled_out] = (0.93 * plan.picture[ruled_out] + 0.07 * np.array(TARGET)).astype(np.uint8)


def _circle(plan: FloorPlan, c: NDArray[np.float64], radius: float, colour: Colour) -> None:
    x, y = plan.pixel(c)[0]
    cv2.circle(plan.picture, (int(x), int(y)), round(radius * plan.scale), colour, 1, cv2.LINE_AA)
