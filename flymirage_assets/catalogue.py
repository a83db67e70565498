"""What the UI says of each asset before anything is made: of which kind it is, and what one of its records holds."""

import inspect
import re

import dagster as dg
import pyarrow as pa

from flymirage_core.annotation.boxes import BOX_SCHEMA
from flymirage_core.dataset.episodes import EPISODE_SCHEMA
from flymirage_core.language.prompts import PROMPT_SCHEMA
from flymirage_core.language.verdicts import VERDICT_SCHEMA
from flymirage_core.navigation.task_sets import TASK_SCHEMA
from flymirage_core.navigation.trajectories import FLIGHT_SCHEMA
from flymirage_core.rendering.frames import FRAME_SCHEMA
from flymirage_core.scene.description import SceneDescription

KINDS: dict[str, set[str]] = {
    "description": {"text", "json"},
    "image": {"image"},
    "world": {"gaussians", "ply"},
    "orbit_renders": {"image", "depth"},
    "orbit_boxes": {"boxes", "parquet"},
    "targets": {"boxes", "parquet"},
    "exploration_renders": {"image", "depth"},
    "boxes": {"boxes", "parquet"},
    "task_sets": {"tasks", "parquet"},
    "trajectories": {"flights", "parquet"},
    "frames": {"video", "depth"},
    "quality_verdict": {"verdicts", "parquet"},
    "prompts": {"text", "parquet"},
    "dataset": {"episodes", "parquet"},
    "lerobot": {"video", "parquet"},
    "flymirage": {"image", "csv"},
    "vlnce": {"episodes", "json"},
    "rlds": {"episodes", "tfrecord"},
    "transforms": {"image", "json"},
    "growth_report": {"report"},
}


def columns_of(asset: str) -> dg.TableSchema:
    """What one record (row, Gaussian, view, episode) of ``asset`` holds."""
    return dg.TableSchema(columns=[dg.TableColumn(name, kind) for name, kind in _COLUMNS[asset].items()])


def _table(schema: pa.Schema) -> dict[str, str]:
    return {field.name: _short(field.type) for field in schema}


def _short(kind: pa.DataType) -> str:
    """
    >>> _short(pa.list_(pa.float64(), 3)), _short(pa.int32())
    ('double[3]', 'int32')
    """
    return f"{kind.value_type}[{kind.list_size}]" if pa.types.is_fixed_size_list(kind) else str(kind)


_VIEW = {"rgb": "uint8 (H, W, 3)", "depth": "uint16 (H, W), mm", "alpha": "uint8 (H, W)", "camera": "K, T_world_camera"}
_EPISODE = _table(EPISODE_SCHEMA)
_COLUMNS: dict[str, dict[str, str]] = {
    "description": {
        name: re.sub(r"\b(\w+\.)+", "", inspect.formatannotation(field.annotation))
        for name, field in SceneDescription.model_fields.items()
    },
    "image": {"rgb": "uint8 (H, W, 3)", "painter": "string"},
    "world": {
        "position": "float32 (3,), metres",
        "scale": "float32 (3,), log metres",
        "rotation": "float32 (4,), wxyz",
        "opacity": "float32, logit",
        "sh": "float32 ((degree + 1)^2, 3)",
    },
    "orbit_renders": _VIEW,
    "orbit_boxes": _table(BOX_SCHEMA),
    "targets": _table(BOX_SCHEMA),
    "exploration_renders": _VIEW,
    "boxes": _table(BOX_SCHEMA),
    "task_sets": _table(TASK_SCHEMA),
    "trajectories": _table(FLIGHT_SCHEMA),
    "frames": _table(FRAME_SCHEMA),
    "quality_verdict": _table(VERDICT_SCHEMA),
    "prompts": _table(PROMPT_SCHEMA),
    **dict.fromkeys(("dataset", "lerobot", "flymirage", "vlnce", "rlds", "transforms"), _EPISODE),
    "growth_report": {
        "night": "date",
        **dict.fromkeys(("scenes", "grown", "failed", "flights_kept", "flights_dropped"), "int"),
        **dict.fromkeys(("usd", "seconds"), "float"),
    },
}
