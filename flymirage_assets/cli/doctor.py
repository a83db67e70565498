"""Commands that examine: doctor; and the hidden one that `make dev` starts from."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, project_settings, project_store
from flymirage_assets.cli.costs import examine_services
from flymirage_core.splats.frames import Up


@app.command()
def doctor(
    world: Annotated[
        Path | None, typer.Argument(help="a Gaussian-splat world: .spz or .ply; the project itself if not given")
    ] = None,
    up: Annotated[Up, typer.Option(help="the file's up axis: auto, y, z or -y")] = "auto",
    scale: Annotated[float | None, typer.Option(help="metres per file unit; 1 if not given")] = None,
    services: Annotated[bool, typer.Option("--services", help="keys, models, balance, clock: by free calls")] = False,
) -> None:
    """Say whether a world can be flown in, or the project is in order; what is wrong, and what to do."""
    if services:
        examine_services()
        return
    if world is None:
        _examine_project()
        return
    from flymirage_assets.report import doctor_table
    from flymirage_core.occupancy.doctor import examine
    from flymirage_core.splats.imports import import_world

    settings = project_settings()
    report = examine(import_world(world, up, scale, settings.cleaning), settings.occupancy)
    console.print(doctor_table(report))
    if any(f.severity == "problem" for f in report.findings):
        raise typer.Exit(1)


def _examine_project() -> None:
    """Runs of dead processes are failed and their pool slots freed; the rest is only looked at."""
    import dagster as dg

    from flymirage_assets.growing import why_stop
    from flymirage_assets.home import close_dead_runs, prepare_home
    from flymirage_assets.report import SCENE_PRODUCTS, human_bytes
    from resources.housekeeping import collect_garbage

    settings, store = project_settings(), project_store()
    prepare_home()
    with dg.DagsterInstance.get() as instance:
        closed = close_dead_runs(instance)
    begun, finished = len(store.scenes()), len(store.scenes_with(SCENE_PRODUCTS[-1]))
    garbage = collect_garbage(store, 7 * 86_400, removing=False)
    console.print(f"store {store.base}: {begun} scenes, {finished} finished")
    console.print(
        f"runs whose process is gone: {closed}{', failed now: they carry on when run again' if closed else ''}"
    )
    console.print(f"old versions that `flymirage gc` would remove: {human_bytes(garbage.bytes)}")
    if reason := why_stop(store, settings):
        console.print(f"[yellow]{reason}[/yellow]", soft_wrap=True)
        raise typer.Exit(1)


@app.command(hidden=True)
def home() -> None:
    """Print DAGSTER_HOME, made ready; `make dev` uses it."""
    from flymirage_assets.home import prepare_home
    from flymirage_assets.runs import dagster_instance

    with dagster_instance():  # what a power cut left behind is tidied before the daemon starts
        sys.stdout.write(f"{prepare_home()}\n")
