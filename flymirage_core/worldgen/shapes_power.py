"""Electricity, laboratories and what must be kept away from people. +y is the front; `fitted` makes sizes exact."""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    bolts,
    cable,
    frame_of,
    group,
    hoop,
    hull,
    patterned,
    pipe,
    placed,
    sign,
    skin,
    spun,
    sweep,
    tapered,
)  # fmt: skip
from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.shapes_industrial import DARK, HAZARD, IRON, STEEL, gauge
from flymirage_core.worldgen.surfaces import Part, Vector

GLASS = replace(paint("powder blue", "glass"), opacity=0.35)
SCREEN = paint("teal", "screen", 0.6, 0.35)


def insulator(material: Material, height: float, radius: float, base: Vector, sheds: int = 6) -> list[Part]:
    """A stack of porcelain sheds with metal ends."""
    pitch = height * 0.86 / sheds
    form = [(0.0, 0.07 * height), (0.45 * radius, 0.07 * height)]
    for k in range(sheds):
        z = 0.07 * height + k * pitch
        form += [(0.45 * radius, z), (radius, z + 0.35 * pitch), (radius * 0.97, z + 0.45 * pitch), (0.45 * radius, z + 0.8 * pitch)]
    ends = [(0, 0), (0.6 * radius, 0), (0.6 * radius, 0.07 * height), (0, 0.07 * height)]
    return [turned(material, [*form, (0.0, 0.93 * height)], base), turned(STEEL, ends, base), turned(STEEL, ends, (base[0], base[1], base[2] + 0.93 * height))]


def transformer(size: Vector, f: Finish) -> list[Part]:
    """A tank with cooling fins, bushings, and an oil conservator."""
    tank = tapered(f.main, [(1.3, 0.7, 0.15), (1.3, 0.7, 1.2), (1.4, 0.8, 1.2), (1.4, 0.8, 1.26)], radius=0.03)
    fins = [box(f.main.shaded(0.92), (0.025, 0.24, 0.85), (u, s * 0.47, 0.27), 0.005) for u in np.linspace(-0.55, 0.55, 12) for s in (-1, 1)]
    fins += [box(f.main.shaded(0.92), (0.24, 0.025, 0.85), (s * 0.77, v, 0.27), 0.005) for v in np.linspace(-0.26, 0.26, 6) for s in (-1, 1)]
    bushings = [p for u in (-0.4, 0.0, 0.4) for p in insulator(paint("brick red", "plain"), 0.62, 0.09, (u, 0.12, 1.24))]
    caps = [pipe(paint("copper", "metal"), [(u, 0.12, 1.84), (u, 0.12, 1.96)], 0.02) for u in (-0.4, 0, 0.4)]
    drum = [pipe(f.main, [(-0.5, -0.26, 1.62), (0.5, -0.26, 1.62)], 0.17), *(box(f.second, (0.06, 0.2, 0.24), (u, -0.26, 1.25)) for u in (-0.35, 0.35))]
    base = [box(IRON, (1.5, 0.12, 0.15), (0, s * 0.25, 0)) for s in (-1, 1)]
    return [tank, *fins, *bushings, *caps, *drum, *base, sign("DANGER|HIGH VOLTAGE", 0.5, 0.3, (0, 0.605, 0.62), "yellow"), *gauge((0.45, 0.42, 1.1))]


