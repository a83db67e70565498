"""RLDS: episodes of steps in TFRecord files, which `tensorflow_datasets.builder_from_directory(folder)` loads.

Written without TensorFlow (`tfrecord`). A file holds one scene's episodes of one split; adding a scene adds files, and
writes dataset_info.json anew. Pictures are JPEG, depth 16-bit PNG, both decoded by TFDS.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flymirage_core.dataset.conventions import ACTION_NAMES, STATE_NAMES
from flymirage_core.dataset.depth_geometry import camera_of
from flymirage_core.dataset.episodes import Episode
from flymirage_core.dataset.export_check import ExportedEpisode, check_geometry
from flymirage_core.dataset.export_folder import Placed, Shard, common_files, write_json
from flymirage_core.dataset.flight_columns import flight_columns
from flymirage_core.dataset.scene_folders import SceneFolders, flight_of, jpeg_bytes, png16_bytes, png16_from
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.dataset.splits import SPLITS
from flymirage_core.dataset.tfrecord import Values, example_bytes, example_from, read_records, write_records
from flymirage_core.errors import InputError
from flymirage_core.files import link_or_copy
from flymirage_core.rendering.frames import CameraRig

DATASET = "flymirage"
VERSION = "1.0.0"
"""Of the features; a change of them is a new version."""
TEMPLATE = "{DATASET}-{SPLIT}.{FILEFORMAT}-{SHARD_INDEX}"
"""TFDS's name for a file without the number of files in it, which grows."""
METADATA = ("episode_id", "scene", "category", "split", "target", "licence")
_FEATURES = "tensorflow_datasets.core.features"


@dataclass(frozen=True)
class RldsFormat(SceneFolders):
    """A scene's place: for each of its splits the file's number in that split, its episodes and bytes."""

    name: str = "rlds"

    def admit(self, rigs: Any) -> None:
        """One picture size in all scenes: it is in features.json."""
        (first_scene, first), *others = rigs
        for scene, rig in others:
            if _size(rig) != _size(first):
                raise InputError(
                    f"scene {scene} was filmed at {_size(rig)} pixels and {first_scene} at {_size(first)}, but one "
                    "RLDS folder holds one size; export them apart, or materialise `frames` of one of them again"
                )

    def write(
        self, folder: Path, products: SceneProducts, episodes: tuple[Episode, ...], before: list[Shard]
    ) -> Placed:
        place: dict[str, Any] = {}
        for split in SPLITS:
            own = [e for e in episodes if e.split == split]
            if own:
                number = _files_before(before, split)
                path = folder / _file(split, number)
                write_records(path, (example_bytes(_example(products, e)) for e in own))
                place[split] = {"number": number, "episodes": len(own), "bytes": path.stat().st_size}
        return Placed(place, _files(place))

    def keep(self, source: Path, folder: Path, shard: Shard, before: list[Shard]) -> Placed:
        place = {split: {**own, "number": _files_before(before, split)} for split, own in shard.place.items()}
        for old, new in zip(_files(shard.place), _files(place), strict=True):
            link_or_copy(source / old, folder / new)
        return Placed(place, _files(place))

    def finish(self, folder: Path, shards: list[Shard]) -> dict[str, Any]:
        rig = next(s.rig for s in shards if s.share.counts.episodes)
        splits = []
        for split in SPLITS:
            own = [shard.place[split] for shard in shards if split in shard.place]
            if own:
                lengths = [str(place["episodes"]) for place in own]
                size = str(sum(place["bytes"] for place in own))
                splits.append({"name": split, "filepathTemplate": TEMPLATE, "numBytes": size, "shardLengths": lengths})
        about = {"name": DATASET, "version": VERSION, "fileFormat": "tfrecord", "splits": splits}
        write_json(folder / "dataset_info.json", {**about, "description": "Aerial vision-language navigation"})
        write_json(folder / "features.json", _features(rig))
        return {
            "rlds": {
                "load": "tensorflow_datasets.builder_from_directory(folder).as_dataset(split='train')",
                "steps": "action as in the LeRobot export; the last step's is zero; reward 1 there, else 0; discount 1",
                "state": list(STATE_NAMES),
                "action": list(ACTION_NAMES),
                "depth": "uint16 millimetres, 0 = no return",
            }
        }

    def check(self, folder: Path, products: SceneProducts) -> int:
        shard = Shard.load(folder, products.scene)
        camera = json.loads((folder / "conventions.json").read_text())["cameras"]
        described = next(c for c in camera if products.scene in c["scenes"])
        centres = {e.episode_id: e.box_centre for e in shard.episodes(folder)}
        seen = 0
        for name in (n for n in shard.files if n not in common_files(shard.scene)):
            for example in map(example_from, read_records(folder / name)):
                seen += _check_example(example, described, centres, products, folder / name)
        return seen


