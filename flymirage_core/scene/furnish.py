"""Which things stand in a zone, how many, and where: its kits, then fillers, within what floor and walls can take."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flymirage_core.scene.design import NEEDS_ANOTHER, OUTDOOR_KINDS, Placement, PlannedObject, Zone
from flymirage_core.scene.knowledge import Noun, Row, Want, ageing, fillers, kits, nouns

FLOOR_SHARE = 0.3
"""Of a zone's ground, what things may cover."""
WALL_SHARE = 0.7
"""Of the walls' length, what stands before them; of the walls' upper half, what hangs on them."""
CEILING_SHARE = 0.25
HEADROOM = 0.15
"""Metres that are kept between a thing and the ceiling."""
COLOUR_WEIGHT = 4.0
"""How much likelier a colour of the scene's palette is."""
STATE_SHARE = 0.3
"""Of the groups of things that have visible states, how many are in one."""
AGEING_SHARE, AGED_SHARE = 0.04, 0.2
"""Of other groups, how many show the age of their material: in most places, and in aged ones."""
SIZE_SHARES = (("small", 0.15), ("medium", 0.7), ("large", 0.15))
FILLER_TRIES = 400
"""Seeded draws of fillers before a zone counts as full."""
FILLER_MOST = 5
"""Of one noun in a zone, as far as fillers go."""
ORDER: tuple[Placement, ...] = ("on_surface", "on_wall", "on_floor", "against_wall", "hanging", "in_row")


@dataclass
class Budget:
    """What a zone can still take: square metres of ground and ceiling, metres of wall below and above, tops."""

    zone: Zone
    wants: Counter[Want] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        x, y, _ = self.zone.dimensions
        walls = WALL_SHARE * 2 * (x + y)
        self.free = {"ground": FLOOR_SHARE * x * y, "ceiling": CEILING_SHARE * x * y, "wall": walls, "high_wall": walls}

    def has(self, noun: str) -> bool:
        return any(w.noun == noun for w in self.wants)

    def free_tops(self, on: str = "") -> int:
        """How many more small things can be put on things, or on those of one kind."""
        tops = sum(nouns()[w.noun].holds * n for w, n in self.wants.items() if on in ("", w.noun))
        return tops - sum(n for w, n in self.wants.items() if w.placement == "on_surface" and on in ("", w.relative_to))

    def add(self, want: Want, number: int) -> int:
        """Take up to ``number`` things in, as far as they fit; returns how many."""
        want = self._anchored(want)
        kind = nouns()[want.noun]
        if not self._fits_height(kind, want.placement):
            return 0
        for taken in range(number):
            if not self._take(kind, want):
                return taken
            self.wants[want] += 1
        return number

    def _anchored(self, want: Want) -> Want:
        """Without a relation to what is not there: such a thing stands where its kind may stand otherwise."""
        if not want.relative_to or self.has(want.relative_to):
            return want
        plain = [p for p in nouns()[want.noun].placements if p not in NEEDS_ANOTHER]
        return Want(want.noun, plain[0] if want.placement in NEEDS_ANOTHER and plain else want.placement)

    def _fits_height(self, kind: Noun, placement: Placement) -> bool:
        if placement == "hanging" and self.zone.kind in OUTDOOR_KINDS:
            return kind.strung
        return self.zone.kind in OUTDOOR_KINDS or kind.size[2] + HEADROOM <= self.zone.dimensions[2]

    def _take(self, kind: Noun, want: Want) -> bool:
        x, y, _ = kind.size
        if want.placement in NEEDS_ANOTHER and not want.relative_to:
            return False
        if want.placement == "on_surface":
            return self.free_tops(want.relative_to) > 0 and self.free_tops() > 0
        where, need = {
            "on_wall": ("high_wall", x + 0.3),
            "hanging": ("ceiling", x * y + 0.3),
            "against_wall": ("wall", x + 0.2),
        }.get(want.placement, ("ground", x * y))
        if need > self.free[where]:
            return False
        self.free[where] -= need
        return True


def fill_zone(
    zone: Zone, own: Sequence[str], options: Sequence[str], filler: str, wanted: int, generator: np.random.Generator
) -> Counter[Want]:
    """What stands in a zone: its ``own`` kits, a seeded choice of ``options``, then fillers up to ``wanted``."""
    budget = Budget(zone)
    chosen = [*own, *(str(k) for k in generator.permutation(list(options)))]
    for number, kit in enumerate(chosen):
        if number >= len(own) and sum(budget.wants.values()) > 0.85 * wanted:
            break
        rows = kits()[kit]
        for row in sorted(rows, key=_relates):
            budget.add(row.want, int(generator.integers(row.least, row.most + 1)))
    choices = fillers()[filler]
    for _ in range(FILLER_TRIES):
        if sum(budget.wants.values()) >= wanted:
            break
        noun = str(pick(generator, choices))
        if sum(n for w, n in budget.wants.items() if w.noun == noun) >= FILLER_MOST:
            continue
        for placement in ORDER:
            if placement in nouns()[noun].placements and budget.add(Want(noun, placement), 1):
                break
    return budget.wants


def _relates(row: Row) -> bool:
    return bool(row.want.relative_to)


def in_finishes(
    wants: Counter[Want], zone: str, palette: Sequence[str], aged: bool, generator: np.random.Generator
) -> list[PlannedObject]:
    """The wants as planned objects: one material for a noun, a few colours, the palette's first; sizes and states."""
    materials: dict[str, str] = {}
    planned: Counter[PlannedObject] = Counter()
    for want, number in wants.items():
        kind = nouns()[want.noun]
        material = materials.setdefault(want.noun, str(pick(generator, list(kind.finishes))))
        colours = _in_palette(kind.finishes[material], palette, generator)
        most = 1 if want.placement in ("around", "in_row", "facing") else min(number, len(colours), 3)
        groups = int(generator.integers(1, most + 1))
        for i in range(groups):
            share = number // groups + (i < number % groups)
            state = _state(kind, material, AGED_SHARE if aged else AGEING_SHARE, generator)
            one = PlannedObject(
                noun=want.noun,
                count=1,
                colour=colours[i],
                material=material,
                size=_size(want, generator),
                state=state,
                placement=want.placement,
                relative_to=want.relative_to,
                zone=zone,
            )
            planned[one] += share
    return [one.model_copy(update={"count": n}) for one, n in planned.items()]


def _in_palette(colours: Sequence[str], palette: Sequence[str], generator: np.random.Generator) -> list[str]:
    """All colours in a seeded order in which those of the palette tend to come first."""
    weights = np.array([COLOUR_WEIGHT if c in palette else 1.0 for c in colours])
    order = generator.choice(len(colours), size=len(colours), replace=False, p=weights / weights.sum())
    return [colours[int(i)] for i in order]


def _state(kind: Noun, material: str, old: float, generator: np.random.Generator) -> str:
    """A state of such things, else with chance ``old`` one that shows the material's age, else none."""
    share = generator.uniform()
    if kind.states and share < STATE_SHARE:
        return str(pick(generator, kind.states))
    return str(pick(generator, ageing(material))) if share > 1 - old and ageing(material) else ""


def _size(want: Want, generator: np.random.Generator) -> Any:
    share = generator.uniform()
    if want.placement in ("on_surface", "around", "in_row"):
        return "medium"
    return SIZE_SHARES[int(np.searchsorted(np.cumsum([s for _, s in SIZE_SHARES]), share))][0]


def pick(generator: np.random.Generator, choices: Sequence[Any]) -> Any:
    """One of the choices."""
    return choices[int(generator.integers(len(choices)))]
