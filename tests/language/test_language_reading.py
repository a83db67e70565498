"""Reading instructions back: any writer's text, against the boxes and from the drone's start."""

from dataclasses import replace

import numpy as np
import pytest
from filmed_room import box
from hypothesis import given, settings
from hypothesis import strategies as st

from flymirage_core.language.reading import Outcome, read_back, read_itinerary
from flymirage_core.language.referring import expressions, unique_landmarks
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import StartPose
from flymirage_core.language.wording import Speaker, drawn

SOFA, RED_CHAIR, BLUE_CHAIR, TABLE, VASE, UNNAMED, SHELF = range(7)
ROOM = (
    box(SOFA, "sofa", (3.0, 2.0, 0.4), (2.0, 0.9, 0.8), "green"),
    box(RED_CHAIR, "chair", (3.0, -2.0, 0.45), (0.5, 0.5, 0.9), "red"),
    box(BLUE_CHAIR, "chair", (5.0, -2.2, 0.45), (0.5, 0.5, 0.9), "blue"),
    box(TABLE, "coffee table", (3.0, 0.6, 0.2), (1.0, 0.6, 0.4), "brown"),
    box(VASE, "vase", (3.0, 0.6, 0.55), (0.2, 0.2, 0.3), "white"),
    box(UNNAMED, "object", (-3.0, 0.0, 1.0), (0.4, 0.4, 2.0), "grey"),
    box(SHELF, "bookshelf", (6.0, 1.0, 1.0), (1.0, 0.3, 2.0), "brown"),
)
HERE = Resolver(ROOM, StartPose((0.0, 0.0, 1.2), 0.0))  # looks along +x: the sofa is on the left


def outcome(text: str, target: int) -> Outcome:
    return read_back(text, HERE, target).outcome


@pytest.mark.parametrize(
    ("text", "target"),
    [
        ("Fly to the couch.", SOFA),
        ("Navigate to the green sofa on your left.", SOFA),
        ("The drone should fly to the green couch that is next to the coffee table.", SOFA),
        ("Find the blue chair, then stop in front of it.", BLUE_CHAIR),
        ("Go to the farthest chair.", BLUE_CHAIR),
        ("Approach the cosy red armchair to the right of the coffee table", RED_CHAIR),
        ("Fly to the chair nearest to you.", RED_CHAIR),
        ("Go to the second chair from the left.", RED_CHAIR),
        ("Fly to the white vase on top of the wooden coffee table and hover there.", VASE),
        ("There is a vase on the table near the sofa. Fly to it.", VASE),
        ("From the starting point, ascend slightly and fly toward the vase", VASE),
        ("Your goal is the bookshelf. Fly past the coffee table to reach it.", SHELF),
        ("Go to the tall, brown bookcase in the corner of the room.", SHELF),
        ("Could you go to the tall bookshelf standing against the wall?", SHELF),
        ("Fly to the table between the sofa and the red chair.", TABLE),
    ],
)
def test_plain_english_is_read_as_its_target(text: str, target: int) -> None:
    reading = read_back(text, HERE, target)
    assert reading.outcome is Outcome.TARGET and reading.objects == (target,) and reading.reason == ""


@pytest.mark.parametrize(
    ("text", "target"),
    [
        ("Fly to the cardboard box.", 0),
        ("Go to the cardboard box on the floor.", 0),
        ("Find the low dark green bookshelf.", 1),
        ("Go to the second low bookshelf from the left.", 2),
        ("Fly to the white object on the wall.", 3),
        ("Head for the waist-high white object behind you on the left.", 4),
        ("Fly to the white object hanging on the wall ahead of you.", 3),
    ],
)
def test_adjectives_that_are_part_of_a_name_and_places_on_wall_and_floor(text: str, target: int) -> None:
    boxes = (
        replace(box(0, "cardboard box", (3.0, -2.0, 0.2), (0.4, 0.4, 0.4), "brown"), material="paper"),
        box(1, "low bookshelf", (4.0, 2.0, 0.3), (1.4, 0.4, 0.6), "dark green"),
        box(2, "low bookshelf", (4.0, -1.0, 0.4), (1.2, 0.4, 0.8), "red"),
        box(3, "object", (5.0, 0.0, 1.6), (0.05, 0.8, 0.6), "white"),
        box(4, "object", (-2.0, 1.5, 0.5), (0.5, 0.5, 1.0), "white"),
    )
    assert read_back(text, Resolver(boxes, HERE.start), target).outcome is Outcome.TARGET


def test_two_chairs_make_a_chair_ambiguous_and_the_reason_names_both() -> None:
    reading = read_back("Find the chair.", HERE, RED_CHAIR)
    assert reading.outcome is Outcome.AMBIGUOUS and reading.objects == (RED_CHAIR, BLUE_CHAIR)
    assert reading.reason == "the prompt may mean any of: chair 1, chair 2"


def test_a_thing_that_is_not_there_is_named() -> None:
    reading = read_back("Fly to the piano.", HERE, SOFA)
    assert reading.outcome is Outcome.ABSENT and reading.reason == "there is no piano among the objects"


