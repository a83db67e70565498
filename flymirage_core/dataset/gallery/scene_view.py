"""A scene to walk around in: splats, boxes with labels, flights and camera frusta in one HTML file, by viser.

viser is the ``[view]`` extra. It serves on loopback only while the file is written; the file itself asks nobody.
"""

import socket
from contextlib import redirect_stdout
from dataclasses import replace
from io import StringIO
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from flymirage_core.dataset.scene_products import SceneProducts
from flymirage_core.errors import InputError
from flymirage_core.rendering.frames import FlightFrames
from flymirage_core.scene.keys import rng
from flymirage_core.splats.cloud import GaussianCloud

MOST_SPLATS = 150_000
"""Of a page: about 5 MB and fluent in a browser without a GPU."""
OBJECTS_FIRST = 6.0
"""How much likelier a splat in an object's box is to stay: walls bear thinning, a stool does not."""
MOST_GROWN = 1.6
"""Factor by which a splat that stays may grow to cover for those that went."""
MOST_FLIGHTS = 20
"""Drawn; more hide each other."""
FRUSTA = 3
"""Pictures shown along a flight: the first, the last, and between."""
PATH_STEP = 0.1
"""Metres between the points of a drawn path."""
CEILING_SHARE = 0.93
"""Indoors, splats above this share of the room's height are left out, so that one can look in from above."""
SH_DC = 0.28209479177387814
"""Spherical harmonic of degree 0."""
FLIGHT_COLOURS = ((230, 80, 60), (60, 130, 230), (60, 170, 90), (220, 160, 40), (150, 90, 200), (40, 170, 180))
WORKERS_FROM_FILE = """<script>
if (location.protocol === "file:") {
  const Plain = window.Worker
  window.Worker = class extends Plain {
    constructor(url, options) {
      const asked = new XMLHttpRequest()
      asked.open("GET", url, false)
      asked.send()
      super("data:text/javascript;charset=utf-8," + encodeURIComponent(asked.responseText), options)
    }
  }
}
</script>"""
"""viser sorts splats by depth in a module worker from a blob. Of a page opened from a file, a browser refuses such a
worker, and near things vanish behind far ones; from a data URL it takes it."""
TARGET_COLOUR, OTHER_COLOUR = (240, 90, 50), (110, 120, 140)


def scene_html(products: SceneProducts, cloud: GaussianCloud) -> str:
    """The page of one scene. Raises `InputError` if viser is not installed."""
    viser = _viser()
    with redirect_stdout(StringIO()):  # it announces its address, which nobody needs
        server = viser.ViserServer(host="127.0.0.1", port=_free_port(), verbose=False)
    try:
        scene = server.scene
        scene.set_up_direction("+z")
        low, high = _extent(cloud)
        _add_splats(scene, visible_splats(cloud, products, high))
        _add_boxes(scene, products)
        for flight_id in [f.flight_id for f in products.trajectories][:MOST_FLIGHTS]:
            _add_flight(scene, products, flight_id)
        middle, size = (low + high) / 2, high - low
        server.initial_camera.position = tuple(
            middle + np.array([-0.55, -0.75, 0.0]) * size[:2].max() + [0, 0, 0.9 * size[2] + 4]
        )
        server.initial_camera.look_at = tuple(middle - [0, 0, size[2] / 4])
        return str(scene.as_html()).replace("<head>", "<head>" + WORKERS_FROM_FILE, 1)
    finally:
        with redirect_stdout(StringIO()):
            server.stop()


def visible_splats(cloud: GaussianCloud, products: SceneProducts, high: NDArray[np.float64]) -> GaussianCloud:
    """At most `MOST_SPLATS`, without an indoor ceiling; those in objects and those that cover most are the likeliest to
    stay, and grow as if they covered for their like that went."""
    if products.description.setting == "indoor":
        cloud = cloud[cloud.means[:, 2] < CEILING_SHARE * high[2]]
    if len(cloud) <= MOST_SPLATS:
        return cloud
    scales = np.sort(cloud.scales, axis=1)
    weight = np.sqrt(cloud.opacities * scales[:, 1] * scales[:, 2] + 1e-12, dtype=float)  # (N,) of the longer axes
    for box in products.boxes:
        weight[box.contains(cloud.means)] *= OBJECTS_FIRST
    # One exponential race: the smallest of Exp(1) / weight are a sample without replacement, by weight.
    finish = rng(products.scene, "gallery").exponential(size=len(cloud)) / weight
    chosen = np.sort(np.argpartition(finish, MOST_SPLATS)[:MOST_SPLATS])
    stayed = 1 - np.exp(-weight[chosen] * finish[chosen].max())  # (MOST_SPLATS,) chance to be among them
    grown = np.minimum(stayed**-0.5, MOST_GROWN).astype(np.float32)
    shown = cloud[chosen]
    return replace(shown, scales=shown.scales * grown[:, None])


