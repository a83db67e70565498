from dataclasses import replace
from functools import reduce

import numpy as np
import pytest
from flight_worlds import empty_room, fill, furnished_room, put, thing

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.errors import PlanningError
from flymirage_core.navigation.flight_space import keep_clear
from flymirage_core.navigation.target_checks import TaskSpace, check_target, is_sensible_target, target_points
from flymirage_core.navigation.task_sets import TaskSets, generate_task_sets
from flymirage_core.occupancy.queries import sphere_is_clear
from flymirage_core.occupancy.search import reachable
from flymirage_core.settings import TaskSettings

SETTINGS = TaskSettings(sets=4, targets_per_set=3)
DRONE = np.array([1.0, 2.0, 1.2])
CABINET = thing(7, (5.6, 2.0, 1.0), (0.8, 1.0, 2.0))


def space_of(grid):
    passable = keep_clear(grid, SETTINGS.passage_radius)
    return TaskSpace(grid, passable, reachable(passable, DRONE))


def room():
    return put(empty_room(6, 4, 2.6), CABINET)


def check(grid, box=CABINET, drone=DRONE, settings=SETTINGS):
    return check_target(box, drone, space_of(grid), settings)


def test_a_good_target_gets_a_point_in_front_of_it_towards_the_drone():
    point = check(room())
    np.testing.assert_allclose(point, [5.2 - SETTINGS.stand_off_per_size * 2.0, 2.0, 1.0], atol=0.02)


def test_a_target_without_room_to_see_all_of_it_is_approached_more_closely():
    shelf = fill(room(), (3.4, 2.3, 0.0), (3.8, 2.4, 2.6))  # beside the point that sees all of the cabinet
    point = check(shelf)
    assert 4.0 - 0.02 <= point[0] <= 5.2 - SETTINGS.stand_off


def test_a_target_whose_box_the_drone_is_in_is_rejected():
    assert check(empty_room(6, 4, 2.6), thing(1, (1.0, 2.0, 1.0), (1, 1, 2))) == "inside_box"


def test_a_target_behind_a_wall_is_rejected():
    wall = fill(room(), (3.0, 1.0, 0.0), (3.1, 3.0, 2.6))  # one could fly round it
    assert check(wall) == "occluded"


def test_something_beside_the_ray_hides_the_target_only_within_the_cylinder():
    near = fill(room(), (3.0, 2.0, 1.0), (3.1, 2.2, 1.3))
    far = fill(room(), (3.0, 2.3, 1.0), (3.1, 2.5, 1.3))
    assert check(near) == "occluded"
    assert not isinstance(check(far), str)


def test_the_objects_own_matter_and_what_is_behind_it_do_not_hide_it():
    assert not isinstance(check(fill(room(), (5.9, 0.0, 0.0), (6.0, 4.0, 2.6))), str)


def test_a_target_point_with_matter_near_it_is_rejected():
    beam = fill(room(), (3.4, 2.3, 0.0), (4.6, 2.4, 2.6))  # beside the target points, off the ray
    assert check(beam) == "unsafe_waypoint"


def test_a_target_point_that_cannot_be_reached_is_rejected():
    window = fill(room(), (3.0, 0.0, 0.0), (3.1, 4.0, 2.6))
    window.state[30, 17:23, 8:14] = 0  # one sees through it, but does not fit
    assert check(window) == "unsafe_waypoint"


@pytest.mark.parametrize(("start", "settings"), [((3.0, 2.0, 1.2), SETTINGS), (DRONE, TaskSettings(max_distance=2.2))])
def test_a_target_nearer_or_farther_than_the_limits_is_rejected(start, settings):
    assert check(room(), drone=np.array(start), settings=settings) == "distance"


def test_the_distance_is_that_of_the_way_and_not_of_the_line():
    barred = room()
    fill(barred, (3.0, 0.0, 0.0), (3.1, 4.0, 0.9))
    fill(barred, (3.0, 0.0, 1.4), (3.1, 4.0, 2.6))  # a slit to look through ...
    barred.state[30, 33:, :] = 0  # ... and a door at the side
    point = check(barred)
    line = np.linalg.norm(point - DRONE)
    assert check(barred, settings=TaskSettings(max_distance=line + 0.2)) == "distance"


def test_a_low_object_is_looked_at_from_as_low_as_is_safe():
    box = thing(2, (5.5, 2.0, 0.3), (0.4, 0.4, 0.4))
    floor = fill(empty_room(6, 4, 2.6), (0, 0, 0), (6, 4, 0.1))
    point = check(put(floor, box), box)
    assert 0.1 + SETTINGS.safety_radius <= point[2] < 0.6


def test_there_is_no_target_point_right_above_an_object():
    assert target_points(CABINET, np.array([5.6, 2.0, 2.5]), SETTINGS, room()) == []


def test_walls_and_nameless_things_are_no_targets():
    assert is_sensible_target(CABINET)
    assert not is_sensible_target(thing(1, (0, 0, 1), (6.0, 0.2, 2.6)))
    assert not is_sensible_target(replace(CABINET, label=""))


