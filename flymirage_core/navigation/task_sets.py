"""`Task` and `TaskSets`, the product of the `task_sets` asset, and `generate_task_sets` (paper, section III-C).

The paper's four checks are in `target_checks`; planning the flights is not here.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final, get_args

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import ArrayLike, NDArray

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.navigation.flight_space import keep_clear
from flymirage_core.navigation.target_checks import Reason, TaskSpace, check_target, is_sensible_target
from flymirage_core.occupancy.grid import OccupancyGrid
from flymirage_core.occupancy.queries import sphere_is_clear
from flymirage_core.occupancy.search import nearest_free, reachable
from flymirage_core.settings import TaskSettings

Float64 = NDArray[np.float64]
Point = tuple[float, float, float]

STARTS_PER_SET: Final = 5
"""Starts that are tried until one leads to N_o targets."""
TRIED_PER_TARGET: Final = 4
"""A start is given up after this many targets for each of the N_o."""
START_TRIALS: Final = 50
"""Random free points that are tried until one is safe."""
NEARNESS: Final = 8.0
"""Metres: of two objects that served equally often, one that is this much nearer is drawn e times as often. Gentle; it
gives flights the paper's distribution of lengths."""
CENTRE_SEARCH: Final = 1.0
"""Metres round c in which a free point is looked for if c itself is too near to something."""


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


def generate_task_sets(
    grid: OccupancyGrid, boxes: BoxMap, centre: ArrayLike, settings: TaskSettings, generator: np.random.Generator
) -> TaskSets:
    """N_s sets of N_o targets, one after the other, each from where the last one ended.

    Set 0 starts at the scene's centre c (3,), or the nearest point to it where the drone has room; the others at random
    points that can be reached from there. Candidates are the boxes that are sensible targets; those that served least
    often come first, so that objects are used evenly, and of those near ones tend to. No object follows itself. After a
    target that nothing can follow another one is taken, and after a start without a whole set another start; if none
    has one, the longest is kept, and a set without any target is left out.

    Args:
        grid: not inflated.
        boxes: the scene's objects, ids unique.

    Raises:
        PlanningError: there is no room for the drone within `CENTRE_SEARCH` of c.
    """
    passable = keep_clear(grid, settings.passage_radius)
    home = nearest_free(passable, centre, CENTRE_SEARCH)
    space = TaskSpace(grid, passable, reachable(passable, home))
    draw = _Draw([box for box in boxes if is_sensible_target(box)], space, settings, generator)
    tasks: list[Task] = []
    for set_index in range(settings.sets):
        legs: list[Task] = []
        for trial in range(STARTS_PER_SET):
            drone = home if set_index == trial == 0 else _random_start(space, settings, generator)
            legs = max(legs, _one_set(set_index, drone, draw), key=len)
            if len(legs) == settings.targets_per_set:
                break
        draw.uses.update(leg.object_id for leg in legs)
        tasks += legs
    return TaskSets(tuple(tasks), draw.rejections)


class _Draw:
    """Draws the next target, and remembers how often each object served and why others were turned away."""

    def __init__(
        self, candidates: list[ObjectBox], space: TaskSpace, settings: TaskSettings, generator: np.random.Generator
    ) -> None:
        self.candidates, self.space, self.settings, self.generator = candidates, space, settings, generator
        self.uses: Counter[int] = Counter()
        self.rejections: dict[str, int] = dict.fromkeys(get_args(Reason), 0)

    def targets(self, drone: Float64, but: int | None) -> Iterator[tuple[ObjectBox, Float64]]:
        """Accepted objects other than ``but`` and their target points (3,), each sought when it is asked for."""
        for n in self._order(drone):
            box = self.candidates[n]
            if box.object_id == but:
                continue
            answer = check_target(box, drone, self.space, self.settings)
            if isinstance(answer, str):
                self.rejections[answer] += 1
            else:
                yield box, answer

    def _order(self, drone: Float64) -> NDArray[np.intp]:
        """Candidates as they are to be tried: by uses, then drawn one after the other with weights exp(-d / NEARNESS).

        Sorting by Gumbel noise plus log weights is such a draw without replacement.
        """
        centres = np.array([box.centre for box in self.candidates]).reshape(-1, 3)  # (B, 3)
        log_weights = -np.linalg.norm(centres - drone, axis=1) / NEARNESS
        uses = [self.uses[box.object_id] for box in self.candidates]
        return np.lexsort((-log_weights - self.generator.gumbel(size=len(centres)), uses))


def _one_set(set_index: int, start: Float64, draw: _Draw) -> list[Task]:
    """N_o targets from ``start``, found depth first; the longest chain that was tried if there is no whole one."""
    wanted = draw.settings.targets_per_set
    chain: list[Task] = []
    longest: list[Task] = []
    choices = [draw.targets(start, None)]  # the ways on from the start and from each target of the chain
    tried = 0
    while choices and len(longest) < wanted and tried < TRIED_PER_TARGET * wanted:
        target = next(choices[-1], None)
        if target is None:
            choices.pop()
            draw.uses.subtract(leg.object_id for leg in chain[-1:])
            del chain[-1:]
            continue
        tried += 1
        box, point = target
        drone = chain[-1].target_point if chain else _as_point(start)
        chain.append(Task(set_index, len(chain), box.object_id, drone, _as_point(point)))
        draw.uses[box.object_id] += 1
        choices.append(draw.targets(point, box.object_id))
        longest = max(longest, list(chain), key=len)
    draw.uses.subtract(leg.object_id for leg in chain)
    return longest


def _random_start(space: TaskSpace, settings: TaskSettings, generator: np.random.Generator) -> Float64:
    """The centre (3,) of a random reachable voxel, with nothing within the safety radius if there is such a one."""
    for _ in range(START_TRIALS):
        place = space.places[generator.integers(len(space.places))]
        point = space.grid.centre_of(np.unravel_index(place, space.reachable.shape))
        if sphere_is_clear(space.grid, point, settings.safety_radius):
            break
    return point


def _as_point(vector: Float64) -> Point:
    x, y, z = (float(value) for value in vector)
    return x, y, z
