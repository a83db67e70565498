"""Beds, seats and tables beyond the plain ones, kitchens and bathrooms. +y is the front; `fitted` makes sizes exact."""

from dataclasses import replace

import numpy as np

from flymirage_core.worldgen.forms import (
    FACING,
    circle,
    cushion,
    hoop,
    loft,
    mirrored,
    patterned,
    pipe,
    placed,
    rounded_path,
    rounded_ring,
    sign,
    spun,
    sweep,
    tapered,
    wheel,
)  # fmt: skip
from flymirage_core.worldgen.parts import (
    Finish,
    box,
    cylinder,
    ellipsoid,
    four_legs,
    paint,
    smooth,
    turned,
)
from flymirage_core.worldgen.surfaces import Part, Vector

STEEL, DARK, WHITE = paint("silver", "brushed"), paint("black"), paint("white")
LINEN = paint("ivory", "fabric")
GLASS = replace(paint("powder blue", "glass"), opacity=0.35)


def kitchen_island(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(paint("light grey", "marble", seed=f.seed % 97), (x, y, 0.05), (0, 0, z - 0.05), 0.01)
    body = [box(f.main, (x - 0.1, y * 0.66, z - 0.15), (0, y * 0.12, 0.1)), box(DARK, (x - 0.2, y * 0.6, 0.1), (0, y * 0.1, 0))]
    doors = [p for i in range(4) for p in (box(f.main.shaded(1.1), (x / 4 - 0.05, 0.02, z - 0.24), ((i - 1.5) * (x / 4 - 0.02), y * 0.45, 0.14), 0.005), box(STEEL, (0.14, 0.025, 0.02), ((i - 1.5) * (x / 4 - 0.02), y * 0.46 + 0.01, z - 0.17)))]
    tap = [pipe(STEEL, [(x * 0.2, -0.05, z), (x * 0.2, -0.05, z + 0.28), (x * 0.2, 0.12, z + 0.28), (x * 0.2, 0.12, z + 0.2)], 0.014, 0.08)]
    sink = [box(paint("slate grey"), (0.5, 0.36, 0.006), (x * 0.2, 0.16, z), 0.002), *mirrored(box(f.main, (0.07, 0.07, z - 0.05), (x / 2 - 0.08, -y / 2 + 0.1, 0)))]
    return [top, *body, *doors, *tap, *sink]


def garden_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    slats = [box(f.main.shaded(0.94 + 0.04 * (i % 3)), (x, y / 7 - 0.012, 0.03), (0, (i - 3) * y / 7, z - 0.03), 0.005) for i in range(7)]
    legs = [pipe(f.second, [(s * (x / 2 - 0.1), -y / 2 + 0.05, 0), (s * (x / 2 - 0.1), y / 2 - 0.1, z - 0.03)], 0.02) for s in (-1, 1)]
    legs += [pipe(f.second, [(s * (x / 2 - 0.13), y / 2 - 0.05, 0), (s * (x / 2 - 0.13), -y / 2 + 0.1, z - 0.03)], 0.02) for s in (-1, 1)]
    return [*slats, *legs, box(f.second, (x - 0.2, 0.03, 0.03), (0, 0, z * 0.5))]


def school_desk(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = [box(f.main, (x, y, 0.025), (0, 0, z - 0.025), 0.01), box(f.second, (x - 0.1, y - 0.08, 0.02), (0, 0, z - 0.15))]
    back = box(f.second, (x - 0.1, 0.015, 0.13), (0, -y / 2 + 0.05, z - 0.15))
    frames = [p for s in (-1, 1) for p in (pipe(STEEL, [(s * (x / 2 - 0.06), -y / 2 + 0.06, 0.02), (s * (x / 2 - 0.06), -y / 2 + 0.06, z - 0.03), (s * (x / 2 - 0.06), y / 2 - 0.06, z - 0.03), (s * (x / 2 - 0.06), y / 2 - 0.06, 0.02)], 0.015, 0.06),)]
    items = [box(paint("navy"), (0.18, 0.24, 0.02), (-0.15, 0.02, z)), box(paint("chalk"), (0.2, 0.28, 0.006), (0.14, 0.03, z)), pipe(paint("yellow"), [(0.2, -0.1, z + 0.012), (0.2, 0.1, z + 0.012)], 0.005)]
    return [*top, back, *frames, *items, pipe(STEEL, [(-x / 2 + 0.06, -y / 2 + 0.06, 0.15), (x / 2 - 0.06, -y / 2 + 0.06, 0.15)], 0.012)]


def pool_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    felt = box(paint("emerald", "fabric"), (x - 0.2, y - 0.2, 0.02), (0, 0, z - 0.06))
    rails = [box(f.main, (x, 0.13, 0.12), (0, s * (y / 2 - 0.065), z - 0.12), 0.03) for s in (-1, 1)] + [box(f.main, (0.13, y - 0.2, 0.12), (s * (x / 2 - 0.065), 0, z - 0.12), 0.03) for s in (-1, 1)]
    rails += [box(paint("emerald", "fabric").shaded(0.8), (x - 0.3, 0.05, 0.05), (0, s * (y / 2 - 0.15), z - 0.05), 0.015) for s in (-1, 1)]
    pockets = [cylinder(DARK, 0.065, 0.012, (u * (x / 2 - 0.12), s * (y / 2 - 0.12), z - 0.01)) for u in (-1, 0, 1) for s in (-1, 1)]
    legs = [turned(f.main, smooth([(0.09, 0), (0.06, 0.1), (0.1, 0.35), (0.07, 0.5), (0.1, z - 0.2)], 10), (s * (x / 2 - 0.25), t * (y / 2 - 0.2), 0)) for s in (-1, 1) for t in (-1, 1)]
    skirt = box(f.main.shaded(0.8), (x - 0.12, y - 0.12, 0.18), (0, 0, z - 0.3), 0.02)
    colours = ("red", "yellow", "blue", "orange", "plum", "green", "burgundy", "black", "mustard", "coral")
    balls = [ellipsoid(paint(c), (0.032,) * 3, (0.3 + 0.058 * row, 0.067 * (k - row / 2), z - 0.01)) for (row, k), c in zip(((r, k) for r in range(4) for k in range(r + 1)), colours, strict=True)]
    cue = pipe(paint("honey brown", "wood"), [(-0.9, -0.2, z + 0.012), (0.1, 0.05, z + 0.012)], 0.012)
    return [felt, *rails, *pockets, *legs, skirt, *balls, ellipsoid(WHITE, (0.032,) * 3, (-0.45, 0.02, z - 0.01)), cue]


def operating_table(size: Vector, f: Finish) -> list[Part]:
    pads = [cushion(paint("slate grey", "leather"), (0.56, w, 0.12), (0, y, 0.84)) for w, y in ((0.75, 0.48), (0.72, -0.24), (0.38, -0.8))]
    base = [tapered(f.main, [(0.5, 0.9, 0), (0.5, 0.9, 0.08), (0.3, 0.34, 0.12), (0.26, 0.28, 0.5)], radius=0.05), box(STEEL, (0.2, 0.2, 0.3), (0, 0, 0.5)), box(f.main, (0.5, 1.7, 0.05), (0, 0, 0.79), 0.01)]
    rails = [pipe(STEEL, [(s * 0.29, -0.85, 0.82), (s * 0.29, 0.85, 0.82)], 0.014) for s in (-1, 1)]
    arms = [cushion(paint("slate grey", "leather"), (0.5, 0.14, 0.07), (s * 0.52, -0.35, 0.88)) for s in (-1, 1)]
    return [*pads, *base, *rails, *arms]


def packing_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    top = box(paint("tan", "wood"), (x, y, 0.04), (0, 0, z - 0.04), 0.004)
    legs = four_legs(f.main, (x, y), z - 0.04, 0.05, 0.01)
    shelf = box(f.main, (x - 0.1, y - 0.1, 0.03), (0, 0, 0.2))
    roll = [placed(turned(paint("caramel", "paper"), [(0, -0.35), (0.1, -0.35), (0.1, 0.35), (0, 0.35)]), (-x / 4, -0.1, 0.36), np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]))]
    boxes = [box(paint("caramel", "paper", seed=3), (0.4, 0.4, 0.3), (x / 4, 0, 0.23), 0.006), box(paint("tan", "paper"), (0.3, 0.25, 0.006), (0.1, 0.1, z))]
    return [top, *legs, shelf, *roll, *boxes, box(f.main, (x - 0.1, 0.03, 0.1), (0, -y / 2 + 0.05, z - 0.16))]


