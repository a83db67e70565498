"""Colour names to linear RGB: the words of a description as the paint of a world. Muted, as real rooms are."""

import hashlib
from typing import Final

MUTED: Final = 0.14
"""Share of grey in every colour: paint and cloth are never as pure as a screen, and the film curve adds some."""
NAMED = {
    "white": "#e9e6df", "ivory": "#e8dfc9", "cream": "#e6d9bd", "chalk": "#dcdad3", "beige": "#cdbb9c",
    "sand": "#c6ad84", "taupe": "#94867a", "light grey": "#bfbfbb", "grey": "#8e908f", "slate grey": "#5d666d",
    "charcoal": "#3f4347", "black": "#2b2b2d", "honey brown": "#b3834f", "oak brown": "#a57c50",
    "walnut brown": "#6b4a33", "chestnut": "#7c4a33", "chocolate": "#4f3528",
    "tan": "#b58b5f", "caramel": "#b0703a", "rust": "#a2542f",
    "terracotta": "#b8684a", "brick red": "#8f3f35", "red": "#a8322d", "burgundy": "#6d2631", "coral": "#d0735c",
    "blush": "#d3a498", "pink": "#c98a93", "mustard": "#c79a34", "yellow": "#dab53d", "ochre": "#b58a3c",
    "orange": "#cf7630", "olive": "#73733f", "moss green": "#68794a", "sage": "#97a688", "forest green": "#35573f",
    "green": "#447a4b", "emerald": "#1f6a52", "mint": "#a7cbb5", "teal": "#2f6c71", "turquoise": "#4f9ea0",
    "sky blue": "#86acc6", "powder blue": "#a9bfd0", "blue": "#3b639a", "denim blue": "#4a6382", "navy": "#2b3a58",
    "lavender": "#9c93b8", "plum": "#623c58", "purple": "#64497f", "silver": "#b3b6b8", "brass": "#b3924e",
    "copper": "#a96a48", "bronze": "#7d6242",
}  # fmt: skip


def linear_rgb(name: str) -> tuple[float, float, float]:
    """Linear RGB of a colour name; of a longer name its last known words; of an unknown one a fixed muted colour."""
    words = name.lower().split()
    for start in range(len(words)):
        code = NAMED.get(" ".join(words[start:]))
        if code:
            return _linear(tuple(int(code[i : i + 2], 16) for i in (1, 3, 5)))
    digest = hashlib.sha256(name.lower().encode()).digest()
    return _linear(tuple(90 + b % 100 for b in digest[:3]))


def _linear(srgb: tuple[int, ...]) -> tuple[float, float, float]:
    r, g, b = (((c / 255 + 0.055) / 1.055) ** 2.4 for c in srgb)
    grey = 0.2126 * r + 0.7152 * g + 0.0722 * b
    return r + MUTED * (grey - r), g + MUTED * (grey - g), b + MUTED * (grey - b)
