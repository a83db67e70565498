"""What hangs on walls, inside and out. The back is at -y; sizes are nominal, `fitted` makes them exact."""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    LYING,
    cloth,
    crown,
    hoop,
    hull,
    mirrored,
    patterned,
    pipe,
    placed,
    plate,
    rounded_ring,
    sign,
    skin,
    tapered,
    two_sided,
)  # fmt: skip
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, picture, turned
from flymirage_core.worldgen.shapes_industrial import flange, handwheel
from flymirage_core.worldgen.shapes_plants import flowers, greenery
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")


def _board(f: Finish, size: Vector, face: Part) -> list[Part]:
    x, y, z = size
    rim = [box(f.second, (x, y, 0.05), (0, 0, h), 0.006) for h in (0, z - 0.05)] + [*mirrored(box(f.second, (0.05, y, z), (x / 2 - 0.025, 0, 0), 0.006))]
    return [*rim, face, box(f.second, (x * 0.8, 0.09, 0.02), (0, y / 2 + 0.02, 0), 0.004)]


def blackboard(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    lines = ("E = m c2|F = m a|v = s / t", "HOMEWORK|page 27|ex. 3 to 9", "MENU|soup 4.50|pie 6.00", "a2 + b2|= c2")[f.seed % 4]
    face = sign(lines, x - 0.1, z - 0.1, (0, 0.012, 0.05), "forest green" if f.chosen(2) else "charcoal", "chalk")
    return [*_board(f, (x, 0.04, z), face), box(WHITE, (0.06, 0.012, 0.012), (0.2, 0.05, 0.02)), box(paint("chalk", "fabric"), (0.12, 0.05, 0.03), (-0.3, 0.05, 0.02), 0.01)]


def whiteboard(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    words = ("SPRINT 12|plan|build|ship", "IDEAS|1 map|2 test|3 fly", "Q3 GOALS|cost|speed", "TO DO|call|write|check")[f.seed % 4]
    face = sign(words, x - 0.08, z - 0.08, (0, 0.012, 0.04), "white", ("blue", "red", "forest green")[f.seed % 3])
    pens = [box(paint(c), (0.12, 0.018, 0.018), (0.2 + 0.16 * i, 0.05, 0.02), 0.006) for i, c in enumerate(("red", "blue", "green"))]
    return [*_board(replace(f, second=STEEL), (x, 0.04, z), face), *pens]


def projection_screen(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    case = box(f.second, (x, 0.1, 0.1), (0, 0, z - 0.1), 0.03)
    face = picture(paint("white", "screen" if f.seed % 2 else "landscape", 0.45, 0.6, f.seed % 97), x - 0.2, z - 0.28, (0, 0.008, 0.12))
    return [case, box(WHITE, (x - 0.06, 0.01, z - 0.1), (0, 0, 0.03)), face, pipe(f.second, [(-x / 2 + 0.02, 0, 0.02), (x / 2 - 0.02, 0, 0.02)], 0.02)]


def curtain(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    rod = [pipe(BRASS, [(-x / 2, 0, z - 0.04), (x / 2, 0, z - 0.04)], 0.018), *mirrored(ellipsoid(BRASS, (0.035,) * 3, (x / 2, 0, z - 0.04)))]
    halves = [p for s in (-1, 1) for p in two_sided(cloth(f.main, x * 0.42, z - 0.08, (s * x * 0.27, 0, 0), 0.11, 0.12))]
    ties = [box(f.main.shaded(0.7), (x * 0.44, 0.14, 0.06), (s * x * 0.27, 0, z * 0.42), 0.025) for s in (-1, 1)]
    return [*rod, *halves, *(ties if f.chosen(2) else [])]


def tapestry(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    weave = replace(f.main, texture="rug", detail=0.6, stretch=1.0)
    return [pipe(BRASS, [(-x / 2, 0, z - 0.02), (x / 2, 0, z - 0.02)], 0.015), picture(weave, x - 0.06, z - 0.12, (0, 0.012, 0.08)), box(f.main.shaded(0.6), (x - 0.06, 0.012, z - 0.12), (0, 0.003, 0.08)), *(box(f.main.shaded(1.2), (0.012, 0.01, 0.08), (u, 0.006, 0)) for u in np.linspace(-x / 2 + 0.05, x / 2 - 0.05, 22))]


def towel_rail(size: Vector, f: Finish) -> list[Part]:
    bars = [*mirrored(pipe(f.main, [(0.28, 0, 0), (0.28, 0, 0.9)], 0.016)), *(pipe(f.main, [(-0.28, 0, z), (0.28, 0, z)], 0.01) for z in (0.06, 0.14, 0.22, 0.36, 0.44, 0.52, 0.66, 0.74, 0.82))]
    towel = paint(("teal", "coral", "ivory", "sage")[f.chosen(4)], "carpet")
    return [*bars, box(towel, (0.4, 0.05, 0.5), (0.02, 0.01, 0.3), 0.022), box(towel.shaded(0.75), (0.4, 0.052, 0.05), (0.02, 0.01, 0.36), 0.02), *(pipe(f.main, [(s * 0.28, 0, z), (s * 0.28, -0.06, z)], 0.012) for s in (-1, 1) for z in (0.1, 0.8))]


def cooker_hood(size: Vector, f: Finish) -> list[Part]:
    return [tapered(f.main, [(0.7, 0.5, 0), (0.7, 0.5, 0.06), (0.26, 0.26, 0.3), (0.24, 0.24, 0.7)], radius=0.01, lean=(0, 0, -0.1, -0.11)), box(patterned("silver", "grille", "black", 0.3), (0.6, 0.4, 0.006), (0, 0, -0.004)), *(box(DARK, (0.03, 0.008, 0.02), (u, 0.251, 0.02)) for u in (-0.06, 0, 0.06))]


def dartboard(size: Vector, f: Finish) -> list[Part]:
    def wedge(a: float, r0: float, r1: float, colour: str) -> Part:
        t = np.linspace(a - 0.157, a + 0.157, 4)
        inner, outer = ([(r * np.cos(b), 0.0, r * np.sin(b)) for b in t] for r in (r0, r1))
        return skin(paint(colour), [outer, inner])[0]

    parts = [placed(turned(DARK, [(0, 0), (0.23, 0), (0.23, 0.035), (0, 0.036)]), (0, -0.02, 0.23), FACING)]
    for k in range(20):
        a, even = k * np.pi / 10, k % 2 == 0
        for r0, r1, one, two in ((0.016, 0.1, "black", "cream"), (0.1, 0.11, "red", "green"), (0.11, 0.165, "black", "cream"), (0.165, 0.176, "red", "green")):
            parts.append(placed(wedge(a, r0, r1, one if even else two), (0, 0.019, 0.23)))
    darts = [p for u, z in ((0.05, 0.28), (-0.04, 0.2)) for p in (pipe(BRASS, [(u, 0.02, z), (u, 0.08, z)], 0.005), pipe(paint("red"), [(u, 0.08, z), (u, 0.12, z)], 0.008))]
    return [*parts, placed(turned(paint("red"), [(0.016, 0.021), (0, 0.022)]), (0, 0.0, 0.23), FACING), placed(hoop(STEEL, 0.178, 0.004), (0, 0.02, 0.23), FACING), *darts]


def basketball_hoop(size: Vector, f: Finish) -> list[Part]:
    board = [box(WHITE, (1.2, 0.03, 0.9), (0, -0.42, 0.2), 0.01), *(box(f.main, w, (u, -0.4, z)) for w, u, z in (((1.2, 0.012, 0.05), 0, 0.2), ((1.2, 0.012, 0.05), 0, 1.05), ((0.05, 0.012, 0.9), -0.575, 0.2), ((0.05, 0.012, 0.9), 0.575, 0.2), ((0.5, 0.012, 0.03), 0, 0.38), ((0.5, 0.012, 0.03), 0, 0.72), ((0.03, 0.012, 0.35), -0.24, 0.38), ((0.03, 0.012, 0.35), 0.24, 0.38)))]
    ring = [hoop(paint("orange", "enamel"), 0.225, 0.012, (0, -0.1, 0.4)), box(paint("orange", "enamel"), (0.14, 0.1, 0.1), (0, -0.37, 0.33), 0.01)]
    strands = [placed(pipe(WHITE, [(0.22, 0, 0.4), (0.15 * np.cos(t), 0.15 * np.sin(t), 0.18), (0.13 * np.cos(2 * t), 0.13 * np.sin(2 * t), 0.0)], 0.004), (0, -0.1, 0), _yaw(a)) for a in np.arange(10) * 0.628 for t in (-0.45, 0.45)]
    return [*board, *ring, *strands, *(pipe(STEEL, [(s * 0.3, -0.44, z), (s * 0.15, -0.5, z)], 0.02) for s in (-1, 1) for z in (0.4, 0.8))]


def _yaw(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def shop_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    words = ("BAKERY", "BOOKS", "FLORIST", "CAFE LUNA", "OPTICIAN", "BICYCLES", "ANTIQUES", "PHARMACY")[f.seed % 8]
    dark = sum(f.main.colour) < 0.9
    face = replace(f.main, texture="text", words=words, ink=paint("cream" if dark else "black").colour, detail=0.35, wear=0.0)
    rim = [box(f.second, (x, y, 0.04), (0, 0, h), 0.008) for h in (0, z - 0.04)] + [*mirrored(box(f.second, (0.04, y, z), (x / 2 - 0.02, 0, 0), 0.008))]
    lamps = [p for u in (-x * 0.3, 0, x * 0.3) for p in (pipe(DARK, [(u, 0, z - 0.02), (u, y * 0.7, z + 0.06), (u, y * 1.2, z + 0.02)], 0.01, 0.05), ellipsoid(paint("cream", emission=1.2), (0.05, 0.04, 0.03), (u, y * 1.2, z)))]
    return [box(f.main, (x - 0.04, y * 0.7, z - 0.04), (0, -y * 0.1, 0.02)), *rim, picture(face, x - 0.08, z - 0.08, (0, y * 0.27, 0.04)), *lamps]


def neon_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    word = ("OPEN", "BAR", "JAZZ", "PIZZA", "DINER", "HOTEL")[f.seed % 6]
    glow = paint(("coral", "turquoise", "yellow", "pink")[f.chosen(4)]).colour
    face = replace(paint("black", "text", 0.0, 0.3), ink=glow, words=word, emission=1.6)
    outline = np.column_stack([rounded_ring(x - 0.06, z - 0.06, 0.12, 5)[:, 0], np.full(20, y / 2), rounded_ring(x - 0.06, z - 0.06, 0.12, 5)[:, 1] + z / 2])
    tube = pipe(paint(("turquoise", "coral", "blue", "yellow")[f.chosen(4)], emission=2.2), np.vstack([outline, outline[:1]]), 0.014)
    return [box(DARK, (x, y * 0.5, z), (0, -y * 0.25, 0), 0.02), picture(face, x * 0.8, z * 0.7, (0, y * 0.1, z * 0.15)), tube]


def awning(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    u = np.linspace(-x / 2, x / 2, 25)
    stripes = replace(f.main, texture="stripes", ink=paint("chalk").colour, detail=0.6)
    scallop = 0.05 * np.abs(np.sin(np.pi * (u + x / 2) / 0.2))
    rows = [np.column_stack([u, np.full(25, v), np.full(25, h)]) for v, h in ((-y / 2 + 0.02, z - 0.03), (y / 2 - 0.02, 0.28))]
    rows.append(np.column_stack([u, np.full(25, y / 2 - 0.02), 0.05 - scallop + 0.05]))
    arms = [pipe(STEEL, [(s * (x / 2 - 0.1), -y / 2 + 0.02, 0.3), (s * (x / 2 - 0.1), y / 2 - 0.03, 0.28)], 0.016) for s in (-1, 1)]
    return [*skin(stripes, [r[:, :] for r in rows]), pipe(STEEL, [(-x / 2, -y / 2 + 0.04, z - 0.03), (x / 2, -y / 2 + 0.04, z - 0.03)], 0.03), pipe(STEEL, [(-x / 2, y / 2 - 0.03, 0.28), (x / 2, y / 2 - 0.03, 0.28)], 0.016), *arms]


def warning_sign(size: Vector, f: Finish) -> list[Part]:
    """Enamelled plates: triangles and squares with legible words."""
    words = ("DANGER|HIGH|VOLTAGE", "RADIATION|RISK", "TOXIC|CHEMICALS", "NO ENTRY", "HARD HAT|AREA", "HOT|SURFACE", "LASER|IN USE")[f.seed % 7]
    if f.seed % 3 == 0:
        triangle = [(-0.22, 0.02), (0.22, 0.02), (0, 0.42)]
        inner = [(0.82 * u, 0.03 + 0.06 + 0.78 * (v - 0.02)) for u, v in triangle]
        mark = [box(DARK, (0.035, 0.006, 0.14), (0, 0.02, 0.17), 0.002), ellipsoid(DARK, (0.022, 0.003, 0.022), (0, 0.022, 0.13))]
        return [plate(DARK, triangle, 0.02), plate(paint("yellow"), inner, 0.024, (0, 0.004, 0)), *mark]
    ground, ink = (("yellow", "black"), ("red", "white"), ("orange", "black"))[f.seed % 2 + (1 if f.seed % 5 == 0 else 0)]
    return [box(paint(ink), (0.45, 0.02, 0.45), (0, 0, 0), 0.006), sign(words, 0.42, 0.42, (0, 0.0115, 0.015), ground, ink), box(patterned("yellow", "hazard"), (0.42, 0.004, 0.05), (0, 0.012, 0.015))]


def emergency_light(size: Vector, f: Finish) -> list[Part]:
    body = box(WHITE, (0.36, 0.08, 0.1), (0, -0.02, 0), 0.015)
    heads = [p for s in (-1, 1) for p in (placed(turned(WHITE, [(0, -0.04), (0.04, -0.035), (0.055, 0.02), (0.05, 0.02)]), (s * 0.1, 0.02, 0.15), FACING), placed(turned(paint("cream", emission=1.8), [(0.05, 0.016), (0, 0.02)]), (s * 0.1, 0.02, 0.15), FACING))]
    return [body, *heads, box(paint("green", emission=1.0), (0.02, 0.004, 0.01), (0.13, 0.021, 0.05)), *mirrored(cylinder(WHITE, 0.012, 0.05, (0.1, 0, 0.08)))]


def security_camera(size: Vector, f: Finish) -> list[Part]:
    plate_ = placed(turned(f.main, [(0, 0), (0.06, 0), (0.055, 0.02), (0, 0.02)]), (0, -0.17, 0.14), FACING)
    arm = pipe(f.main, [(0, -0.15, 0.14), (0, -0.08, 0.14), (0, -0.05, 0.09)], 0.014, 0.03)
    body = hull(f.main, [(-0.12, 0.07, 0.02, 0.09), (-0.1, 0.09, 0.01, 0.1), (0.1, 0.09, 0.0, 0.1), (0.14, 0.1, 0.02, 0.11)], 0.03)
    lens = placed(turned(DARK, [(0.034, 0), (0.03, 0.012), (0.018, 0.01), (0, 0.0)]), (0, 0.12, 0.05), FACING)
    return [plate_, arm, body, lens, ellipsoid(paint("red", emission=2), (0.005,) * 3, (0.025, 0.142, 0.085)), box(f.main, (0.11, 0.25, 0.008), (0, 0.03, 0.112), 0.003)]


def loudspeaker(size: Vector, f: Finish) -> list[Part]:
    """A horn on a bracket."""
    horn = placed(turned(f.main, [(0.03, -0.14), (0.035, -0.05), *((0.04 + 0.13 * t**1.8, -0.05 + 0.19 * t) for t in np.linspace(0.1, 1, 6)), (0.165, 0.14), *((0.035 + 0.12 * t**1.8, -0.05 + 0.18 * t) for t in np.linspace(1, 0.1, 5)), (0, -0.05)], scale=(1.0, 1.35)), (0, 0.02, 0.25), FACING)
    driver = placed(turned(f.second, [(0, -0.16), (0.05, -0.16), (0.06, -0.12), (0.06, -0.06), (0, -0.06)]), (0, 0.02, 0.25), FACING)
    bracket = [pipe(STEEL, [(-0.18, 0.02, 0.25), (-0.18, -0.13, 0.25), (0.18, -0.13, 0.25), (0.18, 0.02, 0.25)], 0.012, 0.05), box(STEEL, (0.12, 0.02, 0.2), (0, -0.13, 0.15), 0.006)]
    return [horn, driver, *bracket, box(f.main, (0.02, 0.04, 0.5), (0, -0.12, 0.0))]


def ventilation_fan(size: Vector, f: Finish) -> list[Part]:
    box_ = [box(f.main, (0.9, 0.12, 0.07), (0, 0, z), 0.01) for z in (0, 0.83)] + [*mirrored(box(f.main, (0.07, 0.12, 0.9), (0.415, 0, 0), 0.01))]
    ring = placed(turned(f.main, [(0.4, -0.14), (0.4, 0.12), (0.37, 0.14), (0.36, 0.12), (0.36, -0.14)]), (0, 0, 0.45), FACING)
    back = placed(turned(DARK, [(0.37, -0.12), (0, -0.12)]), (0, 0, 0.45), FACING)
    blades = [placed(plate(STEEL, [(0.03, -0.03), (0.24, -0.12), (0.34, -0.04), (0.32, 0.06), (0.05, 0.04)], 0.01), (0, -0.02, 0.45), _about_y(a)) for a in np.arange(5) * 1.2566]
    guard = [placed(hoop(STEEL, r, 0.005), (0, 0.12, 0.45), FACING) for r in (0.12, 0.22, 0.32)] + [placed(pipe(STEEL, [(0, 0, 0), (0.37, 0, 0)], 0.005), (0, 0.12, 0.45), _about_y(a)) for a in np.arange(8) * 0.785]
    return [*box_, ring, back, *blades, *guard, placed(turned(f.second, [(0.08, 0), (0.07, 0.06), (0, 0.07)]), (0, -0.03, 0.45), FACING), box(f.main, (0.88, 0.02, 0.88), (0, -0.13, 0.01))]


def _about_y(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1.0, 0], [-s, 0, c]])


def ventilation_grille(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    rim = [box(f.main, (x, 0.04, 0.05), (0, 0, h), 0.008) for h in (0, z - 0.05)] + [*mirrored(box(f.main, (0.05, 0.04, z), (x / 2 - 0.025, 0, 0), 0.008))]
    slats = [box(f.main, (x - 0.1, 0.05, 0.008), (0, 0, h), 0.002, 0.6) for h in np.linspace(0.07, z - 0.08, max(5, round(z / 0.05)))]
    return [*rim, *slats, box(DARK, (x - 0.08, 0.006, z - 0.08), (0, -0.02, 0.04))]


def hose_reel(size: Vector, f: Finish) -> list[Part]:
    discs = [placed(turned(f.main, [(0.1, 0), (0.33, 0), (0.34, 0.012), (0.33, 0.024), (0.1, 0.024)]), (0, y, 0.35), FACING) for y in (-0.12, 0.1)]
    coils = [placed(hoop(DARK, 0.27 - 0.05 * j, 0.026), (0, -0.07 + 0.055 * i, 0.35), FACING) for i in range(3) for j in range(2)]
    hub = [placed(cylinder(STEEL, 0.06, 0.28), (0, -0.14, 0.35), FACING), *(placed(box(f.main, (0.5, 0.05, 0.02)), (0, 0.125, 0.35), _about_y(a) @ FACING) for a in (0.5, 2.07))]
    nozzle = [pipe(BRASS, [(0.3, 0.08, 0.15), (0.34, 0.1, 0.02)], 0.018), box(f.main, (0.3, 0.03, 0.5), (0, -0.145, 0.1), 0.01)]
    return [*discs, *coils, *hub, *nozzle]


def pipe_run(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    top, low = pipe(f.main, [(-x / 2, 0, z - 0.1), (x / 2, 0, z - 0.1)], 0.07), pipe(f.second, [(-x / 2, 0, 0.12), (x * 0.2, 0, 0.12), (x * 0.2, 0, z - 0.1)], 0.045, 0.1)
    thin = [pipe(paint(c, "enamel"), [(-x / 2, 0.02, h), (x / 2, 0.02, h)], 0.022) for c, h in (("yellow", 0.24), ("blue", 0.3))]
    joints = [p for u in (-x * 0.32, x * 0.05, x * 0.4) for p in flange(f.main, 0.07, (u, 0, z - 0.1), LYING)]
    clips = [box(STEEL, (0.03, 0.14, z - 0.06), (u, -0.04, 0.03)) for u in (-x * 0.42, -x * 0.1, x * 0.3)]
    bands = [placed(hoop(paint("yellow"), 0.071, 0.006, tall=0.05), (u, 0, z - 0.1), LYING) for u in (-x * 0.2, x * 0.22)]
    return [top, low, *thin, *joints, *clips, *bands, *handwheel(paint("red", "enamel"), 0.09, (-x * 0.15, 0.12, 0.12), FACING), pipe(STEEL, [(-x * 0.15, 0, 0.12), (-x * 0.15, 0.12, 0.12)], 0.015)]


def valve_wheel(size: Vector, f: Finish) -> list[Part]:
    body = [placed(turned(f.second, [(0, -0.17), (0.14, -0.17), (0.14, -0.13), (0.07, -0.12), (0.06, 0.0), (0.09, 0.02), (0.09, 0.05), (0, 0.05)]), (0, 0, 0.25), FACING), pipe(STEEL, [(0, 0.05, 0.25), (0, 0.18, 0.25)], 0.022)]
    line = [pipe(f.second, [(0, -0.08, 0.0), (0, -0.08, 0.5)], 0.06)]
    return [*body, *line, *handwheel(f.main, 0.22, (0, 0.14, 0.25), FACING)]


def cable_tray(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    rails = [box(f.main, (x, 0.02, 0.1), (0, s * (y / 2 - 0.01), 0)) for s in (-1, 1)]
    rungs = [box(f.main, (0.03, y - 0.03, 0.015), (u, 0, 0.01)) for u in np.arange(-x / 2 + 0.1, x / 2, 0.25)]
    cables = []
    for k in range(9):
        v, colour = (k - 4) * (y - 0.06) / 9, ("black", "black", "orange", "blue", "grey", "yellow")[int(rng.integers(6))]
        path = [(u, v + rng.normal(0, 0.008), 0.045 + rng.uniform(0, 0.02)) for u in np.linspace(-x / 2, x / 2, 8)]
        cables.append(pipe(paint(colour), path, float(rng.uniform(0.01, 0.017))))
    hangers = [pipe(STEEL, [(u, s * (y / 2 - 0.01), 0.05), (u, s * (y / 2 - 0.01), z)], 0.006) for u in (-x * 0.35, x * 0.35) for s in (-1, 1)]
    return [*rails, *rungs, *cables, *hangers]


def first_aid_cabinet(size: Vector, f: Finish) -> list[Part]:
    return [box(WHITE, (0.4, 0.14, 0.5), (0, -0.01, 0), 0.015), box(WHITE.shaded(1.05), (0.37, 0.02, 0.47), (0, 0.062, 0.015), 0.006), *(box(paint("green"), s, (0, 0.075, b), 0.002) for s, b in (((0.06, 0.006, 0.2), 0.2), ((0.2, 0.006, 0.06), 0.27))), sign("FIRST AID", 0.26, 0.06, (0, 0.0735, 0.1), "white", "green"), box(STEEL, (0.02, 0.02, 0.06), (0.16, 0.075, 0.24))]


def tool_board(size: Vector, f: Finish) -> list[Part]:
    parts = [box(f.main, (1.4, 0.03, 0.9), (0, -0.03, 0), 0.005)]
    red, steel = paint("red"), STEEL
    for u, length in zip(np.linspace(-0.6, -0.1, 6), (0.16, 0.18, 0.2, 0.22, 0.25, 0.28), strict=True):
        parts += [pipe(steel, [(u, 0, 0.8 - length), (u, 0, 0.8)], 0.011), placed(hoop(steel, 0.02, 0.007), (u, 0, 0.81), FACING), placed(hoop(steel, 0.02, 0.007), (u, 0, 0.79 - length), FACING)]
    for u, colour in zip(np.linspace(0.1, 0.6, 5), ("red", "yellow", "blue", "green", "orange"), strict=True):
        parts += [pipe(paint(colour), [(u, 0, 0.7), (u, 0, 0.81)], 0.017), pipe(steel, [(u, 0, 0.55), (u, 0, 0.7)], 0.005)]
    parts += [pipe(paint("honey brown", "wood"), [(-0.5, 0, 0.08), (-0.5, 0, 0.36)], 0.014), box(DARK, (0.15, 0.045, 0.05), (-0.5, 0, 0.36), 0.008)]
    saw = [(0.0, 0.0), (0.42, 0.02), (0.42, 0.05), (0.0, 0.13)]
    parts += [plate(steel, [(a - 0.2, b) for a, b in saw], 0.006, (0.0, 0, 0.2)), box(paint("honey brown", "wood"), (0.12, 0.03, 0.14), (-0.25, 0, 0.2), 0.03)]
    parts += [plate(red, [(0.0, 0.0), (0.07, -0.02), (0.1, 0.14), (0.06, 0.16)], 0.02, (0.38, 0, 0.15)), plate(red, [(0.1, -0.02), (0.17, 0.0), (0.11, 0.16), (0.07, 0.14)], 0.02, (0.38, 0, 0.15)), box(steel, (0.05, 0.02, 0.08), (0.465, 0, 0.3))]
    return [*parts, placed(hoop(paint("orange"), 0.09, 0.014), (0.2, 0, 0.28), FACING), placed(hoop(paint("orange"), 0.075, 0.014), (0.2, 0.01, 0.28), FACING)]


def wall_planter(size: Vector, f: Finish) -> list[Part]:
    pot = [hull(f.main, [(-0.12, 0.6, 0.12, 0.28), (0.0, 0.62, 0.02, 0.28), (0.1, 0.56, 0.08, 0.28)], 0.06), box(f.second, (0.66, 0.012, 0.4), (0, -0.12, 0.05))]
    rng = f.generator()
    green = crown(greenery(f), [((0.3, 0.11, 0.12), (0, 0.0, 0.36)), ((0.12, 0.1, 0.2), (-0.22, 0.08, 0.2)), ((0.12, 0.1, 0.16), (0.2, 0.09, 0.22))], (0.09, 0.045), 220, rng, 0.4)
    return [*pot, *green]


def drainpipe(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    line = pipe(f.main, [(0, 0.01, z), (0, 0.01, 0.15), (0, 0.08, 0.0)], 0.05, 0.08)
    head = tapered(f.main, [(0.1, 0.1, z - 0.24), (0.16, 0.14, z - 0.14), (0.16, 0.14, z)], radius=0.01)
    return [line, head, *(p for h in np.arange(0.6, z - 0.4, 0.8) for p in (hoop(f.second, 0.052, 0.008, (0, 0.01, float(h)), 0.04), box(f.second, (0.14, 0.02, 0.04), (0, -0.06, float(h) - 0.02))))]


def balcony(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    slab = [box(paint("light grey", "concrete"), (x, y, 0.14), (0, 0, 0), 0.01), *(tapered(paint("light grey", "concrete"), [(0.1, 0.2, -0.16), (0.1, 0.7, 0.0)], (s * x * 0.35, -y / 2 + 0.35, 0), 0.01) for s in (-1, 1))]
    bars = [pipe(f.main, [(u, y / 2 - 0.04, 0.14), (u, y / 2 - 0.04, z - 0.03)], 0.01) for u in np.linspace(-x / 2 + 0.04, x / 2 - 0.04, round(x / 0.12))]
    bars += [pipe(f.main, [(s * (x / 2 - 0.04), v, 0.14), (s * (x / 2 - 0.04), v, z - 0.03)], 0.01) for s in (-1, 1) for v in np.arange(-y / 2 + 0.1, y / 2 - 0.05, 0.12)]
    rails = [pipe(f.main, [(-x / 2 + 0.04, -y / 2, h), (-x / 2 + 0.04, y / 2 - 0.04, h), (x / 2 - 0.04, y / 2 - 0.04, h), (x / 2 - 0.04, -y / 2, h)], w) for h, w in ((z - 0.03, 0.025), (0.26, 0.012))]
    scrolls = [placed(hoop(f.main, 0.05, 0.007), (u, y / 2 - 0.04, z - 0.14), FACING) for u in np.arange(-x / 2 + 0.12, x / 2 - 0.08, 0.24)]
    return [*slab, *bars, *rails, *scrolls]


def window_box(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    trough = tapered(f.main, [(x * 0.9, y * 0.7, 0), (x, y, z * 0.5), (x, y, z * 0.55), (x * 0.94, y * 0.85, z * 0.55)], radius=0.015)
    rng = f.generator()
    blobs: list[tuple[Vector, Vector]] = [((0.14, y * 0.42, z * 0.18), (u, 0.02, z * 0.64)) for u in np.arange(-x / 2 + 0.12, x / 2 - 0.05, 0.18)]
    return [trough, *crown(greenery(f), blobs, (0.07, 0.04), int(190 * x), rng, 0.6), *flowers(f, x * 0.45, y * 0.4, z * 0.64, z * 0.32, int(34 * x))]


def coat_hooks(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    board = box(f.main, (x, 0.02, 0.12), (0, -0.05, z - 0.12), 0.006)
    hooks = [p for u in np.linspace(-x / 2 + 0.1, x / 2 - 0.1, 5) for p in (pipe(BRASS, [(u, -0.04, z - 0.06), (u, 0.03, z - 0.09), (u, 0.05, z - 0.03)], 0.008, 0.03), ellipsoid(BRASS, (0.014,) * 3, (u, 0.05, z - 0.025)))]
    hat = [turned(paint(("tan", "charcoal", "burgundy")[f.chosen(3)], "fabric"), [(0.13, 0.02), (0.07, 0.03), (0.065, 0.1), (0.03, 0.115), (0, 0.11)])]
    return [board, *hooks, *(placed(p, (x * 0.2, 0.0, z - 0.2), FACING @ np.diag([0.7, 0.7, 0.5])) for p in hat), *two_sided(cloth(paint("rust", "fabric"), 0.12, z - 0.06, (-x * 0.2, 0.03, 0), 0.05, 0.03))]
