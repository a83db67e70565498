"""`SceneDescription`, the product of the `description` asset: what an LLM or the offline writer fills in."""

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class Provenance(BaseModel):
    """Where a scene comes from: written from a taxonomy pick, or a world that the user already has."""

    model_config = ConfigDict(frozen=True)

    kind: Literal["generated", "imported"]
    writer: str  # "offline 1", "gpt-5.4 (prompt 3f2a)", "import"
    file_name: str = ""  # imported: the world file's name
    file_sha256: str = ""  # imported
    up: str = ""  # imported: "auto" | "y" | "z" | "-y"
    scale: float = 0.0  # imported: metres per file unit; 0 = the file is in metres


class PlannedObject(BaseModel):
    """One kind of thing in the scene, as the description asks for it."""

    model_config = ConfigDict(frozen=True)

    noun: str  # "bookshelf"
    count: int = Field(ge=1)
    colour: str
    material: str
    placement: Literal["against_wall", "on_floor", "on_surface", "on_wall", "hanging", "around", "in_row"]
    relative_to: str = ""  # noun of the thing it stands on, or around; "" if none


class SceneDescription(BaseModel):
    """A structured scene specification and its prose. Dimensions in metres (x, y, z)."""

    model_config = ConfigDict(frozen=True)

    scene: str
    title: str
    category: str  # taxonomy category, or "imported"
    subcategory: str
    setting: Literal["indoor", "outdoor"]
    dimensions: tuple[float, float, float]
    style: str
    palette: tuple[str, ...]  # colour names, the walls' first
    light: str
    objects: tuple[PlannedObject, ...]
    prose: str
    provenance: Provenance

    def summary(self) -> dict[str, str | int | float]:
        return {
            "title": self.title,
            "category": self.category,
            "subcategory": self.subcategory,
            "planned_objects": sum(o.count for o in self.objects),
        }

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "description.json").write_text(self.model_dump_json(indent=2) + "\n")

    @staticmethod
    def load(folder: Path) -> "SceneDescription":
        return SceneDescription.model_validate_json((folder / "description.json").read_text())
