"""`DataVersion`: what each version of a data set added, changed and removed. A version is a change of content."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any


@dataclass(frozen=True)
class DataVersion:
    """One version; ``scenes`` names the exact bytes of everything in it, so that the next can be told from it."""

    number: int  # from 1
    digest: str  # of ``scenes``: equal digests are equal data
    scenes: dict[str, str]  # scene -> hash of all its products
    episodes: int
    added: tuple[str, ...]
    changed: tuple[str, ...]
    removed: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)

    @staticmethod
    def from_dict(data: dict[str, Any]) -> "DataVersion":
        lists = {name: tuple(data[name]) for name in ("added", "changed", "removed")}
        return DataVersion(**{**data, **lists})


def scene_hash(data_versions: Mapping[str, str]) -> str:
    """One hash of all of a scene's products."""
    return _hash(sorted(data_versions.items()))


def with_next_version(
    versions: tuple[DataVersion, ...], scenes: Mapping[str, str], episodes: int
) -> tuple[DataVersion, ...]:
    """``versions`` as they are if the data are those of the last one, else with one more that says what changed."""
    digest = _hash(sorted(scenes.items()))
    before = versions[-1].scenes if versions else {}
    if versions and versions[-1].digest == digest:
        return versions
    fresh = DataVersion(
        number=len(versions) + 1,
        digest=digest,
        scenes=dict(sorted(scenes.items())),
        episodes=episodes,
        added=tuple(sorted(scenes.keys() - before.keys())),
        changed=tuple(sorted(s for s in scenes.keys() & before.keys() if scenes[s] != before[s])),
        removed=tuple(sorted(before.keys() - scenes.keys())),
    )
    # Only the last version's scenes are ever compared against; the list would grow with the square of the scenes.
    past = tuple(replace(version, scenes={}) for version in versions)
    return (*past, fresh)


def changelog_text(versions: tuple[DataVersion, ...]) -> str:
    """CHANGELOG.md, the newest version first."""
    lines = ["# Changelog of the data", ""]
    for version in reversed(versions):
        lines += [f"## {version.number} ({version.digest})", "", f"{version.episodes} episodes."]
        for what in ("added", "changed", "removed"):
            names = getattr(version, what)
            if names:
                lines.append(f"{what.capitalize()} {len(names)} scenes: {', '.join(names)}.")
        lines.append("")
    return "\n".join(lines)


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value).encode()).hexdigest()[:16]
