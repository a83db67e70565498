"""The command line: the same Dagster assets on the same instance as the UI, in one process, with progress bars."""

import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from pydantic import ValidationError
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from flymirage_core.errors import FlyMirageError, InputError, WorldError
from flymirage_core.progress import listening
from flymirage_core.settings import Settings
from flymirage_core.splats.frames import Up

if TYPE_CHECKING:
    from resources.store import Store

app = typer.Typer(no_args_is_help=True, add_completion=False, help=__doc__, pretty_exceptions_enable=False)
export_app = typer.Typer(no_args_is_help=True, help="Write the finished scenes in a format that trainers load.")
app.add_typer(export_app, name="export")
console = Console()
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

    store = _store()
    store.register(SceneOrigin(scene=DEMO_SCENE, kind="generated"))
    _grow([DEMO_SCENE])
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

    store = _store()
    known = store.scenes()
    begun = [s for s in known if s.startswith("scene-") and store.current(SCENE_PRODUCTS[-1], s) is None]
    fresh = (key for i in itertools.count(1) if (key := f"scene-{i:04d}") not in known)
    keys = list(itertools.islice(itertools.chain(begun, fresh), scenes))
    for key in keys:
        store.register(SceneOrigin(scene=key, kind="generated"))
    _grow(keys)
    console.print(scenes_table(store, keys))


@app.command("import")
def import_(
    world: Annotated[Path, typer.Argument(help="a Gaussian-splat world: .spz or .ply")],
    scene: Annotated[str, typer.Option(help="the scene's key: lower-case letters, digits, '-' and '_'")],
    up: Annotated[Up, typer.Option(help="the file's up axis: auto, y, z or -y")] = "auto",
    scale: Annotated[float | None, typer.Option(help="metres per file unit; 1 if not given")] = None,
    title: Annotated[str, typer.Option(help="what people call the place")] = "",
    register_only: Annotated[bool, typer.Option("--register-only", help="do not make its products now")] = False,
) -> None:
    """Bring a world of your own and make its whole data set."""
    from flymirage_assets.report import products_table
    from flymirage_core.occupancy.doctor import examine
    from flymirage_core.scene.keys import check_scene_key
    from flymirage_core.splats.imports import import_world
    from resources.records import SceneOrigin

    check_scene_key(scene)
    settings = _settings()
    report = examine(import_world(world, up, scale, settings.cleaning), settings.occupancy)
    problems = [finding.sentence for finding in report.findings if finding.severity == "problem"]
    if problems:  # before anything is kept
        raise WorldError(f"{world} cannot be flown in: {' '.join(problems)}")
    store = _store()
    sha256 = store.keep_import(scene, world)
    store.register(
        SceneOrigin(
            scene=scene, kind="imported", title=title, file_name=world.name, file_sha256=sha256, up=up, scale=scale
        )
    )
    if register_only:
        _register_partition(scene)
        console.print(
            f"scene {scene!r} is registered: `make dev` shows it, `flymirage make {scene}` makes its products"
        )
        return
    _grow([scene])
    console.print(products_table(store, scene))


@app.command()
def make(scenes: Annotated[list[str], typer.Argument(help="scene keys")]) -> None:
    """Make what is missing or stale of scenes that are already known."""
    from flymirage_assets.report import products_table
    from flymirage_core.scene.keys import check_scene_key

    store = _store()
    for scene in scenes:
        if store.origin(check_scene_key(scene)) is None:
            raise InputError(
                f"scene {scene!r} is not known: `flymirage status` lists scenes, `flymirage grow` adds one"
            )
    _grow(scenes)
    for scene in scenes:
        console.print(products_table(store, scene))


@app.command()
def status(scene: Annotated[str | None, typer.Argument(help="one scene, in detail")] = None) -> None:
    """What is in the store."""
    from flymirage_assets.report import products_table, scenes_table
    from flymirage_core.scene.keys import check_scene_key

    store = _store()
    if scene is not None:
        console.print(products_table(store, check_scene_key(scene)))
        return
    keys = store.scenes()
    if not keys:
        console.print("no scene yet: `flymirage grow` or `flymirage import WORLD.spz --scene KEY`")
        return
    console.print(scenes_table(store, keys))


