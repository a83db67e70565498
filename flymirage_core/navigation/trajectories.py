"""Flown trajectories as data: `FlightReport`, `Flight`, and `Trajectories`, the product of the `trajectories` asset."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

Float64 = NDArray[np.float64]


@dataclass(frozen=True)
class FlightReport:
    """What the sampled flight (not the plan) measures. Metres, seconds, radians."""

    duration: float
    length: float
    straight_distance: float
    max_speed: float  # m/s, norm
    max_acceleration: float  # m/s^2, norm
    max_jerk: float  # m/s^3, norm
    max_body_rate: float  # rad/s, norm
    max_angular_acceleration: float  # rad/s^2, norm
    max_yaw_rate: float  # rad/s
    min_rotor_thrust: float  # newtons, of the rotor with least
    max_rotor_thrust: float  # newtons, of the rotor with most
    tracking_position_rms: float  # metres by which the simulated quadrotor strays
    tracking_attitude_rms: float  # radians
    min_clearance: float  # metres from the drone's centre to the nearest blocked voxel's face
    end_error: float  # metres between the flight's end and its target point
    inflation: float  # metres by which obstacles were grown when this flight was planned
    planner: str  # name and version
    attempts: str  # the attempts made, in order, "path_seed:ok" or "path_seed:collision; short_margin:ok"


@dataclass(frozen=True, eq=False)
class Flight:
    """One leg: from where the drone was to in front of its target. World frame, body FLU, quaternions xyzw.

    States are sampled evenly at ``state_rate`` of the settings, the last one at the flight's end. The IMU sits at the
    body's origin, along its axes: gyroscope ``body_rates``, accelerometer ``specific_forces`` = R^T (a + 9.81 e_z).
    """

    flight_id: int  # unique in the scene, counts from 0
    set_index: int  # task set 0..N_s-1
    leg_index: int  # leg within the set 0..N_o-1
    object_id: int  # the target's ObjectBox.object_id
    target_point: Float64  # (3,)
    times: Float64  # (T,) seconds from 0
    positions: Float64  # (T, 3)
    velocities: Float64  # (T, 3) m/s, world
    accelerations: Float64  # (T, 3) m/s^2, world, without gravity
    quaternions: Float64  # (T, 4) xyzw, body (FLU) to world
    body_rates: Float64  # (T, 3) rad/s, about the body's x, y, z: what an ideal gyroscope reads
    angular_accelerations: Float64  # (T, 3) rad/s^2, about the body's x, y, z
    specific_forces: Float64  # (T, 3) m/s^2, body: what an ideal accelerometer reads, (0, 0, +9.81) in hover
    rotor_thrusts: Float64  # (T, 4) newtons: front left, front right, rear right, rear left
    yaws: Float64  # (T,) ENU: counter-clockwise from +x
    clearances: Float64  # (T,) metres to the nearest blocked voxel's face
    report: FlightReport


STATE_SCHEMA = pa.schema(
    [
        ("flight_id", pa.int32()),
        ("time", pa.float64()),
        ("position", pa.list_(pa.float64(), 3)),
        ("velocity", pa.list_(pa.float64(), 3)),
        ("acceleration", pa.list_(pa.float64(), 3)),
        ("quaternion", pa.list_(pa.float64(), 4)),
        ("body_rate", pa.list_(pa.float64(), 3)),
        ("angular_acceleration", pa.list_(pa.float64(), 3)),
        ("specific_force", pa.list_(pa.float64(), 3)),
        ("rotor_thrust", pa.list_(pa.float64(), 4)),
        ("yaw", pa.float64()),
        ("clearance", pa.float64()),
    ]
)
_REPORT_TYPES = {f.name: pa.string() if f.type is str else pa.float64() for f in fields(FlightReport)}
FLIGHT_SCHEMA = pa.schema(
    [
        ("flight_id", pa.int32()),
        ("set_index", pa.int32()),
        ("leg_index", pa.int32()),
        ("object_id", pa.int32()),
        ("target_point", pa.list_(pa.float64(), 3)),
        *_REPORT_TYPES.items(),
    ]
)


@dataclass(frozen=True)
class RejectedTask:
    """A task for which no flight was accepted, and why."""

    set_index: int
    leg_index: int
    object_id: int
    reason: str


REJECTED_SCHEMA = pa.schema(
    [("set_index", pa.int32()), ("leg_index", pa.int32()), ("object_id", pa.int32()), ("reason", pa.string())]
)


@dataclass(frozen=True)
class Trajectories:
    """All accepted flights of a scene, ordered by ``flight_id``, and the tasks that could not be flown."""

    flights: tuple[Flight, ...]
    rejected: tuple[RejectedTask, ...] = ()

    def __len__(self) -> int:
        return len(self.flights)

    def __iter__(self) -> Iterator[Flight]:
        return iter(self.flights)

    def summary(self) -> dict[str, int | float]:
        lengths = [f.report.length for f in self] or [0.0]
        clearances = [f.report.min_clearance for f in self] or [0.0]
        return {
            "flights": len(self),
            "rejected_tasks": len(self.rejected),
            "mean_length_m": round(float(np.mean(lengths)), 2),
            "min_clearance_m": round(float(np.min(clearances)), 3),
            "worst_tracking_m": round(max((f.report.tracking_position_rms for f in self), default=0.0), 4),
            "worst_tracking_deg": round(
                np.degrees(max((f.report.tracking_attitude_rms for f in self), default=0.0)), 2
            ),
        }

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        flights = [
            {
                "flight_id": f.flight_id,
                "set_index": f.set_index,
                "leg_index": f.leg_index,
                "object_id": f.object_id,
                "target_point": f.target_point.tolist(),
                **asdict(f.report),
            }
            for f in self
        ]
        pq.write_table(pa.Table.from_pylist(flights, schema=FLIGHT_SCHEMA), folder / "flights.parquet")
        pq.write_table(
            pa.Table.from_pylist([asdict(r) for r in self.rejected], schema=REJECTED_SCHEMA),
            folder / "rejected.parquet",
        )
        tables = [_states_table(f) for f in self] or [STATE_SCHEMA.empty_table()]
        pq.write_table(pa.concat_tables(tables), folder / "states.parquet")

    @staticmethod
    def load(folder: Path) -> "Trajectories":
        rows = pq.read_table(folder / "flights.parquet", schema=FLIGHT_SCHEMA).to_pylist()
        states = pq.read_table(folder / "states.parquet", schema=STATE_SCHEMA)
        ids = states["flight_id"].to_numpy()
        flights = tuple(_flight_from(row, states.filter(pa.array(ids == row["flight_id"]))) for row in rows)
        rejected = pq.read_table(folder / "rejected.parquet", schema=REJECTED_SCHEMA).to_pylist()
        return Trajectories(flights, tuple(RejectedTask(**r) for r in rejected))


def _vectors(array: Float64) -> pa.FixedSizeListArray:
    return pa.FixedSizeListArray.from_arrays(pa.array(np.ascontiguousarray(array, float).ravel()), array.shape[1])


def _states_table(flight: Flight) -> pa.Table:
    return pa.Table.from_arrays(
        [
            pa.array(np.full(len(flight.times), flight.flight_id, np.int32)),
            pa.array(flight.times),
            _vectors(flight.positions),
            _vectors(flight.velocities),
            _vectors(flight.accelerations),
            _vectors(flight.quaternions),
            _vectors(flight.body_rates),
            _vectors(flight.angular_accelerations),
            _vectors(flight.specific_forces),
            _vectors(flight.rotor_thrusts),
            pa.array(flight.yaws),
            pa.array(flight.clearances),
        ],
        schema=STATE_SCHEMA,
    )


def _flight_from(row: dict[str, object], states: pa.Table) -> Flight:
    def column(name: str, width: int) -> Float64:
        return np.asarray(states[name].combine_chunks().flatten().to_numpy().reshape(-1, width))

    report = FlightReport(**{f.name: row[f.name] for f in fields(FlightReport)})  # type: ignore[arg-type]
    return Flight(
        flight_id=int(row["flight_id"]),  # type: ignore[call-overload]
        set_index=int(row["set_index"]),  # type: ignore[call-overload]
        leg_index=int(row["leg_index"]),  # type: ignore[call-overload]
        object_id=int(row["object_id"]),  # type: ignore[call-overload]
        target_point=np.array(row["target_point"], float),
        times=states["time"].to_numpy(),
        positions=column("position", 3),
        velocities=column("velocity", 3),
        accelerations=column("acceleration", 3),
        quaternions=column("quaternion", 4),
        body_rates=column("body_rate", 3),
        angular_accelerations=column("angular_acceleration", 3),
        specific_forces=column("specific_force", 3),
        rotor_thrusts=column("rotor_thrust", 4),
        yaws=states["yaw"].to_numpy(),
        clearances=states["clearance"].to_numpy(),
        report=report,
    )
