"""Textures that carry their own colours: paintings, screens, boards, lettering, stripes. Absolute albedo per point."""

from collections.abc import Callable
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.noise import Float, lattice_hash, value_noise

Extent = tuple[float, float]
Colour = tuple[float, float, float]
Picture = Callable[[Float, Extent, int, str, Colour, Colour], Float]
"""(uv (N, 2), extent, seed, words, colour, ink) -> linear albedo (N, 3)."""

_CLOTHS = (
    (0.95, 0.9, 0.8),
    (0.9, 0.92, 0.95),
    (0.8, 0.7, 0.55),
    (0.75, 0.45, 0.4),
    (0.5, 0.6, 0.65),
    (0.95, 0.95, 0.9),
)
"""Tints of curtains and blinds."""
LETTERING_HEIGHT = 160
"""Pixels of a sign's raster; letters stay legible where splats are fine enough."""
STRIPE = 0.09
"""Metres across a hazard stripe."""


def _painting(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Soft horizontal bands with a few round shapes over them, in colours that go together."""
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


def _landscape(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Sky, a far range of hills, a near one, a field."""
    x, y = uv[:, 0] / extent[1], uv[:, 1] / extent[1]
    sky = np.array([0.45, 0.55, 0.68]) + (1 - y[:, None]) * np.array([0.3, 0.15, 0.0])
    image = np.clip(sky, 0, 0.9)
    for level, tone in ((0.55, (0.2, 0.27, 0.34)), (0.4, (0.13, 0.2, 0.13)), (0.22, (0.32, 0.3, 0.1))):
        ridge = level + 0.12 * value_noise(np.stack([x * 2.2 / level, 0 * x], 1), seed + int(level * 100))
        image[y < ridge] = np.array(tone) * (0.8 + 0.4 * lattice_hash(np.array([[seed]]), int(level * 10)))
    return np.asarray(image * (1 + 0.10 * value_noise(uv * 25.0, seed))[:, None])


def _hue(angle: Float, level: Float) -> Float:
    phases = np.array([0.0, 2.1, 4.2])
    return np.asarray(level[..., None] * (1 + 0.42 * np.cos(angle[..., None] - phases)), np.float64)


def _screen(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """A dark screen with a few lines of something on it."""
    x, y = uv[:, 0] / extent[0], uv[:, 1] / extent[1]
    image = np.stack([0.02 + 0.03 * y, 0.03 + 0.05 * y, 0.06 + 0.10 * y], 1)
    line = np.floor(y * 9).astype(np.int64)
    length = 0.25 + 0.5 * lattice_hash(line[:, None], seed)
    text = (y * 9 - line > 0.35) & (y * 9 - line < 0.65) & (x > 0.1) & (x < length) & (line > 0) & (line < 8)
    image[text] = (0.25, 0.32, 0.36)
    return np.asarray(image)


def _notes(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """A cork board with sheets of paper on it."""
    image = np.tile([0.36, 0.22, 0.11], (len(uv), 1)) * (1 + 0.1 * value_noise(uv * 30.0, seed))[:, None]
    generator = np.random.default_rng(seed)
    for _ in range(7):
        centre = generator.uniform(0.1, 0.9, 2) * extent
        paper = generator.choice([[0.75, 0.74, 0.7], [0.7, 0.6, 0.25], [0.35, 0.55, 0.6], [0.65, 0.35, 0.32]])
        image[(np.abs(uv - centre) < (0.08, 0.11)).all(axis=1)] = paper
    return image


def _sky(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """What a window shows: sky over a soft line of trees, made bright by the material's emission."""
    x, y = uv[:, 0], uv[:, 1] / extent[1]
    sky = np.stack([0.52 + 0.25 * (1 - y), 0.66 + 0.17 * (1 - y), 0.86 + 0.04 * (1 - y)], 1)
    cloud = np.clip(value_noise(np.stack([x * 1.2, y * 3.5], 1), seed), 0, 1)[:, None]
    sky = sky * (1 - 0.5 * cloud) + 0.9 * 0.5 * cloud
    trees = y < 0.30 + 0.09 * value_noise(np.stack([x * 4.0, 0 * x], 1), seed + 5)
    shade = value_noise(np.stack([x * 14.0, y * 14.0], 1), seed + 6)
    leaves = np.array([0.16, 0.24, 0.12]) * (1 + 0.35 * shade)[:, None]
    return np.where(trees[:, None], leaves, sky)


def _interior(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """A window seen from outside: a dark room, curtains or a blind, and over them the sky and roofs it mirrors."""
    draw = np.random.default_rng(seed)
    kind, side, low = draw.integers(5), draw.uniform(0.16, 0.34), draw.uniform(0.25, 0.8)
    cloth = np.array(_CLOTHS[int(draw.integers(len(_CLOTHS)))])
    x, y = uv[:, 0] / extent[0], uv[:, 1] / extent[1]
    image = np.tile([0.035, 0.036, 0.04], (len(uv), 1)) * (0.6 + 0.8 * y + 0.4 * value_noise(uv * 1.8, seed))[:, None]
    if kind in (0, 1):  # curtains, drawn to the sides
        edge = side * (1 - 0.35 * np.sin(np.pi * np.clip(y, 0, 1)) * (kind == 1))
        hung = (x < edge) | (x > 1 - edge)
        folds = 0.75 + 0.25 * np.sin(uv[:, 0] * 2 * np.pi / 0.09 + 0.6 * value_noise(uv * 3.0, seed))
        image = np.where(hung[:, None], 0.34 * cloth * folds[:, None], image)
    elif kind == 2:  # a roller blind
        image = np.where((y > low)[:, None], 0.36 * cloth * (0.9 + 0.1 * y)[:, None], image)
    elif kind == 3:  # net curtains over all of it
        folds = 0.8 + 0.2 * np.sin(uv[:, 0] * 2 * np.pi / 0.11)
        image = 0.7 * image + 0.16 * folds[:, None]
    roofs = 0.42 + 0.12 * value_noise(np.stack([x * 2.2, 0 * x], 1), seed + 3) + 0.25 * (x - 0.5) * draw.uniform(-1, 1)
    sky = np.clip((y - roofs) * 12, 0, 1)[:, None] * np.array([0.17, 0.21, 0.27]) * (0.75 + 0.4 * y)[:, None]
    return np.asarray((0.75 * image + draw.uniform(0.5, 1.0) * sky) * np.asarray(colour))


def _louvres(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Slats of 7 cm of ``colour``, each dark at its foot."""
    share = (uv[:, 1] / 0.07) % 1
    return np.asarray((0.55 + 0.5 * share)[:, None] * np.asarray(colour))


def _text(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Legible words in ``ink`` on ``colour``."""
    raster = lettering(words, round(extent[0] / extent[1], 3))
    height, width = raster.shape
    column = np.clip((uv[:, 0] / extent[0] * width).astype(int), 0, width - 1)
    row = np.clip(((1 - uv[:, 1] / extent[1]) * height).astype(int), 0, height - 1)
    share = raster[row, column][:, None]
    return np.asarray(share * np.asarray(ink) + (1 - share) * np.asarray(colour))


@lru_cache(maxsize=256)
def lettering(words: str, aspect: float) -> NDArray[np.float64]:
    """A raster (H, W) of ``words``, 1 where there is ink; "|" starts a new line; ``aspect`` is width over height."""
    height, width = LETTERING_HEIGHT, max(8, round(LETTERING_HEIGHT * aspect))
    canvas = np.zeros((height, width), np.uint8)
    lines = words.split("|")
    font, tall = cv2.FONT_HERSHEY_DUPLEX, height / len(lines)
    scale = 0.02 * tall
    widest = max(cv2.getTextSize(line, font, scale, 1)[0][0] for line in lines)
    scale *= min(1.0, 0.88 * width / max(widest, 1))
    thick = max(2, round(scale * 3.2))
    for i, line in enumerate(lines):
        (w, h), _ = cv2.getTextSize(line, font, scale, thick)
        at = ((width - w) // 2, round((i + 0.5) * tall + h / 2))
        cv2.putText(canvas, line, at, font, scale, 255, thick, cv2.LINE_AA)
    return canvas / 255.0


def _hazard(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Slanting stripes of ``colour`` and ``ink``."""
    return _mixed(np.floor((uv[:, 0] + uv[:, 1]) / STRIPE) % 2 > 0.5, colour, ink, uv, seed)


def _stripes(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    return _mixed(np.floor(uv[:, 0] / 0.16) % 2 > 0.5, colour, ink, uv, seed)


def _checks(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    cell = np.floor(uv / 0.2)
    return _mixed((cell.sum(axis=1) % 2) > 0.5, colour, ink, uv, seed)


def _grille(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Bars of ``colour`` with dark gaps between: louvres and gratings."""
    return _mixed((uv[:, 1] / 0.04) % 1 > 0.55, colour, ink, uv, seed)


def _mixed(second: NDArray[np.bool_], colour: Colour, ink: Colour, uv: Float, seed: int) -> Float:
    worn = 1 + 0.06 * value_noise(uv * 6.0, seed)
    return np.where(second[:, None], np.asarray(ink), np.asarray(colour)) * worn[:, None]


def _map(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Land and sea of some world, over a ball or a sheet."""
    size = max(extent)
    height = value_noise(uv * (5.0 / size), seed) + 0.5 * value_noise(uv * (13.0 / size), seed + 1)
    land = np.where((height > 0.5)[:, None], [0.35, 0.28, 0.14], [0.2, 0.3, 0.1])
    return np.where((height > 0.12)[:, None], land, np.asarray(colour))


def _dial(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """A round gauge's or clock's face on a square: twelve marks, two hands."""
    x, y = (uv[:, 0] / extent[0] - 0.5) * 2, (uv[:, 1] / extent[1] - 0.5) * 2
    r, angle = np.hypot(x, y), np.arctan2(x, y)
    mark = (r > 0.74) & (r < 0.92) & (np.abs((angle / (np.pi / 6) + 0.5) % 1 - 0.5) < 0.13)
    for turn, length in ((seed % 12 * np.pi / 6, 0.5), (seed % 60 * np.pi / 30, 0.72)):
        along, across = x * np.sin(turn) + y * np.cos(turn), x * np.cos(turn) - y * np.sin(turn)
        mark |= (np.abs(across) < 0.045) & (along > -0.1) & (along < length)
    return np.where(mark[:, None], np.asarray(ink), np.asarray(colour))


def _buttons(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Rows of keys or switches, a few of them coloured."""
    pitch = max(extent[1] / max(round(extent[1] / 0.05), 3), 0.012)
    cell = np.floor(uv / pitch).astype(np.int64)
    inside = np.abs(uv / pitch - cell - 0.5).max(axis=1) < 0.34
    pick = lattice_hash(cell, seed)
    keys = np.where((pick > 0.9)[:, None], [0.55, 0.06, 0.04], np.where((pick > 0.8)[:, None], [0.05, 0.35, 0.1], ink))
    return np.where(inside[:, None], keys, np.asarray(colour))


def _labels(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """Goods on a shelf: upright packets of many colours with a pale label each."""
    cell = np.stack([np.floor(uv[:, 0] / 0.09), np.floor(uv[:, 1] / 0.3)], 1).astype(np.int64)
    pick = lattice_hash(cell, seed)
    image = _hue(pick * 6.28, 0.12 + 0.3 * lattice_hash(cell, seed + 1))
    inside = uv / [0.09, 0.3] - cell
    label = (np.abs(inside[:, 0] - 0.5) < 0.34) & (np.abs(inside[:, 1] - 0.45) < 0.18)
    image[label] = 0.62
    image[(inside[:, 0] < 0.06) | (inside[:, 1] > 0.55 + 0.4 * pick)] = 0.02
    return np.asarray(image)


def _page(uv: Float, extent: Extent, seed: int, words: str, colour: Colour, ink: Colour) -> Float:
    """A printed page: lines of grey on paper, with margins."""
    x, y = uv[:, 0] / extent[0], uv[:, 1] / extent[1]
    line = np.floor(y * 14).astype(np.int64)
    inside = (x > 0.12) & (x < 0.72 + 0.2 * lattice_hash(line[:, None], seed)) & (line > 0) & (line < 13)
    printed = inside & (y * 14 - line < 0.5)
    return np.where(printed[:, None], 0.5 * np.asarray(colour), np.asarray(colour))


PICTURES: dict[str, Picture] = {
    "painting": _painting, "landscape": _landscape, "screen": _screen, "notes": _notes, "sky": _sky, "text": _text,
    "hazard": _hazard, "stripes": _stripes, "checks": _checks, "grille": _grille, "map": _map, "dial": _dial,
    "buttons": _buttons, "labels": _labels, "page": _page, "interior": _interior, "louvres": _louvres,
}  # fmt: skip
