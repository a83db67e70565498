"""Many machines on one: Postgres, Redis, an S3 server, Dagster's daemon and two Celery workers; one worker is killed.

    python benchmarks/scale_out.py --scenes 20

Everything is real and on loopback but the stages, which are stand-ins (tests/stand_in.py) that sleep as long as
``--seconds`` says. Needs postgresql, redis-server, and pip install 'flymirage[cloud,celery]' 'moto[server]'.
"""

import argparse
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

DAGSTER_YAML = (ROOT / "deploy" / "dagster.yaml").read_text()
Processes = list[subprocess.Popen[bytes]]


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def start(log: Path, *command: str, **kwargs: object) -> subprocess.Popen[bytes]:
    """A server in a session of its own, so that it can be killed whole."""
    with log.open("ab") as out:
        return subprocess.Popen(command, stdout=out, stderr=out, start_new_session=True, **kwargs)  # type: ignore


def start_postgres(folder: Path, port: int) -> subprocess.Popen[bytes]:
    """A data folder of its own, as the user postgres: the server refuses to be root."""
    data = folder / "pg"
    data.mkdir()
    shutil.chown(data, "postgres")
    folder.chmod(0o755)
    as_postgres = ["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else []
    subprocess.run(
        [*as_postgres, "initdb", "-D", data, "-A", "trust", "-U", "dagster"], check=True, capture_output=True
    )
    server = start(
        folder / "postgres.log",
        *as_postgres,
        "postgres",
        "-D",
        str(data),
        "-p",
        str(port),
        "-k",
        str(data),
        "-c",
        "listen_addresses=127.0.0.1",
        "-c",
        "synchronous_commit=off",
    )
    for _ in range(100):
        if subprocess.run(["pg_isready", "-h", "127.0.0.1", "-p", str(port)], capture_output=True).returncode == 0:
            break
        time.sleep(0.3)
    subprocess.run(["createdb", "-h", "127.0.0.1", "-p", str(port), "-U", "dagster", "dagster"], check=True)
    return server


def start_cluster(folder: Path, seconds: float) -> tuple[Processes, Processes]:
    """Servers and daemon; the workers. Sets the environment that every part of the cluster shares."""
    pg, redis, s3 = free_port(), free_port(), free_port()
    home = folder / "home"
    home.mkdir()
    (home / "dagster.yaml").write_text(
        DAGSTER_YAML.replace("port: 5432", f"port: {pg}").replace("max_concurrent_runs: 16", "max_concurrent_runs: 3")
    )
    (folder / "workspace.yaml").write_text("load_from:\n  - python_module: {module_name: stand_in_definitions}\n")
    os.environ |= {
        "DAGSTER_HOME": str(home),
        "FLYMIRAGE_PG_HOST": "127.0.0.1",
        "FLYMIRAGE_PG_USER": "dagster",
        "FLYMIRAGE_PG_PASSWORD": "",
        "FLYMIRAGE_PG_DB": "dagster",
        "FLYMIRAGE_STORE": "s3://flymirage/store",
        "FLYMIRAGE_EXECUTOR": "celery",
        "CELERY_BROKER_URL": f"redis://127.0.0.1:{redis}/0",
        "CELERY_VISIBILITY_SECONDS": "30",
        "AWS_ENDPOINT_URL": f"http://127.0.0.1:{s3}",
        "AWS_ACCESS_KEY_ID": "test",
        "AWS_SECRET_ACCESS_KEY": "test",
        "AWS_DEFAULT_REGION": "us-east-1",
        "STAND_IN_SECONDS": str(seconds),
        "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests"), str(ROOT / "deploy")]),
    }
    servers = [start_postgres(folder, pg)]
    servers.append(start(folder / "redis.log", "redis-server", "--port", str(redis), "--save", ""))
    servers.append(start(folder / "s3.log", sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(s3)))
    wait_for(s3)
    import s3fs

    s3fs.S3FileSystem().mkdir("flymirage")
    workers = [start_worker(folder, name) for name in ("one", "two")]
    servers.append(
        start(
            folder / "daemon.log", sys.executable, "-m", "dagster._daemon", "run", "-w", str(folder / "workspace.yaml")
        )
    )
    return servers, workers


