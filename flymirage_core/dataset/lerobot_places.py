"""Where a scene lies in a LeRobot folder, and moving it: episodes, frames, files and tasks are numbered without a gap.

When an earlier scene goes or changes its size, those behind it are numbered anew: their tables are copied with other
index columns, their videos are linked under another name, and no picture is touched.
"""

from collections.abc import Iterable
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from flymirage_core.dataset.column_stats import numeric_stats
from flymirage_core.dataset.export_folder import Shard
from flymirage_core.dataset.lerobot_schema import (
    CHUNKS_SIZE,
    DATA_PATH,
    EPISODES_PATH,
    RGB_KEY,
    VIDEO_PATH,
    data_schema,
    episode_schema,
)
from flymirage_core.dataset.lerobot_stats import PLACED, SKETCH_NAME
from flymirage_core.dataset.splits import SPLITS
from flymirage_core.files import link_or_copy


class Start(NamedTuple):
    """What the next scene's numbers begin with."""

    first_episode: int
    first_frame: int
    first_data_file: int
    first_video_file: int
    episode_file: int
    tasks: tuple[str, ...]  # known so far; a text's place is its task_index


def start_after(before: list[Shard]) -> Start:
    places = [s.place for s in before]
    sums = (sum(p[name] for p in places) for name in ("episodes", "frames", "data_files", "video_files"))
    episode, frame, data, video = sums
    return Start(episode, frame, data, video, sum(p["episodes"] > 0 for p in places), tuple(all_tasks(before)))


def all_tasks(shards: Iterable[Shard]) -> list[str]:
    """Every training prompt once, in the order of first use: its place is its task_index."""
    return list(dict.fromkeys(text for shard in shards for text in shard.place["tasks"]))


def place_at(
    start: Start, lengths: list[int], data_files: int, video_files: int, tasks: list[str], task_of: list[int]
) -> dict[str, Any]:
    """``tasks`` are the scene's own texts in order, ``task_of`` says for each episode which of them it is given."""
    return {
        **{name: getattr(start, name) for name in Start._fields if name != "tasks"},
        "episodes": len(lengths),
        "frames": sum(lengths),
        "data_files": data_files,
        "video_files": video_files,
        "lengths": lengths,
        "tasks": tasks,
        "task_indices": task_indices(start.tasks, tasks),
        "task_of": task_of,
    }


def empty_place(start: Start) -> dict[str, Any]:
    return place_at(start, [], 0, 0, [], [])


def moved_place(place: dict[str, Any], start: Start) -> dict[str, Any]:
    """The same scene, beginning elsewhere."""
    names = ("lengths", "data_files", "video_files", "tasks", "task_of")
    return place_at(start, *(place[name] for name in names))


def task_indices(known: Iterable[str], own: list[str]) -> list[int]:
    """The global number of each of a scene's texts; texts that are not ``known`` come after those that are."""
    index = {text: i for i, text in enumerate(dict.fromkeys([*known, *own]))}
    return [index[text] for text in own]


def split_ranges(shards: list[Shard]) -> dict[str, str]:
    """The ``splits`` of info.json: ranges of episodes, several joined by commas, as "0:24,36:50"."""
    ranges: dict[str, list[list[int]]] = {}
    number = 0
    for shard in shards:
        for split, count in _in_order(shard):
            own = ranges.setdefault(split, [])
            if own and own[-1][1] == number:
                own[-1][1] += count
            else:
                own.append([number, number + count])
            number += count
    return {split: ",".join(f"{a}:{b}" for a, b in own) for split, own in ranges.items()}


def files_at(scene: str, place: dict[str, Any]) -> list[str]:
    """The files of a scene with episodes that lies at ``place``."""
    return [
        f"scenes/{scene}/{SKETCH_NAME}",
        *(video_path(place["first_video_file"] + i) for i in range(place["video_files"])),
        *(data_path(place["first_data_file"] + i) for i in range(place["data_files"])),
        episodes_path(place["episode_file"]),
    ]


def data_path(number: int) -> str:
    return _numbered(DATA_PATH, number)


def video_path(number: int) -> str:
    return _numbered(VIDEO_PATH.replace("{video_key}", RGB_KEY), number)


def episodes_path(number: int) -> str:
    return _numbered(EPISODES_PATH, number)


