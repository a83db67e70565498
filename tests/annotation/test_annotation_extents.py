"""How far boxes reach: hidden backs, plates on the floor, crowns out of range, things that only lie flat."""

import math
from functools import cache

import numpy as np
import pytest
from analytic_room import Body, Room, Thing, block, sweep, table, views_of

from flymirage_core.annotation.box_fitting import FittedBox, fit_footprint
from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.crowns import with_crowns
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.fused_points import frames_of
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.room_structure import HeightMap, RoomStructure
from flymirage_core.annotation.surroundings import FEATURES, surroundings
from flymirage_core.settings import AnnotationSettings

ANNOTATOR = EmbeddedAnnotator(AnnotationSettings())
BROWN, BLUE, ORANGE, GREY, WHITE = (120, 70, 40), (40, 70, 150), (230, 90, 20), (70, 70, 75), (235, 235, 235)
EYES = ((0.0, 0.0, 1.4), (0.9, -1.2, 1.2), (-0.9, -0.9, 1.6), (0.0, 1.0, 1.1))


@cache
def proposed(*things: Thing) -> tuple[FittedBox, ...]:
    """Boxes in a 5 x 4.4 x 2.6 m room with these things, whatever the recogniser would think of them."""
    room = Room((5, 4.4, 2.6), things)
    views = [view for eye in EYES for view in views_of(room, sweep(eye, yaws=6, pitches=(-35, 5), width=240))]
    return tuple(thing.box for thing, _ in ANNOTATOR.observations(ANNOTATOR.evidence(frames_of(views), math.inf)))


def best(thing: Thing, boxes: tuple[FittedBox, ...]) -> tuple[float, FittedBox | ObjectBox]:
    return max(((yaw_iou(thing.box, box), box) for box in boxes), key=lambda pair: pair[0], default=(0.0, thing.box))


def test_two_faces_that_meet_in_a_corner_give_the_rooms_direction_and_not_the_diagonal():
    side = np.linspace(0, 1, 60)
    corner = np.concatenate([np.stack([side, 0 * side], axis=1), np.stack([0 * side, 0.8 * side], axis=1)])
    noise = np.random.default_rng(0).normal(0, 0.012, corner.shape)
    plan = fit_footprint(np.column_stack([corner + noise, np.zeros(len(corner))]).astype(np.float32), 0.0)
    assert plan.yaw == pytest.approx(0, abs=0.02) or plan.yaw == pytest.approx(np.pi / 2, abs=0.02)
    assert sorted(plan.size) == pytest.approx([0.8, 1.0], abs=0.08)


def test_what_no_view_sees_behind_a_cabinet_belongs_to_it():
    cabinet = block("cabinet", (0.2, 1.8, 0), (1.0, 0.7, 2.0), BROWN)  # its back is 5 cm from the wall
    assert best(cabinet, proposed(cabinet))[0] > 0.8


def test_a_table_does_not_grow_over_the_floor_that_is_seen_behind_it():
    desk = table((0.2, 1.4, 0), BROWN, (1.2, 0.6, 0.74))  # half a metre of floor between it and the wall
    found = best(desk, proposed(desk))
    assert found[0] > 0.7
    assert min(found[1].size[:2]) < 0.75


def test_a_keyboard_lying_on_a_desk_is_a_thing():
    desk = block("desk", (-1.7, 0.4, 0), (0.7, 1.6, 0.75), WHITE)
    keyboard = block("keyboard", (-1.6, 0.3, 0.75), (0.16, 0.44, 0.03), GREY)
    assert best(keyboard, proposed(desk, keyboard))[0] > 0.25


def test_a_rug_is_a_thing_and_bare_floor_is_none():
    rug = block("rug", (0.6, 0.4, 0), (1.8, 1.2, 0.01), BLUE)
    iou, box = best(rug, proposed(rug))
    assert iou > 0.25
    assert sorted(box.size[:2]) == pytest.approx([1.2, 1.8], abs=0.12)
    assert proposed() == ()


def test_a_mat_is_as_thick_as_it_stands_above_the_floor():
    mat = block("mat", (0.6, 0.4, 0), (1.8, 1.2, 0.06), BLUE)
    assert best(mat, proposed(mat))[0] > 0.5


