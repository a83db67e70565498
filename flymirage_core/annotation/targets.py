"""Algorithm 1 of the paper, distance-aware target selection, and `Targets`, the product of the `targets` asset."""

from dataclasses import dataclass
from pathlib import Path

from flymirage_core.annotation.boxes import BoxMap, ObjectBox


@dataclass(frozen=True)
class Targets:
    """Objects to go and look at more closely, in the order in which Algorithm 1 took them; may be empty."""

    boxes: tuple[ObjectBox, ...]

    def summary(self) -> dict[str, str | int | float]:
        return {"targets": len(self.boxes), "labels": ", ".join(b.label for b in self.boxes)}

    def save(self, folder: Path) -> None:
        BoxMap(self.boxes).save(folder)

    @staticmethod
    def load(folder: Path) -> "Targets":
        return Targets(BoxMap.load(folder).boxes)
