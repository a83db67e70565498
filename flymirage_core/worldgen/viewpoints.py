"""Where to look at a world from: the picture of the place, chosen among many trial views, and the panorama from c."""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.rendering.camera import Camera, Intrinsics, look_along
from flymirage_core.rendering.rasterizer import Rasterizer, Rendering
from flymirage_core.splats.cloud import GaussianCloud
from flymirage_core.worldgen.truth import FreeBox, WorldTruth

Float = NDArray[np.float64]

PICTURE_SIZE: Final = (960, 640)
PICTURE_FOV_DEG: Final = 78.0
TRIAL_SIZE: Final = (96, 64)
SPOTS: Final = (0.07, 0.25, 0.5, 0.75, 0.93)
"""Shares of the main space's sides at which trial views stand."""
HEIGHTS: Final = (1.55, 2.1)
"""Metres above the floor; streets and halls are also seen from higher up."""
AIM: Final = 1.0
"""Metres: height of what a trial view looks at."""
BALL: Final = 0.6
"""Metres round the camera that must be free."""
NEAR: Final = 1.7
"""Metres: what is nearer fills the frame."""
NEAR_WEIGHT, HOLE_WEIGHT, SKY_WEIGHT, DEPTH_WEIGHT, CONTRAST_WEIGHT = 40.0, 60.0, 12.0, 5.0, 10.0
"""What a trial view loses for near things, holes and sky beyond `MOST_SKY`, and gains for depth and contrast."""
MOST_SKY: Final = 0.35
SKY_FROM: Final = 30.0
"""Metres from which a pixel shows sky."""
PANORAMA_WIDTH: Final = 1536


def best_view(cloud: GaussianCloud, truth: WorldTruth, rasterizer: Rasterizer) -> NDArray[np.uint8]:
    """(640, 960, 3) picture from the trial view that shows most: many objects, near and far, none filling the frame."""
    trials = _trial_views(truth, *TRIAL_SIZE)
    scores = [_score(v, c, truth) for v, c in zip(rasterizer.render(cloud, trials), trials, strict=True)]
    best = _trial_views(truth, *PICTURE_SIZE)[int(np.argmax(scores))]
    return next(iter(rasterizer.render(cloud, [best]))).rgb


def _trial_views(truth: WorldTruth, width: int, height: int) -> list[Camera]:
    """Cameras at free spots of the main space, looking at its middle, at c, and along it."""
    main = truth.spaces[0]
    intrinsics = Intrinsics.from_horizontal_fov(width, height, np.radians(PICTURE_FOV_DEG))
    low, high = np.array(main.low), np.array(main.high)
    views = []
    for z in _heights(main):
        for u in SPOTS:
            for v in SPOTS:
                spot = np.array([*(low[:2] + np.array([u, v]) * (high - low)[:2]), z])
                if not _free(spot, truth):
                    continue
                for aim in _aims(spot, low, high, truth):
                    if np.hypot(*(aim - spot)[:2]) > 1.5:
                        views.append(Camera(intrinsics, look_along(spot, aim - spot)))
    return views or [Camera(intrinsics, look_along(truth.centre, [1.0, 0.0, -0.1]))]


def _heights(main: FreeBox) -> list[float]:
    top = main.high[2] - 0.4
    return [z for z in (*HEIGHTS, 2.9) if z <= top] or [top]


def _aims(spot: Float, low: Float, high: Float, truth: WorldTruth) -> list[Float]:
    middle = (low + high) / 2
    across = np.array([*(2 * middle - spot)[:2], AIM])
    return [np.array([*middle[:2], AIM]), np.array([*truth.centre[:2], AIM]), across]


def _free(spot: Float, truth: WorldTruth) -> bool:
    steps = np.array(np.meshgrid(*[[-BALL, 0.0, BALL]] * 3, indexing="ij")).reshape(3, -1).T
    return bool(truth.is_free(spot + steps * [1.0, 1.0, 0.7]).all())


def _score(view: Rendering, camera: Camera, truth: WorldTruth) -> float:
    depth = view.depth
    seen = depth > 0
    if seen.mean() < 0.5:
        return -1e9
    near, sky = float((seen & (depth < NEAR)).mean()), float((depth > SKY_FROM).mean())
    shares = np.histogram(np.log(depth[seen]), bins=np.log([0.5, 1, 1.5, 2, 3, 4, 6, 8, 12, 20, 90]))[0] / seen.sum()
    variety = float(-(shares[shares > 0] * np.log(shares[shares > 0])).sum())
    nouns = _visible_nouns(depth, camera, truth)
    score = len(set(nouns)) + 0.3 * len(nouns) + DEPTH_WEIGHT * variety + CONTRAST_WEIGHT * view.rgb.std() / 64
    return float(score - NEAR_WEIGHT * near - HOLE_WEIGHT * (~seen).mean() - SKY_WEIGHT * max(sky - MOST_SKY, 0.0) * 5)


def _visible_nouns(depth: NDArray[np.float32], camera: Camera, truth: WorldTruth) -> list[str]:
    """The nouns of objects whose middle is in the frame and not behind something else."""
    if not truth.objects:
        return []
    pixels, far = camera.project(np.array([o.centre for o in truth.objects]))
    nouns = []
    for o, (u, v), d in zip(truth.objects, pixels, far, strict=True):
        if d > 0.5 and 0 <= u < depth.shape[1] and 0 <= v < depth.shape[0]:
            found = float(depth[int(v), int(u)])
            if found > d - max(o.size) / 2 - 0.15:
                nouns.append(o.noun)
    return nouns


def panorama(cloud: GaussianCloud, centre: Float, rasterizer: Rasterizer) -> NDArray[np.uint8]:
    """(H, 2H, 3) all round c: the middle column looks along +y, to the left lies -x; six faces of a cube, resampled."""
    width, height = PANORAMA_WIDTH, PANORAMA_WIDTH // 2
    side = width // 4
    intrinsics = Intrinsics.from_horizontal_fov(side + 2, side + 2, 2 * np.arctan((side + 2) / side))
    axes = [np.array(a, float) for a in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    cameras = [Camera(intrinsics, look_along(centre, a)) for a in axes]
    turn, tilt = np.meshgrid(
        ((np.arange(width) + 0.5) / width - 0.5) * 2 * np.pi, (0.5 - (np.arange(height) + 0.5) / height) * np.pi
    )
    rays = np.stack([np.sin(turn) * np.cos(tilt), np.cos(turn) * np.cos(tilt), np.sin(tilt)], axis=2)  # (H, W, 3)
    nearest = np.stack([rays @ a for a in axes], axis=2).argmax(axis=2)
    result = np.zeros((height, width, 3), np.uint8)
    for face, (camera, view) in enumerate(zip(cameras, rasterizer.render(cloud, cameras), strict=True)):
        chosen = nearest == face
        local = rays[chosen] @ camera.T_world_camera[:3, :3]  # (M, 3)
        u = (intrinsics.fx * local[:, 0] / local[:, 2] + intrinsics.cx - 0.5).astype(np.float32)
        v = (intrinsics.fy * local[:, 1] / local[:, 2] + intrinsics.cy - 0.5).astype(np.float32)
        picked = [
            cv2.remap(view.rgb, a[None], b[None], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)[0]
            for a, b in zip(np.array_split(u, -(-len(u) // 30000)), np.array_split(v, -(-len(v) // 30000)), strict=True)
        ]
        result[chosen] = np.concatenate(picked)
    return result
