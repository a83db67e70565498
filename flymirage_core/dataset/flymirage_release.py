"""The official release's layout: a folder a flight, `instruction.json`, `data.csv`, `target_points.csv`, JPEG pictures.

The release names its folders ``000001_xxxxxx`` (in ZIPs of 500) and its pictures ``images/front/frame_1.jpg`` and
``depth/front/frame_1.jpg``; its card states no column names, so ours say their unit. What it lacks is added and breaks
nothing: depth without loss as 16-bit PNG beside the JPEG, velocities, the scene, the split, the box, the licence.
"""

import csv
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flymirage_core.dataset.depth_geometry import camera_of
from flymirage_core.dataset.episodes import Episode
from flymirage_core.dataset.export_check import ExportedEpisode, check_geometry
from flymirage_core.dataset.export_folder import Placed, Shard, common_files, write_json
from flymirage_core.dataset.flight_columns import flight_columns
from flymirage_core.dataset.scene_folders import SceneFolders, flight_of, read_png16, write_jpeg, write_png16
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.files import link_or_copy

DEPTH_JPEG_RANGE = 10.0
"""Metres at grey 255 of the lossy depth JPEG; farther is clipped. The PNG beside it has neither limit nor loss."""
POSE_COLUMNS = ("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")
STATE_COLUMNS = (*POSE_COLUMNS, "vx_mps", "vy_mps", "vz_mps", "wx_rps", "wy_rps", "wz_rps")
CSV_COLUMNS = ("timestamp_s", *STATE_COLUMNS, "image", "depth", "depth_png")
TARGET_COLUMNS = (*POSE_COLUMNS, "label", "size_x_m", "size_y_m", "size_z_m")


@dataclass(frozen=True)
class ReleaseFormat(SceneFolders):
    """A scene's place: the number of its first flight, from 1, and its flights' folders."""

    name: str = "flymirage"

    def write(
        self, folder: Path, products: SceneProducts, episodes: tuple[Episode, ...], before: list[Shard]
    ) -> Placed:
        place = _place(_first_number(before), [e.episode_id for e in episodes])
        files: list[str] = []
        for episode, name in zip(episodes, place["folders"], strict=True):
            files += [f"{name}/{path}" for path in _write_flight(folder / name, products, episode)]
        return Placed(place, files)

    def keep(self, source: Path, folder: Path, shard: Shard, before: list[Shard]) -> Placed:
        place = _place(_first_number(before), shard.place["episodes"])
        renamed = dict(zip(shard.place["folders"], place["folders"], strict=True))
        files = []
        for name in (n for n in shard.files if n not in common_files(shard.scene)):
            flight, rest = name.split("/", 1)
            files.append(f"{renamed[flight]}/{rest}")
            (folder / files[-1]).parent.mkdir(parents=True, exist_ok=True)
            link_or_copy(source / name, folder / files[-1])
        return Placed(place, files)

    def finish(self, folder: Path, shards: list[Shard]) -> dict[str, Any]:
        return {
            "flymirage": {
                "data.csv": "one row a frame: seconds, body pose and velocity in the world, body rates FLU, paths",
                "target_points.csv": "the target's box: centre, orientation xyzw (yaw about world z), label, full size",
                "depth/front/frame_N.jpg": "lossy, as in the release: grey = round(255 min(z, range) / range), "
                f"range {DEPTH_JPEG_RANGE:g} m",
                "depth/front/frame_N.png": "uint16 millimetres, lossless, 0 = no return",
                "folders": "number of the flight in this version of the data, six digits of its episode id's sha256",
            }
        }

    def check(self, folder: Path, products: SceneProducts) -> int:
        """Rebuild cameras from data.csv, the target from target_points.csv, and hold both against the frames."""
        shard = Shard.load(folder, products.scene)
        described = json.loads((folder / "conventions.json").read_text())["cameras"]
        camera = next(c for c in described if products.scene in c["scenes"])
        seen = 0
        for episode, name in zip(shard.place["episodes"], shard.place["folders"], strict=True):
            rows = _rows(folder / name / "data.csv")
            states = [np.array([float(row[c]) for c in STATE_COLUMNS]) for row in rows]
            (target,) = _rows(folder / name / "target_points.csv")
            depths = [read_png16(folder / name / rows[i]["depth_png"]) for i in (0, len(rows) // 2)]
            centre = np.array([float(target[c]) for c in ("x_m", "y_m", "z_m")])
            exported = ExportedEpisode(name, [camera_of(s, camera) for s in states], centre, (depths[0], depths[1]))
            seen += check_geometry(exported, products.frames.flight(int(episode.split("/")[1])))
        return seen


def _place(first: int, episodes: list[str]) -> dict[str, Any]:
    numbers = range(first, first + len(episodes))
    digits = (hashlib.sha256(e.encode()).hexdigest()[:6] for e in episodes)
    return {
        "first": first,
        "episodes": episodes,
        "folders": [f"{n:06d}_{d}" for n, d in zip(numbers, digits, strict=True)],
    }


def _first_number(before: list[Shard]) -> int:
    return 1 + sum(len(shard.place["episodes"]) for shard in before)


def _write_flight(folder: Path, products: SceneProducts, episode: Episode) -> list[str]:
    frames = products.frames.flight(episode.flight_id)
    columns = flight_columns(flight_of(products, episode.flight_id), frames, products.boxes.by_id(episode.object_id))
    rows, files = [], ["instruction.json", "data.csv", "target_points.csv"]
    pictures = zip(frames.rgb(), frames.depth(), strict=True)
    for i, (rgb, depth) in enumerate(pictures):
        image, grey, png = (f"{kind}/front/frame_{i + 1}.{end}" for kind, end in _KINDS)
        write_jpeg(folder / image, rgb)
        write_jpeg(folder / grey, np.rint(np.minimum(depth / (1000 * DEPTH_JPEG_RANGE), 1) * 255).astype(np.uint8))
        write_png16(folder / png, depth)
        state = [repr(float(v)) for v in columns["observation.state"][i]]
        rows.append([repr(i / frames.rig.frame_rate), *state, image, grey, png])
        files += [image, grey, png]
    _write_csv(folder / "data.csv", CSV_COLUMNS, rows)
    _write_csv(folder / "target_points.csv", TARGET_COLUMNS, [_target_row(episode)])
    write_json(folder / "instruction.json", _instruction(episode))
    return files


_KINDS = (("images", "jpg"), ("depth", "jpg"), ("depth", "png"))


def _target_row(episode: Episode) -> list[str]:
    turn = (0.0, 0.0, float(np.sin(episode.box_yaw / 2)), float(np.cos(episode.box_yaw / 2)))
    numbers = [repr(v) for v in (*episode.box_centre, *turn)]
    return [*numbers, episode.object_label, *(repr(v) for v in episode.box_size)]


def _instruction(episode: Episode) -> dict[str, Any]:
    own = episode.training_prompts or episode.prompts
    return {
        "instruction": own[episode.flight_id % len(own)].text,
        "instructions": [{"kind": p.kind, "text": p.text, "writer": p.writer} for p in episode.prompts],
        "held_out_instructions": [p.text for p in episode.held_out_prompts],
        "episode_id": episode.episode_id,
        "scene": episode.scene,
        "category": episode.category,
        "split": episode.split,
        "target": episode.object_label,
        "licence": episode.licence,
    }


def _write_csv(path: Path, head: tuple[str, ...], rows: list[list[str]]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))