def _viser() -> Any:
    try:
        import viser
    except ImportError as error:
        raise InputError("the 3D pages need viser: pip install 'flymirage[view]'") from error
    return viser


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _extent(cloud: GaussianCloud) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Low and high corner (3,) of all splats but a hundredth on each side."""
    low, high = np.quantile(cloud.means[:: max(len(cloud) // 50_000, 1)].astype(float), (0.01, 0.99), axis=0)
    return low, high


def _add_splats(scene: Any, cloud: GaussianCloud) -> None:
    turns = Rotation.from_quat(cloud.quaternions).as_matrix()  # (N, 3, 3)
    axes = turns * cloud.scales[:, None, :]
    colours = np.clip(0.5 + SH_DC * cloud.sh[:, 0], 0.0, 1.0)
    covariances = (axes @ axes.transpose(0, 2, 1)).astype(np.float32)
    scene.add_gaussian_splats("/splats", cloud.means, covariances, colours, cloud.opacities[:, None])


def _add_boxes(scene: Any, products: SceneProducts) -> None:
    targets = {flight.object_id for flight in products.trajectories}
    for box in products.boxes:
        colour = TARGET_COLOUR if box.object_id in targets else OTHER_COLOUR
        name = f"/boxes/{box.object_id:04d}"
        turn = (float(np.cos(box.yaw / 2)), 0.0, 0.0, float(np.sin(box.yaw / 2)))  # wxyz at the viewer's border
        scene.add_box(name, colour, box.size, wireframe=True, wxyz=turn, position=box.centre)
        if box.object_id in targets:
            top = (box.centre[0], box.centre[1], box.top + 0.05)
            scene.add_label(f"{name}/label", box.label, position=tuple(np.subtract(top, box.centre)))


def _add_flight(scene: Any, products: SceneProducts, flight_id: int) -> None:
    flight = next(f for f in products.trajectories if f.flight_id == flight_id)
    colour = FLIGHT_COLOURS[flight_id % len(FLIGHT_COLOURS)]
    points = _spread(flight.positions)
    name = f"/flights/{flight_id:04d}"
    scene.add_spline_catmull_rom(f"{name}/path", points.astype(np.float32), thickness=0.025, color=colour)
    frames = products.frames.flight(flight_id)
    if flight_id < len(FLIGHT_COLOURS):  # pictures of a few flights are enough to see what a frame is
        _add_frusta(scene, name, frames, colour)


def _spread(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (P, 3) of a path a `PATH_STEP` apart: a curve through two equal points, as in hover, is not a number."""
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])
    wanted = np.linspace(0.0, arc[-1], max(int(arc[-1] / PATH_STEP), 2))
    return np.column_stack([np.interp(wanted, arc, axis) for axis in positions.T])


def _add_frusta(scene: Any, name: str, frames: FlightFrames, colour: tuple[int, int, int]) -> None:
    chosen = np.linspace(0, len(frames) - 1, FRUSTA).astype(int).tolist()
    cameras = frames.cameras()
    for i, rgb in zip(chosen, frames.rgb_at(chosen), strict=True):
        k, pose = cameras[i].intrinsics, cameras[i].T_world_camera
        x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
        scene.add_camera_frustum(
            f"{name}/frame_{i}",
            fov=float(2 * np.arctan(k.height / 2 / k.fy)),
            aspect=k.width / k.height,
            scale=0.25,
            thickness=0.01,
            color=colour,
            image=rgb[:: max(k.height // 120, 1), :: max(k.height // 120, 1)],
            format="jpeg",
            wxyz=(w, x, y, z),
            position=tuple(pose[:3, 3]),
        )