def switchgear(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.8, 0.64, 2.0), (0, -0.03, 0.06), 0.012)
    doors = [box(f.main.shaded(1.08), (0.74, 0.03, h), (0, 0.3, b), 0.006) for b, h in ((0.12, 0.75), (0.9, 0.5), (1.43, 0.58))]
    meters = [p for i in range(3) for p in gauge((-0.22 + 0.22 * i, 0.33, 1.82), 0.08)]
    lamps = [cylinder(paint(c, emission=0.8), 0.025, 0.03, (0, 0, 0)) for c in ("red", "yellow", "green")]
    lights = [placed(p, (-0.2 + 0.12 * i, 0.31, 1.55), FACING) for i, p in enumerate(lamps)]
    grip = [placed(turned(IRON, [(0, 0), (0.07, 0), (0.07, 0.03), (0, 0.03)]), (0.2, 0.31, 1.56), FACING), box(paint("red"), (0.03, 0.04, 0.14), (0.2, 0.345, 1.5), 0.008)]
    vents = box(patterned("light grey", "grille", "charcoal", 0.4), (0.5, 0.012, 0.24), (0, 0.318, 0.2))
    handles = [box(IRON, (0.03, 0.05, 0.18), (0.3, 0.32, z), 0.01) for z in (0.5, 1.08)]
    return [body, *doors, *meters, *lights, *grip, vents, *handles, box(IRON, (0.76, 0.6, 0.07)), sign("11 kV", 0.3, 0.14, (-0.12, 0.318, 1.16), "yellow"), sign("DANGER", 0.34, 0.12, (0, 0.318, 0.6), "red", "white")]


def insulator_stack(size: Vector, f: Finish) -> list[Part]:
    base = [tapered(paint("light grey", "concrete"), [(0.45, 0.45, 0), (0.4, 0.4, 0.3)], radius=0.02), box(STEEL, (0.3, 0.3, 0.3), (0, 0, 0.3), 0.01)]
    lower, upper = insulator(f.main, 0.85, 0.15, (0, 0, 0.6), 8), insulator(f.main, 0.75, 0.135, (0, 0, 1.45), 7)
    top = [hoop(STEEL, 0.2, 0.025, (0, 0, 2.2)), *spun(pipe(STEEL, [(0, 0, 2.2), (0.2, 0, 2.2)], 0.012), 4), pipe(paint("copper", "metal"), [(0, -0.2, 2.32), (0, 0.2, 2.32)], 0.03), cylinder(STEEL, 0.04, 0.16, (0, 0, 2.2))]
    return [*base, *lower, *upper, *top]


def cable_reel(size: Vector, f: Finish) -> list[Part]:
    disc = [(0.0, -0.03), (0.55, -0.03), (0.55, 0.03), (0.0, 0.03)]
    sides = [placed(turned(f.main, disc), (s * 0.3, 0, 0.55), LYING) for s in (-1, 1)]
    coils = [placed(hoop(DARK, 0.36 + 0.02 * (i % 2), 0.03), (u, 0, 0.55), LYING) for i, u in enumerate(np.linspace(-0.24, 0.24, 10))]
    core = pipe(DARK, [(-0.28, 0, 0.55), (0.28, 0, 0.55)], 0.36)
    rods = [pipe(IRON, [(-0.34, 0.2 * np.cos(a), 0.55 + 0.2 * np.sin(a)), (0.34, 0.2 * np.cos(a), 0.55 + 0.2 * np.sin(a))], 0.018) for a in np.arange(4) * 1.57]
    boards = [box(f.main.shaded(0.75), (0.01, 0.012, 1.02), (s * 0.332, v, 0.04)) for s in (-1, 1) for v in (-0.27, 0.0, 0.27)]
    tail = cable(DARK, (0.2, 0.36, 0.3), (0.24, 0.5, 0.02), 0.02, 0.025)
    return [*sides, core, *coils, *rods, *boards, tail]


