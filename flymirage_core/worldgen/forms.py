"""More words for building: sweeps, lofts, tapered and stuffed bodies, plates, cables, cloth, crowns, wheels."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from flymirage_core.worldgen.materials import Material
from flymirage_core.worldgen.parts import box, ellipsoid, paint, turned
from flymirage_core.worldgen.surfaces import Float, Leaves, Part, Patch, Sheet, Vector, upright, vector

BEND_STEPS = 4
"""Straight pieces of a pipe's bend."""
LYING = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Turns a lathed part so that its axis runs along +x."""
FACING = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Turns a lathed part so that its axis points to the front, +y."""


def placed(part: Part, offset: ArrayLike = (0.0, 0.0, 0.0), rotation: Float | None = None) -> Part:
    """A part turned by ``rotation`` (3, 3) about the origin, then shifted by ``offset``."""
    turn = np.eye(3) if rotation is None else rotation
    spot = turn @ np.asarray(part.offset) + np.asarray(offset)
    return replace(part, offset=vector(spot), rotation=turn @ part.rotation)


def group(parts: Sequence[Part], offset: ArrayLike = (0.0, 0.0, 0.0), yaw: float = 0.0) -> list[Part]:
    """Parts turned about z by ``yaw`` radians, then shifted."""
    return [placed(p, offset, upright(yaw)) for p in parts]


def spun(part: Part, count: int, start: float = 0.0) -> list[Part]:
    """``count`` copies evenly round the z axis."""
    return [placed(part, rotation=upright(start + 2 * np.pi * k / count)) for k in range(count)]


def mirrored(part: Part) -> list[Part]:
    """A part, and its mirror image on the other side of the plane x = 0."""
    x, y, z = part.offset
    return [part, replace(part, offset=(-x, y, z), rotation=np.diag([-1.0, 1.0, 1.0]) @ part.rotation)]


def loft(material: Material, rings: ArrayLike, capped: bool | tuple[bool, bool] = True) -> Part:
    """A skin over closed rings (R, Q, 3), each counter-clockwise seen from where the rings lead to."""
    grid = np.asarray(rings, float)[:, ::-1]
    grid = np.concatenate([grid, grid[:, :1]], axis=1)
    ends = (capped, capped) if isinstance(capped, bool) else capped
    first, last = (np.broadcast_to(grid[i, :-1].mean(axis=0), grid[i].shape)[None] for i in (0, -1))
    return Part(Patch(np.concatenate([*([first] if ends[0] else []), grid, *([last] if ends[1] else [])])), material)


def ruled(material: Material, lower: ArrayLike, upper: ArrayLike) -> Part:
    """The surface between two lines (Q, 3). Its front is where ``lower`` runs left to right below ``upper``."""
    return Part(Patch(np.stack([np.asarray(upper, float), np.asarray(lower, float)])), material)


def rounded_ring(x: float, y: float, radius: float, steps: int = 3) -> Float:
    """(4 * steps, 2) a rectangle with rounded corners, counter-clockwise."""
    radius = min(radius, 0.499 * min(x, y))
    angle = np.linspace(0, np.pi / 2, steps) if radius > 0 else np.zeros(1)
    quarter = [(np.cos(a), np.sin(a)) for a in angle]
    corner = np.array([(radius * c, radius * s) for c, s in quarter])
    ring = []
    for k, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        c, s = np.cos(k * np.pi / 2).round(), np.sin(k * np.pi / 2).round()
        turned_corner = np.stack([c * corner[:, 0] - s * corner[:, 1], s * corner[:, 0] + c * corner[:, 1]], 1)
        ring.append(turned_corner + np.array([sx * (x / 2 - radius), sy * (y / 2 - radius)]))
    return np.concatenate(ring)