@pytest.mark.parametrize(
    ("size", "sensible"), [((0.5, 0.5, 0.5), True), ((0.1, 0.1, 1.5), False), ((0.2, 2.2, 2.4), False)]
)
def test_of_unnamed_things_slivers_and_panels_are_no_targets(size, sensible):
    assert is_sensible_target(replace(CABINET, label="object", size=size)) == sensible


@pytest.fixture(scope="module")
def task_sets():
    grid, boxes = furnished_room()
    return generate_task_sets(grid, boxes, (4.0, 3.0, 1.4), SETTINGS, np.random.default_rng(5))


def test_as_many_sets_of_as_many_targets_as_asked_are_made(task_sets):
    assert [(t.set_index, t.leg_index) for t in task_sets] == [(s, k) for s in range(4) for k in range(3)]


def test_each_leg_starts_where_the_last_one_of_its_set_ended(task_sets):
    for before, after in zip(task_sets.tasks[:-1], task_sets.tasks[1:], strict=True):
        if before.set_index == after.set_index:
            assert after.start == before.target_point
            assert after.object_id != before.object_id


def test_set_0_starts_at_c_and_all_points_are_safe(task_sets):
    grid, _ = furnished_room()
    assert task_sets.tasks[0].start == (4.0, 3.0, 1.4)
    for task in task_sets:
        assert sphere_is_clear(grid, task.start, SETTINGS.safety_radius)
        assert sphere_is_clear(grid, task.target_point, SETTINGS.safety_radius)
        assert np.linalg.norm(np.subtract(task.target_point, task.start)) >= SETTINGS.min_distance - 1e-9


def test_objects_are_used_evenly():
    grid, boxes = furnished_room()
    tasks = generate_task_sets(grid, boxes, (4.0, 3.0, 1.4), TaskSettings(sets=12), np.random.default_rng(0))
    counts = np.unique([t.object_id for t in tasks], return_counts=True)[1]
    assert len(counts) == len(boxes)
    assert counts.max() <= 2 * counts.min()


def test_the_same_generator_gives_the_same_tasks_and_they_survive_storing(task_sets, tmp_path):
    grid, boxes = furnished_room()
    again = generate_task_sets(grid, boxes, (4.0, 3.0, 1.4), SETTINGS, np.random.default_rng(5))
    assert again == task_sets
    task_sets.save(tmp_path)
    assert TaskSets.load(tmp_path) == task_sets


def test_rejections_are_counted_by_reason(task_sets):
    assert set(task_sets.rejections) == {"inside_box", "occluded", "unsafe_waypoint", "distance"}
    assert task_sets.rejections["distance"] > 0


def test_a_set_without_any_valid_target_is_given_up():
    none = generate_task_sets(room(), BoxMap(()), DRONE, SETTINGS, np.random.default_rng(0))
    assert len(none) == 0
    lonely = generate_task_sets(room(), BoxMap((CABINET,)), DRONE, SETTINGS, np.random.default_rng(0))
    assert {t.leg_index for t in lonely} == {0}  # nothing but the same object would follow


def test_an_object_from_which_nothing_else_is_seen_is_only_ever_a_sets_last():
    corridor = fill(fill(empty_room(10, 6, 2.6), (6.0, 2.1, 0.0), (10.0, 2.2, 2.6)), (6.0, 4.0, 0.0), (10.0, 4.1, 2.6))
    at_its_end = thing(0, (9.6, 3.1, 1.2), (0.3, 0.3, 0.3))
    others = [thing(n, (x, y, 1.2), (0.3, 0.3, 0.3)) for n, (x, y) in enumerate([(3, 0.6), (3, 5.4), (5.4, 0.6)], 1)]
    grid, boxes = reduce(put, (at_its_end, *others), corridor), BoxMap((at_its_end, *others))
    tasks = generate_task_sets(grid, boxes, (2.0, 3.1, 1.2), TaskSettings(sets=6), np.random.default_rng(0))
    assert len(tasks) == 6 * TaskSettings().targets_per_set
    assert {t.leg_index for t in tasks if t.object_id == 0} == {TaskSettings().targets_per_set - 1}


def test_a_centre_without_room_for_the_drone_is_an_error():
    with pytest.raises(PlanningError, match="no free space within 1 m"):
        generate_task_sets(empty_room(3, 3, 0.5), BoxMap(()), (1, 1, 0.2), SETTINGS, np.random.default_rng(0))


def test_of_objects_that_served_equally_often_near_ones_tend_to_come_first():
    things = BoxMap(tuple(thing(i, (1.5 + 9.0 * (i % 2), 3.0, 1.0), (0.3, 0.3, 0.3)) for i in range(40)))
    first = [
        generate_task_sets(
            empty_room(12, 6, 2.6), things, (4.0, 3.0, 1.4), TaskSettings(sets=1, min_distance=0.1), seed
        ).tasks[0]
        for seed in map(np.random.default_rng, range(60))
    ]
    assert sum(task.object_id % 2 == 0 for task in first) > 33
