"""Which labels a noun may mean: kin words, family names, plurals, and names for what has no name."""

from flymirage_core.language.meaning import UNNAMED
from flymirage_core.language.scene_relations import Truth

GENERIC = frozenset({UNNAMED, "thing", "item"})
"""Head nouns that say nothing: "tall brown object" names no more than "object" does."""

SAME = (
    frozenset({"sofa", "couch"}),
    frozenset({"bookshelf", "bookcase"}),
    frozenset({"tv", "television"}),
    frozenset({"refrigerator", "fridge"}),
    frozenset({"waste bin", "trash can", "garbage can", "rubbish bin", "trash bin"}),
    frozenset({"nightstand", "bedside table"}),
    frozenset({"potted plant", "houseplant"}),
    frozenset({"monitor", "computer monitor", "computer screen"}),
    frozenset({"pendant lamp", "pendant light", "hanging lamp"}),
    frozenset({"ceiling light", "ceiling lamp"}),
    frozenset({"wall lamp", "wall light", "sconce", "wall sconce"}),
)
"""Words for the same thing."""

SYNONYMS = (
    frozenset({"sofa", "couch", "settee", "loveseat", "sectional"}),
    frozenset({"armchair", "chair", "seat", "recliner"}),
    frozenset({"stool", "ottoman", "pouf", "footstool", "seat"}),
    frozenset({"bench", "pew"}),
    frozenset({"cabinet", "cupboard", "wardrobe", "closet", "armoire", "locker"}),
    frozenset({"bookshelf", "bookcase", "shelf", "shelves", "shelving", "rack"}),
    frozenset({"dresser", "drawers", "sideboard", "credenza", "cabinet"}),
    frozenset({"lamp", "light", "lantern", "sconce", "chandelier"}),
    frozenset({"picture", "painting", "poster", "artwork", "photo", "art", "frame", "photograph", "print"}),
    frozenset({"plant", "houseplant", "shrub", "bush", "tree"}),
    frozenset({"rug", "carpet", "mat"}),
    frozenset({"tv", "television", "monitor", "screen", "display"}),
    frozenset({"bin", "can", "basket", "bucket"}),
    frozenset({"box", "crate", "carton", "chest"}),
    frozenset({"pillow", "cushion"}),
    frozenset({"counter", "bar", "countertop", "island"}),
    frozenset({"vase", "pot", "urn", "jar", "planter"}),
    frozenset({"fridge", "refrigerator", "freezer"}),
    frozenset({"bed", "mattress"}),
    frozenset({"barrel", "drum"}),
    frozenset({"column", "pillar", "post"}),
)
"""Words that people use for one another: a prompt with one of them may be read as any of its set."""

VAGUE = {
    "table": {"desk", "counter", "workbench", "nightstand"},
    "seat": {"chair", "armchair", "stool", "pouf", "ottoman", "bench", "sofa"},
    "cabinet": {"bookshelf", "wardrobe", "sideboard", "dresser", "nightstand", "tv stand", "locker"},
    "container": {"box", "basket", "bin", "waste bin", "crate", "barrel", "suitcase"},
    "lamp": {"ceiling light", "light", "lantern"},
    "picture": {"poster", "painting", "mirror"},
    "appliance": {"printer", "microwave", "refrigerator", "machine"},
    "machine": {"printer", "gas cylinder"},
    "plant": {"shrub", "tree", "bush"},
}
"""Family names: a thing called by one may be any of its kinds, and each of them may be called by it."""


def is_generic(label: str) -> bool:
    """
    >>> is_generic("tall brown object"), is_generic("office chair")
    (True, False)
    """
    return label.split()[-1] in GENERIC


def named(word: str, label: str) -> Truth:
    """Whether a thing with this label is meant by ``word``: certainly by its own label, maybe by kin of it.

    "chair" may mean an "office chair" and, labels being what they are, "office chair" may mean a "chair".
    """
    if is_generic(word):
        return Truth.YES if is_generic(label) else Truth.MAYBE
    if is_generic(label):
        return Truth.NO
    one, other = singular(word), singular(label)
    if one == other or any(one in same and other in same for same in SAME):
        return Truth.YES
    if other.endswith(" " + one) or one.endswith(" " + other):
        return Truth.MAYBE
    if one in VAGUE.get(other, ()) or other in VAGUE.get(one, ()):
        return Truth.MAYBE
    heads = {one, one.split()[-1]}, {other, other.split()[-1]}
    kin = any(heads[0] & group and heads[1] & group for group in SYNONYMS)
    return Truth.MAYBE if kin and one.split()[-1] != other.split()[-1] else Truth.NO


def singular(noun: str) -> str:
    """The noun with its head in the singular, as far as spelling tells.

    >>> [singular(n) for n in ("curtains", "shelves", "chests of drawers", "boxes", "canvas", "wine glass")]
    ['curtain', 'shelf', 'chest of drawers', 'box', 'canvas', 'wine glass']
    """
    head, of, rest = noun.partition(" of ")
    if head.endswith("shelves"):
        head = head[:-3] + "f"
    elif head.endswith(("xes", "shes", "ches", "sses")):
        head = head[:-2]
    elif head.endswith("s") and not head.endswith(("ss", "us", "is", "gas", "as", "lens")):
        head = head[:-1]
    return head + of + rest
