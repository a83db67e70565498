"""All scenes together: episodes, splits, statistics, exports, reader, validator. Knows products, not algorithms."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flymirage_core.dataset.torch_dataset import FlightDataset


def open(
    path: str | Path,
    split: str | None = None,
    scenes: Sequence[str] = (),
    delta_timestamps: Mapping[str, Sequence[float]] | None = None,
    *,
    rgb: bool = True,
    depth: bool = False,
    masks: bool = False,
) -> "FlightDataset":
    """A LeRobot export as a torch Dataset; see `FlightDataset`. Raises `InputError` if the folder is none, or has
    nothing of the ``split`` or ``scenes``."""
    from flymirage_core.dataset.torch_dataset import FlightDataset  # late: torch takes a second to load

    return FlightDataset(Path(path), split, scenes, delta_timestamps, rgb=rgb, depth=depth, masks=masks)
