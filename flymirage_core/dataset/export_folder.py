"""The frame that all export formats share: a shard a scene, written once, linked ever after, and appearing whole.

Layout common to all formats::

    export.json                      format, options, scenes in order, data versions
    scenes/<scene>/shard.json        what the shard was made of, its files with sizes and checksums, its statistics
    scenes/<scene>/episodes.parquet  `EPISODE_SCHEMA`: all that is known of each episode
    scenes/<scene>/boxes.parquet     the scene's objects
    scenes/<scene>/prompts.parquet, long_prompts.parquet: all instructions, the latter over several flights of a set
    scenes/<scene>/camera.json       intrinsics, T_body_camera, frame rate
    conventions.json, statistics.json, README.md, CHANGELOG.md
"""

import json
import shutil
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import pyarrow.parquet as pq

from flymirage_core.dataset.card import dataset_card
from flymirage_core.dataset.changelog import DataVersion, changelog_text, scene_hash, with_next_version
from flymirage_core.dataset.conventions import conventions
from flymirage_core.dataset.episodes import EPISODE_SCHEMA, Episode, episodes_from, episodes_of, episodes_table
from flymirage_core.dataset.scene_products import SceneProducts, SceneSource
from flymirage_core.dataset.statistics import DatasetStatistics, SceneShare, statistics_of
from flymirage_core.errors import InputError, ProductError
from flymirage_core.files import link_or_copy
from flymirage_core.rendering.frames import CameraRig

EXPORT_VERSION = 2
INDEX_NAME = "export.json"
COMMON_FILES = ("boxes.parquet", "camera.json", "episodes.parquet", "long_prompts.parquet", "prompts.parquet")
"""Of a scene, in every format; its shard.json lists them with all its other files."""


@dataclass(frozen=True)
class Shard:
    """One scene's part of an export."""

    scene: str
    key: str  # hash of its products
    rig: CameraRig
    share: SceneShare
    place: dict[str, Any]  # where it lies, in the format's own terms
    files: dict[str, tuple[int, int]]  # path within the export -> bytes, crc32

    def save(self, folder: Path) -> None:
        data = {name: getattr(self, name) for name in ("scene", "key", "place", "files")}
        write_json(shard_folder(folder, self.scene) / "shard.json", {**data, "share": asdict(self.share)})

    @staticmethod
    def load(folder: Path, scene: str) -> "Shard":
        """Raises `ProductError` if it is missing or torn."""
        path = shard_folder(folder, scene) / "shard.json"
        try:
            data = json.loads(path.read_text())
            data["rig"] = CameraRig.load(path.with_name("camera.json"))
            data["share"] = SceneShare.from_dict(data["share"])
            data["files"] = {name: (size, crc) for name, (size, crc) in data["files"].items()}
            return Shard(**data)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ProductError(f"{path} is missing or torn ({error!r}); export again into an empty folder") from error

    def episodes(self, folder: Path) -> tuple[Episode, ...]:
        table = pq.read_table(shard_folder(folder, self.scene) / "episodes.parquet", schema=EPISODE_SCHEMA)
        return episodes_from(table)


@dataclass(frozen=True)
class ExportIndex:
    """``export.json``: which scenes an export holds, in what order, and its history."""

    format: str
    options: dict[str, Any]
    scenes: tuple[str, ...]
    versions: tuple[DataVersion, ...]

    def save(self, folder: Path) -> None:
        data = {"export_version": EXPORT_VERSION, **asdict(self)}
        write_json(folder / INDEX_NAME, data)

    @staticmethod
    def load(folder: Path) -> "ExportIndex":
        """Raises `InputError` if the folder is no export, `ProductError` if it is torn or of another version."""
        path = folder / INDEX_NAME
        if not path.is_file():
            raise InputError(f"{folder} is no FlyMirage export: {INDEX_NAME} is missing")
        try:
            data = json.loads(path.read_text())
            version = data.pop("export_version")
            versions = tuple(DataVersion.from_dict(v) for v in data.pop("versions"))
            index = ExportIndex(data["format"], data["options"], tuple(data["scenes"]), versions)
        except (ValueError, KeyError, TypeError) as error:
            raise ProductError(f"{path} is torn ({error!r}); export again into an empty folder") from error
        if version != EXPORT_VERSION:
            raise ProductError(f"{path} has version {version!r}, this FlyMirage reads {EXPORT_VERSION}; export again")
        return index