def bar_stool(size: Vector, f: Finish) -> list[Part]:
    seat = [turned(f.main, smooth([(0.0, 0.72), (0.16, 0.72), (0.19, 0.75), (0.17, 0.78), (0, 0.775)], 8))]
    if f.chosen(2):
        foot = [turned(STEEL, [(0, 0), (0.2, 0), (0.19, 0.02), (0.03, 0.04), (0.025, 0.72), (0, 0.72)]), hoop(STEEL, 0.15, 0.01, (0, 0, 0.26)), *spun(pipe(STEEL, [(0, 0, 0.26), (0.15, 0, 0.26)], 0.008), 2)]
    else:
        foot = [*spun(pipe(f.second, [(0.19, 0, 0), (0.11, 0, 0.73)], 0.016), 4, 0.78), hoop(f.second, 0.16, 0.01, (0, 0, 0.28))]
    back = [sweep(f.main, rounded_ring(0.02, 0.12, 0.008), [(0.17 * np.cos(a), 0.17 * np.sin(a), 0.93) for a in np.linspace(np.pi + 0.3, 2 * np.pi - 0.3, 9)])]
    return [*seat, *foot, *back, *(pipe(f.second, [(s * 0.1, -0.12, 0.75), (s * 0.11, -0.145, 0.95)], 0.01) for s in (-1, 1))]


