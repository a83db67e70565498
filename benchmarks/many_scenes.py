"""Thousands of scenes in the store and in Dagster's log: how long commands and the UI's queries take.

    python benchmarks/many_scenes.py --scenes 10000

Records and events are synthetic: one real scene is made of stand-in stages (tests/stand_in.py), and its records and
events are copied under other keys. Then `flymirage status`, the growth and staleness look-ups, and, over HTTP, the
GraphQL queries behind the UI's asset pages are timed.
"""

import argparse
import contextlib
import json
import os
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

import dagster as dg  # noqa: E402
import httpx  # noqa: E402
import stand_in  # noqa: E402, F401

GRAPHQL = {
    "lineage page (stats of all assets)": (
        "{ assetNodes { assetKey { path } partitionStats { numMaterialized numPartitions } staleStatus "
        "assetMaterializations(limit: 1) { timestamp } } }"
    ),
    "partitions tab of one asset": (
        '{ assetNodeOrError(assetKey: {path: ["trajectories"]}) { ... on AssetNode { '
        "assetPartitionStatuses { ... on DefaultPartitionStatuses { materializedPartitions failedPartitions } } "
        "partitionKeyConnection(limit: 100, ascending: true) { results } } } }"
    ),
    "one partition of one asset": (
        '{ assetNodeOrError(assetKey: {path: ["trajectories"]}) { ... on AssetNode { '
        'staleStatus(partition: "s00042") assetMaterializations(partitions: ["s00042"], limit: 1) { timestamp '
        "metadataEntries { label } } } } }"
    ),
    "asset catalogue": "{ assetsOrError { ... on AssetConnection { nodes { key { path } } } } }",
    "runs page": "{ runsOrError(limit: 25) { ... on Runs { results { runId status tags { key value } } } } }",
}


def synthesise(folder: Path, keys: list[str]) -> None:
    """Finished scenes ``keys``: copies of the first, which is really made."""
    from flymirage_assets import runs
    from flymirage_assets.report import SCENE_PRODUCTS
    from resources.records import SceneOrigin
    from resources.store import open_store

    store = open_store(str(folder / "store"))
    store.register(SceneOrigin(scene="s00000", kind="generated", category="home", subcategory="kitchen"))
    with runs.dagster_instance() as instance:
        outcome = runs.run_scene(instance, "s00000")
        assert not outcome.error, outcome.error
        instance.add_dynamic_partitions("scene", keys)
    base = Path(str(store.base))
    for key in keys[1:]:
        origin = (base / "scenes" / "s00000.json").read_text().replace("s00000", key)
        (base / "scenes" / f"{key}.json").write_text(origin)
    for asset in SCENE_PRODUCTS:
        record = (base / "products" / asset / "s00000" / "product.json").read_text()
        digest = json.loads(record)["digest"]
        for key in keys[1:]:
            product = base / "products" / asset / key
            product.mkdir()
            (product / "product.json").write_text(record.replace("s00000", key))
            (product / digest).symlink_to(base / "products" / asset / "s00000" / digest)
    _copy_events(folder / "dagster" / "history" / "runs" / "index.db", keys)


def _copy_events(database: Path, keys: list[str]) -> None:
    """Every event of scene s00000's assets, again under each other key."""
    with sqlite3.connect(database) as connection:
        for table in ("event_logs", "asset_event_tags"):
            columns = [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
            rows = connection.execute(f"SELECT * FROM {table} ORDER BY id").fetchall()
            if table == "event_logs":
                own = {row[0] for row in rows if "s00000" in str(row)}
                new_id = max(row[0] for row in rows) + 1
                rows = [row for row in rows if row[0] in own and "ASSET_MATERIALIZATION" in str(row)]
                ids: dict[tuple[int, str], int] = {}
                copies = []
                for key in keys[1:]:
                    for row in rows:
                        ids[row[0], key] = new_id
                        copies.append((new_id, *(_renamed(value, key) for value in row[1:])))
                        new_id += 1
            else:
                event_id = columns.index("event_id")
                next_id = max((row[0] for row in rows), default=0) + 1
                copies = []
                for key in keys[1:]:
                    for row in rows:
                        if (row[event_id], key) in ids:
                            values = list(row)
                            values[0], values[event_id] = next_id, ids[row[event_id], key]
                            copies.append(tuple(_renamed(v, key) for v in values))
                            next_id += 1
            connection.executemany(f"INSERT INTO {table} VALUES ({','.join('?' * len(columns))})", copies)


def _renamed(value: Any, key: str) -> Any:
    return value.replace("s00000", key) if isinstance(value, str) else value


def timed(what: str, action: Callable[[], Any]) -> None:
    started, cpu = time.perf_counter(), time.process_time()
    action()
    print(f"{what}: {time.perf_counter() - started:.2f} s, {time.process_time() - cpu:.2f} CPU s here", flush=True)


def command(folder: Path, *arguments: str) -> None:
    usage = os.wait4(
        subprocess.Popen(
            [sys.executable, "-m", "flymirage_assets.cli", *arguments], cwd=folder, stdout=subprocess.DEVNULL
        ).pid,
        0,
    )[2]
    print(f"    {usage.ru_utime + usage.ru_stime:.2f} CPU s")


def cpu_of(pid: int) -> float:
    """CPU seconds that a process has used (Linux)."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def ask_the_ui(folder: Path, when: str) -> None:
    """Time GraphQL queries against a webserver that is started on loopback, each three times."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    server = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "dagster_webserver",
            "-h",
            "127.0.0.1",
            "-p",
            str(port),
            "-w",
            str(ROOT / "workspace.yaml"),
        ],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        url = f"http://127.0.0.1:{port}/graphql"
        for _ in range(240):
            try:
                httpx.post(url, json={"query": "{ version }"}, timeout=60).raise_for_status()
                break
            except httpx.HTTPError:
                time.sleep(0.5)
        for what, query in GRAPHQL.items():
            seconds = []
            for _ in range(3):
                started = time.perf_counter()
                before = cpu_of(server.pid)
                answer = httpx.post(url, json={"query": query}, timeout=120).json()
                seconds.append((time.perf_counter() - started, cpu_of(server.pid) - before))
                assert "errors" not in answer, answer["errors"][0]["message"]
            print(f"UI, {when}: {what}: {', '.join(f'{s:.2f} s ({c:.2f} CPU s)' for s, c in seconds)}", flush=True)
    finally:
        server.terminate()
        server.wait(30)


