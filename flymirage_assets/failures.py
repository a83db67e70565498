"""What Dagster is told when a stage fails: one sentence, and whether trying again may help."""

from typing import Any

import dagster as dg

from flymirage_core.errors import NO_RETRY, FlyMirageError, NightStopError, TransientServiceError

STOPS_GROWTH = "stops_growth"
"""Metadata of failures that every other scene would meet too."""


class one_clear_sentence:  # noqa: N801 - reads as what it does at the place of use
    """Turns errors into Dagster failures: only a transient one is retried, every other would meet the same again."""

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        if isinstance(error, TransientServiceError | ConnectionError | TimeoutError):
            raise dg.Failure(description=str(error) or type(error).__name__, allow_retries=True) from error
        if isinstance(error, FlyMirageError):
            metadata: dict[str, Any] = {"error": type(error).__name__}
            if isinstance(error, NightStopError):
                metadata[STOPS_GROWTH] = True
            raise dg.Failure(description=str(error), metadata=metadata, allow_retries=False) from error
        if isinstance(error, OSError) and error.errno in NO_RETRY:
            raise dg.Failure(
                description=f"{error.filename or 'the store'} cannot be written: {NO_RETRY[error.errno]}; make room or "
                "set FLYMIRAGE_STORE, then run the command again: it carries on from here",
                allow_retries=False,
            ) from error
        if isinstance(error, Exception) and not isinstance(error, dg.Failure):
            raise dg.Failure(
                description=f"{type(error).__name__}: {error} (a bug of FlyMirage: `make dev` shows the whole trace in "
                "the run's log)",
                allow_retries=False,
            ) from error
