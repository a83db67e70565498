"""The one seam through which tests break the store: a named instant at which a process can be made to die.

``FLYMIRAGE_FAULT=NAME:N`` kills the process (SIGKILL, as a power cut would) when it passes NAME the N-th time.
"""

import os
import signal
from collections import Counter

_passed: Counter[str] = Counter()


def fault_point(name: str) -> None:
    """Die here if the environment asks for it; else cost next to nothing."""
    wanted = os.environ.get("FLYMIRAGE_FAULT")
    if wanted is None:
        return
    _passed[name] += 1
    if wanted == f"{name}:{_passed[name]}":
        os.kill(os.getpid(), signal.SIGKILL)
