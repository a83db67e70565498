"""Laboratories and what must be kept away from people.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    bolts,
    frame_of,
    hoop,
    pipe,
    placed,
    sign,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, paint, smooth, turned
from flymirage_core.worldgen.shapes.fittings import DARK, HAZARD, IRON, STEEL, gauge
from flymirage_core.worldgen.surfaces import Part, Vector

GLASS = replace(paint("powder blue", "glass"), opacity=0.35)


def shielded_cask(size: Vector, f: Finish) -> list[Part]:
    """A lead cask for radioactive sources."""
    body = turned(f.main, [(0, 0.06), (0.4, 0.06), (0.42, 0.1), (0.42, 0.95), (0.4, 1.0), (0, 1.0)])
    ribs = [hoop(f.main.shaded(0.85), 0.425, 0.03, (0, 0, z), 0.05) for z in (0.2, 0.45, 0.8)]
    lid = turned(f.main.shaded(1.1), [(0.4, 1.0), (0.44, 1.0), (0.44, 1.1), (0.36, 1.14), (0, 1.14)])
    lugs = [
        p
        for s in (-1, 1)
        for p in (
            pipe(STEEL, [(s * 0.38, 0, 0.85), (s * 0.5, 0, 0.85)], 0.06),
            hoop(STEEL, 0.0501, 0.015, (s * 0.3, 0, 1.2)),
        )
    ]
    eye = [placed(hoop(STEEL, 0.09, 0.022), (0, 0, 1.24), FACING)]
    trefoil = sign("RADIOACTIVE|MATERIAL", 0.42, 0.22, (0, 0.435, 0.52), "yellow", "burgundy")
    return [
        body,
        *ribs,
        lid,
        *lugs,
        *eye,
        *bolts(IRON, 0.38, 10, 0.022, 1.1),
        trefoil,
        box(IRON, (0.8, 0.8, 0.07), (0, 0, 0), 0.01),
    ]


def glove_box(size: Vector, f: Finish) -> list[Part]:
    legs = frame_of(STEEL, (1.4, 0.65, 0.85), 0.05)
    case = tapered(f.main, [(1.5, 0.8, 0.85), (1.5, 0.8, 1.15), (1.5, 0.5, 1.75)], radius=0.03, lean=(0.0, 0.0, -0.14))
    pane = [
        placed(
            box(replace(paint("powder blue", "glass"), opacity=0.8), (1.2, 0.015, 0.5), (0, 0, 0)),
            (0, 0.375, 1.2),
            np.array([[1.0, 0, 0], [0, 0.89, -0.46], [0, 0.46, 0.89]]),
        )
    ]
    ports = [
        p
        for u in (-0.32, 0.32)
        for p in (
            placed(hoop(STEEL, 0.12, 0.022), (u, 0.4, 1.03), FACING),
            placed(turned(DARK, [(0.11, 0.0), (0.1, 0.1), (0.06, 0.3), (0, 0.34)]), (u, 0.38, 1.03), FACING),
        )
    ]
    lock = [
        placed(
            turned(STEEL, [(0, 0), (0.22, 0), (0.22, 0.28), (0.25, 0.28), (0.25, 0.34), (0, 0.36)]),
            (0.72, -0.05, 1.3),
            LYING,
        )
    ]
    pipes = [pipe(STEEL, [(u, -0.2, 1.7), (u, -0.2, 1.85), (u + 0.3, -0.2, 1.85)], 0.025, 0.05) for u in (-0.4, 0.1)]
    return [
        *legs,
        case,
        *pane,
        *ports,
        *lock,
        *pipes,
        *gauge((-0.62, 0.41, 1.08), 0.05),
        sign("GLOVE BOX 3", 0.34, 0.1, (0, 0.405, 0.88), "yellow"),
    ]


def fume_hood(size: Vector, f: Finish) -> list[Part]:
    base = [
        box(f.main, (1.5, 0.7, 0.85), (0, -0.05, 0)),
        *(box(f.main.shaded(1.1), (0.7, 0.02, 0.75), (s * 0.37, 0.305, 0.06), 0.004) for s in (-1, 1)),
    ]
    top = box(DARK, (1.5, 0.8, 0.05), (0, 0, 0.85), 0.01)
    sides = [box(f.main, (0.1, 0.7, 1.2), (s * 0.7, -0.05, 0.9)) for s in (-1, 1)]
    back = box(paint("chalk"), (1.4, 0.04, 1.2), (0, -0.36, 0.9))
    head = [box(f.main, (1.5, 0.7, 0.35), (0, -0.05, 1.95), 0.01), cylinder(STEEL, 0.14, 0.16, (0, -0.1, 2.28))]
    sash = [box(GLASS, (1.3, 0.015, 0.65), (0, 0.26, 1.35)), box(STEEL, (1.3, 0.03, 0.04), (0, 0.27, 1.32))]
    glasses = [
        turned(
            replace(paint(c, "glass"), opacity=0.8),
            smooth([(0.07, 0.9), (0.08, 0.97), (0.025, 1.06), (0.025, 1.12)], 6),
            (u, -0.05, 0),
        )
        for u, c in ((-0.35, "teal"), (0.1, "orange"), (0.4, "powder blue"))
    ]
    return [
        *base,
        top,
        *sides,
        back,
        *head,
        *sash,
        *glasses,
        sign("FUME HOOD", 0.5, 0.12, (0, 0.305, 2.08), "chalk"),
        *(cylinder(STEEL, 0.025, 0.08, (u, 0.33, 0.72)) for u in (-0.6, 0.6)),
    ]


def safety_shower(size: Vector, f: Finish) -> list[Part]:
    line = pipe(f.main, [(0, -0.28, 0), (0, -0.28, 2.1), (0, 0.12, 2.1), (0, 0.12, 2.02)], 0.03, 0.08)
    rose = turned(f.main, [(0.14, 1.93), (0.12, 1.99), (0.03, 2.03), (0, 2.03)], (0, 0.12, 0))
    pull = [
        pipe(STEEL, [(0.14, 0.0, 2.05), (0.14, 0.0, 1.5)], 0.008),
        placed(hoop(STEEL, 0.07, 0.01), (0.14, 0.0, 1.42), FACING),
        pipe(STEEL, [(0, -0.1, 2.08), (0.14, 0.0, 2.05)], 0.012),
    ]
    bowl = turned(
        paint("yellow", "enamel"), [(0.02, 0.95), (0.14, 1.0), (0.17, 1.08), (0.14, 1.05), (0, 1.02)], (0, 0.0, 0)
    )
    arm = [
        pipe(f.main, [(0, -0.28, 0.92), (0, 0.0, 0.95)], 0.025),
        *(pipe(STEEL, [(s * 0.05, 0, 1.02), (s * 0.05, 0, 1.12)], 0.012) for s in (-1, 1)),
    ]
    plate = [
        sign("EMERGENCY|SHOWER", 0.36, 0.26, (0, -0.24, 1.55), "forest green", "white"),
        turned(HAZARD, [(0.32, 0.0), (0.32, 0.012), (0, 0.014)]),
    ]
    return [line, rose, *pull, bowl, *arm, *plate]
