"""Procedural textures: factors on a material's colour, as functions of metres on the surface and in the object."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.noise import Float, fractal, lattice_hash, value_noise

Extent = tuple[float, float]
Texture = Callable[[Float, Extent, Float, int], Float]
"""(uv (N, 2), extent, points (N, 3), seed) -> factors (N, 3) on the material's colour."""


def _grey(value: Float) -> Float:
    return np.repeat(value[:, None], 3, axis=1)  # (N, 3)


def _plain(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    return _grey(1 + 0.03 * value_noise(points * 3.0, seed))


def _plaster(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    blotches = value_noise(points * 0.9, seed) + 0.5 * value_noise(points * 4.0, seed + 1)
    return _grey(1 + 0.045 * blotches)


def _wood(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Grain along u: long streaks, and the growth rings of a plain-sawn board."""
    along, across = uv[:, 0], uv[:, 1]
    offset = points.sum(axis=1) * 0.05
    warp = value_noise(np.stack([along * 1.3, across * 5.0 + offset], 1), seed)
    grain = value_noise(np.stack([along * 2.0, across * 22.0 + 2 * warp], 1), seed + 1)
    rings = np.sin(across * 95.0 + 5.0 * value_noise(np.stack([along * 0.9, across * 3.0], 1), seed + 2))
    tone = 1 + 0.11 * warp + 0.13 * grain + 0.05 * rings
    return np.stack([tone, tone * (1 - 0.02 * grain), tone * (1 - 0.05 * grain)], 1)


def _planks(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
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


def _tiled(pitch: float) -> Texture:
    def tiles(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
        cell = np.floor(uv / pitch).astype(np.int64)
        inside = uv - cell * pitch
        joint = (np.minimum(inside, pitch - inside) < 0.006).any(axis=1)
        tone = 1 + 0.10 * (lattice_hash(cell, seed) - 0.5) + 0.05 * value_noise(uv * 6.0, seed + 3)
        return _grey(np.where(joint, 0.6, tone))

    return tiles


BRICK: Extent = (0.3, 0.1)
"""Metres of a brick with its joint."""


def _brick(uv: Float) -> tuple[NDArray[np.int64], Float]:
    """(N, 2) which brick, and (N, 2) metres from its lower left corner; every other course is shifted by half."""
    length, height = BRICK
    row = np.floor(uv[:, 1] / height).astype(np.int64)
    along = uv[:, 0] / length + 0.5 * (row % 2)
    brick = np.stack([np.floor(along).astype(np.int64), row], 1)
    return brick, np.stack([(along - brick[:, 0]) * length, uv[:, 1] - row * height], 1)


def _bricks(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Each brick of its own tone and warmth, a few of them burnt dark, over slow clouds of soot."""
    brick, _ = _brick(uv)
    warm = lattice_hash(brick, seed + 5) - 0.5
    tone = 1 + 0.34 * (lattice_hash(brick, seed) - 0.5) + 0.14 * value_noise(points * 0.7, seed + 1)
    tone = tone * np.where(lattice_hash(brick, seed + 9) > 0.94, 0.6, 1.0)
    return np.stack([tone * (1 + 0.1 * warm), tone * (1 - 0.1 * warm), tone * (1 - 0.25 * warm)], 1)


def _mortar(uv: Float) -> Float:
    """(N,) 1 in the joints of bricks."""
    _, inside = _brick(uv)
    return (np.minimum(inside, np.array(BRICK) - inside) < (0.006, 0.006)).any(axis=1).astype(float)


def runs(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """(N,) how much dirt rain has washed down from a patch's upper edge: streaks that fade in about a metre."""
    down = extent[1] - uv[:, 1]
    streak = value_noise(np.stack([uv[:, 0] * 5.0, 0.25 * down], 1), seed + 61)
    broad = value_noise(np.stack([uv[:, 0] * 1.1, 0.1 * down], 1), seed + 62)
    return np.asarray(np.clip(0.35 + 0.8 * streak + 0.5 * broad, 0.0, 1.0) * np.exp(-down / 0.9))


def _carpet(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    return _grey(1 + 0.10 * value_noise(uv * 25.0, seed) + 0.06 * value_noise(uv * 2.0, seed + 1))


def _fabric(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    weave = value_noise(points * 40.0, seed) + value_noise(points * 7.0, seed + 1)
    return _grey(1 + 0.06 * weave)


def _velvet(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    return _grey(1 + 0.16 * fractal(points * 6.0, seed))


def _leather(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    crease = np.exp(-((value_noise(points * 9.0, seed) * 5) ** 2))
    return _grey(1 + 0.08 * value_noise(points * 4.0, seed + 1) - 0.10 * crease)


def _wicker(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Over and under in a basket's weave, 3 cm a strand."""
    strand = np.floor(uv / 0.03).astype(np.int64)
    over = (strand.sum(axis=1) % 2).astype(float)
    return _grey(0.78 + 0.3 * over + 0.12 * (lattice_hash(strand, seed) - 0.5))


def _metal(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    streaks = value_noise(np.stack([uv[:, 0] * 1.0, uv[:, 1] * 30.0], 1), seed)
    sheen = 0.10 * np.sin(points[:, 2] * 5.0 + points[:, 0] * 3.0 + seed)
    return _grey(1 + 0.05 * streaks + sheen)


def _brushed(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """A polished cylinder's or sheet's broad reflections: bright and dark bands across, fine lines along."""
    lines = value_noise(np.stack([uv[:, 0] * 3.0, uv[:, 1] * 60.0], 1), seed)
    sheen = np.sin(points[:, 0] * 7.0 + points[:, 2] * 2.5 + points[:, 1] * 4.0 + seed)
    return _grey(0.95 + 0.05 * lines + 0.22 * sheen)


def _enamel(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Paint on metal: even, with chips that show rust at some places."""
    chips = np.clip(fractal(points * 6.0, seed) - 0.64, 0.0, 0.12)[:, None] / 0.12
    even = _grey(1 + 0.03 * value_noise(points * 1.5, seed + 3))
    return np.asarray(even * (1 - 0.7 * chips) + chips * np.array([0.28, 0.14, 0.08]))


def _rust(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Brown and orange patches, with streaks running down."""
    patch = fractal(points * 3.5, seed)
    streak = value_noise(points * np.array([14.0, 14.0, 1.2]), seed + 5)
    t = np.clip(0.5 + 0.8 * patch + 0.25 * streak, 0.0, 1.0)[:, None]
    return np.asarray((1 - t) * np.array([1.0, 1.0, 1.0]) + t * np.array([1.05, 0.5, 0.26]))


def _corrugated(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    wave = np.cos(2 * np.pi * points[:, 0] / 0.2 + 2 * np.pi * points[:, 1] / 0.2)
    return _enamel(uv, extent, points, seed) * (0.84 + 0.16 * wave)[:, None]


def _stone(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    cloud = value_noise(points * 2.5, seed) + 0.6 * value_noise(points * 9.0, seed + 1)
    vein = np.exp(-((value_noise(points * 1.7, seed + 2) * 6) ** 2))
    return _grey(1 + 0.09 * cloud - 0.08 * vein)


def _marble(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    turn = points @ np.array([1.3, 0.9, 1.1]) * 1.4 + 1.7 * fractal(points * 2.2, seed)
    vein = np.exp(-((np.sin(np.pi * turn) / 0.16) ** 2)) + 0.5 * np.exp(-((np.sin(2.7 * np.pi * turn) / 0.1) ** 2))
    tone = 1 + 0.04 * value_noise(points * 3.0, seed + 1) - 0.38 * np.clip(vein, 0, 1)
    return np.stack([tone, tone * 1.0, tone * 1.01], 1)


def _concrete(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Clouds, dark runs of water, and the small holes that air left."""
    cloud = fractal(points * 1.4, seed)
    runs = np.clip(value_noise(points * np.array([5.0, 5.0, 0.5]), seed + 4) - 0.3, 0.0, 1.0)
    cell = np.floor(points * 22.0).astype(np.int64)
    hole = lattice_hash(cell, seed + 8) > 0.985
    return _grey((1 + 0.11 * cloud - 0.16 * runs) * np.where(hole, 0.7, 1.0))


def _terrazzo(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    chip = lattice_hash(np.floor(points * 40.0).astype(np.int64), seed)
    return np.where((chip > 0.8)[:, None], _grey(0.62 + chip * 0.6 - 0.3), _grey(1 + 0.03 * value_noise(points, seed)))


def _paper(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    tape = np.abs(uv[:, 1] - extent[1] / 2) < 0.03
    return _grey((1 + 0.05 * value_noise(points * 8.0, seed)) * np.where(tape, 1.18, 1.0))


def _leaf(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Light and dark leaves side by side, warmer where light; the crown's inside and underside are darker."""
    each = lattice_hash(np.floor(points * 17.0).astype(np.int64), seed) - 0.5
    tone = 1 + 0.7 * each + 0.22 * value_noise(points * 2.2, seed + 2)
    return np.stack([tone * (1 + 0.30 * each), tone, tone * (0.85 - 0.2 * each)], 1)


def _grass(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    tone = 1 + 0.22 * fractal(points[:, :2] * 0.9, seed) + 0.28 * value_noise(points * 16.0, seed + 3)
    dry = np.clip(fractal(points[:, :2] * 0.5, seed + 9), 0, 1)
    return np.stack([tone * (1 + 0.5 * dry), tone * (1 + 0.1 * dry), tone * 0.9], 1)


def _asphalt(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Fine stone, large worn patches, and a few cracks."""
    patch = fractal(points[:, :2] * 0.35, seed)
    crack = np.exp(-((fractal(points[:, :2] * 0.7, seed + 6) / 0.012) ** 2))
    cell = np.floor(points[:, :2] / (3.7, 4.6)).astype(np.int64)
    at = points[:, :2] / (3.7, 4.6) - cell
    reach = 0.12 + 0.25 * np.stack([lattice_hash(cell, seed + 11), lattice_hash(cell, seed + 12)], 1)
    mended = (np.abs(at - 0.5) < reach).all(axis=1) & (lattice_hash(cell, seed + 13) > 0.55)
    fine = 0.10 * value_noise(points * 30.0, seed + 1) - 0.35 * crack
    return _grey((1 + 0.16 * patch + fine) * np.where(mended, 0.72, 1.0))


def _ashlar(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Dressed stone blocks of 72 by 36 cm."""
    row = np.floor(uv[:, 1] / 0.36).astype(np.int64)
    along = uv[:, 0] / 0.72 + 0.5 * (row % 2)
    cell = np.stack([np.floor(along).astype(np.int64), row], 1)
    inside = np.stack([(along - cell[:, 0]) * 0.72, uv[:, 1] - row * 0.36], 1)
    joint = (np.minimum(inside, [0.72, 0.36] - inside) < 0.012).any(axis=1)
    tone = 1 + 0.16 * (lattice_hash(cell, seed) - 0.5) + 0.1 * fractal(points * 2.0, seed + 1)
    return _grey(np.where(joint, 0.62, tone))


def _gravel(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    stone = lattice_hash(
        np.floor(points * 22.0 + 0.4 * value_noise(points * 9.0, seed)[:, None]).astype(np.int64), seed
    )
    return _grey(0.72 + 0.55 * stone + 0.08 * value_noise(points[:, :2], seed + 1))


def _cobbles(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """Setts of 24 by 16 cm in shifted rows, domed, with dark joints."""
    row = np.floor(uv[:, 1] / 0.16).astype(np.int64)
    along = uv[:, 0] / 0.24 + 0.5 * (row % 2)
    cell = np.stack([np.floor(along).astype(np.int64), row], 1)
    inside = np.stack([(along - cell[:, 0]) * 0.24, uv[:, 1] - row * 0.16], 1)
    edge = np.minimum(inside, np.array([0.24, 0.16]) - inside).min(axis=1)
    tone = (0.82 + 0.36 * lattice_hash(cell, seed + 1)) * np.where(edge < 0.01, 0.5, 0.9 + np.clip(edge, 0, 0.04) * 3)
    return _grey(tone * (1 + 0.08 * value_noise(uv * 2.0, seed + 2)))


def _bark(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    ridge = value_noise(points * np.array([16.0, 16.0, 2.5]), seed)
    return _grey(1 + 0.3 * ridge + 0.12 * value_noise(points * 7.0, seed + 1))


def _soil(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    return _grey(1 + 0.35 * fractal(points * 14.0, seed))


def _water(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    ripple = value_noise(points[:, :2] * 5.0 + 0.8 * value_noise(points[:, :2] * 2.0, seed)[:, None], seed + 1)
    return _grey(1 + 0.28 * np.clip(ripple, -0.6, 1.0))


def _glass(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    """A faint slanting reflection."""
    band = np.sin((points[:, 0] + points[:, 2]) * 4.0 + seed)
    return _grey(1 + 0.35 * np.clip(band, 0.2, 1.0))


def _shingles(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    row = np.floor(uv[:, 1] / 0.25).astype(np.int64)
    cell = np.stack([np.floor(uv[:, 0] / 0.2 + 0.5 * (row % 2)).astype(np.int64), row], 1)
    lower = uv[:, 1] / 0.25 - row
    return _grey((0.82 + 0.3 * lattice_hash(cell, seed)) * np.where(lower < 0.12, 0.6, 1.0))


def _rug(uv: Float, extent: Extent, points: Float, seed: int) -> Float:
    rim = np.minimum(np.minimum(uv[:, 0], extent[0] - uv[:, 0]), np.minimum(uv[:, 1], extent[1] - uv[:, 1]))
    band = np.where((rim > 0.10) & (rim < 0.20), 1.7, np.where(rim < 0.04, 0.7, 1.0))
    diamonds = np.abs((uv[:, 0] * 2.2) % 1 - 0.5) + np.abs((uv[:, 1] * 2.2) % 1 - 0.5)
    field = np.where((rim > 0.3) & (diamonds < 0.22), 1.45, 1.0)
    return np.asarray(_carpet(uv, extent, points, seed) * (band * field)[:, None])


TEXTURES: dict[str, Texture] = {
    "plain": _plain, "plaster": _plaster, "wood": _wood, "planks": _planks, "tiles": _tiled(0.5),
    "small tiles": _tiled(0.15), "paving": _tiled(0.4), "bricks": _bricks, "carpet": _carpet, "fabric": _fabric,
    "velvet": _velvet, "leather": _leather, "wicker": _wicker, "metal": _metal, "brushed": _brushed,
    "enamel": _enamel, "rust": _rust, "corrugated": _corrugated, "stone": _stone, "marble": _marble,
    "concrete": _concrete, "terrazzo": _terrazzo, "paper": _paper, "leaf": _leaf, "grass": _grass,
    "asphalt": _asphalt, "gravel": _gravel, "cobbles": _cobbles, "bark": _bark, "soil": _soil, "water": _water,
    "glass": _glass, "shingles": _shingles, "rug": _rug, "ashlar": _ashlar,
}  # fmt: skip
JOINTS: dict[str, Callable[[Float], Float]] = {"bricks": _mortar}
"""Where a texture shows the material's second colour: uv (N, 2) -> share (N,)."""
