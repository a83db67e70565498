import numpy as np

from flymirage_core.occupancy.grid import FREE, OCCUPIED, OccupancyGrid
from flymirage_core.pictures.canvas import PAPER
from flymirage_core.pictures.charts import Series, colour_bar, colours_of, time_charts
from flymirage_core.pictures.floor_plan import FloorPlan


def room():
    """4 x 3 x 2 m, with a shelf along the whole of y at x = 3 to 3.4, up to 1 m."""
    state = np.full((40, 30, 20), FREE, np.uint8)
    state[30:34, :, :10] = OCCUPIED
    return OccupancyGrid(state, np.zeros(3), 0.1)


def test_a_side_view_is_dark_where_matter_stands_and_light_above_it():
    side = FloorPlan.from_the_side(room())
    (x, low), (_, high) = side.pixel([[3.2, 1.0, 0.5], [3.2, 1.0, 1.5]])
    assert side.picture[low, x].max() < 120
    assert side.picture[high, x].min() > 240


def test_a_view_from_above_looks_only_between_its_heights():
    column, row = FloorPlan.of(room(), (1.2, 1.8)).pixel([3.2, 1.0, 0.5])[0]
    assert FloorPlan.of(room(), (1.2, 1.8)).picture[row, column].min() > 240
    assert FloorPlan.of(room(), (0.2, 0.8)).picture[row, column].max() < 120


def test_each_leg_of_a_coloured_path_has_its_colour():
    plan = FloorPlan.of(room(), (1.2, 1.8))
    path = np.array([[0.5, 1.5, 1.0], [1.5, 1.5, 1.0], [2.5, 1.5, 1.0]])
    plan.coloured_path(path, [(255, 0, 0), (0, 0, 255)])
    for point, colour in ((path[:2].mean(axis=0), (255, 0, 0)), (path[1:].mean(axis=0), (0, 0, 255))):
        x, y = plan.pixel(point)[0]
        assert tuple(plan.picture[y, x]) == colour


def test_colours_run_from_blue_to_red_and_stop_at_the_ends():
    low, high, beyond = colours_of([0.1, 1.4, 9.0], 0.0, 1.5)
    assert low[2] > low[0]
    assert high[0] > high[2]
    assert beyond == colours_of([1.5], 0.0, 1.5)[0]
    assert (colour_bar("speed", 0.0, 1.5, 300) != PAPER).any()


def test_a_chart_draws_higher_values_higher_and_panels_below_each_other():
    times = np.linspace(0, 2, 50)
    charts = time_charts(times, [Series("rising", times), Series("limited", 0 * times + 1, (2.0,))], 300, 100)
    assert charts.shape == (200, 300, 3)
    rows, columns = np.nonzero((charts[:100] == (35, 100, 190)).all(axis=2))
    assert rows[columns < 100].mean() > rows[columns > 250].mean() + 20
    red, _, blue = np.moveaxis(charts[100:].astype(int), 2, 0)
    limit, _ = np.nonzero(red > blue + 60)
    line, _ = np.nonzero((charts[100:] == (35, 100, 190)).all(axis=2))
    assert limit.max() < line.min()
