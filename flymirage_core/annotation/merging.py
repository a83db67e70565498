"""Parts joined to objects: one rule a function, each for a kind of thing that colour alone falls apart.

No rule joins what stands on different supports (`Part.thing`), but for lamps whose pole was lost.
"""

import math
from itertools import combinations
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from flymirage_core.annotation.colours import colour_step
from flymirage_core.annotation.parts import Part, PartSet

MAX_ROUNDS: Final = 12
BLUR: Final = 0.03
"""Metres by which fused points err: a voxel."""
NEAR: Final = 0.05
"""Metres within which things touch, or lie inside of each other's plan, blur on both sides included."""
MOST: Final = 0.7
"""Share of a part's points that counts as most of it."""
NEARLY_ALL: Final = 0.85
SUPPORT_AREA: Final = 0.13
"""Square metres from which a level face carries things."""
SUPPORT_SHARE: Final = 0.7
"""What stands on a thing is smaller in plan than this share of it; else it is its upper part."""
MAX_STANDING_DEPTH: Final = 0.5
"""Metres that a carrier may rise above the foot of what it carries: the back of a desk, not the room round a chair."""
SAME_COLOUR: Final = 9.0
"""Colour step up to which touching parts are one thing."""
MIN_CONTACT: Final = 4
"""Edges between two parts from which they touch ..."""
MIN_CONTACT_SHARE: Final = 0.02
"""... and as a share of the smaller part's points."""
IDENTICAL_COLOUR: Final = 3.0
"""Colour step up to which even what stands on a thing is a part of it."""
SIMILAR_COLOUR: Final = 14.0
"""Colour step up to which parts that nearly touch are one thing."""
JOINT_GAP: Final = 0.10
"""Metres that a joint too thin to be seen may bridge."""
MIN_JOINT_POINTS: Final = 3
LARGE: Final = 1.0
"""Metres; two things that are both longer are never bridged."""
MAX_ABSORBED: Final = 0.34
"""Metres; larger pieces are not swallowed by what is round them: books in a shelf are, a chair under a table is not."""
STACK_DEPTH: Final = 0.12
"""Metres that the upper of two stacked parts may reach into the lower."""
CENTRED: Final = 0.2
"""Share of the smaller part's width within which two are centred on each other."""
COVER_SHARE: Final = 0.6
"""Of the lower part's plan, that a cover has: a mattress on its frame."""
MIN_COVER_AREA: Final = 0.25
"""Square metres; smaller overhanging parts are lids, shades and things on things."""
FOOT_CLEARANCE: Final = 0.25
CANOPY_CLEARANCE: Final = 1.0
MAX_POLE_SHARE: Final = 0.35
"""Of a canopy's plan, that what carries it has at most."""
SHADE_CLEARANCE: Final = 0.3
MAX_POLE_GAP: Final = 1.1
"""Metres between a foot on the floor and a shade whose pole was lost."""
MAX_TABLE_POLE_GAP: Final = 0.25
"""The same on a table."""
MAX_CANOPY_GAP: Final = 0.5
"""The same under a canopy that is much wider than its pole."""
FAR_OFF: Final = 0.5
"""Metres beyond a shade's own width, from whose middle a foot is not looked at."""
POLE_SLANT: Final = 0.12
"""Metres between the middles of foot and shade."""
MAX_LAMP_SIDE: Final = 0.75
MIN_CARRIER_AREA: Final = 0.1
"""Square metres in plan from which a third thing between foot and shade may carry the shade."""
THIN: Final = 0.12
"""Metres of the shorter side in plan of a panel: a screen on its keyboard, the frame of a trolley."""
MIN_THIN_CONTACT: Final = 8
THIN_MARGIN: Final = 0.08
MAX_CONTENT: Final = 0.5
"""Metres; larger things in a shelf are things of their own."""
MIN_CONTAINER: Final = 3
"""A container has so many times the points of its content."""
ENCLOSED: Final = 0.5
"""At the height of its contents a shelf has this share of the points a metre that it has over all; a table has legs."""
MAX_LEG_POINTS: Final = 400
MAX_LEG_SIDE: Final = 0.25
MAX_LEG_HEIGHT: Final = 1.0
MAX_LEG_CLEARANCE: Final = 0.45
MAX_BODY_CLEARANCE: Final = 1.3
"""Metres above the floor; higher things have no legs."""
MIN_FRAME: Final = 0.4
"""Metres of length and of height of the frames of a rack, ..."""
MAX_FRAME_GAP: Final = 1.0
"""... which stand so near behind each other, ..."""
MAX_FRAME_SHIFT: Final = 0.1
"""... so exactly in line ..."""
FRAME_RATIO: Final = 1.25
"""... and differ by no more."""
GAP_COST: Final = 20.0
"""Colour step that a metre between a leg and the body above it weighs as much as."""


