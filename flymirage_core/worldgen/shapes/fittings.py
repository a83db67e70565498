"""Flanges, hand wheels and gauges: what pipework and machines share.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

from flymirage_core.worldgen.forms import (
    FACING,
    bolts,
    hoop,
    patterned,
    pipe,
    placed,
    spun,
)
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import cylinder, paint, picture, turned
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, IRON, DARK = paint("silver", "brushed"), paint("charcoal", "metal"), paint("black")
HAZARD = patterned("yellow", "hazard")


def flange(material: Material, radius: float, centre: Vector, axis: Float | None = None) -> list[Part]:
    """Two bolted discs on a pipe of ``radius``, their axis z unless turned by ``axis``."""
    rim, edge, gap = 1.6 * radius, 0.3 * radius, 0.03 * radius
    profile = [(radius, -edge), (rim, -edge), (rim, -gap), (0.9 * rim, 0), (rim, gap), (rim, edge), (radius, edge)]
    disc = turned(material, profile)
    heads = bolts(IRON, 1.32 * radius, 6, 0.14 * radius, 0.3 * radius)
    return [placed(p, centre, axis) for p in (disc, *heads)]


def handwheel(material: Material, radius: float, centre: Vector, axis: Float | None = None) -> list[Part]:
    spokes = spun(pipe(material, [(0, 0, 0), (radius, 0, 0)], 0.1 * radius), 5)
    parts = [
        hoop(material, radius, 0.12 * radius),
        *spokes,
        cylinder(material, 0.22 * radius, 0.2 * radius, (0, 0, -0.1 * radius)),
    ]
    return [placed(p, centre, axis) for p in parts]


def gauge(centre: Vector, radius: float = 0.06) -> list[Part]:
    rim = placed(
        turned(STEEL, [(0, -0.03), (radius, -0.03), (radius, 0.01), (0.85 * radius, 0.01), (0.85 * radius, 0)]),
        centre,
        FACING,
    )
    face = replace(paint("chalk", "dial", detail=0.3), ink=(0.02, 0.02, 0.02))
    return [rim, picture(face, 1.5 * radius, 1.5 * radius, (centre[0], centre[1] + 0.004, centre[2] - 0.75 * radius))]
