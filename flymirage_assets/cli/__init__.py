"""The command line: one module for each subject, each of which adds its commands to `app`."""

from rich.console import Console
from rich.markup import escape

from flymirage_assets.cli import data, doctor, exports, growth, models, worlds
from flymirage_assets.cli.app import app
from flymirage_core.errors import FlyMirageError

__all__ = ["app", "data", "doctor", "exports", "growth", "main", "models", "worlds"]

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells expect it."""


def main() -> None:
    """Run the command line; the project's own errors become one sentence and exit code 1."""
    try:
        app()
    except (growth.StoppedError, KeyboardInterrupt) as stop:
        Console(stderr=True).print(
            f"[yellow]{escape(str(stop) or 'stopped')}[/yellow]", soft_wrap=True, highlight=False
        )
        raise SystemExit(INTERRUPTED) from None
    except FlyMirageError as error:
        Console(stderr=True).print(f"[red]error:[/red] {escape(str(error))}", soft_wrap=True, highlight=False)
        raise SystemExit(1) from None