def merge_parts(parts: PartSet) -> None:
    """Apply all rules, in this order."""
    for _ in range(MAX_ROUNDS):
        if not _join_touching(parts):
            break
    _join_lost_poles(parts)
    for _ in range(3):
        if not _join_lost_joints(parts):
            break
    _join_thin_pieces(parts)
    _join_frames(parts)
    _join_contents(parts)
    _join_legs(parts)


def _join_touching(parts: PartSet) -> bool:
    """One round over all contacts, the longest first; whether anything was joined."""
    changed = False
    for i, j, contact in parts.contacts():
        if i not in parts.parts or j not in parts.parts:
            continue
        a, b = parts.parts[i], parts.parts[j]
        lower, upper = (a, b) if a.centre[2] < b.centre[2] else (b, a)
        step = float(colour_step(a.colour, b.colour))
        stands = _stands_on(upper, lower)
        if (
            _same_thing(a, b, step, contact, stands and step > IDENTICAL_COLOUR)
            or _piece_inside(a, b, stands, upper)
            or (not stands and (_stacked(lower, upper) or _held_up(lower, upper, NEAR)))
        ):
            parts.join(i, j)
            changed = True
    return changed


def _stands_on(upper: Part, lower: Part) -> bool:
    """Whether ``upper`` is carried by a broad level face of ``lower`` that is a good deal larger."""
    area, height = lower.table
    bottom = upper.lower[2]
    return bool(
        area > SUPPORT_AREA
        and bottom > height - 2 * BLUR
        and bottom > lower.upper[2] - MAX_STANDING_DEPTH
        and upper.footprint.area < SUPPORT_SHARE * lower.footprint.area
        and lower.footprint.share_inside(upper.points, NEAR) > MOST
    )


def _same_thing(a: Part, b: Part, step: float, contact: int, kept_apart: bool) -> bool:
    touching = contact >= max(MIN_CONTACT, MIN_CONTACT_SHARE * min(len(a), len(b)))
    return step < SAME_COLOUR and touching and not kept_apart


def _piece_inside(a: Part, b: Part, stands: bool, upper: Part) -> bool:
    """A small part within the box of a larger one: books in a shelf, knobs, patterns."""
    large, small = (a, b) if len(a) >= len(b) else (b, a)
    if small.extent.max() >= MAX_ABSORBED or (stands and small is upper and small.upper[2] > large.upper[2] - BLUR):
        return False
    within = small.upper[2] < large.upper[2] + BLUR and small.lower[2] > large.lower[2] - BLUR
    return bool(within and large.footprint.share_inside(small.points, BLUR) > NEARLY_ALL)


def _stacked(lower: Part, upper: Part) -> bool:
    """One above the other and centred (lamp, plant, television's foot), or covering it (mattress on its frame)."""
    if upper.lower[2] <= lower.upper[2] - STACK_DEPTH:
        return False
    a, b = lower.footprint, upper.footprint
    if np.linalg.norm(a.centre - b.centre) < CENTRED * min(a.size.max(), b.size.max()) + NEAR:
        return True
    if b.area > COVER_SHARE * a.area and a.share_inside(upper.points, NEAR) > MOST:
        return True
    overhung = upper.lower[2] < lower.upper[2] + JOINT_GAP and min(a.area, b.area) > MIN_COVER_AREA
    return bool(overhung and b.share_inside(lower.points, NEAR) > NEARLY_ALL)


def _held_up(pole: Part, canopy: Part, gap: float) -> bool:
    """A parasol's cloth or a tree's crown round the upper end of its pole, of which ``gap`` metres may be lost."""
    if pole.clearance > FOOT_CLEARANCE or canopy.clearance < CANOPY_CLEARANCE or pole.upper[2] < canopy.lower[2] - gap:
        return False
    a, b = pole.footprint, canopy.footprint
    centred = np.linalg.norm(a.centre - b.centre) < CENTRED * b.size.max() + NEAR
    return bool(centred and a.area < MAX_POLE_SHARE * b.area and b.share_inside(pole.points, NEAR) > NEARLY_ALL)


