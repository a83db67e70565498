"""Commands that make scenes: demo, grow, make."""

import itertools
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from flymirage_assets.cli.app import app, console, progress_bars, project_store
from flymirage_assets.cli.data import lerobot
from flymirage_core.errors import InputError

DEMO_SCENE = "demo"
SETTINGS_FILE = Path("flymirage.toml")
DEMO_SETTINGS = """\
# Written by `flymirage demo`: a data set for a laptop, 40 flights instead of the paper's 100, in smaller pictures.
# Every command in this folder reads it; delete it (or a line) for the defaults in flymirage_core/settings.py.
[tasks]
sets = 8

[frames]
width = 480
height = 360
"""


@app.command()
def demo(out: Annotated[Path, typer.Option(help="where the LeRobot folder goes")] = Path("data/lerobot")) -> None:
    """Grow one offline scene through every product and export it: no key, no GPU, a few minutes."""
    if not SETTINGS_FILE.exists():
        SETTINGS_FILE.write_text(DEMO_SETTINGS)
        console.print(f"wrote {SETTINGS_FILE}: 40 flights instead of the paper's 100, in smaller pictures")
    from flymirage_assets.report import products_table
    from resources.records import SceneOrigin

    store = project_store()
    store.register(SceneOrigin(scene=DEMO_SCENE, kind="generated"))
    make_scenes([DEMO_SCENE])
    lerobot(out)
    console.print(products_table(store, DEMO_SCENE))
    products = Path(str(store.base)) / "products"
    console.print(
        f"products, each with a preview.jpg:  {products}\n"
        f"the data set (LeRobot v3.0):        {out.absolute()}\n"
        f"videos to look at:                  {products / 'frames' / DEMO_SCENE}/*/0000/rgb.mp4\n"
        "everything in the browser:          make dev"
    )


@app.command()
def grow(scenes: Annotated[int, typer.Option(min=1, help="how many new scenes")] = 1) -> None:
    """Grow new scenes through every product; unfinished ones first."""
    from flymirage_assets.report import SCENE_PRODUCTS, scenes_table
    from resources.records import SceneOrigin

    store = project_store()
    known = store.scenes()
    begun = [s for s in known if s.startswith("scene-") and store.current(SCENE_PRODUCTS[-1], s) is None]
    fresh = (key for i in itertools.count(1) if (key := f"scene-{i:04d}") not in known)
    keys = list(itertools.islice(itertools.chain(begun, fresh), scenes))
    for key in keys:
        store.register(SceneOrigin(scene=key, kind="generated"))
    make_scenes(keys)
    console.print(scenes_table(store, keys))


@app.command()
def make(scenes: Annotated[list[str], typer.Argument(help="scene keys")]) -> None:
    """Make what is missing or stale of scenes that are already known."""
    from flymirage_assets.report import products_table
    from flymirage_core.scene.keys import check_scene_key

    store = project_store()
    for scene in scenes:
        if store.origin(check_scene_key(scene)) is None:
            raise InputError(
                f"scene {scene!r} is not known: `flymirage status` lists scenes, `flymirage grow` adds one"
            )
    make_scenes(scenes)
    for scene in scenes:
        console.print(products_table(store, scene))


def make_scenes(keys: list[str]) -> None:
    """Materialise the scenes one after another; raises `RunError` at the end if one failed."""
    from flymirage_assets.runs import RunError, dagster_instance, run_scene

    failed: dict[str, str] = {}
    with dagster_instance() as instance:
        for key in keys:
            console.print(f"[bold]{key}[/bold]")
            with progress_bars():
                outcome = run_scene(instance, key)
            if outcome.error:
                failed[key] = outcome.error
                console.print(f"[red]failed[/red] {key}: {escape(outcome.error)}", soft_wrap=True)
    if failed:
        raise RunError(f"{len(failed)} of {len(keys)} scenes failed: {', '.join(failed)}")