def move_shard(source: Path, folder: Path, shard: Shard, place: dict[str, Any], described: dict[str, Any]) -> list[str]:
    """Write a scene's files at another place; returns their paths. ``described`` are the features of info.json."""
    old = shard.place
    if not old["episodes"]:
        return []
    for before, after in zip(files_at(shard.scene, old), files_at(shard.scene, place), strict=True):
        (folder / after).parent.mkdir(parents=True, exist_ok=True)
        if after.startswith("data/"):
            _move_data(source / before, folder / after, old, place, data_schema(described))
        elif after.startswith("meta/"):
            _move_episodes(source / before, folder / after, old, place, episode_schema(described))
        else:
            link_or_copy(source / before, folder / after)
    return files_at(shard.scene, place)


def _move_data(source: Path, target: Path, old: dict[str, Any], place: dict[str, Any], schema: pa.Schema) -> None:
    file = pq.ParquetFile(source)
    with pq.ParquetWriter(target, schema, use_dictionary=False) as writer:
        for i in range(file.num_row_groups):
            table = file.read_row_group(i)
            episode = table["episode_index"].to_numpy() - old["first_episode"] + place["first_episode"]
            frame = table["index"].to_numpy() - old["first_frame"] + place["first_frame"]
            task = np.array(place["task_indices"])[np.array(place["task_of"])[episode - place["first_episode"]]]
            for name, values in zip(PLACED, (episode, frame, task), strict=True):
                table = table.set_column(table.schema.get_field_index(name), name, pa.array(values, pa.int64()))
            writer.write_table(table.cast(schema), row_group_size=len(table))


def _move_episodes(source: Path, target: Path, old: dict[str, Any], place: dict[str, Any], schema: pa.Schema) -> None:
    rows = pq.read_table(source).to_pylist()
    firsts = [place["first_frame"] + n for n in accumulate([0, *place["lengths"][:-1]])]
    for i, (row, first) in enumerate(zip(rows, firsts, strict=True)):
        chunk, file = divmod(place["episode_file"], CHUNKS_SIZE)
        row |= {"meta/episodes/chunk_index": chunk, "meta/episodes/file_index": file}
        for kind, key in (("data", "data"), (f"videos/{RGB_KEY}", "video")):
            number = row[f"{kind}/chunk_index"] * CHUNKS_SIZE + row[f"{kind}/file_index"]
            number += place[f"first_{key}_file"] - old[f"first_{key}_file"]
            row[f"{kind}/chunk_index"], row[f"{kind}/file_index"] = divmod(number, CHUNKS_SIZE)
        row |= index_row(place["first_episode"] + i, first, row["length"])
        row |= placed_stats(placed_columns(row["episode_index"], first, row["length"], task_of_episode(place, i)))
    pq.write_table(pa.Table.from_pylist(rows, schema=schema), target)


def task_of_episode(place: dict[str, Any], episode: int) -> int:
    """The global task number of a scene's ``episode``-th episode."""
    return int(place["task_indices"][place["task_of"][episode]])


def index_row(episode: int, first_frame: int, length: int) -> dict[str, int]:
    """The columns of meta/episodes that say which episode and which frames."""
    return {"episode_index": episode, "dataset_from_index": first_frame, "dataset_to_index": first_frame + length}


def placed_columns(episode: int, first_frame: int, length: int, task: int) -> dict[str, NDArray[np.int64]]:
    """`PLACED` of one episode, each (F, 1)."""
    frame = np.arange(length, dtype=np.int64)[:, None]
    return {
        "episode_index": np.full_like(frame, episode),
        "index": frame + first_frame,
        "task_index": np.full_like(frame, task),
    }


def placed_stats(columns: dict[str, NDArray[np.int64]]) -> dict[str, Any]:
    stats = {name: numeric_stats(values) for name, values in columns.items()}
    return {f"stats/{name}/{s}": value for name, values in stats.items() for s, value in values.items()}


def _in_order(shard: Shard) -> list[tuple[str, int]]:
    """A scene's splits in the order in which its episodes lie."""
    return [(split, shard.share.splits[split]) for split in SPLITS if split in shard.share.splits]


def _numbered(pattern: str, number: int) -> str:
    chunk, file = divmod(number, CHUNKS_SIZE)
    return pattern.format(chunk_index=chunk, file_index=file)
