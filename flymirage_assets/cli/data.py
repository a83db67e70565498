"""Commands about what is there: status, export."""

from pathlib import Path
from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, progress_bars, project_store

export_app = typer.Typer(no_args_is_help=True, help="Write the finished scenes in a format that trainers load.")
app.add_typer(export_app, name="export")


@app.command()
def status(scene: Annotated[str | None, typer.Argument(help="one scene, in detail")] = None) -> None:
    """What is in the store."""
    from flymirage_assets.report import products_table, scenes_table
    from flymirage_core.scene.keys import check_scene_key

    store = project_store()
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

    check_exportable(project_store())
    with dagster_instance() as instance, progress_bars():
        outcome = run_export(instance, str(out.absolute()), depth)
    if outcome.error:
        raise RunError(outcome.error)
    console.print(f"[green]written[/green] {out.absolute()}")
