"""The measured quality gates: what is seen and flown on one flight, each a number against a threshold, with a reason.

Each public ``*_gate`` function answers one `GateResult`. Frames come as `Sighting`s: pictures sampled along the flight.
Which gates make up a verdict is the judge's business (`judge.py`).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.language.verdicts import GateResult
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.views import DEPTH_UNIT
from flymirage_core.settings import PlannerSettings, VerdictSettings

PROBE_INSET = 0.5
"""Corners are probed this far towards the box's centre: real objects seldom fill the corners of their box."""
OCCLUSION_TOLERANCE = 0.15
"""Metres by which something may stand before the box without hiding it: about the error of a box's faces."""
LEAST_VISIBLE_PROBES = 3
"""Of nine: a frame sees the target when the centre, or this many probes, are in the picture and not hidden."""


@dataclass(frozen=True, eq=False)
class Sighting:
    """One sampled frame."""

    frame_index: int
    camera: Camera
    rgb: NDArray[np.uint8]  # (H, W, 3)
    depth: NDArray[np.uint16]  # (H, W) millimetres, 0 = no return


def alpha_coverage_gate(coverage: NDArray[np.float64], settings: VerdictSettings) -> GateResult:
    """Worst share of opaque pixels (alpha >= 0.5) over all frames; ``coverage`` (F,) in [0, 1]."""
    worst = int(np.argmin(coverage))
    value, threshold = float(coverage[worst]), settings.min_alpha_coverage
    reason = f"frame {worst} has holes: only {value:.0%} of its pixels are opaque, at least {threshold:.0%} must be"
    return _at_least("alpha_coverage", value, threshold, reason)


def sharpness_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Median over the sampled frames of the variance of the Laplacian, grey levels squared.

    A no-reference focus measure: J. L. Pech-Pacheco et al., "Diatom autofocusing in brightfield microscopy: a
    comparative study", ICPR 2000. It falls with blur and with fog, and depends on the picture's size.
    """
    value = float(np.median([variance_of_laplacian(s.rgb) for s in sightings]))
    threshold = settings.min_sharpness
    reason = f"the pictures are blurred or empty: Laplacian variance {value:.1f}, at least {threshold:.1f} is asked for"
    return _at_least("sharpness", value, threshold, reason)


def variance_of_laplacian(rgb: NDArray[np.uint8]) -> float:
    """Sharpness of a picture (H, W, 3), grey levels squared."""
    return float(cv2.Laplacian(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), cv2.CV_32F).var(dtype=np.float64))


def darkness_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Mean brightness (grey levels, 0-255) of the darkest sampled frame."""
    levels = _brightness(sightings)
    worst, threshold = int(np.argmin(levels)), settings.min_brightness
    value = float(levels[worst])
    frame = sightings[worst].frame_index
    reason = f"frame {frame} is too dark: mean brightness {value:.0f} of 255, at least {threshold:.0f} is asked for"
    return _at_least("darkness", value, threshold, reason)


def glare_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Mean brightness (grey levels, 0-255) of the brightest sampled frame."""
    levels = _brightness(sightings)
    worst, threshold = int(np.argmax(levels)), settings.max_brightness
    value = float(levels[worst])
    frame = sightings[worst].frame_index
    reason = f"frame {frame} is too bright: mean brightness {value:.0f} of 255, at most {threshold:.0f} is asked for"
    return _at_most("glare", value, threshold, reason)


def target_visible_gate(sightings: Sequence[Sighting], target: ObjectBox, settings: VerdictSettings) -> GateResult:
    """Share of the sampled frames that see the target."""
    value = float(np.mean([sees(s, target) for s in sightings]))
    threshold = settings.min_target_visible
    reason = (
        f"the {target.label} is seen in only {value:.0%} of the sampled frames (else hidden or out of the picture), "
        f"at least {threshold:.0%} are asked for"
    )
    return _at_least("target_visible", value, threshold, reason)


def sees(sighting: Sighting, target: ObjectBox) -> bool:
    """Whether the picture shows the box: its centre or enough probes are in the picture with nothing standing before.

    A probe is hidden when the measured z-depth at its pixel ends before its ray enters the box, or is missing.
    """
    probes = np.vstack([target.centre, target.corners * (1 - PROBE_INSET) + np.array(target.centre) * PROBE_INSET])
    pixels, depth = sighting.camera.project(probes)  # (9, 2), (9,)
    height, width = sighting.depth.shape
    columns, rows = np.floor(np.nan_to_num(pixels, nan=-1.0)).astype(int).T
    inside = (depth > 0) & (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    measured = sighting.depth[rows[inside], columns[inside]] * DEPTH_UNIT
    entry = depth[inside] * _ray_entry(sighting.camera.position, probes[inside], target)
    visible = np.zeros(len(probes), bool)
    visible[inside] = (measured > 0) & (measured >= entry - OCCLUSION_TOLERANCE)
    return bool(visible[0] or visible.sum() >= LEAST_VISIBLE_PROBES)


def final_view_gate(last: Camera, target: ObjectBox, settings: VerdictSettings) -> GateResult:
    """Angle in degrees between the final view's axis and the direction to the target's centre."""
    towards = np.array(target.centre) - last.position
    cosine = float(towards @ last.forward / max(float(np.linalg.norm(towards)), 1e-9))
    value, threshold = float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))), settings.max_final_angle_deg
    reason = f"the last picture looks {value:.0f} degrees past the {target.label}, at most {threshold:.0f} are allowed"
    return _at_most("final_view", value, threshold, reason)


def progress_gate(flight: Flight, target: ObjectBox, settings: VerdictSettings) -> GateResult:
    """How much of the first distance to the target's box is gone at the end: 1 = all of it, negative = farther away."""
    first, last = target.distance(flight.positions[[0, -1]])
    value = float((first - last) / first) if first > 0 else 0.0
    threshold = settings.min_progress
    reason = (
        f"the flight does not approach the {target.label}: {first:.2f} m at the start, {last:.2f} m at the end, "
        f"{value:.0%} of the distance covered, at least {threshold:.0%} is asked for"
    )
    return _at_least("progress", value, threshold, reason)


