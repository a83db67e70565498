"""Where the camera is at each frame, and what it flies to: flight states thinned to the frame rate."""

import numpy as np

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.annotation.instances import oriented_boxes
from flymirage_core.errors import InputError
from flymirage_core.navigation.trajectories import Flight, Trajectories
from flymirage_core.rendering.frames import BodyPath


def camera_paths(trajectories: Trajectories, boxes: BoxMap, frame_rate: float) -> list[BodyPath]:
    """Body poses of every flight at exactly ``n / frame_rate`` seconds, n = 0, 1, ..., not beyond the flight's end.

    A path's target is the box that the flight flies to; none if that is not among ``boxes``.

    Raises:
        InputError: the states were not recorded at a multiple of ``frame_rate``.
    """
    return [_thinned(flight, boxes, frame_rate) for flight in trajectories]


def _thinned(flight: Flight, boxes: BoxMap, frame_rate: float) -> BodyPath:
    state_rate = 1.0 / float(flight.times[1] - flight.times[0])
    step = round(state_rate / frame_rate)
    if step < 1 or abs(step * frame_rate - state_rate) > 1e-6 * state_rate:
        raise InputError(
            f"frames.rate is {frame_rate:g} Hz but flight {flight.flight_id} has states at {state_rate:g} Hz: "
            "choose a frame rate that divides planner.state_rate"
        )
    shown = np.arange(0, len(flight.times), step)
    shown = shown[np.isclose(flight.times[shown], np.arange(len(shown)) / frame_rate, atol=1e-6)]
    target = [box for box in boxes if box.object_id == flight.object_id]
    return BodyPath(
        flight.flight_id,
        flight.times[shown],
        flight.positions[shown],
        flight.quaternions[shown],
        oriented_boxes(target) if target else None,
    )
