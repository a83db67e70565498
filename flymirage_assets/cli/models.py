"""Commands about the weights of others: models fetch, models list."""

from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, project_settings

models_app = typer.Typer(no_args_is_help=True, help="Optional weights that make annotation better; fetched once.")
app.add_typer(models_app, name="models")


@models_app.command()
def fetch(name: Annotated[str, typer.Argument(help="which: `flymirage models list` tells")]) -> None:
    """Fetch weights and check their SHA-256; from then on the annotator uses them."""
    from resources import models

    weights = models.weights_named(name)
    path = models.fetch(weights, project_settings().annotation)
    console.print(
        f"[green]fetched[/green] {path} ({path.stat().st_size / 1e6:.1f} MB, {weights.licence})", soft_wrap=True
    )


@models_app.command("list")
def list_() -> None:
    """What can be fetched, and what has been."""
    from resources import models

    settings = project_settings().annotation
    for weights in models.KNOWN.values():
        path = models.path_of(weights, settings)
        state = f"fetched: {path}" if path.exists() else "not fetched"
        console.print(f"{weights.name}  {weights.licence}  {state}", soft_wrap=True)
