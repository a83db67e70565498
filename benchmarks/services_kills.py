"""Two hundred scenes from words to world under fire: killed at random instants, answers lost, storms of 429, 5xx, cuts.

Each scene runs `describe -> image -> world` of profile `paper` in processes of its own against the fake services of
`tests/services`, through the same stages that Dagster runs. A process is killed (SIGKILL) at a random instant again and
again; then it may end in peace. Counted: how each process ended, and how often each scene's world was charged.

    python benchmarks/services_kills.py [scenes [seed]]
"""

import json
import multiprocessing
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flymirage_assets.stage import ProductAsset, Stage, upstream_digests
from flymirage_core.errors import FlyMirageError
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import SceneDescription
from flymirage_core.settings import Settings
from flymirage_core.splats.world import World
from resources.services.account import Account
from resources.store import Store

ROOT = Path(__file__).resolve().parents[1]
sys.path += [str(ROOT / "tests" / "services"), str(ROOT / "tests")]
KILLS_PER_SCENE = 3
ATTEMPTS = 12


@dataclass
class Outcome:
    """What became of one scene."""

    scene: str
    faults: list[str]
    kills: int = 0
    ends: Counter[str] = field(default_factory=Counter)  # of its processes
    complete: bool = False
    seconds: float = 0.0  # that its last process took
    sentences: list[str] = field(default_factory=list)
    killed_at: list[str] = field(default_factory=list)


def child(scene: str, environment: dict[str, str], told: Connection) -> None:
    """One process: carry the scene on, and tell how far it is; it ends with "complete" or one clear sentence."""
    os.environ.clear()
    os.environ.update(environment)
    settings = Settings()
    store = Store(settings.store)
    try:
        for name, (compute, tools, upstream) in STAGES.items():
            asset = ProductAsset(name, compute, no_picture, "1", ("cleaning",), tools, settings)
            inputs = {up: KINDS[up].load(store.folder(up, scene)) for up in upstream}
            digests = upstream_digests(store, scene, upstream)
            commit = asset.materialise(store, scene, inputs, digests, lambda _: None)
            if commit.staged is not None:
                store.publish(commit.staged, commit.record, commit.preview)
            told.send(("done", name))
        World.load(store.folder("world", scene))
        told.send(("complete", ""))
    except FlyMirageError as error:
        told.send((type(error).__name__, str(error)))
    except Exception as error:
        told.send(("crashed", f"{type(error).__name__}: {error}"))


def no_picture(*_: object, **__: object) -> NDArray[np.uint8]:
    return np.zeros((8, 8, 3), np.uint8)


def describe(stage: Stage) -> SceneDescription:
    return stage.tools.scene_writer.describe(stage.scene)


def paint(stage: Stage, description: SceneDescription) -> ScenePicture:
    return stage.tools.image_painter.paint(description)


def build(stage: Stage, description: SceneDescription, image: ScenePicture) -> World:
    return stage.tools.world_model.build(description, image)


STAGES: dict[str, tuple[Callable[..., Any], tuple[str, ...], tuple[str, ...]]] = {
    "description": (describe, ("scene_writer",), ()),
    "image": (paint, ("image_painter",), ("description",)),
    "world": (build, ("world_model",), ("description", "image")),
}
KINDS: dict[str, Any] = {"description": SceneDescription, "image": ScenePicture}


