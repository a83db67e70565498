"""Kills, full disks, torn files: after a restart the store holds whole products only, the same as undisturbed ones.

    python benchmarks/crash.py --kills 100

Stages are stand-ins (tests/stand_in.py) that take a while; the command line, Dagster and the store are the real ones.
A round grows a scene in a process of its own that is killed (SIGKILL) at a random instant, again and again until it is
through. Whenever a process is dead, every product that the store calls current is read back and compared.
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from flymirage_core.errors import ProductError  # noqa: E402
from resources.records import SceneOrigin  # noqa: E402
from resources.store import Store, sha256_of  # noqa: E402

SECONDS = 0.05
"""That a stage takes."""


def flymirage(folder: Path, *arguments: str, **environment: str) -> subprocess.Popen[str]:
    """Start a command in a session of its own."""
    env = {k: v for k, v in os.environ.items() if not k.startswith(("FLYMIRAGE_", "DAGSTER_"))}
    paths = [str(ROOT / "tests"), str(ROOT), env.get("PYTHONPATH", "")]
    env |= {"PYTHONPATH": os.pathsep.join(paths), "STAND_IN_SECONDS": str(SECONDS), **environment}
    return subprocess.Popen(
        [sys.executable, "-m", "stand_in", *arguments],
        cwd=folder,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def store_of(folder: Path) -> Store:
    return Store(str(folder / ".flymirage" / "store"))


def digests(folder: Path, scene: str) -> dict[str, str]:
    """Content hash of every current product; raises if one is torn, or holds other bytes than its record says."""
    store, found = store_of(folder), {}
    for asset in store.assets():
        record = store.current(asset, scene)
        if record is None:
            continue
        path = store.folder(asset, scene)
        wrong = [name for name, entry in record.files.items() if sha256_of(path / name) != entry.sha256]
        if wrong:
            raise ProductError(f"{asset}: {wrong} hold other bytes than their record says")
        found[asset] = record.digest
    return found


def wait_or_kill(process: subprocess.Popen[str], seconds: float) -> bool:
    """True if the process was still alive after ``seconds`` and is dead now."""
    try:
        process.communicate(timeout=seconds)
        return False
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return True


def kill_rounds(folder: Path, wanted: int, expected: dict[str, str], usual: float, rng: random.Random) -> Counter[str]:
    """Kill ``wanted`` times over as many scenes as it takes."""
    counts: Counter[str] = Counter()
    while counts["kills"] < wanted:
        scene = folder / f"round-{counts['scenes grown']}"
        scene.mkdir()
        while True:
            process = flymirage(scene, "grow", "--scenes", "1")
            killed = wait_or_kill(process, rng.uniform(0.15, 1.0) * usual) if counts["kills"] < wanted else False
            if not killed:
                process.communicate()
            counts["kills"] += killed
            if killed and counts["kills"] % 10 == 0:
                print(f"    {counts['kills']} kills, wrong products seen: {counts['wrong products seen']}", flush=True)
            with contextlib.suppress(FileNotFoundError):
                seen = digests(scene, "scene-0001")
                counts["looks at the store"] += 1
                counts["wrong products seen"] += sum(expected[name] != digest for name, digest in seen.items())
                counts[f"kills with {len(seen):2d} products done"] += killed
            if not killed:
                break
        counts["scenes grown"] += 1
        counts["final hashes equal"] += digests(scene, "scene-0001") == expected
        counts["exit codes other than 0"] += process.returncode != 0
        print(f"    so far: {counts['kills']} kills, {counts['scenes grown']} scenes", flush=True)
        shutil.rmtree(scene)
    return counts


def torn_files(folder: Path, expected: dict[str, str]) -> str:
    """Cut a file of each product in half and a pointer too; one command mends all."""
    store = store_of(folder)
    for asset in store.assets():
        data = store.folder(asset, "scene-0001") / "data.bin"
        half = data.read_bytes()[: data.stat().st_size // 2]
        data.unlink()
        data.write_bytes(half)
    pointer = Path(str(store.base)) / "products" / "boxes" / "scene-0001" / "product.json"
    pointer.write_text(pointer.read_text()[:50])
    process = flymirage(folder, "make", "scene-0001")
    process.communicate()
    return f"exit {process.returncode}, hashes equal: {digests(folder, 'scene-0001') == expected}"


def twice_at_once(folder: Path, expected: dict[str, str]) -> str:
    """Two runs of the same partition at once."""
    origin = store_of(folder.parent / "calm").origin("scene-0001")
    assert isinstance(origin, SceneOrigin)
    store_of(folder).register(origin)
    both = [flymirage(folder, "make", "scene-0001") for _ in range(2)]
    for process in both:
        process.communicate()
    codes = [p.returncode for p in both]
    return f"exits {codes}, hashes equal: {digests(folder, 'scene-0001') == expected}"


def disk_full(expected: dict[str, str]) -> str:
    """A tmpfs that is full in the middle of the run, then has room."""
    folder = Path(tempfile.mkdtemp())
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=160k", "tmpfs", str(folder)], check=True)
    dagster = tempfile.mkdtemp()
    try:
        env = {"FLYMIRAGE_STORE": str(folder / "store"), "DAGSTER_HOME": dagster, "FLYMIRAGE_GROWTH__MIN_FREE_GB": "0"}
        first = flymirage(Path(dagster), "grow", "--scenes", "1", **env)
        said = first.communicate()[0]
        full = [line for line in said.splitlines() if "full" in line]
        left = Store(str(folder / "store"))
        done = [a for a in left.assets() if left.current(a, "scene-0001") is not None]
        subprocess.run(["mount", "-o", "remount,size=64m", str(folder)], check=True)
        second = flymirage(Path(dagster), "grow", "--scenes", "1", **env)
        second.communicate()
        found = {a: r.digest for a in left.assets() if (r := left.current(a, "scene-0001")) is not None}
        return (
            f"first exit {first.returncode} after {len(done)} products ({full[0][:110] if full else said[-300:]}); "
            f"with room: exit {second.returncode}, hashes equal: {found == expected}"
        )
    finally:
        subprocess.run(["umount", str(folder)], check=False)


def read_only(folder: Path) -> str:
    """A store on a file system that is mounted read-only."""
    mount = Path(tempfile.mkdtemp())
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", str(mount)], check=True)
    try:
        (mount / "store").mkdir()
        subprocess.run(["mount", "-o", "remount,ro", str(mount)], check=True)
        process = flymirage(folder, "grow", "--scenes", "1", FLYMIRAGE_STORE=str(mount / "store"))
        said = process.communicate()[0]
        return (
            f"exit {process.returncode}, traceback: {'Traceback' in said}, says: {said.strip().splitlines()[-1][:160]}"
        )
    finally:
        subprocess.run(["umount", str(mount)], check=False)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as base:
        calm = Path(base) / "calm"
        calm.mkdir()
        started = time.perf_counter()
        flymirage(calm, "grow", "--scenes", "1").communicate()
        usual = time.perf_counter() - started
        expected = digests(calm, "scene-0001")
        print(f"undisturbed: {len(expected)} products in {usual:.1f} s", flush=True)
        print(f"torn files: {torn_files(calm, expected)}", flush=True)
        together = Path(base) / "together"
        together.mkdir()
        print(f"two runs of one partition: {twice_at_once(together, expected)}", flush=True)
        if os.geteuid() == 0:
            print(f"read-only store: {read_only(together)}", flush=True)
            print(f"disk full: {disk_full(expected)}", flush=True)
        for name, count in kill_rounds(
            Path(base), arguments.kills, expected, usual, random.Random(arguments.seed)
        ).items():
            print(f"{name}: {count}", flush=True)


if __name__ == "__main__":
    main()
