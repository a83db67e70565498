"""The validator: a sound export has no findings; each of twenty and more corruptions is found, file and row named."""

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from filmed_room import renamed, scene_products

from flymirage_core.dataset.export_folder import export
from flymirage_core.dataset.formats import FORMATS
from flymirage_core.dataset.lerobot import DepthExport, export_lerobot
from flymirage_core.dataset.lerobot_schema import DEPTH_KEY, RGB_KEY
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.dataset.validate import validate
from flymirage_core.errors import InputError
from flymirage_core.navigation.trajectories import Flight, Trajectories

DATA = "data/chunk-000/file-000.parquet"
EPISODES = "meta/episodes/chunk-000/file-000.parquet"
VIDEO = f"videos/{RGB_KEY}/chunk-000/file-000.mp4"
TABLE = "scenes/cafe/episodes.parquet"


def measured(flight: Flight) -> Flight:
    """The flight with a report of what its states really are."""

    def most(values: np.ndarray) -> float:
        return float(np.linalg.norm(values, axis=1).max())

    report = replace(
        flight.report,
        max_speed=most(flight.velocities),
        max_acceleration=most(flight.accelerations),
        max_body_rate=most(flight.body_rates),
        min_clearance=float(flight.clearances.min()),
    )
    return replace(flight, report=report)


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> list[SceneProducts]:
    cafe = scene_products(tmp_path_factory.mktemp("cafe"))
    cafe = replace(cafe, trajectories=Trajectories(tuple(measured(f) for f in cafe.trajectories)))
    return [cafe, renamed(cafe, "hall")]


@pytest.fixture(scope="module")
def sound(scenes: list[SceneProducts], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return export_lerobot(scenes, tmp_path_factory.mktemp("sound") / "out").folder


@pytest.fixture
def copy(sound: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(sound, tmp_path / "copy"))


def edit_json(name: str, change: Callable[[Any], None]) -> Callable[[Path], None]:
    def corrupt(folder: Path) -> None:
        data = json.loads((folder / name).read_text())
        change(data)
        (folder / name).write_text(json.dumps(data))

    return corrupt


def edit_rows(name: str, change: Callable[[list[dict[str, Any]]], Any]) -> Callable[[Path], None]:
    """Change rows of a table and write it back with its schema."""

    def corrupt(folder: Path) -> None:
        table = pq.read_table(folder / name)
        rows = table.to_pylist()
        rows = change(rows) or rows
        pq.write_table(pa.Table.from_pylist(rows, schema=table.schema), folder / name)

    return corrupt


def set_cell(row: int, column: str, value: Callable[[Any], Any]) -> Callable[[list[dict[str, Any]]], None]:
    def change(rows: list[dict[str, Any]]) -> None:
        rows[row][column] = value(rows[row][column])

    return change


def part(index: int, value: Callable[[float], float]) -> Callable[[list[float]], list[float]]:
    return lambda old: [value(v) if i == index else v for i, v in enumerate(old)]


def swap_depth(rows: list[dict[str, Any]]) -> None:
    rows[3][DEPTH_KEY], rows[20][DEPTH_KEY] = rows[20][DEPTH_KEY], rows[3][DEPTH_KEY]


def drop_column(name: str, column: str) -> Callable[[Path], None]:
    return lambda folder: pq.write_table(pq.read_table(folder / name).drop_columns([column]), folder / name)


def cut(name: str) -> Callable[[Path], None]:
    return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:-400])


def other_prompt(prompts: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{**prompts[0], "text": "Fly to the chair."}, *prompts[1:]]