def garden_chair(size: Vector, f: Finish) -> list[Part]:
    seat = [box(f.main, (0.5, 0.07, 0.02), (0, v, 0.42), 0.005) for v in np.linspace(-0.18, 0.2, 5)]
    back = [box(f.main, (0.46, 0.02, 0.07), (0, -0.235 - 0.07 * i * 0.3, 0.5 + 0.09 * i), 0.005, 0.2) for i in range(4)]
    sides = [pipe(f.second, line, 0.016, 0.05) for s in (-1, 1) for line in ([(s * 0.24, 0.24, 0), (s * 0.24, -0.16, 0.44), (s * 0.24, -0.32, 0.88)], [(s * 0.24, -0.26, 0), (s * 0.24, 0.2, 0.42), (s * 0.26, 0.24, 0.62), (s * 0.26, -0.24, 0.64)])]
    return [*seat, *back, *sides]


def pew(size: Vector, f: Finish) -> list[Part]:
    x, _, _ = size
    outline = [(0.28, 0), (0.28, 0.1), (0.2, 0.5), (0.26, 0.62), (0.18, 0.68), (-0.1, 0.6), (-0.22, 0.95), (-0.3, 0.95), (-0.28, 0)]
    ends = [placed(loft(f.main, [np.column_stack([np.full(9, u), [a for a, _ in outline], [b for _, b in outline]]) for u in (-0.03, 0.03)]), (s * (x / 2 - 0.03), 0, 0)) for s in (-1, 1)]
    back = [box(f.main, (x - 0.06, 0.025, 0.48), (0, -0.2, 0.44), 0, 0.12), box(f.main, (x - 0.06, 0.06, 0.05), (0, -0.265, 0.9), 0.012)]
    books = [box(paint("burgundy"), (0.12, 0.04, 0.17), (u, -0.31, 0.6)) for u in (-x * 0.3, -x * 0.1, x * 0.2)]
    return [*ends, *back, box(f.main, (x - 0.06, 0.4, 0.035), (0, 0.02, 0.42), 0.01), box(f.main, (x - 0.06, 0.04, 0.1), (0, -0.33, 0.55)), *books, box(f.main.shaded(0.85), (x - 0.06, 0.02, 0.3), (0, 0.1, 0.08))]


def bunk_bed(size: Vector, f: Finish) -> list[Part]:
    posts = [box(f.main, (0.06, 0.06, 1.65), (s * 0.46, t * 0.98, 0)) for s in (-1, 1) for t in (-1, 1)]
    parts = [*posts]
    for z in (0.3, 1.2):
        parts += [box(f.main, (0.04, 1.96, 0.12), (s * 0.46, 0, z)) for s in (-1, 1)] + [box(f.main, (0.9, 0.04, h), (0, t * 0.98, z)) for t, h in ((-1, 0.4), (1, 0.3))]
        parts += [box(LINEN, (0.86, 1.9, 0.16), (0, 0, z + 0.06), 0.05), box(paint(("denim blue", "sage", "rust")[f.chosen(3)], "fabric"), (0.88, 1.25, 0.08), (0, 0.28, z + 0.18), 0.035), cushion(LINEN, (0.62, 0.38, 0.14), (0, -0.72, z + 0.2))]
    ladder = [pipe(f.main, [(0.5, 0.55 + u, 0), (0.5, 0.55 + u, 1.55)], 0.018) for u in (0, 0.34)] + [pipe(f.main, [(0.5, 0.55, z), (0.5, 0.89, z)], 0.014) for z in np.arange(0.25, 1.5, 0.27)]
    rail = [pipe(f.main, [(0.47, -0.95, z), (0.47, 0.5, z)], 0.016) for z in (1.45, 1.58)]
    return [*parts, *ladder, *rail]


