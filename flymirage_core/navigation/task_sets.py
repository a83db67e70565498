"""Task sets (paper, section III-C): N_s sets of N_o targets, each accepted by the paper's four checks.

The checks themselves, and `generate_task_sets`, live here; planning the flights does not.
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Task:
    """Fly from ``start`` to ``target_point``, in front of the object. World frame, metres."""

    set_index: int
    leg_index: int
    object_id: int
    start: Point
    target_point: Point


TASK_SCHEMA = pa.schema(
    [
        ("set_index", pa.int32()),
        ("leg_index", pa.int32()),
        ("object_id", pa.int32()),
        ("start", pa.list_(pa.float64(), 3)),
        ("target_point", pa.list_(pa.float64(), 3)),
    ]
)


@dataclass(frozen=True)
class TaskSets:
    """All tasks in flying order: the start of a set's leg k+1 is the target point of its leg k.

    ``rejections`` counts why candidates were turned away: inside_box, occluded, unsafe_waypoint, distance.
    """

    tasks: tuple[Task, ...]
    rejections: dict[str, int]

    def __len__(self) -> int:
        return len(self.tasks)

    def __iter__(self) -> Iterator[Task]:
        return iter(self.tasks)

    def summary(self) -> dict[str, int | float]:
        counts = {f"rejected_{k}": v for k, v in self.rejections.items()}
        return {"task_sets": len({t.set_index for t in self}), "tasks": len(self), **counts}

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.Table.from_pylist([asdict(t) for t in self], schema=TASK_SCHEMA), folder / "tasks.parquet")
        counts = pa.table({"reason": list(self.rejections), "count": pa.array(self.rejections.values(), pa.int64())})
        pq.write_table(counts, folder / "rejections.parquet")

    @staticmethod
    def load(folder: Path) -> "TaskSets":
        rows = pq.read_table(folder / "tasks.parquet", schema=TASK_SCHEMA).to_pylist()
        tasks = tuple(Task(**{**r, "start": tuple(r["start"]), "target_point": tuple(r["target_point"])}) for r in rows)
        counts = pq.read_table(folder / "rejections.parquet").to_pylist()
        return TaskSets(tasks, {r["reason"]: r["count"] for r in counts})