def run_process(outcome: Outcome, environment: dict[str, str], kill_after: float | None) -> None:
    """Start a process, kill it after some seconds or let it end; note how it ended."""
    processes = multiprocessing.get_context("forkserver")
    ours, theirs = processes.Pipe(duplex=False)
    process = processes.Process(target=child, args=(outcome.scene, environment, theirs))
    process.start()
    theirs.close()
    started = time.perf_counter()
    process.join(kill_after if kill_after is not None else 120)
    killed = process.is_alive()
    process.kill()
    process.join()
    told = []
    with suppress(EOFError):
        while ours.poll():
            told.append(ours.recv())
    stages = [text for kind, text in told if kind == "done"]
    if killed and not (told and told[-1][0] == "complete"):
        outcome.kills += 1
        outcome.ends["killed"] += 1
        outcome.killed_at.append(f"after {stages[-1]}" if stages else "before description")
        return
    kind, text = told[-1] if told else ("crashed", f"exit code {process.exitcode}")
    outcome.ends[kind] += 1
    outcome.complete = kind == "complete"
    outcome.seconds = time.perf_counter() - started
    if not outcome.complete:
        outcome.sentences.append(f"{kind}: {text}")


def switch_on_faults(services: "object", chance: random.Random) -> list[str]:
    """Some of the faults of the contract, for the next scene."""
    from fake_http import Reply

    marble, openai = services.marble, services.openai  # type: ignore[attr-defined]
    busy = Reply(429, {"detail": "Rate limit exceeded"}, {"retry-after": "0.05"})
    storm = openai.error(429, "Rate limit", "requests", "rate_limit_exceeded", **{"retry-after": "0.05"})
    faults = {
        "start's answer lost": lambda: marble.fail("worlds:generate", Reply(drop=True), after=True),
        "500 after acceptance": lambda: marble.fail("worlds:generate", Reply(500, {"request_id": "r"}), after=True),
        "503 before acceptance": lambda: marble.fail("worlds:generate", Reply(503, {"detail": "down"})),
        "429 storm at Marble": lambda: marble.fail("worlds:generate", busy, times=chance.randint(1, 4)),
        "429 storm at the LLM": lambda: openai.fail("chat", storm, times=chance.randint(1, 4)),
        "503 of the LLM": lambda: openai.fail("chat", openai.error(503, "down", "server_error", "x"), times=2),
        "description's answer lost": lambda: openai.fail("chat", Reply(drop=True), after=True),
        "picture's answer lost": lambda: openai.fail("images", Reply(drop=True), after=True),
        "polling drops": lambda: marble.fail("operations/", Reply(drop=True), times=3),
        "polling 500": lambda: marble.fail("operations/", Reply(500, {"detail": "x"}), times=2),
        "operations expire": lambda: setattr(marble, "expired_operation", True),
        "downloads are cut": lambda: setattr(marble, "cut_downloads", chance.randint(1, 3)),
        "addresses expire": lambda: setattr(marble, "expired_urls", 1),
        "listed late": lambda: setattr(marble, "listed_after", 0.6),
        "slow answers": lambda: marble.fail(
            "worlds:generate", Reply(200, {"operation_id": "x"}, delay=0.3, drop=True), after=True
        ),
    }
    marble.faults.clear()
    openai.faults.clear()
    marble.expired_operation, marble.cut_downloads, marble.expired_urls, marble.listed_after = False, 0, 0, 0.0
    chosen = chance.sample(sorted(faults), chance.randint(0, 3))
    for name in chosen:
        faults[name]()
    return chosen