def hospital_bed(size: Vector, f: Finish) -> list[Part]:
    base = [box(f.main, (0.7, 1.7, 0.1), (0, 0, 0.24), 0.02), *(pipe(STEEL, [(s * 0.3, y, 0.34), (s * 0.3, y + 0.2, 0.5)], 0.03) for s in (-1, 1) for y in (-0.6, 0.4))]
    casters = [p for s in (-1, 1) for t in (-1, 1) for p in wheel(DARK, STEEL, 0.08, 0.04, (s * 0.34, t * 0.78, 0.08))]
    flat = [box(LINEN, (0.86, 1.2, 0.14), (0, 0.34, 0.55), 0.05), placed(box(LINEN, (0.86, 0.8, 0.14), (0, 0, 0), 0.05), (0, -0.6, 0.68), np.array([[1.0, 0, 0], [0, 0.87, 0.5], [0, -0.5, 0.87]]))]
    cover = [box(paint("powder blue", "fabric"), (0.9, 1.0, 0.08), (0, 0.44, 0.65), 0.035), placed(cushion(LINEN, (0.6, 0.38, 0.13)), (0, -0.78, 0.9), np.array([[1.0, 0, 0], [0, 0.87, 0.5], [0, -0.5, 0.87]]))]
    boards = [tapered(f.main, [(0.92, 0.05, 0.45), (0.92, 0.05, 0.9), (0.7, 0.05, 1.0)], (0, t * 1.02, 0), 0.02) for t in (-1, 1)]
    rails = [p for s in (-1, 1) for p in (pipe(STEEL, rounded_path([(s * 0.47, -0.75, 0.6), (s * 0.47, -0.75, 0.92), (s * 0.47, 0.15, 0.92), (s * 0.47, 0.15, 0.6)], 0.08), 0.014), *(pipe(STEEL, [(s * 0.47, y, 0.6), (s * 0.47, y, 0.92)], 0.008) for y in (-0.5, -0.3, -0.1)))]
    return [*base, *casters, *flat, *cover, *boards, *rails]


def crib(size: Vector, f: Finish) -> list[Part]:
    ends = [p for t in (-1, 1) for p in (box(f.main, (0.68, 0.03, 0.07), (0, t * 0.63, 0.93), 0.01), box(f.main, (0.68, 0.03, 0.06), (0, t * 0.63, 0.3)))]
    bars = [pipe(f.main, [(s * 0.33, y, 0.33), (s * 0.33, y, 0.94)], 0.01) for s in (-1, 1) for y in np.linspace(-0.56, 0.56, 12)] + [pipe(f.main, [(u, t * 0.63, 0.33), (u, t * 0.63, 0.94)], 0.01) for t in (-1, 1) for u in np.linspace(-0.26, 0.26, 6)]
    rails = [box(f.main, (0.03, 1.26, h), (s * 0.33, 0, z), 0.008) for s in (-1, 1) for z, h in ((0.93, 0.05), (0.3, 0.05))]
    posts = [turned(f.main, [(0.025, 0), (0.03, 0.95), (0.022, 0.98), (0.03, 1.0), (0, 1.03)], (s * 0.33, t * 0.63, 0)) for s in (-1, 1) for t in (-1, 1)]
    bedding = [box(LINEN, (0.6, 1.2, 0.1), (0, 0, 0.36), 0.03), box(paint(("mint", "blush", "powder blue")[f.chosen(3)], "fabric"), (0.58, 0.7, 0.06), (0, 0.2, 0.44), 0.025), ellipsoid(paint("caramel", "fabric"), (0.09, 0.09, 0.11), (0.1, -0.35, 0.56)), ellipsoid(paint("caramel", "fabric"), (0.07,) * 3, (0.1, -0.35, 0.7))]
    return [*ends, *bars, *rails, *posts, *bedding]


