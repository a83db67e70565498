"""How long work tells a person where it is: one listener for each thread of control, none by default."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

T = TypeVar("T")
Listener = Callable[[str, int, int], None]
"""Called with (what is being counted, done so far, total)."""

_listener: ContextVar[Listener | None] = ContextVar("progress_listener", default=None)


def current_listener() -> Listener | None:
    """Who hears of progress here, if anyone."""
    return _listener.get()


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Let ``listener`` hear of all progress made inside of the ``with`` block."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def track(items: Iterable[T], what: str, total: int) -> Iterator[T]:
    """Yield ``items``, reporting how many have been done.

    >>> heard = []
    >>> with listening(lambda *report: heard.append(report)):
    ...     list(track("ab", "views", 2))
    ['a', 'b']
    >>> heard
    [('views', 0, 2), ('views', 1, 2), ('views', 2, 2)]
    """
    listener = _listener.get()
    if listener is None:
        yield from items
        return
    listener(what, 0, total)
    for done, item in enumerate(items, start=1):
        listener(what, done, total)  # before it is handed out: not everyone asks for more after the last
        yield item
