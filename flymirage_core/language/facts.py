"""What is measured of a target and of the things about it, in words that a language model is told."""

from collections import Counter

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.looks import shaped
from flymirage_core.language.meaning import UNNAMED, Shape
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import (
    Level,
    Relation,
    Side,
    Truth,
    at_level,
    on_side,
    outline_gap,
    related,
)

NEIGHBOURS = 12
"""So many nearest things are told with their relations."""
REACH = 3.0
"""Metres between outlines within which a thing is a neighbour."""


def name_of(box: ObjectBox) -> str:
    """Its colour, material and noun, as far as they are known: "dark green leather sofa"."""
    return " ".join(word for word in (box.colour, box.material, box.label) if word)


def facts_about(resolver: Resolver, target_id: int) -> str:
    """The target, others that could be mistaken for it, what is near it and how it stands to it, and all things."""
    target = next(box for box in resolver.boxes if box.object_id == target_id)
    x, y, z = target.size
    looks = ", ".join(s.value for s in Shape if shaped(s, target) is Truth.YES) or "no special shape"
    sides = ", ".join(s.value for s in Side if on_side(s, target, resolver.start) is Truth.YES) or "none for sure"
    levels = ", ".join(v.value for v in Level if at_level(v, target, resolver.boxes) is Truth.YES) or "unclear"
    lines = [
        f"Target: {name_of(target)}; {looks}; {max(x, y):.1f} m long, {min(x, y):.1f} m deep, {z:.1f} m high.",
        f"Where it is as seen from the drone at its start: {sides}.",
        f"Where it is in the room: {levels}.",
        _same_kind(resolver, target),
        *_neighbourhood(resolver, target),
        _everything(resolver),
    ]
    return "\n".join(lines)


def _same_kind(resolver: Resolver, target: ObjectBox) -> str:
    others = [box for box in resolver.boxes if box.label == target.label and box is not target]
    if not others:
        return f"It is the only {target.label} there is."
    listed = "; ".join(f"{name_of(box)}, {max(box.size):.1f} m" for box in others[:NEIGHBOURS])
    return f"Other things of the same name that it must be told from ({len(others)}): {listed}."


def _neighbourhood(resolver: Resolver, target: ObjectBox) -> list[str]:
    """One line for each neighbour to which the target stands in a relation for sure."""
    near = sorted(
        (b for b in resolver.boxes if b is not target and b.label != UNNAMED and outline_gap(b, target) <= REACH),
        key=lambda b: (outline_gap(b, target), b.object_id),
    )
    lines = []
    for box in near[:NEIGHBOURS]:
        held = [r.value for r in Relation if related(r, target, box, resolver.start) is Truth.YES]
        if held:
            lines.append(f"The target is {' and '.join(held)} a {name_of(box)}.")
    return lines


def _everything(resolver: Resolver) -> str:
    counted = Counter(name_of(box) for box in resolver.boxes)
    listed = ", ".join(f"{count} x {name}" if count > 1 else name for name, count in sorted(counted.items()))
    return f"All things in the scene: {listed}."
