"""The verdict's section of the settings: thresholds of the gates, calibrated by `benchmarks/quality.py`."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(ge=1)]
Limits = tuple[Annotated[float, Field(ge=0, le=1)], Annotated[float, Field(ge=0, le=1)]]
"""Least and most."""


class VerdictSettings(BaseModel):
    """Thresholds of the measured gates."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    max_empty: Limits = (0.08, 0.25)
    """Most of a frame's pixels with alpha < 0.5, over the flight's worst frame: in a closed scene, and at all. A
    captured room's door, behind which nothing was captured, is the scene's own: what the median flight sees empty is
    added."""
    max_hole: Limits = (0.04, 0.2)
    """Largest connected part of a sampled frame without a depth return, as a share of its pixels; likewise."""
    max_blur: Positive = 0.46
    """Crete et al.'s blur effect (0 sharp, 1 blurred), median over sampled frames."""
    max_noise: Positive = 3.0
    """Immerkaer's noise estimate, grey levels, median over sampled frames."""
    min_contrast: Positive = 98.0
    """Grey levels between the 5th and the 95th percentile, median over sampled frames: fog leaves little."""
    min_brightness: Positive = 35.0
    """Mean grey level of the darkest sampled frame ..."""
    max_brightness: Positive = 235.0
    """... and of the brightest."""
    max_flicker: Positive = 10.0
    """Grey levels by which a surface changes between two neighbouring frames, after re-projection; worst pair."""
    max_depth_jump: Positive = 0.08
    """Share of a frame's points that its neighbour sees at another depth; worst pair."""
    max_floaters: Positive = 0.01
    """Share of a frame's pixels that lie nearer than the flight's clearance leaves room for; worst sampled frame."""
    min_target_visible: Positive = 0.5
    """Least share of sampled frames in which the target is in the picture and not hidden."""
    min_target_share: Positive = 0.004
    """Least share of the last frame's pixels that show the target."""
    max_final_angle_deg: Positive = 25.0
    """Most between the final view's axis and the target's centre."""
    min_progress: Positive = 0.3
    """Least fall of the distance to the target, as a share of its start."""
    max_hover: Positive = 1.5
    """Seconds for which the drone may do nothing: neither move nor turn."""
    min_clearance: Positive = 0.15
    max_limit_ratio: Positive = 1.1
    """Most that the sampled flight may exceed the planner's speed, acceleration, jerk or yaw rate by, as a factor."""
    max_end_error: Positive = 0.3
    """Most between the flight's end and its target point."""
    frame_step: Count = 30
    """The paper samples every 30th frame of a 30 Hz video; at another rate the same seconds are meant."""
