"""How much of what a drone sees each part of a world is: rays from where drones fly, counted where they end."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.scene.keys import rng as seeded
from flymirage_core.worldgen.assembly import Assembly
from flymirage_core.worldgen.meshes import TexturedMesh
from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.truth import WorldTruth

Float = NDArray[np.float64]

SPOTS, RAYS_A_SPOT = 300, 400
REACH: Final = 10.0
"""Metres from c, across, within which the spots lie."""
HEIGHTS: Final = (0.4, 3.2)
"""Metres above the ground."""
BALL: Final = 0.3
"""Metres round a spot that are free."""
STEEPEST: Final = 0.75
"""Radians: cameras look this far up and down."""
FEW: Final = 20.0
"""A part that is hit less often is thought to be seen like the thing that it is of; and that like everything."""
TRIES: Final = 200
"""Rounds of looking for free spots, of as many as are wanted each."""


def pixels_per_area(assembly: Assembly, mesh: TexturedMesh, opaque: RayCaster) -> Float:
    """(M,) rays that end on each part, per square metre, as a multiple of the mean; ``opaque``: `opaque_faces`."""
    truth = assembly.truth
    generator = seeded(truth.scene, "what drones see")
    spots = flown_spots(truth, SPOTS, generator)
    origins = np.repeat(spots, RAYS_A_SPOT, axis=0)
    yaw = generator.uniform(0, 2 * np.pi, len(origins))
    rise = np.tan(generator.uniform(-STEEPEST, STEEPEST, len(origins)))
    rays = np.column_stack([np.cos(yaw), np.sin(yaw), rise]) / np.sqrt(1 + rise * rise)[:, None]
    hit = opaque.hits(origins, rays).face
    count = len(assembly.parts)
    hits = np.bincount(mesh.face_part[mesh.opaque()[hit[hit >= 0]]], minlength=count).astype(float)
    areas = mesh.areas()
    owner = np.repeat(np.arange(len(assembly.things)), [len(t.parts) for t in assembly.things])
    mean = hits.sum() / areas.sum()
    whole = (np.bincount(owner, hits) + FEW) / (np.bincount(owner, areas) + FEW / mean)
    return np.asarray((hits + FEW) / (areas + FEW / whole[owner]) / mean)


def flown_spots(truth: WorldTruth, count: int, generator: np.random.Generator) -> Float:
    """Up to ``count`` places (N, 3) where a drone can be, spread evenly over the free space round c; or c itself."""
    centre = np.array(truth.centre)
    near = np.array([REACH, REACH, np.inf])
    low = np.array([np.maximum(np.maximum(s.low, centre - near), [-np.inf, -np.inf, HEIGHTS[0]]) for s in truth.spaces])
    high = np.array([np.minimum(np.minimum(s.high, centre + near), [np.inf, np.inf, HEIGHTS[1]]) for s in truth.spaces])
    room = np.maximum(high - low, 0.0).prod(axis=1)
    if room.sum() == 0:
        return centre[None]
    offsets = BALL * np.stack(np.meshgrid(*[[-1, 0, 1]] * 3), axis=-1).reshape(-1, 3)
    found = np.zeros((0, 3))
    for _ in range(TRIES):
        space = generator.choice(len(room), count, p=room / room.sum())
        spots = generator.uniform(low[space], high[space])
        free = truth.is_free((spots[:, None] + offsets).reshape(-1, 3)).reshape(-1, len(offsets)).all(axis=1)
        found = np.concatenate([found, spots[free]])
        if len(found) >= count:
            return found[:count]
    return found if len(found) else centre[None]
