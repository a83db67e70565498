"""The command that brings a world of one's own: import."""

from pathlib import Path
from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, project_settings, project_store
from flymirage_assets.cli.growth import make_scenes
from flymirage_core.errors import WorldError
from flymirage_core.splats.frames import Up


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
    settings = project_settings()
    report = examine(import_world(world, up, scale, settings.cleaning), settings.occupancy)
    problems = [finding.sentence for finding in report.findings if finding.severity == "problem"]
    if problems:  # before anything is kept
        raise WorldError(f"{world} cannot be flown in: {' '.join(problems)}")
    store = project_store()
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
    make_scenes([scene])
    console.print(products_table(store, scene))


def _register_partition(scene: str) -> None:
    from flymirage_assets.runs import dagster_instance
    from flymirage_assets.stage import scenes

    with dagster_instance() as instance:
        instance.add_dynamic_partitions(str(scenes.name), [scene])
