"""`Episode`, one row of the data set, and how the products of a scene become episodes."""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from typing import Any

import pyarrow as pa

from flymirage_core.annotation.boxes import ObjectBox
from flymirage_core.dataset.scene_products import SceneProducts, terms_of
from flymirage_core.dataset.splits import Split, is_unseen_instruction, split_of
from flymirage_core.language.prompts import Prompt
from flymirage_core.language.verdicts import GateResult, Verdict
from flymirage_core.navigation.trajectories import Flight, FlightReport

Vector = tuple[float, ...]


@dataclass(frozen=True)
class Episode:
    """One kept flight with at least one prompt. World frame (z up), metres, radians, seconds; quaternions xyzw."""

    episode_id: str  # "<scene>/<flight_id:04d>"
    scene: str
    category: str
    subcategory: str
    setting: str
    seed: str
    split: Split
    flight_id: int
    set_index: int
    leg_index: int
    object_id: int
    object_label: str
    object_colour: str
    label_source: str
    annotator: str
    box_centre: Vector
    box_size: Vector
    box_yaw: float
    start_position: Vector
    start_quaternion: Vector  # body (FLU) to world
    start_yaw: float
    target_point: Vector
    frame_count: int
    frame_rate: float
    prompts: tuple[Prompt, ...]
    judge: str
    gates: tuple[GateResult, ...]
    report: FlightReport
    licence: str  # others' terms on this episode
    models: dict[str, str]  # asset name -> who made it
    data_versions: dict[str, str]  # asset name -> content hash

    @property
    def training_prompts(self) -> tuple[Prompt, ...]:
        """What a trainer may read: all of them, but in training without those that are held out."""
        if self.split != "train":
            return self.prompts
        return tuple(p for p in self.prompts if not is_unseen_instruction(p.text))

    @property
    def held_out_prompts(self) -> tuple[Prompt, ...]:
        """Instructions that no training episode carries, asked for a flight that training sees."""
        return tuple(p for p in self.prompts if p not in self.training_prompts)


def episodes_of(products: SceneProducts) -> Iterator[Episode]:
    """The scene's episodes in the order of flights. A kept flight without a prompt is none; it is counted elsewhere."""
    verdicts = {v.flight_id: v for v in products.verdicts}
    licence = terms_of(products)
    for flight in products.trajectories:
        verdict = verdicts.get(flight.flight_id)
        prompts = products.prompts.of_flight(flight.flight_id)
        if verdict is not None and verdict.keep and prompts:
            target = products.boxes.by_id(flight.object_id)
            yield _episode(products, flight, target, verdict, prompts, licence)


def long_prompts_of(products: SceneProducts, episodes: Iterable[Episode]) -> dict[int, str]:
    """The long instruction by each of its flights, where all of them are episodes and training may read it."""
    splits = {e.flight_id: e.split for e in episodes}
    texts: dict[int, str] = {}
    for long in products.prompts.long_prompts:
        own = [splits.get(i) for i in long.flight_ids]
        if None not in own and not ("train" in own and is_unseen_instruction(long.text)):
            texts |= dict.fromkeys(long.flight_ids, long.text)
    return texts


def _episode(
    products: SceneProducts,
    flight: Flight,
    target: ObjectBox,
    verdict: Verdict,
    prompts: tuple[Prompt, ...],
    licence: str,
) -> Episode:
    description = products.description
    lineage = products.lineage
    return Episode(
        episode_id=f"{products.scene}/{flight.flight_id:04d}",
        scene=products.scene,
        category=description.category,
        subcategory=description.subcategory,
        setting=description.setting,
        seed=lineage.seed or products.scene,
        split=_split(products, flight, prompts),
        flight_id=flight.flight_id,
        set_index=flight.set_index,
        leg_index=flight.leg_index,
        object_id=target.object_id,
        object_label=target.label,
        object_colour=target.colour,
        label_source=target.label_source,
        annotator=target.annotator,
        box_centre=target.centre,
        box_size=target.size,
        box_yaw=target.yaw,
        start_position=_vector(flight.positions[0]),
        start_quaternion=_vector(flight.quaternions[0]),
        start_yaw=float(flight.yaws[0]),
        target_point=_vector(flight.target_point),
        frame_count=len(products.frames.flight(flight.flight_id)),
        frame_rate=products.frames.rig.frame_rate,
        prompts=prompts,
        judge=verdict.judge,
        gates=verdict.gates,
        report=flight.report,
        licence=licence,
        models=dict(sorted(lineage.tools.items())),
        data_versions=dict(sorted(products.data_versions.items())),
    )


