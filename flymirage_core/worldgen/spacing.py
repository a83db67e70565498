"""How finely each part of a world is cut: small things and what drones see finer, so that the count comes out."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.assembly import Assembly
from flymirage_core.worldgen.meshes import TexturedMesh
from flymirage_core.worldgen.rays import RayCaster
from flymirage_core.worldgen.surfaces import EDGE_CELLS, FINE_JOINTS, Leaves
from flymirage_core.worldgen.visibility import pixels_per_area

Float = NDArray[np.float64]

SMALL: Final = 1.1
"""Metres; things smaller than this are cut finer, down to `FINEST` of the spacing."""
FINEST: Final = 0.45
LOOKED_AT: Final = 1 / 3
"""Root of how much of what drones see a part is, by which its spacing falls: at edges, error grows with the spacing."""
LOOKED_AT_RANGE: Final = (0.5, 5.0)
"""Factors on the spacing between which that holds."""
FLOWN: Final = np.array([13.0, 13.0, 3.2])
"""Metres from c: what reaches into it is at most `NEARBY` times as coarse, however little is seen of the whole of it:
large faces are seen in places. For each metre beyond, `COARSER` more."""
NEARBY, COARSER = 1.3, 0.11
HIGH_LOW: Final = (4.0, -1.0)
"""Metres: what lies wholly above or below is far as well."""
RING: Final = 200
"""Surfaces of more points than this may be rings round everything: their nearest point counts, not their bounds."""
SEEN: Final = 0.8
"""Share of all surfels that can be seen, as it usually is."""
RANGE: Final = (0.004, 1.0)
"""Metres between which the spacing is looked for."""
HALVINGS: Final = 24


def coarseness(assembly: Assembly, mesh: TexturedMesh, opaque: RayCaster) -> Float:
    """(M,) factor on the spacing of each part; ``opaque`` are the mesh's `opaque_faces`."""
    finest, coarsest = LOOKED_AT_RANGE
    most = np.minimum(NEARBY + COARSER * _distance(assembly, mesh), coarsest)
    seen = np.clip(pixels_per_area(assembly, mesh, opaque) ** -LOOKED_AT, finest, most)
    owner = np.repeat([t.object_id for t in assembly.things], [len(t.parts) for t in assembly.things])
    sizes = np.array([max(o.size) for o in assembly.truth.objects] or [1.0])
    fine = np.clip(np.sqrt(sizes[np.maximum(owner, 0)] / SMALL), FINEST, 1.0)
    return np.asarray(seen * np.where(owner >= 0, fine, 1.0))


def _distance(assembly: Assembly, mesh: TexturedMesh) -> Float:
    """(M,) metres from each part to the region that is flown in."""
    count = len(assembly.parts)
    part = np.zeros(len(mesh.vertices), np.int64)
    part[mesh.faces.ravel()] = np.repeat(mesh.face_part, 3)
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, part, mesh.vertices)
    np.maximum.at(high, part, mesh.vertices)
    centre = np.array(assembly.truth.centre)
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, part, _outside(mesh.vertices, mesh.vertices, centre))
    return np.where(np.bincount(part, minlength=count) > RING, nearest, _outside(low, high, centre))


def _outside(low: Float, high: Float, centre: Float) -> Float:
    """(N,) metres from boxes to the region that is flown in."""
    off = np.maximum(np.maximum(low - centre - FLOWN, centre - FLOWN - high), 0.0)
    off[:, 2] = np.maximum(np.maximum(low[:, 2] - HIGH_LOW[0], HIGH_LOW[1] - high[:, 2]), 0.0)
    return np.asarray(np.linalg.norm(off, axis=1))


def spacing_for(assembly: Assembly, mesh: TexturedMesh, factors: Float, count: int) -> float:
    """Metres between surfels of factor 1 that give about ``count`` visible ones: halving, on cells counted by area."""
    parts = assembly.parts
    leaves = sum(2 * len(p.surface.centres) for p in parts if isinstance(p.surface, Leaves))
    solid = np.array([not isinstance(p.surface, Leaves) for p in parts])
    detail = np.array([p.material.detail for p in parts]) * factors
    joints = np.array([p.material.joints[:2] for p in parts])  # (M, 2)
    stretch = np.sqrt([p.material.stretch for p in parts])
    first = mesh.faces[:, 0]
    rows = np.unique(np.column_stack([mesh.face_part, mesh.extent[first]])[solid[mesh.face_part]], axis=0)
    part, extent = rows[:, 0].astype(int), rows[:, 1:]  # the patches of all parts: (K,), (K, 2)
    listed = np.bincount(part, extent.prod(axis=1), len(parts))
    repeats = np.maximum(np.rint(mesh.areas() / np.maximum(listed, 1e-9)), 1)[part]  # a block's sides
    low, high = RANGE
    for _ in range(HALVINGS):
        spacing = np.sqrt(low * high)
        side = spacing * detail[part]
        sides = np.stack([side * stretch[part], side / stretch[part]], 1)  # (K, 2)
        cells = _cells(extent, sides, joints[part]).prod(axis=1)
        if SEEN * (cells * repeats).sum() + leaves > count:
            low = spacing
        else:
            high = spacing
    return float(high)


def _cells(length: Float, spacing: Float, pitch: Float) -> Float:
    """About how many cells `surfaces.cells` makes of lengths with joints of a pitch (0: none)."""
    share = length / spacing
    plain = np.where(share < 0.4, 1.0, np.maximum(share + 4 - 2 * sum(EDGE_CELLS), 3.0))
    between = 1 + np.maximum(np.rint(pitch / spacing), 1)
    return np.where(pitch > FINE_JOINTS * spacing, length / np.maximum(pitch, 1e-9) * between, plain)
