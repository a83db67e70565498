"""Commands about what is there: status."""

from typing import Annotated

import typer

from flymirage_assets.cli.app import app, console, project_store


@app.command()
def status(
    scene: Annotated[str | None, typer.Argument(help="one scene, in detail")] = None,
    last: Annotated[int, typer.Option(min=1, help="how many scenes to show, the last by name")] = 20,
) -> None:
    """What is in the store."""
    from flymirage_assets.report import SCENE_PRODUCTS, products_table, scenes_table
    from resources.housekeeping import check_known

    store = project_store()
    if scene is not None:
        check_known(store, scene)
        console.print(products_table(store, scene))
        return
    keys = store.scenes()
    if not keys:
        console.print("no scene yet: `flymirage grow` or `flymirage import WORLD.spz --scene KEY`")
        return
    console.print(scenes_table(store, keys[-last:]))
    finished = len(store.scenes_with(SCENE_PRODUCTS[-1]))
    shown = f"; the last {last} are shown" if len(keys) > last else ""
    console.print(f"scenes: {len(keys)}, finished: {finished}{shown}")