@pytest.mark.parametrize(
    "text",
    [
        "Go to the sofa on your right.",
        "Go to the sofa behind you.",
        "Turn right and fly to the sofa.",
        "Go to the red sofa.",
        "Go to the sofa on the coffee table.",
    ],
)
def test_what_is_not_true_of_the_sofa_is_read_as_nothing(text: str) -> None:
    assert outcome(text, SOFA) is Outcome.ABSENT


def test_a_prompt_of_another_thing_says_which() -> None:
    reading = read_back("Go to the vase.", HERE, SOFA)
    assert reading.outcome is Outcome.OTHER and "means vase 4, not sofa 0" in reading.reason


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "no words"),
        ("Fly on.", "names no thing"),
        ("Zoomify blah.", "'zoomify blah' is not understood"),
        ("Go to the sofa and the vase.", "two goals, the sofa and the vase"),
        ("Go to the sofa in the left corner.", "cannot be checked against the drone's start"),
        ("Go to the second chair.", "does not say from where"),
    ],
)
def test_what_is_outside_the_grammar_is_refused_with_its_words(text: str, why: str) -> None:
    reading = read_back(text, HERE, SOFA)
    assert reading.outcome is Outcome.UNREADABLE and why in reading.reason


def test_what_is_passed_on_the_way_must_be_there() -> None:
    named = Resolver([b for b in ROOM if b.label != "object"], HERE.start)
    assert read_back("Fly past the vase to the sofa.", named, SOFA).outcome is Outcome.TARGET
    reading = read_back("Fly past the piano to the sofa.", named, SOFA)
    assert reading.outcome is Outcome.UNREADABLE and "the piano on the way is not there" in reading.reason


def test_words_that_no_box_confirms_are_reported_and_do_not_single_out() -> None:
    assert read_back("Go to the cosy sofa.", HERE, SOFA).unchecked == ("cosy",)
    assert outcome("Go to the cosy chair.", RED_CHAIR) is Outcome.AMBIGUOUS


def test_a_thing_without_a_name_may_be_called_by_one_that_nothing_else_has() -> None:
    reading = read_back("Go to the grey refrigerator.", HERE, UNNAMED)
    assert reading.outcome is Outcome.TARGET and not reading.certain
    assert outcome("Go to the chair.", UNNAMED) is Outcome.OTHER


def test_what_follows_a_landmark_may_belong_to_either_thing() -> None:
    """ "On your left" could be said of the chair or of the table: only what holds either way is exact."""
    chairs = (
        box(0, "chair", (2.0, 2.0, 0.45), (0.5, 0.5, 0.9)),
        box(1, "chair", (2.0, -2.0, 0.45), (0.5, 0.5, 0.9)),
        box(2, "table", (2.0, 2.8, 0.4), (0.8, 0.8, 0.8)),
        box(3, "table", (2.0, -2.8, 0.4), (0.8, 0.8, 0.8)),
    )
    resolver = Resolver(chairs, StartPose((0.0, 0.0, 1.2), 0.0))
    assert read_back("Go to the chair next to the table on your left.", resolver, 0).outcome is Outcome.TARGET
    assert read_back("Go to the chair next to the table.", resolver, 0).outcome is Outcome.AMBIGUOUS


def test_an_itinerary_is_read_goal_by_goal() -> None:
    text = "First go to the sofa, then find the vase, and finally stop at the blue chair."
    outcomes = [r.outcome for r in read_itinerary(text, HERE, (SOFA, VASE, BLUE_CHAIR))]
    assert outcomes == [Outcome.TARGET] * 3
    assert [r.outcome for r in read_itinerary(text, HERE, (SOFA, VASE))] == [Outcome.UNREADABLE]


rooms = st.lists(
    st.tuples(
        st.sampled_from(
            ["chair", "office chair", "dining table", "lamp", "object", "bookshelf", "books", "hanging plant"]
        ),
        st.tuples(st.floats(-5, 5), st.floats(-5, 5)),
        st.sampled_from(["", "red", "dark red", "green", "white", "light grey"]),
        st.floats(0.2, 2.0),
    ),
    min_size=1,
    max_size=12,
)


@settings(max_examples=25)
@given(rooms, st.floats(-3, 3), st.integers(0, 1000))
def test_every_sentence_the_generator_writes_is_read_as_its_target(things, yaw, seed) -> None:
    boxes = [
        box(i, label, (x, y, h / 2), (0.5, 0.7, h), colour, yaw=0.3 * i)
        for i, (label, (x, y), colour, h) in enumerate(things)
    ]
    resolver = Resolver(boxes, StartPose((0.0, 0.0, 1.2), yaw))
    generator = np.random.default_rng(seed)
    for kind, meaning in expressions(resolver, 0, generator):
        text = Speaker(unique_landmarks(meaning, resolver), drawn(generator)).sentence(kind, meaning)
        assert read_back(text, resolver, 0).outcome is Outcome.TARGET, (text, meaning)