def control_panel(size: Vector, f: Finish) -> list[Part]:
    """A console with a sloping desk of switches and an upright board of dials."""
    x = 1.6
    section = np.array([(0.35, 0.0), (0.35, 0.72), (-0.02, 0.86), (-0.1, 1.2), (-0.3, 1.2), (-0.3, 0.0)])  # (y, z)
    body = sweep(f.main, section, [(-x / 2, 0, 0), (x / 2, 0, 0)])
    slope = _tilted_sheet(patterned("slate grey", "buttons", "charcoal", 0.25, f.seed % 97), x - 0.1, (0.35, 0.725), (-0.01, 0.862))
    board = _tilted_sheet(patterned("slate grey", "buttons", "black", 0.3, f.seed % 89), x - 0.5, (-0.025, 0.885), (-0.06, 1.03))
    dials = [p for u in np.linspace(-0.65, 0.65, 7) for p in gauge((u, -0.06, 1.12), 0.06)]
    screens = [placed(box(SCREEN, (0.3, 0.02, 0.16), (0, 0, 0)), (u, -0.035, 0.89)) for u in (-0.62, 0.62)]
    levers = [p for u in (-0.3, 0.3) for p in (pipe(STEEL, [(u, 0.2, 0.76), (u, 0.22, 0.9)], 0.01), ellipsoid(paint("red"), (0.025,) * 3, (u, 0.22, 0.91)))]
    return [body, *slope, *board, *dials, *screens, *levers, box(IRON, (x, 0.02, 0.08), (0, 0.345, 0))]


def _tilted_sheet(material: Material, width: float, low: tuple[float, float], high: tuple[float, float]) -> list[Part]:
    """A board facing front and up, from (y, z) ``low`` to ``high``, lifted a few millimetres."""
    lift = np.array([0, 0.004, 0.004])
    a = np.array([[width / 2, *low], [-width / 2, *low]]) + lift
    b = np.array([[width / 2, *high], [-width / 2, *high]]) + lift
    return skin(material, [b, a])[1:] + skin(material, [b, a])[:1]


def shielded_cask(size: Vector, f: Finish) -> list[Part]:
    """A lead cask for radioactive sources."""
    body = turned(f.main, [(0, 0.06), (0.4, 0.06), (0.42, 0.1), (0.42, 0.95), (0.4, 1.0), (0, 1.0)])
    ribs = [hoop(f.main.shaded(0.85), 0.425, 0.03, (0, 0, z), 0.05) for z in (0.2, 0.45, 0.8)]
    lid = turned(f.main.shaded(1.1), [(0.4, 1.0), (0.44, 1.0), (0.44, 1.1), (0.36, 1.14), (0, 1.14)])
    lugs = [p for s in (-1, 1) for p in (pipe(STEEL, [(s * 0.38, 0, 0.85), (s * 0.5, 0, 0.85)], 0.06), hoop(STEEL, 0.0501, 0.015, (s * 0.3, 0, 1.2)))]
    eye = [placed(hoop(STEEL, 0.09, 0.022), (0, 0, 1.24), FACING)]
    trefoil = sign("RADIOACTIVE|MATERIAL", 0.42, 0.22, (0, 0.435, 0.52), "yellow", "burgundy")
    return [body, *ribs, lid, *lugs, *eye, *bolts(IRON, 0.38, 10, 0.022, 1.1), trefoil, box(IRON, (0.8, 0.8, 0.07), (0, 0, 0), 0.01)]


def glove_box(size: Vector, f: Finish) -> list[Part]:
    legs = frame_of(STEEL, (1.4, 0.65, 0.85), 0.05)
    case = tapered(f.main, [(1.5, 0.8, 0.85), (1.5, 0.8, 1.15), (1.5, 0.5, 1.75)], radius=0.03, lean=(0.0, 0.0, -0.14))
    pane = [placed(box(replace(paint("powder blue", "glass"), opacity=0.8), (1.2, 0.015, 0.5), (0, 0, 0)), (0, 0.375, 1.2), np.array([[1.0, 0, 0], [0, 0.89, -0.46], [0, 0.46, 0.89]]))]
    ports = [p for u in (-0.32, 0.32) for p in (placed(hoop(STEEL, 0.12, 0.022), (u, 0.4, 1.03), FACING), placed(turned(DARK, [(0.11, 0.0), (0.1, 0.1), (0.06, 0.3), (0, 0.34)]), (u, 0.38, 1.03), FACING))]
    lock = [placed(turned(STEEL, [(0, 0), (0.22, 0), (0.22, 0.28), (0.25, 0.28), (0.25, 0.34), (0, 0.36)]), (0.72, -0.05, 1.3), LYING)]
    pipes = [pipe(STEEL, [(u, -0.2, 1.7), (u, -0.2, 1.85), (u + 0.3, -0.2, 1.85)], 0.025, 0.05) for u in (-0.4, 0.1)]
    return [*legs, case, *pane, *ports, *lock, *pipes, *gauge((-0.62, 0.41, 1.08), 0.05), sign("GLOVE BOX 3", 0.34, 0.1, (0, 0.405, 0.88), "yellow")]


