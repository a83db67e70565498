"""`VlmJudge`: the measured gates first, then a vision-language model on what passed them (paper, section III-C)."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.asking import LanguageModel, load_template
from flymirage_core.errors import ModerationError
from flymirage_core.language.contact_sheet import BOX_COLOUR_NAME, contact_sheets
from flymirage_core.language.facts import name_of
from flymirage_core.language.judge import FrameJudge
from flymirage_core.language.verdicts import GateResult, QualityVerdicts, Verdict
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.progress import track
from flymirage_core.rendering.frames import FlightFrames, Frames

LEAST_SCORE = 3
"""Of five; the template tells the model what it stands for."""
TEMPLATE = load_template("flymirage_core.language", "verdict")


class Aspect(BaseModel):
    """One thing that the model looked at."""

    model_config = ConfigDict(extra="forbid")
    score: int = Field(ge=1, le=5, description="1 = severe, 3 = good enough, 5 = flawless")
    reason: str = Field(min_length=1, description="one sentence: what was seen, in which frame")


class VlmVerdict(BaseModel):
    """The model's answer: three scores with reasons, and what follows from them."""

    model_config = ConfigDict(extra="forbid")
    artifacts: Aspect
    visibility: Aspect
    intent: Aspect
    keep: bool

    @model_validator(mode="after")
    def _agrees(self) -> Self:
        if self.keep is not all(a.score >= LEAST_SCORE for a in (self.artifacts, self.visibility, self.intent)):
            raise ValueError(f"keep is {self.keep}; it must be true exactly if all scores are at least {LEAST_SCORE}")
        return self

    def gates(self) -> tuple[GateResult, ...]:
        """The scores as gates, like the measured ones."""
        aspects = {"vlm_artifacts": self.artifacts, "vlm_visibility": self.visibility, "vlm_intent": self.intent}
        return tuple(
            GateResult(name, a.score, LEAST_SCORE, passed := a.score >= LEAST_SCORE, "" if passed else a.reason)
            for name, a in aspects.items()
        )


@dataclass(frozen=True)
class VlmJudge:
    """Asks the model only about flights that all measured gates let pass; its scores are further gates."""

    measured: FrameJudge
    model: LanguageModel
    frame_step: int
    """Every n-th frame of a 30 Hz video is shown; the paper's is 30."""
    at_once: int = 4
    """Flights that are asked about at the same time."""

    @property
    def name(self) -> str:
        return f"{self.measured.name} + {self.model.name} (prompt {TEMPLATE.fingerprint(VlmVerdict)})"

    def judge(self, frames: Frames, flights: Trajectories, boxes: BoxMap) -> QualityVerdicts:
        """One verdict for each flight, in their order; raises `ProductError` and `ServiceError`s."""
        measured = self.measured.judge(frames, flights, boxes)
        with ThreadPoolExecutor(self.at_once) as pool:
            verdicts = pool.map(lambda v, flight: self._judged(v, flight, frames, boxes), measured, flights)
            return QualityVerdicts(tuple(track(verdicts, "verdicts", len(measured))))

    def _judged(self, verdict: Verdict, flight: Flight, frames: Frames, boxes: BoxMap) -> Verdict:
        if not verdict.keep:
            return replace(verdict, judge=self.name)
        gates = self._asked(frames.flight(flight.flight_id), boxes.by_id(flight.object_id))
        keep = all(gate.passed for gate in gates)
        return Verdict(flight.flight_id, keep, (*verdict.gates, *gates), self.name)

    def _asked(self, frames: FlightFrames, target: ObjectBox) -> tuple[GateResult, ...]:
        sheets = contact_sheets(frames, target, self.frame_step)
        values = {
            "frames": str(sheets.frames),
            "seconds": f"{sheets.seconds_apart:.1f}",
            "colour": BOX_COLOUR_NAME,
            "target": name_of(target),
        }
        question = TEMPLATE.question(values, (sheets.bare, sheets.boxed), seed=frames.flight_id)
        try:
            return self.model.answer(question, VlmVerdict).gates()
        except ModerationError as refusal:
            return (GateResult("vlm_refused", 0.0, 1.0, False, f"the model refused to look at it: {refusal}"),)
