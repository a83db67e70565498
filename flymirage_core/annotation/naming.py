"""Names for observed boxes: what the detector's views agree on, what the recogniser is sure of, else "object"."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from flymirage_core.annotation.appearance import Observation
from flymirage_core.annotation.labels import UNKNOWN
from flymirage_core.annotation.picture_votes import Vote
from flymirage_core.annotation.recogniser import Recognition, trained_recogniser

SURE: Final = 0.9
"""Probability from which the recogniser's noun stands against the detector's."""
HALF_VOTE: Final = 1.5
"""Weight of votes that is worth a score of one half."""


@dataclass(frozen=True)
class Name:
    """What a box is called, by what, how sure (0..1), and what it seems to be made of."""

    noun: str
    source: str  # "detector", "recogniser"
    score: float
    material: str


def named(things: Sequence[Observation], votes: Sequence[Vote | None]) -> list[Name]:
    """A name for each box."""
    if not things:
        return []
    recognised = trained_recogniser().recognise(np.stack([thing.features for thing in things]))
    return [_name(recognition, vote) for recognition, vote in zip(recognised, votes, strict=True)]


def _name(recognition: Recognition, vote: Vote | None) -> Name:
    """The recogniser's finer noun where both agree on the kind; the detector's where the recogniser is not sure."""
    score = 0.0 if recognition.noun == UNKNOWN else recognition.confidence
    own = Name(recognition.noun, "recogniser", score, recognition.material)
    if vote is None or agree(recognition.noun, vote.noun) or (score >= SURE):
        return own
    return Name(vote.noun, "detector", vote.weight / (vote.weight + HALF_VOTE), recognition.material)


def agree(fine: str, coarse: str) -> bool:
    """Whether one noun is a kind of the other, as far as words tell: "office chair" is a "chair"."""
    return fine == coarse or fine.endswith(f" {coarse}") or coarse.endswith(f" {fine}")