@export_app.command()
def lerobot(
    out: Annotated[Path, typer.Option(help="the folder to write")] = Path("data/lerobot"),
    depth: Annotated[str, typer.Option(help="png16 (lossless millimetres) or none")] = "png16",
) -> None:
    """LeRobot v3.0: video, depth, state, action, instructions."""
    from flymirage_assets.assets.dataset import check_exportable
    from flymirage_assets.runs import RunError, dagster_instance, run_export

    check_exportable(_store())
    with dagster_instance() as instance, _progress():
        outcome = run_export(instance, str(out.absolute()), depth)
    if outcome.error:
        raise RunError(outcome.error)
    console.print(f"[green]written[/green] {out.absolute()}")


@app.command()
def doctor(
    world: Annotated[Path, typer.Argument(help="a Gaussian-splat world: .spz or .ply")],
    up: Annotated[Up, typer.Option(help="the file's up axis: auto, y, z or -y")] = "auto",
    scale: Annotated[float | None, typer.Option(help="metres per file unit; 1 if not given")] = None,
) -> None:
    """Say whether a world can be flown in, what is wrong with it, and what to do."""
    from flymirage_assets.report import doctor_table
    from flymirage_core.occupancy.doctor import examine
    from flymirage_core.splats.imports import import_world

    settings = _settings()
    report = examine(import_world(world, up, scale, settings.cleaning), settings.occupancy)
    console.print(doctor_table(report))
    if any(f.severity == "problem" for f in report.findings):
        raise typer.Exit(1)


@app.command(hidden=True)
def home() -> None:
    """Print DAGSTER_HOME, made ready; `make dev` uses it."""
    from flymirage_assets.home import prepare_home

    sys.stdout.write(f"{prepare_home()}\n")


def _settings() -> Settings:
    try:
        return Settings()
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(str(part) for part in first["loc"])
        raise InputError(
            f"setting {field!r} is {first.get('input')!r}: {first['msg']}; it comes from flymirage.toml or from an "
            "environment variable that begins with FLYMIRAGE_"
        ) from error


def _store() -> "Store":
    from resources.store import open_store

    return open_store(_settings().store)


def _register_partition(scene: str) -> None:
    from flymirage_assets.runs import dagster_instance
    from flymirage_assets.stage import scenes

    with dagster_instance() as instance:
        instance.add_dynamic_partitions(str(scenes.name), [scene])


def _grow(keys: list[str]) -> None:
    from flymirage_assets.runs import RunError, dagster_instance, run_scene

    failed: dict[str, str] = {}
    with dagster_instance() as instance:
        for key in keys:
            console.print(f"[bold]{key}[/bold]")
            with _progress():
                outcome = run_scene(instance, key)
            if outcome.error:
                failed[key] = outcome.error
                console.print(f"[red]failed[/red] {key}: {escape(outcome.error)}", soft_wrap=True)
    if failed:
        raise RunError(f"{len(failed)} of {len(keys)} scenes failed: {', '.join(failed)}")


@contextmanager
def _progress() -> Iterator[None]:
    """One bar for each stage that reports; a finished stage leaves a line with its seconds."""
    bars = Progress(
        SpinnerColumn(finished_text="[green]✓[/green]"),
        TextColumn("{task.description}", justify="left"),
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=console,
    )
    tasks = {}

    def listen(what: str, done: int, total: int) -> None:
        if what not in tasks:
            tasks[what] = bars.add_task(what, total=total)
        bars.update(tasks[what], completed=done, total=total)

    with bars, listening(listen):
        yield


def main() -> None:
    """Run the command line; the project's own errors become one sentence and exit code 1."""
    try:
        app()
    except FlyMirageError as error:
        Console(stderr=True).print(f"[red]error:[/red] {escape(str(error))}", soft_wrap=True, highlight=False)
        raise SystemExit(1) from None


if __name__ == "__main__":
    main()
