"""A tiny room with real products: boxes, straight flights, and pictures ray-cast from the boxes and really encoded."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.dataset.episodes import SceneProducts
from flymirage_core.language.judge import MeasuredJudge
from flymirage_core.language.prompter import OfflinePrompter
from flymirage_core.navigation.task_sets import Task, TaskSets
from flymirage_core.navigation.trajectories import Flight, FlightReport, Trajectories
from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.frames import BodyPath, CameraRig, Frames, cameras_along
from flymirage_core.rendering.rasterizer import Rasterizer, Rendering
from flymirage_core.rendering.recording import record_frames
from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import Light, Zone
from flymirage_core.settings import VerdictSettings
from flymirage_core.splats.cloud import GaussianCloud

RATE = 10.0
T_BODY_CAMERA = ((0.0, 0.0, 1.0, 0.1), (-1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.02), (0.0, 0.0, 0.0, 1.0))
RIG = CameraRig(Intrinsics.from_horizontal_fov(64, 48, np.radians(80)), T_BODY_CAMERA, RATE)
COLOURS = {
    "red": (200, 40, 40),
    "green": (40, 160, 60),
    "blue": (40, 70, 200),
    "brown": (120, 80, 40),
    "white": (230, 230, 230),
    "": (150, 150, 150),
}
ROOM = ((-6.0, -6.0, 0.0), (6.0, 6.0, 3.0))


def box(object_id: int, label: str, centre: tuple[float, float, float], size=(0.6, 0.6, 0.9), colour="", yaw=0.0):
    return ObjectBox(object_id, label, centre, size, yaw, 0.9, "test", colour, "", 5, 2.0, "embedded 1")


def furnished_room() -> BoxMap:
    """A red and a blue chair, a brown table with a white lamp on it, and a green bookshelf."""
    return BoxMap(
        (
            box(0, "chair", (3.0, 2.0, 0.6), (0.6, 0.6, 1.2), "red"),
            box(1, "chair", (-3.0, 2.0, 0.6), (0.6, 0.6, 1.2), "blue"),
            box(2, "table", (3.0, -2.5, 0.4), (1.4, 0.8, 0.8), "brown", yaw=0.4),
            box(3, "lamp", (3.0, -2.5, 1.05), (0.3, 0.3, 0.5), "white"),
            box(4, "bookshelf", (4.2, 2.2, 1.0), (0.5, 1.0, 2.0), "green"),
        )
    )


def flight_to(target: ObjectBox, flight_id: int, start=(0.0, 0.0, 1.2), frames: int = 15, set_index: int = 0) -> Flight:
    """Straight from ``start`` to 0.9 m before the target's box, smoothly from rest to rest, nose ahead and banking."""
    start = np.asarray(start, float)
    towards = np.array(target.centre) - start
    length = float(np.hypot(*towards[:2])) - max(target.size[:2]) / 2 - 0.9
    direction = np.array([*towards[:2], 0.0]) / np.hypot(*towards[:2])
    end = start + direction * length + np.array([0.0, 0.0, 0.5 * towards[2]])
    count = (frames - 1) * 3 + 1
    times = np.arange(count) / 30.0
    duration = max(times[-1], 1e-9)
    u = times / duration
    speed = 30 * u**2 * (1 - u) ** 2 / duration
    acceleration = (60 * u - 180 * u**2 + 120 * u**3) / duration**2
    share = 10 * u**3 - 15 * u**4 + 6 * u**5
    yaw = float(np.arctan2(direction[1], direction[0]))
    yaws = yaw + 0.3 * (1 - share)
    roll, pitch = 0.02 * np.sin(6 * u), 0.05 * acceleration
    turns = Rotation.from_euler("ZYX", np.column_stack([yaws, pitch, roll]))
    step = end - start
    report = FlightReport(
        duration=duration,
        length=float(np.linalg.norm(step)),
        straight_distance=float(np.linalg.norm(step)),
        max_speed=1.0,
        max_acceleration=1.0,
        max_jerk=4.0,
        max_body_rate=0.5,
        max_angular_acceleration=3.0,
        max_yaw_rate=0.4,
        min_rotor_thrust=1.1,
        max_rotor_thrust=1.4,
        tracking_position_rms=0.01,
        tracking_attitude_rms=0.01,
        min_clearance=0.5,
        end_error=0.0,
        inflation=0.3,
        planner="test",
        attempts="ok",
    )
    return Flight(
        flight_id,
        set_index,
        0,
        target.object_id,
        end,
        times,
        start + share[:, None] * step,
        speed[:, None] * step,
        acceleration[:, None] * step,
        turns.as_quat(),
        np.gradient(np.column_stack([roll, pitch, yaws]), axis=0) * 30,
        np.zeros((count, 3)),
        turns.inv().apply(acceleration[:, None] * step + [0.0, 0.0, 9.81]),
        np.full((count, 4), 1.2),
        yaws,
        0.5 + 0.2 * share,
        report,
    )


def camera_at(flight: Flight, time: float, rig: CameraRig = RIG) -> Camera:
    i = round(time * 30)
    path = BodyPath(0, flight.times[[i]], flight.positions[[i]], flight.quaternions[[i]])
    return cameras_along(path, rig)[0]


