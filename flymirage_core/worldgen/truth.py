"""`WorldTruth`: what the embedded world model put where. For measuring and tests only: perception never reads it."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class PlacedObject:
    """One object of the generated world. World frame, metres; ``yaw`` turns its x axis from world +x, radians."""

    object_id: int
    noun: str
    colour: str
    material: str
    placement: str
    centre: tuple[float, float, float]
    size: tuple[float, float, float]  # full lengths along its own x, y, z
    yaw: float
    support: int  # object_id of what it stands on; -1 for the room itself
    seed: int  # of its details

    @property
    def axes(self) -> NDArray[np.float64]:
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return np.array([[c, s], [-s, c]])  # (2, 2) its x and y axes, as rows

    @property
    def bottom(self) -> float:
        return self.centre[2] - self.size[2] / 2

    @property
    def top(self) -> float:
        return self.centre[2] + self.size[2] / 2


@dataclass(frozen=True)
class Unplaced:
    """Objects that the description asks for and the room has no place for."""

    noun: str
    count: int
    reason: str


@dataclass(frozen=True)
class WorldTruth:
    """All that is in a generated room: ``dimensions`` (x, y, z), the floor's middle at the origin, and the centre c."""

    scene: str
    dimensions: tuple[float, float, float]
    centre: tuple[float, float, float]
    objects: tuple[PlacedObject, ...]
    unplaced: tuple[Unplaced, ...]

    def summary(self) -> dict[str, str | int | float]:
        return {"placed": len(self.objects), "unplaced": sum(u.count for u in self.unplaced)}

    def save(self, folder: Path) -> None:
        """``truth.json``."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "truth.json").write_text(json.dumps(asdict(self), indent=1) + "\n")

    @staticmethod
    def load(folder: Path) -> "WorldTruth":
        data = json.loads((folder / "truth.json").read_text())
        objects = tuple(
            PlacedObject(**{**o, "centre": tuple(o["centre"]), "size": tuple(o["size"])}) for o in data["objects"]
        )
        return WorldTruth(
            data["scene"],
            tuple(data["dimensions"]),
            tuple(data["centre"]),
            objects,
            tuple(Unplaced(**u) for u in data["unplaced"]),
        )
