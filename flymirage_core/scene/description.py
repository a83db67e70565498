"""`SceneDescription`, the product of the `description` asset: the design of a scene, and where it comes from."""

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict

from flymirage_core.scene.design import SceneDesign


class Provenance(BaseModel):
    """Where a scene comes from: written from a taxonomy pick, or a world that the user already has."""

    model_config = ConfigDict(frozen=True)

    kind: Literal["generated", "imported"]
    writer: str  # "offline 1", "gpt-5.4 (prompt 3f2a)", "import"
    file_name: str = ""  # imported: the world file's name
    file_sha256: str = ""  # imported
    up: str = ""  # imported: "auto" | "y" | "z" | "-y"
    scale: float = 0.0  # imported: metres per file unit; 0 = the file is in metres


class SceneDescription(SceneDesign):
    """The design of a scene that has a key, and where it comes from. An imported world's design is empty."""

    scene: str
    category: str  # taxonomy category, or "imported"
    subcategory: str
    provenance: Provenance

    def check(self) -> None:
        """As a design's; of an import there is nothing to check."""
        if self.provenance.kind == "generated":
            super().check()

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
