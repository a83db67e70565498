"""A night of growth under `dagster dev` that is disturbed: the same scenes, whole, with the same bytes.

    python benchmarks/crash_nights.py daemon         # SIGKILL while a run is going on; likewise:
    python benchmarks/crash_nights.py code-server
    python benchmarks/crash_nights.py worker         # the process of the run
    python benchmarks/crash_nights.py everything     # daemon, web server, code server, worker at once
    python benchmarks/crash_nights.py two-daemons    # a second daemon on the same instance, all night
    python benchmarks/crash_nights.py calm           # nothing happens; the morning's report

Stages are stand-ins (tests/stand_in.py) that take a while; schedule, daemon, queue, code server, workers and store are
the real ones. The night's schedule ticks every minute, and every tick means the same night.
"""

import argparse
import contextlib
import functools
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT), str(ROOT / "tests")]

import dagster as dg  # noqa: E402
from crash import digests, flymirage, store_of  # noqa: E402

from flymirage_assets.report import SCENE_PRODUCTS  # noqa: E402
from flymirage_assets.runs import UNFINISHED, run_scene  # noqa: E402
from resources.records import SceneOrigin  # noqa: E402

ROLES = {
    "daemon": "dagster._daemon",
    "code-server": "code-server start",
    "worker": "spawn_main",
    "everything": "",
}
"""What is killed: processes of the night with this in their command line."""


def told_to(messages: list[dict[str, str]]) -> str:
    """The URL of a webhook on loopback that appends what it is told."""

    class Hook(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            messages.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_: object) -> None: ...

    server = HTTPServer(("127.0.0.1", 0), Hook)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}/"


class Night:
    """A project whose schedules run under `dagster dev`."""

    def __init__(self, folder: Path, scenes: int, seconds: float) -> None:
        self.folder, self.scenes = folder, scenes
        self.told: list[dict[str, str]] = []
        self.home = folder / ".flymirage" / "dagster"
        folder.mkdir()
        self.night = datetime.now(UTC)
        morning = self.night + timedelta(minutes=4)
        (folder / "flymirage.toml").write_text(
            f"[growth]\nnightly = true\nscenes_per_night = {scenes}\nmin_free_gb = 0\n"
            f'cron = "* * * * *"\nsweep_cron = "{morning:%M %H * * *}"\n'
            f'[operation]\nwebhook_url = "{told_to(self.told)}"\n'
        )
        (folder / "workspace.yaml").write_text("load_from:\n  - python_module: {module_name: stand_in_definitions}\n")
        self.environment = {
            **{k: v for k, v in os.environ.items() if not k.startswith(("FLYMIRAGE_", "DAGSTER_"))},
            "DAGSTER_HOME": str(self.home),
            "STAND_IN_SECONDS": str(seconds),
            "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests")]),
        }
        self.instance: dg.DagsterInstance | None = None
        self.logs = (folder / "dagster.log").open("ab")

    @property
    def keys(self) -> list[str]:
        return [f"n{self.night:%Y%m%d}-{i:03d}" for i in range(1, self.scenes + 1)]

    def start(self) -> None:
        """What `make dev` does: tidy the home, then webserver, code server and daemon."""
        flymirage(self.folder, "home", **self.environment).communicate()
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = str(probe.getsockname()[1])
        self._spawn("-m", "dagster", "dev", "-w", "workspace.yaml", "-h", "127.0.0.1", "-p", port)

    def start_another_daemon(self) -> None:
        self._spawn("-m", "dagster._daemon", "run", "-w", "workspace.yaml")

    def kill(self, role: str) -> int:
        """SIGKILL every process of the night that plays ``role``; how many these were."""
        doomed = [pid for pid, line in self._processes() if ROLES[role] in line]
        for pid in doomed:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        return len(doomed)

    def is_up(self) -> bool:
        return any("dagster dev" in line for _, line in self._processes())

    def finished(self) -> int:
        return len(store_of(self.folder).scenes_with(SCENE_PRODUCTS[-1]))

    def known(self) -> list[str]:
        return store_of(self.folder).scenes()

    def runs(self) -> Counter[str]:
        if self.instance is None:
            self.instance = dg.DagsterInstance.from_config(str(self.home))
        return Counter(run.status.value for run in self.instance.get_runs())

    def report(self) -> dict[str, object] | None:
        """The numbers of the last growth report, if there is one."""
        self.runs()
        assert self.instance is not None
        event = self.instance.get_latest_materialization_event(dg.AssetKey("growth_report"))
        if event is None or event.asset_materialization is None:
            return None
        return {name: entry.value for name, entry in event.asset_materialization.metadata.items()}

    def wait(self, until: Callable[[], bool], seconds: float) -> bool:
        """True if it came true in time; `dagster dev` is started again if it gave up."""
        deadline = time.monotonic() + seconds
        while not until():
            if time.monotonic() > deadline:
                return False
            time.sleep(1)
            if not self.is_up():
                print("    dagster dev gave up and is started again", flush=True)
                self.start()
        return True

    def _spawn(self, *command: str) -> None:
        subprocess.Popen(
            [sys.executable, *command],
            cwd=self.folder,
            env=self.environment,
            stdout=self.logs,
            stderr=self.logs,
            start_new_session=True,
        )

    def _processes(self) -> list[tuple[int, str]]:
        """(pid, command line) of all that was started with this night's home (Linux)."""
        found = []
        for path in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if f"DAGSTER_HOME={self.home}\0".encode() in (path / "environ").read_bytes():
                    found.append((int(path.name), (path / "cmdline").read_bytes().replace(b"\0", b" ").decode()))
        return found


