"""Which split an episode is in: a pure function of its scene and task set, so growth never reassigns anything."""

import hashlib
from typing import Literal, get_args

Split = Literal["train", "val_seen", "val_unseen"]
SPLITS: tuple[Split, ...] = get_args(Split)

UNSEEN_SHARE = 0.1
"""Share of scenes held out whole: val_unseen."""
SEEN_SHARE = 0.1
"""Share of a training scene's task sets held out: val_seen."""


def split_of(scene: str, set_index: int) -> Split:
    """Split of all legs of one task set.

    Whole scenes are held out for ``val_unseen``, and for ``val_seen`` whole sets: a leg starts where the last one ends.

    >>> split_of("quiet-cafe", 0) == split_of("quiet-cafe", 0)
    True
    """
    if _unit(f"scene\0{scene}") < UNSEEN_SHARE:
        return "val_unseen"
    return "val_seen" if _unit(f"set\0{scene}\0{set_index}") < SEEN_SHARE else "train"


def _unit(text: str) -> float:
    """A number in [0, 1) that depends on ``text`` alone."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") / 2**64
