"""`validate`: read an export as a stranger would, and name the file and row of everything that is not as it should be.

What all formats have in common is checked here; LeRobot's tables, videos and depth in `validate_lerobot`.
"""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.dataset.episodes import EPISODE_SCHEMA, Episode, episodes_from
from flymirage_core.dataset.export_folder import ExportIndex, Shard, crc32_of, shard_folder
from flymirage_core.dataset.findings import QUATERNION_TOLERANCE, Finding, guarded
from flymirage_core.dataset.scene_products import BOXER_TERMS
from flymirage_core.dataset.splits import is_unseen_instruction, split_of
from flymirage_core.dataset.statistics import statistics_of
from flymirage_core.dataset.validate_lerobot import LEROBOT_CHECKS
from flymirage_core.errors import ProductError
from flymirage_core.language.reading import Outcome, read_back
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import StartPose

BOX_TOLERANCE = 1e-6
"""Metres between an episode's box and the same object's in boxes.parquet."""


@dataclass(frozen=True)
class ValidationReport:
    """What was checked and what was found; sound if nothing was."""

    folder: Path
    format: str
    checks: tuple[str, ...]
    findings: tuple[Finding, ...]

    @property
    def is_sound(self) -> bool:
        return not self.findings


def validate(folder: Path) -> ValidationReport:
    """Check an export of any format. Raises `InputError` if the folder is none, `ProductError` if its index is torn."""
    index = ExportIndex.load(folder)
    checks: dict[str, Callable[[Path], Iterator[Finding]]] = {
        "files": _files,
        "episode tables": _episode_tables,
        "splits": _splits,
        "licences": _licences,
        "prompts": _prompts,
        "metadata": _metadata,
        **(LEROBOT_CHECKS if index.format == "lerobot" else {}),
    }
    findings = [finding for name, check in checks.items() for finding in guarded(name, folder, check)]
    return ValidationReport(folder, index.format, tuple(checks), tuple(dict.fromkeys(findings)))


def _files(folder: Path) -> Iterator[Finding]:
    """Every file that a shard lists is there with its size and checksum."""
    for scene in ExportIndex.load(folder).scenes:
        for name, (size, crc) in Shard.load(folder, scene).files.items():
            path = folder / name
            if not path.is_file():
                yield Finding("files", name, "", f"is missing; scene {scene} lists it")
            elif path.stat().st_size != size:
                yield Finding("files", name, "", f"has {path.stat().st_size} bytes, {size} were written")
            elif crc32_of(path) != crc:
                yield Finding("files", name, "", "has another checksum than when it was written")


def _episode_tables(folder: Path) -> Iterator[Finding]:
    """Schema, counts, ids, boxes, unit quaternions."""
    seen: dict[str, str] = {}
    for shard, episodes in _scenes(folder):
        file = f"scenes/{shard.scene}/episodes.parquet"
        if len(episodes) != shard.share.counts.episodes:
            expected = shard.share.counts.episodes
            yield Finding("episode tables", file, "", f"has {len(episodes)} rows, shard.json counts {expected}")
        boxes = BoxMap.load(shard_folder(folder, shard.scene))
        for row, episode in enumerate(episodes):
            where = f"row {row} ({episode.episode_id})"
            if episode.episode_id in seen:
                yield Finding("episode tables", file, where, f"has the id of an episode of {seen[episode.episode_id]}")
            seen[episode.episode_id] = file
            norm = float(np.linalg.norm(episode.start_quaternion))
            if not abs(norm - 1) <= QUATERNION_TOLERANCE:
                yield Finding("episode tables", file, where, f"start_quaternion has norm {norm:.4f}, expected 1")
            yield from _box_findings(file, where, episode, boxes)


def _box_findings(file: str, where: str, episode: Episode, boxes: BoxMap) -> Iterator[Finding]:
    if not all(np.isfinite(v) and v > 0 for v in episode.box_size):
        yield Finding("episode tables", file, where, f"box_size is {episode.box_size}, expected positive metres")
    try:
        known = boxes.by_id(episode.object_id)
    except KeyError:
        yield Finding("episode tables", file, where, f"object {episode.object_id} is not in boxes.parquet")
        return
    if not np.allclose(known.centre, episode.box_centre, atol=BOX_TOLERANCE):
        yield Finding(
            "episode tables", file, where, f"box_centre is {episode.box_centre}, boxes.parquet has {known.centre}"
        )


