"""Beams, ducts, cables and lifting gear under ceilings: z runs from their bottom up to the ceiling.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

import numpy as np

from flymirage_core.worldgen.forms import FACING, LYING, cable, hoop, pipe, placed, sign, tapered
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, turned
from flymirage_core.worldgen.surfaces import Float, Part, Patch, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")


def beam(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    if f.main.texture == "wood":
        braces = [placed(box(f.second, (0.012, y + 0.02, z * 0.8), (u, 0, z * 0.1))) for u in (-x * 0.35, x * 0.35)]
        return [box(f.main, (x, y, z), (0, 0, 0), 0.012), *braces]
    section = np.array(
        [
            (-y / 2, 0),
            (y / 2, 0),
            (y / 2, 0.03),
            (0.02, 0.035),
            (0.02, z - 0.035),
            (y / 2, z - 0.03),
            (y / 2, z),
            (-y / 2, z),
            (-y / 2, z - 0.03),
            (-0.02, z - 0.035),
            (-0.02, 0.035),
            (-y / 2, 0.03),
        ]
    )
    rows = np.array([np.column_stack([np.full(13, u), np.vstack([section, section[:1]])]) for u in (-x / 2, x / 2)])
    ends = [box(f.main, (0.004, 0.04, z - 0.04), (s * (x / 2 - 0.002), 0, 0.02)) for s in (-1, 1)]
    return [Part(Patch(rows[:, ::-1]), f.main), *ends]


def duct(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    if f.chosen(2):
        r = min(y, z) / 2 - 0.02
        tube = pipe(f.main, [(-x / 2, 0, r + 0.02), (x / 2, 0, r + 0.02)], r)
        seams = [
            placed(hoop(f.main.shaded(0.8), r, 0.014), (u, 0, r + 0.02), LYING)
            for u in np.arange(-x / 2 + 0.02, x / 2, 0.5)
        ]
        hangers = [
            p
            for u in (-x * 0.35, x * 0.35)
            for p in (
                placed(hoop(DARK, r + 0.01, 0.006, tall=0.03), (u, 0, r + 0.02), LYING),
                pipe(DARK, [(u, 0, 2 * r), (u, 0, z)], 0.006),
            )
        ]
        return [tube, *seams, *hangers]
    body = [
        box(f.main, (x, y, z - 0.08), (0, 0, 0.0), 0.006),
        *(
            box(f.main.shaded(0.85), (0.035, y + 0.04, z - 0.05), (u, 0, -0.015))
            for u in np.arange(-x / 2 + 0.02, x / 2, 0.8)
        ),
    ]
    vents = [box(paint("charcoal", "grille"), (0.3, 0.012, 0.14), (u, y / 2, z * 0.3)) for u in (-x * 0.25, x * 0.25)]
    return [
        *body,
        *vents,
        *(pipe(DARK, [(u, s * y * 0.5, 0), (u, s * y * 0.5, z)], 0.006) for u in (-x * 0.4, x * 0.4) for s in (-1, 1)),
    ]


def cable_bundle(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    cables = []
    for _ in range(12):
        v, colour = (
            rng.uniform(-0.5, 0.5) * y * 0.8,
            ("black", "charcoal", "black", "orange", "grey", "blue")[int(rng.integers(6))],
        )
        ends = [(s * x / 2, v * 0.4, z - 0.04 - rng.uniform(0, 0.05)) for s in (-1, 1)]
        cables.append(
            cable(paint(colour), ends[0], ends[1], float(z * rng.uniform(0.35, 0.82)), float(rng.uniform(0.009, 0.016)))
        )
    clips = [box(STEEL, (0.05, y * 0.8, 0.05), (s * (x / 2 - 0.04), 0, z - 0.05)) for s in (-1, 1)]
    return [*cables, *clips, *(hoop_round(s * x * 0.22, z * 0.55, y) for s in (-1, 1))]


def hoop_round(u: float, height: float, width: float) -> Part:
    """A tie round hanging cables."""
    return placed(hoop(paint("chalk"), width * 0.3, 0.008, tall=0.02), (u, 0, height), LYING)


def chain_hoist(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    body = [
        tapered(
            f.main,
            [(0.26, 0.22, z - 0.55), (0.34, 0.28, z - 0.45), (0.34, 0.28, z - 0.25), (0.2, 0.18, z - 0.18)],
            radius=0.05,
        ),
        pipe(STEEL, [(0, 0, z - 0.2), (0, 0, z)], 0.025),
        pipe(DARK, [(-0.19, 0, z - 0.36), (0.19, 0, z - 0.36)], 0.1),
    ]
    links = [
        placed(hoop(STEEL, 0.024, 0.007), (0, 0, h), FACING if i % 2 else LYING)
        for i, h in enumerate(np.arange(0.26, z - 0.55, 0.04))
    ]
    loop = [cable(STEEL, (0.1, 0.1, z - 0.5), (0.16, 0.1, z - 0.5), z * 0.45, 0.008)]
    hook = [
        box(paint("yellow", "enamel"), (0.1, 0.08, 0.12), (0, 0, 0.15), 0.02),
        pipe(
            STEEL,
            [(0, 0, 0.16), (0, 0, 0.1), (0.06, 0, 0.06), (0.03, 0, 0.0), (-0.04, 0, 0.02), (-0.05, 0, 0.06)],
            0.014,
            0.04,
        ),
    ]
    return [*body, *links, *loop, *hook, sign("500 kg", 0.2, 0.07, (0, 0.142, z - 0.4), "yellow")]


def projector(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    body = box(f.main, (0.38, 0.3, 0.12), (0, 0, 0), 0.025)
    lens = [
        placed(
            turned(DARK, [(0, -0.02), (0.05, -0.02), (0.05, 0.03), (0.04, 0.035), (0.036, 0.02)]),
            (-0.09, 0.16, 0.06),
            FACING,
        ),
        placed(turned(paint("sky blue", "glass", 1.2), [(0.036, 0.025), (0, 0.03)]), (-0.09, 0.16, 0.06), FACING),
    ]
    vents = [box(DARK, (0.12, 0.006, 0.006), (0.1, 0.15, 0.04 + 0.014 * i)) for i in range(4)]
    mount = [
        pipe(STEEL, [(0, 0, 0.16), (0, 0, z)], 0.02),
        turned(STEEL, [(0, z - 0.02), (0.07, z - 0.02), (0.07, z), (0, z)]),
        *(pipe(STEEL, [(0, 0, 0.18), (s * 0.14, t * 0.1, 0.12)], 0.008) for s in (-1, 1) for t in (-1, 1)),
    ]
    return [body, *lens, *vents, *mount]


def busbar(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    bars = [box(paint("copper", "brushed"), (x, 0.012, 0.09), (0, v, 0.06)) for v in (-y * 0.33, 0, y * 0.33)]
    marks = [
        box(paint(c), (0.3, 0.016, 0.092), (-x * 0.3, v, 0.059))
        for c, v in (("red", -y * 0.33), ("yellow", 0), ("blue", y * 0.33))
    ]
    posts = [
        turned(
            paint("chestnut"),
            [(0.03, 0.15), (0.05, 0.17), (0.03, 0.19), (0.05, 0.21), (0.03, 0.23), (0.05, 0.25), (0.03, 0.27)],
            (u, v, 0),
        )
        for u in (-x * 0.4, 0, x * 0.4)
        for v in (-y * 0.33, 0, y * 0.33)
    ]
    frame = [
        p
        for u in (-x * 0.4, 0, x * 0.4)
        for p in (
            box(f.main, (0.05, y, 0.04), (u, 0, 0.27)),
            *(pipe(f.main, [(u, s * y * 0.45, 0.28), (u, s * y * 0.45, z)], 0.01) for s in (-1, 1)),
        )
    ]
    return [*bars, *marks, *posts, *frame]


def jet_fan(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    r = 0.32
    tube = placed(
        turned(
            f.main,
            [(0.26, -1.0), (r, -1.0), (r + 0.02, -0.95), (r, -0.9), (r, 0.9), (r + 0.02, 0.95), (r, 1.0), (0.26, 1.0)],
        ),
        (0, 0, 0.36),
        LYING,
    )
    inside = [placed(turned(DARK, [(0.26, s * 0.92), (0, s * 0.92)][::s]), (0, 0, 0.36), LYING) for s in (-1, 1)]
    blades = [
        placed(placed(box(STEEL, (0.2, 0.08, 0.012), (0.14, 0, s * 0.94))), (0, 0, 0.36), LYING @ _about(a))
        for s in (-1, 1)
        for a in np.arange(7) * 0.9
    ]
    hubs = [placed(ellipsoid(STEEL, (0.08, 0.08, 0.1), (0, 0, s * 0.94)), (0, 0, 0.36), LYING) for s in (-1, 1)]
    bands = [placed(hoop(f.second, r + 0.01, 0.012, tall=0.05), (u, 0, 0.36), LYING) for u in (-0.5, 0.5)]
    return [
        tube,
        *inside,
        *blades,
        *hubs,
        *bands,
        *(pipe(f.second, [(u, s * 0.22, 0.6), (u, s * 0.22, z)], 0.025) for u in (-0.5, 0.5) for s in (-1, 1)),
    ]


def _about(angle: float) -> Float:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
