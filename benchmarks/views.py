"""A page of pictures of a world: four views all round, their depth in colour, and where alpha is too small marked.

    python benchmarks/views.py WORLD.spz ... [--out views] [--size 640x480]

Worlds as in rendering.py. In the third row pixels with alpha below 0.5 (no return) are red, below 0.9 yellow.
"""

import argparse
from pathlib import Path

import cv2
import numpy as np
from filming import worlds

from flymirage_core.pictures.canvas import contact_sheet
from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.rasterizer import MIN_ALPHA_FOR_DEPTH, Rendering

HEADINGS = (0, 90, 180, 270)
FAINT = 0.9
"""Alpha under which a surface shows what is behind it."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", nargs="*", type=Path)
    parser.add_argument("--out", type=Path, default=Path("views"))
    parser.add_argument("--size", default="640x480")
    chosen = parser.parse_args()
    intrinsics = Intrinsics.from_horizontal_fov(*map(int, chosen.size.split("x")), np.radians(90))
    chosen.out.mkdir(parents=True, exist_ok=True)
    for name, cloud, centre in worlds(chosen.worlds):
        angles = np.radians(HEADINGS)
        directions = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])  # (4, 3)
        cameras = [Camera(intrinsics, look_along(centre, direction)) for direction in directions]
        views = list(CpuRasterizer().render(cloud, cameras))
        far = max(float(np.quantile(view.depth, 0.99)) for view in views)
        rows = [
            *((view.rgb, f"{name}, heading {heading}") for view, heading in zip(views, HEADINGS, strict=True)),
            *((depth_in_colour(view, far), f"depth, 0 (red) to {far:.1f} m (blue)") for view in views),
            *((holes_marked(view), f"no return {np.mean(view.depth == 0):.1%}") for view in views),
        ]
        page = contact_sheet([picture for picture, _ in rows], [caption for _, caption in rows], 4, 480)
        path = chosen.out / f"{name}.png"
        cv2.imwrite(str(path), page[:, :, ::-1])
        print(path)


def depth_in_colour(view: Rendering, far: float) -> np.ndarray:
    """(H, W, 3) red is near, blue far, black no return."""
    nearness = np.clip(255 * (1 - view.depth / far), 0, 255).astype(np.uint8)
    colours = cv2.applyColorMap(nearness, cv2.COLORMAP_TURBO)[:, :, ::-1]
    return np.where(view.depth[:, :, None] > 0, colours, 0).astype(np.uint8)


def holes_marked(view: Rendering) -> np.ndarray:
    """(H, W, 3) the picture in grey, with its holes and its faint surfaces in colour."""
    grey = np.repeat(cv2.cvtColor(view.rgb, cv2.COLOR_RGB2GRAY)[:, :, None] // 2 + 60, 3, axis=2)
    grey[view.alpha < FAINT] = (230, 200, 60)
    grey[view.alpha < MIN_ALPHA_FOR_DEPTH] = (210, 50, 50)
    return grey


if __name__ == "__main__":
    main()
