"""A small furnished room that is ray cast exactly: coloured boxes to RGB-D views, with the true box of each thing."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.rasterizer import Rendering
from flymirage_core.rendering.views import View

FACE_LIGHT = np.array([[0.8, 0.72], [0.9, 0.66], [0.5, 1.0]])
"""Light on the lower and upper face across each axis."""


@dataclass(frozen=True)
class Body:
    """A box of one colour in its thing's own frame: metres from the thing's place on its support, z up."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    colour: tuple[int, int, int]


@dataclass(frozen=True)
class Thing:
    """Bodies placed together at ``place`` (world) and turned by ``yaw`` (radians)."""

    name: str
    place: tuple[float, float, float]
    yaw: float
    bodies: tuple[Body, ...]

    @property
    def box(self) -> ObjectBox:
        lower = np.min([np.subtract(b.centre, np.divide(b.size, 2)) for b in self.bodies], axis=0)
        upper = np.max([np.add(b.centre, np.divide(b.size, 2)) for b in self.bodies], axis=0)
        centre = _turn(self.yaw) @ ((lower + upper) / 2) + self.place
        return make_box(0, centre, upper - lower, self.yaw, self.name)


@dataclass(frozen=True)
class Room:
    """A closed room of ``size`` (x, y, z) metres, floor's middle at the origin, turned by ``yaw``, and its things."""

    size: tuple[float, float, float]
    things: tuple[Thing, ...] = ()
    yaw: float = 0.0
    walls: tuple[int, int, int] = (225, 218, 205)
    floor: tuple[int, int, int] = (150, 120, 90)
    ceiling: tuple[int, int, int] = (240, 240, 238)
    truth: list[ObjectBox] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "truth", [thing.box for thing in self.things])


def make_box(
    object_id: int, centre: Sequence[float], size: Sequence[float] = (1, 1, 1), yaw: float = 0.0, label: str = "thing"
) -> ObjectBox:
    x, y, z = (float(v) for v in centre)
    w, d, h = (float(v) for v in size)
    return ObjectBox(object_id, label, (x, y, z), (w, d, h), yaw, 1.0, "test", "", "", 1, 1.0, "test 1")


def block(name: str, place: Sequence[float], size: Sequence[float], colour: Sequence[int], yaw: float = 0.0) -> Thing:
    """A plain box standing at ``place``."""
    return Thing(name, tuple(place), yaw, (Body((0, 0, size[2] / 2), tuple(size), tuple(colour)),))


def table(
    place: Sequence[float], colour: Sequence[int], size: Sequence[float] = (1.5, 0.8, 0.74), yaw: float = 0.0
) -> Thing:
    w, d, h = size
    top = Body((0, 0, h - 0.02), (w, d, 0.04), tuple(colour))
    legs = [
        Body((x * (w / 2 - 0.05), y * (d / 2 - 0.05), (h - 0.04) / 2), (0.06, 0.06, h - 0.04), tuple(colour))
        for x in (-1, 1)
        for y in (-1, 1)
    ]
    return Thing("table", tuple(place), yaw, (top, *legs))


def chair(place: Sequence[float], colour: Sequence[int], yaw: float = 0.0) -> Thing:
    """Its back is on its -y side."""
    legs = [Body((x * 0.19, y * 0.19, 0.21), (0.05, 0.05, 0.42), tuple(colour)) for x in (-1, 1) for y in (-1, 1)]
    seat = Body((0, 0, 0.44), (0.44, 0.44, 0.05), tuple(colour))
    back = Body((0, -0.2, 0.68), (0.44, 0.04, 0.46), tuple(colour))
    return Thing("chair", tuple(place), yaw, (*legs, seat, back))


def lamp(place: Sequence[float], yaw: float = 0.0) -> Thing:
    foot = Body((0, 0, 0.02), (0.18, 0.18, 0.04), (60, 60, 65))
    pole = Body((0, 0, 0.15), (0.05, 0.05, 0.24), (60, 60, 65))
    shade = Body((0, 0, 0.38), (0.28, 0.28, 0.22), (235, 190, 90))
    return Thing("lamp", tuple(place), yaw, (foot, pole, shade))


