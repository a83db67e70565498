"""Electricity: transformers, switchgear, insulators, batteries, consoles, servers.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    cable,
    frame_of,
    hoop,
    patterned,
    pipe,
    placed,
    sign,
    skin,
    spun,
    sweep,
    tapered,
)
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, turned
from flymirage_core.worldgen.shapes.fittings import DARK, IRON, STEEL, gauge
from flymirage_core.worldgen.surfaces import Part, Vector

SCREEN = paint("teal", "screen", 0.6, 0.35)


def insulator(material: Material, height: float, radius: float, base: Vector, sheds: int = 6) -> list[Part]:
    """A stack of porcelain sheds with metal ends."""
    pitch = height * 0.86 / sheds
    form = [(0.0, 0.07 * height), (0.45 * radius, 0.07 * height)]
    for k in range(sheds):
        z = 0.07 * height + k * pitch
        form += [
            (0.45 * radius, z),
            (radius, z + 0.35 * pitch),
            (radius * 0.97, z + 0.45 * pitch),
            (0.45 * radius, z + 0.8 * pitch),
        ]
    ends = [(0, 0), (0.6 * radius, 0), (0.6 * radius, 0.07 * height), (0, 0.07 * height)]
    return [
        turned(material, [*form, (0.0, 0.93 * height)], base),
        turned(STEEL, ends, base),
        turned(STEEL, ends, (base[0], base[1], base[2] + 0.93 * height)),
    ]


def transformer(size: Vector, f: Finish) -> list[Part]:
    """A tank with cooling fins, bushings, and an oil conservator."""
    tank = tapered(f.main, [(1.3, 0.7, 0.15), (1.3, 0.7, 1.2), (1.4, 0.8, 1.2), (1.4, 0.8, 1.26)], radius=0.03)
    fins = [
        box(f.main.shaded(0.92), (0.025, 0.24, 0.85), (u, s * 0.47, 0.27), 0.005)
        for u in np.linspace(-0.55, 0.55, 12)
        for s in (-1, 1)
    ]
    fins += [
        box(f.main.shaded(0.92), (0.24, 0.025, 0.85), (s * 0.77, v, 0.27), 0.005)
        for v in np.linspace(-0.26, 0.26, 6)
        for s in (-1, 1)
    ]
    bushings = [
        p for u in (-0.4, 0.0, 0.4) for p in insulator(paint("brick red", "plain"), 0.62, 0.09, (u, 0.12, 1.24))
    ]
    caps = [pipe(paint("copper", "metal"), [(u, 0.12, 1.84), (u, 0.12, 1.96)], 0.02) for u in (-0.4, 0, 0.4)]
    drum = [
        pipe(f.main, [(-0.5, -0.26, 1.62), (0.5, -0.26, 1.62)], 0.17),
        *(box(f.second, (0.06, 0.2, 0.24), (u, -0.26, 1.25)) for u in (-0.35, 0.35)),
    ]
    base = [box(IRON, (1.5, 0.12, 0.15), (0, s * 0.25, 0)) for s in (-1, 1)]
    return [
        tank,
        *fins,
        *bushings,
        *caps,
        *drum,
        *base,
        sign("DANGER|HIGH VOLTAGE", 0.5, 0.3, (0, 0.605, 0.62), "yellow"),
        *gauge((0.45, 0.42, 1.1)),
    ]


def switchgear(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.8, 0.64, 2.0), (0, -0.03, 0.06), 0.012)
    doors = [
        box(f.main.shaded(1.08), (0.74, 0.03, h), (0, 0.3, b), 0.006)
        for b, h in ((0.12, 0.75), (0.9, 0.5), (1.43, 0.58))
    ]
    meters = [p for i in range(3) for p in gauge((-0.22 + 0.22 * i, 0.33, 1.82), 0.08)]
    lamps = [cylinder(paint(c, emission=0.8), 0.025, 0.03, (0, 0, 0)) for c in ("red", "yellow", "green")]
    lights = [placed(p, (-0.2 + 0.12 * i, 0.31, 1.55), FACING) for i, p in enumerate(lamps)]
    grip = [
        placed(turned(IRON, [(0, 0), (0.07, 0), (0.07, 0.03), (0, 0.03)]), (0.2, 0.31, 1.56), FACING),
        box(paint("red"), (0.03, 0.04, 0.14), (0.2, 0.345, 1.5), 0.008),
    ]
    vents = box(patterned("light grey", "grille", "charcoal", 0.4), (0.5, 0.012, 0.24), (0, 0.318, 0.2))
    handles = [box(IRON, (0.03, 0.05, 0.18), (0.3, 0.32, z), 0.01) for z in (0.5, 1.08)]
    return [
        body,
        *_service_back(f, 0.8, 2.0, 0.35),
        *doors,
        *meters,
        *lights,
        *grip,
        vents,
        *handles,
        box(IRON, (0.76, 0.6, 0.07)),
        sign("11 kV", 0.3, 0.14, (-0.12, 0.318, 1.16), "yellow"),
        sign("DANGER", 0.34, 0.12, (0, 0.318, 0.6), "red", "white"),
    ]


def insulator_stack(size: Vector, f: Finish) -> list[Part]:
    base = [
        tapered(paint("light grey", "concrete"), [(0.45, 0.45, 0), (0.4, 0.4, 0.3)], radius=0.02),
        box(STEEL, (0.3, 0.3, 0.3), (0, 0, 0.3), 0.01),
    ]
    lower, upper = insulator(f.main, 0.85, 0.15, (0, 0, 0.6), 8), insulator(f.main, 0.75, 0.135, (0, 0, 1.45), 7)
    top = [
        hoop(STEEL, 0.2, 0.025, (0, 0, 2.2)),
        *spun(pipe(STEEL, [(0, 0, 2.2), (0.2, 0, 2.2)], 0.012), 4),
        pipe(paint("copper", "metal"), [(0, -0.2, 2.32), (0, 0.2, 2.32)], 0.03),
        cylinder(STEEL, 0.04, 0.16, (0, 0, 2.2)),
    ]
    return [*base, *lower, *upper, *top]


def cable_reel(size: Vector, f: Finish) -> list[Part]:
    disc = [(0.0, -0.03), (0.55, -0.03), (0.55, 0.03), (0.0, 0.03)]
    sides = [placed(turned(f.main, disc), (s * 0.3, 0, 0.55), LYING) for s in (-1, 1)]
    coils = [
        placed(hoop(DARK, 0.36 + 0.02 * (i % 2), 0.03), (u, 0, 0.55), LYING)
        for i, u in enumerate(np.linspace(-0.24, 0.24, 10))
    ]
    core = pipe(DARK, [(-0.28, 0, 0.55), (0.28, 0, 0.55)], 0.36)
    rods = [
        pipe(
            IRON,
            [(-0.34, 0.2 * np.cos(a), 0.55 + 0.2 * np.sin(a)), (0.34, 0.2 * np.cos(a), 0.55 + 0.2 * np.sin(a))],
            0.018,
        )
        for a in np.arange(4) * 1.57
    ]
    boards = [
        box(f.main.shaded(0.75), (0.01, 0.012, 1.02), (s * 0.332, v, 0.04)) for s in (-1, 1) for v in (-0.27, 0.0, 0.27)
    ]
    tail = cable(DARK, (0.2, 0.36, 0.3), (0.24, 0.5, 0.02), 0.02, 0.025)
    return [*sides, core, *coils, *rods, *boards, tail]


def control_panel(size: Vector, f: Finish) -> list[Part]:
    """A console with a sloping desk of switches and an upright board of dials."""
    x = 1.6
    section = np.array([(0.35, 0.0), (0.35, 0.72), (-0.02, 0.86), (-0.1, 1.2), (-0.3, 1.2), (-0.3, 0.0)])  # (y, z)
    body = sweep(f.main, section, [(-x / 2, 0, 0), (x / 2, 0, 0)])
    slope = _tilted_sheet(
        patterned("slate grey", "buttons", "charcoal", 0.25, f.seed % 97), x - 0.1, (0.35, 0.725), (-0.01, 0.862)
    )
    board = _tilted_sheet(
        patterned("slate grey", "buttons", "black", 0.3, f.seed % 89), x - 0.5, (-0.025, 0.885), (-0.06, 1.03)
    )
    dials = [p for u in np.linspace(-0.65, 0.65, 7) for p in gauge((u, -0.06, 1.12), 0.06)]
    screens = [placed(box(SCREEN, (0.3, 0.02, 0.16), (0, 0, 0)), (u, -0.035, 0.89)) for u in (-0.62, 0.62)]
    levers = [
        p
        for u in (-0.3, 0.3)
        for p in (
            pipe(STEEL, [(u, 0.2, 0.76), (u, 0.22, 0.9)], 0.01),
            ellipsoid(paint("red"), (0.025,) * 3, (u, 0.22, 0.91)),
        )
    ]
    return [
        body,
        *slope,
        *board,
        *dials,
        *screens,
        *levers,
        *_service_back(f, x, 1.2, 0.3),
        *(
            box(patterned("light grey", "grille", "charcoal", 0.4), (0.46, 0.012, 0.2), (u, 0.352, 0.3))
            for u in (-0.5, 0.5)
        ),
        *(box(f.main.shaded(1.12), (0.7, 0.02, 0.56), (u, 0.345, 0.1), 0.006) for u in (-0.38, 0.38)),
        box(IRON, (x, 0.02, 0.08), (0, 0.345, 0)),
    ]


def _service_back(f: Finish, width: float, height: float, y: float) -> list[Part]:
    """What is on the back of a cabinet that ends at -``y``: two panels with screws, louvres, a plate, a conduit."""
    leaf, parts = (width - 0.1) / 2, []
    vent = patterned("light grey", "grille", "charcoal", 0.4)
    for s in (-1, 1):
        u = s * (width / 4)
        parts += [
            box(f.main.shaded(1.12), (leaf - 0.03, 0.02, height - 0.14), (u, -y - 0.005, 0.08), 0.006),
            box(vent, (leaf * 0.7, 0.012, height * 0.16), (u, -y - 0.012, height * 0.16)),
            box(vent, (leaf * 0.7, 0.012, height * 0.1), (u, -y - 0.012, height * 0.74)),
            box(IRON, (0.025, 0.03, 0.14), (s * 0.07, -y - 0.02, height * 0.48), 0.006),
        ]
        parts += [
            box(STEEL, (0.025, 0.012, 0.025), (u + t * (leaf / 2 - 0.05), -y - 0.014, z), 0.004)
            for t in (-1, 1)
            for z in (0.12, height - 0.11)
        ]
    plate = box(paint("yellow"), (0.2, 0.006, 0.14), (width / 4, -y - 0.017, height * 0.5))
    x = -width / 2 + 0.12
    conduit = pipe(
        STEEL, [(x, -y - 0.03, 0.0), (x, -y - 0.03, height * 0.6), (x, -y + 0.03, height * 0.66)], 0.022, 0.05
    )
    return [*parts, plate, conduit]


def _tilted_sheet(material: Material, width: float, low: tuple[float, float], high: tuple[float, float]) -> list[Part]:
    """A board facing front and up, from (y, z) ``low`` to ``high``, lifted a few millimetres."""
    lift = np.array([0, 0.004, 0.004])
    a = np.array([[width / 2, *low], [-width / 2, *low]]) + lift
    b = np.array([[width / 2, *high], [-width / 2, *high]]) + lift
    return skin(material, [b, a])[1:] + skin(material, [b, a])[:1]


def battery_bank(size: Vector, f: Finish) -> list[Part]:
    frame = [box(IRON, (1.6, 0.55, 0.05), (0, 0, z)) for z in (0.1, 0.75)] + [
        box(IRON, (0.06, 0.5, 1.2), (s * 0.77, 0, 0)) for s in (-1, 1)
    ]
    cells, wires = [], []
    for z in (0.15, 0.8):
        for i in range(7):
            u = -0.63 + 0.21 * i
            cells += [
                box(f.main, (0.18, 0.42, 0.42), (u, 0, z), 0.015),
                box(paint("chalk"), (0.12, 0.005, 0.1), (u, 0.212, z + 0.2)),
            ]
            cells += [
                cylinder(paint("red" if s > 0 else "black"), 0.022, 0.04, (u, s * 0.12, z + 0.42)) for s in (-1, 1)
            ]
            if i:
                wires.append(cable(paint("orange"), (u - 0.21, 0.12, z + 0.46), (u, -0.12, z + 0.46), -0.06, 0.012))
    return [*frame, *cells, *wires, sign("DC 110 V", 0.4, 0.12, (0, 0.28, 0.63), "yellow")]


def solar_panel(size: Vector, f: Finish) -> list[Part]:
    turn = np.array([[1.0, 0, 0], [0, 0.85, 0.53], [0, -0.53, 0.85]])
    cells = replace(paint("navy", "small tiles"), joints=(0.15, 0.15, 0.012), colour=(0.02, 0.035, 0.1), detail=0.8)
    panel = [box(STEEL, (1.7, 1.1, 0.04)), box(cells, (1.64, 1.04, 0.012), (0, 0, 0.036))]
    rack = [pipe(STEEL, [(u, -0.35, 0), (u, -0.42, 0.78)], 0.025) for u in (-0.6, 0.6)] + [
        pipe(STEEL, [(u, 0.45, 0), (u, 0.42, 0.26)], 0.025) for u in (-0.6, 0.6)
    ]
    rack += [pipe(STEEL, [(u, -0.36, 0.02), (u, 0.45, 0.02)], 0.02) for u in (-0.6, 0.6)]
    return [*(placed(p, (0, 0, 0.5), turn) for p in panel), *rack]


def server_rack(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    frame = frame_of(paint("black", "metal"), (0.6, 1.0, 2.0), 0.05)
    sides = [box(paint("charcoal", "metal"), (0.02, 0.94, 1.9), (s * 0.28, 0, 0.05)) for s in (-1, 1)] + [
        box(paint("charcoal"), (0.54, 0.02, 1.9), (0, -0.47, 0.05))
    ]
    units, z = [], 0.08
    while z < 1.86:
        high = float(rng.choice([0.045, 0.09, 0.09, 0.18]))
        face = patterned(
            str(rng.choice(["charcoal", "slate grey", "silver"])),
            str(rng.choice(["grille", "buttons"])),
            "black",
            0.3,
            int(rng.integers(99)),
        )
        units.append(box(face, (0.5, 0.8, high - 0.008), (0, 0.06, z), 0.003))
        units += [
            box(
                paint(str(rng.choice(["green", "green", "sky blue", "orange"])), emission=1.5),
                (0.012, 0.01, 0.01),
                (0.2 - 0.03 * i, 0.463, z + 0.015),
            )
            for i in range(3)
        ]
        z += high
    wires = [
        cable(paint(c), (-0.23, 0.47, a), (-0.23, 0.47, b), 0.0, 0.008)
        for c, a, b in (("blue", 0.4, 1.2), ("yellow", 0.8, 1.7))
    ]
    return [*frame, *sides, *units, *wires]
