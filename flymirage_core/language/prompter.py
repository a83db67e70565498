"""Who writes the instructions: the port `Prompter`, and `OfflinePrompter`, which refuses whatever is ambiguous."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Protocol

import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.meaning import Meaning
from flymirage_core.language.prompts import LongPrompt, Prompt, Prompts
from flymirage_core.language.reading import Outcome, read_back, read_itinerary
from flymirage_core.language.referring import expressions, lasting_expression, unique_landmarks
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import StartPose
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.language.wording import Speaker, drawn
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.rendering.frames import Frames
from flymirage_core.scene.keys import rng

WORDINGS = 4
"""Ways of saying a meaning that are tried until one reads back as it was meant."""
JOINED = 0.05
"""Metres between the end of a flight and the start of the next, within which they are one run."""


class Prompter(Protocol):
    """Writes up to three instructions for each kept flight (section III-C); all are read back before they count.

    ``frames`` are there for those who look at pictures: a VLM shows the drone's view with its prompt.
    """

    @property
    def name(self) -> str: ...

    def write(
        self, scene: str, frames: Frames, boxes: BoxMap, flights: Trajectories, verdicts: QualityVerdicts
    ) -> Prompts: ...


@dataclass(frozen=True)
class OfflinePrompter:
    """Referring expressions from boxes: nouns, seen colours, proportions and relations; no model is asked.

    A prompt is written only if the resolver, reading its meaning back against all boxes, finds it certainly true of
    the target and certainly false of everything else, and its text is read back as the target alone; otherwise it is
    refined, and at last refused.
    """

    name: str = "offline 4"

    def write(
        self, scene: str, frames: Frames, boxes: BoxMap, flights: Trajectories, verdicts: QualityVerdicts
    ) -> Prompts:
        """Prompts in the order of flights, then kinds; a kept flight of which nothing sure can be said has none."""
        kept = set(verdicts.kept)
        resolver = Resolver(boxes, StartPose((0.0, 0.0, 0.0), 0.0))
        written: list[Prompt] = []
        for flight in (f for f in flights if f.flight_id in kept):
            here = resolver.seen_from(StartPose.of_flight(flight))
            written += self._flight_prompts(flight, here, rng(scene, "prompts", flight.flight_id))
        long = (self._long_prompt(run, resolver, scene) for run in unbroken_runs(flights, kept))
        return Prompts(tuple(written), tuple(prompt for prompt in long if prompt is not None))

    def _flight_prompts(self, flight: Flight, resolver: Resolver, generator: np.random.Generator) -> list[Prompt]:
        prompts: dict[str, Prompt] = {}
        for kind, meaning in expressions(resolver, flight.object_id, generator):
            speaker = Speaker(unique_landmarks(meaning, resolver), drawn(generator))
            for text in (speaker.sentence(kind, meaning) for _ in range(WORDINGS)):
                if text not in prompts and read_back(text, resolver, flight.object_id).outcome is Outcome.TARGET:
                    prompts[text] = Prompt(flight.flight_id, kind, text, self.name)
                    break
        return list(prompts.values())

    def _long_prompt(self, run: Sequence[Flight], resolver: Resolver, scene: str) -> LongPrompt | None:
        """One instruction for a whole run; None if one of its goals cannot be told apart wherever the drone is."""
        goals = [flight.object_id for flight in run]
        meanings = [m for goal in goals if (m := lasting_expression(resolver, goal)) is not None]
        if len(meanings) < len(goals):
            return None
        generator = rng(scene, "long prompts", run[0].flight_id)
        unique: frozenset[Meaning] = frozenset().union(*(unique_landmarks(m, resolver) for m in meanings))
        speaker = Speaker(unique, drawn(generator))
        for text in (speaker.itinerary(meanings) for _ in range(WORDINGS)):
            if all(reading.outcome is Outcome.TARGET for reading in read_itinerary(text, resolver, goals)):
                return LongPrompt(run[0].set_index, tuple(f.flight_id for f in run), text, self.name)
        return None


def unbroken_runs(flights: Iterable[Flight], kept: set[int]) -> list[list[Flight]]:
    """Flights of one set, two or more, all kept, each of which begins where the one before it ended (section IV)."""
    runs: list[list[Flight]] = []
    for _, legs in groupby(sorted(flights, key=lambda f: f.flight_id), key=lambda f: f.set_index):
        run: list[Flight] = []
        for leg in legs:
            joined = run and float(np.linalg.norm(leg.positions[0] - run[-1].positions[-1])) <= JOINED
            if run and not (joined and leg.flight_id in kept):
                runs.append(run)
                run = []
            run = [*run, leg] if leg.flight_id in kept else []
        runs.append(run)
    return [run for run in runs if len(run) > 1]
