"""Names for observed boxes: what the detector's views agree on, what the recogniser is sure of, else "object".

And whether a box is believed at all.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from flymirage_core.annotation.appearance import Observation
from flymirage_core.annotation.box_fitting import FittedBox
from flymirage_core.annotation.carving import Detections
from flymirage_core.annotation.labels import UNKNOWN, Support
from flymirage_core.annotation.picture_votes import Vote
from flymirage_core.annotation.recogniser import Recognition, trained_recogniser

SURE: Final = 0.9
"""Probability from which the recogniser's noun stands against the detector's."""
HALF_VOTE: Final = 1.5
"""Weight of votes that is worth a score of one half."""


MAX_LEFT_OVER: Final = 0.76
"""Probability of being no object of its own from which a box that the detector does not know is dropped."""
BULKY: Final = 0.4
"""Metres; unless it is as thick as this ..."""
WELL_SEEN: Final = 24
"""... and so many views saw it: that is a thing, though perhaps a new one."""
NEAR_ENOUGH: Final = 3.0
"""Metres; what no view saw from so near, as in the first pass, is judged more gently."""
MAX_LEFT_OVER_AFAR: Final = 0.9
"""The probability from which that is dropped."""
LEAST_THICKNESS: Final = 0.04
"""Metres of a thing that nobody has a name for, unless it is flat on a wall; what is thinner is a slat, a strip."""
MIN_VIEWS: Final = 4
"""Views that must have seen a thing that nobody has a name for, unless it surely is one."""
PANEL: Final = 2.0
"""Metres of the longest side from which a nameless flat thing on a wall is a part of the wall."""
PILLAR: Final = (2.2, 0.8)
"""Metres of height from which, and of the shorter side up to which, a nameless thing is a pillar, a door, a post ..."""
LIKE_A_PILLAR: Final = 0.25
"""... from this left-over probability on."""
BARE_FRONT: Final = 0.05
"""Metres of relief up to which only a face flush with its wall was seen of a thing above the floor: a panel of the
wall, a headboard behind pillows, if nobody has a name for it."""
TELEVISION: Final = "television"
BUILDING: Final = frozenset({"door", "window"})
"""What has a name, but is no thing."""
LIKELY: Final = 0.5
"""Score of a name below which a box counts as nameless when it is judged whether it is a part of the building."""


@dataclass(frozen=True)
class Doubt:
    """Left-over probabilities from which a box that nobody has a name for is dropped."""

    nameless: float
    unsure: float  # ... if it is thin or few views saw it
    bare_front: float  # ... if only a flat face was seen of it


ALONE: Final = Doubt(0.76, 0.7, 0.5)
BESIDE_DETECTOR: Final = Doubt(0.72, 0.6, 0.35)
"""Where a detector looked too, and knew nothing, less is believed."""


@dataclass(frozen=True)
class Name:
    """What a box is called, by what, how sure (0..1), what it seems to be made of, and whether it is anything."""

    noun: str
    source: str  # "detector", "recogniser"
    score: float
    material: str
    left_over: float  # probability that it is no object of its own


def named(things: Sequence[Observation], votes: Sequence[Vote | None]) -> list[Name]:
    """A name for each box."""
    if not things:
        return []
    recognised = trained_recogniser().recognise(np.stack([thing.features for thing in things]))
    return [chosen_name(r, vote, thing.box) for thing, r, vote in zip(things, recognised, votes, strict=True)]


def is_believed(box: FittedBox, name: Name, seen: Detections, doubt: Doubt = ALONE) -> bool:
    """Whether a box is an object: what the detector knows is; what looks like a left-over is not."""
    if name.source == "detector":
        return True
    if seen.nearest > NEAR_ENOUGH:
        return name.left_over < MAX_LEFT_OVER_AFAR
    thin, _, longest = sorted(box.size)
    bulky = thin >= BULKY and seen.views >= WELL_SEEN
    limit = MAX_LEFT_OVER if name.noun != UNKNOWN else doubt.nameless
    if name.noun in BUILDING or (name.left_over >= limit and not bulky):
        return False
    if name.noun == UNKNOWN and _is_pillar(box) and name.left_over >= LIKE_A_PILLAR:
        return False
    if not _is_unsure(name):
        return True
    if box.on_wall and longest > PANEL:
        return False
    slat = thin < LEAST_THICKNESS and not box.on_wall
    return name.left_over < doubt.unsure or not (slat or seen.views < MIN_VIEWS)


def is_bare_front(thing: Observation, name: Name, doubt: Doubt = ALONE) -> bool:
    """Whether nothing but a flat piece of a wall, or of what covers it, was seen."""
    built = thing.support is not Support.FLOOR and not thing.box.on_wall
    return _is_unsure(name) and built and thing.relief < BARE_FRONT and name.left_over >= doubt.bare_front


def _is_unsure(name: Name) -> bool:
    """Whether nobody has a name for it that is likelier than not."""
    return name.noun == UNKNOWN or name.score < LIKELY


def _is_pillar(box: FittedBox) -> bool:
    return box.size[2] > PILLAR[0] and min(box.size[:2]) < PILLAR[1]


def chosen_name(recognition: Recognition, vote: Vote | None, box: FittedBox) -> Name:
    """The recogniser's finer noun where both agree on the kind; the detector's where the recogniser is not sure.

    What hangs flat on a wall may be a picture: the detector takes those for televisions, so the recogniser decides.
    """
    score = 0.0 if recognition.noun == UNKNOWN else recognition.confidence
    own = Name(recognition.noun, "recogniser", score, recognition.material, recognition.left_over)
    if vote is None or agree(recognition.noun, vote.noun) or score >= SURE:
        return own
    if box.on_wall and (score > 0 or vote.noun == TELEVISION):
        return own
    weight = vote.weight / (vote.weight + HALF_VOTE)
    return Name(vote.noun, "detector", weight, recognition.material, recognition.left_over)


def agree(fine: str, coarse: str) -> bool:
    """Whether one noun is a kind of the other, as far as words tell: "office chair" is a "chair"."""
    return fine == coarse or fine.endswith(f" {coarse}") or coarse.endswith(f" {fine}")
