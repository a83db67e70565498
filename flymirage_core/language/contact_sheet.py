"""Contact sheets: a flight's sampled frames in one picture, as a VLM is shown them (paper, section III-C)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.evidence import sampled_indices
from flymirage_core.pictures.box_overlay import draw_box
from flymirage_core.pictures.canvas import put_text
from flymirage_core.pictures.encoding import jpeg_under
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.frames import FlightFrames

COLUMNS = 4
TILE_WIDTH = 384
"""Pixels: four of them make a sheet that VLMs read without shrinking it."""
MOST_TILES = 20
"""Longer flights are sampled more sparsely, so that the tiles stay legible."""
MOST_BYTES = 900_000
BOX_COLOUR = (255, 0, 255)
BOX_COLOUR_NAME = "magenta"


@dataclass(frozen=True)
class ContactSheets:
    """The same frames twice, as JPEG files: bare, and with the target's box."""

    bare: bytes
    boxed: bytes
    frames: int
    seconds_apart: float


def contact_sheets(frames: FlightFrames, target: ObjectBox, frame_step: int) -> ContactSheets:
    """Every ``frame_step``-th frame of the flight (counted at 30 Hz) and its last one."""
    indices = sampled_indices(len(frames), frames.rig.frame_rate, frame_step)
    if len(indices) > MOST_TILES:
        indices = sorted({indices[i] for i in np.linspace(0, len(indices) - 1, MOST_TILES).round().astype(int)})
    cameras = frames.cameras()
    pictures = frames.rgb_at(indices)
    boxed = [_with_box(picture, cameras[i], target) for picture, i in zip(pictures, indices, strict=True)]
    apart = (indices[1] - indices[0]) / frames.rig.frame_rate if len(indices) > 1 else 0.0
    return ContactSheets(
        jpeg_under(sheet(pictures), MOST_BYTES), jpeg_under(sheet(boxed), MOST_BYTES), len(indices), apart
    )


def sheet(pictures: Sequence[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Pictures (H, W, 3) of one size, side by side in reading order, each with its number from 1."""
    height, width = pictures[0].shape[:2]
    tile = (min(TILE_WIDTH, width), round(min(TILE_WIDTH, width) * height / width))
    columns = min(COLUMNS, len(pictures))
    rows = math.ceil(len(pictures) / columns)
    out = np.zeros((rows * tile[1], columns * tile[0], 3), np.uint8)
    for i, picture in enumerate(pictures):
        y, x = (i // columns) * tile[1], (i % columns) * tile[0]
        small = cv2.resize(picture, tile, interpolation=cv2.INTER_AREA).astype(np.uint8)
        put_text(small, str(i + 1), (5, 17), 0.5, (0, 0, 0))
        put_text(small, str(i + 1), (4, 16), 0.5, (255, 255, 255))
        out[y : y + tile[1], x : x + tile[0]] = small
    return out


def _with_box(picture: NDArray[np.uint8], camera: Camera, target: ObjectBox) -> NDArray[np.uint8]:
    out = np.ascontiguousarray(picture).copy()
    draw_box(out, camera, target, BOX_COLOUR)
    return out