def fly_through_fire(scenes: int, seed: int) -> dict[str, object]:
    from marble_files import originals_of
    from paper_services import paper_services
    from splat_worlds import box

    chance = random.Random(seed)
    outcomes: list[Outcome] = []
    ended: list[int] = []  # asked to end, it reports on the scenes so far
    signal.signal(signal.SIGTERM, lambda number, _: ended.append(number))
    with (
        tempfile.TemporaryDirectory(dir=memory if (memory := Path("/dev/shm")).exists() else None) as folder,
        paper_services(originals_of(box([-2, -2, 0], [2, 2, 2.6], step=0.4))) as services,
    ):
        services.marble.balance = 1e9
        services.marble.seconds_until_done = 0.2
        services.marble.contract = None  # the tests check it; here it only costs time
        environment = {
            **{k: v for k, v in os.environ.items() if not k.startswith("FLYMIRAGE_")},
            **services.environment(
                {
                    "OPENAI_API_KEY": "sk-canary-1",
                    "DASHSCOPE_API_KEY": "sk-canary-2",
                    "WORLDLABS_API_KEY": "wl-canary-3",
                }
            ),
            "FLYMIRAGE_STORE": f"{folder}/store",
            "FLYMIRAGE_SERVICES__BUDGET__NIGHT_USD": "100000",
            "FLYMIRAGE_SERVICES__BUDGET__MONTH_USD": "100000",
            "FLYMIRAGE_SERVICES__MARBLE__LOST_START_WAIT": "0.5",
            "FLYMIRAGE_SERVICES__MARBLE__POLL_SECONDS": "0.05",
            "FLYMIRAGE_SERVICES__MARBLE__RESUBMIT_AFTER_LOST_START": "auto",
            "OMP_NUM_THREADS": "1",
        }
        for i in range(scenes):
            outcome = Outcome(f"scene-{i:04d}", switch_on_faults(services, chance))
            if ended:
                break
            for attempt in range(ATTEMPTS):
                is_killed = attempt < KILLS_PER_SCENE and chance.random() < 0.85
                usual = float(np.median([o.seconds for o in outcomes[-9:]])) if outcomes else 2.0
                try:
                    run_process(outcome, environment, chance.uniform(0.0, 1.1 * usual) if is_killed else None)
                except EOFError:  # the signal ended the server that forks, too
                    if not ended:
                        raise
                    break
                if outcome.complete:
                    break
            outcomes.append(outcome)
            print(f"{i + 1:3d} {outcome.scene} {dict(outcome.ends)} {outcome.faults}", flush=True)
        return report(outcomes, services, Path(folder))


def report(outcomes: list[Outcome], services: "object", folder: Path) -> dict[str, object]:
    marble = services.marble  # type: ignore[attr-defined]
    settings = Settings(store=f"{folder}/store")
    ledger = Account(Store(settings.store), "_", "_", settings.services).ledger
    names = {made.body["display_name"].removeprefix("flymirage ") for made in marble.worlds.values()}
    worlds = Counter(made.body["display_name"].removeprefix("flymirage ") for made in marble.worlds.values())
    booked = ledger.spent(asset="world")
    return {
        "scenes": len(outcomes),
        "complete": sum(o.complete for o in outcomes),
        "worlds charged": len(marble.worlds),
        "scenes charged exactly once": sum(worlds[o.scene] == 1 for o in outcomes),
        "scenes charged twice or more": sum(count > 1 for count in worlds.values()),
        "scenes with a world": len(names),
        "credits charged by Marble": sum(made.credits for made in marble.worlds.values()),
        "credits in the ledger": booked.credits,
        "unsettled worlds in the ledger": booked.unsettled,
        "processes": sum(sum(o.ends.values()) for o in outcomes),
        "processes killed": sum(o.kills for o in outcomes),
        "ends": dict(sum((o.ends for o in outcomes), Counter())),
        "killed at": dict(Counter(at for o in outcomes for at in o.killed_at)),
        "faults": dict(Counter(f for o in outcomes for f in o.faults)),
        "crashes": [s for o in outcomes for s in o.sentences if o.ends["crashed"]][:5],
        "sentences": dict(Counter(s.split(":")[0] for o in outcomes for s in o.sentences)),
        "contract violations": marble.violations[:5],
    }


if __name__ == "__main__":
    multiprocessing.get_context("forkserver").set_forkserver_preload(["flymirage_assets.stage", "resources.tools"])
    started = time.perf_counter()
    scenes, seed = (int(argument) for argument in (*sys.argv[1:], *("200", "7")[len(sys.argv) - 1 :]))
    summary = fly_through_fire(scenes, seed)
    summary["seconds"] = round(time.perf_counter() - started)
    print(json.dumps(summary, indent=1))
