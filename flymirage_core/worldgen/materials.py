"""What surfaces look like before light falls on them: materials, and procedural textures that give albedo per point.

Colours are linear RGB in [0, 1]. Textures are functions of metres, so grain and tiles have their real size.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.colours import linear_rgb

Float = NDArray[np.float64]

DENSE_TEXTURE = 0.6
"""Spacing factor of surfaces that carry a picture."""


@dataclass(frozen=True)
class Material:
    """A surface's look.

    ``joints`` are (pitch along u, pitch along v, width) in metres, 0 = none; ``stretch`` is how much longer than wide
    its surfels are (along the grain); ``detail`` multiplies the surfels' spacing.
    """

    colour: tuple[float, float, float]
    texture: str = "plain"
    emission: float = 0.0  # radiance that it gives off, as a multiple of its colour
    joints: tuple[float, float, float] = (0.0, 0.0, 0.0)
    stretch: float = 1.0
    detail: float = 1.0
    seed: int = 0
    opacity: float = 1.0  # of its splats: glass lets through what is behind it

    def shaded(self, factor: float) -> "Material":
        """The same material, lighter or darker."""
        r, g, b = (min(c * factor, 0.95) for c in self.colour)
        return replace(self, colour=(r, g, b))


MATERIAL_TEXTURES = {
    "wood": ("oak", "walnut", "pine", "beech", "birch", "ash", "teak", "plywood", "wood", "bamboo", "wicker", "rattan"),
    "fabric": ("linen", "velvet", "wool", "felt", "cotton", "canvas", "fabric", "tweed"),
    "metal": ("steel", "brass", "iron", "aluminium", "copper", "chrome", "metal"),
    "stone": ("marble", "concrete", "granite", "stone", "terrazzo", "terracotta"),
    "paper": ("cardboard", "paper"),
    "leaf": ("foliage",),
}


def material_named(name: str, colour: str, seed: int = 0) -> Material:
    """The look of a description's words, e.g. ("oak", "honey brown"); what is not known is smooth paint."""
    words = set(name.lower().split())
    texture = next((t for t, names in MATERIAL_TEXTURES.items() if words & set(names)), "plain")
    return Material(linear_rgb(colour), texture, stretch=2.0 if texture == "wood" else 1.0, seed=seed)


def albedo(material: Material, uv: Float, extent: tuple[float, float], points: Float) -> Float:
    """Linear albedo (N, 3) at surface coordinates ``uv`` (N, 2) metres on a patch of ``extent`` metres.

    ``points`` (N, 3) are object coordinates in metres; they decorrelate the patches of one object.
    """
    base = np.asarray(material.colour)[None, :]
    tint = TEXTURES[material.texture](uv, extent, points, material.seed)
    return np.clip(base * tint if material.texture not in PICTURES else tint, 0.0, 0.95)


def value_noise(coordinates: Float, seed: int) -> Float:
    """Smooth noise (N,) in [-1, 1] with one bump a unit, over coordinates (N, D)."""
    cell = np.floor(coordinates).astype(np.int64)  # (N, D)
    inside = coordinates - cell
    weight = inside * inside * (3 - 2 * inside)  # (N, D)
    total = np.zeros(len(coordinates))
    for corner in np.ndindex(*(2,) * coordinates.shape[1]):
        share = np.where(np.array(corner) == 1, weight, 1 - weight).prod(axis=1)
        total += share * lattice_hash(cell + np.array(corner), seed)
    return total * 2 - 1


def lattice_hash(cell: NDArray[np.int64], seed: int) -> Float:
    """A fixed uniform number in [0, 1) for each integer lattice point (N, D)."""
    state = np.full(len(cell), np.uint64(seed * 2654435761 % 2**32), np.uint64)
    for column in cell.T:
        state = (state ^ (column.astype(np.uint64) & np.uint64(0xFFFFFFFF))) * np.uint64(0x9E3779B97F4A7C15)
        state ^= state >> np.uint64(29)
    state = state * np.uint64(0xBF58476D1CE4E5B9)
    return (state >> np.uint64(40)).astype(np.float64) / 2**24


def _grey(value: Float) -> Float:
    return np.repeat(value[:, None], 3, axis=1)  # (N, 3)