def _join_lost_poles(parts: PartSet) -> None:
    """A foot on the floor and a shade right above it, whose pole no view resolved."""
    order = sorted(parts.parts, key=lambda k: (float(parts.parts[k].centre[2]), k))
    middles = np.array([parts.parts[k].centre[:2] for k in order]).reshape(-1, 2)  # (P, 2)
    reaches = np.array([float(np.hypot(*parts.parts[k].extent[:2])) for k in order]) + FAR_OFF  # (P,)
    for n, i in enumerate(order):
        if i not in parts.parts or not _is_foot(parts.parts[i]):
            continue
        away = np.linalg.norm(middles[n + 1 :] - parts.parts[i].centre[:2], axis=1)
        for j in (order[n + 1 + m] for m in np.flatnonzero(away < reaches[n + 1 :])):
            if j in parts.parts and _one_stand(parts.parts[i], parts.parts[j]) and not _between(parts, i, j):
                i = parts.join(i, j)


def _is_foot(part: Part) -> bool:
    """Whether it stands on the floor or on a support."""
    return part.clearance <= FOOT_CLEARANCE or bool(part.thing)


def _one_stand(lower: Part, upper: Part) -> bool:
    return _foot_and_shade(lower, upper) or (lower.thing == upper.thing and _held_up(lower, upper, MAX_CANOPY_GAP))


def _foot_and_shade(foot: Part, shade: Part) -> bool:
    """Whether one is right above the other, both small, the foot on the floor or a support, the shade on nothing."""
    slant = math.hypot(foot.centre[0] - shade.centre[0], foot.centre[1] - shade.centre[1])
    if slant > POLE_SLANT:
        return False
    gap = float(shade.lower[2] - foot.upper[2])
    max_gap = MAX_TABLE_POLE_GAP if foot.thing else MAX_POLE_GAP
    return bool(
        _is_foot(foot)
        and not shade.thing
        and shade.clearance > SHADE_CLEARANCE
        and -NEAR < gap < max_gap
        and max(foot.extent[:2].max(), shade.extent[:2].max()) <= MAX_LAMP_SIDE
        and foot.table[0] < SUPPORT_AREA
    )


def _between(parts: PartSet, i: int, j: int) -> bool:
    """Whether some third part's top lies between the two, under the upper one: then that one carries it."""
    foot, shade = parts.parts[i], parts.parts[j]
    for k, other in parts.parts.items():
        if k in (i, j) or not foot.upper[2] - STACK_DEPTH < other.upper[2] < shade.lower[2] + STACK_DEPTH:
            continue
        if other.footprint.area > MIN_CARRIER_AREA and other.footprint.share_inside(foot.points, NEAR) > MOST:
            return True
    return False


def _join_lost_joints(parts: PartSet) -> bool:
    """Parts of similar colour that nearly touch; whether anything was joined."""
    changed = False
    order = sorted(parts.parts, key=lambda k: (-len(parts.parts[k]), k))
    lower = np.array([parts.parts[k].lower for k in order]).reshape(-1, 3)  # (P, 3), of those still to be looked at
    upper = np.array([parts.parts[k].upper for k in order]).reshape(-1, 3)
    for n, i in enumerate(order):
        if i not in parts.parts:
            continue
        part = parts.parts[i]
        gaps = np.maximum(0, np.maximum(part.lower - upper[n + 1 :], lower[n + 1 :] - part.upper))
        for j in (order[n + 1 + m] for m in np.flatnonzero(np.linalg.norm(gaps, axis=1) <= JOINT_GAP)):
            if j in parts.parts and _nearly_touching(part, parts.parts[j]):
                parts.join(i, j)  # keeps i, the larger
                changed = True
                break
    return changed


def _nearly_touching(a: Part, b: Part) -> bool:
    gap = np.maximum(0, np.maximum(a.lower - b.upper, b.lower - a.upper))
    if a.thing != b.thing or np.linalg.norm(gap) > JOINT_GAP or colour_step(a.colour, b.colour) > SIMILAR_COLOUR:
        return False
    if min(a.footprint.size.max(), b.footprint.size.max()) > LARGE:
        return False
    lower, upper = (a, b) if a.centre[2] < b.centre[2] else (b, a)
    area, height = lower.table
    carried = area > SUPPORT_AREA and upper.lower[2] > height - NEAR and lower.upper[2] - upper.lower[2] < JOINT_GAP
    if carried and upper.footprint.area < SUPPORT_SHARE * lower.footprint.area:
        return False
    near = cKDTree(a.points).query(b.points, distance_upper_bound=JOINT_GAP)[0]
    return bool(np.isfinite(near).sum() >= MIN_JOINT_POINTS)


