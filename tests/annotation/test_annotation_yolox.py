"""The 2D detector's decoding, on answers made up as the network gives them; its weights are not needed here."""

import math
from pathlib import Path

import numpy as np
import pytest

from flymirage_core.annotation.yolox import COCO, SIDE, YoloxDetector

DETECTOR = YoloxDetector(Path("not needed"))
FIRST_OF_STRIDE_16 = (SIDE // 8) ** 2


def answer(*cells: tuple[int, int, str, float, float, float]) -> np.ndarray:
    """Raw output (A, 85) with predictions (column, row, label, score, width, height) in cells of stride 16."""
    raw = np.zeros((sum((SIDE // stride) ** 2 for stride in (8, 16, 32)), 5 + len(COCO)), np.float32)
    for column, row, label, score, width, height in cells:
        cell = raw[FIRST_OF_STRIDE_16 + row * (SIDE // 16) + column]
        cell[:2] = 0.5
        cell[2:4] = math.log(width / 16), math.log(height / 16)
        cell[4] = score
        cell[5 + COCO.index(label)] = 1.0
    return raw


def test_a_prediction_becomes_a_window_in_the_pictures_own_pixels():
    (found,) = DETECTOR._decoded(answer((10, 4, "chair", 0.8, 40.0, 60.0)), scale=2.0)
    assert (found.label, found.score) == ("chair", pytest.approx(0.8))
    middle = 10.5 * 16 / 2, 4.5 * 16 / 2
    assert found.window == pytest.approx((middle[0] - 10, middle[1] - 15, middle[0] + 10, middle[1] + 15))


def test_two_windows_on_one_thing_are_one_and_the_surest_is_kept():
    found = DETECTOR._decoded(answer((10, 4, "chair", 0.8, 60, 60), (10, 5, "chair", 0.6, 60, 60)), 1.0)
    assert [f.score for f in found] == [pytest.approx(0.8)]


def test_things_of_two_kinds_may_share_a_place():
    found = DETECTOR._decoded(answer((10, 4, "chair", 0.6, 60, 60), (10, 5, "potted plant", 0.8, 60, 60)), 1.0)
    assert sorted(f.label for f in found) == ["chair", "potted plant"]


def test_a_doubtful_prediction_is_none():
    assert DETECTOR._decoded(answer((10, 4, "chair", 0.1, 60, 60)), 1.0) == []
