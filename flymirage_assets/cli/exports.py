"""Commands about the finished data set: export, validate, gallery."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from flymirage_assets.cli.app import app, console, progress_bars, project_store

export_app = typer.Typer(no_args_is_help=True, help="Write the finished scenes in a format that trainers load.")
app.add_typer(export_app, name="export")

Out = Annotated[Path | None, typer.Option(help="the folder to write; data/FORMAT, with one scene data/FORMAT-SCENE")]
Scenes = Annotated[list[str] | None, typer.Option("--scene", help="this scene alone; may be given again")]


@export_app.command()
def lerobot(
    out: Out = None,
    depth: Annotated[str, typer.Option(help="png16 (lossless millimetres) or none")] = "png16",
    scene: Scenes = None,
) -> None:
    """LeRobot v3.0: video, depth, state, action, instructions. Only new and changed scenes are written."""
    write_export("lerobot", out, scene, depth=depth)


@export_app.command()
def flymirage(out: Out = None, scene: Scenes = None) -> None:
    """The official release's folders: a folder a flight, CSV and JPEG, with lossless depth beside the JPEG."""
    write_export("flymirage", out, scene)


@export_app.command()
def vlnce(out: Out = None, scene: Scenes = None) -> None:
    """VLN-CE episodes for evaluation: an episode an instruction, json.gz for each split and each scene."""
    write_export("vlnce", out, scene)


@export_app.command()
def rlds(out: Out = None, scene: Scenes = None) -> None:
    """RLDS: TFRecord files that tensorflow_datasets loads; written without TensorFlow."""
    write_export("rlds", out, scene)


@export_app.command()
def transforms(out: Out = None, scene: Scenes = None) -> None:
    """A transforms.json a scene, with pictures and depth, for those who train splats."""
    write_export("transforms", out, scene)


@app.command()
def validate(export: Annotated[Path, typer.Argument(help="the folder of an export, in any format")]) -> None:
    """Check an export: counts, poses, videos, depth, prompts, splits, licences; names file and row of what is wrong."""
    from flymirage_core.dataset.validate import validate as check

    report = check(export)
    for finding in report.findings:
        console.print(f"[red]{finding.check}[/red]  {escape(finding.sentence)}", soft_wrap=True, highlight=False)
    if not report.is_sound:
        console.print(f"{len(report.findings)} findings in {export}")
        raise typer.Exit(1)
    console.print(
        f"[green]sound[/green] {export}: {report.format}, {len(report.checks)} checks: {', '.join(report.checks)}"
    )


@app.command()
def gallery(
    out: Annotated[Path, typer.Option(help="the folder to write")] = Path("data/gallery"),
    scene: Scenes = None,
) -> Path:
    """Pages to look at without a server: plots, each scene in 3D, videos of the flights with their prompts."""
    from flymirage_assets.assets.dataset import check_exportable, stored_scenes
    from flymirage_core.dataset.gallery.gallery import write_gallery
    from flymirage_core.splats.cloud import GaussianCloud
    from flymirage_core.splats.world import World

    store = project_store()
    check_exportable(store)

    def cloud_of(name: str) -> Callable[[], GaussianCloud]:
        return lambda: World.load(store.folder("world", name)).cloud

    scenes = stored_scenes(store, scene or ())
    index = write_gallery(((s, cloud_of(s.scene)) for s in scenes), out)
    console.print(f"[green]written[/green] {index.absolute()}: open it in a browser")
    return index


def write_export(form: str, out: Path | None, scenes: list[str] | None, **options: Any) -> Path:
    """Write one format through its Dagster asset; returns the folder."""
    from flymirage_assets.assets.dataset import check_exportable, stored_scenes
    from flymirage_assets.runs import RunError, dagster_instance, run_export

    store = project_store()
    check_exportable(store)
    stored_scenes(store, scenes or ())
    folder = (out or Path("data") / "-".join([form, *(scenes or ())])).absolute()
    with dagster_instance() as instance, progress_bars():
        outcome = run_export(instance, form, {"folder": str(folder), "scenes": scenes or [], **options})
    if outcome.error:
        raise RunError(outcome.error)
    console.print(f"[green]written[/green] {folder}")
    return folder
