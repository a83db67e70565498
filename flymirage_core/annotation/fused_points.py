"""Pixels of all views averaged in voxels: `Frame`, a view made ready, and `FusedPoints`, the surface that they share.

Depth of splats is mixed at edges; the edge test throws those pixels away. Nothing here knows what an object is.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple, TypeVar

import cv2
import numba
import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera, Intrinsics
from flymirage_core.rendering.views import View

Float32 = NDArray[np.float32]
Bool = NDArray[np.bool_]
Scalar = TypeVar("Scalar", bound=np.generic)

MIN_DEPTH: Final = 0.15
"""Metres; nearer than this a splat depth is a smear on the lens."""
MIN_ALPHA: Final = 0.6
"""A pixel that lets more of the background through mixes two surfaces."""
MAX_DISPARITY_CURVATURE: Final = 0.045
"""Relative difference of 1/z from its 3x3 mean beyond which a pixel lies on a depth edge. Planes are linear in 1/z, so
grazing floors pass and flying pixels do not."""
HALO_DEPTHS: Final = (0.4, 0.8, 1.6)
"""Metres; something nearer than each has a rim of `HALO_WIDTH` at that depth."""
HALO_WIDTH: Final = 0.05
"""Metres by which splats blur a silhouette."""
HALO_RATIO: Final = 1.4
"""Depth against the nearer thing's from which a pixel is behind it."""
MIN_INCIDENCE: Final = 0.2
"""Cosine between a pixel's ray and its surface's normal below which depth is not believed."""
SQUARE: Final = 0.96
"""Cosine between optical axis and normal from which a surface is seen squarely. A splat's depth is that of its middle
and the nearer ones hide the others, so surfaces at a slant come out too near, by up to a splat's radius."""
NEAREST_WEIGHT_RANGE: Final = 0.5
"""Metres; pixels weigh 1/range^2, those nearer than this all the same."""

SOBEL_SUM: Final = 128
"""What OpenCV's 5x5 Sobel kernel makes of a slope of 1 a pixel."""
KEY_BITS: Final = 21
KEY_OFFSET: Final = 1 << (KEY_BITS - 1)


@dataclass(frozen=True, eq=False)
class Frame:
    """A view made ready: colour, depth without salt and pepper, and how squarely each trusted pixel was seen."""

    camera: Camera
    rgb: NDArray[np.uint8]  # (H, W, 3)
    depth: Float32  # (H, W) z-depth, metres, 0 = no return
    incidence: Float32  # (H, W) cosine between ray and surface normal, 0 where the depth is not to be trusted


@dataclass(frozen=True, eq=False)
class FusedPoints:
    """One point for each voxel that was seen: weighted means over pixels. World frame, metres; sorted by voxel."""

    voxels: NDArray[np.int64]  # (N, 3) index of the voxel, floor(point / edge)
    points: Float32  # (N, 3)
    colours: Float32  # (N, 3) RGB 0..255
    to_camera: Float32  # (N, 3) mean direction to the cameras that saw it
    nearest: Float32  # (N,) metres from the nearest camera that saw it
    frames: NDArray[np.int32]  # (N,) frames that saw it

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: Bool | NDArray[np.intp]) -> "FusedPoints":
        return FusedPoints(*(getattr(self, name)[index] for name in self.__dataclass_fields__))