class Placed(NamedTuple):
    """What a format did with one scene."""

    place: dict[str, Any]  # where the scene lies, in the format's own terms; JSON
    files: list[str]  # paths within the export


class ExportFormat(Protocol):
    """What a format adds to the frame. ``before`` are the shards that precede one in the export's order."""

    @property
    def name(self) -> str: ...

    @property
    def options(self) -> dict[str, Any]:
        """What every shard depends on, besides its products."""
        ...

    def admit(self, rigs: Iterable[tuple[str, CameraRig]]) -> None:
        """Raise `InputError` if scenes with these cameras cannot share a folder."""
        ...

    def write(
        self, folder: Path, products: SceneProducts, episodes: tuple[Episode, ...], before: list[Shard]
    ) -> Placed:
        """Write one scene's files."""
        ...

    def keep(self, source: Path, folder: Path, shard: Shard, before: list[Shard]) -> Placed:
        """Bring an unchanged scene's files over; its place may be another than before."""
        ...

    def finish(self, folder: Path, shards: list[Shard]) -> dict[str, Any]:
        """Write what is of all scenes; returns what the format adds to conventions.json."""
        ...

    def header(self, shares: tuple[SceneShare, ...]) -> str:
        """What the format wants above the card in README.md, or ""."""
        ...

    def check(self, folder: Path, products: SceneProducts) -> int:
        """Hold a fresh scene's files against its products; returns in how many episodes the target is in the last
        picture. Raises `ProductError`."""
        ...


@dataclass(frozen=True)
class ExportReport:
    """What an export holds, and what this one wrote."""

    folder: Path
    statistics: DatasetStatistics
    written: tuple[str, ...]  # scenes
    kept: tuple[str, ...]
    bytes_of_shards: int
    targets_in_last_picture: int  # of the written scenes' episodes

    def summary(self) -> dict[str, str | int | float]:
        s = self.statistics
        return {
            "episodes": s.episodes,
            "frames": s.frames,
            "scenes_written": len(self.written),
            "scenes_kept": len(self.kept),
            "targets_in_last_picture": self.targets_in_last_picture,
            **{f"{split}_episodes": count for split, count in s.episodes_per_split.items() if count},
            "shards_mb": round(self.bytes_of_shards / 1e6, 2),
        }


def export(form: ExportFormat, sources: Iterable[SceneSource], folder: Path) -> ExportReport:
    """Make ``folder`` hold exactly the scenes of ``sources``: only new and changed ones are read and written.

    An unchanged scene's files are hard-linked from the earlier export (copied where the file system cannot). New
    scenes come after the known ones. The folder takes its name when it is whole and has passed the self-test. Raises
    `InputError` if there is no episode, if cameras differ, or if ``folder`` holds something else; `ProductError` if a
    product is torn, or the written folder does not pass the self-test.
    """
    by_scene = {source.scene: source for source in sources}
    folder = folder.absolute()
    with _appearing_whole(folder) as partial:
        known, versions = _known_shards(form, folder)
        order = [s for s in known if s in by_scene] + sorted(by_scene.keys() - known.keys())
        shards: list[Shard] = []
        written: list[str] = []
        for scene in order:
            shard = known.get(scene)
            if shard is not None and shard.key == scene_hash(by_scene[scene].data_versions):
                shards.append(_keep(form, folder, partial, shard, shards))
            else:
                shards.append(_write(form, partial, by_scene[scene].products(), shards))
                written.append(scene)
        _check_not_empty(shards)
        hashes = {shard.scene: shard.key for shard in shards}
        versions = with_next_version(versions, hashes, sum(s.share.counts.episodes for s in shards))
        _finish(form, partial, shards, versions)
        in_picture = sum(form.check(partial, by_scene[scene].products()) for scene in written)
    size = sum(size for shard in shards for size, _ in shard.files.values())
    kept = tuple(s for s in order if s not in written)
    return ExportReport(folder, statistics_of(s.share for s in shards), tuple(written), kept, size, in_picture)


def shard_folder(folder: Path, scene: str) -> Path:
    return folder / "scenes" / scene


def write_json(path: Path, value: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(value, indent=2) + "\n")


def crc32_of(path: Path) -> int:
    crc = 0
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            crc = zlib.crc32(block, crc)
    return crc


