"""Contact sheets of the object catalogue, drawn with the product's own splats, and what each kind costs to build.

    python benchmarks/catalogue.py OUT            sheets OUT/catalogue_0.png ..., 30 kinds each, and OUT/costs.csv
    python benchmarks/catalogue.py OUT chair tree only the kinds whose noun contains one of the words
    python benchmarks/catalogue.py OUT --one-sheet  all kinds on one small sheet, OUT/catalogue.jpg

Light here is a sun and a sky with shadows, by depth maps: enough to judge shapes and materials by.
"""

import csv
import sys
import time
import zlib
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.worldgen.catalogue import KINDS
from flymirage_core.worldgen.kinds import Kind
from flymirage_core.worldgen.materials import Material, material_named
from flymirage_core.worldgen.meshes import mesh_of
from flymirage_core.worldgen.parts import Finish, paint
from flymirage_core.worldgen.sampling import splats
from flymirage_core.worldgen.surfaces import Part, Sheet, Surfels, surfels_of

Float = NDArray[np.float64]

SUN = np.array([0.45, 0.62, 0.75]) / np.linalg.norm([0.45, 0.62, 0.75])
FROM = np.array([0.55, 1.0, 0.42])
"""Direction in which the camera stands, from the object; +y is its front."""
FIELD_OF_VIEW = np.radians(26.0)
PIECES_ACROSS = 95.0
"""Surfels across an object's longest side."""


def main() -> None:
    folder, words = Path(sys.argv[1]), [w for w in sys.argv[2:] if not w.startswith("--")]
    folder.mkdir(parents=True, exist_ok=True)
    nouns = [n for n in KINDS if not words or any(w in n for w in words)]
    rows, tiles = [], []
    tile = 108 if "--one-sheet" in sys.argv else 230
    for noun in nouns:
        started = time.process_time()
        parts, size = example(noun, KINDS[noun])
        built = time.process_time()
        mesh = mesh_of(parts)
        meshed = time.process_time()
        surfels = joined(parts, max(size) / PIECES_ACROSS)
        cut = time.process_time()
        coarse = len(joined(parts, 0.05))
        costs = [f"{1e3 * t:.1f}" for t in (built - started, meshed - built, cut - meshed)]
        rows.append([noun, *(f"{v:.2f}" for v in size), len(parts), len(mesh.faces), coarse, *costs])
        tiles.append(labelled(photograph(surfels, size, 2 * tile), noun, tile))
    with (folder / "costs.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(
            ["noun", "x", "y", "z", "parts", "triangles", "surfels_at_5cm", "build_ms", "mesh_ms", "surfels_ms"]
        )
        writer.writerows(rows)
    if "--one-sheet" in sys.argv:
        cv2.imwrite(str(folder / "catalogue.jpg"), sheet(tiles, 16)[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 72])
    else:
        for i in range(0, len(tiles), 30):
            cv2.imwrite(str(folder / f"catalogue_{i // 30}.png"), sheet(tiles[i : i + 30], 6)[..., ::-1])
    total = [sum(float(r[i]) for r in rows) for i in (5, 7, 8, 9)]
    print(f"{len(nouns)} kinds: {total[0]:.0f} triangles; ms to build, mesh, cut: {total[1:]}")


def example(noun: str, kind: Kind) -> tuple[list[Part], tuple[float, float, float]]:
    """One specimen: a middling size in its usual colour and material."""
    seed = zlib.crc32(noun.encode())
    size = kind.size(np.random.default_rng(seed), 3.0)
    colour, material = kind.usual
    main = material_named(material, colour, seed % 997)
    second = "walnut brown" if main.texture == "wood" else "charcoal"
    accent = paint(second, "wood" if main.texture in ("wood", "fabric") else "metal", seed=seed % 991)
    return kind.build(size, Finish(main, accent, seed, seed)), size


def joined(parts: list[Part], spacing: float) -> Surfels:
    return Surfels.joined([surfels_of(p, spacing) for p in parts])