def tapered(
    material: Material,
    levels: Sequence[tuple[float, float, float]],
    base: Vector = (0.0, 0.0, 0.0),
    radius: float = 0.02,
    lean: Sequence[float] = (),
) -> Part:
    """A body of rounded rectangles: (x, y, z) at each level from the bottom up; ``lean`` shifts each level along y."""
    shift = [*lean, *[0.0] * (len(levels) - len(lean))]
    rings = []
    for (x, y, z), dy in zip(levels, shift, strict=True):
        ring = rounded_ring(x, y, radius)
        rings.append(np.column_stack([ring[:, 0], ring[:, 1] + dy, np.full(len(ring), z)]))
    return placed(loft(material, rings), base)


def cushion(material: Material, size: Vector, base: Vector = (0.0, 0.0, 0.0), pitch: float = 0.0) -> Part:
    """A stuffed pillow lying at ``base``: full in the middle, thin at its seam; ``pitch`` leans it back."""
    x, y, z = size
    u = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 9))
    angle = 2 * np.pi * np.arange(20) / 20
    outline = np.stack([np.cos(angle), np.sin(angle)], 1)
    power = np.abs(outline).max(axis=1, keepdims=True) ** 0.75
    outline = outline / power  # between a circle and a square
    fill = (1 - np.abs(u) ** 2.6) ** 0.5
    rings = [
        np.column_stack(
            [outline * np.array([x, y]) / 2 * (0.06 + 0.94 * f) / np.abs(outline).max(), 0 * angle + z / 2 * v]
        )
        for f, v in zip(fill, u, strict=True)
    ]
    c, s = np.cos(pitch), np.sin(pitch)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return placed(placed(loft(material, rings), (0, 0, z / 2)), base, turn)


def rounded_path(points: ArrayLike, bend: float) -> Float:
    """A polyline (P, 3) with its corners rounded by about ``bend`` metres."""
    p = np.asarray(points, float)
    if bend <= 0 or len(p) < 3:
        return p
    path = [p[0]]
    for before, at, after in zip(p, p[1:], p[2:], strict=False):
        a, b = before - at, after - at
        la, lb = float(np.linalg.norm(a)), float(np.linalg.norm(b))
        start, end = at + a * min(bend, 0.45 * la) / la, at + b * min(bend, 0.45 * lb) / lb
        for t in np.linspace(0, 1, BEND_STEPS + 1):
            path.append((1 - t) ** 2 * start + 2 * t * (1 - t) * at + t**2 * end)
    return np.array([*path, p[-1]])


def sweep(material: Material, section: ArrayLike, path: ArrayLike, scale: ArrayLike = 1.0) -> Part:
    """A closed section (S, 2), counter-clockwise, moved along a path (P, 3); its second axis starts nearest to up.

    ``scale`` (P,) grows or shrinks it on the way. A path that ends where it began makes a closed ring.
    """
    p, s = np.asarray(path, float), np.asarray(section, float)
    closed = bool(np.abs(p[0] - p[-1]).max() < 1e-9)
    step = np.diff(p, axis=0)
    step /= np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12)
    tangent = np.concatenate([step[:1], step[:-1] + step[1:], step[-1:]])
    if closed:
        tangent[0] = tangent[-1] = step[0] + step[-1]
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    up = np.array([0.0, 0.0, 1.0]) if abs(tangent[0, 2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    rings = []
    for t, spot, k in zip(tangent, p, np.broadcast_to(scale, len(p)), strict=True):
        up = up - t * (up @ t)
        up /= max(float(np.linalg.norm(up)), 1e-12)
        rings.append(spot + k * (s[:, :1] * np.cross(up, t) + s[:, 1:] * up))
    return loft(material, rings, not closed)


def circle(radius: float, sides: int = 10) -> Float:
    """(sides, 2) counter-clockwise."""
    angle = 2 * np.pi * np.arange(sides) / sides
    return radius * np.stack([np.cos(angle), np.sin(angle)], 1)


def pipe(material: Material, points: ArrayLike, radius: float, bend: float = 0.0) -> Part:
    """A round bar or pipe along a polyline (P, 3), its corners rounded by ``bend`` metres."""
    return sweep(material, circle(radius), rounded_path(points, bend))


def hoop(material: Material, radius: float, thick: float, centre: Vector = (0.0, 0.0, 0.0), tall: float = 0.0) -> Part:
    """A ring round a vertical axis; ``thick`` is the radius of its bar, ``tall`` > 0 makes the bar a flat band."""
    angle = np.linspace(0, 2 * np.pi, 25)
    path = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], 1)
    section = circle(thick, 8) if tall <= 0 else rounded_ring(2 * thick, tall, 0)
    return placed(sweep(material, section, path), centre)


