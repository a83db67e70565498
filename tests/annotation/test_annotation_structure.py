"""What of a hall is building: walls are, beams and what stands below them in one plane are not."""

import numpy as np

from flymirage_core.annotation.room_structure import find_structure

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
