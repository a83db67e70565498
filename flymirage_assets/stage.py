"""`product_asset`: turns a function of the paper's shape, products in and one out, into a partitioned Dagster asset.

Around the function it does what every stage needs and none should repeat: the early cut-off (same code, settings and
inputs: nothing to do), provenance, the content hash as data version, numbers and a picture as metadata.
"""

import base64
import hashlib
import importlib.metadata
import inspect
import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any, cast

import dagster as dg
import numpy as np
from numpy.typing import NDArray

from flymirage_core.errors import FlyMirageError
from flymirage_core.pictures.encoding import jpeg_under
from flymirage_core.product import Product
from flymirage_core.progress import current_listener, listening
from flymirage_core.scene.keys import check_scene_key, rng
from flymirage_core.settings import Settings
from resources.io_manager import Commit, ProductIOManager
from resources.records import ProductRecord, SceneOrigin
from resources.store import Staged, Store
from resources.tools import Tools, choose_tools

scenes = dg.DynamicPartitionsDefinition(name="scene")
PREVIEW_BYTES = 45_000
"""Previews live in Dagster's event log for ever, so they stay small."""


@dataclass(frozen=True)
class Stage:
    """What a stage may use besides its inputs: the scene, its declared settings, the tools, a private folder."""

    scene: str
    settings: Settings  # only the declared sections answer
    tools: Tools
    store: Store
    scratch: Path

    @property
    def origin(self) -> SceneOrigin:
        """What the scene is; a key that nobody registered (typed in the UI) is a generated scene."""
        return self.store.origin(self.scene) or SceneOrigin(scene=self.scene, kind="generated")

    def rng(self, stage: str, index: int = 0) -> np.random.Generator:
        return rng(self.scene, stage, index)


@dataclass(frozen=True)
class _Declared:
    """The settings sections that a stage declared; asking for another is a bug that would make staleness lie."""

    settings: Settings
    names: tuple[str, ...]

    def __getattr__(self, name: str) -> Any:
        if name not in self.names:
            raise AttributeError(f"this stage does not declare the settings section {name!r}: add it to `sections=`")
        return getattr(self.settings, name)


Compute = Callable[..., Product]  # function(stage, **upstream products) -> product
Draw = Callable[..., NDArray[np.uint8]]  # draw(stage, product, **upstream products) -> (H, W, 3) RGB