def fume_hood(size: Vector, f: Finish) -> list[Part]:
    base = [box(f.main, (1.5, 0.7, 0.85), (0, -0.05, 0)), *(box(f.main.shaded(1.1), (0.7, 0.02, 0.75), (s * 0.37, 0.305, 0.06), 0.004) for s in (-1, 1))]
    top = box(DARK, (1.5, 0.8, 0.05), (0, 0, 0.85), 0.01)
    sides = [box(f.main, (0.1, 0.7, 1.2), (s * 0.7, -0.05, 0.9)) for s in (-1, 1)]
    back = box(paint("chalk"), (1.4, 0.04, 1.2), (0, -0.36, 0.9))
    head = [box(f.main, (1.5, 0.7, 0.35), (0, -0.05, 1.95), 0.01), cylinder(STEEL, 0.14, 0.16, (0, -0.1, 2.28))]
    sash = [box(GLASS, (1.3, 0.015, 0.65), (0, 0.26, 1.35)), box(STEEL, (1.3, 0.03, 0.04), (0, 0.27, 1.32))]
    glasses = [turned(replace(paint(c, "glass"), opacity=0.8), smooth([(0.07, 0.9), (0.08, 0.97), (0.025, 1.06), (0.025, 1.12)], 6), (u, -0.05, 0)) for u, c in ((-0.35, "teal"), (0.1, "orange"), (0.4, "powder blue"))]
    return [*base, top, *sides, back, *head, *sash, *glasses, sign("FUME HOOD", 0.5, 0.12, (0, 0.305, 2.08), "chalk"), *(cylinder(STEEL, 0.025, 0.08, (u, 0.33, 0.72)) for u in (-0.6, 0.6))]


def safety_shower(size: Vector, f: Finish) -> list[Part]:
    line = pipe(f.main, [(0, -0.28, 0), (0, -0.28, 2.1), (0, 0.12, 2.1), (0, 0.12, 2.02)], 0.03, 0.08)
    rose = turned(f.main, [(0.14, 1.93), (0.12, 1.99), (0.03, 2.03), (0, 2.03)], (0, 0.12, 0))
    pull = [pipe(STEEL, [(0.14, 0.0, 2.05), (0.14, 0.0, 1.5)], 0.008), placed(hoop(STEEL, 0.07, 0.01), (0.14, 0.0, 1.42), FACING), pipe(STEEL, [(0, -0.1, 2.08), (0.14, 0.0, 2.05)], 0.012)]
    bowl = turned(paint("yellow", "enamel"), [(0.02, 0.95), (0.14, 1.0), (0.17, 1.08), (0.14, 1.05), (0, 1.02)], (0, 0.0, 0))
    arm = [pipe(f.main, [(0, -0.28, 0.92), (0, 0.0, 0.95)], 0.025), *(pipe(STEEL, [(s * 0.05, 0, 1.02), (s * 0.05, 0, 1.12)], 0.012) for s in (-1, 1))]
    plate = [sign("EMERGENCY|SHOWER", 0.36, 0.26, (0, -0.24, 1.55), "forest green", "white"), turned(HAZARD, [(0.32, 0.0), (0.32, 0.012), (0, 0.014)])]
    return [line, rose, *pull, bowl, *arm, *plate]


