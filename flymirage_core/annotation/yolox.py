"""`YoloxDetector`: 80 everyday things in one picture, by YOLOX-Nano (Ge et al. 2021) through OpenCV's dnn.

The weights (Apache-2.0, Megvii) are no part of this project: `flymirage models fetch yolox-nano` obtains them.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import InputError

Float32 = NDArray[np.float32]

SIDE: Final = 416
"""Pixels of the network's square input."""
PAD: Final = 114
"""Grey of what the picture does not fill of it; the picture stands in the upper left corner."""
STRIDES: Final = (8, 16, 32)
MIN_SCORE: Final = 0.15
"""For many views of one thing, which check each other; one picture alone would want 0.3."""
NMS_IOU: Final = 0.5

COCO: Final = (
    "person", "bicycle", "car", "motorcycle", "airplane", "bus", "train", "truck", "boat", "traffic light",
    "fire hydrant", "stop sign", "parking meter", "bench", "bird", "cat", "dog", "horse", "sheep", "cow",
    "elephant", "bear", "zebra", "giraffe", "backpack", "umbrella", "handbag", "tie", "suitcase", "frisbee",
    "skis", "snowboard", "sports ball", "kite", "baseball bat", "baseball glove", "skateboard", "surfboard",
    "tennis racket", "bottle", "wine glass", "cup", "fork", "knife", "spoon", "bowl", "banana", "apple",
    "sandwich", "orange", "broccoli", "carrot", "hot dog", "pizza", "donut", "cake", "chair", "couch",
    "potted plant", "bed", "dining table", "toilet", "tv", "laptop", "mouse", "remote", "keyboard", "cell phone",
    "microwave", "oven", "toaster", "sink", "refrigerator", "book", "clock", "vase", "scissors", "teddy bear",
    "hair drier", "toothbrush",
)  # fmt: skip
"""The data set's classes, in the network's order."""


@dataclass(frozen=True)
class PictureDetection:
    """One thing in one picture; pixels, x right, y down."""

    label: str  # of `COCO`
    score: float  # 0..1
    window: tuple[float, float, float, float]  # left, top, right, bottom


class YoloxDetector:
    """YOLOX-Nano on the CPU, about 40 ms a picture and two threads."""

    name = "yolox-nano (Apache-2.0)"

    def __init__(self, weights: Path) -> None:
        """The file is read when the first picture comes."""
        self._weights = weights
        self._grid, self._stride = _anchors()

    @cached_property
    def _network(self) -> cv2.dnn.Net:
        try:
            return cv2.dnn.readNetFromONNX(str(self._weights))
        except cv2.error as error:
            raise InputError(
                f"{self._weights} cannot be read as an ONNX network; delete it and run `flymirage models fetch "
                "yolox-nano` again"
            ) from error

    def detect(self, rgb: NDArray[np.uint8]) -> list[PictureDetection]:
        """What is in a picture (H, W, 3), the surest first; raises `InputError` if the weights cannot be read."""
        scale = SIDE / max(rgb.shape[:2])
        height, width = round(rgb.shape[0] * scale), round(rgb.shape[1] * scale)
        canvas = np.full((SIDE, SIDE, 3), PAD, np.uint8)
        canvas[:height, :width] = cv2.resize(rgb, (width, height), interpolation=cv2.INTER_LINEAR)[:, :, ::-1]
        self._network.setInput(np.ascontiguousarray(canvas.transpose(2, 0, 1)[None], np.float32))
        raw = np.asarray(self._network.forward(), np.float32).reshape(-1, 5 + len(COCO))  # (A, 85)
        return self._decoded(raw, scale)

    def _decoded(self, raw: Float32, scale: float) -> list[PictureDetection]:
        scores = raw[:, 4:5] * raw[:, 5:]  # (A, 80)
        best = scores.argmax(axis=1)
        score = scores[np.arange(len(raw)), best]
        kept = np.flatnonzero(score >= MIN_SCORE)
        middle = (raw[kept, :2] + self._grid[kept]) * self._stride[kept]  # (K, 2)
        size = np.exp(raw[kept, 2:4]) * self._stride[kept]
        corner = (middle - size / 2) / scale
        size = size / scale
        rectangles = np.concatenate([corner, size], axis=1)
        chosen = cv2.dnn.NMSBoxesBatched(
            rectangles.tolist(), score[kept].tolist(), best[kept].tolist(), MIN_SCORE, NMS_IOU
        )
        return [
            PictureDetection(
                COCO[best[kept[i]]],
                float(score[kept[i]]),
                (
                    float(corner[i, 0]),
                    float(corner[i, 1]),
                    float(corner[i, 0] + size[i, 0]),
                    float(corner[i, 1] + size[i, 1]),
                ),
            )
            for i in np.asarray(chosen, int).ravel()
        ]


def _anchors() -> tuple[Float32, Float32]:
    """(A, 2) column and row of each prediction's cell, and (A, 1) the cell's side in pixels."""
    cells, strides = [], []
    for stride in STRIDES:
        n = SIDE // stride
        y, x = np.mgrid[:n, :n]
        cells.append(np.stack([x, y], axis=-1).reshape(-1, 2))
        strides.append(np.full((n * n, 1), stride))
    return np.concatenate(cells).astype(np.float32), np.concatenate(strides).astype(np.float32)