def _split(products: SceneProducts, flight: Flight, prompts: tuple[Prompt, ...]) -> Split:
    imported = products.description.provenance.kind == "imported"
    subcategory = "" if imported else products.description.subcategory
    split = split_of(products.scene, flight.set_index, subcategory)
    if split == "train" and all(is_unseen_instruction(p.text) for p in prompts):
        return "test_unseen_instruction"
    return split


def _vector(values: Any) -> Vector:
    return tuple(float(v) for v in values)


_POINT = pa.list_(pa.float64(), 3)
_PROMPT = pa.struct([("kind", pa.string()), ("text", pa.string()), ("writer", pa.string())])
_GATE = pa.struct(
    [
        ("gate", pa.string()),
        ("value", pa.float64()),
        ("threshold", pa.float64()),
        ("passed", pa.bool_()),
        ("reason", pa.string()),
    ]
)
_REPORT = pa.struct([(f.name, pa.string() if f.type is str else pa.float64()) for f in fields(FlightReport)])
EPISODE_SCHEMA = pa.schema(
    [
        ("episode_id", pa.string()),
        ("scene", pa.string()),
        ("category", pa.string()),
        ("subcategory", pa.string()),
        ("setting", pa.string()),
        ("seed", pa.string()),
        ("split", pa.string()),
        ("flight_id", pa.int32()),
        ("set_index", pa.int32()),
        ("leg_index", pa.int32()),
        ("object_id", pa.int32()),
        ("object_label", pa.string()),
        ("object_colour", pa.string()),
        ("label_source", pa.string()),
        ("annotator", pa.string()),
        ("box_centre", _POINT),
        ("box_size", _POINT),
        ("box_yaw", pa.float64()),
        ("start_position", _POINT),
        ("start_quaternion", pa.list_(pa.float64(), 4)),
        ("start_yaw", pa.float64()),
        ("target_point", _POINT),
        ("frame_count", pa.int32()),
        ("frame_rate", pa.float64()),
        ("prompts", pa.list_(_PROMPT)),
        ("judge", pa.string()),
        ("gates", pa.list_(_GATE)),
        ("report", _REPORT),
        ("licence", pa.string()),
        ("models", pa.map_(pa.string(), pa.string())),
        ("data_versions", pa.map_(pa.string(), pa.string())),
    ]
)


def episodes_table(episodes: tuple[Episode, ...]) -> pa.Table:
    """One row an episode, columns as `EPISODE_SCHEMA`."""
    rows = []
    for episode in episodes:
        prompts = [{"kind": p.kind, "text": p.text, "writer": p.writer} for p in episode.prompts]
        maps = {name: list(getattr(episode, name).items()) for name in ("models", "data_versions")}
        rows.append({**asdict(episode), "prompts": prompts, **maps})
    return pa.Table.from_pylist(rows, schema=EPISODE_SCHEMA)


def episodes_from(table: pa.Table) -> tuple[Episode, ...]:
    """The inverse of `episodes_table`."""
    return tuple(_episode_from(row) for row in table.to_pylist())


def _episode_from(row: dict[str, Any]) -> Episode:
    vectors = ("box_centre", "box_size", "start_position", "start_quaternion", "target_point")
    return Episode(
        **{
            **row,
            **{name: tuple(row[name]) for name in vectors},
            "prompts": tuple(Prompt(row["flight_id"], **p) for p in row["prompts"]),
            "gates": tuple(GateResult(**g) for g in row["gates"]),
            "report": FlightReport(**row["report"]),
            "models": dict(row["models"]),
            "data_versions": dict(row["data_versions"]),
        }
    )
