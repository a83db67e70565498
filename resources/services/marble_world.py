"""From Marble's originals to a `World`: frame (contract, section 1.9), collider, panorama, and what is told of them."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from flymirage_core.errors import WorldError
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.collider import from_glb, to_glb
from flymirage_core.splats.frames import Z_UP_FROM, MarbleSemantics
from flymirage_core.splats.imports import import_marble_world, import_world
from flymirage_core.splats.world import World
from resources.services.marble_api import Semantics

COLLIDER_FIT = 0.03
"""Median distance from the collider to the Gaussians, as a share of the world's diagonal, up to which it fits."""
COLLIDER_POINTS = 20_000
GAUSSIANS = 75_000
FRAMES = {"Marble's": np.diag([1.0, 1.0, 1.0]), "Marble's turned by 180 degrees about x": np.diag([1.0, -1.0, -1.0])}
"""In which the collider may be stored; the vendor does not say."""


def world_from_originals(
    spz: Path, semantics: Semantics | None, collider: bytes | None, panorama: bytes | None, cleaning: CleaningSettings
) -> World:
    """The world in the metric z-up frame. Where Marble does not tell scale or ground, they are assumed or estimated,
    and the notes say so.

    Raises `WorldError` if the splat file cannot be used; collider and panorama are left out if they cannot.
    """
    scale = None if semantics is None else semantics.metric_scale_factor
    ground = None if semantics is None else semantics.ground_plane_offset
    if scale is not None and ground is not None:
        world = import_marble_world(spz, MarbleSemantics(scale, ground), cleaning)
        notes: dict[str, Any] = {"semantics": "from Marble"}
        if scale == 1.0:
            notes["semantics"] = "from Marble, which could not infer the scale"
    else:
        world = import_world(spz, "-y", scale, cleaning)
        notes = {"semantics": "Marble gave none: scale assumed 1, ground estimated from the Gaussians"}
        if scale is not None:
            notes["semantics"] = "Marble gave no ground: estimated from the Gaussians"
    return replace(
        world,
        collider=_collider(collider, world, notes) if collider is not None else None,
        panorama=_panorama(panorama, notes) if panorama is not None else None,
        notes={**world.notes, **notes},
    )


def _collider(glb: bytes, world: World, notes: dict[str, Any]) -> bytes | None:
    """The collider in the world's frame: of the frames it may be stored in, the one that fits the Gaussians."""
    try:
        upright, faces = from_glb(glb)
    except WorldError as error:
        notes["collider"] = f"left out: {error}"
        return None
    stored = np.stack([upright[:, 0], upright[:, 2], -upright[:, 1]], axis=1)  # (V, 3) as in the file
    scale = float(world.notes["scale"])
    candidates = {
        name: scale * stored @ (Z_UP_FROM["-y"] @ turn).T + world.centre for name, turn in FRAMES.items()
    }  # Marble's camera, its origin, is c
    misfits = {name: _misfit(vertices, faces, world) for name, vertices in candidates.items()}
    best = min(misfits, key=lambda name: misfits[name])
    notes["collider_misfit"] = round(misfits[best], 4)
    if misfits[best] > COLLIDER_FIT:
        notes["collider"] = f"left out: in no frame does it fit the Gaussians ({misfits[best]:.1%} of the diagonal)"
        return None
    notes["collider"] = f"stored in the frame {best}"
    return to_glb(candidates[best], faces)


def _misfit(vertices: NDArray[np.float64], faces: NDArray[np.int64], world: World) -> float:
    """Median distance of points on the mesh to the next Gaussian, as a share of the Gaussians' diagonal."""
    generator = np.random.default_rng(0)
    corners = vertices[faces]  # (F, 3, 3)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    if not areas.sum() > 0:
        return float("inf")
    chosen = generator.choice(len(faces), COLLIDER_POINTS, p=areas / areas.sum())
    weights = generator.dirichlet(np.ones(3), COLLIDER_POINTS)  # (P, 3)
    points = (corners[chosen] * weights[:, :, None]).sum(axis=1)
    means = world.cloud.means
    some = means[generator.choice(len(means), min(GAUSSIANS, len(means)), replace=False)]
    low, high = np.quantile(some, [0.01, 0.99], axis=0)
    distances, _ = cKDTree(some).query(points)
    return float(np.median(distances) / max(float(np.linalg.norm(high - low)), 1e-9))


def _panorama(data: bytes, notes: dict[str, Any]) -> NDArray[np.uint8] | None:
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    if image is None:
        notes["panorama"] = f"left out: its {len(data)} bytes are no picture"
        return None
    return np.ascontiguousarray(image[:, :, ::-1], np.uint8)
