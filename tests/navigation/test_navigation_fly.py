from dataclasses import fields

import numpy as np
import pytest
from flight_worlds import fill, furnished_room
from scipy.spatial.transform import Rotation

from flymirage_core.navigation.fly import fly_task_sets
from flymirage_core.navigation.task_sets import Task, TaskSets, generate_task_sets
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.settings import PlannerSettings, QuadrotorSettings, TaskSettings

SETTINGS = PlannerSettings()
QUADROTOR = QuadrotorSettings()
CENTRE = (4.0, 3.0, 1.4)


def fly(tasks, world=None, seed=1, quadrotor=QUADROTOR):
    grid, boxes = furnished_room() if world is None else world
    return fly_task_sets(tasks, grid, boxes, SETTINGS, quadrotor, np.random.default_rng(seed))


@pytest.fixture(scope="module")
def tasks():
    grid, boxes = furnished_room()
    return generate_task_sets(grid, boxes, CENTRE, TaskSettings(sets=4, targets_per_set=4), np.random.default_rng(3))


@pytest.fixture(scope="module")
def flights(tasks):
    return fly(tasks)


def test_every_task_is_flown_to_its_target_point(tasks, flights):
    assert flights.rejected == ()
    assert [f.flight_id for f in flights] == list(range(len(tasks)))
    for task, flight in zip(tasks, flights, strict=True):
        assert (flight.set_index, flight.leg_index, flight.object_id) == (
            task.set_index,
            task.leg_index,
            task.object_id,
        )
        np.testing.assert_allclose(flight.positions[0], task.start, atol=1e-6)
        np.testing.assert_allclose(flight.positions[-1], task.target_point, atol=1e-6)


def test_legs_of_a_set_join_in_position_and_attitude(flights):
    for before, after in zip(flights.flights[:-1], flights.flights[1:], strict=True):
        if before.set_index == after.set_index:
            np.testing.assert_allclose(after.positions[0], before.positions[-1], atol=1e-9)
            turn = Rotation.from_quat(before.quaternions[-1]).inv() * Rotation.from_quat(after.quaternions[0])
            assert turn.magnitude() < 1e-6


def test_states_are_even_in_time_and_each_is_what_its_derivative_says(flights):
    for flight in flights:
        dt = 1 / SETTINGS.state_rate
        np.testing.assert_allclose(np.diff(flight.times), dt, atol=1e-9)
        for value, slope, bound in (
            (flight.positions, flight.velocities, SETTINGS.max_jerk * dt**3),
            (flight.velocities, flight.accelerations, SETTINGS.max_jerk * dt**2),
        ):
            gap = np.diff(value, axis=0) - (slope[1:] + slope[:-1]) / 2 * dt
            assert np.linalg.norm(gap, axis=1).max() <= bound
        turned = (
            Rotation.from_quat(flight.quaternions[:-1]).inv() * Rotation.from_quat(flight.quaternions[1:])
        ).magnitude()
        assert turned.max() / dt < flight.report.max_body_rate * 1.1 + 0.05


def test_reports_keep_the_limits_and_agree_with_the_states(flights):
    for flight in flights:
        report = flight.report
        assert report.max_speed <= SETTINGS.max_speed
        assert report.max_acceleration <= SETTINGS.max_acceleration
        assert report.max_jerk <= SETTINGS.max_jerk
        assert report.max_yaw_rate <= SETTINGS.max_yaw_rate + 1e-9
        assert report.min_clearance >= SETTINGS.inflation
        assert report.min_clearance <= flight.clearances.min()
        assert report.end_error < 0.01
        assert report.duration == pytest.approx(flight.times[-1])
        assert np.linalg.norm(flight.velocities, axis=1).max() <= report.max_speed * 1.001


