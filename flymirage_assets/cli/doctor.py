"""Commands that examine: doctor; and the hidden one that `make dev` starts from."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, project_settings
from flymirage_core.splats.frames import Up


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

    settings = project_settings()
    report = examine(import_world(world, up, scale, settings.cleaning), settings.occupancy)
    console.print(doctor_table(report))
    if any(f.severity == "problem" for f in report.findings):
        raise typer.Exit(1)


@app.command(hidden=True)
def home() -> None:
    """Print DAGSTER_HOME, made ready; `make dev` uses it."""
    from flymirage_assets.home import prepare_home

    sys.stdout.write(f"{prepare_home()}\n")
