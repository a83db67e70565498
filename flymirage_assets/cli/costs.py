"""`flymirage costs`: the ledger, for people and (`--json`) for programs; and what `doctor --services` says."""

import json
from dataclasses import asdict
from typing import Annotated

import typer
from rich.markup import escape
from rich.table import Table

from flymirage_assets.cli.app import app, console, project_settings, project_store


@app.command()
def costs(
    as_json: Annotated[bool, typer.Option("--json", help="lines for programs")] = False,
) -> None:
    """What the outside services cost: for each scene and model, this night, this month, in all."""
    from resources.services.account import Account

    settings = project_settings()
    ledger = Account(project_store(), "_costs", "_costs", settings.services).ledger
    lines = ledger.lines()
    if as_json:
        for line in lines:
            typer.echo(json.dumps(asdict(line)))
        return
    if not lines:
        console.print("nothing was spent: no outside service has been asked yet")
        return
    table = Table(show_footer=True)
    table.add_column("scene", "all")
    table.add_column("service")
    table.add_column("model")
    everything = ledger.spent()
    for name in ("calls", "input_tokens", "output_tokens", "images", "credits"):
        table.add_column(name.replace("_", " "), f"{getattr(everything, name)}", justify="right")
    table.add_column("usd", f"{everything.usd:.4f}", justify="right")
    table.add_column("unsettled", f"{everything.unsettled_usd:.4f}", justify="right")
    table.add_column("prices of")
    for line in lines:
        s = line.spent
        counts = (s.calls, s.input_tokens, s.output_tokens, s.images, s.credits)
        unsettled = f"{s.unsettled_usd:.4f}" if s.unsettled else ""
        table.add_row(
            line.scene, line.service, line.model, *map(str, counts), f"{s.usd:.4f}", unsettled, line.prices_of
        )
    console.print(table)
    budget = settings.services.budget
    night, month = ledger.spent(since=ledger.night_start()), ledger.spent(since=ledger.month_start())
    scenes = len({line.scene for line in lines})
    console.print(
        f"this night ${night.usd:.2f} of ${budget.night_usd:.2f}, this month ${month.usd:.2f} of "
        f"${budget.month_usd:.2f}; ${everything.usd / scenes:.2f} a scene over {scenes}"
    )
    if everything.unsettled:
        console.print(
            f"{everything.unsettled} calls (${everything.unsettled_usd:.2f}) are in flight or were never answered: "
            "they count at their worst"
        )


def examine_services() -> None:
    """What `flymirage doctor --services` says: readiness by free calls, and a scene's bill. Exits 1 on a problem."""
    from flymirage_assets.report import SEVERITY_STYLE
    from resources.services.checkup import check_services, scene_cost

    settings = project_settings()
    findings = Table(show_header=False, box=None)
    problems = 0
    for check in check_services(settings, project_store()):
        style = SEVERITY_STYLE[check.severity]
        findings.add_row(f"[{style}]{check.severity}[/{style}]", escape(check.sentence))
        problems += check.severity == "problem"
    console.print(findings)
    table = Table(title="one scene, US dollars", title_justify="left")
    for name in ("step", "arithmetic"):
        table.add_column(name)
    for name in ("least", "usual", "most"):
        table.add_column(name, justify="right")
    for line in scene_cost(settings):
        table.add_row(line.item, line.arithmetic, *(f"{usd:.3f}" for usd in (line.low, line.usual, line.high)))
    console.print(table)
    if problems:
        raise typer.Exit(1)