def sun_lounger(size: Vector, f: Finish) -> list[Part]:
    slats = [box(f.main, (0.62, 0.07, 0.025), (0, v, 0.28), 0.005) for v in np.linspace(-0.25, 0.9, 13)]
    back = [placed(box(f.main, (0.62, 0.07, 0.025), (0, -v, 0), 0.005), (0, -0.32, 0.29), np.array([[1.0, 0, 0], [0, 0.82, 0.57], [0, -0.57, 0.82]])) for v in np.linspace(0, 0.62, 7)]
    frame = [box(f.second, (0.04, 1.85, 0.06), (s * 0.32, 0.0, 0.23), 0.01) for s in (-1, 1)] + [box(f.second, (0.05, 0.05, 0.25), (s * 0.3, y, 0)) for s in (-1, 1) for y in (-0.75, 0.75)]
    pad = [box(paint(("cream", "teal", "coral")[f.chosen(3)], "fabric"), (0.56, 1.2, 0.06), (0, 0.32, 0.305), 0.028), placed(box(paint(("cream", "teal", "coral")[f.chosen(3)], "fabric"), (0.56, 0.62, 0.06), (0, -0.31, 0.02), 0.028), (0, -0.3, 0.31), np.array([[1.0, 0, 0], [0, 0.82, 0.57], [0, -0.57, 0.82]]))]
    return [*slats, *back, *frame, *pad]


def massage_table(size: Vector, f: Finish) -> list[Part]:
    top = [box(f.main, (0.72, 1.6, 0.1), (0, 0.1, 0.6), 0.04), placed(hoop(f.main, 0.12, 0.045), (0, -0.85, 0.66))]
    legs = [pipe(paint("honey brown", "wood"), [(s * 0.3, t * 0.62, 0), (s * 0.3, t * 0.5, 0.6)], 0.025) for s in (-1, 1) for t in (-1, 1)]
    braces = [pipe(STEEL, [(s * 0.3, 0.55, 0.35), (s * 0.3, -0.55, 0.35)], 0.006) for s in (-1, 1)]
    towel = [box(paint("chalk", "fabric"), (0.5, 0.3, 0.1), (0, 0.6, 0.7), 0.04)]
    return [*top, *legs, *braces, *towel, *(box(paint("honey brown", "wood"), (0.6, 0.03, 0.06), (0, t * 0.55, 0.32)) for t in (-1, 1))]


def stove(size: Vector, f: Finish) -> list[Part]:
    body = [box(f.main, (0.6, 0.58, 0.85), (0, -0.01, 0.04), 0.01), box(DARK, (0.56, 0.5, 0.04))]
    glass = [box(DARK, (0.46, 0.015, 0.3), (0, 0.285, 0.3), 0.006), pipe(STEEL, [(-0.22, 0.33, 0.66), (0.22, 0.33, 0.66)], 0.012), *(box(STEEL, (0.02, 0.05, 0.02), (s * 0.2, 0.305, 0.65)) for s in (-1, 1))]
    knobs = [placed(turned(DARK, [(0, 0), (0.022, 0), (0.018, 0.03), (0, 0.03)]), (u, 0.28, 0.8), FACING) for u in np.linspace(-0.22, 0.22, 5)]
    top = [box(paint("charcoal"), (0.58, 0.54, 0.012), (0, 0, 0.89), 0.004)]
    rings = [p for u in (-0.14, 0.14) for v in (-0.12, 0.13) for p in (cylinder(DARK, 0.05, 0.012, (u, v, 0.9)), *(placed(q, (u, v, 0.92)) for q in spun(box(DARK, (0.2, 0.012, 0.012)), 2, 0.78)))]
    return [*body, *glass, *knobs, *top, *rings, box(f.main, (0.6, 0.03, 0.1), (0, -0.28, 0.89), 0.01), box(f.main.shaded(0.9), (0.56, 0.015, 0.16), (0, 0.285, 0.08), 0.005)]


def sink_unit(size: Vector, f: Finish) -> list[Part]:
    body = [box(f.main, (1.2, 0.54, 0.76), (0, -0.02, 0.1)), box(DARK, (1.1, 0.46, 0.1), (0, -0.03, 0)), box(paint("light grey", "stone"), (1.22, 0.6, 0.04), (0, 0, 0.86), 0.01)]
    doors = [p for s in (-1, 1) for p in (box(f.main.shaded(1.1), (0.56, 0.02, 0.68), (s * 0.29, 0.255, 0.14), 0.005), box(STEEL, (0.02, 0.025, 0.14), (s * 0.06, 0.27, 0.6)))]
    bowl = [tapered(STEEL, [(0.5, 0.4, 0.895), (0.52, 0.42, 0.908)], (-0.2, 0.0, 0), 0.06), box(paint("slate grey"), (0.44, 0.34, 0.004), (-0.2, 0.0, 0.906), 0.001), *(box(STEEL, (0.42, 0.012, 0.008), (0.35, v, 0.9)) for v in np.linspace(-0.16, 0.16, 7))]
    tap = [pipe(STEEL, [(-0.2, -0.24, 0.9), (-0.2, -0.24, 1.16), (-0.2, -0.04, 1.16), (-0.2, -0.04, 1.08)], 0.014, 0.08), *(cylinder(STEEL, 0.02, 0.07, (-0.2 + s * 0.1, -0.24, 0.9)) for s in (-1, 1))]
    plates = [placed(turned(WHITE, [(0, 0), (0.1, 0.004), (0.11, 0.014), (0, 0.012)]), (0.3 + 0.05 * i, 0.0, 1.01), np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])) for i in range(4)]
    return [*body, *doors, *bowl, *tap, *plates]


