"""Pictures, depth and poses of a scene as a nerfstudio `transforms.json`, for those who train splats.

nerfstudio's cameras are OpenGL's: x right, y up, z backward. Ours are OpenCV's, so the second and third axis change
their sign; the world stays z up in metres.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flymirage_core.dataset.episodes import Episode
from flymirage_core.dataset.export_check import check_depth
from flymirage_core.dataset.export_folder import Placed, Shard, write_json
from flymirage_core.dataset.scene_folders import SceneFolders, read_png16, write_jpeg, write_png16
from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.errors import ProductError
from flymirage_core.rendering.camera import Camera, Intrinsics

EVERY = 5
"""Every so many frames of a flight one is written: neighbours show the same."""
OPENGL_FROM_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True)
class TransformsFormat(SceneFolders):
    """A folder a scene: transforms.json, images/, depth/."""

    name: str = "transforms"

    @property
    def options(self) -> dict[str, Any]:
        return {"every": EVERY}

    def write(
        self, folder: Path, products: SceneProducts, episodes: tuple[Episode, ...], before: list[Shard]
    ) -> Placed:
        own = folder / products.scene
        entries: list[dict[str, Any]] = []
        for episode in episodes:
            frames = products.frames.flight(episode.flight_id)
            chosen = range(0, len(frames), EVERY)
            cameras = frames.cameras()
            pictures = zip(frames.rgb_at(chosen), frames.depth_at(chosen), strict=True)
            for i, (rgb, depth) in zip(chosen, pictures, strict=True):
                name = f"flight_{episode.flight_id:04d}_{i:05d}"
                write_jpeg(own / "images" / f"{name}.jpg", rgb)
                write_png16(own / "depth" / f"{name}.png", depth)
                entries.append(_entry(name, cameras[i], episode.flight_id, i))
        if entries:
            write_json(own / "transforms.json", {**_camera(products.frames.rig.intrinsics), "frames": entries})
        files = [f"{products.scene}/{e[key]}" for e in entries for key in ("file_path", "depth_file_path")]
        return Placed({}, [*files, *([f"{products.scene}/transforms.json"] if entries else [])])

    def finish(self, folder: Path, shards: list[Shard]) -> dict[str, Any]:
        return {
            "transforms": {
                "transform_matrix": "camera to world, OpenGL camera (x right, y up, z backward), metres, world z up",
                "depth": "uint16 millimetres along the optical axis; depth_unit_scale_factor gives metres",
                "frames": f"every {EVERY}th of each flight",
            }
        }

    def check(self, folder: Path, products: SceneProducts) -> int:
        path = folder / products.scene / "transforms.json"
        if not path.exists():
            return 0
        data = json.loads(path.read_text())
        k = Intrinsics(*(data[name] for name in ("w", "h", "fl_x", "fl_y", "cx", "cy")))
        episodes = Shard.load(folder, products.scene).episodes(folder)
        for episode in episodes:
            rows = [row for row in data["frames"] if row["flight_id"] == episode.flight_id]
            cameras = [Camera(k, np.array(row["transform_matrix"]) @ OPENGL_FROM_OPENCV) for row in rows]
            source = products.frames.flight(episode.flight_id).cameras()[::EVERY]
            for row, camera, expected in zip(rows, cameras, source, strict=True):
                if not np.allclose(camera.T_world_camera, expected.T_world_camera, atol=1e-6):
                    raise ProductError(f"export self-test: {row['file_path']} in {path} has another pose than it had")
            depths = [read_png16(path.parent / rows[i]["depth_file_path"]) for i in (0, len(rows) // 2)]
            check_depth(f"{episode.episode_id} of {path}", cameras, (depths[0], depths[1]))
        return 0


def _entry(name: str, camera: Camera, flight_id: int, frame_index: int) -> dict[str, Any]:
    return {
        "file_path": f"images/{name}.jpg",
        "depth_file_path": f"depth/{name}.png",
        "transform_matrix": (camera.T_world_camera @ OPENGL_FROM_OPENCV).tolist(),
        "flight_id": flight_id,
        "frame_index": frame_index,
    }


def _camera(k: Intrinsics) -> dict[str, Any]:
    return {
        "camera_model": "OPENCV",
        "w": k.width,
        "h": k.height,
        "fl_x": k.fx,
        "fl_y": k.fy,
        "cx": k.cx,
        "cy": k.cy,
        **dict.fromkeys(("k1", "k2", "p1", "p2"), 0.0),
        "depth_unit_scale_factor": 0.001,
    }
