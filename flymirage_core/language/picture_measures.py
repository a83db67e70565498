"""No-reference measures of single pictures: blur, noise, contrast, holes. Published formulae without learned numbers.

`luma` is a picture's brightness (H, W), float32, 0..255.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

Luma = NDArray[np.float32]

BLUR_WIDTH = 11
"""Pixels of the second blur's window."""
NOISE_MASK = np.array([[1, -2, 1], [-2, 4, -2], [1, -2, 1]], np.float32)


def to_luma(rgb: NDArray[np.uint8]) -> Luma:
    return np.asarray(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), np.float32)


def blur_effect(luma: Luma) -> float:
    """0 (sharp) to 1 (blurred): how little a picture changes when it is blurred once more.

    F. Crete, T. Dolmiere, P. Ladret, M. Nicolas, "The blur effect: perception and estimation with a new no-reference
    perceptual blur metric", SPIE 6492, 2007: the greater of both directions.
    """
    worst = 0.0
    for axis in (0, 1):
        steps = _steps(luma, axis)
        blurred = _steps(np.asarray(cv2.blur(luma, (BLUR_WIDTH, 1) if axis == 1 else (1, BLUR_WIDTH))), axis)
        total = cv2.sumElems(steps)[0]
        kept = cv2.sumElems(cv2.max(cv2.subtract(steps, blurred), 0))[0]  # type: ignore[call-overload]
        worst = max(worst, (total - kept) / total if total > 0 else 1.0)
    return worst


def _steps(luma: Luma, axis: int) -> Luma:
    """How much neighbours along ``axis`` differ; by OpenCV, a third of numpy's time."""
    ahead, behind = (luma[1:], luma[:-1]) if axis == 0 else (luma[:, 1:], luma[:, :-1])
    return np.asarray(cv2.absdiff(ahead, behind), np.float32)


def noise_level(luma: Luma) -> float:
    """Standard deviation of the noise, grey levels: what a mask blind to edges' first order leaves.

    J. Immerkaer, "Fast noise variance estimation", Computer Vision and Image Understanding 64 (1996).
    """
    left = cv2.filter2D(luma, cv2.CV_32F, NOISE_MASK)[1:-1, 1:-1]
    return float(np.sqrt(np.pi / 2) / 6 * np.abs(left).mean(dtype=np.float64))


def contrast(luma: Luma) -> float:
    """Grey levels between the 5th and the 95th percentile (of every fourth pixel in every fourth row)."""
    low, high = np.percentile(luma[::4, ::4], [5, 95])
    return float(high - low)


def largest_hole(depth: NDArray[np.uint16]) -> float:
    """Share of the picture that its largest connected part without a depth return takes; 0 = no return.

    Of every second pixel in every second row: holes that matter are larger, and it is a quarter of the work.
    """
    missing = (depth[::2, ::2] == 0).astype(np.uint8)
    if not missing.any():
        return 0.0
    _, _, stats, _ = cv2.connectedComponentsWithStats(missing, connectivity=4)
    return float(stats[1:, cv2.CC_STAT_AREA].max() / missing.size)
