"""The light that a place is seen in, and which colour a thing seen in it has: in white light, evenly lit.

Pictures darken what is in the shade, exaggerate contrast, and take on the colour of lamp, sun or sky. Nothing here
knows which lamps there are: bright surfaces that are nearly grey tell.
"""

from collections import Counter
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flymirage_core.annotation.colours import colour_name, to_lab

Float32 = NDArray[np.float32]

LUMINANCE: Final = np.array([0.2126, 0.7152, 0.0722], np.float32)
"""Of linear sRGB."""
BRIGHT: Final = 50.0
"""Percentile of luminance from which surfaces tell the light's colour ..."""
GREYISH: Final = 15.0
"""... the more, the less chroma they have: what has so much counts a third. Walls, ceilings and floors mostly are
nearly grey."""
BRIGHTEST: Final = 97.0
"""The percentile that tells how bright the pictures are."""
WHITE: Final = 0.65
"""Luminance of white surfaces in well exposed pictures ..."""
EXPOSURE_SHARE: Final = 0.7
"""... and by this power of the ratio to it darker pictures are brightened."""
CONTRAST: Final = 0.75
"""Power of a thing's luminance that goes with its own reflectance: shade and film make the rest of the differences."""
DARKEST: Final = 0.003
"""Luminance below which nothing is brightened further."""
GLARE: Final = 0.8
"""Luminance from which a thing shines or mirrors a light, and shows no colour of its own ..."""
MIN_PLAIN: Final = 0.25
"""... if at least this share of it does show one."""
SAMPLES: Final = 500
"""Points of a thing that are asked for their colour."""
PLACE_SAMPLES: Final = 100_000
"""Points of a place that are."""


@dataclass(frozen=True)
class Light:
    """What the surfaces of a place say about its light."""

    brightness: float  # luminance, 0..1
    colour: tuple[float, float, float]  # linear RGB, green = 1


def light_of(rgb: ArrayLike) -> Light:
    """The light of a place of which ``rgb`` (N, 3), 0..255, are surfaces' colours."""
    colours = np.asarray(rgb, np.float32).reshape(-1, 3)
    if not len(colours):
        return Light(WHITE, (1.0, 1.0, 1.0))
    colours = colours[:: max(1, len(colours) // PLACE_SAMPLES)]
    linear = _linear(colours)
    luminance = linear @ LUMINANCE
    chroma = np.linalg.norm(to_lab(colours)[:, 1:], axis=1)
    told = (luminance >= np.percentile(luminance, BRIGHT)) & (luminance < GLARE)
    grey = np.exp(-((chroma / GREYISH) ** 2)) * told @ linear / max(int(told.sum()), 1) + DARKEST  # (3,)
    red, green, blue = (grey / grey[1]).tolist()
    return Light(float(np.percentile(luminance, BRIGHTEST)), (red, green, blue))


def in_white_light(rgb: ArrayLike, light: Light) -> Float32:
    """CIELAB (N, 3) that one thing's colours (N, 3), 0..255, would have in even white light."""
    balanced = _linear(rgb) / np.array(light.colour, np.float32)  # (N, 3)
    seen = float(np.median(balanced, axis=0) @ LUMINANCE) + DARKEST
    exposure = (WHITE / max(light.brightness, DARKEST)) ** EXPOSURE_SHARE
    bright = balanced * (exposure * seen**CONTRAST / seen)
    encoded = np.where(bright <= 0.0031308, 12.92 * bright, 1.055 * np.maximum(bright, 1e-9) ** (1 / 2.4) - 0.055)
    return to_lab(255 * np.clip(encoded, 0, 1))


def seen_colour(rgb: ArrayLike, light: Light) -> str:
    """Name of the colour that most of a thing has, of which ``rgb`` (N, 3), 0..255, are samples; "" if there are none.

    A mean of several colours is a colour that the thing has nowhere; so the commonest basic colour is named, by the
    median of what has it.
    """
    colours = np.asarray(rgb, np.float32).reshape(-1, 3)
    if not len(colours):
        return ""
    plain = _linear(colours) @ LUMINANCE < GLARE
    lab = in_white_light(colours[plain] if plain.mean() > MIN_PLAIN else colours, light)
    lab = lab[:: max(1, len(lab) // SAMPLES)]
    basic = [colour_name(each).split()[-1] for each in lab.tolist()]
    commonest, _ = Counter(basic).most_common(1)[0]
    return colour_name(np.median(lab[np.array(basic) == commonest], axis=0))


def _linear(rgb: ArrayLike) -> Float32:
    share = np.asarray(rgb, np.float32).reshape(-1, 3) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4).astype(np.float32)
