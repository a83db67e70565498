"""The command about what the data set measures: stats."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from flymirage_assets.cli.app import app, console, project_store
from flymirage_core.errors import InputError

if TYPE_CHECKING:
    from flymirage_core.dataset.paper_figures import Figure


@app.command()
def stats(
    export: Annotated[Path | None, typer.Argument(help="an export's folder; without it the store is counted")] = None,
) -> None:
    """The data set's figures beside the paper's: lengths, objects, prompts, categories, what was kept."""
    from flymirage_core.dataset.paper_figures import TABLES, figures, share_of_tables, statistics_of_export
    from flymirage_core.dataset.statistics import statistics_of

    if export is not None:
        console.print(_table(str(export), figures(statistics_of_export(export))))
        return
    store = project_store()
    finished = store.scenes_with_all(tuple(TABLES))
    if not finished:
        raise InputError("there is nothing to count: no scene has all its products yet; run `flymirage grow`")
    shares = [share_of_tables(s, {asset: store.folder(asset, s) for asset in TABLES}) for s in finished]
    console.print(_table(str(store.base), figures(statistics_of(shares))))


def _table(title: str, lines: Iterable["Figure"]) -> Table:
    table = Table(title=title, title_justify="left")
    for name in ("figure", "here", "FlyMirage (paper and site)"):
        table.add_column(name)
    for line in lines:
        table.add_row(line.name, line.ours, line.paper)
    return table
