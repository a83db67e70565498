"""`WorldTruth`: what the embedded world model put where. For measuring and tests only: perception never reads it."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.worldgen.footprints import Solid

Point = tuple[float, float, float]


@dataclass(frozen=True)
class PlacedObject:
    """One object of the generated world. World frame, metres; ``yaw`` turns its x axis from world +x, radians."""

    object_id: int
    noun: str
    colour: str
    material: str
    state: str
    zone: str
    placement: str
    centre: Point
    size: Point  # full lengths along its own x, y, z
    yaw: float
    support: int  # object_id of what it stands on; -1 for the place itself
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

    @property
    def solid(self) -> Solid:
        """Its box."""
        return Solid(self.centre[0], self.centre[1], self.size[0], self.size[1], self.bottom, self.top, self.yaw)


@dataclass(frozen=True)
class Unplaced:
    """Objects that the description asks for and the place has no spot for."""

    noun: str
    count: int
    reason: str


@dataclass(frozen=True)
class FreeBox:
    """The clear inside of a space, floor to ceiling (of a tunnel: to its crown), world frame."""

    zone: str
    kind: str
    low: Point
    high: Point


@dataclass(frozen=True)
class WorldTruth:
    """All that is in a generated place: its spaces, what the building fills of them, the objects, and the centre c."""

    scene: str
    dimensions: Point  # of all spaces together
    centre: Point
    objects: tuple[PlacedObject, ...]
    unplaced: tuple[Unplaced, ...]
    spaces: tuple[FreeBox, ...]
    structure: tuple[Solid, ...]  # beams, posts, galleries, pipes
    openings: tuple[tuple[Point, Point], ...]  # lowest and highest corner of each window, door and doorway

    def is_free(self, points: ArrayLike) -> NDArray[np.bool_]:
        """(N,) True for world points (N, 3) inside of a space, and outside of every object's and beam's box."""
        p = np.atleast_2d(np.asarray(points, float))
        inside = np.zeros(len(p), bool)
        for space in self.spaces:
            inside |= ((p >= space.low) & (p <= space.high)).all(axis=1)
        for solid in (*self.structure, *(o.solid for o in self.objects)):
            local = (p[:, :2] - [solid.x, solid.y]) @ solid.axes.T
            within = (np.abs(local) <= np.array([solid.width, solid.depth]) / 2).all(axis=1)
            inside &= ~(within & (p[:, 2] >= solid.bottom) & (p[:, 2] <= solid.top))
        return inside

    def summary(self) -> dict[str, str | int | float]:
        return {"placed": len(self.objects), "unplaced": sum(u.count for u in self.unplaced)}

    def save(self, folder: Path) -> None:
        """``truth.json``."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "truth.json").write_text(json.dumps(asdict(self), indent=1) + "\n")

    @staticmethod
    def load(folder: Path) -> "WorldTruth":
        data = json.loads((folder / "truth.json").read_text())
        return WorldTruth(
            data["scene"],
            tuple(data["dimensions"]),
            tuple(data["centre"]),
            tuple(PlacedObject(**_tuples(o)) for o in data["objects"]),
            tuple(Unplaced(**u) for u in data["unplaced"]),
            tuple(FreeBox(**_tuples(s)) for s in data["spaces"]),
            tuple(Solid(**s) for s in data["structure"]),
            tuple((tuple(low), tuple(high)) for low, high in data["openings"]),
        )


def _tuples(row: dict[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value for name, value in row.items()}
