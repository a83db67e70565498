"""Scene keys, and the one way to obtain randomness: a generator seeded from (scene key, stage, index)."""

import hashlib
import re

import numpy as np

from flymirage_core.errors import SceneKeyError

SCENE_KEY_PATTERN = r"^[a-z0-9][a-z0-9_-]{0,63}$"


def check_scene_key(key: str) -> str:
    """Return ``key`` if it may name a scene (and so a folder); raise `SceneKeyError` otherwise.

    >>> check_scene_key("my-flat_2")
    'my-flat_2'
    """
    if not re.fullmatch(SCENE_KEY_PATTERN, key):
        raise SceneKeyError(
            f"scene key {key!r} is not allowed: use 1 to 64 lower-case letters, digits, '-' and '_', "
            "beginning with a letter or digit"
        )
    return key


def rng(scene_key: str, stage: str, index: int = 0) -> np.random.Generator:
    """A generator that depends on its three arguments alone: same key + same code = same bytes."""
    digest = hashlib.sha256(f"{scene_key}\0{stage}\0{index}".encode()).digest()
    return np.random.default_rng(np.frombuffer(digest, dtype=np.uint32))
