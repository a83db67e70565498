"""Dagster's door to the store: outputs are published here, inputs are loaded here, and nobody else knows of folders."""

import time
from dataclasses import dataclass
from typing import Any

import dagster as dg
from pydantic import PrivateAttr

from flymirage_core.errors import FlyMirageError
from resources.records import ProductRecord
from resources.store import ALL_SCENES, Staged, Store, open_store


@dataclass(frozen=True)
class Commit:
    """What an asset hands over: a staged product with its record; without ``staged``, the record that stays current."""

    record: ProductRecord
    staged: Staged | None = None
    preview: bytes | None = None
    reinstated: bool = False  # the record is of an earlier product whose files are still there
    returns: Any = None  # the product's class, if what is staged shall be read back before it is published


class ProductIOManager(dg.ConfigurableIOManager):
    """Publishes `Commit`s and loads products by the type that the asking asset declares."""

    base: str
    _store: Store | None = PrivateAttr(default=None)

    @property
    def store(self) -> Store:
        if self._store is None:
            self._store = open_store(self.base)
        return self._store

    def handle_output(self, context: dg.OutputContext, obj: Commit) -> None:
        if obj.staged is None:
            if obj.reinstated:
                self.store.reinstate(obj.record)
            return
        started = time.perf_counter()
        self.store.publish(obj.staged, obj.record, obj.preview)
        context.add_output_metadata({"commit_seconds": round(time.perf_counter() - started, 3)})

    def load_input(self, context: dg.InputContext) -> Any:
        asset = context.asset_key.path[-1]
        scene = context.partition_key if context.has_partition_key else ALL_SCENES
        try:
            return context.dagster_type.typing_type.load(self.store.folder(asset, scene))
        except FlyMirageError as error:
            raise dg.Failure(description=str(error), allow_retries=False) from error
