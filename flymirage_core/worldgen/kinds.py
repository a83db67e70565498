"""`Kind`: a buildable kind of thing, its size range and how it is usually made; and fitting parts into a size."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from flymirage_core.worldgen.meshes import corners_of
from flymirage_core.worldgen.parts import Finish
from flymirage_core.worldgen.surfaces import Part, Vector, vector

Builder = Callable[[Vector, Finish], list[Part]]
Range = tuple[float, float]


@dataclass(frozen=True)
class Kind:
    """A buildable kind of thing: sizes in metres (x, y, z) from ``smallest`` to ``largest``; +y is its front.

    ``usual`` is its usual (colour, material). ``top`` is where small things can stand, as a share of its height
    (0 = nowhere). A ``square`` kind keeps its proportions; a ``full_height`` one reaches from floor to ceiling; a
    ``flat`` one lies under things.
    """

    builder: Builder
    smallest: Vector
    largest: Vector
    usual: tuple[str, str] = ("grey", "painted steel")
    top: float = 0.0
    square: bool = False
    full_height: bool = False
    flat: bool = False

    def size(self, rng: np.random.Generator, room_height: float) -> Vector:
        """A size within the range: large in all directions or small in all, with some freedom unless ``square``."""
        large = rng.uniform(0.0, 1.0)
        share = np.full(3, large) if self.square else np.clip(large + rng.normal(0.0, 0.2, 3), 0.0, 1.0)
        x, y, z = (a + s * (b - a) for a, b, s in zip(self.smallest, self.largest, share, strict=True))
        return x, y, room_height if self.full_height else z

    def build(self, size: Vector, finish: Finish) -> list[Part]:
        """Parts whose bounds are exactly the box of ``size`` that stands on z = 0 with its middle over the origin."""
        return fitted(self.builder(size, finish), size)


def kind(
    builder: Builder, x: Range, y: Range, z: Range, usual: tuple[str, str] = ("grey", "painted steel"), top: float = 0.0
) -> Kind:
    return Kind(builder, (x[0], y[0], z[0]), (x[1], y[1], z[1]), usual, top)


def round_kind(
    builder: Builder, width: Range, z: Range, usual: tuple[str, str] = ("grey", "painted steel"), top: float = 0.0
) -> Kind:
    """As wide as deep, and of fixed proportions."""
    return Kind(builder, (width[0], width[0], z[0]), (width[1], width[1], z[1]), usual, top, square=True)


def fitted(parts: Sequence[Part], size: Vector) -> list[Part]:
    """The parts stretched along x, y and z, and shifted, until their bounds are exactly the box of ``size``."""
    ends = np.array([(c.min(axis=0), c.max(axis=0)) for c in map(corners_of, parts)])  # (M, 2, 3)
    low, high = ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)
    stretch = np.asarray(size) / np.maximum(high - low, 1e-9)
    base = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    return [
        replace(p, offset=vector((np.asarray(p.offset) - base) * stretch), rotation=stretch[:, None] * p.rotation)
        for p in parts
    ]
