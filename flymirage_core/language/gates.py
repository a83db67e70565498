"""The measured quality gates: what is seen and flown on one flight, each a number against a threshold, with a reason.

Each public ``*_gate`` function answers one `GateResult`. Which gates make up a verdict is the judge's business
(`judge.py`); thresholds are calibrated on labelled damage by `benchmarks/quality.py`.
"""

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from flymirage_core.annotation.boxes import BoxMap, ObjectBox
from flymirage_core.annotation.instances import oriented_boxes
from flymirage_core.language import picture_measures
from flymirage_core.language.evidence import Sighting
from flymirage_core.language.reprojection import Change
from flymirage_core.language.settings import VerdictSettings
from flymirage_core.language.verdicts import GateResult
from flymirage_core.navigation.trajectories import Flight
from flymirage_core.rendering.camera import Camera
from flymirage_core.rendering.instances import seen_share
from flymirage_core.rendering.views import DEPTH_UNIT
from flymirage_core.settings import PlannerSettings

PROBE_INSET = 0.5
"""Corners are probed this far towards the box's centre: real objects seldom fill the corners of their box."""
OCCLUSION_TOLERANCE = 0.15
"""Metres by which something may stand before the box without hiding it: about the error of a box's faces."""
LEAST_VISIBLE_PROBES = 3
"""Of nine: a frame sees the target when the centre, or this many probes, are in the picture and not hidden."""
CLEARANCE_SLACK = 0.17
"""Metres: the diagonal of the occupancy's voxels, by which a clearance may be too large."""
STILL = (0.05, 0.05)
"""m/s and rad/s below which the drone does nothing."""


def alpha_coverage_gate(coverage: NDArray[np.float64], openings: float, settings: VerdictSettings) -> GateResult:
    """Worst share of opaque pixels (alpha >= 0.5) over all frames; ``coverage`` (F,) in [0, 1]."""
    worst = int(np.argmin(coverage))
    value, threshold = float(coverage[worst]), 1.0 - empty_share(openings, settings.max_empty)
    reason = f"frame {worst} has holes: only {value:.0%} of its pixels are opaque, at least {threshold:.0%} must be"
    return _at_least("alpha_coverage", value, threshold, reason)


def hole_gate(sightings: Sequence[Sighting], openings: float, settings: VerdictSettings) -> GateResult:
    """Largest connected part without a depth return, as a share of the picture, over the sampled frames."""
    holes = np.array([picture_measures.largest_hole(s.depth) for s in sightings])
    worst, threshold = int(np.argmax(holes)), empty_share(openings, settings.max_hole)
    value, frame = float(holes[worst]), sightings[worst].frame_index
    reason = f"frame {frame} has a hole of {value:.1%} of the picture, at most {threshold:.1%} are allowed"
    return _at_most("hole", value, threshold, reason)


def empty_share(openings: float, limits: tuple[float, float]) -> float:
    """What may be empty in a scene with ``openings``: they, and as much more as in a closed one, up to the limit."""
    return min(limits[0] + openings, limits[1])


def blur_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Median blur effect of the sampled frames, 0 sharp to 1 blurred (`picture_measures.blur_effect`)."""
    value, threshold = _median([picture_measures.blur_effect(s.luma) for s in sightings]), settings.max_blur
    reason = f"the pictures are blurred: blur effect {value:.2f} of 1, at most {threshold:.2f} is allowed"
    return _at_most("blur", value, threshold, reason)


def noise_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Median noise of the sampled frames, grey levels (`picture_measures.noise_level`)."""
    value, threshold = _median([picture_measures.noise_level(s.luma) for s in sightings]), settings.max_noise
    reason = f"the pictures are noisy: by {value:.1f} grey levels, at most {threshold:.1f} are allowed"
    return _at_most("noise", value, threshold, reason)


def contrast_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Median contrast of the sampled frames, grey levels (`picture_measures.contrast`)."""
    value, threshold = _median([picture_measures.contrast(s.luma) for s in sightings]), settings.min_contrast
    reason = f"the pictures are foggy or empty: contrast {value:.0f} grey levels, at least {threshold:.0f} is asked for"
    return _at_least("contrast", value, threshold, reason)


def darkness_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Mean brightness (grey levels, 0-255) of the darkest sampled frame."""
    levels = _brightness(sightings)
    worst, threshold = int(np.argmin(levels)), settings.min_brightness
    value, frame = float(levels[worst]), sightings[worst].frame_index
    reason = f"frame {frame} is too dark: mean brightness {value:.0f} of 255, at least {threshold:.0f} is asked for"
    return _at_least("darkness", value, threshold, reason)


def glare_gate(sightings: Sequence[Sighting], settings: VerdictSettings) -> GateResult:
    """Mean brightness (grey levels, 0-255) of the brightest sampled frame."""
    levels = _brightness(sightings)
    worst, threshold = int(np.argmax(levels)), settings.max_brightness
    value, frame = float(levels[worst]), sightings[worst].frame_index
    reason = f"frame {frame} is too bright: mean brightness {value:.0f} of 255, at most {threshold:.0f} is asked for"
    return _at_most("glare", value, threshold, reason)