def frame_of(view: View) -> Frame:
    """Clean a view's depth and mark the pixels whose depth is that of one surface."""
    picture = view.picture
    depth = np.asarray(cv2.medianBlur(np.ascontiguousarray(picture.depth, np.float32), 3), np.float32)  # (H, W)
    depth[(depth < MIN_DEPTH) | ~np.isfinite(depth) | (picture.alpha < MIN_ALPHA)] = 0
    some = depth > 0
    disparity = np.where(some, 1 / np.maximum(depth, MIN_DEPTH), 0).astype(np.float32)
    curvature = np.abs(cv2.blur(disparity, (3, 3)) - disparity) * depth
    inside = cv2.erode(some.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    incidence = _plane_angles(disparity, view.camera.intrinsics)[0]
    trusted = inside & (curvature < MAX_DISPARITY_CURVATURE) & (incidence > MIN_INCIDENCE)
    trusted &= ~_in_halo(depth, view.camera.intrinsics.fx)
    return Frame(view.camera, picture.rgb, depth, np.where(trusted, incidence, 0).astype(np.float32))


def _in_halo(depth: Float32, focal: float) -> Bool:
    """(H, W) pixels behind the soft rim of something near, wider the nearer it is: their depth is a mixture."""
    known = np.where(depth > 0, depth, np.inf).astype(np.float32)
    halo = np.zeros(depth.shape, bool)
    for limit in HALO_DEPTHS:
        side = 2 * int(HALO_WIDTH * focal / limit) + 1
        nearest = cv2.erode(known, np.ones((side, side), np.uint8))
        halo |= (nearest < limit) & (depth > HALO_RATIO * np.minimum(nearest, limit))
    return halo


def _plane_angles(disparity: Float32, k: Intrinsics) -> tuple[Float32, Float32]:
    """(H, W) cosines between each pixel's surface normal n and its ray r, and between n and the optical axis.

    A plane n . x = d has disparity (n . r) / d, linear in the pixel; so the gradient of disparity gives n / d.
    """
    across = cv2.Sobel(disparity, cv2.CV_32F, 1, 0, ksize=5, scale=1 / SOBEL_SUM)
    down = cv2.Sobel(disparity, cv2.CV_32F, 0, 1, ksize=5, scale=1 / SOBEL_SUM)
    x = (np.arange(k.width, dtype=np.float32) + 0.5 - k.cx) / k.fx  # (W,)
    y = ((np.arange(k.height, dtype=np.float32) + 0.5 - k.cy) / k.fy)[:, None]  # (H, 1)
    nx, ny = across * k.fx, down * k.fy
    nz = disparity - nx * x - ny * y
    length = np.maximum(np.sqrt(nx * nx + ny * ny + nz * nz), 1e-9)
    return disparity / (length * np.sqrt(x * x + y * y + 1)), np.abs(nz) / length


def square_only(frame: Frame) -> Frame:
    """The frame with trust in those pixels only whose surface faces the camera squarely: few, but without bias."""
    disparity = np.where(frame.depth > 0, 1 / np.maximum(frame.depth, MIN_DEPTH), 0).astype(np.float32)
    square = _plane_angles(disparity, frame.camera.intrinsics)[1] > SQUARE
    return replace(frame, incidence=np.where(square, frame.incidence, 0).astype(np.float32))


def frames_of(views: Iterable[View]) -> list[Frame]:
    """`frame_of` each view, in order."""
    return [frame_of(view) for view in views]


def fuse_points(frames: Sequence[Frame], voxel: float, max_distance: float) -> FusedPoints:
    """Average the trusted pixels of all frames in voxels of edge ``voxel`` metres.

    Only pixels within ``max_distance`` metres of their own optical centre enter. Colour and place are means weighted by
    (incidence / range)^2: splat depth errs askance, and by a share of the range.
    """
    table = _Table(
        np.full(1 << 16, -1, np.int64),
        np.empty(1 << 15, np.int64),
        np.empty((1 << 15, 12), np.float32),
        np.empty(1 << 15, np.int32),
    )
    count = 0
    for index, frame in enumerate(frames):
        table = _with_room(table, count, count + frame.depth.size)
        k, pose = frame.camera.intrinsics, frame.camera.T_world_camera
        lens = np.array([k.fx, k.fy, k.cx, k.cy])
        picture = (frame.rgb, frame.depth, frame.incidence)
        limits = (voxel, min(max_distance, 1e6))
        count = _add_frame(picture, lens, np.ascontiguousarray(pose), limits, index, table, count)
    return _collected(table.keys[:count], table.rows[:count])


class _Table(NamedTuple):
    """Open-addressing hash table of voxels."""

    slots: NDArray[np.int64]  # row of each key, -1 = empty
    keys: NDArray[np.int64]  # (M,)
    rows: Float32  # (M, 12) w * point, w * colour, w * direction, w, nearest range, frames
    last: NDArray[np.int32]  # (M,) frame that touched the row last


def _with_room(table: _Table, count: int, needed: int) -> _Table:
    """The table, larger if need be, with its first ``count`` rows."""
    slots, keys, rows, last = table
    if needed > len(keys):
        keys, rows, last = _grown(keys, 2 * needed), _grown(rows, 2 * needed), _grown(last, 2 * needed)
    if 2 * needed > len(slots):
        slots = np.full(1 << int(2 * needed).bit_length(), -1, np.int64)
        _rehash(keys, count, slots)
    return _Table(slots, keys, rows, last)


def _grown(array: NDArray[Scalar], length: int) -> NDArray[Scalar]:
    out = np.empty((length, *array.shape[1:]), array.dtype)
    out[: len(array)] = array
    return out


def _collected(keys: NDArray[np.int64], rows: Float32) -> FusedPoints:
    order = np.argsort(keys)
    keys, rows = keys[order], rows[order]
    weight = rows[:, 9:10]
    mask = (1 << KEY_BITS) - 1
    voxels = np.stack([keys >> (2 * KEY_BITS), (keys >> KEY_BITS) & mask, keys & mask], axis=1) - KEY_OFFSET  # (N, 3)
    direction = rows[:, 6:9] / np.maximum(np.linalg.norm(rows[:, 6:9], axis=1, keepdims=True), 1e-9)
    return FusedPoints(
        voxels, rows[:, :3] / weight, rows[:, 3:6] / weight, direction, rows[:, 10], rows[:, 11].astype(np.int32)
    )


@numba.njit(cache=True, nogil=True)
def _slot_of(key: int, slots: NDArray[np.int64], keys: NDArray[np.int64]) -> int:
    """Where ``key`` is in the table, or the empty slot where it belongs."""
    mask = len(slots) - 1
    h = key ^ (key >> 29)
    h = h * 0x2545F4914F6CDD1D
    slot = (h ^ (h >> 32)) & mask
    while slots[slot] >= 0 and keys[slots[slot]] != key:
        slot = (slot + 1) & mask
    return slot


@numba.njit(cache=True, nogil=True)
def _rehash(keys: NDArray[np.int64], count: int, slots: NDArray[np.int64]) -> None:
    for row in range(count):
        slots[_slot_of(keys[row], slots, keys)] = row


@numba.njit(cache=True, nogil=True)
def _add_frame(
    picture: tuple[NDArray[np.uint8], Float32, Float32],  # rgb (H, W, 3), depth (H, W), incidence (H, W)
    lens: NDArray[np.float64],  # fx, fy, cx, cy
    pose: NDArray[np.float64],  # (4, 4) T_world_camera
    limits: tuple[float, float],  # edge of a voxel, greatest range
    frame: int,
    table: _Table,
    count: int,
) -> int:
    """Add a frame's trusted pixels to the table; the new number of rows."""
    rgb, depth, incidence = picture
    voxel, max_distance = limits
    slots, keys, rows, last = table
    for v in range(depth.shape[0]):
        for u in range(depth.shape[1]):
            if incidence[v, u] <= 0:
                continue
            x = (u + 0.5 - lens[2]) / lens[0]
            y = (v + 0.5 - lens[3]) / lens[1]
            ray = np.sqrt(x * x + y * y + 1)
            z = depth[v, u]
            reach = z * ray
            if reach > max_distance:
                continue
            key = 0
            for a in range(3):
                p = (pose[a, 0] * x + pose[a, 1] * y + pose[a, 2]) * z + pose[a, 3]
                key = (key << KEY_BITS) | (int(np.floor(p / voxel)) + KEY_OFFSET)
            slot = _slot_of(key, slots, keys)
            row = slots[slot]
            if row < 0:
                row = count
                slots[slot] = row
                keys[row] = key
                rows[row] = 0
                rows[row, 10] = reach
                last[row] = -1
                count += 1
            near = max(reach, NEAREST_WEIGHT_RANGE)
            w = incidence[v, u] * incidence[v, u] / (near * near)
            for a in range(3):
                direction = pose[a, 0] * x + pose[a, 1] * y + pose[a, 2]
                rows[row, a] += w * (direction * z + pose[a, 3])
                rows[row, 3 + a] += w * rgb[v, u, a]
                rows[row, 6 + a] -= w * direction / ray
            rows[row, 9] += w
            rows[row, 10] = min(rows[row, 10], reach)
            if last[row] != frame:
                last[row] = frame
                rows[row, 11] += 1
    return count
