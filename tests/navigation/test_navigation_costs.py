import numpy as np
import pytest

from flymirage_core.navigation import costs
from flymirage_core.navigation.lbfgs import CONVERGED, Problem, minimise, total_cost
from flymirage_core.navigation.obstacle_pairs import voxels_of
from flymirage_core.occupancy.grid import OccupancyGrid

ORIGINAL_LIMITS = np.array([2.0, 3.0, np.inf])
TIGHT_LIMITS = np.array([0.5, 0.5, 2.0])
EMPTY = OccupancyGrid(np.zeros((40, 40, 40), np.uint8), np.full(3, -20.0), 1.0)


def random_problem(seed: int) -> tuple[np.ndarray, Problem]:
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0.3, 0.1, (12, 3)), axis=0)
    v = rng.normal(size=(5, 3))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    index = rng.integers(3, 9, 5)
    p = points[index] + rng.normal(0, 0.5, (5, 3))
    reference = points[1:-1] + rng.normal(0, 0.1, (10, 3))
    weights = np.array([1.0, 0.5, 0.1, 1.0])
    return points, Problem(0.3, TIGHT_LIMITS, index, p, v, 0.5, reference, weights)


def test_costs_and_gradients_agree_with_the_original(original):
    for case in original["costs"]:
        points = np.array(case["ctrl"])
        reference = np.array(case["ref"])
        pairs = np.array(case["pair_index"]), np.array(case["pair_p"]), np.array(case["pair_v"])
        for name, cost in (
            ("smooth", lambda g, q=points: costs.smoothness(q, 1.0, g)),
            ("dist", lambda g, q=points, pairs=pairs: costs.collision(q, *pairs, 0.5, 1.0, g)),
            ("fit", lambda g, q=points, r=reference: costs.anisotropic_fit(q, r, 1.0, g)),
        ):
            gradient = np.zeros_like(points)
            assert cost(gradient) == pytest.approx(case[name], abs=1e-9)
            np.testing.assert_allclose(gradient, case[f"g_{name}"], atol=1e-9)


def test_feasibility_of_one_axis_alone_agrees_with_the_original(original):
    """The original limits each axis and we limit norms: the same where all motion is along one axis."""
    for case in original["costs"]:
        total, gradient = 0.0, np.zeros_like(case["ctrl"])
        for axis in range(3):
            points = np.zeros_like(gradient)
            points[:, axis] = np.array(case["ctrl"])[:, axis]
            total += costs.feasibility(points, case["ts"], ORIGINAL_LIMITS, 1.0, gradient)
        assert total == pytest.approx(case["feas"], rel=1e-9)
        np.testing.assert_allclose(gradient, case["g_feas"], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_the_gradient_is_the_slope_of_the_cost(seed):
    points, problem = random_problem(seed)
    gradient, unused = np.zeros_like(points), np.zeros_like(points)
    total_cost(points, problem, gradient)
    step = 1e-6
    for i in range(3, len(points) - 3):
        for axis in range(3):
            beside = np.zeros_like(points)
            beside[i, axis] = step
            above, below = (total_cost(points + side * beside, problem, unused)[0] for side in (1, -1))
            assert gradient[i, axis] == pytest.approx((above - below) / (2 * step), rel=1e-4, abs=1e-4)
    assert not gradient[:3].any()
    assert not gradient[-3:].any()


@pytest.mark.parametrize("seed", range(5))
def test_minimisation_goes_down_to_where_the_gradient_vanishes_and_keeps_the_ends(seed):
    points, problem = random_problem(seed)
    gradient = np.zeros_like(points)
    before, _ = total_cost(points, problem, gradient)
    slope = np.linalg.norm(gradient)
    ends = points[[0, 1, 2, -3, -2, -1]]
    assert minimise(points, problem, voxels_of(EMPTY), 1e-6) == CONVERGED
    after, _ = total_cost(points, problem, gradient)
    assert after < before
    assert np.linalg.norm(gradient) < 1e-3 * slope
    np.testing.assert_array_equal(points[[0, 1, 2, -3, -2, -1]], ends)
