"""Dagster's SQLite files without a disk sync for each event."""

import sqlite3
from typing import Any

from sqlalchemy import event
from sqlalchemy.engine import Engine


def fewer_syncs() -> None:
    """Set ``synchronous=NORMAL`` on every SQLite connection that this process opens from now on.

    Dagster keeps its files in WAL mode; there NORMAL cannot damage them, and a killed process loses nothing. A power
    cut may lose the last events, which the next run reports again: the store, which syncs by itself, is what counts.
    """
    if not event.contains(Engine, "connect", _normal):
        event.listen(Engine, "connect", _normal)


def _normal(connection: Any, _: Any) -> None:
    if isinstance(connection, sqlite3.Connection):
        connection.execute("PRAGMA synchronous=NORMAL")
