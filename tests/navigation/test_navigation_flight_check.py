import numpy as np
import pytest
from flight_worlds import empty_room, fill
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flymirage_core.errors import PlanningError
from flymirage_core.navigation.bspline import fit_bspline
from flymirage_core.navigation.flight_check import check_flight, exact_clearance
from flymirage_core.navigation.flight_space import keep_clear
from flymirage_core.navigation.seed_path import timed_samples
from flymirage_core.occupancy.grid import FREE, OccupancyGrid
from flymirage_core.settings import PlannerSettings

SETTINGS = PlannerSettings()
START, GOAL = np.array([1.0, 1.5, 1.25]), np.array([5.0, 1.5, 1.25])
ROOM = empty_room(6, 3, 2.5)


def straight(speed=1.0, start=START, goal=GOAL):
    samples, interval = timed_samples(np.stack([start, goal]), speed, 1.0, 0.3)
    return fit_bspline(samples, interval)


def check(spline, grid=ROOM, inflated=None, inflation=0.3, goal=GOAL):
    return check_flight(
        [(spline.control_points, spline.interval, spline.duration)],
        (START, goal),
        grid,
        keep_clear(grid, inflation) if inflated is None else inflated,
        inflation,
        SETTINGS,
    )


def test_a_good_flight_is_measured():
    spline = straight()
    measures = check(spline)
    assert measures.length == pytest.approx(4, abs=1e-6)
    assert measures.duration == pytest.approx(spline.duration)
    np.testing.assert_allclose(
        [measures.max_speed, measures.max_acceleration, measures.max_jerk], spline.highest_norms(), rtol=0.01
    )
    assert measures.min_clearance == pytest.approx(1.0, abs=1e-6)  # to the end walls
    assert measures.end_error < 1e-9


def test_a_flight_through_an_obstacle_is_rejected():
    with pytest.raises(PlanningError, match="in an obstacle at t="):
        check(straight(), fill(empty_room(6, 3, 2.5), (3.0, 1.4, 0.0), (3.1, 1.6, 2.5)))


def test_a_flight_past_an_obstacle_within_its_inflation_is_rejected():
    beside = fill(empty_room(6, 3, 2.5), (3.0, 1.7, 0.0), (3.1, 1.9, 2.5))
    with pytest.raises(PlanningError, match="inflated obstacle"):
        check(straight(), beside)
    with pytest.raises(PlanningError, match=r"clearance 0\.200 m"):
        check(straight(), beside, inflated=beside)


@pytest.mark.parametrize(("speed", "what"), [(2.0, "speed"), (1.45, "jerk|acceleration")])
def test_a_flight_beyond_the_limits_is_rejected(speed, what):
    spline = straight(speed)
    hurried = spline.stretched(0.5) if what != "speed" else spline
    with pytest.raises(PlanningError, match=f"({what}|speed) .* exceeds"):
        check(hurried)


def test_a_flight_that_ends_elsewhere_is_rejected():
    with pytest.raises(PlanningError, match=r"missed by 0\.020"):
        check(straight(), goal=np.add(GOAL, [0.02, 0, 0]))


def test_a_flight_that_does_not_stop_is_rejected():
    share = np.linspace(0, 1, 21)[:, None] ** 2  # of the way, in 8 s
    pull = 2 * (GOAL - START) / 8**2
    cruising = fit_bspline(START + share * (GOAL - START), 0.4, np.stack([0 * pull, 8 * pull, pull, pull]))
    with pytest.raises(PlanningError, match="not at rest"):
        check(cruising)


@given(
    arrays(np.bool_, (5, 4, 6), elements=st.booleans()),
    arrays(np.float64, (4, 3), elements=st.floats(-0.125, 0.75, width=32)),
)
def test_exact_clearance_is_the_distance_to_the_nearest_blocked_box(blocked, points):
    grid = OccupancyGrid(blocked.astype(np.uint8), np.zeros(3), 0.1)
    padded = np.pad(blocked, 10, constant_values=True)
    lower = (np.argwhere(padded) - 10) * 0.1  # (M, 3) of all blocked boxes, those outside of the grid included
    gaps = np.maximum(np.maximum(lower - points[:, None], points[:, None] - lower - 0.1), 0)
    np.testing.assert_allclose(exact_clearance(grid, points), np.linalg.norm(gaps, axis=2).min(axis=1), atol=1e-9)


@given(
    arrays(np.uint8, (7, 6, 5), elements=st.sampled_from([0, 0, 0, 0, 0, 0, 0, 0, 1, 2])),
    st.sampled_from([0.1, 0.15, 0.2]),
)
def test_every_point_of_a_voxel_that_is_kept_clear_has_the_clearance(state, radius):
    grid = OccupancyGrid(np.pad(state, 3), np.zeros(3), 0.1)
    space = keep_clear(grid, radius)
    free = np.argwhere(space.state == FREE)
    corners = np.array(np.meshgrid(*[[1e-9, 1 - 1e-9]] * 3)).reshape(3, -1).T
    points = (free[:, None] + corners).reshape(-1, 3) * 0.1
    assert (exact_clearance(grid, points) >= radius - 1e-6).all() if len(points) else True
    lost = np.argwhere((grid.state == FREE) & (space.state != FREE))
    nearest = exact_clearance(grid, ((lost[:, None] + corners).reshape(-1, 3)) * 0.1).reshape(len(lost), -1)
    assert (nearest.min(axis=1) < radius).all()  # and nothing else is taken away
