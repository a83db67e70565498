"""Layouts: what is asked for is placed or reported, nothing goes through anything, and c stays free."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.scene.design import PlannedObject
from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.footprints import Occupied, Solid
from flymirage_core.worldgen.layout import lay_out
from flymirage_core.worldgen.model import build_truth
from flymirage_core.worldgen.truth import PlacedObject, WorldTruth

KEYS = st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True)
SEVERAL = ["scene-0001", "scene-0002", "scene-0003", "demo-0000", "demo-0001", "demo-0002", "demo-0003", "demo-0004"]


def described(key):
    return OfflineSceneWriter().describe(key)


def as_solid(o: PlacedObject) -> Solid:
    return Solid(o.centre[0], o.centre[1], o.size[0], o.size[1], o.bottom, o.top, o.yaw)


def sample_inside(o: PlacedObject, shrink: float) -> np.ndarray:
    """A lattice of points in the object's box, ``shrink`` metres in from its faces."""
    axes = [np.linspace(-1, 1, 5) * max(s / 2 - shrink, 0.0) for s in o.size]
    local = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    local[:, :2] = local[:, :2] @ o.axes
    return local + o.centre


def contains(o: PlacedObject, points: np.ndarray, shrink: float) -> np.ndarray:
    local = points - o.centre
    local[:, :2] = local[:, :2] @ o.axes.T
    return (np.abs(local) < np.array(o.size) / 2 - shrink).all(axis=1)


@given(KEYS)
@settings(max_examples=25, deadline=None)
def test_no_two_objects_interpenetrate_and_all_are_in_the_room(key):
    truth = build_truth(described(key))
    solid = [o for o in truth.objects if not kind_of(o.noun).flat]
    for i, one in enumerate(solid):
        points = sample_inside(one, 0.002)
        assert (np.abs(points) <= np.array(truth.dimensions) * [0.5, 0.5, 1.0] + 1e-3).all(), one.noun
        for other in solid[:i]:
            if (
                np.linalg.norm(np.subtract(one.centre, other.centre))
                < (np.linalg.norm(one.size) + np.linalg.norm(other.size)) / 2
            ):
                assert not contains(other, points, 0.002).any(), (one.noun, other.noun)
                assert not contains(one, sample_inside(other, 0.002), 0.002).any(), (one.noun, other.noun)


@given(KEYS)
@settings(max_examples=25, deadline=None)
def test_a_ball_of_one_metre_round_c_is_free(key):
    truth = build_truth(described(key))
    assert 1.3 <= truth.centre[2] <= 1.7
    assert min(as_solid(o).distance_to(truth.centre) for o in truth.objects if not kind_of(o.noun).flat) >= 1.0


@given(KEYS)
@settings(max_examples=25, deadline=None)
def test_every_planned_object_is_placed_or_reported(key):
    description = described(key)
    truth = build_truth(description)
    planned, found = Counter(), Counter()
    for o in description.objects:
        planned[o.noun] += o.count
    for o in truth.objects:
        found[o.noun] += 1
    for u in truth.unplaced:
        found[u.noun] += u.count
        assert u.reason.startswith("no free")
    assert planned == found


@pytest.mark.parametrize("key", SEVERAL)
def test_a_scene_holds_seventy_five_objects_or_more(key):
    assert len(build_truth(described(key)).objects) >= 75


@pytest.mark.parametrize("key", SEVERAL)
def test_placements_mean_what_they_say(key):
    truth = build_truth(described(key))
    x, y, z = truth.dimensions
    for o in truth.objects:
        back = np.array(o.centre[:2]) - o.axes[1] * o.size[1] / 2
        to_wall = min(x / 2 - abs(back[0]), y / 2 - abs(back[1]))
        if o.placement in ("against_wall", "on_wall"):
            assert to_wall < 0.05, o.noun
        if o.placement == "hanging":
            assert abs(o.top - z) < 1e-3, o.noun
        if o.placement == "on_surface":
            support = truth.objects[o.support]
            assert abs(o.bottom - support.top) < 2e-3, o.noun
            assert contains(support, np.array([[*o.centre[:2], support.centre[2]]]), 0.0).all()
        if o.placement in ("on_floor", "in_row", "around", "against_wall"):
            assert o.bottom == pytest.approx(0.0, abs=1e-3), o.noun


def test_chairs_face_their_table():
    truth = next(
        t for t in map(build_truth, map(described, SEVERAL)) if any(o.placement == "around" for o in t.objects)
    )
    plan = {(o.noun, o.colour): o.relative_to for d in map(described, SEVERAL) for o in d.objects}
    for chair in (o for o in truth.objects if o.placement == "around"):
        tables = [o for o in truth.objects if o.noun == plan[chair.noun, chair.colour]]
        nearest = min(tables, key=lambda t: np.hypot(*np.subtract(t.centre, chair.centre)[:2]))
        assert as_solid(nearest).distance_to(chair.centre) < 0.7
        assert chair.axes[1] @ np.subtract(nearest.centre, chair.centre)[:2] > 0


def test_a_room_that_is_asked_for_too_much_says_what_has_no_place():
    description = described("scene-0001")
    too_much = PlannedObject(noun="wardrobe", count=60, colour="white", material="oak", placement="against_wall")
    _, truth = lay_out(description.model_copy(update={"objects": (too_much,)}))
    assert 5 < len(truth.objects) < 60
    assert sum(u.count for u in truth.unplaced) == 60 - len(truth.objects)


def test_truth_survives_its_file_format(tmp_path):
    truth = build_truth(described("scene-0001"))
    truth.save(tmp_path)
    assert WorldTruth.load(tmp_path) == truth


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 3.1), st.floats(0.3, 2), st.floats(0.3, 2))
def test_boxes_hit_exactly_where_a_fine_lattice_of_one_lies_in_the_other(x, y, yaw, width, depth):
    placed, new = Solid(0, 0, 1.2, 0.7, 0, 1, 0.4), Solid(x, y, width, depth, 0, 1, yaw)
    occupied = Occupied()
    occupied.add(placed)
    u, v = np.meshgrid(np.linspace(-0.5, 0.5, 60), np.linspace(-0.5, 0.5, 60))
    points = np.stack([u.ravel() * width, v.ravel() * depth], 1) @ new.axes + [x, y]
    inside = (np.abs((points) @ placed.axes.T) < [0.6, 0.35]).all(axis=1)
    if inside.any():
        assert occupied.hits(new, 0.0)
    if not occupied.hits(new, 0.0):
        assert not inside.any()
    assert not occupied.hits(Solid(x, y, width, depth, 1.0, 2.0, yaw), 0.0)  # standing on top is touching, not hitting
