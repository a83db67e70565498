"""Commands that make scenes: demo, grow, make, rebuild."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from flymirage_assets.cli.app import app, console, progress_bars, project_settings, project_store
from flymirage_assets.cli.exports import gallery, lerobot
from flymirage_core.errors import FlyMirageError, InputError

if TYPE_CHECKING:
    from dagster import DagsterInstance

DEMO_SCENE = "demo"
DEMO_PLACE = ("leisure and hospitality venues", "cafe")
"""A room that is quickly built, with much to fly to."""
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
    category, subcategory = DEMO_PLACE
    store.register(SceneOrigin(scene=DEMO_SCENE, kind="generated", category=category, subcategory=subcategory))
    make_scenes([DEMO_SCENE])
    lerobot(out)
    index = gallery(out.parent / "gallery")
    console.print(products_table(store, DEMO_SCENE))
    products = Path(str(store.base)) / "products"
    console.print(
        f"products, each with a preview.jpg:  {products}\n"
        f"the data set (LeRobot v3.0):        {out.absolute()}\n"
        f"to look at, in a browser:           {index.absolute()}\n"
        "everything in the browser:          make dev"
    )


@app.command()
def grow(
    scenes: Annotated[int, typer.Option(min=1, help="how many scenes")] = 1,
    forever: Annotated[bool, typer.Option("--forever", help="scene after scene, until stopped")] = False,
) -> None:
    """Grow scenes through every product, unfinished ones first; each new one in the place that is rarest so far."""
    from flymirage_assets.growing import endless_scenes, next_scenes, post_report
    from flymirage_assets.report import scenes_table
    from flymirage_assets.runs import dagster_instance
    from flymirage_core.scene.taxonomy import taxonomy_named

    store, kinds = project_store(), taxonomy_named(project_settings().taxonomy)
    with dagster_instance() as instance:
        keys = endless_scenes(store, instance, kinds) if forever else next_scenes(store, instance, scenes, kinds)
        begun: list[str] = []
        try:
            grow_scenes(instance, _noting(_until_full(keys), begun))
        finally:
            report = post_report(instance, store, begun)
    console.print(scenes_table(store, begun[-20:]))
    console.print(f"{report.grown} grown, {report.failed} failed, ${report.usd:.2f} spent")


def _noting(keys: Iterable[str], begun: list[str]) -> Iterator[str]:
    for key in keys:
        begun.append(key)
        yield key


@app.command()
def make(scenes: Annotated[list[str], typer.Argument(help="scene keys")]) -> None:
    """Make what is missing or stale of scenes that are already known."""
    from flymirage_assets.report import products_table

    store = project_store()
    _check_known(scenes)
    make_scenes(scenes)
    for scene in scenes:
        console.print(products_table(store, scene))


@app.command()
def rebuild(
    scenes: Annotated[list[str] | None, typer.Argument(help="scene keys; all if none is given")] = None,
    stage: Annotated[str, typer.Option(help="only this stage and what follows from it, e.g. trajectories")] = "",
    stale: Annotated[bool, typer.Option("--stale/--all", help="only what is stale, or look at everything")] = True,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="show what is stale, why, and what it costs")] = False,
    background: Annotated[bool, typer.Option("--background", help="as a backfill of the daemon of `make dev`")] = False,
) -> None:
    """Make again what changed code, settings or inputs made stale; what turns out the same costs nothing."""
    from flymirage_assets.definitions import defs
    from flymirage_assets.report import stale_table
    from flymirage_assets.runs import launch_backfill
    from flymirage_assets.staleness import stage_specs, stale_products, with_followers

    settings, store = project_settings(), project_store()
    specs = stage_specs(defs)
    chosen = with_followers(specs, stage) if stage else specs
    keys = _check_known(scenes) if scenes else store.scenes()
    found = [s for s in stale_products(store, specs, settings, keys) if s.asset in {c.name for c in chosen}]
    console.print(stale_table(found, len(keys)))
    wanted = {key: [s.asset for s in found if s.scene == key] for key in sorted({s.scene for s in found})}
    if not stale:
        wanted = {key: [c.name for c in chosen] for key in keys}
    if dry_run or not wanted:
        return
    if background:
        assets = {asset for of_scene in wanted.values() for asset in of_scene}
        backfill = launch_backfill([c.name for c in chosen if c.name in assets], list(wanted))
        console.print(f"backfill {backfill}: {len(wanted)} runs are queued; `make dev` runs and shows them")
        return
    make_scenes(list(wanted), wanted)


def _check_known(scenes: list[str]) -> list[str]:
    from flymirage_core.scene.keys import check_scene_key

    store = project_store()
    for scene in scenes:
        if store.origin(check_scene_key(scene)) is None:
            raise InputError(
                f"scene {scene!r} is not known: `flymirage status` lists scenes, `flymirage grow` adds one"
            )
    return scenes


def make_scenes(keys: list[str], assets: "dict[str, list[str]] | None" = None) -> None:
    """Materialise the scenes one after another; raises `RunError` at the end if one failed."""
    from flymirage_assets.runs import dagster_instance

    with dagster_instance() as instance:
        grow_scenes(instance, keys, assets)


def grow_scenes(instance: "DagsterInstance", keys: Iterable[str], assets: "dict[str, list[str]] | None" = None) -> None:
    """Materialise scene after scene until there is none left or a reason to stop.

    Raises `RunError` at the end if one failed, and `StoppedError` at Ctrl-C: nothing half-made is ever read, and the
    next call carries on from the last finished product.
    """
    from flymirage_assets.runs import RunError, run_scene

    begun, failed = 0, list[str]()
    for key in keys:
        console.print(f"[bold]{key}[/bold]")
        begun += 1
        with progress_bars():
            outcome = run_scene(instance, key, (assets or {}).get(key, ()))
        if outcome.interrupted:
            raise StoppedError(f"stopped in the middle of {key}: run the command again to carry on from there")
        if outcome.error:
            failed.append(key)
            console.print(f"[red]failed[/red] {key}: {escape(outcome.error)}", soft_wrap=True)
        if outcome.stops_growth:
            break
    if failed:
        raise RunError(f"{len(failed)} of {begun} scenes failed: {', '.join(failed)}")


def _until_full(keys: Iterable[str]) -> Iterator[str]:
    """``keys`` while there is room for another scene; none is taken, and so claimed, that will not be begun."""
    from flymirage_assets.growing import why_stop

    settings, store, iterator = project_settings(), project_store(), iter(keys)
    while not (reason := why_stop(store, settings)):
        if (key := next(iterator, None)) is None:
            return
        yield key
    console.print(f"[yellow]stopped[/yellow] {escape(reason)}", soft_wrap=True)


class StoppedError(FlyMirageError):
    """Somebody pressed Ctrl-C."""
