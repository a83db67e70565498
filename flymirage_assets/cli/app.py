"""What every command shares: the typer application, the console, the project's settings and store, progress bars."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer
from pydantic import ValidationError
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from flymirage_core.errors import InputError
from flymirage_core.progress import listening
from flymirage_core.settings import Settings

if TYPE_CHECKING:
    from resources.store import Store

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="The same Dagster assets on the same instance as the UI, in one process, with progress bars.",
)
console = Console()


def project_settings() -> Settings:
    """The settings; raises `InputError` naming the field that cannot be used."""
    try:
        return Settings()
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(str(part) for part in first["loc"])
        problem = "there is no such setting" if first["type"] == "extra_forbidden" else first["msg"]
        raise InputError(
            f"setting {field!r} is {first.get('input')!r}: {problem}; it comes from flymirage.toml or from an "
            "environment variable that begins with FLYMIRAGE_"
        ) from error


def project_store() -> "Store":
    """The store that the settings name."""
    from resources.store import open_store

    return open_store(project_settings().store)


@contextmanager
def progress_bars() -> Iterator[None]:
    """One bar for each stage that reports; a finished stage leaves a line with its seconds."""
    bars = Progress(
        SpinnerColumn(finished_text="[green]✓[/green]"),
        TextColumn("{task.description}", justify="left"),
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=console,
    )
    tasks = {}

    def listen(what: str, done: int, total: int) -> None:
        if what not in tasks:
            tasks[what] = bars.add_task(what, total=total)
        bars.update(tasks[what], completed=done, total=total)

    with bars, listening(listen):
        yield
