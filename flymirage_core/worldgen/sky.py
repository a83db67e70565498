"""Sun and sky by the time of day: what lights the open air and what is seen above it. Linear RGB radiance.

The unit is that in which a white lamp shade of emission 1 has radiance 1; a bright clear sky has about 5.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flymirage_core.scene.design import Light
from flymirage_core.worldgen.noise import value_noise

Float = NDArray[np.float64]
Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Hour:
    """A time of day: the sun's (at night the moon's) height, its light, the sky's colours, how bright pictures are."""

    elevation_deg: float
    sun: Colour  # irradiance on a surface that faces it
    zenith: Colour
    horizon: Colour
    exposure: float


HOURS = {
    "dawn": Hour(13.0, (17.0, 11.5, 7.2), (1.6, 2.2, 3.6), (5.4, 4.1, 3.4), 0.9),
    "morning": Hour(34.0, (23.0, 20.5, 17.0), (1.9, 3.1, 5.6), (4.9, 5.3, 5.9), 1.0),
    "noon": Hour(58.0, (25.0, 23.6, 21.5), (1.8, 3.0, 5.8), (4.8, 5.4, 6.1), 1.0),
    "afternoon": Hour(40.0, (24.0, 21.6, 18.2), (1.9, 3.1, 5.6), (5.0, 5.3, 5.8), 1.0),
    "dusk": Hour(10.0, (15.0, 8.6, 4.6), (1.2, 1.6, 3.0), (5.8, 3.7, 2.6), 0.85),
    "night": Hour(42.0, (0.10, 0.12, 0.17), (0.012, 0.018, 0.04), (0.05, 0.05, 0.06), 0.5),
}
OVERCAST_ZENITH, OVERCAST_HORIZON = 4.6, 3.3
"""Radiance of a closed cloud cover by day, nearly grey."""
OVERCAST_TINT = (0.96, 1.0, 1.05)
GROUND_SHARE = 0.22
"""Radiance of far ground below the horizon as a share of the horizon's."""
CLOUD_COVER, OVERCAST_COVER = 0.5, 1.3
"""How much of the sky clouds take: a little less than this share; above 1 there is no gap between them."""
CLOUD_LAYER, CLOUD_SCALE, CLOUD_EDGE = 0.16, 1.1, 0.3
"""How far away clouds at the horizon are, how small they are, and how soft their rims."""
CLOUD_BRIGHT, CLOUD_GREY = 1.7, 0.45
"""Radiance of a cloud's rim, as a share of the horizon's, and how much darker its middle is."""
CLOUD_TINT = np.array([1.0, 1.0, 1.02])
GLOW = 0.55
"""Of the haze round the sun, as a share of the horizon's radiance."""


@dataclass(frozen=True, eq=False)
class Sun:
    """A distant light: unit vector towards it, and the irradiance it gives a surface that faces it."""

    towards: Float  # (3,)
    irradiance: Float  # (3,)


@dataclass(frozen=True, eq=False)
class Sky:
    """What is seen where nothing else is."""

    zenith: Float  # (3,)
    horizon: Float  # (3,)
    sun: Sun | None
    clouds: float  # share of the sky that they take, 0 = none, above 1 all
    seed: int

    def radiance(self, directions: Float) -> Float:
        """(N, 3) along unit ``directions`` (N, 3)."""
        up = directions[:, 2]
        share = np.clip(up, 0.0, 1.0)[:, None] ** 0.5
        result = self.horizon * (1 - share) + self.zenith * share
        if self.sun is not None:
            near = np.clip(directions @ self.sun.towards, 0.0, 1.0)[:, None]
            result = result + GLOW * self.horizon * (near**24 + 0.3 * near**4)
        if self.clouds > 0:
            puff = self._puffs(directions)
            cover = _smooth((puff - 1 + self.clouds) / CLOUD_EDGE)[:, None] * np.clip(up * 9, 0, 1)[:, None]
            thick = _smooth((puff - 1 + min(self.clouds, 0.85)) * 1.6)[:, None]  # their middles are grey below
            white = self.horizon.mean() * CLOUD_BRIGHT * (1 - CLOUD_GREY * thick) * CLOUD_TINT
            result = result * (1 - cover) + white * cover
        below = np.clip(-up * 25.0, 0.0, 1.0)[:, None]
        return np.asarray(result * (1 - below) + GROUND_SHARE * self.horizon * below)

    def _puffs(self, directions: Float) -> Float:
        """(N,) how much cloud there is, about 0 to 1: noise on a flat layer overhead, drawn out by the wind."""
        flat = directions[:, :2] / (CLOUD_LAYER + np.clip(directions[:, 2:], 0.0, 1.0)) * CLOUD_SCALE
        flat = flat + 0.55 * np.stack(
            [value_noise(flat * 0.8, self.seed + 7), value_noise(flat * 0.8, self.seed + 8)], 1
        )
        octaves = (0.5**k * value_noise(flat * 2.1**k, self.seed + k) for k in range(5))
        return np.asarray(0.5 + 0.42 * sum(octaves))


def _smooth(share: Float) -> Float:
    """A soft step from 0 to 1."""
    t = np.clip(share, 0.0, 1.0)
    return np.asarray(t * t * (3 - 2 * t))


def sky_of(light: Light, seed: int) -> Sky:
    """The sky of a description's light; the sun's azimuth and the clouds by ``seed``."""
    hour = HOURS[light.time_of_day]
    zenith, horizon = np.array(hour.zenith), np.array(hour.horizon)
    azimuth, elevation = seed % 360, np.radians(hour.elevation_deg)
    angle = np.radians(azimuth)
    towards = np.array([np.cos(angle) * np.cos(elevation), np.sin(angle) * np.cos(elevation), np.sin(elevation)])
    if light.sky == "clear":
        return Sky(zenith, horizon, Sun(towards, np.array(hour.sun)), CLOUD_COVER, seed)
    level = (horizon.mean() + zenith.mean()) / (np.mean(HOURS["noon"].horizon) + np.mean(HOURS["noon"].zenith))
    tint = np.array(OVERCAST_TINT) * level
    return Sky(OVERCAST_ZENITH * tint, OVERCAST_HORIZON * tint, None, OVERCAST_COVER, seed)


def exposure_of(light: Light) -> float:
    """How bright a picture of the place is, of what a picture by day is."""
    return HOURS[light.time_of_day].exposure
