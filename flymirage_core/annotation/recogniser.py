"""`Recogniser`: the noun and the material of a box, by a small network trained on renders of generated worlds.

Weights and model card lie beside this file (`recogniser.npz`, `RECOGNISER.md`); `benchmarks/train_recogniser.py` makes
both. Inference is numpy: two hidden layers, an ensemble whose probabilities are averaged.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.appearance import FEATURES
from flymirage_core.annotation.labels import UNKNOWN
from flymirage_core.errors import ProductError

Float32 = NDArray[np.float32]

CLIP: Final = 4.0
"""Standard deviations to which a feature is cut: what never occurred in training must not run away with the result."""


@dataclass(frozen=True)
class Recognition:
    """What a box was taken for."""

    noun: str  # a noun, the name of a family of nouns, or "object" where neither is sure enough
    confidence: float  # probability of the noun, or of the family, 0..1; calibrated on worlds not trained on
    material: str  # "" where no material is sure enough
    left_over: float  # probability that it is no object of its own: a part of one, of several, or of the building


@dataclass(frozen=True, eq=False)
class Recogniser:
    """E networks: F features -> H -> G hidden units -> nouns, materials. Arrays as in `recogniser.npz`."""

    mean: Float32  # (F,)
    scale: Float32  # (F,)
    hidden: tuple[tuple[Float32, Float32], ...]  # (E, in, out) weights and (E, 1, out) biases of each layer
    noun_head: tuple[Float32, Float32]  # (E, G, N + 1), (E, 1, N + 1); the last class is "no object of its own"
    material_head: tuple[Float32, Float32]  # (E, G, M), (E, 1, M)
    nouns: tuple[str, ...]  # N
    families: tuple[str, ...]  # N: the family of each noun, its own name if it has none
    materials: tuple[str, ...]  # M
    min_noun: float  # least probability to say a noun, a family, a material
    min_family: float
    min_material: float

    def recognise(self, features: Float32) -> list[Recognition]:
        """What each of the things with ``features`` (K, F) is."""
        if not len(features):
            return []
        nouns, materials = self.probabilities(features)  # (K, N + 1), (K, M)
        return [self._decided(p, m) for p, m in zip(nouns, materials, strict=True)]

    def probabilities(self, features: Float32) -> tuple[Float32, Float32]:
        """Probabilities (K, N + 1) of the nouns, the last of none of them, and (K, M) of the materials."""
        x = np.clip((features - self.mean) / self.scale, -CLIP, CLIP)[None]  # (1, K, F)
        for weights, biases in self.hidden:
            x = np.maximum(x @ weights + biases, 0)
        return tuple(_softmax(x @ w + b).mean(axis=0) for w, b in (self.noun_head, self.material_head))  # type: ignore[return-value]

    def _decided(self, nouns: Float32, materials: Float32) -> Recognition:
        best = int(nouns[:-1].argmax())
        left_over = float(nouns[-1])
        m = int(materials.argmax())
        material = self.materials[m] if materials[m] >= self.min_material else ""
        if nouns[best] >= self.min_noun:
            return Recognition(self.nouns[best], float(nouns[best]), material, left_over)
        totals = dict.fromkeys(self.families, 0.0)
        for name, p in zip(self.families, nouns[:-1], strict=True):
            totals[name] += float(p)
        family = max(totals, key=lambda name: totals[name])
        if totals[family] >= self.min_family:
            return Recognition(family, totals[family], material, left_over)
        return Recognition(UNKNOWN, float(nouns[best]), material, left_over)


def _softmax(logits: Float32) -> Float32:
    e = np.exp(logits - logits.max(axis=-1, keepdims=True))
    return np.asarray(e / e.sum(axis=-1, keepdims=True), np.float32)


@cache
def trained_recogniser() -> Recogniser:
    """The one whose weights come with this project; raises `ProductError` if they are for other features."""
    with resources.files("flymirage_core.annotation").joinpath("recogniser.npz").open("rb") as file:
        arrays = dict(np.load(file, allow_pickle=False))
    if arrays["mean"].shape != (FEATURES,):
        raise ProductError(
            f"flymirage_core/annotation/recogniser.npz is for {arrays['mean'].size} features, this code measures "
            f"{FEATURES}: train it again with benchmarks/train_recogniser.py"
        )
    return recogniser_of(arrays)


def recogniser_of(arrays: dict[str, NDArray[np.generic]]) -> Recogniser:
    """A recogniser from the arrays of its file."""

    def layer(name: str) -> tuple[Float32, Float32]:
        return np.asarray(arrays[f"{name}_weights"], np.float32), np.asarray(arrays[f"{name}_biases"], np.float32)

    def words(name: str) -> tuple[str, ...]:
        return tuple(str(word) for word in arrays[name])

    thresholds: Sequence[float] = [float(t) for t in arrays["thresholds"]]  # type: ignore[arg-type]
    return Recogniser(
        mean=np.asarray(arrays["mean"], np.float32),
        scale=np.asarray(arrays["scale"], np.float32),
        hidden=(layer("first"), layer("second")),
        noun_head=layer("noun"),
        material_head=layer("material"),
        nouns=words("nouns"),
        families=words("families"),
        materials=words("materials"),
        min_noun=thresholds[0],
        min_family=thresholds[1],
        min_material=thresholds[2],
    )
