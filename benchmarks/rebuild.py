"""Rebuild after a planner change, on many scenes: which stages run, which are cut off, what it costs.

    python benchmarks/rebuild.py --scenes 50

Stages are stand-ins (tests/stand_in.py); staleness, the store, Dagster and the automation conditions are the real ones.
Dagster's log is kept in memory, which makes fifty scenes a matter of minutes. Each line says what was changed and, for
each stage, in how many scenes its product was computed, or reinstated from an earlier time.
"""

import argparse
import os
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
os.environ.setdefault("COLUMNS", "160")

import dagster as dg
import stand_in  # noqa: F401 - replaces the stages' functions before the definitions are built

from flymirage_assets import runs
from flymirage_assets.definitions import build_definitions
from flymirage_assets.staleness import stage_specs, stale_products
from flymirage_core.settings import PlannerSettings, Settings
from resources.records import SceneOrigin
from resources.store import open_store


def rebuild(settings: Settings, keys: list[str], what: str) -> None:
    """Rebuild what is stale under ``settings`` and print what happened."""
    from flymirage_assets import definitions

    definitions.defs = build_definitions(settings)
    store = open_store(settings.store)
    specs = stage_specs(definitions.defs)
    started = time.perf_counter()
    stale = stale_products(store, specs, settings, keys)
    looked = time.perf_counter() - started
    before = {(k, s.name): store.current(s.name, k) for k in keys for s in specs}
    seen = {(k, s.name): set(_made(settings, s.name, k)) for k in keys for s in specs}
    started, cpu = time.perf_counter(), time.process_time()
    with dg.DagsterInstance.ephemeral() as instance:
        for key in sorted({s.scene for s in stale}):
            outcome = runs.run_scene(instance, key, [s.asset for s in stale if s.scene == key])
            assert not outcome.error, outcome.error
    outcomes: Counter[tuple[str, str]] = Counter()
    for key in keys:
        for spec in specs:
            after = store.current(spec.name, key)
            if set(_made(settings, spec.name, key)) != seen[key, spec.name]:
                outcomes[spec.name, "computed"] += 1
            elif after != before[key, spec.name]:
                outcomes[spec.name, "reinstated"] += 1
    ran, cpu = time.perf_counter() - started, time.process_time() - cpu
    print(f"{what}: looked {looked:.2f} s, ran {ran:.1f} s, {cpu:.1f} CPU s")
    for (name, outcome), count in outcomes.items():
        print(f"    {name:20s} {outcome:10s} {count} scenes")
    if not outcomes:
        print("    nothing was made")
    sys.stdout.flush()


def _made(settings: Settings, asset: str, scene: str) -> list[str]:
    folder = Path(settings.store) / "products" / asset / scene / "made"
    return [p.name for p in folder.iterdir()] if folder.exists() else []


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--scenes", type=int, default=50)
    count = parser.parse_args().scenes
    with tempfile.TemporaryDirectory() as folder:
        os.environ["DAGSTER_HOME"] = f"{folder}/dagster"
        plain = Settings(store=f"{folder}/store")
        keys = [f"s{i:04d}" for i in range(count)]
        for key in keys:
            open_store(plain.store).register(SceneOrigin(scene=key, kind="generated"))
        slower = plain.model_copy(update={"planner": PlannerSettings(max_speed=1.0)})
        same_bytes = plain.model_copy(update={"planner": PlannerSettings(horizon=8.0)})
        rebuild(plain, keys, f"{count} new scenes")
        rebuild(plain, keys, "a comment (no declared version, no setting)")
        rebuild(slower, keys, "planner.max_speed 1.5 -> 1.0")
        rebuild(plain, keys, "changed back")
        rebuild(same_bytes, keys, "planner.horizon 7.5 -> 8 (the same flights come out)")


if __name__ == "__main__":
    main()