def washing_machine(size: Vector, f: Finish) -> list[Part]:
    body = box(f.main, (0.6, 0.56, 0.83), (0, -0.01, 0.02), 0.015)
    rim = placed(turned(STEEL, [(0.2, 0.0), (0.2, 0.03), (0.15, 0.045), (0.15, 0.0)]), (0, 0.27, 0.42), FACING)
    glass = placed(turned(paint("charcoal", "glass"), [(0.15, 0.015), (0.1, 0.0), (0, -0.01)]), (0, 0.275, 0.42), FACING)
    panel = [box(f.main.shaded(0.9), (0.58, 0.02, 0.12), (0, 0.27, 0.7), 0.004), placed(turned(STEEL, [(0, 0), (0.035, 0), (0.03, 0.03), (0, 0.03)]), (0.06, 0.28, 0.76), FACING), box(paint("teal", "screen", 0.5, 0.3), (0.12, 0.01, 0.05), (0.2, 0.278, 0.735)), box(f.main.shaded(0.8), (0.18, 0.012, 0.08), (-0.18, 0.278, 0.72), 0.004)]
    return [body, rim, glass, *panel, box(DARK, (0.56, 0.5, 0.03))]


def oven(size: Vector, f: Finish) -> list[Part]:
    """A baker's deck oven: three doors over each other on legs."""
    body = [box(f.main, (0.9, 0.72, 1.25), (0, -0.02, 0.35), 0.015), *four_legs(STEEL, (0.9, 0.74), 0.35, 0.06)]
    decks = [p for i in range(3) for p in (box(DARK, (0.6, 0.02, 0.22), (-0.06, 0.345, 0.46 + 0.38 * i), 0.01), box(paint("orange", emission=0.35), (0.5, 0.012, 0.13), (-0.06, 0.358, 0.5 + 0.38 * i), 0.004), pipe(STEEL, [(-0.34, 0.39, 0.71 + 0.38 * i), (0.22, 0.39, 0.71 + 0.38 * i)], 0.014), box(paint("charcoal", "buttons", detail=0.3), (0.14, 0.012, 0.22), (0.35, 0.346, 0.46 + 0.38 * i)))]
    return [*body, *decks, cylinder(STEEL, 0.08, 0.14, (0.2, -0.2, 1.6))]


def bathtub(size: Vector, f: Finish) -> list[Part]:
    rows = ((0.56, 1.4, 0.06), (0.7, 1.58, 0.4), (0.78, 1.7, 0.56), (0.78, 1.7, 0.6))
    outer = [np.column_stack([rounded_ring(a, b, 0.32, 6), np.full(24, z)]) for a, b, z in rows]
    inner = [np.column_stack([rounded_ring(a - 0.12, b - 0.14, 0.28, 6), np.full(24, z)]) for a, b, z in (rows[3], rows[1], (0.6, 1.4, 0.16))]
    shell = loft(f.main, np.array([*outer, *inner]), True)
    feet = [ellipsoid(paint("brass", "metal"), (0.05, 0.06, 0.06), (s * 0.24, t * 0.55, 0.06)) for s in (-1, 1) for t in (-1, 1)]
    tap = [pipe(STEEL, [(0, -0.82, 0.58), (0, -0.82, 0.78), (0, -0.66, 0.78), (0, -0.66, 0.72)], 0.018, 0.07), *(ellipsoid(STEEL, (0.03,) * 3, (s * 0.1, -0.8, 0.64)) for s in (-1, 1))]
    return [shell, *feet, *tap, *([tapered(replace(paint("sky blue", "water"), opacity=0.8), [(0.6, 1.5, 0.4), (0.6, 1.5, 0.405)], radius=0.28)] if f.chosen(2) else [])]


