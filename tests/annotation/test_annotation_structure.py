"""What of a hall is building: walls are, beams and what stands below them in one plane are not."""

import numpy as np
import pytest

from flymirage_core.annotation.box_fitting import MAX_WALL_GAP, FittedBox, fit_box, settle
from flymirage_core.annotation.plausibility import is_thing
from flymirage_core.annotation.room_structure import find_structure
from flymirage_core.annotation.wall_objects import flat_things

STEP = 0.05


def plane(origin, a, b, normal) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 3) ``STEP`` apart over the parallelogram at ``origin`` with the edges ``a``, ``b``; normals (N, 3)."""
    a, b = np.array(a, float), np.array(b, float)
    u, v = (np.arange(0, 1, STEP / np.linalg.norm(edge)) for edge in (a, b))
    points = (np.array(origin, float) + u[:, None, None] * a + v[None, :, None] * b).reshape(-1, 3)
    return points.astype(np.float32), np.tile(np.array(normal, np.float32), (len(points), 1))


HALL = [
    plane((-6, -4, 0), (12, 0, 0), (0, 8, 0), (0, 0, 1)),
    plane((-6, -4, 5), (12, 0, 0), (0, 8, 0), (0, 0, -1)),
    plane((-6, -4, 0), (0, 8, 0), (0, 0, 5), (1, 0, 0)),
    plane((6, -4, 0), (0, 8, 0), (0, 0, 5), (-1, 0, 0)),
    plane((-6, -4, 0), (12, 0, 0), (0, 0, 5), (0, 1, 0)),
    plane((-6, 4, 0), (12, 0, 0), (0, 0, 5), (0, -1, 0)),
]
BEAM = plane((-2, -4, 4), (0, 8, 0), (0, 0, 0.6), (1, 0, 0))
CABINETS = plane((-2, -3, 0), (0, 5, 0), (0, 0, 1.2), (1, 0, 0))


def structure(*surfaces):
    points, normals = (np.concatenate(part) for part in zip(*surfaces, strict=True))
    return find_structure(points, normals, points, STEP)


def test_a_beam_over_cabinets_makes_no_wall():
    found = structure(*HALL, BEAM, CABINETS)
    assert len(found.walls) == 4
    assert not found.contains(CABINETS[0][CABINETS[0][:, 2] > 0.1]).any()


def test_a_partition_to_above_all_furniture_is_a_wall():
    partition = plane((-2, -4, 0), (0, 5, 0), (0, 0, 3), (1, 0, 0))
    found = structure(*HALL, partition)
    assert found.contains(partition[0]).mean() > 0.95


def test_what_is_built_before_a_wall_in_a_hall_is_not_the_wall():
    lockers = plane((-5.5, -3, 0), (0, 5, 0), (0, 0, 3), (1, 0, 0))
    found = structure(*HALL, lockers)
    assert len(found.walls) == 4


def thing(*boxes):
    """Points (N, 3) over the upright sides of boxes, each given by its middle in plan, size in plan, bottom and top."""
    sides = []
    for (x, y), (w, d), bottom, top in boxes:
        for edge, normal in (((w, 0, 0), (0, 1, 0)), ((0, d, 0), (1, 0, 0))):
            for k in (-1, 1):
                corner = np.array([x, y, bottom]) + k * np.array(normal) * (w / 2, d / 2, 0) - np.array(edge) / 2
                sides.append(plane(corner, edge, (0, 0, top - bottom), normal)[0])
    return np.concatenate(sides)


def hung(*boxes):
    points, hall = thing(*boxes), structure(*HALL)
    box = fit_box(points, np.zeros_like(points), np.arange(len(points)), hall, MAX_WALL_GAP)
    return settle([box], hall, [])[0]


def test_a_lamp_on_a_long_cord_keeps_little_of_the_cord():
    lamp = hung(((0, 0), (0.5, 0.5), 2.6, 2.9), ((0, 0), (0.06, 0.06), 2.9, 5.0))
    assert lamp.hanging
    assert lamp.bottom == pytest.approx(2.6, abs=0.06)
    assert lamp.top < 3.6


def test_a_lamp_close_under_the_ceiling_hangs_from_it_and_a_tray_stays_where_it_was_seen():
    assert hung(((0, 0), (0.5, 0.5), 4.1, 4.5)).top == pytest.approx(5.0, abs=0.06)
    assert hung(((0, 0), (2.5, 0.3), 4.1, 4.5)).top == pytest.approx(4.5, abs=0.06)


def test_a_flower_box_high_on_a_wall_is_a_thing_and_a_cornice_is_none():
    hall = structure(*HALL)
    box, cornice = (FittedBox((0, -4 + d / 2, 4.5), (1.0, d, 0.3), 0.0, np.arange(500)) for d in (0.3, 0.12))
    assert is_thing(box, hall)
    assert not is_thing(cornice, hall)


def brick_wall() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of a wall 6 m by 2.4 m, 2 cm apart, its colours of bricks in mortar, and two things on it.

    The light fades along it, and from 1.5 m up bricks are too far away to be told apart.
    """
    x, y = (a.ravel() for a in np.meshgrid(np.arange(0, 6, 0.02), np.arange(0, 2.4, 0.02)))
    course = (y // 0.08).astype(int)
    brick = ((x + 0.11 * (course % 2)) // 0.22).astype(int)
    shade = np.random.default_rng(0).normal(0, 7, (100, 100))[course, brick]
    mortar = (y % 0.08 < 0.02) | ((x + 0.11 * (course % 2)) % 0.22 < 0.02)
    colours = np.column_stack([60 - 3 * x + np.where(mortar, 15, shade), 12 - mortar * 9.0, 14 - mortar * 8.0])
    colours[y > 1.5] = np.column_stack([60 - 3 * x, 0 * x + 10, 0 * x + 12])[y > 1.5]
    for west, colour in ((0.8, (45, 30, -20)), (4.0, (70, -25, 25))):
        colours[(x > west) & (x < west + 0.8) & (y > 0.7) & (y < 1.3)] = colour
    return x, y, colours.astype(np.float32)


def test_pictures_are_found_on_bricks_that_are_told_apart_from_near_only():
    x, y, colours = brick_wall()
    things = list(flat_things(x, y, np.zeros(len(x)), colours))
    found = sorted((*corner, *sides) for _, corner, sides in things if min(sides) > 0.3)
    assert np.array(found) == pytest.approx(
        np.array([[0.8, 0.7, 0.8, 0.6], [4.0, 0.7, 0.8, 0.6]]), abs=0.17
    )  # a cell or two over


def test_two_boards_that_a_cable_joins_are_two_things():
    x, y = (a.ravel() for a in np.meshgrid(np.arange(0, 4, 0.02), np.arange(0, 2.4, 0.02)))
    colours = np.tile(np.array([75, -5, 10], np.float32), (len(x), 1))
    for west in (0.8, 2.2):
        colours[(x > west) & (x < west + 0.8) & (y > 1) & (y < 1.6)] = (35, 20, 20)
    colours[(x > 1.5) & (x < 2.3) & (y > 1.2) & (y < 1.32)] = (35, 20, 20)
    found = sorted((*corner, *sides) for _, corner, sides in flat_things(x, y, np.zeros(len(x)), colours))
    assert np.array(found) == pytest.approx(np.array([[0.8, 1, 0.8, 0.6], [2.2, 1, 0.8, 0.6]]), abs=0.1)
