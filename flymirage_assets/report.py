"""Tables for the terminal: products of a scene, scenes of a store, what the doctor found."""

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.table import Table

from resources.store import Store

if TYPE_CHECKING:  # they take a second to import
    from flymirage_assets.staleness import StaleProduct
    from flymirage_core.occupancy.doctor import DoctorReport

SCENE_PRODUCTS = (
    "description",
    "image",
    "world",
    "orbit_renders",
    "orbit_boxes",
    "targets",
    "exploration_renders",
    "boxes",
    "task_sets",
    "trajectories",
    "frames",
    "quality_verdict",
    "prompts",
)
SEVERITY_STYLE = {"ok": "green", "warning": "yellow", "problem": "red"}


def human_bytes(count: float) -> str:
    """
    >>> human_bytes(1536)
    '1.5 kB'
    """
    for unit in ("B", "kB", "MB", "GB"):
        if count < 1024 or unit == "GB":
            return f"{count:.0f} {unit}" if unit == "B" else f"{count:.1f} {unit}"
        count /= 1024
    raise AssertionError("unreachable")


def products_table(store: Store, scene: str) -> Table:
    """One row a product: what is in it, how long it took, how big it is."""
    table = Table(title=f"scene {scene}", title_justify="left")
    for name, justify in (("product", "left"), ("what is in it", "left"), ("seconds", "right"), ("size", "right")):
        table.add_column(name, justify="right" if justify == "right" else "left")
    seconds, size = 0.0, 0
    for asset in SCENE_PRODUCTS:
        record = store.current(asset, scene)
        if record is None:
            table.add_row(asset, "[dim]not made yet[/dim]", "", "")
            continue
        shown = ", ".join(f"{k.replace('_', ' ')} {v}" for k, v in list(record.summary.items())[:4])
        table.add_row(asset, shown, f"{record.seconds:.1f}", human_bytes(record.bytes))
        seconds, size = seconds + record.seconds, size + record.bytes
    table.add_section()
    table.add_row("all", "", f"{seconds:.1f}", human_bytes(size))
    return table


def scenes_table(store: Store, keys: Sequence[str]) -> Table:
    """One row a scene: how far it is, and what came of it."""
    table = Table()
    for name in ("scene", "title"):
        table.add_column(name, overflow="ellipsis", no_wrap=True, max_width=36)
    for name in ("products", "objects", "flights", "kept", "prompts"):
        table.add_column(name, justify="right")
    for key in keys:
        records = {asset: store.current(asset, key) for asset in SCENE_PRODUCTS}

        def number(asset: str, name: str, records: dict = records) -> str:  # type: ignore[type-arg]
            record = records[asset]
            return "" if record is None else str(record.summary.get(name, ""))

        done = sum(r is not None for r in records.values())
        table.add_row(
            key,
            number("description", "title"),
            f"{done}/{len(SCENE_PRODUCTS)}",
            number("boxes", "objects"),
            number("trajectories", "flights"),
            number("quality_verdict", "kept"),
            number("prompts", "prompts"),
        )
    return table


def doctor_table(report: "DoctorReport") -> Table:
    """One row a finding, in plain words."""
    table = Table(show_header=False, box=None)
    for finding in report.findings:
        style = SEVERITY_STYLE[finding.severity]
        table.add_row(f"[{style}]{finding.severity}[/{style}]", finding.sentence)
    return table


def stale_table(found: "Sequence[StaleProduct]", scenes: int) -> Table:
    """One row a product and reason: how many scenes, and what making it again took the last time."""
    table = Table(title_justify="left", caption_justify="left")
    for name in ("product", "why"):
        table.add_column(name)
    for name in ("scenes", "seconds", "US dollars"):
        table.add_column(name, justify="right")
    groups = Counter((s.asset, s.reasons) for s in found)
    for (asset, reasons), count in groups.items():
        members = [s for s in found if (s.asset, s.reasons) == (asset, reasons)]
        seconds, usd = sum(s.seconds for s in members), sum(s.usd for s in members)
        table.add_row(asset, "\n".join(reasons), str(count), f"{seconds:.0f}", f"{usd:.2f}")
    stale = len({s.scene for s in found})
    table.title = f"{stale} of {scenes} scenes have something stale" if found else f"{scenes} scenes, nothing is stale"
    surely = [s for s in found if not s.follows]
    table.caption = (
        f"at most {sum(s.seconds for s in found):.0f} s and ${sum(s.usd for s in found):.2f}; at least "
        f"{sum(s.seconds for s in surely):.0f} s and ${sum(s.usd for s in surely):.2f}: what follows costs nothing "
        "where what it follows from turns out the same"
    )
    return table