def start_worker(folder: Path, name: str) -> subprocess.Popen[bytes]:
    celery = [sys.executable, "-m", "celery", "-A", "dagster_celery.app", "worker", "-Q", "dagster", "-c", "1"]
    return start(folder / f"worker-{name}.log", *celery, "-n", f"{name}@%h")


def wait_for(port: int) -> None:
    for _ in range(200):
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.2)
    raise TimeoutError(f"nothing answers on port {port}")


def grow_on_cluster(folder: Path, keys: list[str], seconds: float, limit: float) -> None:
    """Queue a run a scene, kill a worker when a third is done, and wait until every run has ended."""
    servers, workers = start_cluster(folder, seconds)
    try:
        import dagster as dg
        import stand_in_definitions  # noqa: F401 - builds the definitions over stand-in stages

        from flymirage_assets import runs
        from flymirage_assets.report import SCENE_PRODUCTS
        from flymirage_core.settings import Settings
        from resources.records import SceneOrigin
        from resources.store import open_store

        store = open_store(Settings().store)
        for key in keys:
            store.register(SceneOrigin(scene=key, kind="generated"))
        runs.launch_backfill(list(SCENE_PRODUCTS), keys)
        started, killed, done = time.perf_counter(), False, 0
        with dg.DagsterInstance.get() as instance:
            while done < len(keys) and time.perf_counter() - started < limit:
                time.sleep(3)
                done = len(instance.get_materialized_partitions(dg.AssetKey("prompts")))
                if done >= len(keys) // 3 and not killed:
                    os.killpg(workers[0].pid, signal.SIGKILL)
                    killed = True
                    print(f"killed a worker after {done} scenes, {time.perf_counter() - started:.0f} s", flush=True)
            took = time.perf_counter() - started
            while instance.get_run_records(dg.RunsFilter(statuses=runs.UNFINISHED), limit=1):
                if time.perf_counter() - started > limit:
                    break
                time.sleep(3)
            closed = time.perf_counter() - started - took
            states = Counter(run.status.value for run in instance.get_runs())
        whole = [
            all((r := store.current(asset, key)) is not None and store.is_whole(r) for asset in SCENE_PRODUCTS)
            for key in keys
        ]
        pace = f"{took:.0f} s, {3600 * done / took:.0f} an hour"
        print(f"cluster: {sum(whole)} of {len(keys)} scenes whole in S3 after {pace}")
        print(f"runs: {dict(states)}, {closed:.0f} s later", flush=True)
    finally:
        for process in [*workers, *reversed(servers)]:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGTERM)
        time.sleep(3)
        for process in [*workers, *servers]:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)


def grow_in_one_process(folder: Path, scenes: int, seconds: float) -> None:
    """The same in one process with SQLite and a local store, for comparison."""
    env = {k: v for k, v in os.environ.items() if not k.startswith(("FLYMIRAGE_", "DAGSTER_"))}
    env |= {"STAND_IN_SECONDS": str(seconds), "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests")])}
    folder.mkdir()
    started = time.perf_counter()
    command = [sys.executable, "-m", "stand_in", "grow", "--scenes", str(scenes)]
    subprocess.run(command, cwd=folder, env=env, check=True, capture_output=True)
    took = time.perf_counter() - started
    print(f"one process: {scenes} scenes in {took:.0f} s, {3600 * scenes / took:.0f} an hour", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--limit", type=float, default=3000.0, help="seconds that the cluster has")
    parser.add_argument("--alone", action=argparse.BooleanOptionalAction, default=True, help="also in one process")
    parser.add_argument("--keep", type=Path, help="keep logs here")
    arguments = parser.parse_args()
    folder = arguments.keep or Path(tempfile.mkdtemp())
    folder.mkdir(exist_ok=True)
    grow_on_cluster(folder, [f"c{i:03d}" for i in range(arguments.scenes)], arguments.seconds, arguments.limit)
    if arguments.alone:
        grow_in_one_process(folder / "alone", max(2, arguments.scenes // 5), arguments.seconds)


if __name__ == "__main__":
    main()
