"""`QualityVerdicts`, the product of the `quality_verdict` asset: keep or drop, with reasons and numbers."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq


@dataclass(frozen=True)
class GateResult:
    """One measured gate. ``passed`` is what decides; ``reason`` is a sentence when it did not pass, else ""."""

    gate: str  # "alpha_coverage"
    value: float
    threshold: float
    passed: bool
    reason: str


@dataclass(frozen=True)
class Verdict:
    """The verdict on one flight: kept if every gate passed (and the judge, if one was asked, agreed)."""

    flight_id: int
    keep: bool
    gates: tuple[GateResult, ...]
    judge: str  # "measured 1"; a VLM's name and prompt hash where one was asked

    @property
    def reasons(self) -> tuple[str, ...]:
        return tuple(g.reason for g in self.gates if not g.passed)


VERDICT_SCHEMA = pa.schema(
    [
        ("flight_id", pa.int32()),
        ("keep", pa.bool_()),
        (
            "gates",
            pa.list_(
                pa.struct(
                    [
                        ("gate", pa.string()),
                        ("value", pa.float64()),
                        ("threshold", pa.float64()),
                        ("passed", pa.bool_()),
                        ("reason", pa.string()),
                    ]
                )
            ),
        ),
        ("judge", pa.string()),
    ]
)


@dataclass(frozen=True)
class QualityVerdicts:
    """One verdict for each flight that has frames."""

    verdicts: tuple[Verdict, ...]

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    def __len__(self) -> int:
        return len(self.verdicts)

    @property
    def kept(self) -> tuple[int, ...]:
        """Flight ids of the kept flights, ascending."""
        return tuple(v.flight_id for v in self if v.keep)

    def summary(self) -> dict[str, str | int | float]:
        reasons: dict[str, int] = {}
        for gate in (g for v in self for g in v.gates if not g.passed):
            reasons[f"dropped_by_{gate.gate}"] = reasons.get(f"dropped_by_{gate.gate}", 0) + 1
        return {"kept": len(self.kept), "dropped": len(self) - len(self.kept), **reasons}

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        pq.write_table(
            pa.Table.from_pylist([asdict(v) for v in self], schema=VERDICT_SCHEMA), folder / "verdicts.parquet"
        )

    @staticmethod
    def load(folder: Path) -> "QualityVerdicts":
        rows = pq.read_table(folder / "verdicts.parquet", schema=VERDICT_SCHEMA).to_pylist()
        return QualityVerdicts(
            tuple(Verdict(**{**r, "gates": tuple(GateResult(**g) for g in r["gates"])}) for r in rows)
        )