def _join_thin_pieces(parts: PartSet) -> None:
    """Thin pieces that touch a body and lie over its plan, however high they rise."""
    for i, j, contact in parts.contacts():
        if i not in parts.parts or j not in parts.parts or contact < MIN_THIN_CONTACT:
            continue
        large, small = sorted((parts.parts[i], parts.parts[j]), key=len, reverse=True)
        thin = small.footprint.size.min() < THIN and large.thing == small.thing
        if thin and large.footprint.share_inside(small.points, THIN_MARGIN) > MOST:
            parts.join(i, j)


def _join_frames(parts: PartSet) -> None:
    """Thin upright frames on the floor, one behind the other: bicycle racks."""
    frames = {k: part for k, part in sorted(parts.parts.items()) if _is_frame(part)}
    joined = {k: k for k in frames}  # number of the part that each frame now belongs to
    for i, j in combinations(frames, 2):
        if joined[i] != joined[j] and _next_frame(frames[i], frames[j]):
            old = {joined[i], joined[j]}
            new = parts.join(joined[i], joined[j])
            joined |= {k: new for k, part in joined.items() if part in old}


def _is_frame(part: Part) -> bool:
    short, long = sorted(part.footprint.size)
    upright = short < THIN and min(long, float(part.extent[2])) > MIN_FRAME
    return bool(upright and part.clearance < FOOT_CLEARANCE and not part.thing)


def _next_frame(a: Part, b: Part) -> bool:
    offset = np.abs(a.footprint.local(b.footprint.centre[None])[0])
    axis = int(a.footprint.size.argmax())
    in_line = offset[axis] < MAX_FRAME_SHIFT and offset[1 - axis] < MAX_FRAME_GAP
    ratios = [a.footprint.size.max() / b.footprint.size.max(), a.extent[2] / b.extent[2]]
    alike = max(max(r, 1 / r) for r in ratios) < FRAME_RATIO and colour_step(a.colour, b.colour) < SIMILAR_COLOUR
    return bool(in_line and alike and np.ptp(a.footprint.local(b.points)[:, 1 - axis]) < THIN)


def _join_contents(parts: PartSet) -> None:
    """What lies inside a shelf or a frame that encloses it on several sides."""
    bodies = _longest_first(parts)
    for j in sorted(parts.parts, key=lambda k: (len(parts.parts[k]), k)):
        piece = parts.parts[j]
        if piece.extent.max() > MAX_CONTENT:
            continue
        for i in bodies:
            if len(parts.parts[i]) < MIN_CONTAINER * len(piece):
                break
            if i != j and _encloses(parts.parts[i], piece):
                parts.join(i, j)  # keeps i, the larger
                bodies = _longest_first(parts)
                break


def _longest_first(parts: PartSet) -> list[int]:
    return sorted(parts.parts, key=lambda k: (-len(parts.parts[k]), k))


def _encloses(body: Part, piece: Part) -> bool:
    if body.thing != piece.thing:
        return False
    if piece.lower[2] < body.lower[2] - BLUR or piece.upper[2] > body.upper[2] + BLUR:
        return False
    if body.footprint.share_inside(piece.points, BLUR) < NEARLY_ALL:
        return False
    heights = body.points[:, 2]
    beside = ((heights > piece.lower[2]) & (heights < piece.upper[2])).mean()
    return bool(beside > ENCLOSED * piece.extent[2] / max(float(body.extent[2]), NEAR))


def _join_legs(parts: PartSet) -> None:
    """Thin low pieces under or inside the plan of a larger thing."""
    for j in sorted(parts.parts, key=lambda k: (len(parts.parts[k]), k)):
        leg = parts.parts[j]
        thick = len(leg) > MAX_LEG_POINTS or leg.extent[:2].max() > MAX_LEG_SIDE
        if thick or leg.extent[2] > MAX_LEG_HEIGHT or leg.clearance >= MAX_LEG_CLEARANCE:
            continue
        owners = [
            (float(colour_step(leg.colour, body.colour)) + GAP_COST * max(0.0, float(body.lower[2] - leg.upper[2])), i)
            for i, body in parts.parts.items()
            if i != j and _over(body, leg)
        ]
        if owners:
            parts.join(min(owners)[1], j)


def _over(body: Part, leg: Part) -> bool:
    high_enough = body.upper[2] > leg.upper[2] - BLUR and body.clearance <= MAX_BODY_CLEARANCE
    alike = body.thing == leg.thing and len(body) >= 2 * len(leg)
    return bool(alike and high_enough and body.footprint.share_inside(leg.points, NEAR) > COVER_SHARE)