def battery_bank(size: Vector, f: Finish) -> list[Part]:
    frame = [box(IRON, (1.6, 0.55, 0.05), (0, 0, z)) for z in (0.1, 0.75)] + [box(IRON, (0.06, 0.5, 1.2), (s * 0.77, 0, 0)) for s in (-1, 1)]
    cells, wires = [], []
    for z in (0.15, 0.8):
        for i in range(7):
            u = -0.63 + 0.21 * i
            cells += [box(f.main, (0.18, 0.42, 0.42), (u, 0, z), 0.015), box(paint("chalk"), (0.12, 0.005, 0.1), (u, 0.212, z + 0.2))]
            cells += [cylinder(paint("red" if s > 0 else "black"), 0.022, 0.04, (u, s * 0.12, z + 0.42)) for s in (-1, 1)]
            if i:
                wires.append(cable(paint("orange"), (u - 0.21, 0.12, z + 0.46), (u, -0.12, z + 0.46), -0.06, 0.012))
    return [*frame, *cells, *wires, sign("DC 110 V", 0.4, 0.12, (0, 0.28, 0.63), "yellow")]


def solar_panel(size: Vector, f: Finish) -> list[Part]:
    turn = np.array([[1.0, 0, 0], [0, 0.85, 0.53], [0, -0.53, 0.85]])
    cells = replace(paint("navy", "small tiles"), joints=(0.15, 0.15, 0.012), colour=(0.02, 0.035, 0.1), detail=0.8)
    panel = [box(STEEL, (1.7, 1.1, 0.04)), box(cells, (1.64, 1.04, 0.012), (0, 0, 0.036))]
    rack = [pipe(STEEL, [(u, -0.35, 0), (u, -0.42, 0.78)], 0.025) for u in (-0.6, 0.6)] + [pipe(STEEL, [(u, 0.45, 0), (u, 0.42, 0.26)], 0.025) for u in (-0.6, 0.6)]
    rack += [pipe(STEEL, [(u, -0.36, 0.02), (u, 0.45, 0.02)], 0.02) for u in (-0.6, 0.6)]
    return [*(placed(p, (0, 0, 0.5), turn) for p in panel), *rack]


def antenna_mast(size: Vector, f: Finish) -> list[Part]:
    """A lattice mast with aerials and a dish."""
    corner = [(0.3, -0.2), (-0.3, -0.2), (0.0, 0.34)]
    at = [np.array([[u * k, v * k, z] for u, v in corner]) for z, k in zip(np.linspace(0, 3.4, 9), np.linspace(1, 0.35, 9), strict=True)]
    legs = [pipe(f.main, [level[i] for level in at], 0.02) for i in range(3)]
    braces = [pipe(f.main, [a[i], b[(i + 1) % 3]], 0.009) for a, b in zip(at, at[1:], strict=False) for i in range(3)]
    rings = [pipe(f.main, [*level, level[0]], 0.009) for level in at[1:]]
    top = [pipe(f.main, [(0, 0, 3.3), (0, 0, 4.0)], 0.018), *(box(paint("chalk"), (0.09, 0.05, 0.6), (0.16 * np.cos(a), 0.16 * np.sin(a), 3.1), 0.02) for a in (0.5, 2.6, 4.7))]
    dish = [placed(turned(paint("white"), smooth([(0, 0), (0.12, 0.02), (0.22, 0.08)], 5)), (0, 0.2, 2.4), FACING), ellipsoid(paint("red", emission=1.5), (0.04,) * 3, (0, 0, 3.97))]
    return [*legs, *braces, *rings, *top, *dish, box(paint("light grey", "concrete"), (0.8, 0.8, 0.1))]


