"""Yaw along a flight: looking where it goes, turning in place before departure if needed, ending on the target object.

The original turns at up to pi rad/s with no limit on its acceleration, far too fast for pictures; here rate and
acceleration have limits, and the drone waits in hover, before departure and after arrival, for what they do not allow.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from flymirage_core.settings import PlannerSettings

Float64 = NDArray[np.float64]

SUBSTEPS: Final = 4
"""Steps of the yaw servo for each recorded state."""
LOOK_AHEAD: Final = 1.0
"""Seconds: the drone looks at where it will be then."""
MIN_HORIZONTAL: Final = 0.1
"""Metres: when it moves less than this to the side within the look-ahead, up or down, it looks at the target."""
FACE_FROM: Final = 3.0
FACE_FULLY: Final = 1.5
"""Metres left to fly between which the view turns from the flight's direction to the target's centre."""
DEPARTURE_ANGLE: Final = 0.5
"""Radians: the drone departs once its view is no further from where it should be."""
SETTLED_ANGLE: Final = 0.003
"""Radians: the flight is over once its view is no further from the target's centre."""
GAIN: Final = 4.0
"""1/s, of the servo for small errors."""
BRAKE_SHARE: Final = 0.8
"""Share of the acceleration limit with which the servo plans to stop."""
MAX_HOVER: Final = 60.0
"""Seconds; never needed: half a turn takes 5."""


@dataclass(frozen=True, eq=False)
class YawPlan:
    """Yaw at every recorded state: ``before`` states of hover, the flight's states, ``after`` states of hover."""

    yaws: Float64  # (T,) radians, continuous (not wrapped)
    rates: Float64  # (T,) rad/s
    before: int
    after: int


def plan_yaw(positions: Float64, target_centre: Float64, first_yaw: float | None, settings: PlannerSettings) -> YawPlan:
    """Yaw for a flight.

    Args:
        positions: ((T - 1) * SUBSTEPS + 1, 3) of the flight alone, `SUBSTEPS` for each recorded state.
        target_centre: (3,) of the object at which the flight ends.
        first_yaw: of the drone in hover before departure; None: it already looks where the flight begins.
    """
    dt = 1 / (settings.state_rate * SUBSTEPS)
    reference = view_directions(positions, target_centre, round(LOOK_AHEAD / dt))
    servo = _Servo(reference[0] if first_yaw is None else first_yaw, 0.0, dt, settings)
    reference += 2 * np.pi * np.round((servo.yaw - reference[0]) / (2 * np.pi))  # the shorter way round
    yaws, rates = [servo.yaw], [servo.rate]
    longest = int(MAX_HOVER / dt)

    def follow(angle: float, rate: float) -> None:
        servo.step(angle, rate)
        yaws.append(servo.yaw)
        rates.append(servo.rate)

    before = 0
    while before < longest and (before % SUBSTEPS or abs(servo.yaw - reference[0]) > DEPARTURE_ANGLE):
        follow(reference[0], 0.0)
        before += 1
    for last, angle in pairwise(reference):
        follow(angle, (angle - last) / dt)
    after = 0
    while after < longest and (after % SUBSTEPS or not servo.rests_at(reference[-1])):
        follow(reference[-1], 0.0)
        after += 1
    return YawPlan(np.array(yaws)[::SUBSTEPS], np.array(rates)[::SUBSTEPS], before // SUBSTEPS, after // SUBSTEPS)


def view_directions(positions: Float64, target_centre: Float64, ahead: int) -> Float64:
    """Where to look (M,), radians without jumps, at positions (M, 3) of a flight; ``ahead`` positions further on."""
    to_target = target_centre[:2] - positions[:, :2]
    bearing = np.arctan2(to_target[:, 1], to_target[:, 0])
    later = positions[np.minimum(np.arange(len(positions)) + ahead, len(positions) - 1), :2]
    course = later - positions[:, :2]  # (M, 2)
    beside = np.angle(np.exp(1j * (np.arctan2(course[:, 1], course[:, 0]) - bearing)))  # course, seen from the bearing
    left = np.linalg.norm(positions[-1] - positions, axis=1)  # metres
    along = np.clip((left - FACE_FULLY) / (FACE_FROM - FACE_FULLY), 0, 1)
    along[np.linalg.norm(course, axis=1) < MIN_HORIZONTAL] = 0
    return np.unwrap(bearing + along * beside)


class _Servo:
    """Follows an angle within a rate and an acceleration limit."""

    def __init__(self, yaw: float, rate: float, dt: float, settings: PlannerSettings) -> None:
        self.yaw, self.rate, self.dt = float(yaw), rate, dt
        self.max_rate, self.max_acceleration = settings.max_yaw_rate, settings.max_yaw_acceleration

    def step(self, angle: float, rate: float) -> None:
        error = angle - self.yaw
        closing = min(GAIN * abs(error), (2 * BRAKE_SHARE * self.max_acceleration * abs(error)) ** 0.5)
        wanted = rate + (closing if error > 0 else -closing)
        wanted = min(max(wanted, -self.max_rate), self.max_rate)
        most = self.max_acceleration * self.dt
        before = self.rate
        self.rate += min(max(wanted - before, -most), most)
        self.yaw += (before + self.rate) / 2 * self.dt

    def rests_at(self, angle: float) -> bool:
        return abs(self.yaw - angle) <= SETTLED_ANGLE and abs(self.rate) <= self.max_acceleration * self.dt
