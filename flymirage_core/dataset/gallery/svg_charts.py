"""Bar charts as inline SVG: they scale, print, and follow the page's colours. Knows nothing of what they mean."""

from collections.abc import Mapping
from html import escape

WIDTH, ROW, LABEL, VALUE = 480, 22, 210, 56
"""Pixels: of the chart, a bar's row, the names at its left, the numbers at its right."""
COLUMN_WIDTH, COLUMN_HEIGHT = 52, 150
"""Pixels: of a column and its gap, of the tallest column."""


def bars(title: str, values: Mapping[str, float], unit: str = "") -> str:
    """Horizontal bars, one for each name, in the order given."""
    most = max([*values.values(), 1e-9])
    room = WIDTH - LABEL - VALUE
    rows = []
    for i, (name, value) in enumerate(values.items()):
        y = i * ROW
        rows.append(
            f'<text x="{LABEL - 8}" y="{y + 15}" text-anchor="end">{escape(_short(name))}</text>'
            f'<rect x="{LABEL}" y="{y + 4}" width="{max(room * value / most, 1):.1f}" height="{ROW - 8}" rx="2"/>'
            f'<text x="{LABEL + room * value / most + 6:.1f}" y="{y + 15}" class="n">{value:g}{unit}</text>'
        )
    return _figure(title, WIDTH, max(len(values), 1) * ROW + 4, "".join(rows))


def paired_columns(title: str, ours: Mapping[str, float], theirs: Mapping[str, float], legend: tuple[str, str]) -> str:
    """Two columns (shares, 0..1) beside each other for each name."""
    most = max([*ours.values(), *theirs.values(), 1e-9])
    parts = []
    for i, name in enumerate(ours):
        for j, (value, kind) in enumerate(((ours[name], "ours"), (theirs.get(name, 0.0), "theirs"))):
            height = COLUMN_HEIGHT * value / most
            x = i * COLUMN_WIDTH + 6 + j * 19
            parts.append(
                f'<rect class="{kind}" x="{x}" y="{COLUMN_HEIGHT - height + 16:.1f}" width="17" height="{height:.1f}">'
                f"<title>{escape(name)}: {value:.1%}</title></rect>"
            )
            if value >= 0.005:
                y = COLUMN_HEIGHT - height + 12
                parts.append(f'<text class="n s" x="{x + 8}" y="{y:.1f}" text-anchor="middle">{100 * value:.0f}</text>')
        y = COLUMN_HEIGHT + 32
        parts.append(f'<text x="{i * COLUMN_WIDTH + 24}" y="{y}" text-anchor="middle">{escape(name)}</text>')
    y = COLUMN_HEIGHT + 48
    parts += [
        f'<rect class="{kind}" x="{6 + 150 * j}" y="{y}" width="12" height="12"/>'
        f'<text x="{24 + 150 * j}" y="{y + 11}">{escape(text)}</text>'
        for j, (kind, text) in enumerate(zip(("ours", "theirs"), legend, strict=True))
    ]
    return _figure(title, len(ours) * COLUMN_WIDTH + 12, COLUMN_HEIGHT + 64, "".join(parts))


def _figure(title: str, width: int, height: int, body: str) -> str:
    label = escape(title)
    return (
        f"<figure><figcaption>{label}</figcaption>"
        f'<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" aria-label="{label}">{body}'
        "</svg></figure>"
    )


def _short(name: str, most: int = 34) -> str:
    return name if len(name) <= most else name[: most - 1] + "…"