def plate(material: Material, outline: ArrayLike, thick: float, centre: Vector = (0.0, 0.0, 0.0)) -> Part:
    """A board cut to an outline (Q, 2) of (x, z), counter-clockwise seen from -y, star-shaped about its mean.

    Its middle is at ``centre``; it is ``thick`` along y.
    """
    ring = np.asarray(outline, float)[::-1]
    rings = [np.column_stack([ring[:, 0], np.full(len(ring), y), ring[:, 1]]) for y in (-thick / 2, thick / 2)]
    return placed(loft(material, rings), centre)


def cable(material: Material, start: ArrayLike, end: ArrayLike, sag: float, radius: float = 0.01) -> Part:
    """A hanging cable or rope; ``sag`` metres lower in the middle than the straight line."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    t = np.linspace(0, 1, 13)[:, None]
    return sweep(material, circle(radius, 8), a + t * (b - a) - [0, 0, sag] * (4 * t * (1 - t)))


def cloth(
    material: Material, width: float, height: float, base: Vector, folds: float = 0.12, deep: float = 0.05
) -> Part:
    """A hanging curtain or banner that faces +y: folds of ``folds`` metres pitch, ``deep`` metres deep at the hem."""
    u = np.linspace(-width / 2, width / 2, max(9, int(width / folds * 8) + 1))
    rows = []
    for z, share in ((0.0, 1.0), (0.35 * height, 0.8), (0.75 * height, 0.55), (height, 0.4)):
        y = share * deep / 2 * np.sin(2 * np.pi * u / folds + 0.7 * np.sin(5 * u) + (1 - share))
        rows.append(np.column_stack([u, y, np.full(len(u), z)]))
    return placed(Part(Patch(np.array(rows[::-1])), material), base)


def wheel(tyre: Material, rim: Material, radius: float, width: float, centre: Vector) -> list[Part]:
    """A tyre with a hub, its axle along x."""
    w = width / 2
    round_tyre = [(0.62, -w), (0.9, -w), (1.0, -0.6 * w), (1.0, 0.6 * w), (0.9, w), (0.62, w)]
    hub = [(0.0, -0.8 * w), (0.62, -0.8 * w), (0.64, 0.0), (0.62, 0.8 * w), (0.2, 0.5 * w), (0.0, 0.85 * w)]
    return [
        placed(turned(m, [(r * radius, h) for r, h in form]), centre, LYING)
        for m, form in ((tyre, round_tyre), (rim, hub))
    ]


def crown(
    material: Material,
    blobs: Sequence[tuple[Vector, Vector]],
    leaf: tuple[float, float],
    count: int,
    rng: np.random.Generator,
    solid: float = 0.72,
) -> list[Part]:
    """Leaves lying on the outside of several ellipsoids (radii, centre): the head of a tree, bush or hedge.

    ``leaf`` is (length, width); a dark body of ``solid`` of each radius fills it, so that no light comes through.
    """
    weight = np.array([r[0] * r[1] + r[0] * r[2] + r[1] * r[2] for r, _ in blobs])
    leaves, cores = [], []
    for (radii, centre), share in zip(blobs, weight / weight.sum(), strict=True):
        number = max(12, int(count * share))
        out = rng.normal(size=(number, 3))
        out /= np.linalg.norm(out, axis=1, keepdims=True)
        centres = out * np.asarray(radii) * rng.uniform(0.72, 1.0, (number, 1)) + np.asarray(centre)
        facing = out + rng.normal(size=(number, 3)) * 0.45 + [0.0, 0.0, 0.25]
        lengths = np.cross(facing, rng.normal(size=(number, 3)))
        lengths *= leaf[0] / 2 / np.maximum(np.linalg.norm(lengths, axis=1, keepdims=True), 1e-9)
        widths = np.cross(facing, lengths)
        widths *= leaf[1] / 2 / np.maximum(np.linalg.norm(widths, axis=1, keepdims=True), 1e-9)
        leaves.append((centres, lengths * rng.uniform(0.7, 1.2, (number, 1)), widths))
        if solid > 0:
            core = (radii[0] * solid, radii[1] * solid, radii[2] * solid)
            cores.append(ellipsoid(material.shaded(0.45), core, centre))
    return [Part(Leaves(*(np.concatenate(a) for a in zip(*leaves, strict=True))), material), *cores]


def two_sided(part: Part, shade: float = 0.8) -> list[Part]:
    """A cloth's or pane's patch, and its back in a darker tone."""
    assert isinstance(part.surface, Patch)
    back = Part(Patch(part.surface.grid[:, ::-1]), part.material.shaded(shade), part.offset, part.rotation)
    return [part, back]


def skin(material: Material, rows: ArrayLike, shade: float = 0.8) -> list[Part]:
    """A two-sided cloth through rows of points (R, Q, 3); its front is cross(down the rows, along a row)."""
    return two_sided(Part(Patch(np.asarray(rows, float)), material), shade)


def sign(
    words: str, width: float, height: float, base: Vector, ground: str = "white", ink: str = "black", glow: float = 0.0
) -> Part:
    """Lettering that faces +y, the bottom's middle at ``base``; "|" starts a new line."""
    x, y, z = base
    fine = float(np.clip(height / len(words.split("|")) * 2.2, 0.12, 0.7))
    face = replace(paint(ground, "text", emission=glow, detail=fine), ink=paint(ink).colour, words=words)
    return Part(Sheet((x + width / 2, y, z), (-width, 0.0, 0.0), (0.0, 0.0, height)), face)


