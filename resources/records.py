"""The small JSON documents of the store: what a scene is, and which bytes are a product's current ones."""

import json
from collections.abc import Callable
from typing import Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from flymirage_core.errors import ProductError
from flymirage_core.scene.keys import check_scene_key
from flymirage_core.splats.frames import Up

SCHEMA_VERSION = 1
"""Of both documents; raised when a reader of the old ones would misread the new ones."""
UPGRADES: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}
"""What makes a document of version n into one of version n + 1. Old documents are upgraded whenever they are read."""


class NewerRecordError(ProductError):
    """A document was written by a newer FlyMirage: it must not be replaced by this one."""


class Document(BaseModel):
    model_config = ConfigDict(frozen=True)
    schema_version: int = SCHEMA_VERSION


class SceneOrigin(Document):
    """Where a scene comes from: words, or a world file that the user brought (kept in the store beside this)."""

    scene: str
    kind: Literal["generated", "imported"]
    title: str = ""
    category: str = ""  # generated: the taxonomy pick
    subcategory: str = ""
    file_name: str = ""  # imported
    file_sha256: str = ""
    up: Up = "auto"
    scale: float | None = None  # metres per file unit; None = the file is in metres
    reroll: int = 0  # generated: how many of its descriptions a service refused

    @property
    def place(self) -> tuple[str, str] | None:
        """(category, subcategory) that growth chose for a generated scene."""
        return (self.category, self.subcategory) if self.kind == "generated" and self.category else None

    @field_validator("scene")
    @classmethod
    def _key(cls, value: str) -> str:
        return check_scene_key(value)


class FileEntry(BaseModel):
    model_config = ConfigDict(frozen=True)
    size: int
    sha256: str


class ProductRecord(Document):
    """``product.json``: which folder is current, and everything needed to know why it holds what it holds."""

    asset: str
    scene: str
    digest: str  # content hash of the files, and the folder's name
    input_hash: str  # H(code version, settings, upstream digests): the same -> nothing to do
    code_version: str
    flymirage_version: str
    settings: dict[str, Any]  # the sections that this stage reads
    seed: str  # randomness comes from (scene key, stage, index); this is the key
    inputs: dict[str, str]  # upstream asset -> digest
    tools: dict[str, str]  # rasterizer, annotator...: names and versions
    files: dict[str, FileEntry]
    summary: dict[str, str | int | float]
    seconds: float
    usd: float = 0.0
    usage: dict[str, float] = {}  # calls, tokens, images, credits of services, and what they cost
    created_at: str = Field(description="UTC, ISO 8601")

    @property
    def bytes(self) -> int:
        return sum(f.size for f in self.files.values())


def parse_record(text: str, where: str) -> ProductRecord:
    """Read a ``product.json``; raise `ProductError` for one that is torn or of a version this code does not know."""
    return _parse(ProductRecord, text, where)


def parse_origin(text: str, where: str) -> SceneOrigin:
    """Read a scene's registration; errors as in `parse_record`."""
    return _parse(SceneOrigin, text, where)


D = TypeVar("D", bound=Document)


def _parse(kind: type[D], text: str, where: str) -> D:
    try:
        found = json.loads(text)
        version = found.get("schema_version", 1) if isinstance(found, dict) else 1
        if version > SCHEMA_VERSION:
            raise NewerRecordError(
                f"{where} has schema version {version}, this FlyMirage reads up to version {SCHEMA_VERSION}: "
                "use the FlyMirage that wrote it, or a newer one"
            )
        for step in range(version, SCHEMA_VERSION):
            found = {**UPGRADES[step](found), "schema_version": step + 1}
        return kind.model_validate(found)
    except json.JSONDecodeError as error:
        raise ProductError(f"{where} cannot be read: it is torn ({error}); delete it and materialise again") from error
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(str(part) for part in first["loc"]) or "the document"
        raise ProductError(
            f"{where} cannot be read: {field}: {first['msg']}; delete it and materialise again"
        ) from error
