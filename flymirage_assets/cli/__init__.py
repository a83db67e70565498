"""The command line: one module for each subject, each of which adds its commands to `app`."""

import signal

from rich.console import Console
from rich.markup import escape

from flymirage_assets.cli import costs, data, doctor, exports, figures, growth, models, operations, worlds
from flymirage_assets.cli.app import app
from flymirage_core.errors import NO_RETRY, FlyMirageError

__all__ = ["app", "costs", "data", "doctor", "exports", "figures", "growth", "main", "models", "operations", "worlds"]

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells expect it."""


def main() -> None:
    """Run the command line; the project's own errors become one sentence and exit code 1."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        # A script's background job (`flymirage grow &`): the shell ignores SIGINT for it, Dagster has SIGTERM do as
        # SIGINT does, and nothing but SIGKILL would stop it.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        app()
    except (growth.StoppedError, KeyboardInterrupt) as stop:
        Console(stderr=True).print(
            f"[yellow]{escape(str(stop) or 'stopped')}[/yellow]", soft_wrap=True, highlight=False
        )
        raise SystemExit(INTERRUPTED) from None
    except FlyMirageError as error:
        _say(str(error))
    except OSError as error:
        if error.errno not in NO_RETRY:
            raise
        what = error.filename or "the store"
        _say(f"{what} cannot be written: {NO_RETRY[error.errno]}; make room, or set FLYMIRAGE_STORE")


def _say(sentence: str) -> None:
    Console(stderr=True).print(f"[red]error:[/red] {escape(sentence)}", soft_wrap=True, highlight=False)
    raise SystemExit(1)
