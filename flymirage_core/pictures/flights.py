"""Flights as pictures: all of a scene from above and from the side by speed, and one over time."""

from typing import Final

import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.pictures.canvas import INK, PAPER, Colour, Picture, stacked
from flymirage_core.pictures.charts import Series, colour_bar, colours_of, time_charts
from flymirage_core.pictures.floor_plan import FloorPlan
from flymirage_core.settings import PlannerSettings

_START: Final[Colour] = (40, 160, 70)
_GAP: Final = 8
_PANEL_HEIGHT: Final = 120
_STEP: Final = 3
"""Every third state is enough for a line on a map."""


def flights_by_speed(
    flights: Trajectories, grid: OccupancyGrid, boxes: BoxMap, heights: tuple[float, float], settings: PlannerSettings
) -> Picture:
    """From above (what is occupied between ``heights``) and from the side; green: where flights begin, dark: end."""
    top, side = FloorPlan.of(grid, heights), FloorPlan.from_the_side(grid)
    top.boxes(boxes)
    for plan in (top, side):
        for flight in flights:
            speeds = np.linalg.norm(flight.velocities[::_STEP], axis=1)
            plan.coloured_path(flight.positions[::_STEP], colours_of(speeds[:-1], 0.0, settings.max_speed))
        for flight in flights:
            plan.dot(flight.positions[0], _START, 4)
            plan.dot(flight.positions[-1], INK, 4)
    bar = colour_bar("speed, m/s", 0.0, settings.max_speed, top.picture.shape[1])
    gap = np.full((_GAP, top.picture.shape[1], 3), PAPER, np.uint8)
    return stacked([top.picture, gap, side.picture, bar])


def flight_over_time(flight: Flight, settings: PlannerSettings, width: int) -> Picture:
    """Speed, acceleration, clearance and yaw of one flight, with the limits that they keep."""
    yaws = np.degrees(np.unwrap(flight.yaws))
    series = [
        Series("speed, m/s", np.linalg.norm(flight.velocities, axis=1), (settings.max_speed,)),
        Series("acceleration, m/s^2", np.linalg.norm(flight.accelerations, axis=1), (settings.max_acceleration,)),
        Series("clearance, m", flight.clearances, (flight.report.inflation,)),
        Series("yaw, degrees", yaws),
    ]
    return time_charts(flight.times, series, width, _PANEL_HEIGHT)