def _check_example(
    example: dict[str, Values], described: dict[str, Any], centres: dict[str, Any], products: SceneProducts, path: Path
) -> bool:
    (name,) = (_text(v) for v in example["episode_metadata/episode_id"])
    states = np.asarray(example["steps/observation/state"]).reshape(-1, len(STATE_NAMES)).astype(float)
    depths = example["steps/observation/depth"]
    first, middle = (png16_from(bytes(depths[i]), f"{path}: depth {i} of {name}") for i in (0, len(depths) // 2))
    cameras = [camera_of(state, described) for state in states]
    frames = products.frames.flight(int(name.split("/")[1]))
    return check_geometry(ExportedEpisode(name, cameras, np.array(centres[name]), (first, middle)), frames)


def _text(value: Any) -> str:
    return bytes(value).decode()


def _example(products: SceneProducts, episode: Episode) -> dict[str, Values]:
    frames = products.frames.flight(episode.flight_id)
    columns = flight_columns(flight_of(products, episode.flight_id), frames, products.boxes.by_id(episode.object_id))
    count = len(frames)
    last = np.arange(count) == count - 1
    own = episode.training_prompts or episode.prompts
    text = own[episode.flight_id % len(own)].text.encode()
    described = {"target": episode.object_label, **{n: getattr(episode, n) for n in METADATA if n != "target"}}
    return {
        "steps/observation/image": [jpeg_bytes(rgb) for rgb in frames.rgb()],
        "steps/observation/depth": [png16_bytes(depth) for depth in frames.depth()],
        "steps/observation/state": columns["observation.state"],
        "steps/action": columns["action"],
        "steps/reward": last.astype(np.float32),
        "steps/discount": np.ones(count, np.float32),
        "steps/is_first": (np.arange(count) == 0).astype(np.int64),
        "steps/is_last": last.astype(np.int64),
        "steps/is_terminal": last.astype(np.int64),
        "steps/language_instruction": [text] * count,
        "episode_metadata/instructions": [b"\n".join(p.text.encode() for p in own)],
        **{f"episode_metadata/{name}": [value.encode()] for name, value in described.items()},
    }


def _features(rig: CameraRig) -> dict[str, Any]:
    height, width = rig.intrinsics.height, rig.intrinsics.width
    steps = {
        "observation": _dict(
            {
                "image": _image((height, width, 3), "uint8", "jpeg"),
                "depth": _image((height, width, 1), "uint16", "png"),
                "state": _tensor("tensor_feature.Tensor", "float32", len(STATE_NAMES)),
            }
        ),
        "action": _tensor("tensor_feature.Tensor", "float32", len(ACTION_NAMES)),
        **{name: _tensor("scalar.Scalar", "float32") for name in ("reward", "discount")},
        **{name: _tensor("scalar.Scalar", "bool") for name in ("is_first", "is_last", "is_terminal")},
        "language_instruction": _text_feature(),
    }
    sequence = {"feature": _dict(steps), "length": "-1"}
    return _dict(
        {
            "steps": {"pythonClassName": f"{_FEATURES}.dataset_feature.Dataset", "sequence": sequence},
            "episode_metadata": _dict({name: _text_feature() for name in ("instructions", *METADATA)}),
        }
    )


def _dict(features: dict[str, Any]) -> dict[str, Any]:
    return {"pythonClassName": f"{_FEATURES}.features_dict.FeaturesDict", "featuresDict": {"features": features}}


def _text_feature() -> dict[str, Any]:
    return {"pythonClassName": f"{_FEATURES}.text_feature.Text", "text": {}}


def _image(shape: tuple[int, ...], dtype: str, encoding: str) -> dict[str, Any]:
    described = {"shape": {"dimensions": [str(n) for n in shape]}, "dtype": dtype, "encodingFormat": encoding}
    return {"pythonClassName": f"{_FEATURES}.image_feature.Image", "image": described}


def _tensor(kind: str, dtype: str, length: int = 0) -> dict[str, Any]:
    shape = {"dimensions": [str(length)]} if length else {}
    return {"pythonClassName": f"{_FEATURES}.{kind}", "tensor": {"shape": shape, "dtype": dtype, "encoding": "none"}}


def _files_before(before: list[Shard], split: str) -> int:
    return sum(split in shard.place for shard in before)


def _files(place: dict[str, Any]) -> list[str]:
    return [_file(split, own["number"]) for split, own in place.items()]


def _file(split: str, number: int) -> str:
    return f"{DATASET}-{split}.tfrecord-{number:05d}"


def _size(rig: CameraRig) -> str:
    return f"{rig.intrinsics.width}x{rig.intrinsics.height}"
