"""The data set as a LeRobot v3.0 folder, written by hand with pyarrow and PyAV: one episode a flight.

RGB goes into mp4 files by copying packets, depth losslessly as 16-bit PNG into the tables. The folder appears under its
name only when it is whole and has passed the self-test.
"""

import json
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from flymirage_core.dataset.card import HUB_HEADER
from flymirage_core.dataset.column_stats import numeric_stats
from flymirage_core.dataset.conventions import conventions, lerobot_conventions
from flymirage_core.dataset.episodes import Episode, SceneProducts, episodes_of
from flymirage_core.dataset.export_check import check_export
from flymirage_core.dataset.lerobot_files import EpisodeWriter
from flymirage_core.dataset.lerobot_schema import INDEX_COLUMNS, features, info, modality, write_tasks
from flymirage_core.dataset.manifest import build_manifest
from flymirage_core.dataset.splits import SPLITS
from flymirage_core.errors import InputError
from flymirage_core.rendering.frames import CameraRig


class DepthExport(Enum):
    """How depth goes into the export."""

    PNG16 = "png16"
    """Losslessly, as 16-bit PNG in millimetres, an `image` feature of the data tables."""
    NONE = "none"


@dataclass(frozen=True)
class ExportReport:
    """What was written."""

    folder: Path
    episodes: int
    frames: int
    tasks: int
    splits: dict[str, int]
    bytes_by_kind: dict[str, int]  # data, videos, meta
    targets_in_last_picture: int  # episodes whose target's centre projects into their last frame

    def summary(self) -> dict[str, str | int | float]:
        sizes = {f"{kind}_mb": round(size / 1e6, 2) for kind, size in self.bytes_by_kind.items()}
        splits = {f"{split}_episodes": count for split, count in self.splits.items()}
        return {
            "episodes": self.episodes,
            "frames": self.frames,
            "tasks": self.tasks,
            "targets_in_last_picture": self.targets_in_last_picture,
            **splits,
            **sizes,
        }


def export_lerobot(
    scenes: Iterable[SceneProducts], folder: Path, depth: DepthExport = DepthExport.PNG16
) -> ExportReport:
    """Write all episodes to ``folder``, which is replaced if it is an earlier export.

    Episodes come in the order of splits, then scenes, then flights, so that each split is one range of episodes.
    Raises `InputError` if there is no episode, if cameras differ, or if ``folder`` holds something else; `ProductError`
    if a product is torn, or the written folder does not pass the self-test.
    """
    scenes = tuple(scenes)
    manifest = build_manifest(scenes)
    if not manifest.episodes:
        counts = manifest.statistics
        raise InputError(
            f"there is nothing to export: {counts.flights} flights in {counts.scenes} scenes, {counts.dropped} dropped "
            f"by the verdict, {counts.kept_without_prompts} kept without an unambiguous prompt"
        )
    rig = _common_rig(scenes)
    described = features(rig, depth is DepthExport.PNG16)
    for products in scenes:
        products.frames.check()
    with _appearing_whole(folder) as partial:
        splits: dict[str, int] = {}
        with EpisodeWriter(partial, rig, described) as writer:
            for split, products, episode in _ordered(scenes):
                writer.add(products, episode)
                splits[split] = splits.get(split, 0) + 1
        _write_meta(partial, writer, described, splits, rig)
        _write_json(partial / "conventions.json", {**_conventions(scenes), "lerobot": lerobot_conventions()})
        _write_json(partial / "statistics.json", manifest.statistics.as_dict())
        (partial / "README.md").write_text(HUB_HEADER + manifest.card())
        in_picture = check_export(partial, scenes)
    sizes = {kind: _size(folder / kind) for kind in ("data", "videos", "meta")}
    return ExportReport(folder, len(writer.rows), writer.frames, len(writer.tasks), splits, sizes, in_picture)


def _ordered(scenes: tuple[SceneProducts, ...]) -> Iterator[tuple[str, SceneProducts, Episode]]:
    for split in SPLITS:
        for products in scenes:
            yield from ((split, products, e) for e in episodes_of(products) if e.split == split)


def _common_rig(scenes: tuple[SceneProducts, ...]) -> CameraRig:
    """The one picture size and whole frame rate of all scenes with episodes."""
    rigs = {p.scene: p.frames.rig for p in scenes if any(episodes_of(p))}
    (first_scene, first), *others = rigs.items()
    if not float(first.frame_rate).is_integer():
        raise InputError(
            f"scene {first_scene} was filmed at {first.frame_rate:g} Hz, but LeRobot takes whole frame rates only; "
            "set frames.rate to a whole number and materialise `frames` again"
        )
    for scene, rig in others:
        if _film(rig) != _film(first):
            raise InputError(
                f"scene {scene} was filmed at {_film(rig)} and {first_scene} at {_film(first)}, but one LeRobot folder "
                "holds one size and rate; export them apart, or materialise `frames` of one of them again"
            )
    return first


def _film(rig: CameraRig) -> str:
    return f"{rig.intrinsics.width}x{rig.intrinsics.height}, {rig.frame_rate:g} Hz"


def _conventions(scenes: tuple[SceneProducts, ...]) -> dict[str, Any]:
    return conventions((p.scene, p.frames.rig) for p in scenes)


def _write_meta(
    folder: Path, writer: EpisodeWriter, described: dict[str, Any], splits: dict[str, int], rig: CameraRig
) -> None:
    ranges, first = {}, 0
    for split, count in splits.items():
        ranges[split], first = f"{first}:{first + count}", first + count
    counts = (len(writer.rows), writer.frames, len(writer.tasks))
    meta = folder / "meta"
    _write_json(meta / "info.json", info(described, round(rig.frame_rate), *counts, ranges))
    _write_json(meta / "modality.json", modality())
    numbers = {name: numeric_stats(values) for name, values in writer.numbers().items()}
    pictures = {name: counts.stats() for name, counts in writer.pictures.items()}
    order = [n for n in described if n not in INDEX_COLUMNS] + list(INDEX_COLUMNS)
    _write_json(meta / "stats.json", {name: {**numbers, **pictures}[name] for name in order})
    write_tasks(writer.tasks, meta / "tasks.parquet")
    writer.write_episodes(meta)


@contextmanager
def _appearing_whole(folder: Path) -> Iterator[Path]:
    """A hidden folder beside ``folder`` that takes its name when the block ends well, and is removed otherwise."""
    folder = folder.absolute()
    if folder.exists() and not (folder / "meta" / "info.json").exists() and any(folder.iterdir()):
        raise InputError(f"{folder} is not empty and no LeRobot export; choose another folder, or empty this one")
    partial, previous = folder.with_name(f".{folder.name}.partial"), folder.with_name(f".{folder.name}.previous")
    for leftover in (partial, previous):
        shutil.rmtree(leftover, ignore_errors=True)
    partial.mkdir(parents=True)
    try:
        yield partial
        if folder.exists():
            folder.rename(previous)
        partial.rename(folder)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    shutil.rmtree(previous, ignore_errors=True)


def _size(folder: Path) -> int:
    return sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())


def _write_json(path: Path, value: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(value, indent=2) + "\n")
