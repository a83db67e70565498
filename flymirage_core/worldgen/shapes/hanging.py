"""Lights, signs and things to look at that hang from ceilings: z runs from their bottom up to the ceiling.

Sizes are nominal: `fitted` makes them exact. +y is the front.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from flymirage_core.worldgen.forms import (
    cable,
    cloth,
    cushion,
    hoop,
    hull,
    loft,
    pipe,
    placed,
    plate,
    rounded_ring,
    sign,
    spun,
    two_sided,
)
from flymirage_core.worldgen.parts import Finish, box, ellipsoid, paint, smooth, turned
from flymirage_core.worldgen.surfaces import Part, Patch, Vector

STEEL, DARK, WHITE, BRASS = paint("silver", "brushed"), paint("black"), paint("white"), paint("brass", "brushed")
GLOW = paint("cream", emission=1.6)


def chandelier(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    stem = [
        turned(
            f.main,
            smooth([(0, 0.02), (0.05, 0.06), (0.03, 0.12), (0.09, 0.2), (0.03, 0.28), (0.04, 0.4), (0.012, 0.46)], 16),
        ),
        pipe(f.main, [(0, 0, 0.45), (0, 0, z)], 0.01),
        turned(f.main, [(0, z - 0.05), (0.06, z - 0.01), (0.06, z), (0, z)]),
    ]
    arms = [p for k in range(8) for p in (_turned_by(q, k * np.pi / 4) for q in _candle_arm(f, 0.4, 0.26))]
    crystals = [
        p
        for k in range(8)
        for p in (
            _turned_by(
                cable(paint("chalk", "glass", 0.25), (0.4, 0, 0.24), (0.283, 0.283, 0.24), 0.08, 0.006), k * np.pi / 4
            ),
        )
    ]
    drops = [
        *spun(ellipsoid(paint("chalk", "glass", 0.3), (0.012, 0.012, 0.03), (0.3, 0, 0.1)), 8, 0.2),
        ellipsoid(paint("chalk", "glass", 0.3), (0.03, 0.03, 0.04), (0, 0, 0.0)),
    ]
    return [*stem, *arms, *crystals, *drops]


def _candle_arm(f: Finish, reach: float, base: float) -> list[Part]:
    arm = pipe(
        f.main,
        [(0.03, 0, base - 0.04), (0.5 * reach, 0, base - 0.16), (reach, 0, base - 0.1), (reach, 0, base)],
        0.009,
        0.12,
    )
    cup = turned(f.main, [(0, 0), (0.03, 0.0), (0.045, 0.02), (0, 0.02)], (reach, 0, base))
    candle = turned(paint("ivory"), [(0.014, base + 0.02), (0.014, base + 0.12), (0, base + 0.12)], (reach, 0, 0))
    return [
        arm,
        cup,
        candle,
        turned(GLOW.shaded(1.2), smooth([(0, base + 0.11), (0.02, base + 0.14), (0, base + 0.19)], 6), (reach, 0, 0)),
    ]


def _turned_by(part: Part, angle: float) -> Part:
    c, s = np.cos(angle), np.sin(angle)
    return placed(part, rotation=np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]))


def paper_lantern(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    shade = replace(f.main, emission=0.75)
    form = [(0.09, 0.0)]
    for t in np.linspace(0.03, 0.97, 17):
        form.append((0.09 + 0.16 * np.sin(np.pi * t) ** 0.6, 0.42 * t))
    ribs = [hoop(f.main.shaded(0.7), r, 0.003, (0, 0, h)) for r, h in form[1:-1:2]]
    return [
        turned(shade, [*form, (0.09, 0.42)]),
        *ribs,
        hoop(DARK, 0.09, 0.006, (0, 0, 0.0)),
        hoop(DARK, 0.09, 0.006, (0, 0, 0.42)),
        pipe(DARK, [(0, 0, 0.3), (0, 0, z)], 0.004),
        turned(WHITE, [(0.04, z - 0.02), (0.04, z), (0, z)]),
    ]


def ceiling_fan(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    body = [
        pipe(f.second, [(0, 0, 0.2), (0, 0, z)], 0.014),
        turned(f.second, smooth([(0, 0.1), (0.09, 0.11), (0.11, 0.16), (0.08, 0.22), (0, 0.23)], 10)),
        turned(f.second, [(0, z - 0.06), (0.05, z - 0.05), (0.07, z), (0, z)]),
        turned(GLOW, smooth([(0, 0.02), (0.06, 0.03), (0.08, 0.08), (0.075, 0.11)], 7)),
    ]
    twist = np.array([[1.0, 0, 0], [0, 0.98, -0.2], [0, 0.2, 0.98]])
    blade = placed(
        loft(
            f.main,
            np.array(
                [
                    np.column_stack([np.full(12, u), rounded_ring(w, 0.01, 0.004)])
                    for u, w in ((0.16, 0.1), (0.3, 0.14), (0.6, 0.15), (0.65, 0.1))
                ]
            ),
        ),
        (0, 0, 0.15),
        twist,
    )
    return [
        *body,
        *spun(blade, 5),
        *spun(box(f.second, (0.12, 0.03, 0.012), (0.13, 0, 0.145)), 5),
        pipe(BRASS, [(0.05, 0.05, 0.1), (0.05, 0.05, 0.0)], 0.003),
    ]


def hanging_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    high = z * 0.6
    words, ground, ink = (
        ("PLATFORM 3", "blue", "white"),
        ("EXIT  >", "forest green", "white"),
        ("GATES B 1-9", "yellow", "black"),
        ("TOILETS", "slate grey", "white"),
        ("<  CAFE", "burgundy", "cream"),
    )[f.seed % 5]
    face = [
        sign(words, x - 0.06, high - 0.06, (0, y / 2 + 0.004, 0.03), ground, ink, 0.35),
        placed(
            sign(words, x - 0.06, high - 0.06, (0, y / 2 + 0.004, 0.03), ground, ink, 0.35),
            rotation=np.diag([-1.0, -1.0, 1.0]),
        ),
    ]
    return [
        box(f.main, (x, y, high), (0, 0, 0), 0.01),
        *face,
        *(pipe(STEEL, [(s * x * 0.38, 0, high), (s * x * 0.38, 0, z)], 0.01) for s in (-1, 1)),
    ]


def banner(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    words = ("WELCOME", "SALE", "FESTIVAL", "GO TEAM", "ART WEEK")[f.seed % 5]
    hang = two_sided(cloth(f.main, x, z - 0.04, (0, 0, 0.0), x * 1.6, 0.02), 1.0)
    lettering = sign(
        "|".join(words.split(" ")), x * 0.8, z * 0.2 * len(words.split(" ")), (0, 0.018, z * 0.45), "white", "black"
    )
    ink = "cream" if sum(f.main.colour) < 0.9 else "black"
    lettering = replace(lettering, material=replace(lettering.material, colour=f.main.colour, ink=paint(ink).colour))
    return [
        *hang,
        lettering,
        pipe(BRASS, [(-x / 2, 0, z - 0.03), (x / 2, 0, z - 0.03)], 0.014),
        box(paint(ink, "fabric"), (x * 0.8, 0.045, 0.03), (0, 0, z * 0.3)),
        box(paint(ink, "fabric"), (x * 0.8, 0.045, 0.03), (0, 0, z * 0.86)),
    ]


def lighting_truss(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    base, w = z * 0.5, z * 0.42
    corner = [(-y * 0.4, base), (y * 0.4, base), (-y * 0.4, base + w), (y * 0.4, base + w)]
    bars = [pipe(f.main, [(-x / 2, v, h), (x / 2, v, h)], 0.02) for v, h in corner]
    u = np.linspace(-x / 2, x / 2, 2 * max(4, round(x / 0.5)) + 1)
    zig = [
        pipe(f.main, [(a, *corner[i][:1], corner[i][1]), (b, corner[j][0], corner[j][1])], 0.009)
        for k, (a, b) in enumerate(pairwise(u))
        for i, j in (((0, 2), (1, 3)) if k % 2 == 0 else ((2, 0), (3, 1)))
    ]
    lamps = [
        p
        for at, c in zip(np.linspace(-x * 0.38, x * 0.38, 4), ("cream", "coral", "sky blue", "cream"), strict=True)
        for p in _stage_lamp((float(at), 0.0, base), c)
    ]
    return [
        *bars,
        *zig,
        *lamps,
        *(pipe(STEEL, [(s * x * 0.4, 0, base + w), (s * x * 0.4, 0, z)], 0.012) for s in (-1, 1)),
    ]


def _stage_lamp(top: Vector, colour: str) -> list[Part]:
    tilt = np.array([[1.0, 0, 0], [0, 0.87, -0.5], [0, 0.5, 0.87]])
    can = placed(
        turned(DARK, [(0, 0.1), (0.05, 0.1), (0.065, 0.04), (0.065, -0.1), (0.058, -0.1)]),
        (top[0], top[1], top[2] - 0.14),
        tilt,
    )
    glow = placed(
        turned(paint(colour, emission=2.2), [(0, -0.09), (0.058, -0.09)]), (top[0], top[1], top[2] - 0.14), tilt
    )
    return [can, glow, pipe(DARK, [(top[0], top[1], top[2]), (top[0], top[1], top[2] - 0.12)], 0.01)]


def mirror_ball(size: Vector, f: Finish) -> list[Part]:
    z, r = size[2], 0.2
    rng = f.generator()
    parts = [
        pipe(DARK, [(0, 0, 2 * r), (0, 0, z)], 0.006),
        turned(DARK, [(0, z - 0.05), (0.05, z - 0.05), (0.05, z), (0, z)]),
    ]
    for k, v in enumerate(np.linspace(-1.4, 1.4, 13)):
        tone = paint("silver").shaded(float(rng.uniform(0.5, 1.5)))
        a, b = v - 0.1, v + 0.1
        count = max(6, int(26 * np.cos(v)))
        for i in range(count):
            if (i + k) % 2 == 0:
                t = np.array([i, i + 1]) * 2 * np.pi / count
                corners = [
                    [(r * np.cos(h) * np.cos(x), r * np.cos(h) * np.sin(x), r + r * np.sin(h)) for x in t[::-1]]
                    for h in (a, b)
                ]
                parts.append(Part(Patch(np.array(corners)), tone.shaded(float(rng.uniform(0.6, 1.5)))))
    return [*parts, ellipsoid(paint("slate grey", "brushed"), (r * 0.985,) * 3, (0, 0, r))]


def punching_bag(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    high = z * 0.72
    bag = turned(
        f.main, [(0, 0), *smooth([(0.12, 0.0), (0.18, 0.05), (0.18, high - 0.06), (0.13, high)], 10), (0, high)]
    )
    bands = [hoop(f.second, 0.182, 0.008, (0, 0, h), 0.05) for h in (0.15, high * 0.5, high - 0.14)]
    chains = spun(pipe(STEEL, [(0.13, 0, high), (0.0, 0, high + 0.2)], 0.007), 4)
    return [bag, *bands, *chains, pipe(STEEL, [(0, 0, high + 0.2), (0, 0, z)], 0.01)]


def hanging_chair(size: Vector, f: Finish) -> list[Part]:
    """A woven egg on a cord."""
    z = size[2]
    weave = replace(f.main, texture="wicker", detail=0.7)
    angle = np.linspace(0.62 * np.pi, 2.38 * np.pi, 25)
    rows = []
    for h in np.linspace(0.02, 0.98, 12):
        r = 0.44 * np.sin(np.pi * h**0.85) ** 0.75
        rows.append([(r * np.cos(a), r * np.sin(a), 1.25 * h) for a in angle])
    egg = two_sided(Part(Patch(np.array(rows)[:, ::-1]), weave), 0.85)
    rim = [pipe(weave.shaded(0.8), [row[i] for row in rows], 0.022) for i in (0, -1)]
    seat = [
        cushion(paint(("ivory", "terracotta", "sage")[f.chosen(3)], "fabric"), (0.62, 0.58, 0.18), (0, -0.02, 0.22)),
        cushion(
            paint(("ivory", "terracotta", "sage")[f.chosen(3)], "fabric"), (0.56, 0.5, 0.14), (0, -0.22, 0.36), 1.2
        ),
    ]
    return [*egg, *rim, *seat, pipe(STEEL, [(0, 0, 1.22), (0, 0, z)], 0.014), hoop(STEEL, 0.04, 0.01, (0, 0, 1.26))]


def model_aeroplane(size: Vector, f: Finish) -> list[Part]:
    z = size[2]
    body = hull(
        f.main,
        [
            (-0.48, 0.03, 0.1, 0.14),
            (-0.3, 0.07, 0.08, 0.17),
            (0.1, 0.12, 0.05, 0.2),
            (0.35, 0.12, 0.06, 0.19),
            (0.46, 0.08, 0.08, 0.16),
        ],
        0.04,
    )
    wings = [box(f.second, (1.2, 0.2, 0.012), (0, 0.12, h), 0.005) for h in (0.06, 0.24)]
    stays = [
        pipe(f.second.shaded(0.7), [(u, 0.12 + v, 0.06), (u, 0.12 + v, 0.25)], 0.006)
        for u in (-0.45, -0.2, 0.2, 0.45)
        for v in (-0.06, 0.06)
    ]
    tail = [
        box(f.second, (0.4, 0.1, 0.008), (0, -0.44, 0.13)),
        plate(f.second, [(-0.004, 0.12), (0.004, 0.12), (0.004, 0.26), (-0.004, 0.26)], 0.1, (0, -0.45, 0)),
    ]
    prop = [
        box(paint("honey brown", "wood"), (0.03, 0.012, 0.3), (0, 0.48, -0.03)),
        ellipsoid(STEEL, (0.025,) * 3, (0, 0.48, 0.12)),
    ]
    wheels = [pipe(DARK, [(s * 0.1 - 0.01, 0.22, 0.0), (s * 0.1 + 0.01, 0.22, 0.0)], 0.035) for s in (-1, 1)]
    return [
        body,
        *wings,
        *stays,
        *tail,
        *prop,
        *wheels,
        *(pipe(DARK, [(0, v, 0.2), (0, 0.08, z)], 0.003) for v in (-0.3, 0.35)),
    ]


def exit_sign(size: Vector, f: Finish) -> list[Part]:
    x, y, z = size
    high = z * 0.72
    faces = [sign("EXIT", x - 0.02, high - 0.02, (0, y / 2 + 0.003, 0.01), "green", "white", 0.9)]
    return [
        box(paint("forest green"), (x, y, high), (0, 0, 0), 0.006),
        *faces,
        placed(faces[0], rotation=np.diag([-1.0, -1.0, 1.0])),
        *(pipe(STEEL, [(s * x * 0.3, 0, high), (s * x * 0.3, 0, z)], 0.006) for s in (-1, 1)),
    ]


def string_of_lights(size: Vector, f: Finish) -> list[Part]:
    x, _, z = size
    sag = z - 0.14
    wire = cable(DARK, (-x / 2, 0, z - 0.01), (x / 2, 0, z - 0.01), sag, 0.006)
    bulbs = []
    for t in np.linspace(0.04, 0.96, max(8, round(x / 0.24))):
        at = (float(x * (t - 0.5)), 0.0, float(z - 0.01 - sag * 4 * t * (1 - t)))
        bulbs += [
            turned(DARK, [(0.014, -0.03), (0.014, 0.0), (0, 0.0)], at),
            turned(paint("cream", emission=2.6), smooth([(0, -0.12), (0.032, -0.085), (0.014, -0.03)], 6), at),
        ]
    return [wire, *bulbs]
