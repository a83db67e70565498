"""What Dagster and the store add to one real scene: the same products by plain library calls, and by a Dagster run.

    python benchmarks/overhead.py plain      # each stage's function, its product saved and loaded; nothing else
    python benchmarks/overhead.py dagster    # `flymirage make` of the same scene, its CPU time taken apart

The scene is that of `flymirage demo` and its settings, unless the environment has others. CPU time of this process,
imports not counted: they are the same. Content hashes of the products are printed in one word, so that both can be seen
to have made the same.
"""

import argparse
import functools
import hashlib
import inspect
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
os.environ |= {
    "FLYMIRAGE_TASKS__SETS": "8",
    "FLYMIRAGE_FRAMES__WIDTH": "480",
    "FLYMIRAGE_FRAMES__HEIGHT": "360",
    **os.environ,
}

from flymirage_assets import stage as staging
from flymirage_assets.cli.growth import DEMO_PLACE
from flymirage_core.settings import Settings
from resources.records import SceneOrigin
from resources.store import open_store
from resources.tools import choose_tools

SCENE = "demo"
spent: Counter[str] = Counter()
"""CPU seconds by what they were spent on; what is called within another is not counted twice."""
_open: list[float] = []


@contextmanager
def clock(what: str) -> Any:
    started = time.process_time()
    _open.append(0.0)
    yield
    took = time.process_time() - started
    spent[what] += took - _open.pop()
    if _open:
        _open[-1] += took


def timed(what: str, function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        with clock(what):
            return function(*arguments, **named)

    return call


def plain(folder: Path) -> None:
    """Every stage in turn, as somebody would call the library in a script."""
    stages: list[tuple[Callable[..., Any], tuple[str, ...]]] = []

    def note(**declared: Any) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
            stages.append((function, tuple(declared.get("sections", ()))))
            return function

        return decorate

    staging.product_asset = note  # before the stages' modules are imported
    from flymirage_assets.assets import navigation, scene_annotation, world_generation

    settings, store = Settings(), open_store(str(folder / "store"))
    store.register(origin())
    for assets in (
        world_generation.world_generation_assets,
        scene_annotation.scene_annotation_assets,
        navigation.navigation_assets,
    ):
        assets(settings)
    tools, words = choose_tools(settings), []
    for function, _ in stages:
        hints = inspect.get_annotations(function)
        with clock(function.__name__), store.scratch() as scratch:
            inputs = {name: hint.load(folder / name) for name, hint in hints.items() if name not in ("stage", "return")}
            product = function(staging.Stage(SCENE, settings, tools, store, scratch), **inputs)
            product.save(folder / function.__name__)
        words.append(word_of(folder / function.__name__))
    print(f"products {hashlib.sha256(''.join(words).encode()).hexdigest()[:12]}")


def by_dagster(folder: Path) -> None:
    """The same by `runs.run_scene`, which every command and every run of the daemon comes down to."""
    os.environ |= {"DAGSTER_HOME": str(folder / "dagster"), "FLYMIRAGE_STORE": str(folder / "store")}
    real = staging.product_asset
    staging.product_asset = lambda **declared: real(  # before the stages' modules are imported
        **{**declared, "draw": timed("pictures for the UI", declared["draw"])}
    )
    from flymirage_assets import definitions, runs
    from flymirage_assets.report import SCENE_PRODUCTS
    from resources.io_manager import ProductIOManager
    from resources.store import Store

    staging.ProductAsset._computed = timed("the stages' functions", staging.ProductAsset._computed)  # type: ignore
    staging.jpeg_under = timed("pictures for the UI", staging.jpeg_under)
    staging.check_results = timed("reading back", staging.check_results)
    Store.stage = timed("saving and hashing", Store.stage)  # type: ignore[method-assign]
    ProductIOManager.load_input = timed("loading inputs", ProductIOManager.load_input)  # type: ignore[method-assign]
    ProductIOManager.handle_output = timed("publishing", ProductIOManager.handle_output)  # type: ignore[method-assign]
    store = open_store(str(folder / "store"))
    store.register(origin())
    with runs.dagster_instance() as instance, clock("Dagster and the rest"):
        outcome = runs.run_scene(instance, SCENE)
    assert not outcome.error, outcome.error
    assert definitions.defs
    words = [word_of(store.folder(asset, SCENE)) for asset in SCENE_PRODUCTS]
    print(f"products {hashlib.sha256(''.join(words).encode()).hexdigest()[:12]}")


def origin() -> SceneOrigin:
    category, subcategory = DEMO_PLACE
    return SceneOrigin(scene=SCENE, kind="generated", category=category, subcategory=subcategory)


def word_of(folder: Path) -> str:
    """Hash of all files of a product, its picture for the UI left out."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != "preview.jpg")
    return "".join(hashlib.sha256(path.read_bytes()).hexdigest() for path in files)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("how", choices=("plain", "dagster"))
    how = parser.parse_args().how
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as name:
        (plain if how == "plain" else by_dagster)(Path(name))
    for what, seconds in spent.items():
        print(f"    {what:24s} {seconds:6.2f} CPU s")
    print(f"{how}: {sum(spent.values()):.2f} CPU s, {time.perf_counter() - started:.0f} s", flush=True)


if __name__ == "__main__":
    main()