@dataclass(frozen=True)
class ProductAsset:
    """One stage of the pipeline: the function and all that its staleness depends on."""

    name: str
    compute: Compute
    draw: Draw
    version: str
    sections: tuple[str, ...]
    tools: tuple[str, ...]
    settings: Settings

    @property
    def section_values(self) -> dict[str, Any]:
        return {name: getattr(self.settings, name).model_dump(mode="json") for name in self.sections}

    @property
    def code_version(self) -> str:
        """The declared version and a hash of the settings it reads: what makes a product stale."""
        return f"{self.version}-{_hash(self.section_values)[:8]}"

    def materialise(
        self, store: Store, scene: str, inputs: Mapping[str, Any], digests: dict[str, str], log: Callable[[str], None]
    ) -> Commit:
        """Compute the product of ``scene``, or find that the current one is still right.

        ``digests`` names the exact bytes of everything that goes in: upstream products, or the scene's registration.
        """
        tools = choose_tools(self.settings)
        tool_names = {port: getattr(tools, port).name for port in self.tools}
        input_hash = _hash([self.code_version, digests, tool_names])
        current = store.current(self.name, scene)
        if current is not None and current.input_hash == input_hash and store.is_whole(current):
            log(f"{self.name} of {scene}: inputs, code and settings are unchanged, nothing to do")
            return Commit(current, preview=store.preview(current))
        started = time.perf_counter()
        report = self._listener(log)
        report("", 0, 1)
        with store.scratch() as scratch, listening(report):
            declared = cast(Settings, _Declared(self.settings, self.sections))
            stage = Stage(scene, declared, tools, store, scratch)
            product = self.compute(stage, **inputs)
            staged = store.stage(product)
            preview = jpeg_under(self.draw(stage, product, **inputs), PREVIEW_BYTES)
        report("", 1, 1)
        seconds = time.perf_counter() - started
        return Commit(self._record(scene, staged, input_hash, digests, tool_names, product, seconds), staged, preview)

    def _record(
        self,
        scene: str,
        staged: Staged,
        input_hash: str,
        inputs: dict[str, str],
        tools: dict[str, str],
        product: Product,
        seconds: float,
    ) -> ProductRecord:
        return ProductRecord(
            asset=self.name,
            scene=scene,
            digest=staged.digest,
            input_hash=input_hash,
            code_version=self.code_version,
            flymirage_version=importlib.metadata.version("flymirage"),
            settings=self.section_values,
            seed=scene,
            inputs=inputs,
            tools=tools,
            files=staged.files,
            summary=dict(product.summary()),
            seconds=round(seconds, 3),
            created_at=datetime.now(UTC).isoformat(timespec="seconds"),
        )

    def _listener(self, log: Callable[[str], None]) -> Callable[[str, int, int], None]:
        outer = current_listener()

        def report(what: str, done: int, total: int) -> None:
            if outer is not None:
                outer(f"{self.name} {what}".strip(), done, total)
            elif what and done and done in (total // 4, total // 2, total * 3 // 4, total):
                log(f"{self.name}: {done} of {total} {what}")

        return report


def product_asset(
    *,
    version: str,
    group: str,
    settings: Settings,
    draw: Draw,
    sections: Sequence[str] = (),
    tools: Sequence[str] = (),
    kinds: Sequence[str] = ("python",),
) -> Callable[[Compute], dg.AssetsDefinition]:
    """Make a scene-partitioned asset of ``function(stage, **upstream products) -> product``.

    ``sections`` names the settings it reads, ``tools`` the ports it uses, ``draw(stage, product, **upstream)`` makes
    the picture that a person wants to see of it. The function's docstring becomes the asset's description.
    """

    def decorate(function: Compute) -> dg.AssetsDefinition:
        hints = inspect.get_annotations(function)
        upstream = {name: hint for name, hint in hints.items() if name not in ("stage", "return")}
        stage = ProductAsset(function.__name__, function, draw, version, tuple(sections), tuple(tools), settings)

        @dg.asset(
            name=stage.name,
            description=inspect.getdoc(function),
            partitions_def=scenes,
            group_name=group,
            code_version=stage.code_version,
            kinds=set(kinds),
            required_resource_keys={"io_manager"},
            ins={name: dg.AssetIn(dagster_type=_dagster_type(hint)) for name, hint in upstream.items()},
            metadata={"product": hints["return"].__name__},
        )
        def materialise(context: dg.AssetExecutionContext, **inputs: Any) -> Any:
            store = cast(ProductIOManager, context.resources.io_manager).store
            with one_clear_sentence():
                scene = check_scene_key(context.partition_key)
                digests = upstream_digests(store, scene, upstream)
                commit = stage.materialise(store, scene, inputs, digests, context.log.info)
            return materialize_result(commit, store)

        return materialise

    return decorate


def upstream_digests(store: Store, scene: str, upstream: Iterable[str]) -> dict[str, str]:
    """Content hashes of the current upstream products; of the scene's registration where there are none."""
    records = {asset: store.current(asset, scene) for asset in upstream}
    if not records:
        origin = store.origin(scene)
        return {"origin": "" if origin is None else _hash(origin.model_dump(mode="json"))}
    return {asset: record.digest for asset, record in records.items() if record is not None}


class one_clear_sentence:  # noqa: N801 - reads as what it does at the place of use
    """Turns the project's own errors into a Dagster failure that is not retried: a retry would meet the same input."""

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        if isinstance(error, FlyMirageError):
            raise dg.Failure(description=str(error), allow_retries=False) from error


def materialize_result(commit: Commit, store: Store) -> Any:
    """The event that Dagster shows: numbers, the folder, a picture, and the content hash as data version."""
    record = commit.record
    folder = store.base / "products" / record.asset / record.scene / record.digest
    metadata: dict[str, Any] = {
        **record.summary,
        "seconds": record.seconds,
        "bytes": record.bytes,
        "usd": record.usd,
        "folder": dg.MetadataValue.path(str(folder)),
        "reused": commit.staged is None,
    }
    if commit.preview is not None:
        picture = base64.b64encode(commit.preview).decode()
        metadata["picture"] = dg.MetadataValue.md(f"![picture](data:image/jpeg;base64,{picture})")
    return dg.MaterializeResult(value=commit, metadata=metadata, data_version=dg.DataVersion(record.digest))


@cache
def _dagster_type(kind: type) -> dg.DagsterType:
    """One Dagster type for each product class: their names must be unique."""
    return dg.PythonObjectDagsterType(kind)


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:32]
