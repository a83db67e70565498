"""Collision meshes: triangles of the world frame (z up, metres) from and to GLB, which is y up by its standard.

World (x, y, z) is stored as glTF (x, z, -y), so that any viewer shows the place upright; reading turns it back.
"""

import io

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from trimesh.exchange.gltf import export_glb

from flymirage_core.errors import WorldError

Triangles = tuple[NDArray[np.float64], NDArray[np.int64]]
"""Vertices (V, 3), world frame, and faces (F, 3), counter-clockwise seen from outside."""


def to_glb(vertices: ArrayLike, faces: ArrayLike) -> bytes:
    """A GLB of one mesh: ``vertices`` (V, 3) metres, world frame; ``faces`` (F, 3) indices. Same input, same bytes."""
    x, y, z = np.asarray(vertices, np.float64).T
    mesh = trimesh.Trimesh(np.stack([x, z, -y], axis=1), np.asarray(faces, np.int64), process=False)
    scene = trimesh.Scene()
    scene.add_geometry(mesh, geom_name="collider")
    return bytes(export_glb(scene))  # type: ignore[no-untyped-call]


def from_glb(data: bytes) -> Triangles:
    """All triangles of a GLB in one mesh, its nodes' transforms applied, glTF's y up turned to z up.

    Raises:
        WorldError: the bytes are no GLB, or hold no triangle.
    """
    try:
        mesh = trimesh.load_scene(io.BytesIO(data), file_type="glb").to_mesh()
    except Exception as error:  # whatever a damaged file makes of the decoder
        raise WorldError(f"collider: {len(data)} bytes are not a whole GLB file ({error}); get it again") from error
    if len(mesh.faces) == 0:
        raise WorldError("collider: the GLB holds no triangles; export it again")
    x, y, z = np.asarray(mesh.vertices, np.float64).T
    return np.stack([x, -z, y], axis=1), np.asarray(mesh.faces, np.int64)
