"""What surfaces look like before light falls on them: materials, and the words that name them.

Colours are linear RGB in [0, 1]. Textures (`textures.py`, `pictured.py`) are functions of metres, so
grain and tiles have their real size.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flymirage_core.worldgen.colours import linear_rgb
from flymirage_core.worldgen.noise import fractal
from flymirage_core.worldgen.pictured import PICTURES
from flymirage_core.worldgen.textures import JOINTS, TEXTURES, runs

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Material:
    """A surface's look.

    ``joints`` are (pitch along u, pitch along v, width) in metres, 0 = none; ``stretch`` is how much longer than wide
    its surfels are (along the grain); ``detail`` multiplies the surfels' spacing.
    """

    colour: tuple[float, float, float]
    texture: str = "plain"
    emission: float = 0.0  # radiance that it gives off, as a multiple of its colour
    joints: tuple[float, float, float] = (0.0, 0.0, 0.0)
    stretch: float = 1.0
    detail: float = 1.0
    seed: int = 0
    opacity: float = 1.0  # of its splats: glass lets through what is behind it
    ink: tuple[float, float, float] = (0.02, 0.02, 0.022)  # second colour: letters, stripes, joints
    words: str = ""  # lettering of the texture "text"; "|" starts a new line
    wear: float = 0.0  # 0 new .. 1 dirty and faded
    stain: float = 0.0  # 0 none .. 1 dark runs of water from the patch's upper edge

    def shaded(self, factor: float) -> "Material":
        """The same material, lighter or darker."""
        r, g, b = (min(c * factor, 0.95) for c in self.colour)
        return replace(self, colour=(r, g, b))


MATERIAL_TEXTURES = {
    "rust": ("rusty", "rusted", "corroded", "weathering", "corten"),
    "corrugated": ("corrugated",),
    "wicker": ("wicker", "rattan", "cane", "straw", "seagrass", "woven"),
    "wood": ("oak", "walnut", "pine", "beech", "birch", "ash", "teak", "plywood", "wood", "bamboo", "wooden", "timber",
             "maple", "cedar", "mahogany", "cherry", "spruce"),
    "velvet": ("velvet", "suede"),
    "leather": ("leather", "vinyl"),
    "fabric": ("linen", "wool", "felt", "cotton", "canvas", "fabric", "tweed", "upholstered", "nylon", "tarpaulin",
               "jute", "burlap", "cloth"),
    "enamel": ("painted", "enamelled", "enamel", "lacquered", "powder-coated"),
    "brushed": ("brushed", "stainless", "aluminium", "chrome", "galvanised", "zinc"),
    "metal": ("steel", "brass", "iron", "copper", "metal", "bronze", "lead", "wrought", "cast"),
    "marble": ("marble", "onyx"),
    "concrete": ("concrete", "cement"),
    "terrazzo": ("terrazzo",),
    "stone": ("granite", "stone", "slate", "sandstone", "limestone", "terracotta", "clay", "plaster"),
    "bricks": ("brick",),
    "paper": ("cardboard", "paper"),
    "leaf": ("foliage", "leaves"),
    "glass": ("glass", "acrylic", "crystal"),
}  # fmt: skip
GLASS_OPACITY = 0.45
"""Of a pane's splats: what is behind shows, and a glint of its own colour stays."""


def material_named(name: str, colour: str, seed: int = 0) -> Material:
    """The look of a description's words, e.g. ("oak", "honey brown"); what is not known is smooth paint."""
    words = set(name.lower().replace("-", " ").split()) | set(name.lower().split())
    texture = next((t for t, names in MATERIAL_TEXTURES.items() if words & set(names)), "plain")
    wear = 0.5 if words & {"worn", "old", "weathered", "dusty", "dirty", "faded", "rusty"} else 0.12
    stretch = 2.0 if texture == "wood" else 1.0
    return Material(linear_rgb(colour), texture, stretch=stretch, seed=seed, wear=wear)


def albedo(material: Material, uv: Float, extent: tuple[float, float], points: Float) -> Float:
    """Linear albedo (N, 3) at surface coordinates ``uv`` (N, 2) metres on a patch of ``extent`` metres.

    ``points`` (N, 3) are object coordinates in metres; they decorrelate the patches of one object.
    """
    if material.texture in PICTURES:
        picture = PICTURES[material.texture]
        return np.clip(picture(uv, extent, material.seed, material.words, material.colour, material.ink), 0.0, 0.95)
    tint = TEXTURES[material.texture](uv, extent, points, material.seed)
    colours = np.asarray(material.colour) * tint
    if material.texture in JOINTS:
        joint = JOINTS[material.texture](uv)[:, None]  # (N, 1)
        colours = colours * (1 - joint) + np.asarray(material.ink) * joint
    if material.wear > 0:
        dirt = np.clip(fractal(points * 2.7, material.seed + 101) + 0.1, 0.0, 1.0) * material.wear  # (N,)
        colours = colours * (1 - 0.55 * dirt[:, None]) + 0.03 * dirt[:, None]
    if material.stain > 0:
        colours = colours * (1 - 0.5 * material.stain * runs(uv, extent, points, material.seed))[:, None]
    return np.clip(colours, 0.0, 0.95)
