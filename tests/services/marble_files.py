"""A world as Marble would hand it out: SPZ version 2 in its frame (x right, y down, z forward), collider, panorama."""

import gzip
import io
import struct
from dataclasses import dataclass

import numpy as np
import trimesh
from fake_openai import png
from numpy.typing import NDArray

from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.splats.frames import Z_UP_FROM, transformed

SCALE = 2.5
GROUND = 1.5


@dataclass(frozen=True)
class Originals:
    """The files of one world, by name, and what its semantics say."""

    files: dict[str, bytes]
    scale: float = SCALE
    ground: float = GROUND


def originals_of(cloud: GaussianCloud, collider_turned: bool = False, scale: float = SCALE, ground: float = GROUND):
    """``cloud`` (world frame, its camera ``ground`` above the floor) in Marble's terms.

    With ``collider_turned`` the collider is stored y up, as one observer measured; else in Marble's own frame.
    """
    down = Z_UP_FROM["-y"].T
    raw = transformed(cloud, down, 1 / scale, down @ [0, 0, -ground] / scale)
    low, high = raw.means.min(axis=0), raw.means.max(axis=0)
    box = trimesh.creation.box(bounds=[low, high]).subdivide_loop(0)
    if collider_turned:
        box.vertices = box.vertices * [1, -1, -1]
    glb = trimesh.Scene({"collider": box}).export(file_type="glb")
    return Originals(
        {"full_res.spz": spz2(raw), "collider.glb": glb, "pano.png": png(128, 64, "panorama")}, scale, ground
    )


def spz2(cloud: GaussianCloud, fraction_bits: int = 12) -> bytes:
    """SPZ version 2 as the format's own description has it; DC colour only, as Marble's files."""
    count = len(cloud)
    fixed = np.rint(cloud.means.astype(np.float64) * (1 << fraction_bits)).astype(np.int32)
    positions = np.ascontiguousarray(fixed).view(np.uint8).reshape(count, 3, 4)[:, :, :3]
    sign = np.where(cloud.quaternions[:, 3:] < 0, -1.0, 1.0)  # w is not stored, so it is made positive
    out = io.BytesIO()
    out.write(struct.pack("<IIIBBBB", 0x5053474E, 2, count, 0, fraction_bits, 0, 0))
    out.write(positions.tobytes())
    out.write(_byte(cloud.opacities * 255).tobytes())
    out.write(_byte(cloud.sh[:, 0] * 0.15 * 255 + 0.5 * 255).tobytes())
    out.write(_byte((np.log(cloud.scales) + 10) * 16).tobytes())
    out.write(_byte(cloud.quaternions[:, :3] * sign * 127.5 + 127.5).tobytes())
    return gzip.compress(out.getvalue(), mtime=0)


def _byte(values: NDArray[np.float32]) -> NDArray[np.uint8]:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)