def kill(night: Night, role: str) -> None:
    """Once, while a run is going on after the first scene."""
    night.wait(lambda: night.finished() > 0 and night.runs()["STARTED"] > 0, 300)
    count = night.kill(role)
    print(f"    killed {role} ({count} processes) with {night.finished()} scenes finished", flush=True)
    time.sleep(2)


def two_daemons(night: Night) -> None:
    night.start_another_daemon()


def calm(night: Night) -> None:
    """Nothing happens; the morning's report is printed."""
    night.wait(lambda: night.report() is not None, 600)
    print(f"    report: {night.report()}", flush=True)


EVENTS: dict[str, Callable[[Night], None]] = {
    **{role: functools.partial(kill, role=role) for role in ROLES},
    "two-daemons": two_daemons,
    "calm": calm,
}


def undisturbed(folder: Path, keys: list[str]) -> dict[str, dict[str, str]]:
    """Content hashes of the same scenes, made in this process, one after the other."""
    os.environ["FLYMIRAGE_STORE"] = str(folder / ".flymirage" / "store")
    import stand_in  # noqa: F401 - replaces the stages' functions before the definitions are built

    store = store_of(folder)
    with dg.DagsterInstance.ephemeral() as instance:
        for key in keys:
            store.register(SceneOrigin(scene=key, kind="generated"))
            outcome = run_scene(instance, key)
            assert not outcome.error, outcome.error
    return {key: digests(folder, key) for key in keys}


def watch(night: Night, event: str, limit: float) -> None:
    """Let the night happen, and print what came of it."""
    started = time.monotonic()
    night.start()
    try:
        night.wait(lambda: len(night.known()) >= night.scenes, 300)
        print(f"the night's scenes are asked for after {time.monotonic() - started:.0f} s", flush=True)
        EVENTS[event](night)
        done = night.wait(lambda: night.finished() >= len(night.known()), limit)
        took = time.monotonic() - started
        quiet = night.wait(lambda: not any(night.runs()[status.value] for status in UNFINISHED), 240)
        night.wait(lambda: len(night.told) >= night.runs()["FAILURE"], 90)
    finally:
        night.kill("everything")
    found, whole = night.known(), undisturbed(night.folder / "calm", night.known())
    equal = sum(digests(night.folder, key) == whole[key] for key in found)
    print(f"{len(found)} scenes, {night.finished()} finished after {took:.0f} s, in time: {done}")
    print(
        f"the night's {night.scenes} scenes and no others: {found == night.keys}; hashes equal: {equal} of {len(found)}"
    )
    print(f"no run is left unfinished: {quiet}; runs: {dict(night.runs())}")
    print(f"told to the webhook: {[(m['event'], m['scene'], m['error'][:80]) for m in night.told]}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("event", choices=EVENTS)
    parser.add_argument("--scenes", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=0.3, help="that a stage takes")
    parser.add_argument("--limit", type=float, default=1200.0, help="seconds that the night may take")
    arguments = parser.parse_args()
    folder = Path(tempfile.mkdtemp()) / "night"
    watch(Night(folder, arguments.scenes, arguments.seconds), arguments.event, arguments.limit)
    shutil.rmtree(folder.parent)


if __name__ == "__main__":
    main()
