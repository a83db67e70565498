"""Colours as people name them, and colours as segmentation compares them. CIELAB, D65."""

import math
from collections.abc import Iterable
from typing import Final

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

Float32 = NDArray[np.float32]

LIGHTNESS_WEIGHT: Final = 0.35
"""Lightness counts this much in `colour_step`: shading changes it most."""
REFERENCE_LIGHTNESS: Final = 50.0
MIN_LIGHTNESS: Final = 25.0
"""Below this, chroma is mostly noise and is not amplified further."""
GREY_CHROMA: Final = 12.0
"""Colours with less chroma are named by lightness alone: people say "grey" of slate, cement and mushroom."""
PALE_CHROMA: Final = 9.0
"""The same of very light and very dark colours, and of light blue ones."""
NEITHER_PALE_NOR_DEEP: Final = (30.0, 82.0)
BLUISH: Final = (200.0, 300.0)
"""Degrees of hue of blue, which is noticed where it is `LIGHT`."""
GREENISH: Final = 105.0
"""Degrees of hue from which pale yellow is a pale green in warm light."""
PALE: Final = 30.0
GREYS: Final = ((14.0, "black"), (38.0, "dark grey"), (66.0, "grey"), (86.0, "light grey"), (101.0, "white"))
"""Lightness up to which each name holds."""
HUES: Final = (
    ("red", 28.0),
    ("orange", 62.0),
    ("yellow", 94.0),
    ("green", 145.0),
    ("teal", 200.0),
    ("blue", 280.0),
    ("purple", 322.0),
    ("pink", 358.0),
)
"""Basic names and their hue angles in degrees (atan2(b, a) of CIELAB)."""
DARK: Final = 30.0
LIGHT: Final = 72.0
VIVID: Final = 45.0
"""Chroma from which dull orange is orange and no brown ..."""
VIVID_LIGHTNESS: Final = 58.0
"""... at this lightness; darker ones need more of it (`_is_brown`)."""
PALE_BROWN: Final = (54.0, 20.0)
"""Lightness from which a brown of less chroma than this is light brown."""
GOLDEN: Final = 42.0
"""Chroma from which what is between brown and yellow is yellow."""


def to_lab(rgb: ArrayLike) -> Float32:
    """CIELAB (N, 3), L 0..100, of sRGB colours (N, 3) 0..255."""
    colours = np.asarray(rgb, np.float32).reshape(1, -1, 3) / 255
    if colours.size == 0:
        return np.zeros((0, 3), np.float32)
    return np.asarray(cv2.cvtColor(np.ascontiguousarray(colours), cv2.COLOR_RGB2LAB)[0], np.float32)


def shading_free(lab: Float32) -> Float32:
    """Lab (N, 3) with a and b scaled to one lightness: shading changes them in proportion."""
    out = lab.copy()
    scale = (REFERENCE_LIGHTNESS + 16) / (np.maximum(lab[:, :1], MIN_LIGHTNESS) + 16)
    out[:, 1:] *= scale
    return out


def colour_step(a: Float32, b: Float32) -> Float32:
    """Difference (...,) of two `shading_free` colours (..., 3)."""
    difference = a - b
    difference = difference * np.array([LIGHTNESS_WEIGHT, 1, 1], np.float32)
    return np.asarray(np.sqrt((difference**2).sum(axis=-1)), np.float32)


def colour_name(lab: Iterable[float]) -> str:
    """A basic colour name with "dark" or "light" where that helps.

    >>> [colour_name(lab) for lab in to_lab([[200, 30, 30], [20, 60, 20], [250, 250, 250]])]
    ['red', 'dark green', 'white']
    """
    lightness, a, b = (float(x) for x in lab)
    chroma = math.hypot(a, b)
    hue = math.degrees(math.atan2(b, a)) % 360
    if chroma < _least_chroma(lightness, hue):
        return next(name for limit, name in GREYS if lightness < limit or limit > 100)
    name = min(HUES, key=lambda entry: abs((hue - entry[1] + 180) % 360 - 180))[0]
    if name == "yellow" and hue > GREENISH and chroma < PALE:
        name = "green"
    return _shaded(name, hue, lightness, chroma)


def _least_chroma(lightness: float, hue: float) -> float:
    """Chroma from which a colour has a hue that people name."""
    light_blue = BLUISH[0] < hue < BLUISH[1] and lightness > LIGHT
    medium = NEITHER_PALE_NOR_DEEP[0] <= lightness <= NEITHER_PALE_NOR_DEEP[1]
    return GREY_CHROMA if medium and not light_blue else PALE_CHROMA


def _shaded(name: str, hue: float, lightness: float, chroma: float) -> str:
    """The hue's everyday name at this lightness and chroma: dull and dark orange is brown, pale yellow is beige."""
    warm = 25 < hue < 105 and name != "green"
    if warm and lightness >= LIGHT and chroma < 30:
        return "beige" if chroma > 12.6 or lightness < 88 else "cream"
    if name == "yellow" and lightness < 60:
        return _dark_yellow(hue, lightness, chroma)
    if warm and _is_brown(hue, lightness, chroma):
        return "dark brown" if lightness < 32 else "brown"
    if warm and chroma < GOLDEN and name != "red":
        return "light brown"
    if name == "pink" and lightness < 45:
        return "dark red" if hue > 354 or hue < 180 else "purple"
    if name == "red" and lightness > 62:
        return "pink"
    if lightness < DARK and name not in ("orange", "yellow"):
        return f"dark {name}"
    if lightness > LIGHT and name in ("green", "teal", "blue", "purple"):
        return f"light {name}"
    return name


def _is_brown(hue: float, lightness: float, chroma: float) -> bool:
    """Of a warm colour. Clay and rust are brown, brick is red; the darker an orange, the more vivid it must be."""
    vivid = VIVID + 1.5 * max(0.0, VIVID_LIGHTNESS - lightness)
    dark = lightness < (PALE_BROWN[0] if chroma < PALE_BROWN[1] else 62)
    return dark and chroma < vivid and not (hue < 40 and chroma > 32)


def _dark_yellow(hue: float, lightness: float, chroma: float) -> str:
    if hue > 98:
        return "olive"
    return "brown" if chroma < GOLDEN or lightness < 42 else "dark yellow" if lightness < 50 else "yellow"