def clearance_gate(flight: Flight, settings: VerdictSettings) -> GateResult:
    """Least distance in metres from the drone's centre to what may not be flown in."""
    value, threshold = flight.report.min_clearance, settings.min_clearance
    reason = f"the flight passes {value:.2f} m from an obstacle, at least {threshold:.2f} m is asked for"
    return _at_least("clearance", value, threshold, reason)


def feasibility_gate(flight: Flight, limits: PlannerSettings, settings: VerdictSettings) -> GateResult:
    """The sampled flight's worst ratio of speed, acceleration, jerk or yaw rate to the quadrotor's limit."""
    report = flight.report
    ratios = {
        f"speed {report.max_speed:.2f} m/s": report.max_speed / limits.max_speed,
        f"acceleration {report.max_acceleration:.2f} m/s^2": report.max_acceleration / limits.max_acceleration,
        f"jerk {report.max_jerk:.2f} m/s^3": report.max_jerk / limits.max_jerk,
        f"yaw rate {report.max_yaw_rate:.2f} rad/s": report.max_yaw_rate / limits.max_yaw_rate,
    }
    worst = max(ratios, key=lambda name: ratios[name])
    value, threshold = float(ratios[worst]), settings.max_limit_ratio
    reason = f"{worst} is {value:.2f} times the quadrotor's limit, at most {threshold:.2f} times is allowed"
    return _at_most("feasibility", value, threshold, reason)


def arrival_gate(flight: Flight, settings: VerdictSettings) -> GateResult:
    """Metres between the flight's end and its target point."""
    value, threshold = flight.report.end_error, settings.max_end_error
    reason = f"the flight ends {value:.2f} m from its target point, at most {threshold:.2f} m is allowed"
    return _at_most("arrival", value, threshold, reason)


def _brightness(sightings: Sequence[Sighting]) -> NDArray[np.float64]:
    return np.array([cv2.cvtColor(s.rgb, cv2.COLOR_RGB2GRAY).mean() for s in sightings])  # (S,)


def _ray_entry(origin: NDArray[np.float64], points: NDArray[np.float64], box: ObjectBox) -> NDArray[np.float64]:
    """Share (N,) of the way from ``origin`` to each point (N, 3) in the box at which the ray enters the box."""
    start, ends = box.to_local(origin), box.to_local(points)
    direction = ends - start  # (N, 3)
    half = np.array(box.size) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        near = np.minimum((-half - start) / direction, (half - start) / direction)  # (N, 3) slab entries
    entry: NDArray[np.float64] = np.clip(np.where(np.isfinite(near), near, -np.inf).max(axis=1), 0.0, 1.0)
    return entry


def _at_least(gate: str, value: float, threshold: float, reason: str) -> GateResult:
    return _result(gate, value, threshold, value >= threshold, reason)


def _at_most(gate: str, value: float, threshold: float, reason: str) -> GateResult:
    return _result(gate, value, threshold, value <= threshold, reason)


def _result(gate: str, value: float, threshold: float, passed: bool, reason: str) -> GateResult:
    """Comparisons with NaN are false, so what could not be measured does not pass."""
    return GateResult(gate, value, threshold, bool(passed), "" if passed else reason)
