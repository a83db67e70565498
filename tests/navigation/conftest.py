"""Numbers dumped from the original EGO-Planner, if they lie beside the project."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flymirage_core.occupancy.grid import OccupancyGrid


@pytest.fixture(scope="session")
def original_folder() -> Path:
    data = Path(os.environ.get("FLYMIRAGE_TEST_DATA", Path(__file__).parents[3] / "shared" / "data"))
    if not (data / "ego" / "golden_units_room.json").exists():
        pytest.skip(f"no numbers of the original planner in {data}: set FLYMIRAGE_TEST_DATA")
    return data / "ego"


@pytest.fixture(scope="session")
def original(original_folder: Path) -> dict[str, Any]:
    return json.loads((original_folder / "golden_units_room.json").read_text())


@pytest.fixture(scope="session")
def original_room(original_folder: Path) -> tuple[OccupancyGrid, np.ndarray, np.ndarray]:
    """Its test room, not inflated, and 20 starts and goals (20, 3)."""
    data = np.load(original_folder / "room.npz")
    grid = OccupancyGrid(data["grid"].astype(np.uint8), data["origin"], float(data["resolution"]))
    return grid, data["starts"], data["goals"]
