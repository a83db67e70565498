"""What a box looks like, in numbers: size, place, shape, colours and crops of the views that saw it best.

These are the recogniser's features (`FEATURES` of them); nothing here knows a noun.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.colours import to_lab
from flymirage_core.annotation.fused_points import Frame, FusedPoints
from flymirage_core.annotation.labels import Support, green
from flymirage_core.annotation.room_structure import RoomStructure
from flymirage_core.annotation.surroundings import FEATURES as SURROUNDINGS

Float32 = NDArray[np.float32]

SHAPE_CELLS: Final = (5, 5, 8)
"""Cells of the grid in the box, along its longer side, its shorter side and z."""
CROP: Final = 24
"""Pixels of a crop's side."""
MAX_SAMPLES: Final = 48
"""Pixels of a window's shorter side that are looked at, at least, before they become a crop."""
CROP_CELLS: Final = 6
EDGE_CELLS: Final = 4
EDGE_ANGLES: Final = 6
CROP_MARGIN: Final = 0.06
"""Metres round the box within which a pixel's point belongs to it."""
AT_WALL: Final = 0.3
"""Metres to a wall's plane within which a surface is at the wall."""
FAR: Final = 3.0
"""Metres; gaps to walls and ceiling are not told apart beyond this."""

_SHAPE: Final = int(np.prod(SHAPE_CELLS))
_SLABS: Final = SHAPE_CELLS[2]
_GEOMETRY: Final = 13 + len(Support)
_COLOUR: Final = 13
_CROP_COLOURS: Final = CROP_CELLS**2 * 4
_EDGES: Final = EDGE_CELLS**2 * EDGE_ANGLES
FEATURES: Final = SURROUNDINGS + _SHAPE + _SLABS * 8 + _GEOMETRY + _COLOUR + _CROP_COLOURS + _EDGES


@dataclass(frozen=True, eq=False)
class Observation:
    """A box with all that its name may be judged by."""

    box: FittedBox
    support: Support
    points: Float32  # (M, 3) seen of it
    relief: float  # metres that they spread across the wall which they are at; inf away from walls
    features: Float32  # (FEATURES,)


def observe(
    box: FittedBox,
    support: Support,
    seen: FusedPoints,
    normals: Float32,
    variation: Float32,
    structure: RoomStructure,
    frames: Sequence[Frame],
    around: Float32,
) -> Observation:
    """Measure a box. ``seen``: its M points, with ``normals`` (M, 3) and `surface_variation` (M,).

    ``frames``: those that show most of it. ``around``: its `surroundings`.
    """
    points, lab = seen.points, to_lab(seen.colours)  # (M, 3)
    local, half = _in_box(box, points)
    features = np.concatenate(
        [
            around,
            _shape_grid(local, half).ravel(),
            _slabs(local, lab, normals, variation).ravel(),
            _geometry(box, support, structure, len(points)),
            _colours(lab, variation),
            _crops(box, frames),
        ]
    ).astype(np.float32)
    return Observation(box, support, points, _relief(box, points, structure), features)


def mirrored(features: Float32) -> Float32:
    """Features (N, FEATURES) of the same things seen in a mirror: for training on more than there is."""
    out = features.copy()
    grid = out[:, SURROUNDINGS : SURROUNDINGS + _SHAPE].reshape(-1, *SHAPE_CELLS)
    grid[:] = grid[:, ::-1].copy()
    first = FEATURES - _EDGES - _CROP_COLOURS
    crops = out[:, first : FEATURES - _EDGES].reshape(-1, CROP_CELLS, CROP_CELLS, 4)
    crops[:] = crops[:, :, ::-1].copy()
    edges = out[:, FEATURES - _EDGES :].reshape(-1, EDGE_CELLS, EDGE_CELLS, EDGE_ANGLES)
    edges[:] = edges[:, :, ::-1, (-np.arange(EDGE_ANGLES) - 1) % EDGE_ANGLES].copy()
    return out


def reversed_depth(features: Float32) -> Float32:
    """Features (N, FEATURES) of things whose shape is turned front to back."""
    out = features.copy()
    grid = out[:, SURROUNDINGS : SURROUNDINGS + _SHAPE].reshape(-1, *SHAPE_CELLS)
    grid[:] = grid[:, :, ::-1].copy()
    return out


