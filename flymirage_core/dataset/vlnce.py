"""VLN-CE episodes for evaluation: an episode an instruction, as ``<split>/<split>.json.gz`` and a ground-truth file.

The files are VLN-CE's, the world is ours: z up, metres, body quaternion xyzw; conventions.json says so. Each split's
``content/<scene>.json.gz`` holds one scene's episodes alone. A long instruction over several flights of a set is an
episode of its own, of the kind "long_horizon".
"""

import gzip
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.dataset.episodes import Episode
from flymirage_core.dataset.export_check import PIXEL_TOLERANCE
from flymirage_core.dataset.export_folder import Placed, Shard
from flymirage_core.dataset.scene_folders import SceneFolders, flight_of
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.dataset.splits import SPLITS, is_unseen_instruction
from flymirage_core.errors import ProductError
from flymirage_core.rendering.camera import Camera

GOAL_RADIUS = 1.0
"""Metres from the target point within which an evaluation may count success; stored with every goal."""
REFERENCE_STEP = 0.25
"""Metres between points of the reference path: VLN-CE's step."""
PATH_TOLERANCE = 0.05
"""Metres by which a flight may leave the straight pieces of its reference path ..."""
CUT_CORNER = 0.02
"""... and from which on the path gets a point more there: a flight may turn back on the spot."""
HELD_OUT_SPLIT = "test_unseen_instruction"

Row = dict[str, Any]
Points = NDArray[np.float64]


@dataclass(frozen=True)
class VlnceFormat(SceneFolders):
    """A scene's place: how many episodes it adds to each split."""

    name: str = "vlnce"

    def write(
        self, folder: Path, products: SceneProducts, episodes: tuple[Episode, ...], before: list[Shard]
    ) -> Placed:
        by_split: dict[str, list[Row]] = {}
        for episode in episodes:
            for prompt in episode.prompts:
                held_out = episode.split == "train" and is_unseen_instruction(prompt.text)
                row = _row(products, [episode], prompt.text, prompt.kind)
                by_split.setdefault(HELD_OUT_SPLIT if held_out else episode.split, []).append(row)
        by_flight = {e.flight_id: e for e in episodes}
        for long in products.prompts.long_prompts:
            legs = [by_flight[i] for i in long.flight_ids if i in by_flight]
            if len(legs) == len(long.flight_ids):  # else a leg was dropped
                by_split.setdefault(legs[0].split, []).append(_row(products, legs, long.text, "long_horizon"))
        files = []
        for split, rows in sorted(by_split.items()):
            for i, row in enumerate(rows):
                row["episode_id"] = f"{products.scene}/{split}/{i}"
            files.append(f"{split}/content/{products.scene}.json.gz")
            _write_gz(folder / files[-1], {"episodes": rows})
        return Placed({split: len(rows) for split, rows in sorted(by_split.items())}, files)

    def finish(self, folder: Path, shards: list[Shard]) -> dict[str, Any]:
        for split in SPLITS:
            own = [shard.scene for shard in shards if split in shard.place]
            if own:
                episodes = [row for scene in own for row in _read_gz(folder / split / "content" / f"{scene}.json.gz")]
                truth = {row["episode_id"]: _truth(row) for row in episodes}
                _write_gz(folder / split / f"{split}.json.gz", {"episodes": episodes})
                _write_gz(folder / split / f"{split}_gt.json.gz", truth)
        return {
            "vlnce": {
                "frame": "not Habitat's: right-handed, z up, metres; start_rotation xyzw, body (FLU) to world",
                "goals": f"position: where the flight ends; radius {GOAL_RADIUS:g} m; object: the target's box centre",
                "reference_path": f"the flown path, a point every {REFERENCE_STEP:g} m, at sharp turns, and its end",
                "locations": "the reference path again, as VLN-CE's ground truth has it",
                "long_horizon": "several flights of one task set, flown one after the other",
            }
        }

    def check(self, folder: Path, products: SceneProducts) -> int:
        """Every episode against the frames it was made from: start, path, goals, the target in the first picture."""
        checked: set[int] = set()
        for path in sorted(folder.glob(f"*/content/{products.scene}.json.gz")):
            for row in _read_gz(path):
                where = f"export self-test: episode {row['episode_id']} of {path}"
                _check_start(row, products, where)
                _check_path(row, products, where)
                checked.update(row["trajectory_id"])
        return len(checked)


def _check_start(row: Row, products: SceneProducts, where: str) -> None:
    """The drone's camera at the start must see the first target where the first frame does."""
    body = np.eye(4)
    body[:3, :3] = Rotation.from_quat(row["start_rotation"]).as_matrix()
    body[:3, 3] = row["start_position"]
    camera = Camera(products.frames.rig.intrinsics, body @ np.array(products.frames.rig.T_body_camera))
    source = products.frames.flight(row["trajectory_id"][0]).cameras()[0]
    (found, depth), (expected, _) = (c.project(row["goals"][0]["object"]) for c in (camera, source))
    off = float(np.linalg.norm(found - expected))
    if depth[0] > 0 and not off <= PIXEL_TOLERANCE:
        raise ProductError(f"{where} starts where its target projects {off:.1f} pixels from where its picture has it")


