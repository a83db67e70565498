"""The table of benchmarks/ANNOTATION.md, from the figures that `annotation.measure_worlds` wrote of each world."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

COLUMNS = ("R25_1", "P25_1", "R50_1", "R25_2", "P25_2", "R50_2", "P50_2")


def table(rows: Sequence[dict[str, Any]]) -> str:
    """Markdown: a line a world, then means, medians and pooled figures (every object, every box counts the same)."""
    head = ["world", "true", "boxes", *COLUMNS, "cm", "noun", "wrong", "colour/paint", "s", "MB", "prototype s", "R/P"]
    lines = [head, ["---"] * len(head), *(_line(r["category"].split(" / ")[-1], [r], np.mean) for r in rows)]
    lines += [_line("**mean**", rows, np.mean), _line("**median**", rows, np.median)]
    centres = float(np.average([r["cm_2"] for r in rows], weights=[r["matched"] for r in rows]))
    pooled = [{**r, **{c: _pooled(rows, c) for c in COLUMNS}, "cm_2": centres} for r in rows]
    lines.append(_line("**pooled**", pooled, np.mean))
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _pooled(rows: Sequence[dict[str, Any]], column: str) -> float:
    """A share over all worlds together: recalls over true objects, precisions over boxes."""
    weights = [r["true" if column.startswith("R") else f"judged_{column[-1]}"] for r in rows]
    return float(np.average([r[column] for r in rows], weights=weights)) if sum(weights) else math.nan


def _line(name: str, rows: Sequence[dict[str, Any]], middle: Callable[[Any], Any]) -> list[str]:
    def of(key: str) -> float:
        return float(middle([r[key] for r in rows if key in r] or [math.nan]))

    matched = max(sum(r["matched"] for r in rows), 1)
    named = sum(r["noun"] + r["family"] for r in rows) / matched
    wrong = max(0.0, 1 - named - sum(r["generic"] for r in rows) / matched)
    colours = "/".join(f"{sum(r[key] for r in rows) / matched:.2f}" for key in ("colour", "paint"))
    return [
        name,
        str(sum(r["true"] for r in rows)),
        str(sum(r["boxes"] for r in rows)),
        *(f"{of(c):.2f}" for c in COLUMNS),
        f"{of('cm_2'):.1f}",
        f"{named:.2f}",
        f"{wrong:.2f}",
        colours,
        f"{of('s_1'):.0f} + {of('s_2'):.0f}",
        f"{of('MB'):.0f}",
        f"{of('prototype_s'):.0f}",
        f"{of('prototype_R25'):.2f}/{of('prototype_P25'):.2f}",
    ]
