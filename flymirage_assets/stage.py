"""`product_asset`: turns a function of the paper's shape, products in and one out, into a partitioned Dagster asset.

Around the function it does what every stage needs and none should repeat: the early cut-off (same code, settings and
inputs: nothing to do), provenance, the content hash as data version, numbers and a picture as metadata.
"""

import base64
import importlib.metadata
import inspect
import time
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any, cast

import dagster as dg
import numpy as np
from numpy.typing import NDArray

from flymirage_assets.catalogue import KINDS, columns_of
from flymirage_assets.checks import check_results, check_specs
from flymirage_assets.conditions import condition_of
from flymirage_assets.failures import one_clear_sentence
from flymirage_assets.hashing import hash_of, input_hash_of
from flymirage_assets.home import tag_with_process
from flymirage_assets.pools import is_paid, pool_of
from flymirage_core.errors import ModerationError, ProductError
from flymirage_core.pictures.encoding import jpeg_under
from flymirage_core.product import Product
from flymirage_core.progress import current_listener, listening
from flymirage_core.scene.keys import check_scene_key, rng
from flymirage_core.settings import Settings
from resources.io_manager import Commit, ProductIOManager
from resources.records import NewerRecordError, ProductRecord, SceneOrigin
from resources.rerolls import roll_again
from resources.services.account import Account
from resources.store import ALL_SCENES, Staged, Store
from resources.tools import Tools, choose_tools, is_service

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
    returns: type[Product] | None = None  # the product's class: what was written is read back before it is published

    @property
    def section_values(self) -> dict[str, Any]:
        return {name: getattr(self.settings, name).model_dump(mode="json") for name in self.sections}

    @property
    def code_version(self) -> str:
        """The declared version and a hash of the settings it reads: what makes a product stale."""
        return f"{self.version}-{hash_of(self.section_values)[:8]}"

    def materialise(
        self, store: Store, scene: str, inputs: Mapping[str, Any], digests: dict[str, str], log: Callable[[str], None]
    ) -> Commit:
        """Compute the product of ``scene``, or find that the current one is still right.

        ``digests`` names the exact bytes of everything that goes in: upstream products, or the scene's registration.
        """
        origin = store.origin(scene) if scene != ALL_SCENES else None
        reroll = origin.reroll if origin is not None else 0
        account = Account(store, scene, self.name, self.settings.services, reroll)
        tools = choose_tools(self.settings, account)
        tool_names = {port: getattr(tools, port).name for port in self.tools}
        input_hash = input_hash_of(self.code_version, digests, tool_names)
        current = _readable(store, self.name, scene, log)
        if current is not None and current.input_hash == input_hash and store.is_whole(current):
            log(f"{self.name} of {scene}: inputs, code and settings are unchanged, nothing to do")
            return Commit(current, preview=store.preview(current), returns=self.returns)
        if (earlier := store.remembered(self.name, scene, input_hash)) is not None:
            log(f"{self.name} of {scene}: the same inputs, code and settings as an earlier time, its product is back")
            return Commit(earlier, preview=store.preview(earlier), reinstated=True, returns=self.returns)
        started = time.perf_counter()
        report = self._listener(log)
        report("", 0, 1)
        with store.scratch() as scratch, listening(report):
            declared = cast(Settings, _Declared(self.settings, self.sections))
            stage = Stage(scene, declared, tools, store, scratch)
            product = self._computed(stage, inputs)
            staged = store.stage(product)
            preview = jpeg_under(self.draw(stage, product, **inputs), PREVIEW_BYTES)
        report("", 1, 1)
        seconds = time.perf_counter() - started
        record = self._record(scene, staged, input_hash, digests, tool_names, product, seconds)
        if is_paid(self.settings, self.tools):
            usage = account.usage_since(current.created_at if current is not None else "")
            record = record.model_copy(update={"usd": usage["usd"], "usage": usage})
        return Commit(record, staged, preview, returns=self.returns)

    def _computed(self, stage: Stage, inputs: Mapping[str, Any]) -> Product:
        """The product; a content that a service refused costs the scene its description, if another can be had."""
        try:
            return self.compute(stage, **inputs)
        except ModerationError as refusal:
            if self.name == "description" or not is_service(self.settings, "scene_writer"):
                raise
            raise roll_again(stage.store, stage.scene, refusal, self.settings.services.rerolls) from refusal

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
) -> Callable[[Compute], dg.AssetsDefinition]:
    """Make a scene-partitioned asset of ``function(stage, **upstream products) -> product``.

    ``sections`` names the settings it reads, ``tools`` the ports it uses, ``draw(stage, product, **upstream)`` makes
    the picture that a person wants to see of it. The function's docstring becomes the asset's description.
    """

    def decorate(function: Compute) -> dg.AssetsDefinition:
        hints = inspect.get_annotations(function)
        upstream = {name: hint for name, hint in hints.items() if name not in ("stage", "return")}
        stage = ProductAsset(
            function.__name__, function, draw, version, tuple(sections), tuple(tools), settings, hints["return"]
        )

        @dg.asset(
            name=stage.name,
            description=inspect.getdoc(function),
            partitions_def=scenes,
            group_name=group,
            code_version=stage.code_version,
            kinds=KINDS[stage.name],
            owners=[f"team:{group}"],
            pool=pool_of(settings, tools),
            retry_policy=retry_policy(settings),
            automation_condition=condition_of(settings, tools),
            check_specs=check_specs(function.__name__),
            required_resource_keys={"io_manager"},
            ins={name: dg.AssetIn(dagster_type=_dagster_type(hint)) for name, hint in upstream.items()},
            metadata={
                "product": hints["return"].__name__,
                "reads_settings": stage.section_values,
                "uses_tools": list(tools),
                "costs_money": is_paid(settings, tools),
                **about(stage.name, function),
            },
        )
        def materialise(context: dg.AssetExecutionContext, **inputs: Any):  # type: ignore[no-untyped-def]
            store = cast(ProductIOManager, context.resources.io_manager).store
            if settings.executor == "in_process":
                tag_with_process(context.instance, context.run)
            with one_clear_sentence():
                scene = check_scene_key(context.partition_key)
                digests = upstream_digests(store, scene, upstream)
                commit = stage.materialise(store, scene, inputs, digests, context.log.info)
            yield materialize_result(commit, store)  # a returned one needs an annotation, which would hide its value

        return materialise

    return decorate