def toilet(size: Vector, f: Finish) -> list[Part]:
    def oval(w: float, d: float, z: float, y: float) -> np.ndarray:
        c = circle(0.5, 20)
        return np.column_stack([c[:, 0] * w, c[:, 1] * d + y, np.full(20, z)])

    bowl = loft(f.main, np.array([oval(0.22, 0.34, 0, -0.02), oval(0.2, 0.32, 0.15, 0.0), oval(0.34, 0.5, 0.36, 0.06), oval(0.36, 0.52, 0.4, 0.06), oval(0.26, 0.4, 0.4, 0.07), oval(0.2, 0.3, 0.3, 0.06)]))
    seat = loft(f.main.shaded(1.05), np.array([oval(0.38, 0.5, 0.4, 0.07), oval(0.38, 0.5, 0.43, 0.07), oval(0.24, 0.34, 0.43, 0.08), oval(0.24, 0.34, 0.4, 0.08)]), False)
    lid = loft(f.main.shaded(1.05), np.array([oval(0.37, 0.05, 0.43, -0.17), oval(0.38, 0.06, 0.6, -0.19), oval(0.28, 0.04, 0.78, -0.2)]))
    tank = [tapered(f.main, [(0.34, 0.15, 0.38), (0.38, 0.17, 0.74), (0.4, 0.19, 0.74), (0.4, 0.19, 0.78)], (0, -0.28, 0), 0.03), cylinder(STEEL, 0.025, 0.012, (0, -0.28, 0.78))]
    return [bowl, seat, lid, *tank]


def washbasin(size: Vector, f: Finish) -> list[Part]:
    rows = ((0.3, 0.24, 0.66), (0.5, 0.4, 0.76), (0.6, 0.48, 0.84), (0.6, 0.48, 0.88), (0.5, 0.36, 0.88), (0.42, 0.28, 0.8), (0.1, 0.08, 0.76))
    basin = loft(f.main, np.array([np.column_stack([rounded_ring(a, b, 0.12, 5), np.full(20, z)]) for a, b, z in rows]))
    foot = turned(f.main, smooth([(0.11, 0), (0.1, 0.1), (0.075, 0.4), (0.12, 0.68)], 8), (0, -0.05, 0))
    tap = [pipe(STEEL, [(0, -0.19, 0.87), (0, -0.19, 1.02), (0, -0.06, 1.02), (0, -0.06, 0.98)], 0.014, 0.05), *(cylinder(STEEL, 0.018, 0.06, (s * 0.1, -0.19, 0.88)) for s in (-1, 1))]
    return [basin, foot, *tap]


def shower_cabin(size: Vector, f: Finish) -> list[Part]:
    pane = replace(f.main if f.main.texture == "glass" else GLASS, opacity=0.3)
    tray = [box(WHITE, (0.95, 0.95, 0.12), (0, 0, 0), 0.03), box(paint("light grey"), (0.8, 0.8, 0.006), (0, 0, 0.118)), cylinder(STEEL, 0.05, 0.008, (0, 0, 0.123))]
    frame = [pipe(STEEL, [(s * 0.46, t * 0.46, 0.1), (s * 0.46, t * 0.46, 2.05)], 0.018) for s in (-1, 1) for t in (-1, 1)] + [p for z in (0.13, 2.03) for p in (*mirrored(box(STEEL, (0.03, 0.92, 0.03), (0.46, 0, z))), box(STEEL, (0.92, 0.03, 0.03), (0, 0.46, z)), box(STEEL, (0.92, 0.03, 0.03), (0, -0.46, z)))]
    walls = [*mirrored(box(pane, (0.01, 0.88, 1.88), (0.46, 0, 0.15))), box(pane, (0.42, 0.01, 1.88), (-0.23, 0.46, 0.15)), box(pane, (0.42, 0.01, 1.88), (0.23, 0.47, 0.15)), box(paint("chalk", "small tiles"), (0.9, 0.02, 1.88), (0, -0.46, 0.15))]
    head = [pipe(STEEL, [(0, -0.44, 1.0), (0, -0.42, 1.95), (0, -0.15, 1.98)], 0.014, 0.08), turned(STEEL, [(0.11, 1.93), (0.1, 1.95), (0, 1.97)], (0, -0.15, 0)), box(STEEL, (0.2, 0.05, 0.05), (0, -0.43, 1.05), 0.01), pipe(STEEL, [(0.06, 0.5, 0.95), (0.06, 0.5, 1.25)], 0.012)]
    return [*tray, *frame, *walls, *head]