def _plain(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    return _grey(1 + 0.03 * value_noise(points * 3.0, seed))


def _plaster(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    blotches = value_noise(points * 0.9, seed) + 0.5 * value_noise(points * 4.0, seed + 1)
    return _grey(1 + 0.045 * blotches)


def _wood(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    along, across = uv[:, 0], uv[:, 1]
    offset = points.sum(axis=1) * 0.05
    warp = value_noise(np.stack([along * 1.3, across * 5.0 + offset], 1), seed)
    grain = value_noise(np.stack([along * 2.0, across * 20.0 + 2 * warp], 1), seed + 1)
    tone = 1 + 0.10 * warp + 0.14 * grain
    return np.stack([tone, tone * (1 - 0.02 * grain), tone * (1 - 0.05 * grain)], 1)


def _planks(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    width, length = 0.16, 1.4
    row = np.floor(uv[:, 1] / width).astype(np.int64)
    shift = lattice_hash(row[:, None], seed) * length
    board = np.stack([np.floor((uv[:, 0] + shift) / length).astype(np.int64), row], 1)
    tone = 1 + 0.34 * (lattice_hash(board, seed + 7) - 0.5)
    shade = 0.10 * (lattice_hash(board, seed + 9) - 0.5)
    inside = uv[:, 1] / width - row
    seam = np.where(np.minimum(inside, 1 - inside) * width < 0.006, 0.62, 1.0)
    butt = (uv[:, 0] + shift) % length
    seam = np.where(np.minimum(butt, length - butt) < 0.012, 0.72, seam)
    grain = _wood(uv, extent, points, seed)
    return grain * (tone * seam)[:, None] * np.stack([1 + shade, 1 + 0 * shade, 1 - shade], 1)


def _tiles(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    pitch = 0.5
    cell = np.floor(uv / pitch).astype(np.int64)
    inside = uv - cell * pitch
    joint = (np.minimum(inside, pitch - inside) < 0.006).any(axis=1)
    tone = 1 + 0.10 * (lattice_hash(cell, seed) - 0.5) + 0.05 * value_noise(uv * 6.0, seed + 3)
    return _grey(np.where(joint, 0.6, tone))


def _bricks(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    height, length = 0.1, 0.3
    row = np.floor(uv[:, 1] / height).astype(np.int64)
    along = uv[:, 0] / length + 0.5 * (row % 2)
    brick = np.stack([np.floor(along).astype(np.int64), row], 1)
    across = uv[:, 1] - row * height
    end = (along - brick[:, 0]) * length
    mortar = (np.minimum(across, height - across) < 0.006) | (np.minimum(end, length - end) < 0.008)
    tone = 1 + 0.4 * (lattice_hash(brick, seed) - 0.5) + 0.08 * value_noise(uv * 12.0, seed + 1)
    return _grey(np.where(mortar, 1.25, tone))


def _carpet(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    return _grey(1 + 0.10 * value_noise(uv * 25.0, seed) + 0.06 * value_noise(uv * 2.0, seed + 1))


def _fabric(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    weave = value_noise(points * 40.0, seed) + value_noise(points * 7.0, seed + 1)
    return _grey(1 + 0.06 * weave)


def _metal(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    brushed = value_noise(np.stack([uv[:, 0] * 1.0, uv[:, 1] * 30.0], 1), seed)
    sheen = 0.18 * np.sin(points[:, 2] * 5.0 + points[:, 0] * 3.0 + seed)
    return _grey(1 + 0.06 * brushed + sheen)


def _stone(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    cloud = value_noise(points * 2.5, seed) + 0.6 * value_noise(points * 9.0, seed + 1)
    vein = np.exp(-((value_noise(points * 1.7, seed + 2) * 6) ** 2))
    return _grey(1 + 0.09 * cloud - 0.12 * vein)


def _paper(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    tape = np.abs(uv[:, 1] - extent[1] / 2) < 0.03
    return _grey((1 + 0.05 * value_noise(points * 8.0, seed)) * np.where(tape, 1.18, 1.0))


def _leaf(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    tone = 1 + 0.35 * value_noise(points * 14.0, seed)
    return np.stack([tone * (1 + 0.1 * value_noise(points * 5.0, seed + 1)), tone, tone * 0.9], 1)


def _rug(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    rim = np.minimum(np.minimum(uv[:, 0], extent[0] - uv[:, 0]), np.minimum(uv[:, 1], extent[1] - uv[:, 1]))
    band = np.where((rim > 0.10) & (rim < 0.20), 1.7, np.where(rim < 0.04, 0.7, 1.0))
    diamonds = np.abs((uv[:, 0] * 2.2) % 1 - 0.5) + np.abs((uv[:, 1] * 2.2) % 1 - 0.5)
    field = np.where((rim > 0.3) & (diamonds < 0.22), 1.45, 1.0)
    return np.asarray(_carpet(uv, extent, points, seed) * (band * field)[:, None])


def _painting(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    """Soft horizontal bands with a few round shapes over them, in colours that go together: absolute albedo."""
    generator = np.random.default_rng(seed)
    hue = generator.uniform(0, 2 * np.pi)
    x, y = uv[:, 0] / extent[0], uv[:, 1] / extent[1]
    wobble = 0.12 * value_noise(np.stack([x * 3.0, y * 2.0], 1), seed)
    band = np.floor((y + wobble) * generator.integers(3, 6)).astype(np.int64)
    image = _hue(np.asarray(hue + band * generator.uniform(0.3, 0.7)), np.asarray(0.16 + 0.12 * (band % 3)))
    for _ in range(int(generator.integers(1, 4))):
        centre, radius = generator.uniform(0.2, 0.8, 2), generator.uniform(0.1, 0.24)
        inside = np.hypot(x - centre[0], (y - centre[1]) * extent[1] / extent[0]) < radius
        image[inside] = _hue(np.full(1, hue + generator.uniform(2, 4)), np.full(1, generator.uniform(0.15, 0.5)))
    return np.asarray(image) * (1 + 0.08 * value_noise(uv * 20.0, seed))[:, None]


def _hue(angle: Float, level: Float) -> Float:
    phases = np.array([0.0, 2.1, 4.2])
    return np.asarray(level[..., None] * (1 + 0.42 * np.cos(angle[..., None] - phases)), np.float64)


def _screen(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    """A dark screen with a few lines of something on it: absolute albedo."""
    x, y = uv[:, 0] / extent[0], uv[:, 1] / extent[1]
    image = np.stack([0.02 + 0.03 * y, 0.03 + 0.05 * y, 0.06 + 0.10 * y], 1)
    line = np.floor(y * 9).astype(np.int64)
    length = 0.25 + 0.5 * lattice_hash(line[:, None], seed)
    text = (y * 9 - line > 0.35) & (y * 9 - line < 0.65) & (x > 0.1) & (x < length) & (line > 0) & (line < 8)
    image[text] = (0.25, 0.32, 0.36)
    return np.asarray(image)


def _notes(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    """A board with sheets of paper on it: absolute albedo."""
    image = np.tile([0.36, 0.22, 0.11], (len(uv), 1)) * (1 + 0.1 * value_noise(uv * 30.0, seed))[:, None]
    generator = np.random.default_rng(seed)
    for _ in range(7):
        centre = generator.uniform(0.1, 0.9, 2) * extent
        paper = generator.choice([[0.75, 0.74, 0.7], [0.7, 0.6, 0.25], [0.35, 0.55, 0.6], [0.65, 0.35, 0.32]])
        image[(np.abs(uv - centre) < (0.08, 0.11)).all(axis=1)] = paper
    return image


def _sky(uv: Float, extent: tuple[float, float], points: Float, seed: int) -> Float:
    """What a window shows: sky over a soft line of trees: absolute albedo, made bright by the material's emission."""
    x, y = uv[:, 0], uv[:, 1] / extent[1]
    sky = np.stack([0.52 + 0.25 * (1 - y), 0.66 + 0.17 * (1 - y), 0.86 + 0.04 * (1 - y)], 1)
    cloud = np.clip(value_noise(np.stack([x * 1.2, y * 3.5], 1), seed), 0, 1)[:, None]
    sky = sky * (1 - 0.5 * cloud) + 0.9 * 0.5 * cloud
    trees = y < 0.30 + 0.09 * value_noise(np.stack([x * 4.0, 0 * x], 1), seed + 5)
    leaves = (
        np.array([0.16, 0.24, 0.12]) * (1 + 0.35 * value_noise(np.stack([x * 14.0, y * 14.0], 1), seed + 6))[:, None]
    )
    return np.where(trees[:, None], leaves, sky)


Texture = Callable[[Float, tuple[float, float], Float, int], Float]
TEXTURES: dict[str, Texture] = {
    "plain": _plain,
    "plaster": _plaster,
    "wood": _wood,
    "planks": _planks,
    "tiles": _tiles,
    "bricks": _bricks,
    "carpet": _carpet,
    "fabric": _fabric,
    "metal": _metal,
    "stone": _stone,
    "paper": _paper,
    "leaf": _leaf,
    "rug": _rug,
    "painting": _painting,
    "screen": _screen,
    "notes": _notes,
    "sky": _sky,
}
PICTURES = {"painting", "screen", "notes", "sky"}
"""Textures that give albedo itself rather than a factor on the material's colour."""
