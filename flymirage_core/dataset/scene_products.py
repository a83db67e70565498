"""`SceneProducts`: everything that one scene gives to the data set, and the terms that lie on it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from flymirage_core.annotation.boxes import BoxMap
from flymirage_core.language.prompts import Prompts
from flymirage_core.language.verdicts import QualityVerdicts
from flymirage_core.navigation.task_sets import TaskSets
from flymirage_core.navigation.trajectories import Trajectories
from flymirage_core.rendering.frames import Frames
from flymirage_core.scene.description import SceneDescription

OWN_TOOLS = ("offline", "embedded", "measured", "cpu", "gsplat", "import", "ray caster")
"""Beginnings of the names of FlyMirage's own tools, which put no terms on their output."""
BOXER_TERMS = "CC-BY-NC-4.0, non-commercial (boxes by Boxer)"
NO_TERMS = "no third-party terms"


@dataclass(frozen=True)
class SceneLineage:
    """Who made a scene's products, from what seed, and what it cost."""

    seed: str = ""  # randomness comes from (seed, stage, index)
    tools: Mapping[str, str] = field(default_factory=dict)  # asset -> names and versions of what made it
    usd: float = 0.0
    seconds: float = 0.0  # of computing
    flymirage_version: str = ""


@dataclass(frozen=True, eq=False)
class SceneProducts:
    """Everything that one scene gives to the data set. Videos stay on disk until a frame is asked for."""

    scene: str
    description: SceneDescription
    boxes: BoxMap
    task_sets: TaskSets
    trajectories: Trajectories
    frames: Frames
    verdicts: QualityVerdicts
    prompts: Prompts
    data_versions: dict[str, str]  # asset name -> content hash
    lineage: SceneLineage = SceneLineage()

    def products(self) -> "SceneProducts":
        """Itself: products in memory are a source too."""
        return self


class SceneSource(Protocol):
    """A scene whose products can be had; an export asks only for those that it must write."""

    @property
    def scene(self) -> str: ...

    @property
    def data_versions(self) -> dict[str, str]: ...

    def products(self) -> SceneProducts: ...


def terms_of(products: SceneProducts) -> str:
    """What others' terms lie on a scene's data; FlyMirage's own embedded parts put none.

    Boxer is CC-BY-NC-4.0; an imported world keeps its owner's terms, a service's answer that service's.
    """
    terms: dict[str, None] = {}  # ordered, each once
    for annotator in sorted({box.annotator for box in products.boxes}):
        if annotator.lower().startswith("boxer"):
            terms[BOXER_TERMS] = None
    provenance = products.description.provenance
    if provenance.kind == "imported":
        terms[f"the terms of the imported world {provenance.file_name}"] = None
    writers = [
        provenance.writer,
        *(name for names in products.lineage.tools.values() for name in names.split("; ")),
        *(prompt.writer for prompt in products.prompts),
        *(verdict.judge for verdict in products.verdicts),
    ]
    for name in writers:
        if name and not name.lower().startswith((*OWN_TOOLS, "boxer")):
            terms[f"the terms of {name}"] = None
    return "; ".join(terms) or NO_TERMS
