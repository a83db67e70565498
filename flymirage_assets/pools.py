"""Scarce things that stages of several runs share: each paid service, the GPU, the CPU renderer. A pool for each.

A pool limits how many stages use the thing at once; requests per minute are limited where the requests are made.
"""

from collections.abc import Sequence

from flymirage_core.settings import Settings
from resources.tools import choose_rasterizer, is_service

POOL_OF_SERVICE = {
    "scene_writer": "language_model",
    "image_painter": "image_model",
    "world_model": "world_model",
    "frame_judge": "vision_model",
    "prompter": "vision_model",
}
POOL_LIMITS = {
    "language_model": 4,
    "image_model": 4,
    "world_model": 4,
    "vision_model": 4,
    "gpu": 1,
    "cpu_renderer": 1,
}
"""At once, over all runs; change one with `dagster instance concurrency set POOL N` or in the UI under Deployment."""


def is_paid(settings: Settings, ports: Sequence[str]) -> bool:
    """True if a service that costs money fills one of the ports."""
    return any(is_service(settings, port) for port in ports)


def pool_of(settings: Settings, ports: Sequence[str]) -> str | None:
    """The pool of a stage that uses ``ports``: that of its first service, else of the renderer, else none."""
    for port in ports:
        if is_service(settings, port):
            return POOL_OF_SERVICE[port]
    if "rasterizer" not in ports:
        return None
    return "gpu" if choose_rasterizer(settings).name.startswith("gsplat") else "cpu_renderer"
