import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flymirage_core.navigation.bspline import UniformBSpline, fit_bspline

coordinates = st.floats(-20, 20, width=32)
point_lists = st.integers(4, 30).flatmap(lambda n: arrays(np.float64, (n, 3), elements=coordinates))
intervals = st.floats(0.05, 1.0)


def test_evaluation_agrees_with_the_original(original):
    for case in original["parameterize"]:
        spline = UniformBSpline(np.array(case["ctrl"]), case["ts"])
        times = np.linspace(0, case["duration"], len(case["pos"]))
        assert np.isclose(spline.duration, case["duration"])
        for order, key in enumerate(("pos", "vel", "acc")):
            np.testing.assert_allclose(spline.at(times, order), case[key], atol=1e-9)


@given(point_lists, intervals, arrays(np.float64, (4, 3), elements=st.floats(-3, 3, width=32)))
def test_a_fit_meets_position_velocity_and_acceleration_at_both_ends_exactly(samples, interval, ends):
    spline = fit_bspline(samples, interval, ends)
    stop = spline.duration
    np.testing.assert_allclose(spline.at([0, stop]), samples[[0, -1]], atol=1e-9)
    np.testing.assert_allclose(spline.at([0, stop], 1), ends[:2], atol=1e-8)
    np.testing.assert_allclose(spline.at([0, stop], 2), ends[2:], atol=1e-6)


def test_a_fit_reproduces_samples_that_lie_on_a_spline():
    control = np.random.default_rng(0).normal(size=(12, 3))
    spline = UniformBSpline(control, 0.3)
    knots = np.arange(10) * 0.3
    ends = np.concatenate([spline.at(knots[[0, -1]], 1), spline.at(knots[[0, -1]], 2)])
    np.testing.assert_allclose(fit_bspline(spline.at(knots), 0.3, ends).control_points, control, atol=1e-9)


@given(point_lists, intervals, st.integers(1, 3))
def test_each_derivative_is_the_slope_of_the_one_before(control, interval, order):
    spline = UniformBSpline(control, interval)
    times = (np.arange(len(control) - 3) + 0.5) * interval  # between knots, where jerk is defined
    step = 1e-5 * interval
    slope = (spline.at(times + step, order - 1) - spline.at(times - step, order - 1)) / (2 * step)
    np.testing.assert_allclose(spline.at(times, order), slope, rtol=1e-4, atol=1e-4 / interval**order)


@given(point_lists, intervals, st.floats(1, 3))
def test_stretching_divides_speed_acceleration_and_jerk_by_powers_of_the_factor(control, interval, factor):
    spline = UniformBSpline(control, interval)
    expected = np.array(spline.highest_norms()) / factor ** np.arange(1, 4)
    np.testing.assert_allclose(spline.stretched(factor).highest_norms(), expected, rtol=1e-9, atol=1e-12)