def satellite_dish(size: Vector, f: Finish) -> list[Part]:
    tilt = np.array([[1.0, 0, 0], [0, 0.5, 0.866], [0, -0.866, 0.5]])
    form = [(0, 0), *((r, 0.55 * r * r) for r in np.linspace(0.08, 0.42, 6))]
    inside = placed(turned(f.main, [*form[::-1]]), (0, 0.05, 0.6), tilt)
    outside = placed(turned(f.main.shaded(0.85), form), (0, 0.045, 0.595), tilt)
    tip = np.array([0, 0.05, 0.6]) + tilt @ np.array([0, 0, 0.42])
    arm = [pipe(IRON, [np.array([0, 0.05, 0.6]) + tilt @ np.array([0, 0.4, 0.1]), tip], 0.014), placed(cylinder(DARK, 0.04, 0.1), tip, tilt)]
    stand = [pipe(STEEL, [(0, -0.1, 0), (0, -0.1, 0.5), (0, 0.02, 0.6)], 0.025, 0.06), turned(IRON, [(0, 0), (0.2, 0), (0.2, 0.02), (0, 0.02)], (0, -0.1, 0))]
    return [inside, outside, *arm, *stand]


def server_rack(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    frame = frame_of(paint("black", "metal"), (0.6, 1.0, 2.0), 0.05)
    sides = [box(paint("charcoal", "metal"), (0.02, 0.94, 1.9), (s * 0.28, 0, 0.05)) for s in (-1, 1)] + [box(paint("charcoal"), (0.54, 0.02, 1.9), (0, -0.47, 0.05))]
    units, z = [], 0.08
    while z < 1.86:
        high = float(rng.choice([0.045, 0.09, 0.09, 0.18]))
        face = patterned(str(rng.choice(["charcoal", "slate grey", "silver"])), str(rng.choice(["grille", "buttons"])), "black", 0.3, int(rng.integers(99)))
        units.append(box(face, (0.5, 0.8, high - 0.008), (0, 0.06, z), 0.003))
        units += [box(paint(str(rng.choice(["green", "green", "sky blue", "orange"])), emission=1.5), (0.012, 0.01, 0.01), (0.2 - 0.03 * i, 0.463, z + 0.015)) for i in range(3)]
        z += high
    wires = [cable(paint(c), (-0.23, 0.47, a), (-0.23, 0.47, b), 0.0, 0.008) for c, a, b in (("blue", 0.4, 1.2), ("yellow", 0.8, 1.7))]
    return [*frame, *sides, *units, *wires]


def catwalk(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    deck = z - 1.1
    grate = box(patterned("light grey", "grille", "charcoal", 0.4), (x, y - 0.06, 0.04), (0, 0, deck - 0.04))
    beams = [box(f.main, (x, 0.06, 0.16), (0, s * (y / 2 - 0.03), deck - 0.18)) for s in (-1, 1)]
    posts = [box(f.main, (0.09, 0.09, deck - 0.1), (s * (x / 2 - 0.2), t * (y / 2 - 0.08), 0)) for s in (-1, 1) for t in (-1, 1)]
    rails = [pipe(f.main, [(-x / 2, t * (y / 2 - 0.03), deck + h), (x / 2, t * (y / 2 - 0.03), deck + h)], 0.02) for t in (-1, 1) for h in (0.55, 1.08)]
    rails += [pipe(f.main, [(u, t * (y / 2 - 0.03), deck), (u, t * (y / 2 - 0.03), deck + 1.08)], 0.018) for t in (-1, 1) for u in np.linspace(-x / 2 + 0.03, x / 2 - 0.03, max(3, round(x / 0.8)))]
    braces = [pipe(f.main, [(s * (x / 2 - 0.2), t * (y / 2 - 0.08), deck - 0.7), (s * (x / 2 - 0.8), t * (y / 2 - 0.08), deck - 0.1)], 0.025) for s in (-1, 1) for t in (-1, 1)]
    toe = [box(HAZARD, (x, 0.012, 0.1), (0, s * (y / 2 - 0.01), deck)) for s in (-1, 1)]
    return [grate, *beams, *posts, *rails, *braces, *toe]


def gantry_crane(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    def i_beam(length: float, high: float) -> list[Part]:
        return [box(f.main, (length, 0.26, 0.03), (0, 0, h)) for h in (0.0, high - 0.03)] + [box(f.main, (length, 0.03, high), (0, 0, 0))]

    bridge = group(i_beam(x, 0.36), (0, 0, z - 0.36))
    legs = [pipe(f.main, [(s * (x / 2 - 0.25), t * 0.7, 0.15), (s * (x / 2 - 0.35), t * 0.14, z - 0.36)], 0.06) for s in (-1, 1) for t in (-1, 1)]
    feet = [box(f.main, (0.2, 1.6, 0.14), (s * (x / 2 - 0.25), 0, 0.1), 0.02) for s in (-1, 1)]
    wheels = [pipe(DARK, [(s * (x / 2 - 0.25) - 0.04, t * 0.66, 0.08), (s * (x / 2 - 0.25) + 0.04, t * 0.66, 0.08)], 0.08) for s in (-1, 1) for t in (-1, 1)]
    u = (-0.3, 0.1, 0.4)[f.chosen(3)]
    trolley = [box(paint("red", "enamel"), (0.4, 0.36, 0.26), (u, 0, z - 0.66), 0.03), cable(DARK, (u, 0, z - 0.66), (u, 0, 1.5), 0.0, 0.012)]
    hook = [box(HAZARD, (0.16, 0.1, 0.2), (u, 0, 1.35), 0.02), pipe(IRON, [(u, 0, 1.36), (u, 0, 1.26), (u + 0.07, 0, 1.2), (u, 0, 1.12), (u - 0.07, 0, 1.2)], 0.02, 0.06)]
    return [*bridge, *legs, *feet, *wheels, *trolley, *hook, sign("SWL 2 t", 0.6, 0.24, (-x * 0.28, 0.02, z - 0.3), "yellow")]


def vent_unit(size: Vector, f: Finish) -> list[Part]:
    """A rooftop air handler: louvred body, a fan on top, a bent duct."""
    body = box(f.main, (1.5, 0.9, 0.85), (0, 0, 0.12), 0.015)
    louvres = [box(patterned("light grey", "grille", "charcoal", 0.4), (0.6, 0.012, 0.55), (s * 0.36, 0.455, 0.28)) for s in (-1, 1)]
    top = [turned(f.second, [(0.34, 0.97), (0.34, 1.1), (0.3, 1.1), (0.3, 1.0), (0, 1.0)], (-0.3, 0, 0)), *(placed(p, (-0.3, 0, 1.05)) for p in spun(box(DARK, (0.28, 0.1, 0.012), (0.15, 0, 0)), 5)), *(hoop(STEEL, r, 0.006, (-0.3, 0, 1.1)) for r in (0.1, 0.2, 0.3))]
    duct = hull(STEEL, [(0.0, 0.4, 0.9, 1.28), (-0.5, 0.4, 0.9, 1.28)], 0.02)
    bend = [placed(duct, (0.42, 0.1, 0)), box(STEEL, (0.46, 0.05, 0.44), (0.42, -0.4, 0.87))]
    feet = [box(IRON, (0.1, 0.9, 0.12), (s * 0.6, 0, 0)) for s in (-1, 1)]
    return [body, *louvres, *top, *bend, *feet, *(box(f.main.shaded(0.8), (0.02, 0.92, 0.86), (u, 0, 0.12)) for u in (0.0,))]


def air_conditioner(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.95, 0.4, 0.72), (0, 0, 0.08), 0.02)
    ring = placed(turned(f.main.shaded(0.9), [(0.3, 0.0), (0.31, 0.03), (0.27, 0.03), (0.27, 0.0)]), (-0.12, 0.2, 0.45), FACING)
    dark = placed(turned(DARK, [(0.27, 0.004), (0, 0.004)]), (-0.12, 0.2, 0.45), FACING)
    grid = [placed(hoop(STEEL, r, 0.005), (-0.12, 0.225, 0.45), FACING) for r in (0.07, 0.14, 0.21)]
    bars = [placed(pipe(STEEL, [(0, 0, 0), (0.28, 0, 0)], 0.004), (-0.12, 0.225, 0.45), FACING @ np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])) for a in np.arange(10) * 0.628]
    blades = [placed(box(IRON, (0.22, 0.08, 0.01), (0.13, 0, 0)), (-0.12, 0.208, 0.45), FACING @ np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])) for a in np.arange(4) * 1.57]
    feet = [box(IRON, (0.06, 0.45, 0.08), (s * 0.35, 0, 0)) for s in (-1, 1)]
    return [body, ring, dark, *blades, *grid, *bars, *feet, box(patterned("light grey", "grille", "charcoal", 0.4), (0.2, 0.01, 0.4), (0.34, 0.203, 0.25))]


