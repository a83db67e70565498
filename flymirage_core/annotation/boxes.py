"""Gravity-aligned oriented boxes of objects, and `BoxMap`, the product of both box assets."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import ArrayLike, NDArray

from flymirage_core.annotation.labels import UNKNOWN

SIZE_CLASSES: Final = (("small", 0.5), ("medium", 1.2), ("large", float("inf")))
"""Metres of the longest side up to which each holds."""
TALL: Final = 1.8
"""Height against the longer side, ..."""
LONG: Final = 2.5
"""... longer side against the others, ..."""
LOW: Final = 0.45
"""... and height against the longer side, at which a shape has a word."""


@dataclass(frozen=True)
class ObjectBox:
    """One object. World frame (z up), metres; ``yaw`` turns its x axis from world +x, counter-clockwise, radians."""

    object_id: int
    label: str  # a noun in lower case: "office chair"; "object" where nothing better is known
    centre: tuple[float, float, float]
    size: tuple[float, float, float]  # full lengths along the box's own x, y, z
    yaw: float
    score: float  # 0..1
    label_source: str  # what named it: "recogniser", "detector", "boxer"
    colour: str  # a basic colour name as seen: "dark green"; "" if not measured
    material: str  # a guess; "" if not measured
    supporting_frames: int  # pictures that saw it
    nearest_camera_distance: float  # metres, from the optical centre of the nearest supporting picture
    annotator: str  # name and version: "embedded 1", "boxer d364743"
    label_score: float = 0.0  # 0..1: how sure the label is; 0 where it is "object"

    @property
    def rotation(self) -> NDArray[np.float64]:
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])  # (3, 3) world from box

    @property
    def corners(self) -> NDArray[np.float64]:
        signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        return (signs * self.size) @ self.rotation.T + self.centre  # (8, 3)

    @property
    def size_class(self) -> str:
        """ "small", "medium" or "large", by the longest side."""
        return next(name for name, limit in SIZE_CLASSES if max(self.size) <= limit)

    @property
    def description(self) -> str:
        """What may be said of it in two or three words: "red stool"; of a thing without a name "tall brown object"."""
        shape = self._shape if self.label == UNKNOWN else ""
        return " ".join(word for word in (shape, self.colour, self.label) if word)

    @property
    def _shape(self) -> str:
        longer, shorter, height = max(self.size[:2]), min(self.size[:2]), self.size[2]
        if height > TALL * longer:
            return "tall"
        if longer > LONG * max(shorter, height):
            return "long"
        return "low" if height < LOW * longer else ""

    @property
    def top(self) -> float:
        return self.centre[2] + self.size[2] / 2

    @property
    def bottom(self) -> float:
        return self.centre[2] - self.size[2] / 2

    def to_local(self, points: ArrayLike) -> NDArray[np.float64]:
        """World points (..., 3) in the box's own frame: origin at its centre, axes along its sides."""
        return (np.asarray(points, float) - self.centre) @ self.rotation  # (..., 3)

    def contains(self, points: ArrayLike, margin: float = 0.0) -> NDArray[np.bool_]:
        """True (...,) where world points (..., 3) lie in the box grown by ``margin`` metres on each side."""
        return np.asarray((np.abs(self.to_local(points)) <= np.asarray(self.size) / 2 + margin).all(axis=-1))

    def distance(self, points: ArrayLike) -> NDArray[np.float64]:
        """Metres (...,) from world points (..., 3) to the box's surface; 0 inside."""
        outside = np.maximum(np.abs(self.to_local(points)) - np.asarray(self.size) / 2, 0.0)
        return np.asarray(np.linalg.norm(outside, axis=-1))


BOX_SCHEMA = pa.schema(
    [
        ("object_id", pa.int32()),
        ("label", pa.string()),
        ("centre", pa.list_(pa.float64(), 3)),
        ("size", pa.list_(pa.float64(), 3)),
        ("yaw", pa.float64()),
        ("score", pa.float64()),
        ("label_source", pa.string()),
        ("colour", pa.string()),
        ("material", pa.string()),
        ("supporting_frames", pa.int32()),
        ("nearest_camera_distance", pa.float64()),
        ("annotator", pa.string()),
        ("label_score", pa.float64()),
    ]
)


@dataclass(frozen=True)
class BoxMap:
    """The objects of a scene; ``boxes[i].object_id`` is unique and stays with the object through all later products."""

    boxes: tuple[ObjectBox, ...]

    def __len__(self) -> int:
        return len(self.boxes)

    def __iter__(self) -> Iterator[ObjectBox]:
        return iter(self.boxes)

    def by_id(self, object_id: int) -> ObjectBox:
        """The box with this id; KeyError if there is none."""
        for box in self.boxes:
            if box.object_id == object_id:
                return box
        raise KeyError(object_id)

    def summary(self) -> dict[str, str | int | float]:
        named = sum(b.label != UNKNOWN for b in self)
        by = ", ".join(sorted({b.annotator for b in self}))
        return {"objects": len(self), "named": named, "labels": len({b.label for b in self}), "annotator": by}

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.Table.from_pylist([asdict(b) for b in self], schema=BOX_SCHEMA), folder / "boxes.parquet")

    @staticmethod
    def load(folder: Path) -> "BoxMap":
        rows = pq.read_table(folder / "boxes.parquet", schema=BOX_SCHEMA).to_pylist()
        return BoxMap(tuple(ObjectBox(**{**r, "centre": tuple(r["centre"]), "size": tuple(r["size"])}) for r in rows))