def picture(place: Sequence[float], colour: Sequence[int], yaw: float = 0.0) -> Thing:
    """Flat, its back at y = 0 of its own frame, looking along -y."""
    return Thing("picture", tuple(place), yaw, (Body((0, -0.02, 0), (0.9, 0.04, 0.65), tuple(colour)),))


def sweep(
    position: Sequence[float], yaws: int = 12, pitches: Sequence[float] = (-35, -10, 15), width: int = 160
) -> list[Camera]:
    """Cameras at one place, all round, at each pitch in degrees; 90 degrees wide."""
    lens = Intrinsics.from_horizontal_fov(width, width * 3 // 4, np.pi / 2)
    angles = [(2 * np.pi * k / yaws, np.radians(p)) for p in pitches for k in range(yaws)]
    return [
        Camera(lens, look_along(position, (np.cos(a) * np.cos(p), np.sin(a) * np.cos(p), np.sin(p)))) for a, p in angles
    ]


def views_of(room: Room, cameras: Sequence[Camera]) -> list[View]:
    """What the cameras see, exactly."""
    return [View(camera, _render(room, camera)) for camera in cameras]


def _render(room: Room, camera: Camera) -> Rendering:
    k = camera.intrinsics
    u, v = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    rays = np.stack([(u - k.cx) / k.fx, (v - k.cy) / k.fy, np.ones_like(u)], axis=-1).reshape(-1, 3)
    rays = rays @ camera.T_world_camera[:3, :3].T  # (P, 3) world, z-depth 1
    depth, colour = _shell(room, camera.position, rays)
    for thing in room.things:
        rotation = _turn(thing.yaw)
        origin, local = (camera.position - thing.place) @ rotation, rays @ rotation
        for body in thing.bodies:
            _hit(body, origin, local, depth, colour)
    shape = (k.height, k.width)
    rgb = np.clip(colour, 0, 255).astype(np.uint8).reshape(*shape, 3)
    return Rendering(rgb, depth.astype(np.float32).reshape(shape), np.ones(shape, np.float32))


def _shell(room: Room, position: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    rotation = _turn(room.yaw)
    origin, local = position @ rotation, rays @ rotation
    lower, upper = (
        np.array([-room.size[0] / 2, -room.size[1] / 2, 0]),
        np.array([room.size[0] / 2, room.size[1] / 2, room.size[2]]),
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        exits = np.where(local > 0, (upper - origin) / local, (lower - origin) / local)
    exits = np.where(local == 0, np.inf, exits)
    axis = exits.argmin(axis=1)
    upward = local[np.arange(len(local)), axis] > 0
    paint = np.array([room.walls, room.walls, room.floor], float)[axis]
    paint[(axis == 2) & upward] = room.ceiling
    return exits.min(axis=1), paint * FACE_LIGHT[axis, upward.astype(int)][:, None]


def _hit(body: Body, origin: np.ndarray, rays: np.ndarray, depth: np.ndarray, colour: np.ndarray) -> None:
    half = np.divide(body.size, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (np.subtract(body.centre, origin) - half) / rays, (np.subtract(body.centre, origin) + half) / rays
    near, far = np.minimum(a, b), np.maximum(a, b)
    axis = np.nan_to_num(near, nan=-np.inf).argmax(axis=1)
    enter, leave = np.nanmax(near, axis=1), np.nanmin(far, axis=1)
    seen = (enter < leave) & (enter > 1e-6) & (enter < depth)
    depth[seen] = enter[seen]
    upper = rays[np.arange(len(rays)), axis][seen] < 0
    colour[seen] = np.array(body.colour) * FACE_LIGHT[axis[seen], upper.astype(int)][:, None]


def _turn(yaw: float) -> np.ndarray:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
