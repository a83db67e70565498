"""Which scenes to grow next: keys that two daemons agree on, places in balance, and when to stop."""

import itertools
import json
import shutil
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Any

import dagster as dg

from flymirage_assets.pools import POOL_OF_SERVICE, is_paid
from flymirage_core.errors import ProductError
from flymirage_core.scene.taxonomy import Taxonomy, standard_taxonomy
from flymirage_core.settings import Settings
from resources.records import ProductRecord, SceneOrigin
from resources.services.account import Account
from resources.store import Store

LAST_PRODUCT = "prompts"
"""A scene that has it is finished."""
TALLY = "growth/tally.json"


@dataclass(frozen=True)
class GrowthReport:
    """What came of a night, or of one `flymirage grow`."""

    scenes: int
    grown: int
    failed: int
    flights_kept: int
    flights_dropped: int
    usd: float
    seconds: float


def night_scenes(store: Store, night: date, count: int, taxonomy: Taxonomy | None = None) -> list[str]:
    """Register the ``count`` scenes of a night, and return their keys: the same ones however often it is called."""
    keys = [f"n{night:%Y%m%d}-{i:03d}" for i in range(1, count + 1)]
    _claim(store, keys, taxonomy)
    return keys


def next_scenes(store: Store, instance: dg.DagsterInstance, count: int, taxonomy: Taxonomy | None = None) -> list[str]:
    """Keys of ``count`` scenes for `flymirage grow`: unfinished ones first, then new ones, which are registered."""
    begun = unfinished_scenes(store, instance)[:count]
    known = set(store.scenes())
    fresh = (key for i in itertools.count(1) if (key := f"scene-{i:04d}") not in known)
    return begun + list(itertools.islice((key for key in fresh if _claim(store, [key], taxonomy)), count - len(begun)))


def endless_scenes(store: Store, instance: dg.DagsterInstance, taxonomy: Taxonomy | None = None) -> Iterator[str]:
    """Unfinished scenes, each once, then new ones without end."""
    yield from unfinished_scenes(store, instance)
    known = set(store.scenes())
    for i in itertools.count(1):
        if (key := f"scene-{i:04d}") not in known and _claim(store, [key], taxonomy):
            yield key


def unfinished_scenes(store: Store, instance: dg.DagsterInstance) -> list[str]:
    """Generated scenes that were begun, in order; read from Dagster's log and checked in the store."""
    finished = instance.get_materialized_partitions(dg.AssetKey(LAST_PRODUCT))
    candidates = [s for s in store.scenes() if s not in finished]
    return [s for s in candidates if (origin := store.origin(s)) is not None and origin.kind == "generated"]


def why_stop(store: Store, settings: Settings) -> str:
    """Why no further scene may be begun, in one sentence; "" if there is no reason."""
    return _spent_budget(store, settings) or _full_disk(store, settings)


def _spent_budget(store: Store, settings: Settings) -> str:
    if not is_paid(settings, tuple(POOL_OF_SERVICE)):
        return ""
    budget, ledger = settings.services.budget, Account(store, "", "", settings.services).ledger
    for name, cap, since in (
        ("night_usd", budget.night_usd, ledger.night_start()),
        ("month_usd", budget.month_usd, ledger.month_start()),
    ):
        spent = ledger.spent(since=since).usd
        if spent >= cap:
            return f"${spent:.2f} are spent and services.budget.{name} = ${cap:.2f}: `flymirage costs` shows on what"
    return ""


def _full_disk(store: Store, settings: Settings) -> str:
    if not store.is_local:
        return ""
    free = shutil.disk_usage(Path(str(store.base))).free / 1e9
    if free >= settings.growth.min_free_gb:
        return ""
    return (
        f"the store's disk has {free:.1f} GB left, growth.min_free_gb asks for {settings.growth.min_free_gb:g}: "
        "`flymirage gc` frees old versions"
    )


def growth_report(store: Store, scenes: Sequence[str]) -> GrowthReport:
    """Sums over ``scenes``, from the records in the store."""
    usd = seconds = 0.0
    grown = kept = dropped = 0
    for scene in scenes:
        records = [r for asset in store.assets() if (r := _readable(store, asset, scene)) is not None]
        usd, seconds = usd + sum(r.usd for r in records), seconds + sum(r.seconds for r in records)
        verdict = next((r.summary for r in records if r.asset == "quality_verdict"), {})
        grown += any(r.asset == LAST_PRODUCT for r in records)
        kept, dropped = kept + int(verdict.get("kept", 0)), dropped + int(verdict.get("dropped", 0))
    return GrowthReport(len(scenes), grown, len(scenes) - grown, kept, dropped, round(usd, 4), round(seconds, 1))


def post_report(instance: dg.DagsterInstance, store: Store, scenes: Sequence[str]) -> GrowthReport:
    """The report of a `flymirage grow`, also as a materialisation of the asset ``growth_report``."""
    report = growth_report(store, scenes)
    night = datetime.now(UTC).date().isoformat()
    metadata: dict[str, Any] = {"night": night, **asdict(report)}
    if scenes:
        instance.report_runless_asset_event(dg.AssetMaterialization("growth_report", metadata=metadata))
    return report


def _readable(store: Store, asset: str, scene: str) -> ProductRecord | None:
    try:
        return store.current(asset, scene)
    except ProductError:
        return None


def _claim(store: Store, keys: Sequence[str], taxonomy: Taxonomy | None = None) -> list[str]:
    """Register those of ``keys`` that nobody has, each in the place that balances the data set; return these."""
    taxonomy = taxonomy or standard_taxonomy()
    unknown = [key for key in keys if store.origin(key) is None]
    if not unknown:
        return []
    counts = _tally(store)
    claimed = []
    for key in unknown:
        category, subcategory = taxonomy.pick(key, counts)
        origin = SceneOrigin(scene=key, kind="generated", category=category, subcategory=subcategory)
        if store.claim(origin):
            counts[category, subcategory] += 1
            claimed.append(key)
    store.write_note(TALLY, json.dumps([[*place, n] for place, n in sorted(counts.items())]))
    return claimed


def _tally(store: Store) -> Counter[tuple[str, str]]:
    """Scenes in each (category, subcategory): from the note of the last claim; counted anew if there is none."""
    text = store.read_note(TALLY)
    try:
        return Counter({(category, sub): int(n) for category, sub, n in json.loads(text or "")})
    except ValueError:
        origins = (store.origin(scene) for scene in store.scenes())
        return Counter(origin.place for origin in origins if origin is not None and origin.place is not None)
