"""The ledger: every call that may cost something is booked at its worst price before it is made, and settled after.

A booking that was never settled (a killed process, a lost answer) keeps counting at its worst: caps hold in any case.
"""

import sqlite3
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from flymirage_core.errors import BudgetError, SceneBudgetError
from flymirage_core.service_settings import BudgetSettings
from resources.services.database import Database

COUNTED = "CASE state WHEN 'sent' THEN worst_usd ELSE usd END"
"""What a call counts for in sums: its price once that is known."""


@dataclass(frozen=True)
class Usage:
    """What one call used, and what that costs."""

    usd: float = 0.0
    input_tokens: int = 0
    cached_tokens: int = 0
    output_tokens: int = 0
    images: int = 0
    credits: int = 0


@dataclass(frozen=True)
class Call:
    """A call about to be made."""

    id: str
    scene: str
    asset: str
    service: str
    model: str
    worst_usd: float
    prices_of: str


@dataclass(frozen=True)
class Spent:
    """Sums over calls. ``unsettled_usd`` is the part of ``usd`` that is only a worst case."""

    calls: int
    usd: float
    unsettled: int
    unsettled_usd: float
    input_tokens: int
    cached_tokens: int
    output_tokens: int
    images: int
    credits: int


@dataclass(frozen=True)
class Line:
    """Sums of one scene at one service and model."""

    scene: str
    service: str
    model: str
    prices_of: str
    spent: Spent


class Ledger:
    """Books calls, refuses those that could break a cap, and adds up. Safe for several processes."""

    def __init__(self, database: Database, budget: BudgetSettings, clock: Callable[[], float] = time.time) -> None:
        self.database, self.budget, self.clock = database, budget, clock

    def book(self, call: Call) -> None:
        """Book ``call`` at its worst; raises `SceneBudgetError` or `BudgetError` if a cap could break.

        A call that is booked already is not booked twice.
        """
        now = self.clock()
        with self.database.transaction() as connection:
            if connection.execute("SELECT 1 FROM calls WHERE id = ? AND state = 'sent'", (call.id,)).fetchone():
                return
            self._check_caps(connection, call, now)
            connection.execute(
                "INSERT OR REPLACE INTO calls (id, at, scene, asset, service, model, state, worst_usd, prices_of) "
                "VALUES (?, ?, ?, ?, ?, ?, 'sent', ?, ?)",
                (call.id, now, call.scene, call.asset, call.service, call.model, call.worst_usd, call.prices_of),
            )

    def settle(self, call_id: str, usage: Usage) -> None:
        """The call was answered: this is what it cost. Settling it again changes nothing."""
        with self.database.transaction() as connection:
            connection.execute(
                "UPDATE calls SET state = 'settled', usd = ?, input_tokens = ?, cached_tokens = ?, output_tokens = ?, "
                "images = ?, credits = ?, seconds = ? - at WHERE id = ? AND state = 'sent'",
                (
                    usage.usd,
                    usage.input_tokens,
                    usage.cached_tokens,
                    usage.output_tokens,
                    usage.images,
                    usage.credits,
                    self.clock(),
                    call_id,
                ),
            )

    def release(self, call_id: str) -> None:
        """The call certainly cost nothing: it never left, or was refused."""
        with self.database.transaction() as connection:
            connection.execute("UPDATE calls SET state = 'free' WHERE id = ?", (call_id,))

    def unsettled(self, service: str) -> int:
        """How many calls of a service are booked at their worst: in flight, or lost."""
        with self.database.reading() as connection:
            query = "SELECT COUNT(*) FROM calls WHERE service = ? AND state = 'sent'"
            return int(connection.execute(query, (service,)).fetchone()[0])

    def others_since(self, service: str, call_id: str, since: float) -> int:
        """How many other calls of a service cost, or may cost, something since a time."""
        with self.database.reading() as connection:
            query = "SELECT COUNT(*) FROM calls WHERE service = ? AND id != ? AND state != 'free' AND at + seconds >= ?"
            return int(connection.execute(query, (service, call_id, since)).fetchone()[0])

    def spent(self, scene: str = "", asset: str = "", since: float = 0.0) -> Spent:
        """Sums; of one scene, of one asset of it, or since a time (seconds since the epoch)."""
        with self.database.reading() as connection:
            row = connection.execute(f"SELECT {_SUMS} FROM calls WHERE {_WHERE}", (scene, scene, asset, asset, since))
            return _spent(row.fetchone())

    def lines(self, since: float = 0.0) -> list[Line]:
        """One for each scene, service, model and price date, in this order."""
        with self.database.reading() as connection:
            rows = connection.execute(
                f"SELECT scene, service, model, prices_of, {_SUMS} FROM calls WHERE at >= ? AND state != 'free' "
                "GROUP BY scene, service, model, prices_of ORDER BY scene, service, model, prices_of",
                (since,),
            ).fetchall()
        return [Line(r["scene"], r["service"], r["model"], r["prices_of"], _spent(r)) for r in rows]

    def night_start(self) -> float:
        """The last noon, UTC."""
        now = datetime.fromtimestamp(self.clock(), UTC)
        noon = now.replace(hour=12, minute=0, second=0, microsecond=0)
        return (noon if now >= noon else noon - timedelta(days=1)).timestamp()

    def month_start(self) -> float:
        """The calendar month's first instant, UTC."""
        now = datetime.fromtimestamp(self.clock(), UTC)
        return now.replace(day=1, hour=0, minute=0, second=0, microsecond=0).timestamp()

    def _check_caps(self, connection: sqlite3.Connection, call: Call, now: float) -> None:
        def sum_where(condition: str, value: float | str) -> float:
            query = f"SELECT COALESCE(SUM({COUNTED}), 0) FROM calls WHERE state != 'free' AND {condition}"
            return float(connection.execute(query, (value,)).fetchone()[0])

        budget = self.budget
        caps = (
            ("scene_usd", f"scene {call.scene!r}", budget.scene_usd, sum_where("scene = ?", call.scene)),
            ("night_usd", "this night", budget.night_usd, sum_where("at >= ?", self.night_start())),
            ("month_usd", "this month", budget.month_usd, sum_where("at >= ?", self.month_start())),
        )
        for name, what, cap, so_far in caps:
            if so_far + call.worst_usd > cap + 1e-9:
                kind = SceneBudgetError if name == "scene_usd" else BudgetError
                raise kind(
                    f"a call of {call.model} for {call.asset} of scene {call.scene!r} may cost ${call.worst_usd:.2f}; "
                    f"with ${so_far:.2f} already spent on {what} that could exceed the cap services.budget.{name} = "
                    f"${cap:.2f}: nothing was sent; raise the cap if you want it (`flymirage costs` shows the ledger)"
                )


_SUMS = (
    f"SUM(state != 'free') AS calls, COALESCE(SUM({COUNTED}), 0) AS usd, SUM(state = 'sent') AS unsettled, "
    "COALESCE(SUM(CASE state WHEN 'sent' THEN worst_usd END), 0) AS unsettled_usd, SUM(input_tokens) AS input_tokens, "
    "SUM(cached_tokens) AS cached_tokens, SUM(output_tokens) AS output_tokens, SUM(images) AS images, "
    "SUM(credits) AS credits"
)
_WHERE = "(? = '' OR scene = ?) AND (? = '' OR asset = ?) AND at >= ?"


def _spent(row: sqlite3.Row) -> Spent:
    numbers = {name: row[name] or 0 for name in Spent.__dataclass_fields__}
    return Spent(**{**numbers, "usd": round(numbers["usd"], 6), "unsettled_usd": round(numbers["unsettled_usd"], 6)})