def _check_path(row: Row, products: SceneProducts, where: str) -> None:
    """The path must begin at the start, pass where every frame was taken, and end at the goal; so must each leg."""
    T_camera_body = np.linalg.inv(products.frames.rig.T_body_camera)
    path, goals = np.array(row["reference_path"]), row["goals"]
    legs = [products.frames.flight(i).cameras() for i in row["trajectory_id"]]
    flown = [np.array([(c.T_world_camera @ T_camera_body)[:3, 3] for c in cameras]) for cameras in legs]  # (F, 3) each
    errors = {
        "begins {:.2f} m from its start": np.linalg.norm(path[0] - row["start_position"]),
        "ends {:.2f} m from its goal": np.linalg.norm(path[-1] - goals[-1]["position"]),
        "has points {:.2f} m apart": np.linalg.norm(np.diff(path, axis=0), axis=1).max(initial=0.0) - REFERENCE_STEP,
        "passes {:.2f} m from where a frame was taken": _distance_to_path(np.concatenate(flown), path).max(),
    }
    for goal, leg in zip(goals, flown[-len(goals) :], strict=True):
        flies_to = products.boxes.by_id(goal["object_id"]).centre
        errors |= {
            f"has the goal {goal['object_category']} {{:.2f}} m from its flight's end": np.linalg.norm(
                leg[-1] - goal["position"]
            ),
            f"has the object {goal['object_category']} {{:.2f}} m from its box": np.linalg.norm(
                np.subtract(flies_to, goal["object"])
            ),
        }
    for text, error in errors.items():
        if not error <= PATH_TOLERANCE:
            raise ProductError(f"{where} {text.format(error)}; at most {PATH_TOLERANCE} m are allowed")


def _distance_to_path(points: Points, path: Points) -> NDArray[np.float64]:
    """Metres (N,) from each point (N, 3) to the nearest of the straight pieces between a path's points (P, 3)."""
    ends = path[1:] if len(path) > 1 else path
    return np.asarray(_distance_to_pieces(points[:, None], path[: len(ends)], ends).min(axis=1))


def _distance_to_pieces(points: Points, start: Points, end: Points) -> NDArray[np.float64]:
    """Metres (...) from points (..., 3) to the straight pieces from ``start`` to ``end``."""
    along, offset = end - start, points - start
    share = np.clip((offset * along).sum(axis=-1) / np.maximum((along**2).sum(axis=-1), 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(offset - share[..., None] * along, axis=-1))


def _row(products: SceneProducts, legs: list[Episode], text: str, kind: str) -> Row:
    flights = [flight_of(products, leg.flight_id) for leg in legs]
    path = resampled(np.concatenate([flight.positions for flight in flights]))
    length = sum(float(leg.report.length) for leg in legs)
    goals = [
        {
            "position": flight.positions[-1].tolist(),
            "radius": GOAL_RADIUS,
            "object": list(leg.box_centre),
            "object_id": leg.object_id,
            "object_category": leg.object_label,
        }
        for flight, leg in zip(flights, legs, strict=True)
    ]
    return {
        "episode_id": "",
        "trajectory_id": [leg.flight_id for leg in legs],
        "scene_id": products.scene,
        "start_position": list(legs[0].start_position),
        "start_rotation": list(legs[0].start_quaternion),
        "info": {"geodesic_distance": length, "duration": sum(leg.report.duration for leg in legs), "kind": kind},
        "goals": goals if kind == "long_horizon" else goals[-1:],
        "instruction": {"instruction_text": text},
        "reference_path": path,
    }


def resampled(positions: Points) -> list[list[float]]:
    """Points every `REFERENCE_STEP` along a path (T, 3), its end included, and where it would cut a corner."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])  # (T,)
    wanted = np.append(np.arange(0.0, arc[-1], REFERENCE_STEP), arc[-1])
    while True:
        points = np.column_stack([np.interp(wanted, arc, axis) for axis in positions.T])  # (P, 3)
        piece = np.clip(np.searchsorted(wanted, arc, side="right") - 1, 0, max(len(points) - 2, 0))  # (T,)
        off = _distance_to_pieces(positions, points[piece], points[np.minimum(piece + 1, len(points) - 1)])
        worst = int(np.argmax(off))
        if off[worst] <= CUT_CORNER or arc[worst] in wanted:
            return [[round(float(v), 4) for v in point] for point in points]
        wanted = np.sort(np.append(wanted, arc[worst]))


def _truth(row: Row) -> Row:
    return {"locations": row["reference_path"], "forward_steps": len(row["reference_path"]) - 1}


def _read_gz(path: Path) -> Iterable[Row]:
    rows: list[Row] = json.loads(gzip.decompress(path.read_bytes()))["episodes"]
    return rows


def _write_gz(path: Path, value: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(json.dumps(value).encode(), mtime=0))
