"""Boxes cut and joined by what is thought of the pieces and of the whole; judges stand in for the recogniser."""

import math
from collections.abc import Callable, Sequence
from functools import cache

import pytest
from analytic_room import Body, Room, Thing, block, sweep, views_of

from flymirage_core.annotation.appearance import Observation
from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.evidence import Evidence
from flymirage_core.annotation.fused_points import frames_of
from flymirage_core.annotation.fusion import yaw_iou
from flymirage_core.annotation.regrouping import Belief, Judge, regrouped
from flymirage_core.settings import AnnotationSettings

BLUE, RED, GREY = (40, 70, 150), (150, 40, 40), (70, 70, 75)
EYES = ((0.0, 0.0, 1.4), (0.9, -1.2, 1.2), (-0.9, -0.9, 1.6), (0.0, 1.0, 1.1))
KNOWN, DOUBTFUL = Belief("bench", 0.8, 0.05), Belief("bin", 0.1, 0.6)


@cache
def evidence_of(*things: Thing) -> Evidence:
    room = Room((5, 4.4, 2.6), things)
    views = [view for eye in EYES for view in views_of(room, sweep(eye, yaws=6, pitches=(-35, 5), width=240))]
    return EmbeddedAnnotator(AnnotationSettings()).evidence(frames_of(views), math.inf)


def who_knows(wanted: Callable[[FittedBox], bool], other: Belief = DOUBTFUL) -> Judge:
    """A judge who knows some boxes by name, and thinks the same of all others."""

    def judge(observed: Sequence[tuple[Observation, Detections] | None]) -> list[Belief]:
        return [KNOWN if pair is not None and wanted(pair[0].box) else other for pair in observed]

    return judge


def best(thing: Thing, boxes: Sequence[FittedBox]) -> float:
    return max(yaw_iou(thing.box, box) for box in boxes)


def two_coloured() -> Thing:
    halves = Body((-0.4, 0, 0.4), (0.8, 0.5, 0.8), BLUE), Body((0.4, 0, 0.4), (0.8, 0.5, 0.8), RED)
    return Thing("car", (0.4, 0.6, 0), 0.0, halves)


def bench_and_locker() -> tuple[Thing, Thing]:
    """Of one colour, and without a gap."""
    return block("bench", (0.2, 0.8, 0), (1.2, 0.4, 0.45), GREY), block("locker", (1.05, 0.8, 0), (0.5, 0.4, 1.2), GREY)


def test_halves_of_two_colours_are_one_thing_if_the_whole_is_known():
    car = two_coloured()
    apart = regrouped(evidence_of(car), who_knows(lambda box: False))
    whole = regrouped(evidence_of(car), who_knows(lambda box: max(box.size) > 1.2))
    assert len(apart) == 2 and best(car, apart) < 0.6
    assert len(whole) == 1 and best(car, whole) > 0.8


def test_a_whole_that_is_no_better_known_than_its_halves_stays_apart():
    assert len(regrouped(evidence_of(two_coloured()), who_knows(lambda box: True))) == 2


def test_two_things_of_one_colour_are_cut_where_the_outline_changes_if_one_is_known():
    bench, locker = bench_and_locker()
    together = regrouped(evidence_of(bench, locker), who_knows(lambda box: False))
    apart = regrouped(
        evidence_of(bench, locker), who_knows(lambda box: box.size[2] < 0.6 and 0.9 < max(box.size) < 1.4)
    )
    assert len(together) == 1
    assert best(bench, apart) > 0.7 and best(locker, apart) > 0.6


@pytest.mark.parametrize("belief", [Belief("bench", 0.75, 0.5), Belief("bench", 0.3, 0.19)])
def test_what_is_well_known_or_hardly_a_left_over_is_not_cut(belief):
    things = bench_and_locker()
    low = who_knows(lambda box: box.size[2] < 0.6, belief)
    assert len(regrouped(evidence_of(*things), low)) == 1


def test_a_thing_on_another_is_not_joined_to_it_but_a_left_over_there_is():
    chest, radio = (
        block("chest", (0.6, 0.8, 0), (0.9, 0.6, 0.8), BLUE),
        block("radio", (0.6, 0.8, 0.8), (0.4, 0.3, 0.4), RED),
    )

    def tall(box: FittedBox) -> bool:
        return box.size[2] > 1.0

    things = regrouped(evidence_of(chest, radio), who_knows(tall, Belief("box", 0.3, 0.2)))
    pieces = regrouped(evidence_of(chest, radio), who_knows(tall, Belief("box", 0.3, 0.6)))
    assert len(things) == 2 and best(radio, things) > 0.5
    assert len(pieces) == 1