def radiator(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    count = max(6, round(x / 0.075))
    columns = [p for i in range(count) for p in (box(f.main, (x / count * 0.62, y * 0.9, z - 0.1), ((i + 0.5) * x / count - x / 2, 0, 0.07), 0.018),)]
    bars = [pipe(f.main, [(-x / 2 + 0.03, 0, h), (x / 2 - 0.03, 0, h)], 0.022) for h in (0.13, z - 0.09)]
    feet = [box(f.main, (0.04, y, 0.1), (s * (x / 2 - 0.1), 0, 0), 0.01) for s in (-1, 1)]
    return [*columns, *bars, *feet, placed(turned(WHITE, [(0, 0), (0.025, 0), (0.025, 0.06), (0, 0.06)]), (x / 2 - 0.02, 0, 0.1))]


def fireplace(size: Vector, f: Finish) -> list[Part]:
    inside = [box(paint("charcoal", "bricks"), (0.86, 0.04, 0.8), (0, -0.2, 0.05)), *mirrored(box(paint("charcoal", "bricks"), (0.04, 0.36, 0.8), (0.43, -0.02, 0.05)))]
    jambs = [p for s in (-1, 1) for p in (box(f.main, (0.3, 0.4, 1.05), (s * 0.58, -0.03, 0), 0.01), tapered(f.main.shaded(1.05), [(0.24, 0.06, 0.12), (0.2, 0.05, 0.95)], (s * 0.58, 0.18, 0), 0.008), box(f.main, (0.34, 0.46, 0.12), (s * 0.58, 0, 0), 0.01))]
    lintel = [box(f.main, (0.9, 0.4, 0.24), (0, -0.03, 0.82), 0.008), box(f.main.shaded(1.05), (0.4, 0.05, 0.14), (0, 0.18, 0.86), 0.01)]
    shelf = [tapered(f.main, [(1.3, 0.42, 1.04), (1.5, 0.5, 1.12), (1.52, 0.52, 1.12), (1.52, 0.52, 1.18)], (0, 0, 0), 0.01)]
    logs = [pipe(paint("walnut brown", "bark"), [(-0.26, 0.02 + 0.07 * i, 0.14 + 0.04 * i), (0.26, -0.04 + 0.08 * i, 0.16)], 0.05) for i in range(3)]
    fire = [turned(paint(c, emission=e), smooth([(0, 0.16), (r, 0.2), (0.6 * r, 0.3), (0, h)], 6), (u, 0.02, 0)) for c, e, r, h, u in (("orange", 2.5, 0.09, 0.5, -0.06), ("yellow", 3.0, 0.06, 0.42, 0.07), ("orange", 2.0, 0.05, 0.36, -0.17))]
    return [*inside, *jambs, *lintel, *shelf, *logs, *fire, box(f.main.shaded(0.7), (1.5, 0.5, 0.05), (0, 0, 0)), *(pipe(DARK, [(u, 0.17, 0.06), (u, 0.17, 0.2)], 0.01) for u in np.linspace(-0.35, 0.35, 8)), pipe(DARK, [(-0.37, 0.17, 0.2), (0.37, 0.17, 0.2)], 0.012)]


def chest_freezer(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    body = box(f.main, (x, y, z - 0.14), (0, 0, 0.06), 0.03)
    lids = [box(GLASS, (x / 2 - 0.03, y - 0.1, 0.02), (s * x / 4, 0, z - 0.06 + 0.015 * (s > 0)), 0.006) for s in (-1, 1)]
    rim = [box(paint("slate grey"), (x, 0.06, 0.07), (0, s * (y / 2 - 0.03), z - 0.08), 0.02) for s in (-1, 1)] + [box(paint("slate grey"), (0.06, y, 0.07), (s * (x / 2 - 0.03), 0, z - 0.08), 0.02) for s in (-1, 1)]
    goods = [box(replace(paint("white", "labels", 0.1, 0.4, f.seed % 97)), (x - 0.12, y - 0.12, 0.03), (0, 0, z - 0.14))]
    return [body, *lids, *rim, *goods, box(DARK, (x - 0.06, y - 0.06, 0.06)), sign("ICE CREAM", x * 0.5, 0.2, (0, y / 2 + 0.002, z * 0.45), "chalk", "blue"), box(patterned("slate grey", "grille"), (0.3, 0.01, 0.14), (-x / 2 + 0.2, y / 2 + 0.002, 0.1))]
