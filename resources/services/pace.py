"""The pace: how fast and how often at once a service is asked, by all processes of a store together.

Starts in the last minute and requests in flight are counted in the shared database. A pause that a service asks for
(Retry-After) holds for everybody; after failures in a row the service counts as down for a while (circuit breaker).
"""

import os
import platform
import random
import sqlite3
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from flymirage_core.errors import TransientServiceError
from flymirage_core.service_settings import PaceSettings
from resources.services.database import Database

MINUTE = 60.0
LEASE = 900.0
"""Seconds after which a request in flight is taken for lost, if nobody knows whether its process lives."""


class Pace:
    """The pace of one service."""

    def __init__(
        self,
        database: Database,
        service: str,
        settings: PaceSettings,
        clock: Callable[[], float] = time.time,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.database, self.service, self.settings, self.clock, self.sleep = database, service, settings, clock, sleep

    @contextmanager
    def turn(self) -> Iterator[None]:
        """Wait for a turn and hold it; raises `TransientServiceError` while the service counts as down."""
        ticket = uuid.uuid4().hex
        while (wait := self._try_start(ticket)) > 0:
            self.sleep(wait * random.uniform(1.0, 1.1))  # jitter: processes that wait do not come back as one
        try:
            yield
        finally:
            with self.database.transaction() as connection:
                connection.execute("DELETE FROM in_flight WHERE id = ?", (ticket,))

    def succeeded(self) -> None:
        """The service answered as it should: it is up."""
        with self.database.transaction() as connection:
            connection.execute("DELETE FROM health WHERE service = ?", (self.service,))

    def failed(self) -> None:
        """The service did not answer, or with a server error; after enough of these in a row it counts as down."""
        with self.database.transaction() as connection:
            connection.execute(
                "INSERT INTO health VALUES (?, 1, 0) ON CONFLICT (service) DO UPDATE SET failures = failures + 1",
                (self.service,),
            )
            connection.execute(
                "UPDATE health SET closed_until = ? WHERE service = ? AND failures >= ?",
                (self.clock() + self.settings.breaker_seconds, self.service, self.settings.breaker_failures),
            )

    def hold(self, seconds: float) -> None:
        """Nobody starts another request to the service for so long."""
        with self.database.transaction() as connection:
            connection.execute(
                "INSERT INTO in_flight VALUES (?, ?, '', ?)",
                (f"hold {uuid.uuid4().hex}", self.service, self.clock() + seconds),
            )

    def _try_start(self, ticket: str) -> float:
        """0 if the turn is taken, else seconds to wait before asking again."""
        now = self.clock()
        with self.database.transaction() as connection:
            self._check_health(connection, now)
            self._sweep(connection, now)
            held = connection.execute(
                "SELECT MAX(until) FROM in_flight WHERE service = ? AND process = ''", (self.service,)
            ).fetchone()[0]
            if held is not None:
                return max(float(held) - now, 0.01)
            flying = connection.execute(
                "SELECT COUNT(*) FROM in_flight WHERE service = ? AND process != ''", (self.service,)
            ).fetchone()[0]
            if flying >= self.settings.at_once:
                return 0.1
            oldest = connection.execute(
                "SELECT at FROM starts WHERE service = ? ORDER BY at DESC LIMIT 1 OFFSET ?",
                (self.service, self.settings.starts_per_minute - 1),
            ).fetchone()
            if oldest is not None and oldest[0] + MINUTE > now:
                return float(oldest[0]) + MINUTE - now
            connection.execute("INSERT INTO starts VALUES (?, ?)", (self.service, now))
            connection.execute(
                "INSERT INTO in_flight VALUES (?, ?, ?, ?)", (ticket, self.service, _process(), now + LEASE)
            )
        return 0.0

    def _check_health(self, connection: sqlite3.Connection, now: float) -> None:
        row = connection.execute("SELECT * FROM health WHERE service = ?", (self.service,)).fetchone()
        if row is None or row["failures"] < self.settings.breaker_failures:
            return
        if row["closed_until"] > now:
            wait = row["closed_until"] - now
            raise TransientServiceError(
                f"{self.service} counts as down after {row['failures']} failures in a row; it is asked again in "
                f"{wait:.0f} s: run the command again then",
                retry_after=wait,
            )
        connection.execute(  # this request probes; the others keep waiting for its outcome
            "UPDATE health SET closed_until = ? WHERE service = ?", (now + self.settings.breaker_seconds, self.service)
        )

    def _sweep(self, connection: sqlite3.Connection, now: float) -> None:
        """Forget old starts, pauses that are over, and requests of processes that are gone."""
        connection.execute("DELETE FROM starts WHERE at < ?", (now - MINUTE,))
        connection.execute("DELETE FROM in_flight WHERE until < ?", (now,))
        rows = connection.execute("SELECT DISTINCT process FROM in_flight WHERE process != ''").fetchall()
        for (process,) in rows:
            if not _is_alive(process):
                connection.execute("DELETE FROM in_flight WHERE process = ?", (process,))


def _process() -> str:
    """This process, as ``host:pid:start``: a number that comes again does not confuse."""
    return f"{platform.node()}:{os.getpid()}:{_started(os.getpid())}"


def _is_alive(process: str) -> bool:
    host, pid, started = process.rsplit(":", 2)
    if host != platform.node() or not Path("/proc").exists():
        return True  # nobody here knows: the lease decides
    return _started(int(pid)) == started


def _started(pid: int) -> str:
    """Start time of a process in the kernel's ticks, "" if it is gone or nobody says."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[19]
    except OSError:
        return ""