def _known_shards(form: ExportFormat, folder: Path) -> tuple[dict[str, Shard], tuple[DataVersion, ...]]:
    """The shards of the earlier export that can be kept: whole, and of the same options."""
    if not (folder / INDEX_NAME).exists():
        return {}, ()
    try:
        index = ExportIndex.load(folder)
    except ProductError:
        return {}, ()  # torn, or of an older version: everything is written again
    if index.format != form.name:
        raise InputError(
            f"{folder} is an export in the format {index.format!r}, {form.name!r} was asked for; choose another folder"
        )
    shards = {}
    for scene in index.scenes if index.options == form.options else ():
        try:
            shard = Shard.load(folder, scene)
        except ProductError:
            continue
        if all((folder / n).is_file() and (folder / n).stat().st_size == size for n, (size, _) in shard.files.items()):
            shards[scene] = shard
    return shards, index.versions


def _write(form: ExportFormat, folder: Path, products: SceneProducts, before: list[Shard]) -> Shard:
    rigs = [(s.scene, s.rig) for s in before if s.share.counts.episodes]
    episodes = tuple(episodes_of(products))
    if episodes:
        form.admit([*rigs, (products.scene, products.frames.rig)])
        products.frames.check()
    own = shard_folder(folder, products.scene)
    own.mkdir(parents=True)
    pq.write_table(episodes_table(episodes), own / "episodes.parquet")
    products.boxes.save(own)
    products.prompts.save(own)
    products.frames.rig.save(own / "camera.json")
    place, names = form.write(folder, products, episodes, before)
    names = sorted([*names, *common_files(products.scene)])
    files = {name: ((folder / name).stat().st_size, crc32_of(folder / name)) for name in names}
    share = SceneShare.of(products, episodes)
    shard = Shard(products.scene, scene_hash(products.data_versions), products.frames.rig, share, place, files)
    shard.save(folder)
    return shard


def _keep(form: ExportFormat, source: Path, folder: Path, shard: Shard, before: list[Shard]) -> Shard:
    link_files(source, folder, common_files(shard.scene))
    place, names = form.keep(source, folder, shard, before)
    files = {}
    for name in sorted([*names, *common_files(shard.scene)]):
        path, old = folder / name, source / name
        linked = name in shard.files and old.exists() and old.samefile(path)
        files[name] = shard.files[name] if linked else (path.stat().st_size, crc32_of(path))
    kept = Shard(shard.scene, shard.key, shard.rig, shard.share, place, files)
    kept.save(folder)
    return kept


def common_files(scene: str) -> list[str]:
    """What every format keeps of a scene, besides its shard.json."""
    return [f"scenes/{scene}/{name}" for name in COMMON_FILES]


def link_files(source: Path, folder: Path, names: Iterable[str]) -> None:
    """Give ``folder`` the named files of ``source`` under the same names."""
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        link_or_copy(source / name, folder / name)


def _finish(form: ExportFormat, folder: Path, shards: list[Shard], versions: tuple[DataVersion, ...]) -> None:
    shares = tuple(s.share for s in shards)
    own = conventions((s.scene, s.rig) for s in shards)
    write_json(folder / "conventions.json", {**own, **form.finish(folder, shards)})
    write_json(folder / "statistics.json", statistics_of(shares).as_dict())
    (folder / "CHANGELOG.md").write_text(changelog_text(versions))
    (folder / "README.md").write_text(form.header(shares) + dataset_card(shares, versions))
    ExportIndex(form.name, form.options, tuple(s.scene for s in shards), versions).save(folder)


def _check_not_empty(shards: list[Shard]) -> None:
    counts = statistics_of(s.share for s in shards)
    if not counts.episodes:
        raise InputError(
            f"there is nothing to export: {counts.flights} flights in {counts.scenes} scenes, {counts.dropped} dropped "
            f"by the verdict, {counts.kept_without_prompts} kept without an unambiguous prompt"
        )


@contextmanager
def _appearing_whole(folder: Path) -> Iterator[Path]:
    """A hidden folder beside ``folder`` that takes its name when the block ends well, and is removed otherwise."""
    partial, previous = folder.with_name(f".{folder.name}.partial"), folder.with_name(f".{folder.name}.previous")
    if previous.exists() and not folder.exists():
        previous.rename(folder)  # killed between the two renames below
    if folder.exists() and not (folder / INDEX_NAME).exists() and any(folder.iterdir()):
        raise InputError(f"{folder} is not empty and no FlyMirage export; choose another folder, or empty this one")
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
