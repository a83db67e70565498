"""Asset checks: a corrupt product stops the run (blocking), a poor one is a warning with its numbers."""

import operator
from dataclasses import dataclass
from typing import Any

import dagster as dg

from flymirage_core.errors import FlyMirageError
from resources.io_manager import Commit
from resources.store import Store

WHOLE, QUALITY = "whole", "quality"


@dataclass(frozen=True)
class Expectation:
    """A number of the product's summary that should be at least so much."""

    number: str
    at_least: float
    why: str


EXPECTED = {
    "world": Expectation("gaussians", 5_000, "thinner worlds have holes that cameras see through"),
    "orbit_boxes": Expectation("objects", 3, "Algorithm 1 needs objects to choose from"),
    "boxes": Expectation("objects", 5, "task sets need targets; the paper's scenes have 60 to 100 objects"),
    "task_sets": Expectation("tasks", 2, "a scene without tasks adds nothing to the data set"),
    "trajectories": Expectation("flights", 1, "no task could be flown"),
    "quality_verdict": Expectation("kept", 1, "every flight was dropped"),
    "prompts": Expectation("prompts_per_flight", 1.0, "kept flights without instructions are not exported"),
}


def check_specs(asset: str) -> list[dg.AssetCheckSpec]:
    """``whole`` for every asset; ``quality`` where something is expected of it."""
    specs = [
        dg.AssetCheckSpec(
            WHOLE,
            asset=asset,
            blocking=True,
            description="The files that were written can be read back as the product, with the sizes in its record.",
        )
    ]
    if (expected := EXPECTED.get(asset)) is not None:
        about = f"{expected.number.replace('_', ' ')} >= {expected.at_least:g}: {expected.why}. Never stops a run."
        specs.append(dg.AssetCheckSpec(QUALITY, asset=asset, description=about))
    return specs


def check_results(commit: Commit, store: Store) -> list[dg.AssetCheckResult]:
    """Results of the checks that `check_specs` declares; none for products that are not partitioned by scene."""
    record = commit.record
    if commit.returns is None:
        return []
    problem = _unreadable(commit, store)
    numbers: dict[str, Any] = {"files": len(record.files), "bytes": record.bytes, "problem": problem or "none"}
    results = [dg.AssetCheckResult(passed=not problem, check_name=WHOLE, metadata=numbers)]
    if (expected := EXPECTED.get(record.asset)) is not None:
        value = record.summary.get(expected.number, 0)
        results.append(
            dg.AssetCheckResult(
                passed=isinstance(value, int | float) and operator.ge(value, expected.at_least),
                check_name=QUALITY,
                severity=dg.AssetCheckSeverity.WARN,
                metadata={expected.number: value, "at_least": expected.at_least, "why": expected.why},
            )
        )
    return results


def _unreadable(commit: Commit, store: Store) -> str:
    """Why the product cannot be read back, in one sentence; "" if it can."""
    assert commit.returns is not None
    record, staged = commit.record, commit.staged
    if staged is None:  # it was read back when it was made
        return "" if store.is_whole(record) else "files are missing or torn"
    try:
        torn = [name for name, entry in record.files.items() if (staged.folder / name).stat().st_size != entry.size]
        if torn:
            return f"{torn[0]} has another size than was written"
        commit.returns.load(staged.folder)
    except (FlyMirageError, OSError, ValueError, KeyError) as error:
        return f"it cannot be read back: {error}"
    return ""
