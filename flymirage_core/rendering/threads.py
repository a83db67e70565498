"""Work side by side on the cores of this machine, its results in order."""

import os
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")
P = TypeVar("P")

LOOK_AHEAD = 2
"""Finished results that may wait for their reader, beyond one for each thread."""


def usable_cores() -> int:
    """How many cores this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_order(make: Callable[[T], P], items: Iterable[T], threads: int) -> Generator[P, None, None]:
    """What ``make`` makes of each item, on as many threads; at most ``threads + LOOK_AHEAD`` are held or in the making.

    >>> list(in_order(len, ["one", "three"], threads=2))
    [3, 5]
    """
    pool = ThreadPoolExecutor(threads, "rasterizer")
    pending: deque[Future[P]] = deque()
    try:
        for item in items:
            pending.append(pool.submit(make, item))
            if len(pending) >= threads + LOOK_AHEAD:
                yield pending.popleft().result()
        while pending:
            yield pending.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)
