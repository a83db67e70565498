"""The pace: all processes of a store together are as fast as a service allows and leave it alone if it is down."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

import pytest

from flymirage_core.errors import TransientServiceError
from flymirage_core.service_settings import PaceSettings
from resources.services.database import Database
from resources.services.pace import Pace


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def pace(folder: Path, clock: Clock, **settings: float) -> Pace:
    return Pace(Database(folder), "marble", PaceSettings(**settings), clock, clock.sleep)


def test_starts_in_a_minute_are_counted_over_everybody(tmp_path) -> None:
    clock = Clock()
    one, other = (pace(tmp_path, clock, starts_per_minute=3) for _ in range(2))
    for mine in (one, other, one):
        with mine.turn():
            pass
    assert clock.now == 1000.0
    with other.turn():
        assert 1060.0 <= clock.now < 1067.0


def test_a_pause_that_the_service_asks_for_holds_for_everybody(tmp_path) -> None:
    clock = Clock()
    pace(tmp_path, clock).hold(34.0)
    with pace(tmp_path, clock).turn():
        assert 1034.0 <= clock.now < 1038.0


def test_a_service_that_fails_again_and_again_is_left_alone_and_then_probed(tmp_path) -> None:
    clock = Clock()
    mine = pace(tmp_path, clock, breaker_failures=3, breaker_seconds=60.0)
    for _ in range(3):
        mine.failed()
    with pytest.raises(TransientServiceError, match="counts as down after 3 failures") as caught, mine.turn():
        pass
    assert caught.value.retry_after == pytest.approx(60.0)
    clock.now += 61.0
    with mine.turn():  # the probe
        pass
    with pytest.raises(TransientServiceError), pace(tmp_path, clock, breaker_failures=3).turn():
        pass  # the others wait for its outcome
    mine.succeeded()
    with pace(tmp_path, clock, breaker_failures=3).turn():
        pass


def _hold_a_turn(folder: Path) -> None:
    with Pace(Database(folder), "marble", PaceSettings(at_once=1)).turn():
        time.sleep(60)


def test_a_killed_process_gives_its_turn_back(tmp_path) -> None:
    process = multiprocessing.get_context("spawn").Process(target=_hold_a_turn, args=(tmp_path,))
    process.start()
    database = Database(tmp_path)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        with database.reading() as connection:
            if connection.execute("SELECT COUNT(*) FROM in_flight").fetchone()[0]:
                break
        time.sleep(0.05)
    assert process.pid is not None
    os.kill(process.pid, signal.SIGKILL)
    process.join(10)
    started = time.monotonic()
    with Pace(database, "marble", PaceSettings(at_once=1)).turn():
        assert time.monotonic() - started < 5


def test_only_so_many_are_in_flight_at_once(tmp_path) -> None:
    clock = Clock()
    first, second = (pace(tmp_path, clock, at_once=1) for _ in range(2))
    waited: list[float] = []

    def sleep(seconds: float) -> None:
        waited.append(seconds)
        if len(waited) == 3:
            turn.__exit__(None, None, None)

    second.sleep = sleep
    turn = first.turn()
    turn.__enter__()
    with second.turn():
        assert len(waited) == 3