def _readable(store: Store, asset: str, scene: str, log: Callable[[str], None]) -> ProductRecord | None:
    """The current record; none if it is torn, for then the product is made again."""
    try:
        return store.current(asset, scene)
    except NewerRecordError:
        raise
    except ProductError as error:
        log(str(error))
        return None


def upstream_digests(store: Store, scene: str, upstream: Iterable[str]) -> dict[str, str]:
    """Content hashes of the current upstream products; of the scene's registration where there are none."""
    records = {asset: store.current(asset, scene) for asset in upstream}
    if not records:
        origin = store.origin(scene)
        return {"origin": "" if origin is None else hash_of(origin.model_dump(mode="json"))}
    return {asset: record.digest for asset, record in records.items() if record is not None}


def retry_policy(settings: Settings) -> dg.RetryPolicy | None:
    """Again after a transient failure, later and later; what is permanent says so itself (`one_clear_sentence`)."""
    if settings.operation.step_retries == 0:
        return None
    return dg.RetryPolicy(
        max_retries=settings.operation.step_retries,
        delay=settings.operation.retry_delay,
        backoff=dg.Backoff.EXPONENTIAL,
        jitter=dg.Jitter.PLUS_MINUS,
    )


def about(asset: str, function: Callable[..., Any]) -> dict[str, Any]:
    """What a record of ``asset`` holds, and where its function stands: the UI opens it in an editor."""
    code = inspect.unwrap(function).__code__
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", dg.BetaWarning)
        place = dg.LocalFileCodeReference(file_path=code.co_filename, line_number=code.co_firstlineno)
        references = dg.CodeReferencesMetadataValue(code_references=[place])
    return {"dagster/code_references": references, "dagster/column_schema": columns_of(asset)}


def materialize_result(commit: Commit, store: Store) -> Any:
    """The event that Dagster shows: numbers, the folder, a picture, and the content hash as data version."""
    record = commit.record
    results = check_results(commit, store)
    if not all(result.passed for result in results if result.severity == dg.AssetCheckSeverity.ERROR):
        commit = replace(commit, staged=None)  # corrupt: never published
    folder = store.base / "products" / record.asset / record.scene / record.digest
    metadata: dict[str, Any] = {
        **record.summary,
        "seconds": record.seconds,
        "bytes": record.bytes,
        "usd": record.usd,
        **{name: value for name, value in record.usage.items() if name != "usd"},
        "folder": dg.MetadataValue.path(str(folder)),
        "reused": commit.staged is None,
    }
    if commit.preview is not None:
        picture = base64.b64encode(commit.preview).decode()
        metadata["picture"] = dg.MetadataValue.md(f"![picture](data:image/jpeg;base64,{picture})")
    return dg.MaterializeResult(
        value=commit, metadata=metadata, data_version=dg.DataVersion(record.digest), check_results=results
    )


@cache
def _dagster_type(kind: type) -> dg.DagsterType:
    """One Dagster type for each product class: their names must be unique."""
    return dg.PythonObjectDagsterType(kind)
