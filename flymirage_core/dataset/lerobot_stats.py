"""A scene's statistics as a small file, and meta/stats.json from the files of all scenes."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flymirage_core.dataset.column_stats import NumberSketch, PictureCounts, Stats, joint_stats, numeric_stats
from flymirage_core.dataset.export_folder import Shard, shard_folder

SKETCH_NAME = "statistics.npz"
PLACED = ("episode_index", "index", "task_index")
"""Columns that follow from where a scene lies: their statistics are worked out from the places, not kept."""


def save_sketch(folder: Path, numbers: dict[str, NDArray[Any]], pictures: dict[str, PictureCounts]) -> None:
    """Write a scene's ``statistics.npz`` of its numeric columns (N, n) and its sampled pictures."""
    arrays: dict[str, NDArray[Any]] = {}
    for name, values in numbers.items():
        if name not in PLACED:
            sketch = NumberSketch.of(values)
            arrays[f"number|{name}|count"] = np.array(sketch.count)
            arrays[f"number|{name}|moments"] = np.stack([sketch.mean, sketch.variance])
            arrays[f"number|{name}|grid"] = sketch.grid
    for name, counts in pictures.items():
        channel, level = np.nonzero(counts.counts)
        arrays[f"picture|{name}|shape"] = np.array([*counts.counts.shape, counts.pictures])
        arrays[f"picture|{name}|scale"] = np.array(counts.scale)
        arrays[f"picture|{name}|counts"] = np.stack([channel, level, counts.counts[channel, level]])
    np.savez_compressed(folder / SKETCH_NAME, allow_pickle=False, **arrays)


def joint_statistics(folder: Path, shards: list[Shard], order: list[str]) -> dict[str, Stats]:
    """meta/stats.json over all shards with episodes, features in ``order``."""
    numbers: dict[str, list[NumberSketch]] = {}
    pictures: dict[str, PictureCounts] = {}
    for shard in shards:
        with np.load(shard_folder(folder, shard.scene) / SKETCH_NAME) as arrays:
            for kind, name in sorted({tuple(key.split("|")[:2]) for key in arrays.files}):
                if kind == "number":
                    mean, variance = arrays[f"number|{name}|moments"]
                    count, grid = int(arrays[f"number|{name}|count"]), arrays[f"number|{name}|grid"]
                    numbers.setdefault(name, []).append(NumberSketch(count, mean, variance, grid))
                else:
                    counted = _picture_counts(arrays, name)
                    pictures[name] = pictures[name] + counted if name in pictures else counted
    stats = {name: joint_stats(sketches) for name, sketches in numbers.items()}
    stats |= {name: counts.stats() for name, counts in pictures.items()}
    stats |= {name: numeric_stats(values) for name, values in _placed_columns(shards).items()}
    return {name: stats[name] for name in order}


def _picture_counts(arrays: Any, name: str) -> PictureCounts:
    channels, levels, pictures = (int(n) for n in arrays[f"picture|{name}|shape"])
    counts = np.zeros((channels, levels), np.int64)
    channel, level, count = arrays[f"picture|{name}|counts"]
    counts[channel, level] = count
    return PictureCounts(counts, pictures, float(arrays[f"picture|{name}|scale"]))


def _placed_columns(shards: list[Shard]) -> dict[str, NDArray[Any]]:
    """`PLACED` over all frames, each (N, 1)."""
    lengths = np.concatenate([np.array(s.place["lengths"], np.int64) for s in shards])
    tasks = np.concatenate([np.array(s.place["task_indices"])[s.place["task_of"]] for s in shards])
    return {
        "episode_index": np.repeat(np.arange(len(lengths)), lengths)[:, None],
        "index": np.arange(lengths.sum())[:, None],
        "task_index": np.repeat(tasks, lengths)[:, None],
    }
