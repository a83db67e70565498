"""Finishes of floors, walls, ceilings, ground and facades: a zone's surface words made materials."""

from dataclasses import replace
from typing import Final

from flymirage_core.scene.design import Zone
from flymirage_core.worldgen.colours import linear_rgb
from flymirage_core.worldgen.materials import Material, material_named

MORTAR: Final = (0.22, 0.19, 0.17)
CLAY_SHARE: Final = 0.45
"""Of a brick's colour: fired clay is never as pure as paint."""
FINISHES: Final[dict[str, Material]] = {
    "parquet": Material((1, 1, 1), "planks", joints=(0.0, 0.16, 0.012), stretch=3.0, detail=0.95),
    "plank": Material((1, 1, 1), "planks", joints=(0.0, 0.16, 0.012), stretch=3.0, detail=0.95),
    "board": Material((1, 1, 1), "planks", joints=(0.0, 0.16, 0.012), stretch=3.0, detail=1.1),
    "tile": Material((1, 1, 1), "tiles", joints=(0.5, 0.5, 0.012), detail=1.3),
    "brick": Material((1, 1, 1), "bricks", joints=(0.15, 0.1, 0.012), stretch=2.2, detail=1.2, ink=MORTAR),
    "carpet": Material((1, 1, 1), "carpet", detail=1.3),
    "terrazzo": Material((1, 1, 1), "terrazzo", detail=1.0),
    "marble": Material((1, 1, 1), "marble", detail=1.2),
    "concrete": Material((1, 1, 1), "concrete", detail=1.4, wear=0.25),
    "cobble": Material((1, 1, 1), "cobbles", joints=(0.12, 0.16, 0.02), detail=0.9),
    "sett": Material((1, 1, 1), "cobbles", joints=(0.12, 0.16, 0.02), detail=0.9),
    "asphalt": Material((1, 1, 1), "asphalt", detail=1.2, wear=0.2),
    "tarmac": Material((1, 1, 1), "asphalt", detail=1.2, wear=0.2),
    "paving": Material((1, 1, 1), "paving", joints=(0.4, 0.4, 0.012), detail=1.2),
    "slab": Material((1, 1, 1), "paving", joints=(0.4, 0.4, 0.012), detail=1.2),
    "gravel": Material((1, 1, 1), "gravel", detail=0.9),
    "grass": Material((1, 1, 1), "grass", detail=0.9),
    "lawn": Material((1, 1, 1), "grass", detail=0.9),
    "soil": Material((1, 1, 1), "soil", detail=1.0),
    "earth": Material((1, 1, 1), "soil", detail=1.0),
    "corrugated": Material((1, 1, 1), "corrugated", detail=1.1),
    "ashlar": Material((1, 1, 1), "ashlar", detail=1.3),
    "shingle": Material((1, 1, 1), "shingles", detail=1.2),
    "plaster": Material((1, 1, 1), "plaster", detail=1.7),
    "paint": Material((1, 1, 1), "plaster", detail=1.7),
    "stucco": Material((1, 1, 1), "plaster", detail=1.6, wear=0.2),
}
"""The first key that occurs in the surface's material words is taken."""
USUAL: Final = {
    "floor": ("light grey", "concrete"), "ground": ("grey", "asphalt"), "walls": ("cream", "plaster"),
    "facades": ("sand", "plaster"), "ceiling": ("white", "plaster"), "roof": ("terracotta", "shingle"),
}  # fmt: skip
LARGE_SPACE: Final = 220.0
"""Square metres of plan from which surfaces are cut a little coarser, so that objects keep their share."""


def finish(zone: Zone, part: str, seed: int) -> Material:
    """The material of a zone's ``part`` ("floor", "facades", ...), by its description, else a usual one."""
    other = {"floor": "ground", "ground": "floor", "walls": "facades", "facades": "walls"}.get(part, part)
    found = next((s for name in (part, other) for s in zone.surfaces if s.part == name), None)
    colour, words = (found.colour, found.material.lower()) if found else USUAL[part]
    return dressed(colour, words, seed)


def dressed(colour: str, words: str, seed: int) -> Material:
    """A large surface's material from words such as ("oak brown", "oak plank")."""
    base = next((m for name, m in FINISHES.items() if name in words), None)
    if base is None:
        base = replace(material_named(words, colour, seed), detail=1.3)
    shade = linear_rgb(colour)
    if base.texture == "bricks":
        grey = 0.25 * shade[0] + 0.65 * shade[1] + 0.1 * shade[2]
        r, g, b = (c + CLAY_SHARE * (grey * k - c) for c, k in zip(shade, (1.5, 1.1, 0.9), strict=True))
        shade = (r, g, b)
    return replace(base, colour=shade, seed=seed)
