"""Crates, machines, signs, vessels. Every builder fills the size (x, y, z) it is given; +y is the front."""

import numpy as np

from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import (
    Finish,
    box,
    cylinder,
    ellipsoid,
    paint,
    picture,
    smooth,
    tube,
    turned,
)
from flymirage_core.worldgen.surfaces import Part, Vector


def carton(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    label = box(paint("chalk"), (x * 0.35, 0.004, z * 0.3), (-x * 0.2, y / 2, z * 0.5))
    return [box(f.main, (x, y, z), (0, 0, 0), 0.006), label]


def crate(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    slats = max(3, round(z / 0.16))
    parts = [box(f.main.shaded(0.7), (x - 0.05, y - 0.05, z - 0.02), (0, 0, 0.01))]
    for i in range(slats):
        parts.append(box(f.main, (x, y, z / slats - 0.03), (0, 0, (i + 0.1) * z / slats), 0.004))
    return parts + [
        box(f.main.shaded(1.15), (0.06, 0.06, z), (s * (x / 2 - 0.03), t * (y / 2 - 0.03), 0))
        for s in (-1, 1)
        for t in (-1, 1)
    ]


def basket(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    r = x / 2
    body = turned(f.main, smooth([(0, 0), (r * 0.8, 0), (r, z * 0.5), (r * 0.9, z - 0.03)]), (0, 0, 0), (1.0, y / x))
    rim = turned(
        f.second,
        [(r * 0.94, z - 0.05), (r * 0.94, z), (r * 0.82, z), (r * 0.8, z * 0.5), (0, z * 0.45)],
        scale=(1.0, y / x),
    )
    return [body, rim]


def bin_(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    body = turned(f.main, [(0, 0), (r * 0.85, 0), (r, z * 0.86)])
    return [body, turned(f.second, [(r, z * 0.86), (r, z * 0.92), (r * 0.75, z), (0, z)])]


def barrel(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    parts = [
        turned(f.main, smooth([(r * 0.9, 0), (r * 0.985, z * 0.5), (r * 0.9, z)], 8)),
        turned(f.main.shaded(0.8), [(r * 0.9, z - 0.02), (0, z - 0.02)]),
    ]
    return parts + [
        turned(f.second, [(r * 0.97, h), (r, h), (r, h + 0.04), (r * 0.97, h + 0.04)]) for h in (z * 0.3, z * 0.66)
    ]


def gas_cylinder(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    body = turned(
        f.main, smooth([(0, 0), (r, 0.01), (r, z * 0.3), (r, z * 0.72), (r * 0.5, z * 0.86), (0.035, z * 0.9)], 14)
    )
    return [
        body,
        cylinder(f.second, 0.03, z * 0.1, (0, 0, z * 0.9)),
        turned(f.second, [(r * 0.99, z * 0.4), (r + 0.0, z * 0.4), (r, z * 0.45)]),
    ]


def tank(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    r = min(x, y) / 2
    body = turned(
        f.main,
        smooth(
            [(0, 0.2), (r * 0.8, 0.24), (r, 0.4), (r, z * 0.6), (r, z - 0.25), (r * 0.6, z - 0.08), (0, z - 0.06)], 18
        ),
        scale=(x / 2 / r, y / 2 / r),
    )
    bands = [turned(f.second, [(r - 0.01, h), (r, h), (r, h + 0.05), (r - 0.01, h + 0.05)]) for h in (0.5, z - 0.5)]
    feet = [
        cylinder(f.second, 0.05, 0.3, (r * 0.65 * np.cos(a), r * 0.65 * np.sin(a), 0))
        for a in np.arange(4) * np.pi / 2 + 0.78
    ]
    return [body, *bands, *feet, cylinder(f.second, 0.09, 0.08, (0, 0, z - 0.08))]


def pipe_rack(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    pipes = [
        p
        for i, h in enumerate(np.linspace(0.3, z - 0.12, 4))
        for p in tube(f.main if i % 2 == 0 else f.second, [(-x / 2, 0, h), (x / 2, 0, h)], min(y / 2 - 0.02, 0.09))
    ]
    posts = [box(f.second.shaded(0.8), (0.06, 0.06, z), (s * x * 0.38, -y / 2 + 0.03, 0)) for s in (-1, 1)]
    return [*pipes, *posts]


def tool_chest(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    rows = max(3, round((z - 0.14) / 0.15))
    h = (z - 0.16) / rows
    parts = [box(f.main, (x, y - 0.02, z - 0.12), (0, -0.01, 0.12), 0.012)]
    parts += [
        cylinder(f.second, 0.05, 0.12, (s * (x / 2 - 0.08), t * (y / 2 - 0.1), 0)) for s in (-1, 1) for t in (-1, 1)
    ]
    for i in range(rows):
        parts.append(box(f.main.shaded(1.25), (x - 0.06, 0.02, h - 0.02), (0, y / 2 - 0.015, 0.14 + i * h)))
        parts.append(box(f.second, (x - 0.16, 0.02, 0.02), (0, y / 2 - 0.01, 0.14 + i * h + h * 0.6)))
    return parts


def toolbox(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    handle = tube(
        f.second,
        [(-x * 0.25, 0, z * 0.75), (-x * 0.25, 0, z - 0.015), (x * 0.25, 0, z - 0.015), (x * 0.25, 0, z * 0.75)],
        0.014,
    )
    return [
        box(f.main, (x, y, z * 0.62), (0, 0, 0), 0.008),
        box(f.main.shaded(1.2), (x, y * 0.9, z * 0.18), (0, 0, z * 0.6), 0.02),
        *handle,
    ]


def suitcase(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    body = box(f.main, (x, y, z - 0.26), (0, 0, 0.05), 0.045)
    ribs = [
        box(f.main.shaded(0.8), (0.02, 0.01, z - 0.36), (u, y / 2 - 0.003, 0.1))
        for u in np.linspace(-x * 0.3, x * 0.3, 4)
    ]
    handle = tube(
        f.second,
        [
            (-x * 0.2, -y * 0.2, z - 0.24),
            (-x * 0.2, -y * 0.2, z - 0.012),
            (x * 0.2, -y * 0.2, z - 0.012),
            (x * 0.2, -y * 0.2, z - 0.24),
        ],
        0.012,
    )
    return [
        body,
        *ribs,
        *handle,
        *(cylinder(f.second, 0.03, 0.06, (s * x * 0.35, t * y * 0.25, 0)) for s in (-1, 1) for t in (-1, 1)),
    ]


def traffic_cone(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x * 0.4
    rings = (
        (0.03, 0.4, f.main),
        (0.4, 0.6, paint("white")),
        (0.6, 0.72, f.main),
        (0.72, 0.82, paint("white")),
        (0.82, 1.0, f.main),
    )
    cone = [turned(m, [(r * (1 - 0.88 * a), a * z), (r * (1 - 0.88 * b), b * z)]) for a, b, m in rings]
    return [
        box(f.main.shaded(0.7), (x, x, 0.03), (0, 0, 0), 0.01),
        *cone,
        turned(f.main, [(r * 0.12, z - 0.004), (0, z)]),
    ]


def standing_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    face = Material((0.5, 0.5, 0.5), "painting", detail=0.6, seed=f.seed)
    board = box(f.main, (x, 0.05, z * 0.55), (0, 0, z * 0.45), 0.01)
    pages = picture(face, x - 0.08, z * 0.4, (0, 0.03, z * 0.48))
    posts = [box(f.second, (0.05, 0.05, z * 0.46), (s * (x / 2 - 0.06), 0, 0)) for s in (-1, 1)]
    return [board, pages, *posts, *(box(f.second, (0.08, y, 0.03), (s * (x / 2 - 0.06), 0, 0)) for s in (-1, 1))]


def kiosk(size: Vector, f: Finish) -> list[Part]:
    """A ticket or information machine: a leaning screen on a pedestal."""
    x, y, z = size
    screen = Material((0.5, 0.5, 0.5), "screen", emission=0.5, detail=0.6, seed=f.seed)
    body = box(f.main, (x, y - 0.03, z), (0, -0.015, 0), 0.03)
    band = box(f.second, (x - 0.02, 0.02, z * 0.12), (0, y / 2 - 0.025, z * 0.86), 0.005)
    slot = box(paint("charcoal"), (x * 0.6, 0.02, 0.08), (0, y / 2 - 0.02, z * 0.35))
    return [body, band, slot, picture(screen, x * 0.75, z * 0.3, (0, y / 2 - 0.008, z * 0.5))]


def turnstile(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    body = box(f.main, (x * 0.45, y, z), (-x * 0.27, 0, 0), 0.03)
    arms = [
        p
        for a in (0.0, 2.1, 4.2)
        for p in tube(
            f.second,
            [
                (-x * 0.05, 0, z * 0.72),
                (-x * 0.05 + 0.5 * x * (1 if a == 0 else 0.2), y * 0.3 * np.sin(a), z * 0.72 - 0.2 * z * (a > 0)),
            ],
            0.02,
        )
    ]
    return [body, *arms, box(paint("green", emission=0.6), (x * 0.2, 0.06, 0.01), (-x * 0.27, y * 0.3, z))]


def trolley(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    decks = [box(f.main, (x - 0.04, y - 0.04, 0.04), (0, 0, h), 0.008) for h in (0.12, z * 0.55)]
    posts = [
        box(f.second, (0.03, 0.03, z - 0.08), (s * (x / 2 - 0.02), t * (y / 2 - 0.02), 0.08))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    rail = [box(f.second, (0.03, y, 0.03), (s * (x / 2 - 0.02), 0, z - 0.03)) for s in (-1, 1)]
    wheels = [
        cylinder(paint("charcoal"), 0.04, 0.08, (s * (x / 2 - 0.06), t * (y / 2 - 0.06), 0))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    return [*decks, *posts, *rail, *wheels]


def pallet(size: Vector, f: Finish) -> list[Part]:
    """A pallet with sacks on it."""
    x, y, z = size
    boards = [box(f.second, (x, 0.1, 0.03), (0, v, 0.11)) for v in np.linspace(-y / 2 + 0.05, y / 2 - 0.05, 5)]
    feet = [box(f.second, (0.1, y, 0.11), (u, 0, 0)) for u in (-x / 2 + 0.05, 0, x / 2 - 0.05)]
    layers = max(1, round((z - 0.14) / 0.2))
    h = (z - 0.14) / layers
    sacks = [
        box(f.main.shaded(0.92 + 0.16 * ((i + j) % 2)), (x / 2 - 0.02, y - 0.06, h), (s * x / 4, 0, 0.14 + i * h), 0.06)
        for i in range(layers)
        for j, s in enumerate((-1, 1))
    ]
    return [*boards, *feet, *sacks]


def electrical_box(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    warning = box(paint("yellow"), (x * 0.35, 0.004, x * 0.3), (0, y / 2, z * 0.6))
    return [
        box(f.main, (x, y, z), (0, 0, 0), 0.01),
        warning,
        box(f.second, (0.02, 0.03, 0.1), (x * 0.38, y / 2 - 0.012, z * 0.4)),
    ]


def fire_extinguisher(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x * 0.42
    body = turned(
        f.main, smooth([(0, 0), (r, 0.005), (r, z * 0.3), (r, z * 0.66), (r * 0.5, z * 0.78), (0.025, z * 0.82)], 14)
    )
    hose = tube(paint("black"), [(0, 0, z * 0.88), (x * 0.42, 0, z * 0.8), (x * 0.44, 0, z * 0.35)], 0.014)
    return [
        body,
        cylinder(paint("black"), 0.025, z * 0.14, (0, 0, z * 0.8)),
        *hose,
        box(paint("black"), (0.14, 0.03, 0.03), (0, 0, z - 0.03)),
    ]


def bottle(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x / 2
    body = turned(
        f.main, smooth([(0, 0), (r, 0.005), (r, z * 0.3), (r, z * 0.55), (r * 0.4, z * 0.72), (r * 0.35, z * 0.9)], 14)
    )
    return [
        body,
        cylinder(f.second, r * 0.4, z * 0.12, (0, 0, z * 0.88)),
        turned(paint("cream"), [(r * 1.0, z * 0.2), (r, z * 0.45)]),
    ]


def pot(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    r = x * 0.4
    handles = [
        p
        for s in (-1, 1)
        for p in tube(
            f.second, [(s * r, -0.05, z * 0.55), (s * (x / 2 - 0.01), 0, z * 0.58), (s * r, 0.05, z * 0.55)], 0.01
        )
    ]
    lid = turned(f.main.shaded(1.15), smooth([(r, z * 0.72), (r * 0.6, z * 0.84), (0, z * 0.88)], 6))
    return [cylinder(f.main, r, z * 0.72), lid, cylinder(f.second, 0.02, z * 0.14, (0, 0, z * 0.86)), *handles]


def ball(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    return [ellipsoid(f.main, (x / 2, y / 2, z / 2), (0, 0, z / 2))]


def plain_box(size: Vector, f: Finish) -> list[Part]:
    """What a noun without a shape of its own becomes: a plain body with a trim, of plausible size."""
    x, y, z = size
    return [box(f.main, (x, y, z * 0.9), (0, 0, z * 0.1), 0.02), box(f.second, (x * 0.9, y * 0.9, z * 0.1))]