def photograph(surfels: Surfels, size: tuple[float, float, float], pixels: int) -> NDArray[np.uint8]:
    """(pixels, pixels, 3) the object on grey ground, seen from its front, a little to the right and above."""
    span = float(max(np.linalg.norm(size[:2]) * 0.95, size[2]))
    floor = Part(
        Sheet((-4 * span, -4 * span, 0.0), (8 * span, 0.0, 0.0), (0.0, 8 * span, 0.0)), Material((0.4, 0.4, 0.4))
    )
    scene = Surfels.joined([surfels, surfels_of(floor, span / 16)])
    cloud = splats(scene, shaded(scene, span / PIECES_ACROSS), 0.99)
    middle = np.array([0.0, 0.0, size[2] * 0.48])
    direction = FROM / np.linalg.norm(FROM)
    distance = 0.62 * span / np.tan(FIELD_OF_VIEW / 2)
    camera = Camera(
        Intrinsics.from_horizontal_fov(pixels, pixels, FIELD_OF_VIEW),
        look_along(middle + distance * direction, -direction),
    )
    view = next(iter(CpuRasterizer().render(cloud, [camera])))
    backdrop = 225 * (1 - view.alpha[..., None])
    return np.clip(view.rgb + backdrop, 0, 255).astype(np.uint8)


def shaded(surfels: Surfels, cell: float) -> Float:
    """sRGB colours (N, 3): sun with shadow, the part of the sky that is seen, and what glows."""
    angle = np.arange(28) * np.pi * (3 - 5**0.5)
    up = (np.arange(28) + 0.5) / 28
    sky = np.stack([np.cos(angle) * np.sqrt(1 - up**2), np.sin(angle) * np.sqrt(1 - up**2), up], 1)
    light = np.zeros(len(surfels))
    for direction in sky:
        light += np.maximum(surfels.normals @ direction, 0.0) * seen_from(surfels, direction, cell) / 14
    sun = np.maximum(surfels.normals @ SUN, 0.0) * seen_from(surfels, SUN, cell)
    total = 0.14 + 0.55 * light + 0.75 * sun
    linear = np.clip(surfels.albedo * (total[:, None] + 1.6 * surfels.emission[:, None]), 0.0, 1.0)
    return np.asarray(np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def seen_from(surfels: Surfels, direction: Float, cell: float) -> NDArray[np.bool_]:
    """(N,) whether light along ``direction`` reaches each surfel: a depth map with cells of ``cell`` metres."""
    side = np.cross(direction, [0.0, 0.0, 1.0] if abs(direction[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    over = np.cross(direction, side)
    u, v = (np.floor(surfels.points @ axis / (1.6 * cell)).astype(np.int64) for axis in (side, over))
    u, v, depth = u - u.min(), v - v.min(), surfels.points @ direction
    nearest = np.full((u.max() + 1, v.max() + 1), -np.inf)
    solid = surfels.opacity > 0.6
    np.maximum.at(nearest, (u[solid], v[solid]), depth[solid])
    return np.asarray(depth > nearest[u, v] - 3.5 * cell)


def labelled(picture: NDArray[np.uint8], noun: str, tile: int) -> NDArray[np.uint8]:
    small = np.ascontiguousarray(cv2.resize(picture, (tile, tile), interpolation=cv2.INTER_AREA))
    scale = 0.42 if tile > 150 else 0.3
    cv2.putText(small, noun, (4, tile - 5), cv2.FONT_HERSHEY_SIMPLEX, scale, (30, 30, 30), 1, cv2.LINE_AA)
    return np.asarray(small, np.uint8)


def sheet(tiles: list[NDArray[np.uint8]], columns: int) -> NDArray[np.uint8]:
    blank = np.full_like(tiles[0], 255)
    filled = tiles + [blank] * (-len(tiles) % columns)
    return np.vstack([np.hstack(filled[i : i + columns]) for i in range(0, len(filled), columns)])


if __name__ == "__main__":
    main()
