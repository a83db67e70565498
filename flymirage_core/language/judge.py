"""Who decides which flights are kept: the port `FrameJudge`, and `MeasuredJudge`, which asks nobody."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.errors import ProductError
from flymirage_core.language import gates
from flymirage_core.language.gates import Sighting
from flymirage_core.language.verdicts import GateResult, QualityVerdicts, Verdict
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.rendering.frames import FlightFrames, Frames
from flymirage_core.settings import PlannerSettings, VerdictSettings

PAPER_FRAME_RATE = 30.0
"""Hz: the video rate that `VerdictSettings.frame_step` counts frames of (section III-C)."""


class FrameJudge(Protocol):
    """Looks at each flight's frames and says keep or drop, with reasons (section III-C, visual quality assessment)."""

    @property
    def name(self) -> str: ...

    def judge(self, frames: Frames, flights: Trajectories, boxes: BoxMap) -> QualityVerdicts: ...


@dataclass(frozen=True)
class MeasuredJudge:
    """Keeps a flight if all measured gates pass.

    The paper asks a VLM about rendering artifacts, poor visibility and unclear flight intent; these gates measure the
    same three things (coverage, sharpness, exposure; target visible; final view, progress), and what a picture does
    not show (clearance, feasibility, arrival).
    """

    settings: VerdictSettings
    limits: PlannerSettings = field(default_factory=PlannerSettings)
    """The quadrotor's limits that flights were planned with."""
    name: str = "measured 1"

    def judge(self, frames: Frames, flights: Trajectories, boxes: BoxMap) -> QualityVerdicts:
        """One verdict for each flight, in their order.

        Raises `ProductError` if products do not belong together, or a video is damaged.
        """
        frames.check()
        return QualityVerdicts(tuple(self._verdict(frames, flight, boxes) for flight in flights))

    def _verdict(self, frames: Frames, flight: Flight, boxes: BoxMap) -> Verdict:
        try:
            target = boxes.by_id(flight.object_id)
        except KeyError:
            raise ProductError(
                f"flight {flight.flight_id} flies to object {flight.object_id}, not among the {len(boxes)} boxes: "
                "the products are of different runs; materialise `task_sets` and what follows again"
            ) from None
        results = self._gates(frames.flight(flight.flight_id), flight, target)
        return Verdict(flight.flight_id, all(g.passed for g in results), results, self.name)

    def _gates(self, frames: FlightFrames, flight: Flight, target: ObjectBox) -> tuple[GateResult, ...]:
        settings = self.settings
        sightings = tuple(sample(frames, settings.frame_step))
        coverage = frames.table["alpha_coverage"].to_numpy(float)  # (F,)
        return (
            gates.alpha_coverage_gate(coverage, settings),
            gates.sharpness_gate(sightings, settings),
            gates.darkness_gate(sightings, settings),
            gates.glare_gate(sightings, settings),
            gates.target_visible_gate(sightings, target, settings),
            gates.final_view_gate(sightings[-1].camera, target, settings),
            gates.progress_gate(flight, target, settings),
            gates.clearance_gate(flight, settings),
            gates.feasibility_gate(flight, self.limits, settings),
            gates.arrival_gate(flight, settings),
        )


def sampled_indices(frame_count: int, frame_rate: float, frame_step: int) -> list[int]:
    """Every ``frame_step``-th frame of a 30 Hz video (the same seconds at another rate), and always the last.

    >>> sampled_indices(50, 10.0, 30)
    [0, 10, 20, 30, 40, 49]
    """
    step = max(1, round(frame_step * frame_rate / PAPER_FRAME_RATE))
    return sorted({*range(0, frame_count, step), frame_count - 1})


def sample(frames: FlightFrames, frame_step: int) -> Iterator[Sighting]:
    """The sampled frames of a flight; no others are decoded. Raises `ProductError` if a video is torn."""
    wanted = sampled_indices(len(frames), frames.rig.frame_rate, frame_step)
    cameras = frames.cameras()
    for index, rgb, depth in zip(wanted, frames.rgb_at(wanted), frames.depth_at(wanted), strict=True):
        yield Sighting(index, cameras[index], rgb, depth)