CORRUPTIONS: dict[str, tuple[Callable[[Path], None], str, str, str]] = {
    # what was done: (how, the check that finds it, the file it must name, what the row must say)
    "a frame's row is lost": (edit_rows(DATA, lambda rows: rows[:5] + rows[6:]), "rows", "file-000.parquet", ""),
    "the total of episodes is wrong": (
        edit_json("meta/info.json", lambda d: d.update(total_episodes=7)),
        "counts",
        "meta/info.json",
        "total_episodes",
    ),
    "an episode is in two splits": (
        edit_json("meta/info.json", lambda d: d["splits"].update(val_unseen="0:1")),
        "counts",
        "meta/info.json",
        "episode 0",
    ),
    "a column is missing": (drop_column(DATA, "sim.imu"), "rows", DATA, "sim.imu"),
    "a time stamp slips": (
        edit_rows(DATA, set_cell(4, "timestamp", lambda t: t + 0.05)),
        "rows",
        DATA,
        "row 4, episode 0",
    ),
    "a task number is another episode's": (
        edit_rows(DATA, set_cell(7, "task_index", lambda t: 99)),
        "rows",
        DATA,
        "row 7, episode 0",
    ),
    "an episode does not end": (
        edit_rows(DATA, set_cell(14, "next.done", lambda d: not d)),
        "rows",
        DATA,
        "row 14, episode 0",
    ),
    "a quaternion is not normal": (
        edit_rows(DATA, set_cell(9, "observation.state", part(6, lambda w: 1.2 * w))),
        "states",
        DATA,
        "row 9, episode 0",
    ),
    "a position is not a number": (
        edit_rows(DATA, set_cell(2, "observation.state", part(0, lambda x: float("nan")))),
        "states",
        DATA,
        "row 2, episode 0",
    ),
    "an action's sign is turned": (
        edit_rows(DATA, set_cell(6, "action", part(0, lambda dx: -dx))),
        "states",
        DATA,
        "row 6, episode 0",
    ),
    "a pose jumps": (
        edit_rows(DATA, set_cell(8, "observation.state", part(1, lambda y: y + 0.5))),
        "states",
        DATA,
        "row 7, episode 0",
    ),
    "a velocity is in other units": (
        edit_rows(DATA, set_cell(20, "observation.state", part(7, lambda v: 100 * v + 1))),
        "feasibility",
        DATA,
        "row 20, episode 1",
    ),
    "the drone touches a wall": (
        edit_rows(DATA, set_cell(5, "sim.clearance", lambda c: -0.1)),
        "feasibility",
        DATA,
        "row 5, episode 0",
    ),
    "a depth picture is torn": (
        edit_rows(DATA, set_cell(3, DEPTH_KEY, lambda c: {**c, "bytes": c["bytes"][:40]})),
        "depth",
        DATA,
        "row 3, episode 0",
    ),
    "two depth pictures are exchanged": (edit_rows(DATA, swap_depth), "depth", DATA, "row 3, episode 0"),
    "a video is cut short": (cut(VIDEO), "videos", VIDEO, ""),
    "another picture is in a video": (
        lambda folder: other_picture(folder / VIDEO),
        "videos",
        VIDEO,
        "episode 0",
    ),
    "an episode's pictures begin a frame late": (
        edit_rows(EPISODES, set_cell(1, f"videos/{RGB_KEY}/from_timestamp", lambda t: t + 0.1)),
        "videos",
        EPISODES,
        "episode 1",
    ),
    "a target leaves the picture by word alone": (
        edit_rows(DATA, set_cell(10, "sim.target_in_picture", lambda s: 1 - s)),
        "targets",
        DATA,
        "row 10, episode 0",
    ),
    "the statistics are of other data": (
        edit_json("meta/stats.json", lambda d: d["action"]["mean"].__setitem__(0, 3.0)),
        "statistics",
        "meta/stats.json",
        "action",
    ),
    "the camera is another": (
        edit_json("conventions.json", lambda d: d["cameras"][0]["K"][0].__setitem__(0, 500.0)),
        "metadata",
        "conventions.json",
        "camera of cafe",
    ),
    "an episode is moved into training": (
        edit_rows(TABLE, set_cell(0, "split", lambda s: "train" if s != "train" else "val_seen")),
        "splits",
        TABLE,
        "row 0 (cafe/0000)",
    ),
    "a prompt fits two things": (
        edit_rows(TABLE, set_cell(1, "prompts", other_prompt)),
        "prompts",
        TABLE,
        "row 1 (cafe/0001)",
    ),
    "a licence is gone": (
        edit_rows(TABLE, set_cell(2, "licence", lambda s: "")),
        "licences",
        TABLE,
        "row 2 (cafe/0002)",
    ),
    "a box is somewhere else": (
        edit_rows(TABLE, set_cell(0, "box_centre", part(2, lambda z: z + 1))),
        "episode tables",
        TABLE,
        "row 0 (cafe/0000)",
    ),
    "an episode's row is lost": (edit_rows(TABLE, lambda rows: rows[:2]), "episode tables", TABLE, ""),
    "a bit of the boxes is flipped": (
        lambda folder: flip(folder / "scenes/hall/boxes.parquet"),
        "files",
        "scenes/hall/boxes.parquet",
        "",
    ),
}


def flip(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 3] ^= 4
    path.write_bytes(data)


def other_picture(path: Path) -> None:
    """The same file with one byte of its first picture changed: still whole, another picture."""
    data = bytearray(path.read_bytes())
    at = data.index(b"mdat") + 1200
    data[at] ^= 0x55
    path.write_bytes(data)


def test_a_sound_export_has_no_findings(sound: Path) -> None:
    report = validate(sound)
    assert [f.sentence for f in report.findings] == []
    assert report.is_sound and len(report.checks) == 14


def test_at_least_twenty_corruptions_are_listed() -> None:
    assert len(CORRUPTIONS) >= 20


@pytest.mark.parametrize("what", CORRUPTIONS)
def test_a_corruption_is_found_and_its_file_and_row_are_named(what: str, copy: Path) -> None:
    corrupt, check, file, row = CORRUPTIONS[what]
    corrupt(copy)
    found = [f for f in validate(copy).findings if f.check == check]
    assert any(file in f.sentence and row in f.row for f in found), [f.sentence for f in found]


@pytest.mark.parametrize("form", [f for f in FORMATS if f != "lerobot"])
def test_every_other_format_is_checked_too(form: str, scenes: list[SceneProducts], tmp_path: Path) -> None:
    folder = export(FORMATS[form](DepthExport.PNG16), scenes[:1], tmp_path / form).folder
    assert validate(folder).is_sound
    victim = next(p for p in sorted(folder.rglob("*")) if p.suffix in (".png", ".gz") or ".tfrecord" in p.name)
    flip(victim)
    if victim.name.startswith(("train", "val")):
        victim = next(folder.glob("*/content/*.gz"))
        flip(victim)
    assert str(victim.relative_to(folder)) in {f.file for f in validate(folder).findings}


def test_a_folder_that_is_no_export_is_refused_in_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is no FlyMirage export: export\.json is missing"):
        validate(tmp_path)
