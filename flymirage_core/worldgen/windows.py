"""Everything that shines in a world, as lamps: windows and skylights of indoor spaces, and all that glows enough."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.assembly import Assembly
from flymirage_core.worldgen.building import skylights
from flymirage_core.worldgen.lighting import Illumination, Lamps
from flymirage_core.worldgen.place import Space
from flymirage_core.worldgen.sky import Sky, Sun
from flymirage_core.worldgen.surfaces import Surfels

Float = NDArray[np.float64]
Row = tuple[Float, Float, Float, Float, Float]

WINDOW_SHARE: Final = 0.62
"""Of the sky's radiance that comes in: the rest are frames, glass, and ground that is darker than the sky."""
THROUGH_GLASS: Final = 0.4
"""Of the sun's light: panes, curtains, and a camera's exposure between inside and outside."""
PIECE: Final = 1.4
"""Metres: larger windows are several lamps."""
LAMP_POWER: Final = 0.012
"""Things that glow less (emission times albedo times square metres) light nothing: screens, small signs."""
LAMP_BOOST: Final = 5.0
"""A lamp gives this many times the light that its visible shade alone would."""
BELOW: Final = 0.05
"""Metres by which a lamp's light comes from under its glow's middle."""


def illumination_of(assembly: Assembly, pieces: list[Surfels]) -> tuple[Illumination, list[bool]]:
    """The world's lights, and which of its things (one piece of surfels each) are lamps."""
    rows: list[Row] = []
    for space in assembly.place.spaces:
        if not space.open_air:
            rows += _windows(space, assembly)
    lamps = []
    for thing, own in zip(assembly.things, pieces, strict=True):
        glow = own.emission * own.areas * own.albedo.mean(axis=1)  # (N,)
        lamps.append(thing.shines and bool(glow.sum() > LAMP_POWER))
        if lamps[-1]:
            rows.append(_lamp(own, glow))
    sky, sun = assembly.sky, assembly.sky.sun
    if assembly.place.open_air:
        return Illumination(Lamps.of(rows), sun, sky, assembly.brightness), lamps
    if sun is not None:
        sun = Sun(sun.towards, THROUGH_GLASS * sun.irradiance)
    return Illumination(Lamps.of(rows), sun, None, assembly.brightness), lamps


def _lamp(own: Surfels, glow: Float) -> Row:
    middle = (own.points * glow[:, None]).sum(axis=0) / glow.sum()
    spread = np.sqrt(((own.points - middle) ** 2 * glow[:, None]).sum(axis=0) / glow.sum())
    axes = np.argsort(-spread)[:2]
    u, v = np.zeros(3), np.zeros(3)
    u[axes[0]], v[axes[1]] = 1.5 * spread[axes]
    colour = (own.albedo * glow[:, None]).sum(axis=0) / glow.sum()
    power = LAMP_BOOST * (glow / np.maximum(own.albedo.mean(axis=1), 1e-6)).sum() / np.pi
    return middle - [0.0, 0.0, BELOW], np.zeros(3), u, v, power * colour


def _windows(space: Space, assembly: Assembly) -> list[Row]:
    rows: list[Row] = []
    for wall in space.walls:
        for o in (o for o in wall.openings if o.kind == "window"):
            columns = max(1, round((o.right - o.left) / PIECE))
            width, height = (o.right - o.left) / columns, o.top - o.bottom
            inward = np.array([*wall.inward, 0.0])
            for i in range(columns):
                spot = np.array([*wall.at(o.left + (i + 0.5) * width, 0.02), (o.bottom + o.top) / 2])
                u, v = np.array([*wall.along, 0.0]) * width / 2, np.array([0.0, 0.0, height / 2])
                rows.append((spot, inward, u, v, _incoming(assembly.sky, -inward) * width * height))
    for low, high in skylights(space, assembly.place):
        x, y = (high - low) / 2
        spot = np.array([*((low + high) / 2), space.height + 0.02])
        light = _incoming(assembly.sky, np.array([0.0, 0.0, 1.0])) * 4 * x * y
        rows.append((spot, np.array([0.0, 0.0, -1.0]), np.array([x, 0.0, 0.0]), np.array([0.0, y, 0.0]), light))
    return rows


def _incoming(sky: Sky, outward: Float) -> Float:
    """Mean radiance of the sky about a direction, as a window lets it in."""
    directions = outward + 0.6 * np.array([[0, 0, 1.0], [0.5, 0, 0.6], [-0.5, 0, 0.6], [0, 0.5, 0.6], [0, -0.5, 0.6]])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.asarray(WINDOW_SHARE * sky.radiance(directions).mean(axis=0))
