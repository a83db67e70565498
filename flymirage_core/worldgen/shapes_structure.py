"""Stairs, decks, frames and what stands in yards and playgrounds. +y is the front; `fitted` makes sizes exact."""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    cloth,
    frame_of,
    hoop,
    hull,
    mirrored,
    patterned,
    pipe,
    placed,
    sign,
    skin,
    tapered,
    two_sided,
    wheel,
)  # fmt: skip
from flymirage_core.worldgen.parts import Finish, box, cylinder, ellipsoid, paint, turned
from flymirage_core.worldgen.shapes_plants import leafy
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK = paint("silver", "brushed"), paint("black")


def ladder(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rails = [pipe(f.main, [(s * (x / 2 - 0.03), y / 2 - 0.03, 0), (s * (x / 2 - 0.03), -y / 2 + 0.03, z)], 0.026) for s in (-1, 1)]
    rungs = [pipe(f.main, [(-x / 2 + 0.03, (y / 2 - 0.03) * (1 - 2 * h / z), h), (x / 2 - 0.03, (y / 2 - 0.03) * (1 - 2 * h / z), h)], 0.015) for h in np.arange(0.28, z - 0.1, 0.28)]
    return [*rails, *rungs, *(box(DARK, (0.06, 0.08, 0.05), (s * (x / 2 - 0.03), y / 2 - 0.04, 0)) for s in (-1, 1))]


def pallet(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = [box(f.main.shaded(0.92 + 0.05 * (i % 3)), (x, y / 7 - 0.02, 0.02), (0, (i - 3) * y / 7, z - 0.02), 0.003) for i in range(7)]
    blocks = [box(f.main.shaded(0.85), (0.13, 0.1, z - 0.06), (u * (x / 2 - 0.07), v * (y / 2 - 0.06), 0.02)) for u in (-1, 0, 1) for v in (-1, 0, 1)]
    return [*top, *blocks, *(box(f.main, (x, 0.1, 0.02), (0, v * (y / 2 - 0.06), 0)) for v in (-1, 0, 1)), *(box(f.main, (0.12, y, 0.02), (u * (x / 2 - 0.07), 0, z - 0.04)) for u in (-1, 0, 1))]


def _flight(f: Finish, x: float, y: float, z: float) -> list[Part]:
    """Open steps that rise from the front (+y) to the back, with strings and handrails."""
    count = max(4, round(z / 0.18))
    tread = patterned("light grey", "grille", "charcoal", 0.4) if f.main.texture != "wood" else f.main
    steps = [box(tread, (x - 0.1, y / count + 0.03, 0.035), (0, y / 2 - (i + 0.5) * y / count, (i + 1) * z / count - 0.035)) for i in range(count)]
    ends = [(y / 2, 0.0), (-y / 2, z)]
    strings = []
    for s in (-1, 1):
        u = s * (x / 2 - 0.02)
        outline = [(u, ends[0][0], 0.0), (u, ends[0][0] - 0.25, 0.0), (u, ends[1][0], z - 0.3), (u, ends[1][0], z)]
        strings += [p for shift in (-0.015, 0.015) for p in skin(f.main, [[(a + shift, b, c) for a, b, c in outline[:2]], [(a + shift, b, c) for a, b, c in outline[3:1:-1]]])]
        rail = [(u, y / 2 - 0.05, 0.05), (u, y / 2 - 0.05, 0.95), (u, -y / 2 + 0.03, z + 0.92), (u, -y / 2 + 0.03, z - 0.02)]
        strings.append(pipe(f.main, rail, 0.02, 0.08))
        strings += [pipe(f.main, [(u, y / 2 - t * y, t * z), (u, y / 2 - t * y, t * z + 0.92)], 0.012) for t in np.linspace(0.1, 0.95, max(4, count // 2))]
        strings.append(pipe(f.main, [(u, y / 2 - 0.05, 0.5), (u, -y / 2 + 0.03, z + 0.47)], 0.01))
    return [*steps, *strings]


def staircase(size: Vector, f: Finish) -> list[Part]:
    return _flight(f, size[0], size[1], size[2] - 0.92)


def mezzanine(size: Vector, f: Finish) -> list[Part]:
    """A platform on posts with a rail, and a ladder up to it."""
    x, y, z = size
    deck = z - 1.05
    floor = [box(paint("oak brown", "planks"), (x, y, 0.06), (0, 0, deck - 0.06)), *(box(f.main, (x, 0.1, 0.2), (0, s * (y / 2 - 0.05), deck - 0.26)) for s in (-1, 1)), *(box(f.main, (0.08, y - 0.2, 0.14), (u, 0, deck - 0.2)) for u in np.linspace(-x / 2 + 0.05, x / 2 - 0.05, max(3, round(x))))]
    posts = [box(f.main, (0.12, 0.12, deck - 0.2), (s * (x / 2 - 0.1), t * (y / 2 - 0.1), 0)) for s in (-1, 1) for t in (-1, 1)]
    runs = [[(-x / 2 + 0.03, -y / 2, deck), (-x / 2 + 0.03, y / 2 - 0.03, deck), (x / 2 - 0.03, y / 2 - 0.03, deck), (x / 2 - 0.03, -y / 2, deck)]]
    rails = [pipe(f.main, [(a, b, c + h) for a, b, c in runs[0]], w) for h, w in ((1.03, 0.022), (0.7, 0.012), (0.38, 0.012))]
    uprights = [pipe(f.main, [(u, y / 2 - 0.03, deck), (u, y / 2 - 0.03, z - 0.02)], 0.016) for u in np.linspace(-x / 2 + 0.03, x / 2 - 0.03, max(4, round(x)))]
    steps = [placed(p, (x * 0.28, y / 2 - 0.3, 0)) for p in ladder((0.55, 0.5, deck + 0.3), f)]
    return [*floor, *posts, *rails, *uprights, *steps]


def stage(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(replace(f.main, texture="planks"), (x, y, 0.05), (0, 0, z - 0.05), 0.008)
    skirt = [*two_sided(cloth(paint("charcoal", "velvet"), x, z - 0.05, (0, y / 2 - 0.03, 0), 0.14, 0.04)), *mirrored(box(paint("charcoal", "velvet"), (0.02, y - 0.06, z - 0.05), (x / 2 - 0.02, 0, 0)))]
    steps = [box(f.main.shaded(0.85), (0.9, 0.25, z * h), (-x * 0.35, y / 2 + 0.12 + 0.25 * i, 0), 0.006) for i, h in enumerate((0.66, 0.33))]
    lights = [p for u in np.linspace(-x * 0.2, x * 0.45, 4) for p in (box(DARK, (0.16, 0.14, 0.1), (u, y / 2 - 0.1, z), 0.02), box(paint("cream", emission=1.2), (0.12, 0.012, 0.06), (u, y / 2 - 0.175, z + 0.02)))]
    return [top, *skirt, *steps, *lights, box(STEEL, (x, 0.02, 0.04), (0, y / 2, z - 0.05))]


def steel_drum(size: Vector, f: Finish) -> list[Part]:
    ribs = [(0.0, 0.0), (0.285, 0.0), (0.295, 0.015), (0.285, 0.03)]
    for h in (0.3, 0.6):
        ribs += [(0.285, h - 0.02), (0.3, h), (0.285, h + 0.02)]
    body = turned(f.main, [*ribs, (0.285, 0.87), (0.298, 0.885), (0.285, 0.9), (0.275, 0.88), (0, 0.88)])
    bungs = [cylinder(STEEL, r, 0.02, (u, 0.06, 0.875)) for u, r in ((0.17, 0.035), (-0.17, 0.022))]
    label = (("TOXIC", "yellow", "black"), ("FLAMMABLE", "red", "white"), ("OIL", "chalk", "black"), ("CORROSIVE", "chalk", "black"))[f.chosen(4)]
    return [body, *bungs, sign(label[0], 0.26, 0.16, (0, 0.291, 0.37), label[1], label[2])]


def welding_curtain(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    frame = [*mirrored(pipe(DARK, [(x / 2 - 0.03, 0, 0.06), (x / 2 - 0.03, 0, z)], 0.018)), pipe(DARK, [(-x / 2 + 0.03, 0, z - 0.02), (x / 2 - 0.03, 0, z - 0.02)], 0.018), *mirrored(pipe(DARK, [(x / 2 - 0.03, -y / 2, 0.04), (x / 2 - 0.03, y / 2, 0.04)], 0.02))]
    sheet = replace(paint(("orange", "olive")[f.chosen(2)], "velvet"), opacity=0.85)
    strips = [p for u in np.linspace(-x / 2 + 0.2, x / 2 - 0.2, 5) for p in two_sided(cloth(sheet, x / 5 + 0.04, z - 0.2, (u, 0.02 * (round(u * 5) % 2), 0.12), 0.3, 0.02), 0.9)]
    return [*frame, *strips, sign("WELDING", 0.5, 0.16, (0, 0.05, z * 0.6), "yellow")]


def loom(size: Vector, f: Finish) -> list[Part]:
    frame = frame_of(f.main, (1.7, 1.3, 1.2), 0.09)
    top = [box(f.main, (0.09, 0.09, 0.4), (s * 0.8, -0.1, 1.2)) for s in (-1, 1)] + [box(f.main, (1.7, 0.1, 0.1), (0, -0.1, 1.5), 0.01)]
    beams = [pipe(f.main.shaded(0.85), [(-0.8, y, z), (0.8, y, z)], 0.07) for y, z in ((0.6, 0.8), (-0.6, 0.9))]
    warp = [pipe(paint("ivory"), [(u, 0.62, 0.87), (u, 0.0, 0.92), (u, -0.6, 0.97)], 0.004) for u in np.linspace(-0.6, 0.6, 34)]
    cloth_ = [box(replace(paint(("burgundy", "teal", "mustard")[f.chosen(3)], "stripes"), ink=paint("cream").colour, detail=0.5), (1.24, 0.42, 0.012), (0, 0.38, 0.88)), pipe(paint("burgundy", "fabric"), [(-0.62, 0.6, 0.8), (0.62, 0.6, 0.8)], 0.085)]
    heddles = [box(f.main, (1.4, 0.03, 0.04), (0, y, z)) for y in (-0.05, -0.14) for z in (0.72, 1.12)] + [pipe(STEEL, [(u, y, 0.74), (u, y, 1.14)], 0.003) for y in (-0.05, -0.14) for u in np.linspace(-0.6, 0.6, 24)]
    bench = [box(f.main, (1.2, 0.28, 0.05), (0, 0.9, 0.48), 0.01), *mirrored(box(f.main, (0.06, 0.26, 0.48), (0.5, 0.9, 0)))]
    return [*frame, *top, *beams, *warp, *cloth_, *heddles, *bench]


def street_sign(size: Vector, f: Finish) -> list[Part]:
    pole = turned(f.main, [(0, 0), (0.05, 0), (0.05, 0.04), (0.028, 0.06), (0.028, 2.55), (0.04, 2.57), (0, 2.62)])
    names = ("ELM STREET", "MILL LANE", "HARBOUR RD", "STATION RD", "QUEEN ST", "ORCHARD AVE")
    one = [box(paint("forest green"), (0.6, 0.02, 0.15), (0, 0.035, 2.3), 0.005), sign(names[f.seed % 6], 0.58, 0.14, (0, 0.048, 2.305), "forest green", "white"), placed(sign(names[f.seed % 6], 0.58, 0.14, (0, -0.02, 2.305), "forest green", "white"), rotation=np.diag([-1.0, -1.0, 1.0]))]
    return [pole, *one]


def motorcycle(size: Vector, f: Finish) -> list[Part]:
    rear, front = (0, -0.68, 0.32), (0, 0.72, 0.32)
    wheels = [p for c in (rear, front) for p in wheel(DARK, STEEL, 0.32, 0.13, c)]
    tank = hull(f.main, [(-0.12, 0.16, 0.72, 0.86), (0.05, 0.3, 0.68, 0.95), (0.28, 0.28, 0.7, 0.96), (0.4, 0.14, 0.76, 0.9)], 0.08)
    seat = tapered(paint("black", "leather"), [(0.24, 0.72, 0), (0.28, 0.74, 0.06), (0.2, 0.66, 0.11)], (0, -0.42, 0.7), 0.1)
    engine = [box(STEEL, (0.34, 0.3, 0.26), (0, 0.08, 0.3), 0.05), *(box(paint("charcoal"), (0.3, 0.26, 0.012), (0, 0.1, 0.58 + 0.03 * i)) for i in range(4)), pipe(STEEL, [(-0.24, 0.08, 0.4), (0.24, 0.08, 0.4)], 0.12)]
    frame = [pipe(DARK, [(0, 0.42, 0.9), (0, 0.36, 0.5), (0, 0.1, 0.26), (0, -0.3, 0.3), (0, -0.68, 0.34)], 0.028, 0.1), pipe(DARK, [(0, 0.42, 0.86), (0, -0.3, 0.7), (0, -0.75, 0.72)], 0.025)]
    fork = [pipe(STEEL, [(s * 0.09, 0.4, 0.95), (s * 0.09, 0.72, 0.32)], 0.022) for s in (-1, 1)] + [pipe(STEEL, [(s * 0.1, -0.66, 0.34), (s * 0.12, -0.5, 0.68)], 0.026) for s in (-1, 1)]
    bars = [pipe(DARK, [(-0.38, 0.2, 1.04), (-0.2, 0.36, 1.06), (0.2, 0.36, 1.06), (0.38, 0.2, 1.04)], 0.016, 0.1), ellipsoid(f.main, (0.1, 0.08, 0.1), (0, 0.5, 0.92)), ellipsoid(paint("cream", emission=0.8), (0.08, 0.03, 0.08), (0, 0.565, 0.92))]
    exhaust = [pipe(STEEL, [(0.12, 0.22, 0.45), (0.2, 0.1, 0.25), (0.2, -0.3, 0.25), (0.21, -0.95, 0.38)], 0.045, 0.1)]
    guards = [pipe(f.main, [(0, c[1] + 0.36 * np.cos(a), 0.32 + 0.36 * np.sin(a)) for a in np.linspace(0.5, 2.5, 9)], 0.07) for c in (rear, front)]
    return [*wheels, tank, seat, *engine, *frame, *fork, *bars, *exhaust, *guards, ellipsoid(paint("red", emission=0.6), (0.06, 0.03, 0.04), (0, -0.86, 0.72)), *mirrored(ellipsoid(DARK, (0.05, 0.012, 0.035), (0.3, 0.3, 1.18)))]


def scaffolding(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    at = np.linspace(-x / 2 + 0.04, x / 2 - 0.04, max(2, round(x / 1.6) + 1))
    posts = [pipe(f.main, [(u, s * (y / 2 - 0.05), 0), (u, s * (y / 2 - 0.05), z)], 0.024) for u in at for s in (-1, 1)]
    levels = np.arange(1.9, z - 0.3, 1.9) if z > 2.4 else np.array([z - 1.0])
    decks, rails = [], []
    for h in levels:
        decks += [box(paint("honey brown", "wood").shaded(0.85 + 0.06 * i), (x - 0.02, y / 4 - 0.02, 0.04), (0, (i - 1.5) * (y - 0.1) / 4, h), 0.004) for i in range(4)]
        rails += [pipe(f.main, [(-x / 2, s * (y / 2 - 0.05), h + up), (x / 2, s * (y / 2 - 0.05), h + up)], 0.022) for s in (-1, 1) for up in (-0.03, 0.5, 1.0) if h + up < z]
        rails += [pipe(f.main, [(u, -y / 2, h - 0.03), (u, y / 2, h - 0.03)], 0.022) for u in at]
    braces = [pipe(f.main, [(a, y / 2 - 0.05, 0.1), (b, y / 2 - 0.05, float(levels[0]))], 0.02) for a, b in ((at[0], at[1]), (at[-1], at[-2]))]
    feet = [box(DARK, (0.14, 0.14, 0.02), (u, s * (y / 2 - 0.07), 0)) for u in at for s in (-1, 1)]
    net = [placed(replace(p, material=replace(p.material, opacity=0.35)), (0, -y / 2 + 0.02, 0.3)) for p in two_sided(cloth(paint("forest green", "fabric"), x, z - 0.4, (0, 0, 0), 0.5, 0.03))] if f.chosen(2) else []
    return [*posts, *decks, *rails, *braces, *feet, *net]


def pergola(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    posts = [box(f.main, (0.12, 0.12, z - 0.2), (s * (x / 2 - 0.3), t * (y / 2 - 0.3), 0), 0.008) for s in (-1, 1) for t in (-1, 1)]
    beams = [box(f.main, (x, 0.07, 0.18), (0, t * (y / 2 - 0.3), z - 0.3), 0.01) for t in (-1, 1)]
    rafters = [box(f.main.shaded(0.95), (0.05, y, 0.13), (u, 0, z - 0.14), 0.006) for u in np.linspace(-x / 2 + 0.1, x / 2 - 0.1, max(6, round(x / 0.36)))]
    braces = [pipe(f.main, [(s * (x / 2 - 0.3), t * (y / 2 - 0.3), z - 0.75), (s * (x / 2 - 0.75), t * (y / 2 - 0.3), z - 0.3)], 0.035) for s in (-1, 1) for t in (-1, 1)]
    vine = leafy(f, [((0.7, 0.5, 0.12), (-x * 0.2, 0.2, z - 0.05)), ((0.2, 0.2, 0.6), (-x / 2 + 0.3, y / 2 - 0.3, z * 0.5)), ((0.5, 0.4, 0.1), (x * 0.22, -0.4, z - 0.05))], (0.11, 0.07), 420)
    return [*posts, *beams, *rafters, *braces, *vine]


def swing(size: Vector, f: Finish) -> list[Part]:
    legs = [pipe(f.main, [(s * 1.15, t * 0.65, 0), (s * 1.0, 0, 2.15)], 0.035) for s in (-1, 1) for t in (-1, 1)]
    seats = []
    for u, y in ((-0.45, 0.0), (0.45, 0.12)):
        seats += [box(paint(("red", "blue", "green")[f.chosen(3)]), (0.46, 0.18, 0.03), (u, y, 0.5), 0.012), *(pipe(STEEL, [(u + s * 0.2, y, 0.52), (u + s * 0.2, 0, 2.13)], 0.007) for s in (-1, 1))]
    return [*legs, pipe(f.main, [(-1.05, 0, 2.15), (1.05, 0, 2.15)], 0.04), *seats, *(pipe(f.main, [(s * 1.1, -0.35, 0.99), (s * 1.1, 0.35, 0.99)], 0.02) for s in (-1, 1))]


def slide(size: Vector, f: Finish) -> list[Part]:
    path = np.array([(1.3, 0.12), (0.9, 0.2), (0.2, 0.75), (-0.5, 1.35), (-0.8, 1.42)])
    chute = [np.array([(u, y, z + 0.16 * abs(u / 0.26) ** 4) for u in np.linspace(-0.26, 0.26, 9)]) for y, z in path]
    bed = skin(f.main, chute)
    rims = [pipe(f.main.shaded(0.85), [c[i] for c in chute], 0.03) for i in (0, -1)]
    frame = [pipe(STEEL, [(s * 0.28, -1.35, 0), (s * 0.28, -0.85, 1.42), (s * 0.28, -0.85, 1.95), (s * 0.28, -0.45, 1.6)], 0.022, 0.08) for s in (-1, 1)]
    rungs = [box(paint("slate grey"), (0.56, 0.12, 0.025), (0, -1.35 + 0.5 * t, 1.42 * t)) for t in (0.15, 0.32, 0.49, 0.66, 0.83)]
    legs = [pipe(STEEL, [(s * 0.26, 0.2, 0.72), (s * 0.3, 0.2, 0)], 0.022) for s in (-1, 1)]
    return [*bed, *rims, *frame, *rungs, *legs, box(paint("slate grey"), (0.56, 0.4, 0.03), (0, -0.75, 1.38))]


def climbing_frame(size: Vector, f: Finish) -> list[Part]:
    """A dome of triangles."""
    rows = []
    for k, (r, z) in enumerate(((1.1, 0.0), (1.0, 0.75), (0.72, 1.4), (0.32, 1.85))):
        turn = k * np.pi / 10
        rows.append(np.array([(r * np.cos(a), r * np.sin(a), z) for a in turn + np.arange(10) * 2 * np.pi / 10]))
    colours = [f.main, paint("yellow", "enamel"), paint("blue", "enamel")]
    bars = []
    for k, (low, high) in enumerate(zip(rows[:-1], rows[1:], strict=True)):
        for i in range(10):
            bars += [pipe(colours[k % 3], [low[i], high[i]], 0.022), pipe(colours[(k + 1) % 3], [low[(i + 1) % 10], high[i]], 0.022), pipe(colours[(k + 2) % 3], [high[i], high[(i + 1) % 10]], 0.022)]
    joints = [ellipsoid(DARK, (0.04,) * 3, tuple(p)) for row in rows[1:] for p in row]
    return [*bars, *joints]


def brick_pile(size: Vector, f: Finish) -> list[Part]:
    rng = f.generator()
    parts = []
    for layer in range(8):
        for i in range(4):
            for j in range(3):
                if layer > 5 and rng.random() < 0.25 * (layer - 5) + 0.1:
                    continue
                u, v = (i - 1.5) * 0.255 + rng.normal(0, 0.006), (j - 1) * 0.27 + rng.normal(0, 0.006)
                size_ = (0.24, 0.115, 0.072)
                for s in (-1, 1):
                    parts.append(box(f.main.shaded(rng.uniform(0.75, 1.2)), size_, (u, v + s * 0.062, 0.14 + layer * 0.076), 0.004))
    return [*parts, *pallet((1.05, 0.85, 0.14), replace(f, main=paint("tan", "wood")))]


def clothesline(size: Vector, f: Finish) -> list[Part]:
    posts = [p for s in (-1, 1) for p in (pipe(STEEL, [(s * 1.2, 0, 0), (s * 1.2, 0, 1.85)], 0.025), pipe(STEEL, [(s * 1.2, -0.5, 1.85), (s * 1.2, 0.5, 1.85)], 0.02))]
    lines = [pipe(paint("chalk"), [(-1.2, y, 1.85), (0, y, 1.78), (1.2, y, 1.85)], 0.005) for y in (-0.45, 0.0, 0.45)]
    tints = ("chalk", "coral", "powder blue", "mustard", "sage", "burgundy", "denim blue")
    wash = [p for k, (u, y, w, h) in enumerate(((-0.75, 0.45, 0.6, 0.75), (0.0, 0.45, 0.5, 0.6), (0.65, 0.45, 0.45, 0.7), (-0.5, 0.0, 0.9, 1.2), (0.55, 0.0, 0.7, 0.9), (-0.2, -0.45, 0.5, 0.6), (0.5, -0.45, 0.6, 0.8))) for p in two_sided(cloth(f.main if k == 3 else paint(tints[(k + f.seed) % 7], "fabric"), w, h, (u, y, 1.8 - h), 0.35, 0.08))]
    return [*posts, *lines, *wash]


def chimney(size: Vector, f: Finish) -> list[Part]:
    bricks = replace(f.main, texture="bricks", detail=0.8)
    stack = [box(bricks, (0.7, 0.7, 1.5)), box(bricks.shaded(0.85), (0.8, 0.8, 0.16), (0, 0, 1.4)), box(paint("light grey", "concrete"), (0.78, 0.78, 0.06), (0, 0, 1.56), 0.01)]
    pots = [turned(paint("terracotta", "stone"), [(0.13, 1.6), (0.11, 1.65), (0.1, 1.9), (0.13, 1.93), (0.12, 2.0), (0.09, 2.0), (0.08, 1.9), (0, 1.85)], (s * 0.18, 0, 0)) for s in (-1, 1)]
    return [*stack, *pots, box(paint("slate grey", "metal"), (0.8, 0.8, 0.1), (0, 0, 0), 0.01)]


def boat(size: Vector, f: Finish) -> list[Part]:
    """A fishing boat on trestles, with a wheelhouse."""
    rings = []
    for t in np.linspace(0, 1, 11):
        half = 0.78 * (0.8 + 0.2 * min(t / 0.3, 1.0)) * (1 - max(0.0, (t - 0.5) / 0.5) ** 2.3) + 0.004
        top = 0.75 + 0.3 * t**2.5
        keel = 0.12 + 0.5 * max(0.0, (t - 0.75) / 0.25) ** 2
        rings.append([(half * np.cos(a), -2.05 + 4.1 * t, keel + (top - keel) * (1 - np.sin(a) ** 0.8)) for a in np.linspace(0, np.pi, 11)])
    grid = np.array(rings)
    deck = skin(paint("honey brown", "planks"), [np.linspace(r[-1], r[0], 5) - [0, 0, 0.14] for r in grid])
    transom = skin(f.main, [grid[0], np.array([(u, y, 0.75) for u, y, _ in grid[0]])])
    house = [tapered(paint("chalk"), [(0.8, 0.9, 0.7), (0.74, 0.8, 1.35)], (0, -0.5, 0), 0.06), box(f.second, (0.9, 1.0, 0.05), (0, -0.5, 1.35), 0.02), *(box(paint("charcoal", "glass"), (0.5, 0.02, 0.22), (0, -0.5 + s * 0.415, 1.05)) for s in (-1, 1)), *(box(paint("charcoal", "glass"), (0.02, 0.5, 0.22), (s * 0.385, -0.5, 1.05)) for s in (-1, 1))]
    line = [pipe(paint("chalk"), grid[:, i], 0.04) for i in (0, -1)]
    gear = [placed(hoop(paint("orange"), 0.16, 0.04), (0.41, -0.5, 0.95), np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])), pipe(STEEL, [(0, -0.85, 1.3), (0, -0.85, 1.9)], 0.02), pipe(STEEL, [(0, 1.6, 0.9), (0, 1.6, 1.2)], 0.04)]
    rests = [tapered(paint("tan", "wood"), [(1.2, 0.16, 0), (0.7, 0.14, 0.3)], (0, y, 0), 0.01) for y in (-1.2, 0.8)]
    return [*skin(f.main, grid[:, ::-1], 0.7), *deck, *transom, *house, *line, *gear, *rests]


def luggage_cart(size: Vector, f: Finish) -> list[Part]:
    """An airport trailer: a flat bed with bags under a roof."""
    rng = f.generator()
    bed = [box(f.main, (1.4, 2.4, 0.1), (0, -0.2, 0.4), 0.02), *(box(f.main, (0.06, 0.06, 0.85), (s * 0.66, -0.2 + t * 1.14, 0.5)) for s in (-1, 1) for t in (-1, 1)), box(f.main, (1.44, 2.46, 0.05), (0, -0.2, 1.28), 0.02)]
    wheels = [p for s in (-1, 1) for y in (-0.95, 0.55) for p in wheel(DARK, STEEL, 0.2, 0.14, (s * 0.6, y, 0.2))]
    tow = [pipe(DARK, [(0, 1.0, 0.42), (0, 1.45, 0.2)], 0.03), placed(hoop(DARK, 0.05, 0.018), (0, 1.48, 0.18))]
    bags = []
    for u in (-0.42, 0.05, 0.45):
        for y in np.arange(-1.1, 0.8, 0.52):
            h = float(rng.uniform(0.4, 0.7))
            colour = str(rng.choice(["navy", "black", "burgundy", "teal", "slate grey", "rust", "forest green"]))
            bags += [box(paint(colour, "fabric"), (0.38, 0.46, h), (u, y, 0.5), 0.06), box(DARK, (0.14, 0.03, 0.03), (u, y, 0.5 + h), 0.01)]
    return [*bed, *wheels, *tow, *bags]
