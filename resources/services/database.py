"""The one SQLite file in which all processes of a store share what they spent and how fast they may go."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SCHEMA = """
CREATE TABLE IF NOT EXISTS calls (
    id TEXT PRIMARY KEY,             -- of a world: its request key, so that it is booked once however often it is asked
    at REAL NOT NULL,                -- seconds since the epoch, UTC
    scene TEXT NOT NULL,
    asset TEXT NOT NULL,
    service TEXT NOT NULL,
    model TEXT NOT NULL,
    state TEXT NOT NULL,             -- sent | settled | free
    worst_usd REAL NOT NULL,         -- counts until the call is settled
    usd REAL NOT NULL DEFAULT 0,
    input_tokens INTEGER NOT NULL DEFAULT 0,
    cached_tokens INTEGER NOT NULL DEFAULT 0,
    output_tokens INTEGER NOT NULL DEFAULT 0,
    images INTEGER NOT NULL DEFAULT 0,
    credits INTEGER NOT NULL DEFAULT 0,
    prices_of TEXT NOT NULL,         -- date of the price table
    seconds REAL NOT NULL DEFAULT 0
);
CREATE INDEX IF NOT EXISTS calls_by_scene ON calls (scene, asset);
CREATE INDEX IF NOT EXISTS calls_by_time ON calls (at);
CREATE TABLE IF NOT EXISTS starts (service TEXT NOT NULL, at REAL NOT NULL);
CREATE INDEX IF NOT EXISTS starts_by_service ON starts (service, at);
CREATE TABLE IF NOT EXISTS in_flight (
    id TEXT PRIMARY KEY, service TEXT NOT NULL, process TEXT NOT NULL, until REAL NOT NULL
);
CREATE TABLE IF NOT EXISTS health (service TEXT PRIMARY KEY, failures INTEGER NOT NULL, closed_until REAL NOT NULL);
"""


class Database:
    """Opened for each transaction: nothing is shared between threads or survives a fork."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.path = folder / "services.sqlite"
        self._is_ready = False

    def _ready(self) -> None:
        """The file is made when it is first needed: whoever only wants to know what there is leaves no trace."""
        if self._is_ready:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        connection = sqlite3.connect(self.path, timeout=60)
        try:
            connection.executescript(SCHEMA)
        finally:
            connection.close()
        self._is_ready = True

    @contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """A write transaction of its own, durable when it ends (synchronous=FULL)."""
        self._ready()
        connection = sqlite3.connect(self.path, timeout=60, isolation_level=None)
        try:
            connection.row_factory = sqlite3.Row
            connection.execute("PRAGMA synchronous=FULL")
            connection.execute("BEGIN IMMEDIATE")
            yield connection
            connection.execute("COMMIT")
        except BaseException:
            if connection.in_transaction:
                connection.execute("ROLLBACK")
            raise
        finally:
            connection.close()

    @contextmanager
    def reading(self) -> Iterator[sqlite3.Connection]:
        """For queries."""
        self._ready()
        connection = sqlite3.connect(self.path, timeout=60)
        try:
            connection.row_factory = sqlite3.Row
            yield connection
        finally:
            connection.close()
