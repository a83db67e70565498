"""`Layout`: a place while it is being furnished, and what fits where in it. Who puts what where is in `placers`."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from flymirage_core.scene.design import PlannedObject
from flymirage_core.worldgen.building import ceiling_at
from flymirage_core.worldgen.catalogue import kind_of
from flymirage_core.worldgen.footprints import Occupied, Solid
from flymirage_core.worldgen.kinds import Kind
from flymirage_core.worldgen.place import Place, Space
from flymirage_core.worldgen.truth import PlacedObject

Size = tuple[float, float, float]

FREE_BALL = 1.05
"""Metres round c that stay empty."""
SHARES = {"small": (0.0, 0.35), "medium": (0.2, 0.8), "large": (0.65, 1.0)}
"""Of the way from a kind's smallest to its largest size."""
OPEN_TOP = 15.0
"""Metres: things in the open air are lower."""


@dataclass
class Layout:
    """The place being furnished."""

    place: Place
    centre: tuple[float, float, float]
    rng: np.random.Generator
    objects: list[PlacedObject] = field(default_factory=list)
    occupied: Occupied = field(default_factory=Occupied)
    kept_clear: Occupied = field(default_factory=Occupied)  # before windows and doors, and from doors to the middle
    missing: dict[tuple[str, str], int] = field(default_factory=dict)
    anchored: dict[int, int] = field(default_factory=dict)  # chairs already round each anchor

    def fits(self, space: Space, solid: Solid, gap: float) -> bool:
        """Inside the space, out of the free ball, and ``gap`` metres away from everything (in plan)."""
        reach = solid.reach
        spot = np.array([solid.x, solid.y])
        if not ((spot - reach >= space.low - 1e-6) & (spot + reach <= space.high + 1e-6)).all():
            return False
        top = OPEN_TOP if space.open_air else min(ceiling_at(space, spot + s * reach) for s in (-1, 1))
        lowest = solid.top <= top + 1e-6
        return lowest and solid.distance_to(self.centre) >= FREE_BALL and not self.occupied.hits(solid, gap)

    def fits_clear(self, space: Space, solid: Solid, gap: float) -> bool:
        """`fits`, and not before a window or in the way of a door either."""
        return self.fits(space, solid, gap) and not self.kept_clear.hits(solid, 0.0)

    def first(self, space: Space, spots: Iterator[Solid], gap: float) -> Solid | None:
        return next((s for s in spots if self.fits_clear(space, s, gap)), None)

    def put(self, planned: PlannedObject, space: Space, solid: Solid, support: int = -1) -> int:
        """Record an object; returns its id."""
        number = len(self.objects)
        self.objects.append(
            PlacedObject(
                number,
                planned.noun,
                planned.colour,
                planned.material,
                planned.state,
                space.zone.name,
                planned.placement,
                (round(solid.x, 4), round(solid.y, 4), round((solid.bottom + solid.top) / 2, 4)),
                (round(solid.width, 4), round(solid.depth, 4), round(solid.top - solid.bottom, 4)),
                round(solid.yaw, 5),
                support,
                int(self.rng.integers(1 << 31)),
            )
        )
        if not kind_of(planned.noun).flat:
            self.occupied.add(solid)
        return number

    def miss(self, noun: str, reason: str, count: int = 1) -> None:
        self.missing[noun, reason] = self.missing.get((noun, reason), 0) + count

    def named(self, planned: PlannedObject, space: Space) -> list[PlacedObject]:
        """The placed things that ``planned`` is relative to: those of its own space, else any."""
        every = [o for o in self.objects if planned.relative_to and o.noun == planned.relative_to]
        return [o for o in every if o.zone == space.zone.name] or every

    def size(self, space: Space, planned: PlannedObject, kind: Kind) -> Size:
        """A size of the kind as the plan's word says: large in all directions or small in all, with some freedom."""
        large = self.rng.uniform(*SHARES[planned.size])
        share = np.full(3, large) if kind.square else np.clip(large + self.rng.normal(0.0, 0.12, 3), 0.0, 1.0)
        x, y, z = (float(a + s * (b - a)) for a, b, s in zip(kind.smallest, kind.largest, share, strict=True))
        return x, y, min(space.height, OPEN_TOP) if kind.full_height else z
