"""Who decides which flights are kept: the port `FrameJudge`, and `MeasuredJudge`, which asks nobody."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.errors import ProductError
from flymirage_core.language import gates
from flymirage_core.language.evidence import Evidence, scene_openings
from flymirage_core.language.reprojection import change
from flymirage_core.language.settings import VerdictSettings
from flymirage_core.language.verdicts import GateResult, QualityVerdicts, Verdict
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.rendering.frames import Frames
from flymirage_core.settings import PlannerSettings


class FrameJudge(Protocol):
    """Looks at each flight's frames and says keep or drop, with reasons (section III-C, visual quality assessment)."""

    @property
    def name(self) -> str: ...

    def judge(self, frames: Frames, flights: Trajectories, boxes: BoxMap) -> QualityVerdicts: ...


@dataclass(frozen=True)
class MeasuredJudge:
    """Keeps a flight if all measured gates pass.

    The paper asks a VLM about rendering artifacts, poor visibility and unclear flight intent; these gates measure the
    same three things (coverage, holes, blur, noise, contrast, exposure, flicker, floaters; target visible and of some
    size; final view, progress, hovering), and what a picture does not show (clearance, feasibility, arrival).
    """

    settings: VerdictSettings
    limits: PlannerSettings = field(default_factory=PlannerSettings)
    """The quadrotor's limits that flights were planned with."""
    name: str = "measured 4"

    def judge(self, frames: Frames, flights: Trajectories, boxes: BoxMap) -> QualityVerdicts:
        """One verdict for each flight, in their order.

        Raises `ProductError` if products do not belong together, or a video is damaged.
        """
        frames.check()
        openings = scene_openings(frames)
        return QualityVerdicts(tuple(self._verdict(frames, flight, boxes, openings) for flight in flights))

    def _verdict(self, frames: Frames, flight: Flight, boxes: BoxMap, openings: float) -> Verdict:
        try:
            target = boxes.by_id(flight.object_id)
        except KeyError:
            raise ProductError(
                f"flight {flight.flight_id} flies to object {flight.object_id}, not among the {len(boxes)} boxes: "
                "the products are of different runs; materialise `task_sets` and what follows again"
            ) from None
        filmed = frames.flight(flight.flight_id)
        evidence = Evidence.of(flight, target, filmed, self.settings.frame_step, openings)
        results = self.gates(evidence)
        return Verdict(flight.flight_id, all(g.passed for g in results), results, self.name)

    def gates(self, evidence: Evidence) -> tuple[GateResult, ...]:
        """All gates of one flight, those of its pictures first."""
        settings, flight, target, sightings = self.settings, evidence.flight, evidence.target, evidence.sightings
        changes = [c for pair in evidence.pairs if (c := change(*pair)) is not None]
        times = np.array([s.frame_index for s in sightings]) / evidence.frame_rate  # (S,)
        return (
            gates.alpha_coverage_gate(evidence.coverage, evidence.openings, settings),
            gates.hole_gate(sightings, evidence.openings, settings),
            gates.blur_gate(sightings, settings),
            gates.noise_gate(sightings, settings),
            gates.contrast_gate(sightings, settings),
            gates.darkness_gate(sightings, settings),
            gates.glare_gate(sightings, settings),
            gates.flicker_gate(changes, settings),
            gates.depth_jump_gate(changes, settings),
            gates.floater_gate(sightings, np.interp(times, flight.times, flight.clearances), settings),
            gates.target_visible_gate(sightings, target, settings),
            gates.target_size_gate(sightings[-1], target, settings),
            gates.final_view_gate(sightings[-1].camera, target, settings),
            gates.progress_gate(flight, target, settings),
            gates.hover_gate(flight, settings),
            gates.clearance_gate(flight, settings),
            gates.feasibility_gate(flight, self.limits, settings),
            gates.arrival_gate(flight, settings),
        )
