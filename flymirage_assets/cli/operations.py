"""Commands that keep house: gc, remove."""

from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, project_store


@app.command()
def gc(
    days: Annotated[float, typer.Option(min=0, help="keep what was made in so many days")] = 7.0,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="only say what would go")] = False,
) -> None:
    """Remove versions of products that are no longer current, and what killed processes left behind."""
    from flymirage_assets.report import human_bytes
    from resources.housekeeping import collect_garbage

    freed = collect_garbage(project_store(), days * 86_400, removing=not dry_run)
    console.print(f"{'would free' if dry_run else 'freed'} {human_bytes(freed.bytes)} in {freed.folders} folders")


@app.command()
def remove(
    scene: Annotated[str, typer.Argument(help="the scene's key")],
    yes: Annotated[bool, typer.Option("--yes", help="do not ask")] = False,
) -> None:
    """Remove a scene everywhere: its products, its world file, paid answers, and its runs in Dagster."""
    from flymirage_assets.report import human_bytes
    from flymirage_assets.runs import dagster_instance, forget_scene
    from resources.housekeeping import check_known, remove_scene

    store = project_store()
    check_known(store, scene)
    if not yes:
        typer.confirm(f"remove scene {scene!r} with all its products?", abort=True)
    freed = remove_scene(store, scene)
    with dagster_instance() as instance:
        runs = forget_scene(instance, scene)
    console.print(
        f"removed scene {scene!r}: {human_bytes(freed.bytes)} in {freed.folders} folders, {runs} runs; "
        "exported data sets keep it until the next `flymirage export`"
    )
