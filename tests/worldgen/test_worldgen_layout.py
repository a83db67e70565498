"""Layouts: what is asked for is placed or reported, nothing goes through anything, words are honoured, c stays free."""

from collections import Counter

import numpy as np
import pytest
from generated_places import EVERY, described, flat, planned, street, works, zone
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.worldgen.assembly import build_truth
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.footprints import Occupied, Solid
from flymirage_core.worldgen.place import THICKNESS, place_for
from flymirage_core.worldgen.truth import PlacedObject, WorldTruth

KEYS = st.from_regex(r"[a-z0-9][a-z0-9_-]{0,20}", fullmatch=True)
SEVERAL = ["scene-0001", "scene-0002", "scene-0003", "demo-0000", "demo-0001", "demo-0002", "demo-0003", "demo-0004"]
PLACES = st.one_of(st.builds(lambda make, key: make(key), st.sampled_from(list(EVERY.values())), KEYS),
                   st.builds(OfflineSceneWriter().describe, KEYS))  # fmt: skip


def written(key):
    return OfflineSceneWriter().describe(key)


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


@given(PLACES)
@settings(max_examples=12)
def test_no_two_objects_interpenetrate_and_all_are_in_their_space(description):
    truth = build_truth(description)
    spaces = {s.zone: s for s in truth.spaces}
    solid = [o for o in truth.objects if not kind_of(o.noun).flat]
    for i, one in enumerate(solid):
        points = sample_inside(one, 0.002)
        space = spaces[one.zone]
        assert (points >= np.array(space.low) - 1e-3).all(), one.noun
        assert (points <= np.array(space.high) + 1e-3).all(), one.noun
        for other in solid[:i]:
            if (
                np.linalg.norm(np.subtract(one.centre, other.centre))
                < (np.linalg.norm(one.size) + np.linalg.norm(other.size)) / 2
            ):
                assert not contains(other, points, 0.002).any(), (one.noun, other.noun)
                assert not contains(one, sample_inside(other, 0.002), 0.002).any(), (one.noun, other.noun)


@given(PLACES)
@settings(max_examples=12)
def test_no_object_stands_in_what_belongs_to_the_building(description):
    truth = build_truth(description)
    taken = Occupied()
    for solid in truth.structure:
        taken.add(solid)
    assert not [o.noun for o in truth.objects if not kind_of(o.noun).flat and taken.hits(o.solid, -0.002)]


@given(PLACES)
@settings(max_examples=12)
def test_a_ball_of_one_metre_round_c_is_free(description):
    truth = build_truth(description)
    assert 1.1 <= truth.centre[2] <= 1.7
    assert min((o.solid.distance_to(truth.centre) for o in truth.objects if not kind_of(o.noun).flat), default=9) >= 1.0
    assert min((s.distance_to(truth.centre) for s in truth.structure), default=9) >= 1.0
    assert truth.is_free(truth.centre).all()


@given(PLACES)
@settings(max_examples=12)
def test_every_planned_object_is_placed_or_reported(description):
    truth = build_truth(description)
    wanted, found = Counter(), Counter()
    for o in description.objects:
        wanted[o.noun] += o.count
    for o in truth.objects:
        found[o.noun] += 1
    for u in truth.unplaced:
        assert u.reason.startswith("no free")
        found[u.noun] += u.count
    assert wanted == Counter({noun: n for noun, n in found.items() if noun in wanted})


@pytest.mark.parametrize("key", SEVERAL)
def test_a_scene_holds_sixty_objects_or_more(key):
    assert len(build_truth(written(key)).objects) >= 60


@pytest.mark.parametrize("make", EVERY.values(), ids=EVERY)
def test_spaces_do_not_overlap_and_connected_ones_have_a_doorway(make):
    place = place_for(make())
    assert not place.unplaced
    for i, one in enumerate(place.spaces):
        for other in place.spaces[:i]:
            assert (one.low >= other.high + THICKNESS / 2).any() or (other.low >= one.high + THICKNESS / 2).any()
    doorways = sum(o.kind == "doorway" for s in place.spaces for w in s.walls for o in w.openings)
    assert doorways == 2 * (len(place.spaces) - 1)  # one in each of the two walls


def test_placements_mean_what_they_say():
    for description in (flat(), works(), street(), *map(written, SEVERAL)):
        place, truth = place_for(description), build_truth(description)
        for o in truth.objects:
            walls = place.space(o.zone).walls
            back = np.array(o.centre[:2]) - o.axes[1] * o.size[1] / 2
            to_wall = min(abs((back - w.origin) @ w.inward) for w in walls if w.enclosure != "open")
            if o.placement in ("against_wall", "on_wall"):
                assert to_wall < 0.05, o.noun
            if o.placement == "hanging":
                assert o.bottom >= 1.0, o.noun
            if o.placement == "on_surface":
                support = truth.objects[o.support]
                assert o.bottom - support.bottom == pytest.approx(support.size[2] * kind_of(support.noun).top, abs=2e-3)
                assert contains(support, np.array([[*o.centre[:2], support.centre[2]]]), 0.0).all()
            if o.placement in ("on_floor", "in_row", "around", "against_wall", "facing", "beside"):
                assert o.bottom == pytest.approx(0.0, abs=1e-3), o.noun


@given(KEYS)
@settings(max_examples=8)
def test_what_faces_a_thing_looks_at_it_and_what_is_beside_it_is_near(key):
    truth = build_truth(flat(key))
    sofa = next((o for o in truth.objects if o.noun == "sofa"), None)
    for o in truth.objects:
        if o.placement == "facing":
            way = np.subtract(sofa.centre, o.centre)[:2]
            assert o.axes[1] @ way / np.linalg.norm(way) > 0.8
        if o.placement == "beside":
            assert sofa.solid.distance_to(o.centre) < 1.2
        if o.placement == "around" and o.noun == "dining chair":
            table = next(t for t in truth.objects if t.noun == "dining table")
            assert o.axes[1] @ np.subtract(table.centre, o.centre)[:2] > 0


def test_a_zone_that_finds_no_side_is_reported_with_its_objects():
    names = [f"room {i}" for i in range(12)]
    zones = [zone("closet", "room", (2.5, 2.5, 2.6), tuple(names))]
    zones += [zone(n, "room", (9, 9, 2.6), ("closet",)) for n in names]
    truth = build_truth(described("crowd", zones, [planned("crate", 1, "on_floor", zone=n) for n in names]))
    lost = [u for u in truth.unplaced if u.noun in names]
    assert lost and all("no free side" in u.reason for u in lost)
    assert sum(u.count for u in truth.unplaced if u.noun == "crate") >= len(lost)


def test_a_room_that_is_asked_for_too_much_says_what_has_no_place():
    description = written("scene-0001")
    too_much = planned("wardrobe", 60, "against_wall")
    truth = build_truth(description.model_copy(update={"objects": (too_much,)}))
    assert 5 < len(truth.objects) < 60
    assert sum(u.count for u in truth.unplaced) == 60 - len(truth.objects)


def test_truth_survives_its_file_format(tmp_path):
    truth = build_truth(works())
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
