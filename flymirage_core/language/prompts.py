"""`Prompts`, the product of the `prompts` asset: up to three instructions for each kept flight, and one for each run.

Layout: ``prompts.parquet`` (`PROMPT_SCHEMA`, a row a prompt), ``long_prompts.parquet`` (`LONG_PROMPT_SCHEMA`).
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

import pyarrow as pa
import pyarrow.parquet as pq

PromptKind = Literal["object_centred", "relative", "appearance"]


@dataclass(frozen=True)
class Prompt:
    """One instruction; it was read back against all boxes and picked exactly its target."""

    flight_id: int
    kind: PromptKind
    text: str
    writer: str  # "offline 1"; a VLM's name and prompt hash


PROMPT_SCHEMA = pa.schema(
    [("flight_id", pa.int32()), ("kind", pa.string()), ("text", pa.string()), ("writer", pa.string())]
)


@dataclass(frozen=True)
class LongPrompt:
    """One instruction over several flights of a task set, flown one after the other (section IV: long-horizon)."""

    set_index: int
    flight_ids: tuple[int, ...]  # in the order flown, two or more; each begins where the one before it ended
    text: str
    writer: str


LONG_PROMPT_SCHEMA = pa.schema(
    [
        ("set_index", pa.int32()),
        ("flight_ids", pa.list_(pa.int32())),
        ("text", pa.string()),
        ("writer", pa.string()),
    ]
)


@dataclass(frozen=True)
class Prompts:
    """Prompts in the order of flights, then kinds; long ones in the order of sets."""

    prompts: tuple[Prompt, ...]
    long_prompts: tuple[LongPrompt, ...] = ()

    def __iter__(self) -> Iterator[Prompt]:
        return iter(self.prompts)

    def __len__(self) -> int:
        return len(self.prompts)

    def of_flight(self, flight_id: int) -> tuple[Prompt, ...]:
        return tuple(p for p in self if p.flight_id == flight_id)

    def summary(self) -> dict[str, str | int | float]:
        flights = {p.flight_id for p in self}
        return {
            "prompts": len(self),
            "flights_with_prompts": len(flights),
            "prompts_per_flight": round(len(self) / max(len(flights), 1), 2),
            "long_prompts": len(self.long_prompts),
        }

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        pq.write_table(
            pa.Table.from_pylist([asdict(p) for p in self], schema=PROMPT_SCHEMA), folder / "prompts.parquet"
        )
        pq.write_table(
            pa.Table.from_pylist([asdict(p) for p in self.long_prompts], schema=LONG_PROMPT_SCHEMA),
            folder / "long_prompts.parquet",
        )

    @staticmethod
    def load(folder: Path) -> "Prompts":
        rows = pq.read_table(folder / "prompts.parquet", schema=PROMPT_SCHEMA).to_pylist()
        long = pq.read_table(folder / "long_prompts.parquet", schema=LONG_PROMPT_SCHEMA).to_pylist()
        return Prompts(
            tuple(Prompt(**r) for r in rows),
            tuple(LongPrompt(**{**r, "flight_ids": tuple(r["flight_ids"])}) for r in long),
        )