def _splits(folder: Path) -> Iterator[Finding]:
    """Each episode is in the split that the rule gives it; so no scene held out is trained on."""
    for shard, episodes in _scenes(folder):
        for row, episode in enumerate(episodes):
            kind = "" if episode.category == "imported" else episode.subcategory
            expected: str = split_of(episode.scene, episode.set_index, kind)
            if expected == "train" and all(is_unseen_instruction(p.text) for p in episode.prompts):
                expected = "test_unseen_instruction"
            if episode.split != expected:
                file = f"scenes/{shard.scene}/episodes.parquet"
                where = f"row {row} ({episode.episode_id})"
                yield Finding("splits", file, where, f"is in {episode.split!r}, the rule says {expected!r}")


def _licences(folder: Path) -> Iterator[Finding]:
    """Every episode and the card state the terms; boxes by Boxer are non-commercial wherever they appear."""
    for shard, episodes in _scenes(folder):
        file = f"scenes/{shard.scene}/episodes.parquet"
        by_boxer = any(b.annotator.lower().startswith("boxer") for b in BoxMap.load(shard_folder(folder, shard.scene)))
        for row, episode in enumerate(episodes):
            where = f"row {row} ({episode.episode_id})"
            if not episode.licence.strip():
                yield Finding("licences", file, where, "states no licence")
            elif by_boxer and BOXER_TERMS not in episode.licence:
                yield Finding("licences", file, where, f"has boxes by Boxer and states {episode.licence!r}")
        if not shard.share.terms.strip():
            yield Finding("licences", f"scenes/{shard.scene}/shard.json", "share.terms", "states no licence")
    card = (folder / "README.md").read_text()
    for terms in {shard.share.terms for shard, _ in _scenes(folder)}:
        if terms not in card:
            yield Finding("licences", "README.md", "Terms", f"does not state {terms!r}")


def _prompts(folder: Path) -> Iterator[Finding]:
    """Each prompt, read back against all boxes of its scene from the flight's start, means its target alone."""
    for shard, episodes in _scenes(folder):
        file = f"scenes/{shard.scene}/episodes.parquet"
        resolver = None
        for row, episode in enumerate(episodes):
            where = f"row {row} ({episode.episode_id})"
            x, y, z = episode.start_position
            start = StartPose((x, y, z), episode.start_yaw)
            boxes = BoxMap.load(shard_folder(folder, shard.scene)) if resolver is None else ()
            resolver = Resolver(boxes, start) if resolver is None else resolver.seen_from(start)
            if not episode.prompts:
                yield Finding("prompts", file, where, "has no prompt")
            for prompt in episode.prompts:
                reading = read_back(prompt.text, resolver, episode.object_id)
                if reading.outcome is not Outcome.TARGET:
                    reason = reading.reason or reading.outcome.value
                    yield Finding("prompts", file, where, f"{prompt.text!r} is not resolved to its target: {reason}")


def _metadata(folder: Path) -> Iterator[Finding]:
    """conventions.json knows every scene's camera; statistics.json counts what is there."""
    shards = [shard for shard, _ in _scenes(folder)]
    conventions: dict[str, Any] = json.loads((folder / "conventions.json").read_text())
    cameras = {scene: camera for camera in conventions["cameras"] for scene in camera["scenes"]}
    for shard in shards:
        camera = cameras.get(shard.scene)
        if camera is None:
            yield Finding("metadata", "conventions.json", "cameras", f"names no camera for scene {shard.scene}")
        elif not np.allclose(camera["K"], shard.rig.intrinsics.matrix):
            yield Finding("metadata", "conventions.json", f"camera of {shard.scene}", "K differs from camera.json")
        elif not np.allclose(camera["T_body_camera"], shard.rig.T_body_camera):
            where = f"camera of {shard.scene}"
            yield Finding("metadata", "conventions.json", where, "T_body_camera differs from camera.json")
    found = json.loads((folder / "statistics.json").read_text())
    expected = json.loads(json.dumps(statistics_of(s.share for s in shards).as_dict()))
    for name, value in expected.items():
        if found.get(name) != value:
            yield Finding("metadata", "statistics.json", name, f"is {found.get(name)!r}, the shards say {value!r}")


def _scenes(folder: Path) -> Iterator[tuple[Shard, tuple[Episode, ...]]]:
    for scene in ExportIndex.load(folder).scenes:
        path = shard_folder(folder, scene) / "episodes.parquet"
        try:
            episodes = episodes_from(pq.read_table(path, schema=EPISODE_SCHEMA))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ProductError(f"{path.relative_to(folder)} cannot be read as episodes: {error}") from error
        yield Shard.load(folder, scene), episodes
