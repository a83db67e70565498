"""Pictures as bytes of a bounded size."""

import cv2
import numpy as np
from numpy.typing import NDArray


def jpeg_under(rgb: NDArray[np.uint8], max_bytes: int) -> bytes:
    """JPEG of ``rgb`` (H, W, 3) in at most ``max_bytes``: quality falls to 60, then the size shrinks by quarters."""
    image: NDArray[np.uint8] = np.ascontiguousarray(rgb[:, :, ::-1])
    while True:
        for quality in (88, 75, 60):
            data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()
            if len(data) <= max_bytes:
                return data
        height, width = image.shape[:2]
        smaller = (max(1, width * 3 // 4), max(1, height * 3 // 4))
        image = cv2.resize(image, smaller, interpolation=cv2.INTER_AREA).astype(np.uint8)