def sweep(keys: list[str]) -> None:
    """A whole morning of the sensor ``stale_sweep``: how long its ticks take, and that each scene is looked at once."""
    from flymirage_assets.sweep import SweepCursor, sweep_sensor
    from flymirage_core.settings import Settings

    sensor, cursor, ticks = sweep_sensor(Settings()), SweepCursor(morning="yesterday").model_dump_json(), []
    asked: list[str | None] = []
    with dg.DagsterInstance.get() as instance:
        while not SweepCursor.model_validate_json(cursor).done:
            started = time.perf_counter(), time.process_time()
            result = sensor(dg.build_sensor_context(instance, cursor=cursor))
            assert isinstance(result, dg.SensorResult) and result.cursor is not None
            ticks.append((time.perf_counter() - started[0], time.process_time() - started[1]))
            asked += [request.partition_key for request in result.run_requests or []]
            cursor = result.cursor
    wall, cpu = [t[0] for t in ticks], sum(t[1] for t in ticks)
    print(f"stale_sweep: {len(ticks)} ticks of at most {max(wall):.1f} s, {cpu:.1f} CPU s in all; ", end="")
    print(f"{len(asked)} runs asked for, each of another scene: {len(set(asked)) == len(asked)}", flush=True)
    assert set(asked) <= set(keys)


def measure(folder: Path, keys: list[str]) -> None:
    for _ in range(2):
        timed("flymirage status", lambda: command(folder, "status"))
    timed("flymirage status SCENE", lambda: command(folder, "status", keys[42]))
    from flymirage_assets import definitions, growing, runs
    from flymirage_assets.assets.dataset import finished_scenes
    from flymirage_assets.staleness import stage_specs, stale_products
    from flymirage_core.settings import Settings
    from resources.store import open_store

    settings = Settings()
    store = open_store(settings.store)
    timed("which scenes are finished", lambda: finished_scenes(store))
    with runs.dagster_instance() as instance:
        timed("keys of 5 more scenes", lambda: growing.next_scenes(store, instance, 5))
        timed("a night's scenes", lambda: growing.night_scenes(store, growing.date(2026, 1, 1), 5))
    specs = stage_specs(definitions.defs)
    timed("what is stale in all scenes", lambda: stale_products(store, specs, settings, keys))
    sweep(keys)
    ask_the_ui(folder, "with a log that no server has seen yet")
    ask_the_ui(folder, "after a restart")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--folder", type=Path, help="of an earlier time, or to be kept for a later one")
    arguments = parser.parse_args()
    with contextlib.ExitStack() as stack:
        folder = arguments.folder or Path(stack.enter_context(tempfile.TemporaryDirectory()))
        os.environ |= {"DAGSTER_HOME": f"{folder}/dagster", "FLYMIRAGE_STORE": f"{folder}/store"}
        os.environ["PYTHONPATH"] = str(ROOT)
        keys = [f"s{i:05d}" for i in range(arguments.scenes)]
        if not (folder / "store").exists():
            timed(f"{len(keys)} synthetic scenes", lambda: synthesise(folder, keys))
        measure(folder, keys)


if __name__ == "__main__":
    main()