def patterned(ground: str, texture: str, ink: str = "black", detail: float = 0.6, seed: int = 0) -> Material:
    """A material of two colours: "hazard", "stripes", "checks", "grille", "dial", "buttons"."""
    return replace(paint(ground, texture, detail=detail, seed=seed), ink=paint(ink).colour)


def frame_of(material: Material, size: Vector, bar: float, base: Vector = (0.0, 0.0, 0.0)) -> list[Part]:
    """The twelve edges of a box as square bars: racks, cages, scaffolds."""
    x, y, z = size
    bx, by, bz = base
    parts = [
        box(material, (bar, bar, z), (bx + s * (x - bar) / 2, by + t * (y - bar) / 2, bz))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    for h in (0.0, z - bar):
        parts += [box(material, (x - 2 * bar, bar, bar), (bx, by + t * (y - bar) / 2, bz + h)) for t in (-1, 1)]
        parts += [box(material, (bar, y - 2 * bar, bar), (bx + s * (x - bar) / 2, by, bz + h)) for s in (-1, 1)]
    return parts


def struts(material: Material, points: Sequence[ArrayLike], radius: float) -> list[Part]:
    """Separate straight bars between successive points."""
    return [pipe(material, np.array([a, b], float), radius) for a, b in pairwise(points)]


def bolts(material: Material, radius: float, count: int, size: float, height: float) -> list[Part]:
    """Bolt heads in a circle round z at ``height``."""
    head = turned(material, [(0, 0), (size, 0), (size, size), (0, size)], (radius, 0.0, height))
    return spun(head, count)


def hull(material: Material, stations: Sequence[tuple[float, float, float, float]], radius: float = 0.1) -> Part:
    """A body along y through rounded sections: (y, width, bottom, top) from back to front: vehicles, boats, ducts."""
    rings = []
    for y, width, low, high in stations:
        ring = rounded_ring(high - low, width, radius)
        rings.append(np.column_stack([ring[:, 1], np.full(len(ring), y), ring[:, 0] + (low + high) / 2]))
    return loft(material, rings)
