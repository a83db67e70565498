"""What is stale in the store, why, and what making it again will cost. Reads records only; computes nothing."""

import statistics
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import dagster as dg

from flymirage_assets.hashing import hash_of, input_hash_of
from flymirage_core.errors import InputError, ProductError
from flymirage_core.settings import Settings
from resources.records import ProductRecord
from resources.store import READERS, Store
from resources.tools import Tools, choose_tools


@dataclass(frozen=True)
class StageSpec:
    """What the staleness of one stage depends on, as its asset declares it."""

    name: str
    code_version: str
    upstream: tuple[str, ...]
    sections: Mapping[str, Any]  # settings section -> its values
    tools: tuple[str, ...]
    paid: bool


@dataclass(frozen=True)
class StaleProduct:
    """One product that has to be looked at again: ``reasons`` in plain words, and what it took the last time."""

    scene: str
    asset: str
    reasons: tuple[str, ...]
    seconds: float
    usd: float
    follows: bool
    """Only because something upstream is stale: if that turns out the same, this costs nothing."""


def stage_specs(definitions: dg.Definitions) -> list[StageSpec]:
    """The scene-partitioned stages, each after all that it needs."""
    graph = definitions.resolve_asset_graph()
    specs = {}
    for key in graph.toposorted_asset_keys:
        node = graph.get(key)
        if "reads_settings" not in node.metadata:
            continue
        specs[key.path[-1]] = StageSpec(
            name=key.path[-1],
            code_version=str(node.code_version),
            upstream=tuple(sorted(parent.path[-1] for parent in node.parent_keys)),
            sections=_value(node.metadata["reads_settings"]),
            tools=tuple(_value(node.metadata["uses_tools"])),
            paid=bool(_value(node.metadata["costs_money"])),
        )
    return list(specs.values())


def with_followers(specs: Sequence[StageSpec], stage: str) -> list[StageSpec]:
    """``stage`` and what follows from it; raises `InputError` for a name that no stage has."""
    if stage not in {spec.name for spec in specs}:
        raise InputError(f"there is no stage {stage!r}: choose one of {', '.join(spec.name for spec in specs)}")
    chosen = {stage}
    for spec in specs:  # in topological order
        if chosen & set(spec.upstream):
            chosen.add(spec.name)
    return [spec for spec in specs if spec.name in chosen]


def stale_products(
    store: Store, specs: Sequence[StageSpec], settings: Settings, scenes: Iterable[str]
) -> list[StaleProduct]:
    """Stale products of ``scenes``, scene by scene, upstream first."""
    tools = choose_tools(settings)
    keys = list(scenes)
    with ThreadPoolExecutor(1 if store.is_local else READERS) as readers:
        records = list(readers.map(lambda scene: {s.name: _current(store, s.name, scene) for s in specs}, keys))
        costs = _usual_costs(records)
        found = readers.map(lambda scene, known: _of_scene(store, specs, tools, scene, known, costs), keys, records)
        return [stale for of_scene in found for stale in of_scene]


def _of_scene(
    store: Store,
    specs: Sequence[StageSpec],
    tools: Tools,
    scene: str,
    records: Mapping[str, ProductRecord | None],
    costs: Mapping[str, tuple[float, float]],
) -> list[StaleProduct]:
    found: list[StaleProduct] = []
    stale: set[str] = set()
    for spec in specs:
        record, digests = records[spec.name], _inputs(store, spec, scene, records)
        names = {port: getattr(tools, port).name for port in spec.tools}
        input_hash = input_hash_of(spec.code_version, digests, names)
        if record is not None and record.input_hash == input_hash:
            reasons = [] if store.is_whole(record) else ["files are missing or torn"]
        else:
            reasons = _reasons(spec, record, digests, names)
        following = sorted(stale & set(spec.upstream))
        if not reasons and not following:
            continue
        if not following and store.remembered(spec.name, scene, input_hash) is not None:
            reasons, cost = [*reasons, "made so before: its files are still there"], (0.0, 0.0)
        else:
            cost = (record.seconds, record.usd) if record is not None else costs.get(spec.name, (0.0, 0.0))
        why = reasons or [f"follows from {', '.join(following)}"]
        found.append(StaleProduct(scene, spec.name, tuple(why), *cost, follows=not reasons))
        stale.add(spec.name)
    return found


def _reasons(
    spec: StageSpec, record: ProductRecord | None, digests: Mapping[str, str], names: Mapping[str, str]
) -> list[str]:
    """Why a product that was made from something else, or never, is stale."""
    if record is None:
        return ["not made yet"]
    reasons = _code_and_settings(spec, record)
    reasons += [f"tool {p}: {record.tools.get(p)} -> {n}" for p, n in names.items() if record.tools.get(p) != n]
    reasons += [f"{name} has new bytes" for name, d in digests.items() if record.inputs.get(name) != d]
    return reasons or ["made from other inputs"]


def _code_and_settings(spec: StageSpec, record: ProductRecord) -> list[str]:
    old, new = record.code_version.partition("-")[0], spec.code_version.partition("-")[0]
    reasons = [f"code: version {old} -> {new}"] if old != new else []
    for section, values in spec.sections.items():
        before = record.settings.get(section, {})
        reasons += [
            f"setting {section}.{name}: {before.get(name, 'not there')} -> {values.get(name, 'not there')}"
            for name in sorted({*before, *values})
            if before.get(name, None) != values.get(name, None)
        ]
    return reasons


def _inputs(store: Store, spec: StageSpec, scene: str, records: Mapping[str, ProductRecord | None]) -> dict[str, str]:
    if not spec.upstream:
        origin = store.origin(scene)
        return {"origin": "" if origin is None else hash_of(origin.model_dump(mode="json"))}
    found = {name: records[name] if name in records else _current(store, name, scene) for name in spec.upstream}
    return {name: record.digest for name, record in found.items() if record is not None}


def _current(store: Store, asset: str, scene: str) -> ProductRecord | None:
    """A record that cannot be read counts as none: the product is made again."""
    try:
        return store.current(asset, scene)
    except ProductError:
        return None


def _usual_costs(records: Iterable[Mapping[str, ProductRecord | None]]) -> dict[str, tuple[float, float]]:
    """Median (seconds, US dollars) of each asset over the scenes that have it."""
    seen: dict[str, list[ProductRecord]] = {}
    for of_scene in records:
        for name, record in of_scene.items():
            if record is not None:
                seen.setdefault(name, []).append(record)
    return {
        name: (statistics.median(r.seconds for r in rs), statistics.median(r.usd for r in rs))
        for name, rs in seen.items()
    }


def _value(metadata: Any) -> Any:
    return getattr(metadata, "value", metadata)