def work_light(size: Vector, f: Finish) -> list[Part]:
    legs = spun(pipe(f.main, [(0, 0, 0.75), (0.3, 0, 0.0)], 0.014), 3, 0.5)
    pole = pipe(f.main, [(0, 0, 0.4), (0, 0, 1.6)], 0.018)
    bar = pipe(f.main, [(-0.26, 0, 1.6), (0.26, 0, 1.6)], 0.016)
    lamps = [p for s in (-1, 1) for p in (box(f.main, (0.26, 0.1, 0.2), (s * 0.17, 0.04, 1.6), 0.02), box(paint("white", emission=2.2), (0.22, 0.012, 0.16), (s * 0.17, 0.093, 1.62)))]
    cage = [box(DARK, (0.006, 0.01, 0.18), (s * 0.17 + u, 0.105, 1.61)) for s in (-1, 1) for u in (-0.06, 0, 0.06)]
    return [*legs, pole, bar, *lamps, *cage]


def shipping_container(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    u = np.linspace(-y / 2 + 0.1, y / 2 - 0.1, int(y / 0.14) * 2 + 1)
    wave = np.where(np.arange(len(u)) % 4 < 2, 0.0, 0.035)
    steel = replace(f.main, texture="rust" if f.main.texture == "rust" else "enamel")
    sides = [placed(skin(steel, [np.column_stack([s * (x / 2 - 0.05 + wave - 0.035), u[::-s], np.full(len(u), h)]) for h in (z - 0.12, 0.15)])[k]) for s in (-1, 1) for k in (0, 1)]
    frame = frame_of(steel.shaded(0.85), (x, y, z), 0.12)
    doors = [box(steel, (x / 2 - 0.14, 0.05, z - 0.3), (s * (x / 4 - 0.05), y / 2 - 0.06, 0.15)) for s in (-1, 1)]
    rods = [pipe(STEEL, [(v, y / 2 - 0.02, 0.12), (v, y / 2 - 0.02, z - 0.12)], 0.018) for v in (-0.85, -0.3, 0.3, 0.85)]
    grips = [box(STEEL, (0.2, 0.03, 0.05), (v, y / 2 - 0.01, 1.1)) for v in (-0.75, -0.2, 0.2, 0.75)]
    rest = [box(steel, (x - 0.2, 0.05, z - 0.2), (0, -y / 2 + 0.05, 0.1)), box(steel.shaded(1.05), (x - 0.2, y - 0.2, 0.03), (0, 0, z - 0.05)), box(IRON, (x - 0.2, y - 0.2, 0.05), (0, 0, 0.06))]
    name = [sign("FMLU 204817", 0.9, 0.16, (0.55, y / 2 - 0.03, z - 0.5), "white", "black")]
    return [*sides, *frame, *doors, *rods, *grips, *rest, *name]
