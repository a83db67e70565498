"""`VlmPrompter`: a vision-language model writes the instructions, told what is really there; the resolver reads each
back, and what it does not read as the target alone is refined once, and then left to the offline prompter."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Final

from pydantic import BaseModel, ConfigDict, Field

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.asking import LanguageModel, load_template
from flymirage_core.errors import ModerationError
from flymirage_core.language.contact_sheet import BOX_COLOUR_NAME, ContactSheets, contact_sheets
from flymirage_core.language.facts import facts_about
from flymirage_core.language.prompter import OfflinePrompter
from flymirage_core.language.prompts import Prompt, PromptKind, Prompts
from flymirage_core.language.reading import Outcome, read_back
from flymirage_core.language.resolver import Resolver
from flymirage_core.language.scene_relations import StartPose
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.progress import track
from flymirage_core.rendering.frames import Frames

KINDS: Final[tuple[PromptKind, ...]] = ("object_centred", "relative", "appearance")
TEMPLATE = load_template("flymirage_core.language", "instructions")
KIND_TEMPLATES = {kind: load_template("flymirage_core.language", kind) for kind in KINDS}
MOST_CHARACTERS = 240


class Instructions(BaseModel):
    """The model's answer: one sentence of each kind, "" where none is possible."""

    model_config = ConfigDict(extra="forbid")
    object_centred: str = Field(max_length=MOST_CHARACTERS, description="by its noun")
    relative: str = Field(max_length=MOST_CHARACTERS, description="by what it stands next to")
    appearance: str = Field(max_length=MOST_CHARACTERS, description="by how it looks")

    def of(self, kind: PromptKind) -> str:
        return str(getattr(self, kind)).strip()


@dataclass(frozen=True)
class VlmPrompter:
    """Up to three instructions for each kept flight. ``writer`` of a prompt says who found its words."""

    model: LanguageModel
    frame_step: int
    at_once: int = 4
    offline: OfflinePrompter = field(default_factory=OfflinePrompter)

    @property
    def name(self) -> str:
        return f"{self.model.name} (prompt {fingerprint()}, every {self.frame_step}th frame), else {self.offline.name}"

    def write(
        self, scene: str, frames: Frames, boxes: BoxMap, flights: Trajectories, verdicts: QualityVerdicts
    ) -> Prompts:
        """Prompts in the order of flights, then kinds; raises `ServiceError`s."""
        plain = self.offline.write(scene, frames, boxes, flights, verdicts)
        kept = set(verdicts.kept)
        wanted = [flight for flight in flights if flight.flight_id in kept]
        with ThreadPoolExecutor(self.at_once) as pool:
            written = pool.map(lambda flight: self._flight_prompts(flight, frames, boxes, plain), wanted)
            prompts = [prompt for of_flight in track(written, "flights", len(wanted)) for prompt in of_flight]
        return Prompts(tuple(prompts), plain.long_prompts)

    def _flight_prompts(self, flight: Flight, frames: Frames, boxes: BoxMap, plain: Prompts) -> list[Prompt]:
        """The model's sentence of each kind where it reads back, else the offline one."""
        resolver = Resolver(boxes, StartPose.of_flight(flight))
        target = boxes.by_id(flight.object_id)
        sheets = contact_sheets(frames.flight(flight.flight_id), target, self.frame_step)
        good, bad = self._asked(flight, resolver, sheets, "")
        if bad:
            missing = {kind for kind in KINDS if kind not in good}
            again, _ = self._asked(flight, resolver, sheets, _complaints(bad))
            good |= {kind: text for kind, text in again.items() if kind in missing and text not in good.values()}
        writer = f"{self.model.name} (prompt {fingerprint()})"
        prompts = [Prompt(flight.flight_id, kind, good[kind], writer) for kind in KINDS if kind in good]
        said = set(good.values())
        prompts += [p for p in plain.of_flight(flight.flight_id) if p.kind not in good and p.text not in said]
        return sorted(prompts, key=lambda p: KINDS.index(p.kind))

    def _asked(
        self, flight: Flight, resolver: Resolver, sheets: ContactSheets, complaints: str
    ) -> tuple[dict[PromptKind, str], dict[str, str]]:
        """(sentences by kind that are read as the target alone, reasons by sentence that are not)."""
        values = {
            "kinds": "\n".join(template.text({}) for template in KIND_TEMPLATES.values()),
            "colour": BOX_COLOUR_NAME,
            "facts": facts_about(resolver, flight.object_id),
            "complaints": complaints,
        }
        question = TEMPLATE.question(values, (sheets.bare, sheets.boxed), seed=flight.flight_id)
        try:
            answer = self.model.answer(question, Instructions)
        except ModerationError:
            return {}, {}
        good: dict[PromptKind, str] = {}
        bad: dict[str, str] = {}
        for kind in (k for k in KINDS if answer.of(k)):
            problem = problem_with(answer.of(kind), resolver, flight.object_id)
            if problem:
                bad[answer.of(kind)] = problem
            elif answer.of(kind) not in good.values():
                good[kind] = answer.of(kind)
        return good, bad


def problem_with(text: str, resolver: Resolver, target_id: int) -> str:
    """Why a sentence may not be used: the offline prompter's own rule; "" if it may."""
    reading = read_back(text, resolver, target_id)
    if reading.outcome is not Outcome.TARGET:
        return reading.reason
    if reading.unchecked:
        return f"nothing measured confirms: {', '.join(reading.unchecked)}"
    return "" if reading.certain else "it is not certainly true of the target"


def fingerprint() -> str:
    """Of everything that the model is told, and of what it must answer."""
    kinds = "".join(template.fingerprint() for template in KIND_TEMPLATES.values())
    return f"{TEMPLATE.fingerprint(Instructions)[:4]}{kinds[0:2]}{kinds[8:10]}{kinds[16:18]}"


def _complaints(bad: dict[str, str]) -> str:
    lines = [f'"{text}" cannot be used: {reason}.' for text, reason in bad.items()]
    return "\n".join(["Your earlier sentences failed a check:", *lines, "Write better ones, or an empty string."])
