"""Which split an episode is in, and which sentences are kept from training: pure functions of an episode's own words.

Nothing depends on what else is in the data set, so growth never reassigns anything.
"""

import hashlib
from typing import Literal, get_args

Split = Literal["train", "val_seen", "val_unseen", "test_unseen_category", "test_unseen_instruction"]
SPLITS: tuple[Split, ...] = get_args(Split)

UNSEEN_CATEGORY_SHARE = 0.1
"""Share of kinds of places (subcategories) held out whole: test_unseen_category."""
UNSEEN_SHARE = 0.1
"""Share of the other scenes held out whole: val_unseen."""
SEEN_SHARE = 0.1
"""Share of a training scene's task sets held out: val_seen."""
UNSEEN_INSTRUCTION_SHARE = 0.1
"""Share of sentences that no training episode may carry."""

SPLIT_RULE = {
    "hash": "first 8 bytes of sha256, as a share of 2^64",
    "test_unseen_category": f"hash of the scene's subcategory < {UNSEEN_CATEGORY_SHARE}; never an imported scene",
    "val_unseen": f"else hash of the scene's key < {UNSEEN_SHARE}",
    "val_seen": f"else hash of scene key and task set < {SEEN_SHARE}",
    "test_unseen_instruction": "else every one of the flight's instructions is held out",
    "train": "else; its held-out instructions are listed apart and are not among its tasks",
    "held-out instruction": f"hash of the sentence < {UNSEEN_INSTRUCTION_SHARE}",
}
"""The rule in words, for manifest.json and conventions.json."""


def split_of(scene: str, set_index: int, subcategory: str = "") -> Split:
    """Split of all legs of one task set; ``subcategory`` is the scene's kind of place, "" for an imported world.

    Whole kinds of places are held out for ``test_unseen_category``, whole scenes for ``val_unseen``, and for
    ``val_seen`` whole sets: a leg starts where the last one ends.

    >>> split_of("quiet-cafe", 0) == split_of("quiet-cafe", 0)
    True
    """
    if subcategory and _unit(f"subcategory\0{subcategory}") < UNSEEN_CATEGORY_SHARE:
        return "test_unseen_category"
    if _unit(f"scene\0{scene}") < UNSEEN_SHARE:
        return "val_unseen"
    return "val_seen" if _unit(f"set\0{scene}\0{set_index}") < SEEN_SHARE else "train"


def is_unseen_instruction(text: str) -> bool:
    """Is the sentence kept from training, in whatever episode it occurs?"""
    return _unit(f"instruction\0{text}") < UNSEEN_INSTRUCTION_SHARE


def _unit(text: str) -> float:
    """A number in [0, 1) that depends on ``text`` alone."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") / 2**64
