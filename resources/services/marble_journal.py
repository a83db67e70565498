"""The journal of one paid world: written durably before its start is sent, so that a crash at any instant resumes it.

It lies in the store, as one small document that is replaced as a whole; so any machine that shares the store carries on
where another stopped. It holds no key and no URL. On an object store a document is one PUT, which those make atomic.
"""

from typing import Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from flymirage_core.errors import ProductError
from resources.services.marble_api import Semantics
from resources.store import Store

State = Literal["submitting", "running", "made", "kept", "failed"]


class KeptFile(BaseModel):
    """An original in the store, beside the journal."""

    model_config = ConfigDict(frozen=True)
    name: str
    size: int
    sha256: str


class Journal(BaseModel):
    """What is known of one start of a world.

    submitting: the start may have been sent. running: it was accepted. made: Marble has the world. kept: so do we.
    failed: Marble could not make it.
    """

    model_config = ConfigDict(frozen=True)

    schema_version: int = 1
    key: str  # its tag
    state: State
    started_at: float  # seconds since the epoch, UTC
    balance_before: float  # credits
    operation_id: str = ""
    world_id: str = ""
    credits: int | None = None  # as Marble says
    adopted: bool = False  # found again by its tag
    failure: str = ""
    resolution: str = ""
    caption: str = ""
    semantics: Semantics | None = None
    files: tuple[KeptFile, ...] = ()

    def with_(self, **changes: object) -> "Journal":
        return self.model_copy(update=changes)


class Journals:
    """The journals of one scene's worlds."""

    def __init__(self, store: Store, scene: str) -> None:
        self.store, self.folder = store, f"{scene}/marble"

    def load(self, key: str) -> Journal | None:
        """Raises `ProductError` if the journal cannot be read: then nobody may start the world again by himself."""
        data = self.store.read_service_file(f"{self.folder}/{key}.json")
        if data is None:
            return None
        try:
            return Journal.model_validate_json(data)
        except ValidationError as error:
            raise ProductError(
                f"the journal services/{self.folder}/{key}.json cannot be read ({error.errors()[0]['msg']}): look at "
                f"Marble's list of worlds for the tag {key}, then delete the file to start the world again"
            ) from error

    def save(self, journal: Journal) -> Journal:
        """Durable when this returns."""
        self.store.write_service_file(f"{self.folder}/{journal.key}.json", journal.model_dump_json(indent=1).encode())
        return journal

    def forget(self, key: str) -> None:
        """The start was certainly not accepted."""
        self.store.remove_service_file(f"{self.folder}/{key}.json")

    def keep_file(self, key: str, name: str, data: bytes) -> None:
        self.store.write_service_file(f"{self.folder}/{key}/{name}", data)

    def file(self, key: str, name: str) -> bytes | None:
        return self.store.read_service_file(f"{self.folder}/{key}/{name}")
