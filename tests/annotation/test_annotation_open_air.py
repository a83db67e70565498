"""Open-air places: what closes them is told from rows of things, and from rooms with a ceiling."""

import numpy as np
import pytest

from flymirage_core.annotation.fused_points import Frame
from flymirage_core.annotation.open_air import find_open_air, sees_sky
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along

STEP = 0.05


def plane(origin, a, b) -> np.ndarray:
    """Points (N, 3) ``STEP`` apart over the parallelogram at ``origin`` with the edges ``a`` and ``b``."""
    a, b = np.array(a, float), np.array(b, float)
    u, v = (np.arange(0, 1, STEP / np.linalg.norm(edge)) for edge in (a, b))
    return (np.array(origin, float) + u[:, None, None] * a + v[None, :, None] * b).reshape(-1, 3).astype(np.float32)


def street(*things: tuple[np.ndarray, tuple[float, float, float]]):
    """A street along x, 10 m wide, with house fronts on both sides at y = +-5; ``things``: points and their normal."""
    surfaces = [
        (plane((-10, -5, 0), (20, 0, 0), (0, 10, 0)), (0, 0, 1)),
        (plane((-10, -5, 0), (20, 0, 0), (0, 0, 6)), (0, 1, 0)),
        (plane((-10, 5, 0), (20, 0, 0), (0, 0, 6)), (0, -1, 0)),
        *things,
    ]
    points = np.concatenate([p for p, _ in surfaces])
    normals = np.concatenate([np.tile(np.array(n, np.float32), (len(p), 1)) for p, n in surfaces])
    return points, normals


def structure(*things, eyes=((0, 0, 1.5),)):
    points, normals = street(*things)
    return find_open_air(points, normals, points, np.array(eyes, float))


def test_house_fronts_and_the_ground_are_the_place():
    found = structure()
    assert found.ceiling is None
    assert sorted(w.offset for w in found.walls) == pytest.approx([-5, -5], abs=0.05)
    assert found.contains(np.array([[0, -5, 4], [3, 5, 1], [0, 0, 0.02]], np.float32)).all()
    assert not found.contains(np.array([[0, 0, 1], [3, 4.5, 3]], np.float32)).any()


def test_what_shows_through_windows_belongs_to_the_house():
    assert structure().contains(np.array([[0, 6.5, 1.5]], np.float32)).all()


def test_a_face_that_a_camera_was_behind_closes_nothing():
    found = structure(eyes=((0, 0, 1.5), (0, 7, 8.0)))
    assert not found.contains(np.array([[0, 7, 1.5]], np.float32)).any()
    assert found.contains(np.array([[0, 5, 1.5]], np.float32)).all()


def test_a_row_of_stalls_with_gaps_is_no_wall():
    counters = [(plane((x, 2, 0), (2.4, 0, 0), (0, 0, 0.85)), (0, -1, 0)) for x in np.arange(-7, 7, 2.6)]
    assert len(structure(*counters).walls) == 2


def test_a_fence_is_a_wall():
    fence = (plane((-9, 2, 0), (14, 0, 0), (0, 0, 1.8)), (0, -1, 0))
    assert len(structure(fence).walls) == 3


def view(depth: float) -> Frame:
    """One that looks up by 40 degrees at something everywhere ``depth`` metres away along the axis; 0 = no return."""
    direction = (np.cos(np.radians(40)), 0, np.sin(np.radians(40)))
    camera = Camera(Intrinsics.from_horizontal_fov(64, 48, np.pi / 2), look_along(np.zeros(3), direction))
    picture = np.full((48, 64), depth, np.float32)
    return Frame(camera, np.zeros((48, 64, 3), np.uint8), picture, np.ones_like(picture))


@pytest.mark.parametrize(("depth", "open_air"), [(45.0, True), (4.0, False), (0.0, False)])
def test_sky_is_what_is_farther_up_than_any_ceiling(depth, open_air):
    assert sees_sky([view(depth)]) is open_air


def test_a_little_sky_between_trees_and_houses_is_enough():
    assert sees_sky([view(45.0)] + 15 * [view(4.0)])