def test_the_feet_of_a_sign_that_is_nearly_nothing_in_plan_belong_to_it():
    panel = Body((0, 0, 0.8), (0.8, 0.05, 1.5), BLUE)
    feet = [Body((x, 0, 0.015), (0.08, 0.4, 0.03), BLUE) for x in (-0.3, 0.3)]
    sign = Thing("sign", (0.5, 0.4, 0), 0.0, (panel, *feet))
    assert best(sign, proposed(sign))[0] > 0.5


def test_the_plate_under_a_cone_belongs_to_it():
    plate, body = Body((0, 0, 0.015), (0.4, 0.4, 0.03), ORANGE), Body((0, 0, 0.33), (0.26, 0.26, 0.6), ORANGE)
    cone = Thing("cone", (0.6, 0.5, 0), 0.0, (plate, body))
    iou, box = best(cone, proposed(cone))
    assert iou > 0.6
    assert box.size[:2] == pytest.approx([0.4, 0.4], abs=0.08)


def open_air() -> RoomStructure:
    ground = HeightMap(np.array([-5.0, -5.0]), np.zeros((80, 80)))
    return RoomStructure(0.0, None, 0.0, (), ground, ground.raised(0.09), None)


def tree() -> np.ndarray:
    """(N, 3) points of a trunk up to 3 m, and of a crown 3 m wide from 2.5 to 5 m, 10 cm apart."""
    trunk = [(0.1 * x, 0.1 * y, z) for x in (-1, 1) for y in (-1, 1) for z in np.arange(0, 3, 0.1)]
    steps = np.arange(-1.5, 1.51, 0.1)
    crown = [(x, y, z) for x in steps for y in steps for z in np.arange(2.5, 5.01, 0.1) if x**2 + y**2 < 2.25]
    return np.array(trunk + crown, np.float32)


def test_a_tree_seen_up_to_three_metres_gets_the_rest_of_its_crown():
    seen = FittedBox((0, 0, 1.6), (1.0, 1.0, 3.2), 0.0, np.zeros(0, np.intp))
    (box,) = with_crowns([seen], tree(), open_air())
    assert box.top == pytest.approx(5.0, abs=0.15)
    assert box.bottom == pytest.approx(0.0)
    assert box.size[:2] == pytest.approx([3, 3], abs=0.3)


def test_low_things_and_things_in_rooms_get_no_crown():
    low = FittedBox((0, 0, 0.5), (1.0, 1.0, 1.0), 0.0, np.zeros(0, np.intp))
    assert with_crowns([low], tree(), open_air()) == [low]
    tall = FittedBox((0, 0, 1.6), (1.0, 1.0, 3.2), 0.0, np.zeros(0, np.intp))
    place = open_air()
    room = RoomStructure(0.0, 5.5, 0.0, (), place.floor_map, place.floor_top, place.floor_map.raised(5.5))
    assert with_crowns([tall], tree(), room) == [tall]


def test_a_crown_stops_at_a_thing_of_its_own():
    seen = FittedBox((0, 0, 1.6), (1.0, 1.0, 3.2), 0.0, np.zeros(0, np.intp))
    kiosk = FittedBox((1.2, 0, 2.5), (1.0, 3.0, 5.2), 0.0, np.zeros(0, np.intp))
    grown = with_crowns([seen, kiosk], tree(), open_air())[0]
    assert grown.centre[0] + grown.size[0] / 2 < 0.75


def test_a_piece_of_a_larger_thing_goes_on_beyond_its_ends_and_a_thing_of_its_own_does_not():
    x, y = (a.ravel() for a in np.meshgrid(np.arange(-1, 1, 0.03), np.arange(-0.3, 0.3, 0.03)))
    points = np.column_stack([x, y, np.full(len(x), 0.7)]).astype(np.float32)  # a table's top, 2 m long
    colours, building = np.zeros((len(points), 3), np.float32), np.zeros(len(points), bool)
    seen = Detections(5, 1.5, np.array([40, 60]))

    def measured(length: float) -> np.ndarray:
        members = np.flatnonzero(np.abs(points[:, 0]) < length / 2)
        box = FittedBox((0, 0, 0.69), (length, 0.62, 0.06), 0.0, members)
        return surroundings(box, seen, [], np.arange(len(points)), points, colours, building)

    whole, piece = measured(2.02), measured(0.8)
    assert whole.shape == (FEATURES,)
    assert np.isfinite(piece).all()
    assert not whole[:18].any()
    assert piece[0] > 0.5 and piece[3] > 0.5