def _relief(box: FittedBox, points: Float32, structure: RoomStructure) -> float:
    across = [wall.distance(points) for wall in structure.walls_at(box.centre)]
    return min(
        (float(np.ptp(np.percentile(d, (5, 95)))) for d in across if abs(np.median(d)) < AT_WALL), default=np.inf
    )


def _in_box(box: FittedBox, points: Float32) -> tuple[Float32, Float32]:
    """Points (M, 3) as shares -1..1 of the box along its longer side, its shorter side and z; half sizes (3,)."""
    turn = box.yaw + (np.pi / 2 if box.size[1] > box.size[0] else 0.0)
    c, s = np.cos(turn), np.sin(turn)
    local = (points - np.array(box.centre)) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    half = np.array([max(box.size[:2]), min(box.size[:2]), box.size[2]]) / 2
    return np.clip(local / half, -1, 1).astype(np.float32), half.astype(np.float32)


def _shape_grid(local: Float32, half: Float32) -> Float32:
    """How full of surface each cell of the box is, 0..1: `SHAPE_CELLS`."""
    cells = np.minimum((local + 1) / 2 * SHAPE_CELLS, np.array(SHAPE_CELLS) - 1).astype(int)
    counts = np.zeros(SHAPE_CELLS, np.float32)
    np.add.at(counts, tuple(cells.T), 1)
    a, b, h = 2 * half / SHAPE_CELLS
    expected = np.median([a * b, a * h, b * h]) / 0.03**2  # points of a surface across the cell
    return np.asarray(1 - np.exp(-2 * counts / max(float(expected), 1.0)), np.float32)


def _slabs(local: Float32, lab: Float32, normals: Float32, variation: Float32) -> Float32:
    """For each slab of height: colour, share of the points, reach along both sides, share looking up, roughness."""
    slab = np.minimum((local[:, 2] + 1) / 2 * _SLABS, _SLABS - 1).astype(int)
    out = np.zeros((_SLABS, 8), np.float32)
    for k in range(_SLABS):
        mine = slab == k
        if not mine.any():
            continue
        reach = np.abs(local[mine, :2]).mean(axis=0)
        out[k] = [*lab[mine].mean(axis=0) / 50, mine.mean(), *reach, (normals[mine, 2] > 0.7).mean(), 0]
        out[k, 7] = 10 * variation[mine].mean()
    return out


def _geometry(box: FittedBox, support: Support, structure: RoomStructure, points: int) -> Float32:
    long, short, height = max(box.size[:2]), min(box.size[:2]), box.size[2]
    logs = np.log(np.maximum([long, short, height], 0.02))
    ceiling = FAR
    if structure.ceiling_map is not None:
        ceiling = float(structure.ceiling_map.at(np.array([box.centre[:2]]))[0]) - box.top
    wall = structure.wall_gap(box.centre, short)
    area = 2 * (long * short + long * height + short * height)
    return np.array(
        [
            *logs,
            logs[0] - logs[1],
            logs[2] - logs[0],
            logs[2] - logs[1],
            box.bottom - structure.floor,
            box.top - structure.floor,
            min(max(ceiling, 0.0), FAR),
            min(wall, FAR),
            float(wall < 0.1),
            np.log(points),
            points * 0.03**2 / max(area, 1e-3),
            *(float(support is s) for s in Support),
        ],
        np.float32,
    )


def _colours(lab: Float32, variation: Float32) -> Float32:
    percentiles = np.percentile(lab, (10, 50, 90), axis=0) / 50  # (3, 3)
    leaves = green(lab)
    rough = float(np.median(variation[leaves])) if leaves.any() else 0.0
    chroma = np.hypot(lab[:, 1], lab[:, 2])
    return np.array(
        [*percentiles.ravel(), leaves.mean(), 10 * rough, 10 * variation.mean(), chroma.std() / 20], np.float32
    )