@dataclass(frozen=True)
class RayCaster(Rasterizer):
    """A rasterizer that sees boxes instead of splats; ``spoil`` damages each picture."""

    boxes: BoxMap
    spoil: Callable[[np.ndarray], np.ndarray]
    name: str = "ray caster"

    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]:
        for camera in cameras:
            rgb, depth = ray_cast(camera, self.boxes)
            metres = depth.astype(np.float32) / 1000
            yield Rendering(self.spoil(rgb), metres, np.ones_like(metres))


def film(
    folder: Path,
    flights: list[Flight],
    boxes: BoxMap,
    rig: CameraRig = RIG,
    spoil: Callable[[np.ndarray], np.ndarray] = lambda rgb: rgb,
) -> Frames:
    """All flights' frames, really encoded."""
    step = round(30 / rig.frame_rate)
    paths = [BodyPath(f.flight_id, f.times[::step], f.positions[::step], f.quaternions[::step]) for f in flights]
    nothing = GaussianCloud(*(np.zeros((0, *shape), np.float32) for shape in ((3,), (4,), (3,), (), (1, 3))))
    return record_frames(nothing, paths, rig, RayCaster(boxes, spoil), folder)


def ray_cast(camera: Camera, boxes: BoxMap) -> tuple[np.ndarray, np.ndarray]:
    """Chequered boxes in a chequered room: RGB (H, W, 3) uint8 and z-depth (H, W) uint16 millimetres."""
    k = camera.intrinsics
    u, v = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    rays = np.stack([(u - k.cx) / k.fx, (v - k.cy) / k.fy, np.ones_like(u)], axis=-1).reshape(-1, 3)
    directions = rays @ camera.T_world_camera[:3, :3].T  # z-depth 1 each
    low, high = (np.array(corner) for corner in ROOM)
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = np.nanmin(
            np.maximum((low - camera.position) / directions, (high - camera.position) / directions), axis=1
        )
        colour = np.full((len(rays), 3), 110.0)
        for item in boxes:
            start, step = item.to_local(camera.position), directions @ item.rotation
            half = np.array(item.size) / 2
            near = np.minimum((-half - start) / step, (half - start) / step).max(axis=1)
            far = np.maximum((-half - start) / step, (half - start) / step).min(axis=1)
            hit = (near > 0) & (near < far) & (near < depth)
            depth = np.where(hit, near, depth)
            colour[hit] = COLOURS[item.colour]
    points = camera.position + depth[:, None] * directions
    chequer = 0.7 + 0.3 * (np.floor(points * 2.5 + 1e-6).sum(axis=1) % 2)
    shape = (k.height, k.width)
    return (colour * chequer[:, None]).astype(np.uint8).reshape(*shape, 3), np.rint(depth * 1000).astype(
        np.uint16
    ).reshape(shape)


def description(scene: str) -> SceneDescription:
    return SceneDescription(
        scene=scene,
        title=scene,
        category="homes",
        subcategory="living room",
        setting="indoor",
        dimensions=(12.0, 12.0, 3.0),
        zones=(Zone(name="room", kind="room", dimensions=(12.0, 12.0, 3.0), surfaces=(), connects_to=(), windows=0),),
        style="plain",
        era="",
        palette=("grey",),
        light=Light(time_of_day="noon", sky="none", sources=("ceiling_lamps",), words="even lamp light"),
        objects=(),
        prose="A room.",
        image_prompt="A room.",
        world_prompt="A room.",
        provenance=Provenance(kind="generated", writer="offline 1"),
    )


def scene_products(
    folder: Path, scene: str = "cafe", targets: tuple[int, ...] = (0, 1, 4), frames: int = 15, rig: CameraRig = RIG
) -> SceneProducts:
    """A whole scene: one flight to each target, of ``frames`` frames plus two for every next one, filmed and judged."""
    boxes = furnished_room()
    flights = [
        flight_to(boxes.by_id(t), i, frames=frames + 2 * i, set_index=i, start=(0.0, 0.1 * i, 1.2))
        for i, t in enumerate(targets)
    ]
    trajectories = Trajectories(tuple(flights))
    filmed = film(folder / scene, flights, boxes, rig)
    settings = VerdictSettings(
        max_blur=1.0, max_noise=255.0, max_flicker=255.0, max_depth_jump=1.0, min_contrast=1.0, max_floaters=1.0
    )
    verdicts = MeasuredJudge(settings).judge(filmed, trajectories, boxes)
    tasks = tuple(Task(f.set_index, 0, f.object_id, tuple(f.positions[0]), tuple(f.target_point)) for f in flights)
    prompts = OfflinePrompter().write(scene, filmed, boxes, trajectories, verdicts)
    return SceneProducts(
        scene,
        description(scene),
        boxes,
        TaskSets(tasks, {}),
        trajectories,
        filmed,
        verdicts,
        prompts,
        {"boxes": "ab12"},
    )


def renamed(products: SceneProducts, scene: str) -> SceneProducts:
    """The same products under another scene's name."""
    return replace(products, scene=scene, description=description(scene))
