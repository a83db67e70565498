"""Dagster's SQLite files without a disk sync for each event."""

import sqlite3
from collections import OrderedDict
from typing import Any

from sqlalchemy import event
from sqlalchemy.engine import Engine

OPEN_FILES = 4
"""Runs, the index of events, schedules, and the events of the run that is going on."""
_open: "OrderedDict[str, sqlite3.Connection]" = OrderedDict()


def fewer_syncs() -> None:
    """Set ``synchronous=NORMAL`` on every SQLite connection that this process opens, and keep one to each file open.

    Dagster opens a connection for each event and keeps its files in WAL mode. There NORMAL cannot damage them, and a
    killed process loses nothing. A power cut may lose the last events, which the next run reports again: the store,
    which syncs by itself, is what counts. The connection that stays open keeps the others from folding the WAL back
    into the file (two syncs) each time they close.
    """
    if not event.contains(Engine, "connect", _on_connect):
        event.listen(Engine, "connect", _on_connect)


def _on_connect(connection: Any, _: Any) -> None:
    if not isinstance(connection, sqlite3.Connection):
        return
    connection.execute("PRAGMA synchronous=NORMAL")
    file = connection.execute("PRAGMA database_list").fetchone()[2]
    if not file:  # in memory
        return
    if file not in _open:
        _open[file] = keeper = sqlite3.connect(file, check_same_thread=False)
        keeper.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchone()  # only now does it hold the file
    _open.move_to_end(file)
    while len(_open) > OPEN_FILES:
        _open.popitem(last=False)[1].close()
