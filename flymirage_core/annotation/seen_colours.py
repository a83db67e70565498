"""Colours of boxes as the views show them, for annotators that name things but not their colour."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.light import Light, light_of, seen_colour
from flymirage_core.rendering.views import View

PIXEL_STEP: Final = 4
"""Every fourth pixel, both ways, is looked at."""
REACH: Final = 6.0
"""Metres; what is farther from the camera shows too little of itself."""
MIN_PIXELS: Final = 8
PLACE_STEP: Final = 8
"""Every eighth of the pixels looked at tells of the place's light."""


def with_seen_colours(boxes: BoxMap, views: Iterable[View]) -> BoxMap:
    """The boxes with the colour of the pixels whose points lie in them; "" where there are too few."""
    colours: list[list[np.ndarray]] = [[np.zeros((0, 3))] for _ in boxes]
    place = [np.zeros((0, 3))]
    for view in views:
        points, rgb = _points(view)
        place.append(rgb[::PLACE_STEP])
        for found, box in zip(colours, boxes, strict=True):
            if np.linalg.norm(np.subtract(box.centre, view.camera.position)) < REACH:
                found.append(rgb[box.contains(points)])
    light = light_of(np.concatenate(place))
    return BoxMap(
        tuple(replace(b, colour=_name(np.concatenate(c), light)) for b, c in zip(boxes, colours, strict=True))
    )


def _points(view: View) -> tuple[np.ndarray, np.ndarray]:
    """World points (N, 3) of some pixels that have depth, and their colours (N, 3)."""
    k, depth = view.camera.intrinsics, view.picture.depth[::PIXEL_STEP, ::PIXEL_STEP]
    x = (np.arange(0, k.width, PIXEL_STEP) + 0.5 - k.cx) / k.fx
    y = (np.arange(0, k.height, PIXEL_STEP) + 0.5 - k.cy) / k.fy
    rays = np.stack(np.broadcast_arrays(x[None], y[:, None], 1.0), axis=-1)  # (h, w, 3)
    some = depth > 0
    local = (rays * depth[..., None])[some]
    world = local @ view.camera.T_world_camera[:3, :3].T + view.camera.position
    return world, view.picture.rgb[::PIXEL_STEP, ::PIXEL_STEP][some]


def _name(pixels: np.ndarray, light: Light) -> str:
    return seen_colour(pixels, light) if len(pixels) >= MIN_PIXELS else ""
