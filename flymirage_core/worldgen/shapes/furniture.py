"""Tables, seats, beds and storage. Every builder fills the size (x, y, z) it is given; +y is the front."""

import numpy as np

from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import Finish, box, four_legs, paint, picture, tube, turned
from flymirage_core.worldgen.surfaces import Part, Vector

BOOK_COLOURS = (
    "rust",
    "navy",
    "cream",
    "moss green",
    "burgundy",
    "mustard",
    "slate grey",
    "teal",
    "tan",
    "chalk",
    "plum",
)


def round_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    r = min(x, y) / 2
    foot = turned(f.second, [(0, 0), (r * 0.55, 0), (r * 0.5, 0.03), (0.04, 0.06), (0.04, z - 0.04)])
    return [turned(f.main, [(0, z - 0.04), (r, z - 0.035), (r, z), (0, z)], scale=(x / 2 / r, y / 2 / r)), foot]


def coffee_table(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    shelf = box(f.second, (x - 0.12, y - 0.12, 0.025), (0, 0, z * 0.35))
    return [
        box(f.main, (x, y, 0.05), (0, 0, z - 0.05), 0.012),
        shelf,
        *four_legs(f.second, (x, y), z - 0.05, 0.05, 0.02),
    ]


def desk(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    width = min(0.42, x * 0.35)
    drawers = box(f.second, (width, y - 0.08, z - 0.12), (x / 2 - width / 2 - 0.02, 0, 0.08))
    fronts = [
        box(
            f.main,
            (width - 0.03, 0.015, (z - 0.16) / 3 - 0.02),
            (x / 2 - width / 2 - 0.02, y / 2 - 0.04, 0.09 + i * (z - 0.16) / 3),
        )
        for i in range(3)
    ]
    legs = [box(f.second, (0.05, 0.05, z - 0.04), (-x / 2 + 0.06, s * (y / 2 - 0.06), 0)) for s in (-1, 1)]
    modesty = box(f.second, (x - 0.14, 0.02, z * 0.45), (0, -y / 2 + 0.05, z * 0.5))
    return [box(f.main, (x, y, 0.04), (0, 0, z - 0.04), 0.006), drawers, *fronts, *legs, modesty]


def workbench(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    shelf = box(f.main, (x - 0.1, y - 0.1, 0.03), (0, 0, 0.16))
    top = box(f.main, (x, y, 0.07), (0, 0, z - 0.07))
    rail = box(f.second, (x - 0.1, 0.03, 0.1), (0, -y / 2 + 0.07, z - 0.17))
    return [top, shelf, rail, *four_legs(f.second, (x, y), z - 0.07, 0.09, 0.02)]


def counter(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    body = box(f.second, (x - 0.04, y - 0.06, z - 0.05), (0, -0.01, 0.0))
    n = max(2, round(x / 0.6))
    panel = f.second.shaded(1.25), (x / n - 0.06, 0.015, z - 0.3)
    panels = [box(*panel, ((i + 0.5) * x / n - x / 2, y / 2 - 0.04, 0.13)) for i in range(n)]
    return [box(f.main, (x, y, 0.05), (0, 0, z - 0.05), 0.01), body, *panels]


def reception_desk(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    front = box(f.second, (x, 0.08, z - 0.04), (0, y / 2 - 0.04, 0))
    slats = [
        box(f.second.shaded(0.75), (0.03, 0.012, z - 0.2), (u, y / 2 - 0.004, 0.08))
        for u in np.linspace(-x / 2 + 0.1, x / 2 - 0.1, int(x / 0.16))
    ]
    sides = [box(f.second, (0.06, y - 0.08, z - 0.3), (s * (x / 2 - 0.03), -0.04, 0)) for s in (-1, 1)]
    desk_top = box(f.main, (x - 0.12, y - 0.1, 0.04), (0, -0.04, z - 0.35))
    return [front, *slats, *sides, desk_top, box(f.main, (x, 0.26, 0.04), (0, y / 2 - 0.13, z - 0.04), 0.008)]


def padded_chair(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    seat = 0.47
    back = box(f.main, (x - 0.02, 0.07, z - seat + 0.02), (0, -y / 2 + 0.06, seat - 0.02), 0.03, 0.04)
    return [
        *four_legs(f.second, (x, y), seat - 0.08, 0.035, 0.03),
        box(f.main, (x, y - 0.04, 0.09), (0, 0.02, seat - 0.09), 0.035),
        back,
    ]


def stool(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    r = min(x, y) / 2
    seat = turned(f.main, [(0, z - 0.05), (r - 0.01, z - 0.05), (r, z - 0.03), (r - 0.01, z), (0, z)])
    legs = [
        tube(f.second, [(u * r * 0.86, v * r * 0.86, 0.0), (u * r * 0.5, v * r * 0.5, z - 0.05)], 0.018)
        for u, v in ((0.7, 0.7), (-0.7, 0.7), (0.7, -0.7), (-0.7, -0.7))
    ]
    ring = turned(
        f.second, [(r * 0.62, z * 0.35), (r * 0.66, z * 0.35), (r * 0.66, z * 0.35 + 0.03), (r * 0.62, z * 0.35 + 0.03)]
    )
    return [seat, ring, *(p for leg in legs for p in leg)]


def bench(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    slats = [box(f.main, (x, y / 4 - 0.015, 0.04), (0, (i - 1.5) * y / 4, z - 0.04), 0.006) for i in range(4)]
    legs = [box(f.second, (0.07, y - 0.06, z - 0.04), (s * (x / 2 - 0.2), 0, 0)) for s in (-1, 1)]
    return [*slats, *legs]


def seat_row(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    count = max(2, round(x / 0.58))
    pitch = x / count
    parts = [box(f.second, (x - 0.1, 0.06, 0.06), (0, 0, 0.32))]
    parts += [box(f.second, (0.06, y - 0.06, 0.04), (s * (x / 2 - 0.3), 0, 0)) for s in (-1, 1)]
    parts += [box(f.second, (0.06, 0.06, 0.3), (s * (x / 2 - 0.3), 0, 0.03)) for s in (-1, 1)]
    for i in range(count):
        u = (i + 0.5) * pitch - x / 2
        parts.append(box(f.main, (pitch - 0.05, y - 0.08, 0.05), (u, 0.03, 0.38), 0.02))
        parts.append(box(f.main, (pitch - 0.05, 0.05, z - 0.47), (u, -y / 2 + 0.07, 0.47), 0.02, 0.07))
    return parts


def sofa(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    arm = min(0.2, x * 0.13)
    seats = max(1, round((x - 2 * arm) / 0.75))
    width = (x - 2 * arm) / seats
    parts = [
        box(f.main.shaded(0.9), (x - 0.02, y - 0.04, 0.24), (0, 0, 0.08), 0.03),
        box(f.main, (x, 0.2, z - 0.1), (0, -y / 2 + 0.1, 0.1), 0.05),
        *(box(f.main, (arm, y, 0.5), (s * (x / 2 - arm / 2), 0, 0.1), 0.05) for s in (-1, 1)),
        *(
            box(f.second, (0.05, 0.05, 0.1), (s * (x / 2 - 0.08), t * (y / 2 - 0.08), 0))
            for s in (-1, 1)
            for t in (-1, 1)
        ),
    ]
    for i in range(seats):
        u = (i + 0.5) * width - (x - 2 * arm) / 2
        parts.append(box(f.main.shaded(1.08), (width - 0.01, y - 0.22, 0.16), (u, 0.09, 0.31), 0.05))
        parts.append(box(f.main.shaded(1.04), (width - 0.02, 0.15, z - 0.46), (u, -y / 2 + 0.26, 0.45), 0.06, 0.12))
    return parts


def bed(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    sheet = paint("ivory", "fabric", seed=f.seed)
    parts = [
        box(f.second, (x, y - 0.04, 0.18), (0, 0.02, 0.1)),
        *four_legs(f.second, (x, y), 0.1, 0.07),
        box(sheet, (x - 0.06, y - 0.12, 0.22), (0, 0.0, 0.28), 0.05),
        box(f.main, (x, y * 0.66, 0.2), (0, y * 0.16, 0.34), 0.06),
        box(f.second, (x, 0.07, z), (0, -y / 2 + 0.035, 0), 0.02),
    ]
    for s in (-1, 1) if x > 1.2 else (0,):
        parts.append(
            box(sheet.shaded(1.1), (min(0.62, x * 0.42), 0.4, 0.16), (s * x / 4, -y / 2 + 0.34, 0.48), 0.07, 0.25)
        )
    return parts


def bookshelf(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    shelves = max(2, round((z - 0.1) / 0.36))
    pitch = (z - 0.1 - 0.03) / shelves
    parts = [box(f.main, (0.03, y, z), (s * (x / 2 - 0.015), 0, 0)) for s in (-1, 1)]
    parts += [box(f.main, (x - 0.06, y, 0.03), (0, 0, 0.1 + i * pitch)) for i in range(shelves + 1)]
    parts += [
        box(f.main.shaded(0.6), (x - 0.06, 0.02, z - 0.1), (0, -y / 2 + 0.01, 0.1)),
        box(f.main, (x - 0.06, 0.02, 0.1), (0, y / 2 - 0.05, 0)),
    ]
    for i in range(shelves):
        u, end = -x / 2 + 0.05, x / 2 - rng.uniform(0.06, 0.4)
        while u < end - 0.07:
            w, h = rng.uniform(0.035, 0.075), min(rng.uniform(0.2, 0.3), pitch - 0.05)
            book = paint(str(rng.choice(BOOK_COLOURS)), seed=int(rng.integers(1000)))
            parts.append(box(book, (w - 0.004, y * rng.uniform(0.55, 0.72), h), (u + w / 2, -0.02, 0.13 + i * pitch)))
            u += w
    return parts


def storage_rack(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    levels = max(3, round(z / 0.55))
    pitch = (z - 0.12) / (levels - 1)
    parts = four_legs(f.second, (x, y), z, 0.05, 0.0)
    for i in range(levels):
        base = 0.06 + i * pitch
        parts.append(box(f.main, (x - 0.02, y - 0.02, 0.04), (0, 0, base)))
        u = -x / 2 + 0.1
        while i < levels - 1 and u < x / 2 - 0.35:
            w, h = rng.uniform(0.22, 0.4), rng.uniform(0.18, min(0.36, pitch - 0.1))
            colour = str(rng.choice(["tan", "caramel", "grey", "denim blue", "chalk", "olive", "rust"]))
            if rng.random() < 0.8:
                carton = paint(
                    colour, "paper" if colour in ("tan", "caramel") else "plain", seed=int(rng.integers(1000))
                )
                parts.append(box(carton, (w, y - rng.uniform(0.1, 0.2), h), (u + w / 2, 0, base + 0.04), 0.01))
            u += w + rng.uniform(0.03, 0.12)
    return parts


def cabinet(size: Vector, f: Finish) -> list[Part]:
    """Doors side by side on a plinth: sideboards, wardrobes, lockers, kitchen cabinets."""
    x, y, z = size
    plinth = 0.08
    doors = max(1, round(x / (0.5 if z < 1.3 else 0.48)))
    width = x / doors
    parts = [
        box(f.main, (x, y - 0.025, z - plinth), (0, -0.0125, plinth)),
        box(f.second, (x - 0.06, y - 0.08, plinth), (0, -0.02, 0)),
    ]
    for i in range(doors):
        u = (i + 0.5) * width - x / 2
        parts.append(
            box(f.main.shaded(1.12), (width - 0.02, 0.02, z - plinth - 0.04), (u, y / 2 - 0.015, plinth + 0.02), 0.004)
        )
        side = 1 if i % 2 == 0 else -1
        parts.append(box(f.second, (0.02, 0.02, 0.14), (u + side * (width / 2 - 0.06), y / 2 - 0.01, z * 0.52)))
    return parts


def drawers(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rows = max(2, round(z / 0.26))
    height = (z - 0.1) / rows
    parts = [box(f.main, (x, y - 0.025, z - 0.06), (0, -0.0125, 0.06)), *four_legs(f.second, (x, y), 0.06, 0.05)]
    for i in range(rows):
        base = 0.08 + i * height
        parts.append(box(f.main.shaded(1.12), (x - 0.04, 0.02, height - 0.02), (0, y / 2 - 0.015, base), 0.004))
        parts.append(box(f.second, (min(0.16, x * 0.4), 0.02, 0.02), (0, y / 2 - 0.01, base + height * 0.5)))
    return parts


def display_case(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    parts = [
        box(f.second, (x, y, z * 0.3), (0, 0, 0), 0.006),
        *four_legs(f.second, (x, y), z, 0.035, 0.0),
        box(f.second, (x, y, 0.05), (0, 0, z - 0.05)),
    ]
    parts.append(box(f.main.shaded(1.2), (x - 0.04, 0.02, z * 0.66), (0, -y / 2 + 0.015, z * 0.3)))
    for level in (z * 0.3, z * 0.3 + 0.36 * z):
        parts.append(box(f.main, (x - 0.04, y - 0.04, 0.02), (0, 0, level)))
        for u in np.arange(-x / 2 + 0.15, x / 2 - 0.1, 0.24):
            item = paint(str(rng.choice(BOOK_COLOURS)), seed=int(rng.integers(1000)))
            h = rng.uniform(0.12, 0.25)
            parts.append(
                turned(item, [(0, 0), (0.06, 0), (0.08, h * 0.4), (0.04, h), (0, h)], (float(u), 0.0, level + 0.02))
            )
    return parts


def fridge(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    doors = [
        box(f.main.shaded(1.08), (x - 0.01, 0.04, h - 0.01), (0, y / 2 - 0.03, b), 0.012)
        for b, h in ((0.05, z * 0.6), (0.05 + z * 0.6, z * 0.4 - 0.06))
    ]
    handles = [box(f.second, (0.03, 0.03, 0.4), (x / 2 - 0.07, y / 2 - 0.015, b)) for b in (z * 0.3, z * 0.66)]
    return [
        box(f.main, (x, y - 0.05, z - 0.02), (0, -0.025, 0.02), 0.01),
        *doors,
        *handles,
        box(f.second, (x - 0.04, y - 0.1, 0.03)),
    ]


def vending_machine(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rng = f.generator()
    parts = [
        box(f.main, (x, y - 0.04, z), (0, -0.02, 0), 0.02),
        box(paint("charcoal"), (x * 0.68, 0.02, z * 0.62), (-x * 0.1, y / 2 - 0.03, z * 0.3)),
    ]
    for row in range(5):
        for col in range(5):
            item = paint(str(rng.choice(["red", "yellow", "sky blue", "green", "orange", "white"])), emission=0.25)
            parts.append(
                box(
                    item,
                    (0.07, 0.02, 0.12),
                    (-x * 0.1 + (col - 2) * x * 0.125, y / 2 - 0.012, z * (0.33 + row * 0.118)),
                )
            )
    parts.append(
        picture(
            Material((0.5, 0.5, 0.5), "screen", emission=0.6, detail=0.6, seed=f.seed),
            x * 0.16,
            0.2,
            (x * 0.36, y / 2 - 0.015, z * 0.6),
        )
    )
    return [*parts, box(f.second, (x * 0.5, 0.02, 0.18), (-x * 0.1, y / 2 - 0.02, z * 0.08))]


def tv_stand(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    bays = max(2, round(x / 0.6))
    parts = [box(f.main, (x, y, 0.03), (0, 0, h), 0.004) for h in (0.1, z - 0.03)] + [
        box(f.main.shaded(0.6), (x, 0.02, z - 0.12), (0, -y / 2 + 0.01, 0.1))
    ]
    parts += [
        box(f.main, (0.03, y, z - 0.13), (u, 0, 0.1)) for u in np.linspace(-x / 2 + 0.015, x / 2 - 0.015, bays + 1)
    ]
    doors = [
        box(f.second, (x / bays - 0.05, 0.02, z - 0.17), ((i + 0.5) * x / bays - x / 2, y / 2 - 0.015, 0.13))
        for i in range(0, bays, 2)
    ]
    return [*parts, *doors, *four_legs(f.second, (x, y), 0.1, 0.04)]
