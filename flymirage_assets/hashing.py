"""The two hashes by which stages decide whether there is something to do."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any


def hash_of(value: Any) -> str:
    """sha256 (32 hex digits) of ``value`` as canonical JSON."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:32]


def input_hash_of(code_version: str, inputs: Mapping[str, str], tools: Mapping[str, str]) -> str:
    """H(code version, upstream digests, names of the tools): a product that has the same one is up to date."""
    return hash_of([code_version, dict(inputs), dict(tools)])
