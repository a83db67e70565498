"""Algorithm 1 as a drawing: what a target rules out is tinted, what it leaves is not."""

import numpy as np
import pytest

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.occupancy.grid import FREE, OccupancyGrid
from flymirage_core.pictures.floor_plan import FloorPlan
from flymirage_core.pictures.target_selection import draw_target_selection
from flymirage_core.settings import TargetSettings


def make_box(object_id: int, centre: tuple[float, float, float]) -> ObjectBox:
    return ObjectBox(object_id, "thing", centre, (0.5, 0.5, 0.5), 0.0, 1.0, "test", "", "", 1, 1.0, "test")


@pytest.fixture
def plan() -> FloorPlan:
    """16 x 16 m of free space round the origin."""
    state = np.full((160, 160, 20), FREE, np.uint8)
    return FloorPlan.of(OccupancyGrid(state, np.array([-8.0, -8.0, 0.0]), 0.1), (0.5, 1.5))


def colour_at(picture: np.ndarray, plan: FloorPlan, x: float, y: float) -> list[int]:
    column, row = plan.pixel([x, y, 0])[0]
    return picture[row, column].tolist()


def test_places_near_a_target_and_in_its_direction_are_tinted_and_others_are_not(plan):
    target = make_box(0, (6.0, 0.0, 1.0))
    picture = draw_target_selection(plan, [target], [target], (0, 0, 1), TargetSettings())
    assert colour_at(picture, plan, 5.0, 2.0) != [255, 255, 255]  # within d_prune
    assert colour_at(picture, plan, 2.0, 0.5) != [255, 255, 255]  # within theta_th
    assert colour_at(picture, plan, -5.0, 2.0) == [255, 255, 255]


def test_without_targets_nothing_is_tinted_and_the_legend_says_so(plan):
    near = make_box(0, (1.0, 0.0, 1.0))
    picture = draw_target_selection(plan, [near], [], (0, 0, 1), TargetSettings())
    assert colour_at(picture, plan, 5.0, 2.0) == [255, 255, 255]
    assert picture.shape[0] > plan.picture.shape[0]
