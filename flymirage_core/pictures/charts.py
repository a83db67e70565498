"""Small charts: quantities over time below each other, and values as colours. Knows nothing of what they mean."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.pictures.canvas import INK, PAPER, Colour, Picture, put_text

_GRID: Final[Colour] = (222, 220, 214)
_LIMIT: Final[Colour] = (205, 60, 45)
_LINE: Final[Colour] = (35, 100, 190)
_MARGIN: Final = (58, 22, 14, 24)  # pixels left, top, right, bottom of a panel
_TICKS: Final = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)


@dataclass(frozen=True, eq=False)
class Series:
    """One quantity over time, with limits drawn as dashed lines."""

    title: str
    values: NDArray[np.float64]  # (T,)
    limits: tuple[float, ...] = ()


def time_charts(times: ArrayLike, series: Sequence[Series], width: int, height: int) -> Picture:
    """Panels below each other over one time axis; ``width`` and ``height`` of a panel in pixels."""
    clock = np.asarray(times, float)
    return np.concatenate([_panel(clock, s, width, height) for s in series], axis=0)


def colours_of(values: ArrayLike, lowest: float, highest: float) -> list[Colour]:
    """One colour for each of (N,) values, from blue at ``lowest`` to red at ``highest``."""
    share = np.clip((np.asarray(values, float) - lowest) / (highest - lowest), 0, 1)
    coloured = cv2.applyColorMap((255 * share).astype(np.uint8)[:, None], cv2.COLORMAP_TURBO)[:, 0, ::-1]
    return [(int(r), int(g), int(b)) for r, g, b in coloured]


def colour_bar(title: str, lowest: float, highest: float, width: int) -> Picture:
    """The scale of `colours_of`, 30 pixels high, with its ends named."""
    bar = np.full((30, width, 3), PAPER, np.uint8)
    left, right = 16 + 9 * len(title), width - 60
    for x, colour in zip(range(left, right), colours_of(np.linspace(0, 1, max(right - left, 0)), 0, 1), strict=True):
        bar[8:22, x] = colour
    put_text(bar, title, (8, 20), 0.42)
    put_text(bar, f"{lowest:g}", (left - 14, 20), 0.42)
    put_text(bar, f"{highest:g}", (right + 6, 20), 0.42)
    return bar


def _panel(times: NDArray[np.float64], series: Series, width: int, height: int) -> Picture:
    panel = np.full((height, width, 3), PAPER, np.uint8)
    left, top, right, bottom = _MARGIN
    everything = np.concatenate([series.values, series.limits, [0.0]])
    low, high = float(everything.min()), float(everything.max()) * 1.08 + 1e-9
    end = max(float(times[-1]), 1e-9)

    def at(time: float, value: float) -> tuple[int, int]:
        x = left + (width - left - right) * time / end
        y = height - bottom - (height - top - bottom) * (value - low) / (high - low)
        return round(x), round(y)

    for value in _ticks(low, high, 4):
        cv2.line(panel, at(0, value), at(end, value), _GRID, 1)
        put_text(panel, f"{value:6.3g}", (4, at(0, value)[1] + 4), 0.36)
    for time in _ticks(0, end, 10):
        cv2.line(panel, at(time, low), at(time, high), _GRID, 1)
        put_text(panel, f"{time:g} s", (at(time, low)[0] - 8, height - 8), 0.36)
    for limit in series.limits:
        for start in np.arange(0, end, end / 40):
            cv2.line(panel, at(start, limit), at(start + end / 80, limit), _LIMIT, 1, cv2.LINE_AA)
    points = np.array([at(t, v) for t, v in zip(times, series.values, strict=True)], np.int32)
    cv2.polylines(panel, [points], False, _LINE, 2, cv2.LINE_AA)
    put_text(panel, series.title, (left, 15), 0.42, INK)
    return panel


def _ticks(low: float, high: float, most: int) -> list[float]:
    """Round numbers in [low, high], ``most`` or fewer."""
    step = next((t for t in _TICKS if (high - low) / t <= most), _TICKS[-1])
    return [float(step * n) for n in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1)]
