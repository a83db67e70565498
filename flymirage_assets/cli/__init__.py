"""The command line: one module for each subject, each of which adds its commands to `app`."""

from rich.console import Console
from rich.markup import escape

from flymirage_assets.cli import data, doctor, growth, models, worlds
from flymirage_assets.cli.app import app
from flymirage_core.errors import FlyMirageError

__all__ = ["app", "data", "doctor", "growth", "main", "models", "worlds"]


def main() -> None:
    """Run the command line; the project's own errors become one sentence and exit code 1."""
    try:
        app()
    except FlyMirageError as error:
        Console(stderr=True).print(f"[red]error:[/red] {escape(str(error))}", soft_wrap=True, highlight=False)
        raise SystemExit(1) from None
