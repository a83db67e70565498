"""The data set as a LeRobot v3.0 folder, written by hand with pyarrow and PyAV: one episode a flight.

RGB goes into mp4 files by copying packets, depth losslessly as 16-bit PNG into the tables. A scene has data, video and
episode files of its own; adding a scene adds files, and writes meta/info.json, stats.json and tasks.parquet anew.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from flymirage_core.dataset.card import hub_header
from flymirage_core.dataset.conventions import lerobot_conventions
from flymirage_core.dataset.episodes import Episode, long_prompts_of
from flymirage_core.dataset.export_check import check_lerobot
from flymirage_core.dataset.export_folder import (
    ExportReport,
    Placed,
    Shard,
    common_files,
    export,
    link_files,
    write_json,
)
from flymirage_core.dataset.lerobot_files import EpisodeWriter
from flymirage_core.dataset.lerobot_places import (
    all_tasks,
    empty_place,
    move_shard,
    moved_place,
    split_ranges,
    start_after,
)
from flymirage_core.dataset.lerobot_schema import INDEX_COLUMNS, features, info, modality, write_tasks
from flymirage_core.dataset.lerobot_stats import joint_statistics
from flymirage_core.dataset.scene_products import SceneProducts, SceneSource
from flymirage_core.dataset.splits import SPLITS
from flymirage_core.dataset.statistics import SceneShare
from flymirage_core.errors import InputError
from flymirage_core.rendering.frames import CameraRig


class DepthExport(Enum):
    """How depth goes into the export."""

    PNG16 = "png16"
    """Losslessly, as 16-bit PNG in millimetres, an `image` feature of the data tables."""
    NONE = "none"


def export_lerobot(scenes: Iterable[SceneSource], folder: Path, depth: DepthExport = DepthExport.PNG16) -> ExportReport:
    """Make ``folder`` a LeRobot v3.0 data set of exactly these scenes; see `export_folder.export` for what is reused.

    Raises `InputError` if there is no episode, if cameras differ, or if ``folder`` holds something else; `ProductError`
    if a product is torn, or the written folder does not pass the self-test.
    """
    return export(LeRobotFormat(depth), scenes, folder)


@dataclass(frozen=True)
class LeRobotFormat:
    """LeRobot v3.0. A scene's place: its first episode, frame and files in the whole, and its own counts."""

    depth: DepthExport = DepthExport.PNG16
    name: str = "lerobot"

    @property
    def options(self) -> dict[str, Any]:
        return {"depth": self.depth.value}

    def admit(self, rigs: Iterable[tuple[str, CameraRig]]) -> None:
        """One picture size and one whole frame rate in all scenes."""
        (first_scene, first), *others = rigs
        if not float(first.frame_rate).is_integer():
            raise InputError(
                f"scene {first_scene} was filmed at {first.frame_rate:g} Hz, but LeRobot takes whole frame rates only; "
                "set frames.rate to a whole number and materialise `frames` again"
            )
        for scene, rig in others:
            if _film(rig) != _film(first):
                raise InputError(
                    f"scene {scene} was filmed at {_film(rig)} and {first_scene} at {_film(first)}, but one LeRobot "
                    "folder holds one size and rate; export them apart, or materialise `frames` of one of them again"
                )

    def write(
        self, folder: Path, products: SceneProducts, episodes: tuple[Episode, ...], before: list[Shard]
    ) -> Placed:
        start = start_after(before)
        if not episodes:
            return Placed(empty_place(start), [])
        described, long_prompts = self._features(products.frames.rig), long_prompts_of(products, episodes)
        with EpisodeWriter(folder, products.frames.rig, described, start) as writer:
            for episode in sorted(episodes, key=lambda e: (SPLITS.index(e.split), e.flight_id)):
                writer.add(products, episode, long_prompts.get(episode.flight_id, ""))
        return writer.finish(products.scene)

    def keep(self, source: Path, folder: Path, shard: Shard, before: list[Shard]) -> Placed:
        place = moved_place(shard.place, start_after(before))
        if place == shard.place:
            names = [n for n in shard.files if n not in common_files(shard.scene)]
            link_files(source, folder, names)
            return Placed(place, names)
        return Placed(place, move_shard(source, folder, shard, place, self._features(shard.rig)))

    def finish(self, folder: Path, shards: list[Shard]) -> dict[str, Any]:
        filled = [s for s in shards if s.place["episodes"]]
        described = self._features(filled[0].rig)
        tasks = all_tasks(filled)
        counts = (sum(s.place["episodes"] for s in filled), sum(s.place["frames"] for s in filled), len(tasks))
        meta = folder / "meta"
        write_json(meta / "info.json", info(described, round(filled[0].rig.frame_rate), *counts, split_ranges(filled)))
        write_json(meta / "modality.json", modality())
        order = [n for n in described if n not in INDEX_COLUMNS] + list(INDEX_COLUMNS)
        write_json(meta / "stats.json", joint_statistics(folder, filled, order))
        write_tasks(tasks, meta / "tasks.parquet")
        return {"lerobot": lerobot_conventions()}

    def header(self, shares: tuple[SceneShare, ...]) -> str:
        return hub_header(shares)

    def check(self, folder: Path, products: SceneProducts) -> int:
        return check_lerobot(folder, products)

    def _features(self, rig: CameraRig) -> dict[str, Any]:
        return features(rig, self.depth is DepthExport.PNG16)


def _film(rig: CameraRig) -> str:
    return f"{rig.intrinsics.width}x{rig.intrinsics.height}, {rig.frame_rate:g} Hz"
