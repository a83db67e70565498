"""What is seen on one object: whether a colour name, a material or a shape word describes it."""

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.meaning import Shape
from flymirage_core.language.scene_relations import ON_GROUND, Truth, at_least, at_most

CONFUSABLE_COLOURS = (
    frozenset({"white", "beige", "cream", "light grey"}),
    frozenset({"black", "dark grey", "dark brown", "dark blue"}),
    frozenset({"grey", "silver"}),
    frozenset({"brown", "light brown", "beige", "tan", "dark orange", "dark yellow", "olive"}),
    frozenset({"beige", "cream", "light orange", "light yellow"}),
    frozenset({"red", "pink", "dark pink", "light red"}),
    frozenset({"purple", "pink"}),
    frozenset({"red", "orange"}),
    frozenset({"orange", "yellow", "gold"}),
    frozenset({"blue", "purple"}),
    frozenset({"blue", "cyan", "turquoise", "teal"}),
    frozenset({"green", "teal", "turquoise", "olive"}),
)
"""Colour names that light and eye do not keep apart."""

CONFUSABLE_MATERIALS = (
    frozenset({"wood", "wicker", "bamboo", "cardboard"}),
    frozenset({"metal", "steel", "iron", "aluminium", "brass"}),
    frozenset({"fabric", "leather", "upholstery", "velvet"}),
    frozenset({"glass", "plastic", "acrylic"}),
    frozenset({"stone", "concrete", "marble", "ceramic", "porcelain"}),
    frozenset({"plastic", "rubber", "metal", "ceramic"}),
)

FURNITURE_LOW = (0.6, 0.8)
"""Metres of height up to which a thing is low."""
LOW_BOTTOM = (0.3, 0.6)
"""Metres of its underside above the ground: no lamp at the ceiling is low, however flat it is."""
THIN = (0.15, 0.25)
"""Metres of the shortest side up to which a thing is flat (lying) or thin (standing)."""


HEIGHTS = {
    Shape.KNEE_HIGH: ((0.4, 0.3), (0.6, 0.7)),
    Shape.WAIST_HIGH: ((0.8, 0.7), (1.1, 1.2)),
    Shape.HEAD_HIGH: ((1.5, 1.35), (1.85, 2.0)),
}
"""Metres of a thing's top above the ground: at least, and at most."""


def coloured(name: str, seen: str) -> Truth:
    """Whether ``name`` describes a thing of the ``seen`` colour; an unmeasured colour may be any."""
    if name == seen:
        return Truth.YES
    if not seen:
        return Truth.MAYBE
    if any(name in kin and seen in kin for kin in CONFUSABLE_COLOURS):
        return Truth.MAYBE
    opposite = {name.split()[0], seen.split()[0]} == {"dark", "light"}
    return Truth.MAYBE if name.split()[-1] == seen.split()[-1] and not opposite else Truth.NO


def made_of(name: str, guessed: str) -> Truth:
    """Whether ``name`` describes a thing whose material was guessed; an unmeasured material may be any."""
    if name == guessed:
        return Truth.YES
    kin = any(name in group and guessed in group for group in CONFUSABLE_MATERIALS)
    return Truth.MAYBE if kin or not guessed else Truth.NO


def shaped(shape: Shape, box: ObjectBox) -> Truth:
    """From the proportions of the box: height, longer and shorter side."""
    longer, shorter, height = max(box.size[:2]), min(box.size[:2]), box.size[2]
    match shape:
        case Shape.TALL:
            return at_least(height / longer, (1.8, 1.3))
        case Shape.SLIM:
            return at_least(height / longer, (3.0, 2.0))
        case Shape.LOW:
            standing = at_most(box.bottom, LOW_BOTTOM)
            return min(at_most(height / longer, (0.45, 0.65)), at_most(height, FURNITURE_LOW), standing)
        case Shape.LONG:
            return min(at_least(longer / shorter, (2.5, 1.8)), at_least(longer / height, (1.5, 1.1)))
        case Shape.FLAT:
            return min(at_most(height, THIN), at_most(height / longer, (0.25, 0.4)), at_least(shorter, (0.2, 0.15)))
        case Shape.THIN:
            return min(at_most(shorter, THIN), at_most(shorter / min(longer, height), (0.2, 0.35)))
        case Shape.BOXY:
            return at_most(max(longer, height) / min(shorter, height), (1.25, 1.6))
        case Shape.KNEE_HIGH | Shape.WAIST_HIGH | Shape.HEAD_HIGH:
            least, most = HEIGHTS[shape]
            return min(at_most(box.bottom, ON_GROUND), at_least(box.top, least), at_most(box.top, most))
