"""`GsplatRasterizer`: Gaussians to RGB, expected depth and alpha on a CUDA card, by gsplat's ``rasterization``.

gsplat is the ``[gpu]`` extra: nothing of it, nor of torch, is imported before a `GsplatRasterizer` is asked for. The
constants that gsplat takes as arguments are those of `cpu_kernels`; the others are compiled into it.
"""

import importlib
import importlib.metadata
import importlib.util
import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from flymirage_core.errors import InputError
from flymirage_core.rendering import cpu_kernels as kernels
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.cpu import drawable
from flymirage_core.rendering.rasterizer import MIN_ALPHA_FOR_DEPTH, Rasterizer, Rendering
from flymirage_core.splats.cloud import GaussianCloud

BATCH_PIXELS = 2**23
"""Most pixels of one call (27 frames of 640 x 480, 20 bytes of answer each): enough to fill a card."""
BATCH_GAUSSIANS = 2**25
"""Most cameras times Gaussians of one call; gsplat needs about 100 bytes for each that a camera sees."""


class GsplatRasterizer(Rasterizer):
    """Renders batches of cameras on a CUDA card. Pictures are those of `cpu.CpuRasterizer` but for rounding.

    Raises `InputError`, when made, if gsplat or a CUDA card is missing.
    """

    def __init__(self, device: str = "cuda") -> None:
        why_not = why_unusable()
        if why_not:
            raise InputError(
                f"renderer is 'gsplat', but {why_not}: pip install 'flymirage[gpu]' on a machine with an NVIDIA card "
                "and its driver, or set renderer to 'auto' or 'cpu'"
            )
        self._torch: Any = importlib.import_module("torch")
        self._gsplat: Any = importlib.import_module("gsplat")
        self._device = device
        self._loaded: tuple[GaussianCloud, _OnCard] | None = None
        self.name = f"gsplat {_version()}"

    def render(self, cloud: GaussianCloud, cameras: Sequence[Camera]) -> Iterator[Rendering]:
        """Pictures in the cameras' order; a batch is rendered when its first picture is asked for."""
        splats = self._on_card(cloud)
        for batch in batches(cameras, splats.count):
            yield from self._render_batch(splats, batch)

    def _render_batch(self, splats: "_OnCard", cameras: list[Camera]) -> Iterator[Rendering]:
        """One call of gsplat for cameras with pictures of one size; rounded on the card, where it costs nothing."""
        torch, k = self._torch, cameras[0].intrinsics
        if splats.count == 0:
            yield from (_blank(k.height, k.width) for _ in cameras)
            return
        with torch.inference_mode():
            colours, alphas, _ = self._gsplat.rasterization(
                means=splats.means,
                quats=splats.quaternions,
                scales=splats.scales,
                opacities=splats.opacities,
                colors=splats.sh,
                sh_degree=splats.sh_degree,
                viewmats=self._tensor(np.stack([c.T_camera_world for c in cameras])),  # (C, 4, 4)
                Ks=self._tensor(np.stack([c.intrinsics.matrix for c in cameras])),  # (C, 3, 3)
                width=k.width,
                height=k.height,
                near_plane=kernels.NEAR,
                far_plane=kernels.FAR,
                eps2d=kernels.BLUR,
                packed=True,
                backgrounds=torch.zeros((len(cameras), 3), device=self._device),  # black
                render_mode="RGB+ED",
            )  # (C, H, W, 4), (C, H, W, 1)
            rgb = torch.round(colours[..., :3].clamp(0, 1) * 255).to(torch.uint8).cpu().numpy()
            alpha = alphas[..., 0]
            depth = torch.where(alpha >= MIN_ALPHA_FOR_DEPTH, colours[..., 3], 0.0).cpu().numpy()
            yield from map(Rendering, rgb, depth, alpha.cpu().numpy())

    def _on_card(self, cloud: GaussianCloud) -> "_OnCard":
        """The cloud's drawable Gaussians as tensors; the last cloud stays on the card."""
        if self._loaded is None or self._loaded[0] is not cloud:
            kept = cloud[drawable(cloud)]
            tensors = _OnCard(
                means=self._tensor(kept.means),
                quaternions=self._tensor(kept.quaternions[:, [3, 0, 1, 2]]),  # gsplat's are wxyz
                scales=self._tensor(np.abs(kept.scales)),
                opacities=self._tensor(np.minimum(kept.opacities, 1)),
                sh=self._tensor(kept.sh),
                sh_degree=kept.sh_degree,
            )
            self._loaded = (cloud, tensors)
        return self._loaded[1]

    def _tensor(self, array: np.ndarray) -> Any:
        return self._torch.as_tensor(np.ascontiguousarray(array, np.float32), device=self._device)


@dataclass(frozen=True, eq=False)
class _OnCard:
    """A cloud as gsplat takes it, float32 torch tensors."""

    means: Any  # (N, 3)
    quaternions: Any  # (N, 4) wxyz
    scales: Any  # (N, 3)
    opacities: Any  # (N,)
    sh: Any  # (N, K, 3)
    sh_degree: int

    @property
    def count(self) -> int:
        return len(self.means)


def why_unusable() -> str:
    """Why gsplat cannot render here, as half a sentence; empty if it can. Imports torch only if gsplat is there.

    >>> why_unusable() in ("", "gsplat is not installed") or why_unusable().startswith("torch")
    True
    """
    if importlib.util.find_spec("gsplat") is None:
        return "gsplat is not installed"
    torch: Any = importlib.import_module("torch")
    if not torch.cuda.is_available():
        return f"torch {torch.__version__} finds no CUDA card"
    return ""


def batches(cameras: Sequence[Camera], gaussians: int) -> Iterator[list[Camera]]:
    """Neighbours in ``cameras`` whose pictures have one size, in groups of what one call may hold; at least one."""
    for _, group in itertools.groupby(cameras, key=lambda c: (c.intrinsics.width, c.intrinsics.height)):
        alike = list(group)
        pixels = alike[0].intrinsics.width * alike[0].intrinsics.height
        size = max(1, min(BATCH_PIXELS // pixels, BATCH_GAUSSIANS // max(gaussians, 1)))
        yield from (alike[first : first + size] for first in range(0, len(alike), size))


def _blank(height: int, width: int) -> Rendering:
    nothing = np.zeros((height, width), np.float32)
    return Rendering(np.zeros((height, width, 3), np.uint8), nothing, nothing)


def _version() -> str:
    try:
        return importlib.metadata.version("gsplat")
    except importlib.metadata.PackageNotFoundError:
        return "of unknown version"