def flicker_gate(changes: Sequence[Change], settings: VerdictSettings) -> GateResult:
    """Most by which surfaces change their grey level between neighbouring frames; 0 if no two could be compared."""
    value, threshold = max((c.colour for c in changes), default=0.0), settings.max_flicker
    reason = f"the pictures flicker: by {value:.1f} grey levels between two frames, at most {threshold:.1f} are allowed"
    return _at_most("flicker", value, threshold, reason)


def depth_jump_gate(changes: Sequence[Change], settings: VerdictSettings) -> GateResult:
    """Largest share of points that the neighbouring frame sees at another depth; 0 if no two could be compared."""
    value, threshold = max((c.depth for c in changes), default=0.0), settings.max_depth_jump
    reason = f"surfaces pop up or vanish: {value:.1%} of a frame's points in the next, at most {threshold:.1%} may"
    return _at_most("depth_jump", value, threshold, reason)


def floater_gate(sightings: Sequence[Sighting], room: NDArray[np.float64], settings: VerdictSettings) -> GateResult:
    """Share of the picture nearer than anything solid can be, over the sampled frames.

    ``room`` (S,) is the drone's clearance at each, metres: what is seen within it is no part of the map, but a floater.
    """
    shares = np.array([_share_within(s, r - CLEARANCE_SLACK) for s, r in zip(sightings, room, strict=True)])
    worst, threshold = int(np.argmax(shares)), settings.max_floaters
    value, frame = float(shares[worst]), sightings[worst].frame_index
    reason = f"floaters fill {value:.1%} of frame {frame} right before the camera, at most {threshold:.1%} is allowed"
    return _at_most("floaters", value, threshold, reason)


def target_visible_gate(sightings: Sequence[Sighting], target: ObjectBox, settings: VerdictSettings) -> GateResult:
    """Share of the sampled frames that see the target."""
    value = float(np.mean([sees(s, target) for s in sightings]))
    threshold = settings.min_target_visible
    reason = (
        f"the {target.label} is seen in only {value:.0%} of the sampled frames (else hidden or out of the picture), "
        f"at least {threshold:.0%} are asked for"
    )
    return _at_least("target_visible", value, threshold, reason)


def target_size_gate(last: Sighting, target: ObjectBox, settings: VerdictSettings) -> GateResult:
    """Share of the last frame's pixels that show a point in the target's box."""
    depth = last.depth.astype(np.float32) * np.float32(DEPTH_UNIT)  # (H, W) metres
    value, threshold = seen_share(depth, last.camera, oriented_boxes(BoxMap((target,)))), settings.min_target_share
    reason = f"the {target.label} fills only {value:.2%} of the last picture, at least {threshold:.2%} is asked for"
    return _at_least("target_size", value, threshold, reason)


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


def hover_gate(flight: Flight, settings: VerdictSettings) -> GateResult:
    """Longest time in seconds for which the drone neither moves nor turns."""
    step = float(flight.times[1] - flight.times[0]) if len(flight.times) > 1 else 0.0
    turning = np.abs(np.angle(np.exp(1j * np.diff(flight.yaws, append=flight.yaws[-1:])))) / max(step, 1e-9)
    still = (np.linalg.norm(flight.velocities, axis=1) < STILL[0]) & (turning < STILL[1])  # (T,)
    value, threshold = _longest_run(still) * step, settings.max_hover
    reason = f"the drone hovers for {value:.1f} s without turning, at most {threshold:.1f} s are allowed"
    return _at_most("hovering", value, threshold, reason)


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


def _longest_run(flags: NDArray[np.bool_]) -> int:
    """
    >>> _longest_run(np.array([True, False, True, True]))
    2
    """
    return max((sum(1 for _ in run) for flag, run in groupby(flags.tolist()) if flag), default=0)


def _share_within(sighting: Sighting, distance: float) -> float:
    """Share of the pixels whose points lie nearer to the optical centre than ``distance`` metres."""
    k = sighting.camera.intrinsics
    u = (np.arange(k.width, dtype=np.float32) + 0.5 - k.cx) / k.fx
    v = (np.arange(k.height, dtype=np.float32) + 0.5 - k.cy) / k.fy
    limit = np.float32(max(distance, 0.0) / DEPTH_UNIT) / np.sqrt(1 + u[None, :] ** 2 + v[:, None] ** 2)  # (H, W)
    return float(np.count_nonzero((sighting.depth > 0) & (sighting.depth < limit)) / sighting.depth.size)


def _brightness(sightings: Sequence[Sighting]) -> NDArray[np.float64]:
    return np.array([float(s.luma.mean(dtype=np.float64)) for s in sightings])  # (S,)


def _median(values: Sequence[float]) -> float:
    return float(np.median(values))


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
