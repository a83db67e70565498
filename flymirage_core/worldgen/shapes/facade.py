"""What hangs on facades and in plant rooms. The back is at -y.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    crown,
    hoop,
    mirrored,
    pipe,
    placed,
    plate,
    rounded_ring,
    skin,
    tapered,
)
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, turned
from flymirage_core.worldgen.shapes.fittings import flange, handwheel
from flymirage_core.worldgen.shapes.foliage import flowers, greenery
from flymirage_core.worldgen.surfaces import Float, Part, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")


def basketball_hoop(size: Vector, f: Finish) -> list[Part]:
    board = [
        box(WHITE, (1.2, 0.03, 0.9), (0, -0.42, 0.2), 0.01),
        *(
            box(f.main, w, (u, -0.4, z))
            for w, u, z in (
                ((1.2, 0.012, 0.05), 0, 0.2),
                ((1.2, 0.012, 0.05), 0, 1.05),
                ((0.05, 0.012, 0.9), -0.575, 0.2),
                ((0.05, 0.012, 0.9), 0.575, 0.2),
                ((0.5, 0.012, 0.03), 0, 0.38),
                ((0.5, 0.012, 0.03), 0, 0.72),
                ((0.03, 0.012, 0.35), -0.24, 0.38),
                ((0.03, 0.012, 0.35), 0.24, 0.38),
            )
        ),
    ]
    ring = [
        hoop(paint("orange", "enamel"), 0.225, 0.012, (0, -0.1, 0.4)),
        box(paint("orange", "enamel"), (0.14, 0.1, 0.1), (0, -0.37, 0.33), 0.01),
    ]
    strands = [
        placed(
            pipe(
                WHITE,
                [
                    (0.22, 0, 0.4),
                    (0.15 * np.cos(t), 0.15 * np.sin(t), 0.18),
                    (0.13 * np.cos(2 * t), 0.13 * np.sin(2 * t), 0.0),
                ],
                0.004,
            ),
            (0, -0.1, 0),
            _yaw(a),
        )
        for a in np.arange(10) * 0.628
        for t in (-0.45, 0.45)
    ]
    return [
        *board,
        *ring,
        *strands,
        *(pipe(STEEL, [(s * 0.3, -0.44, z), (s * 0.15, -0.5, z)], 0.02) for s in (-1, 1) for z in (0.4, 0.8)),
    ]


def _yaw(angle: float) -> Float:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def shop_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    words = ("BAKERY", "BOOKS", "FLORIST", "CAFE LUNA", "OPTICIAN", "BICYCLES", "ANTIQUES", "PHARMACY")[f.seed % 8]
    dark = sum(f.main.colour) < 0.9
    face = replace(
        f.main, texture="text", words=words, ink=paint("cream" if dark else "black").colour, detail=0.35, wear=0.0
    )
    rim = [box(f.second, (x, y, 0.04), (0, 0, h), 0.008) for h in (0, z - 0.04)] + [
        *mirrored(box(f.second, (0.04, y, z), (x / 2 - 0.02, 0, 0), 0.008))
    ]
    lamps = [
        p
        for u in (-x * 0.3, 0, x * 0.3)
        for p in (
            pipe(DARK, [(u, 0, z - 0.02), (u, y * 0.7, z + 0.06), (u, y * 1.2, z + 0.02)], 0.01, 0.05),
            ellipsoid(paint("cream", emission=1.2), (0.05, 0.04, 0.03), (u, y * 1.2, z)),
        )
    ]
    return [
        box(f.main, (x - 0.04, y * 0.7, z - 0.04), (0, -y * 0.1, 0.02)),
        *rim,
        picture(face, x - 0.08, z - 0.08, (0, y * 0.27, 0.04)),
        *lamps,
    ]


def neon_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    word = ("OPEN", "BAR", "JAZZ", "PIZZA", "DINER", "HOTEL")[f.seed % 6]
    glow = paint(("coral", "turquoise", "yellow", "pink")[f.chosen(4)]).colour
    face = replace(paint("black", "text", 0.0, 0.3), ink=glow, words=word, emission=1.6)
    outline = np.column_stack(
        [
            rounded_ring(x - 0.06, z - 0.06, 0.12, 5)[:, 0],
            np.full(20, y / 2),
            rounded_ring(x - 0.06, z - 0.06, 0.12, 5)[:, 1] + z / 2,
        ]
    )
    tube = pipe(
        paint(("turquoise", "coral", "blue", "yellow")[f.chosen(4)], emission=2.2),
        np.vstack([outline, outline[:1]]),
        0.014,
    )
    return [
        box(DARK, (x, y * 0.5, z), (0, -y * 0.25, 0), 0.02),
        picture(face, x * 0.8, z * 0.7, (0, y * 0.1, z * 0.15)),
        tube,
    ]


def awning(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    u = np.linspace(-x / 2, x / 2, 25)
    stripes = replace(f.main, texture="stripes", ink=paint("chalk").colour, detail=0.6)
    scallop = 0.05 * np.abs(np.sin(np.pi * (u + x / 2) / 0.2))
    rows = [
        np.column_stack([u, np.full(25, v), np.full(25, h)])
        for v, h in ((-y / 2 + 0.02, z - 0.03), (y / 2 - 0.02, 0.28))
    ]
    rows.append(np.column_stack([u, np.full(25, y / 2 - 0.02), 0.05 - scallop + 0.05]))
    arms = [
        pipe(STEEL, [(s * (x / 2 - 0.1), -y / 2 + 0.02, 0.3), (s * (x / 2 - 0.1), y / 2 - 0.03, 0.28)], 0.016)
        for s in (-1, 1)
    ]
    return [
        *skin(stripes, [r[:, :] for r in rows]),
        pipe(STEEL, [(-x / 2, -y / 2 + 0.04, z - 0.03), (x / 2, -y / 2 + 0.04, z - 0.03)], 0.03),
        pipe(STEEL, [(-x / 2, y / 2 - 0.03, 0.28), (x / 2, y / 2 - 0.03, 0.28)], 0.016),
        *arms,
    ]


def loudspeaker(size: Vector, f: Finish) -> list[Part]:
    """A horn on a bracket."""
    horn = placed(
        turned(
            f.main,
            [
                (0.03, -0.14),
                (0.035, -0.05),
                *((0.04 + 0.13 * t**1.8, -0.05 + 0.19 * t) for t in np.linspace(0.1, 1, 6)),
                (0.165, 0.14),
                *((0.035 + 0.12 * t**1.8, -0.05 + 0.18 * t) for t in np.linspace(1, 0.1, 5)),
                (0, -0.05),
            ],
            scale=(1.0, 1.35),
        ),
        (0, 0.02, 0.25),
        FACING,
    )
    driver = placed(
        turned(f.second, [(0, -0.16), (0.05, -0.16), (0.06, -0.12), (0.06, -0.06), (0, -0.06)]), (0, 0.02, 0.25), FACING
    )
    bracket = [
        pipe(STEEL, [(-0.18, 0.02, 0.25), (-0.18, -0.13, 0.25), (0.18, -0.13, 0.25), (0.18, 0.02, 0.25)], 0.012, 0.05),
        box(STEEL, (0.12, 0.02, 0.2), (0, -0.13, 0.15), 0.006),
    ]
    return [horn, driver, *bracket, box(f.main, (0.02, 0.04, 0.5), (0, -0.12, 0.0))]


def ventilation_fan(size: Vector, f: Finish) -> list[Part]:
    box_ = [box(f.main, (0.9, 0.12, 0.07), (0, 0, z), 0.01) for z in (0, 0.83)] + [
        *mirrored(box(f.main, (0.07, 0.12, 0.9), (0.415, 0, 0), 0.01))
    ]
    ring = placed(
        turned(f.main, [(0.4, -0.14), (0.4, 0.12), (0.37, 0.14), (0.36, 0.12), (0.36, -0.14)]), (0, 0, 0.45), FACING
    )
    back = placed(turned(DARK, [(0.37, -0.12), (0, -0.12)]), (0, 0, 0.45), FACING)
    blades = [
        placed(
            plate(STEEL, [(0.03, -0.03), (0.24, -0.12), (0.34, -0.04), (0.32, 0.06), (0.05, 0.04)], 0.01),
            (0, -0.02, 0.45),
            _about_y(a),
        )
        for a in np.arange(5) * 1.2566
    ]
    guard = [placed(hoop(STEEL, r, 0.005), (0, 0.12, 0.45), FACING) for r in (0.12, 0.22, 0.32)] + [
        placed(pipe(STEEL, [(0, 0, 0), (0.37, 0, 0)], 0.005), (0, 0.12, 0.45), _about_y(a))
        for a in np.arange(8) * 0.785
    ]
    return [
        *box_,
        ring,
        back,
        *blades,
        *guard,
        placed(turned(f.second, [(0.08, 0), (0.07, 0.06), (0, 0.07)]), (0, -0.03, 0.45), FACING),
        box(f.main, (0.88, 0.02, 0.88), (0, -0.13, 0.01)),
    ]


def _about_y(angle: float) -> Float:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1.0, 0], [-s, 0, c]])


def ventilation_grille(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    rim = [box(f.main, (x, 0.04, 0.05), (0, 0, h), 0.008) for h in (0, z - 0.05)] + [
        *mirrored(box(f.main, (0.05, 0.04, z), (x / 2 - 0.025, 0, 0), 0.008))
    ]
    slats = [
        box(f.main, (x - 0.1, 0.05, 0.008), (0, 0, h), 0.002, 0.6)
        for h in np.linspace(0.07, z - 0.08, max(5, round(z / 0.05)))
    ]
    return [*rim, *slats, box(DARK, (x - 0.08, 0.006, z - 0.08), (0, -0.02, 0.04))]


def hose_reel(size: Vector, f: Finish) -> list[Part]:
    discs = [
        placed(turned(f.main, [(0.1, 0), (0.33, 0), (0.34, 0.012), (0.33, 0.024), (0.1, 0.024)]), (0, y, 0.35), FACING)
        for y in (-0.12, 0.1)
    ]
    coils = [
        placed(hoop(DARK, 0.27 - 0.05 * j, 0.026), (0, -0.07 + 0.055 * i, 0.35), FACING)
        for i in range(3)
        for j in range(2)
    ]
    hub = [
        placed(cylinder(STEEL, 0.06, 0.28), (0, -0.14, 0.35), FACING),
        *(placed(box(f.main, (0.5, 0.05, 0.02)), (0, 0.125, 0.35), _about_y(a) @ FACING) for a in (0.5, 2.07)),
    ]
    nozzle = [
        pipe(BRASS, [(0.3, 0.08, 0.15), (0.34, 0.1, 0.02)], 0.018),
        box(f.main, (0.3, 0.03, 0.5), (0, -0.145, 0.1), 0.01),
    ]
    return [*discs, *coils, *hub, *nozzle]


def pipe_run(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    top, low = (
        pipe(f.main, [(-x / 2, 0, z - 0.1), (x / 2, 0, z - 0.1)], 0.07),
        pipe(f.second, [(-x / 2, 0, 0.12), (x * 0.2, 0, 0.12), (x * 0.2, 0, z - 0.1)], 0.045, 0.1),
    )
    thin = [
        pipe(paint(c, "enamel"), [(-x / 2, 0.02, h), (x / 2, 0.02, h)], 0.022)
        for c, h in (("yellow", 0.24), ("blue", 0.3))
    ]
    joints = [p for u in (-x * 0.32, x * 0.05, x * 0.4) for p in flange(f.main, 0.07, (u, 0, z - 0.1), LYING)]
    clips = [box(STEEL, (0.03, 0.14, z - 0.06), (u, -0.04, 0.03)) for u in (-x * 0.42, -x * 0.1, x * 0.3)]
    bands = [
        placed(hoop(paint("yellow"), 0.071, 0.006, tall=0.05), (u, 0, z - 0.1), LYING) for u in (-x * 0.2, x * 0.22)
    ]
    return [
        top,
        low,
        *thin,
        *joints,
        *clips,
        *bands,
        *handwheel(paint("red", "enamel"), 0.09, (-x * 0.15, 0.12, 0.12), FACING),
        pipe(STEEL, [(-x * 0.15, 0, 0.12), (-x * 0.15, 0.12, 0.12)], 0.015),
    ]


def valve_wheel(size: Vector, f: Finish) -> list[Part]:
    body = [
        placed(
            turned(
                f.second,
                [
                    (0, -0.17),
                    (0.14, -0.17),
                    (0.14, -0.13),
                    (0.07, -0.12),
                    (0.06, 0.0),
                    (0.09, 0.02),
                    (0.09, 0.05),
                    (0, 0.05),
                ],
            ),
            (0, 0, 0.25),
            FACING,
        ),
        pipe(STEEL, [(0, 0.05, 0.25), (0, 0.18, 0.25)], 0.022),
    ]
    line = [pipe(f.second, [(0, -0.08, 0.0), (0, -0.08, 0.5)], 0.06)]
    return [*body, *line, *handwheel(f.main, 0.22, (0, 0.14, 0.25), FACING)]


def cable_tray(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    rails = [box(f.main, (x, 0.02, 0.1), (0, s * (y / 2 - 0.01), 0)) for s in (-1, 1)]
    rungs = [box(f.main, (0.03, y - 0.03, 0.015), (u, 0, 0.01)) for u in np.arange(-x / 2 + 0.1, x / 2, 0.25)]
    cables = []
    for k in range(9):
        v, colour = (
            (k - 4) * (y - 0.06) / 9,
            ("black", "black", "orange", "blue", "grey", "yellow")[int(rng.integers(6))],
        )
        path = [(u, v + rng.normal(0, 0.008), 0.045 + rng.uniform(0, 0.02)) for u in np.linspace(-x / 2, x / 2, 8)]
        cables.append(pipe(paint(colour), path, float(rng.uniform(0.01, 0.017))))
    hangers = [
        pipe(STEEL, [(u, s * (y / 2 - 0.01), 0.05), (u, s * (y / 2 - 0.01), z)], 0.006)
        for u in (-x * 0.35, x * 0.35)
        for s in (-1, 1)
    ]
    return [*rails, *rungs, *cables, *hangers]


def drainpipe(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    line = pipe(f.main, [(0, 0.01, z), (0, 0.01, 0.15), (0, 0.08, 0.0)], 0.05, 0.08)
    head = tapered(f.main, [(0.1, 0.1, z - 0.24), (0.16, 0.14, z - 0.14), (0.16, 0.14, z)], radius=0.01)
    return [
        line,
        head,
        *(
            p
            for h in np.arange(0.6, z - 0.4, 0.8)
            for p in (
                hoop(f.second, 0.052, 0.008, (0, 0.01, float(h)), 0.04),
                box(f.second, (0.14, 0.02, 0.04), (0, -0.06, float(h) - 0.02)),
            )
        ),
    ]


def balcony(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    slab = [
        box(paint("light grey", "concrete"), (x, y, 0.14), (0, 0, 0), 0.01),
        *(
            tapered(
                paint("light grey", "concrete"),
                [(0.1, 0.2, -0.16), (0.1, 0.7, 0.0)],
                (s * x * 0.35, -y / 2 + 0.35, 0),
                0.01,
            )
            for s in (-1, 1)
        ),
    ]
    bars = [
        pipe(f.main, [(u, y / 2 - 0.04, 0.14), (u, y / 2 - 0.04, z - 0.03)], 0.01)
        for u in np.linspace(-x / 2 + 0.04, x / 2 - 0.04, round(x / 0.12))
    ]
    bars += [
        pipe(f.main, [(s * (x / 2 - 0.04), v, 0.14), (s * (x / 2 - 0.04), v, z - 0.03)], 0.01)
        for s in (-1, 1)
        for v in np.arange(-y / 2 + 0.1, y / 2 - 0.05, 0.12)
    ]
    rails = [
        pipe(
            f.main,
            [
                (-x / 2 + 0.04, -y / 2, h),
                (-x / 2 + 0.04, y / 2 - 0.04, h),
                (x / 2 - 0.04, y / 2 - 0.04, h),
                (x / 2 - 0.04, -y / 2, h),
            ],
            w,
        )
        for h, w in ((z - 0.03, 0.025), (0.26, 0.012))
    ]
    scrolls = [
        placed(hoop(f.main, 0.05, 0.007), (u, y / 2 - 0.04, z - 0.14), FACING)
        for u in np.arange(-x / 2 + 0.12, x / 2 - 0.08, 0.24)
    ]
    return [*slab, *bars, *rails, *scrolls]


def window_box(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    trough = tapered(
        f.main, [(x * 0.9, y * 0.7, 0), (x, y, z * 0.5), (x, y, z * 0.55), (x * 0.94, y * 0.85, z * 0.55)], radius=0.015
    )
    rng = f.generator()
    blobs: list[tuple[Vector, Vector]] = [
        ((0.14, y * 0.42, z * 0.18), (u, 0.02, z * 0.64)) for u in np.arange(-x / 2 + 0.12, x / 2 - 0.05, 0.18)
    ]
    return [
        trough,
        *crown(greenery(f), blobs, (0.07, 0.04), int(190 * x), rng, 0.6),
        *flowers(f, x * 0.45, y * 0.4, z * 0.64, z * 0.32, int(34 * x)),
    ]