def test_reports_say_what_the_rotors_do_and_how_well_the_simulated_quadrotor_follows(flights):
    least, most = QUADROTOR.rotor_limits
    for flight in flights:
        report = flight.report
        assert least < report.min_rotor_thrust <= flight.rotor_thrusts.min()
        assert flight.rotor_thrusts.max() <= report.max_rotor_thrust < most
        assert np.linalg.norm(flight.angular_accelerations, axis=1).max() == pytest.approx(
            report.max_angular_acceleration
        )
        assert 0 < report.tracking_position_rms <= QUADROTOR.max_position_rms
        assert 0 < np.degrees(report.tracking_attitude_rms) <= QUADROTOR.max_attitude_rms_deg


def test_the_imu_of_a_flight_gives_its_accelerations(flights):
    for flight in flights:
        world = Rotation.from_quat(flight.quaternions).apply(flight.specific_forces) - [0, 0, 9.81]
        np.testing.assert_allclose(world, flight.accelerations, atol=1e-9)


@pytest.mark.parametrize(
    ("drone", "reason"),
    [
        (QuadrotorSettings(thrust_to_weight=1.05), "not flyable: rotors would give"),
        (QuadrotorSettings(drag=(3.0, 3.0, 3.0)), "strays by"),
        (QuadrotorSettings(max_attitude_rms_deg=0.001), "tilted away"),
    ],
)
def test_flights_that_the_drone_cannot_fly_are_rejected_with_the_reason(tasks, drone, reason):
    flown = fly(tasks, quadrotor=drone)
    assert any(reason in task.reason for task in flown.rejected)
    assert len(flown) + len(flown.rejected) == len(tasks)


def test_flights_end_looking_at_the_centre_of_their_object(flights):
    _, boxes = furnished_room()
    for flight in flights:
        towards = np.array(boxes.by_id(flight.object_id).centre) - flight.positions[-1]
        assert abs(np.angle(np.exp(1j * (flight.yaws[-1] - np.arctan2(towards[1], towards[0]))))) < 0.01
        nose = Rotation.from_quat(flight.quaternions[-1]).apply([1, 0, 0])
        assert np.degrees(np.arccos(nose @ towards / np.linalg.norm(towards))) < 20


def test_a_sets_first_flight_begins_looking_where_it_goes(flights):
    for flight in flights:
        if flight.leg_index == 0:
            assert np.linalg.norm(flight.velocities[5]) > 0  # no turn before it


def test_after_a_rejected_task_the_next_one_starts_where_the_drone_is(tasks):
    first, second, third = tasks.tasks[:3]
    blocked = Task(0, 1, second.object_id, second.start, (0.2, 3.0, 0.5))  # inside of a cabinet
    detour = Task(0, 2, third.object_id, blocked.target_point, third.target_point)
    flown = fly(TaskSets((first, blocked, detour), {}))
    assert [(r.leg_index, r.object_id) for r in flown.rejected] == [(1, second.object_id)]
    assert "is blocked" in flown.rejected[0].reason
    assert [f.leg_index for f in flown] == [0, 2]
    np.testing.assert_allclose(flown.flights[1].positions[0], first.target_point, atol=1e-6)


def test_one_task_changes_no_other_sets_flight(tasks, flights):
    alone = fly(TaskSets(tuple(t for t in tasks if t.set_index == 0), {}))
    for a, b in zip(alone, flights, strict=False):
        assert a.positions.tobytes() == b.positions.tobytes()


def test_a_world_with_no_way_out_rejects_every_task(tasks):
    grid, boxes = furnished_room()
    fill(grid, (0, 0, 0), (8, 6, 2.8))
    flown = fly(tasks, (grid, boxes))
    assert len(flown) == 0
    assert len(flown.rejected) == len(tasks)


def test_the_same_inputs_give_the_same_bytes_and_survive_storing(tasks, flights, tmp_path):
    again = fly(tasks)
    flights.save(tmp_path)
    stored = Trajectories.load(tmp_path)
    for one, other, read in zip(flights, again, stored, strict=True):
        arrays = [f.name for f in fields(Flight) if isinstance(getattr(one, f.name), np.ndarray)]
        assert len(arrays) == 12
        for name in arrays:
            assert getattr(one, name).tobytes() == getattr(other, name).tobytes() == getattr(read, name).tobytes()
        assert one.report == other.report == read.report
