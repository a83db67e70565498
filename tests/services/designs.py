"""A scene as a language model would design it, and what a fake model answers to each of our questions."""

from typing import Any


def design(title: str = "Quiet reading room", **changes: Any) -> dict[str, Any]:
    """A whole `SceneDesign` as JSON."""
    things = [
        ("bookshelf", "oak brown", "oak", "against_wall", "", 6),
        ("armchair", "forest green", "velvet", "on_floor", "", 4),
        ("coffee table", "black", "steel", "on_floor", "", 3),
        ("vase", "teal", "stoneware", "on_surface", "coffee table", 6),
        ("stool", "red", "beech", "around", "coffee table", 8),
        ("painting", "blue", "canvas", "on_wall", "", 9),
        ("pendant lamp", "copper", "copper", "hanging", "", 6),
        ("crate", "orange", "plastic", "on_floor", "", 6),
        ("cabinet", "white", "painted wood", "against_wall", "", 5),
        ("potted plant", "green", "terracotta", "on_floor", "", 7),
    ]
    objects = [
        {
            "noun": noun,
            "count": count,
            "colour": colour,
            "material": material,
            "size": "medium",
            "state": "",
            "placement": placement,
            "relative_to": relative_to,
            "zone": "main hall",
        }
        for noun, colour, material, placement, relative_to, count in things
    ]
    zone = {
        "name": "main hall",
        "kind": "room",
        "dimensions": [11.0, 9.0, 3.2],
        "surfaces": [
            {"part": "floor", "colour": "brown", "material": "oak plank"},
            {"part": "walls", "colour": "cream", "material": "plaster"},
            {"part": "ceiling", "colour": "white", "material": "plaster"},
        ],
        "connects_to": [],
        "windows": 4,
    }
    return {
        "title": title,
        "setting": "indoor",
        "dimensions": [11.0, 9.0, 3.2],
        "zones": [zone],
        "style": "art deco",
        "era": "1930s",
        "palette": ["cream", "brown", "forest green"],
        "light": {
            "time_of_day": "afternoon",
            "sky": "clear",
            "sources": ["windows", "hanging_lamps"],
            "words": "low sun through tall windows",
        },
        "objects": objects,
        "prose": f"{title}: an art deco room of eleven by nine metres with bookshelves, armchairs and plants.",
        "image_prompt": f"{title}, art deco reading room with bookshelves and green armchairs.",
        "world_prompt": f"{title}, a rectangular art deco room, oak floor, cream walls, tall windows.",
        **changes,
    }