def _crops(box: FittedBox, frames: Sequence[Frame]) -> Float32:
    """Mean over the views' crops of coarse colours and of edge directions; zero where no view shows the box."""
    found = [crop for frame in frames if (crop := _crop(box, frame)) is not None]
    if not found:
        return np.zeros(_CROP_COLOURS + _EDGES, np.float32)
    return np.asarray(np.mean([_crop_features(*crop) for crop in found], axis=0), np.float32)


def window_of(box: FittedBox, frame: Frame) -> tuple[int, int, int, int] | None:
    """(left, top, right, bottom) in pixels of the part of ``frame`` in which the box lies; None if there is none."""
    c, s = np.cos(box.yaw), np.sin(box.yaw)
    signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    corners = (signs * box.size) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + box.centre  # (8, 3)
    pixels, depth = frame.camera.project(corners)
    if (depth < 0.1).any():
        return None
    height, width = frame.depth.shape
    left, top = np.maximum(np.floor(pixels.min(axis=0)).astype(int), 0)
    right, bottom = np.minimum(np.ceil(pixels.max(axis=0)).astype(int), (width, height))
    return (int(left), int(top), int(right), int(bottom)) if right - left >= 4 and bottom - top >= 4 else None


def _crop(box: FittedBox, frame: Frame) -> tuple[Float32, Float32] | None:
    """Lab (CROP, CROP, 3) of the box's window, and the share of each pixel (CROP, CROP) that lies in the box."""
    window = window_of(box, frame)
    if window is None:
        return None
    left, top, right, bottom = window
    step = max(1, min(right - left, bottom - top) // MAX_SAMPLES)
    rgb, depth = frame.rgb[top:bottom:step, left:right:step], frame.depth[top:bottom:step, left:right:step]
    k, pose = frame.camera.intrinsics, frame.camera.T_world_camera
    x = (np.arange(left, right, step) + 0.5 - k.cx) / k.fx
    y = (np.arange(top, bottom, step) + 0.5 - k.cy) / k.fy
    rays = np.stack(np.broadcast_arrays(x[None], y[:, None], 1.0), axis=-1)  # (h, w, 3)
    away = (rays * depth[..., None]) @ pose[:3, :3].T + pose[:3, 3] - box.centre
    c, s = np.cos(box.yaw), np.sin(box.yaw)
    local = away @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    mask = ((np.abs(local) < np.array(box.size) / 2 + CROP_MARGIN).all(axis=-1) & (depth > 0)).astype(np.float32)
    size = (CROP, CROP)
    small = cv2.resize(np.ascontiguousarray(rgb, np.float32) / 255, size, interpolation=cv2.INTER_AREA)
    lab = cv2.cvtColor(small, cv2.COLOR_RGB2LAB)
    return np.asarray(lab, np.float32), np.asarray(cv2.resize(mask, size, interpolation=cv2.INTER_AREA), np.float32)


def _crop_features(lab: Float32, mask: Float32) -> Float32:
    """Coarse colours where the box is, and a histogram of edge directions, of one crop."""
    side = (CROP_CELLS, CROP_CELLS)
    share = cv2.resize(mask, side, interpolation=cv2.INTER_AREA)  # (C, C)
    colours = cv2.resize(lab * mask[..., None], side, interpolation=cv2.INTER_AREA) / np.maximum(share, 0.05)[..., None]
    grid = np.concatenate([colours / 50, share[..., None]], axis=-1)  # (C, C, 4)
    across = cv2.Sobel(lab[..., 0], cv2.CV_32F, 1, 0, scale=1 / 8)
    down = cv2.Sobel(lab[..., 0], cv2.CV_32F, 0, 1, scale=1 / 8)
    strength = np.hypot(across, down)
    angle = np.minimum((np.arctan2(down, across) % np.pi) / np.pi * EDGE_ANGLES, EDGE_ANGLES - 1).astype(int)
    cell = np.arange(CROP) * EDGE_CELLS // CROP
    histogram = np.zeros((EDGE_CELLS, EDGE_CELLS, EDGE_ANGLES), np.float32)
    np.add.at(histogram, (cell[:, None], cell[None, :], angle), strength)
    histogram = np.sqrt(histogram / (CROP / EDGE_CELLS) ** 2 / 10)
    return np.concatenate([grid.ravel(), histogram.ravel()]).astype(np.float32)
