"""`GaussianCloud`: 3D Gaussians as arrays, and nothing else."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import WorldError

Float32 = NDArray[np.float32]


@dataclass(frozen=True)
class GaussianCloud:
    """N anisotropic 3D Gaussians in the world frame (right-handed, z up, metres).

    Quaternions are xyzw and unit length here; wxyz stands only in PLY files and at gsplat's door. Scales are standard
    deviations in metres (not logarithms), opacities lie in [0, 1] (not logits). ``sh[:, 0]`` is the DC term: the colour
    seen is ``max(0.5 + sum_k basis_k(direction) sh[:, k], 0)``, gsplat's convention.
    """

    means: Float32  # (N, 3)
    quaternions: Float32  # (N, 4) xyzw
    scales: Float32  # (N, 3)
    opacities: Float32  # (N,)
    sh: Float32  # (N, K, 3), K = (degree + 1)**2, degree 0..3

    def __post_init__(self) -> None:
        n = len(self.means)
        shapes = {
            "means": (self.means.shape, (n, 3)),
            "quaternions": (self.quaternions.shape, (n, 4)),
            "scales": (self.scales.shape, (n, 3)),
            "opacities": (self.opacities.shape, (n,)),
            "sh": (self.sh.shape, (n, self.sh.shape[1] if self.sh.ndim == 3 else 1, 3)),
        }
        for name, (found, expected) in shapes.items():
            if found != expected:
                raise WorldError(f"Gaussian cloud: {name} has shape {found}, expected {expected}")
            if getattr(self, name).dtype != np.float32:
                raise WorldError(f"Gaussian cloud: {name} is {getattr(self, name).dtype}, expected float32")
        if self.sh.shape[1] not in (1, 4, 9, 16):
            raise WorldError(
                f"Gaussian cloud: {self.sh.shape[1]} SH coefficients, expected 1, 4, 9 or 16 (degree 0 to 3)"
            )

    def __len__(self) -> int:
        return len(self.means)

    @property
    def sh_degree(self) -> int:
        return int(np.sqrt(self.sh.shape[1])) - 1

    def __getitem__(self, index: NDArray[np.bool_] | NDArray[np.intp] | slice) -> "GaussianCloud":
        """The Gaussians that a mask, an index array or a slice picks."""
        return GaussianCloud(
            self.means[index], self.quaternions[index], self.scales[index], self.opacities[index], self.sh[index]
        )
