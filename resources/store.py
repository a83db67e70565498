"""The store: where products are, committed so that nothing half-written is ever read.

Layout under the base (a local path or any fsspec URL)::

    scenes/<scene>.json                        what the scene is (`SceneOrigin`)
    imports/<scene>/<file>                     the world file a user brought
    products/<asset>/<scene>/<digest>/...      files, named by their content
    products/<asset>/<scene>/product.json      written last: which digest is current, and its provenance
    products/<asset>/<scene>/made/<input hash>.json   its earlier records: the way back to old settings is free
    services/<scene>/...                       answers that were paid for, and journals of paid requests
    growth/                                    notes of growth: how many scenes each category has
    staging/                                   work in progress; never read, swept when old

A writer that is killed leaves at most an unreferenced folder. Reading goes by ``product.json`` alone.
"""

import contextlib
import hashlib
import os
import shutil
import socket
import tempfile
import time
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from upath import UPath

from flymirage_core.errors import InputError, ProductError
from flymirage_core.product import Product
from flymirage_core.scene.keys import check_scene_key
from resources.faults import fault_point
from resources.processes import is_alive, this_process
from resources.records import FileEntry, ProductRecord, SceneOrigin, parse_origin, parse_record

STALE_STAGING_SECONDS = 24 * 3600
READERS = 16
"""Records are read by so many threads: an object store answers one after the other too slowly."""
PREVIEW_NAME = "preview.jpg"
"""A picture for people: kept beside the product, outside of its content hash."""


@dataclass(frozen=True)
class Staged:
    """A product written to a private folder and hashed, not yet visible to anyone."""

    folder: Path
    files: dict[str, FileEntry]
    digest: str


class Store:
    """Products and scenes under one base. Safe for several processes: the last complete commit wins."""

    def __init__(self, base: str) -> None:
        remote = "://" in base  # listings are not cached: other machines write to the same place
        self.base = UPath(base, use_listings_cache=False) if remote else UPath(os.path.abspath(base))  # noqa: PTH100
        self.is_local = self.base.protocol in ("", "file", "local")

    # Scenes ---------------------------------------------------------------------------------------------------------

    def register(self, origin: SceneOrigin) -> None:
        """Make a scene known. Registering it again with other contents replaces it (its products become stale)."""
        self._put_text(self.base / "scenes" / f"{origin.scene}.json", origin.model_dump_json(indent=2) + "\n")

    def claim(self, origin: SceneOrigin) -> bool:
        """Register a scene that nobody registered before; False if somebody did, also at this very instant."""
        path = self.base / "scenes" / f"{origin.scene}.json"
        text = origin.model_dump_json(indent=2) + "\n"
        if not self.is_local:
            path.parent.mkdir(parents=True, exist_ok=True)
            try:
                with path.fs.open(path.path, "xb") as file:
                    file.write(text.encode())
            except FileExistsError:
                return False
            return True
        staged = self._staging_folder() / path.name
        self._put_text(UPath(staged), text)
        Path(str(path.parent)).mkdir(parents=True, exist_ok=True)
        try:
            os.link(staged, str(path))  # fails if it exists; and nobody ever reads half of it
        except FileExistsError:
            return False
        finally:
            shutil.rmtree(staged.parent, ignore_errors=True)
        return True

    def origin(self, scene: str) -> SceneOrigin | None:
        """What a scene is, or None if nobody registered it (a key typed in the UI)."""
        path = self.base / "scenes" / f"{check_scene_key(scene)}.json"
        return parse_origin(path.read_text(), str(path)) if path.exists() else None

    def knows(self, scene: str) -> bool:
        """True if `scenes` lists it."""
        check_scene_key(scene)
        return (self.base / f"scenes/{scene}.json").exists() or (self.base / f"products/description/{scene}").exists()

    def scenes(self) -> list[str]:
        """Keys, sorted, of all scenes that were registered, or described (from a key typed in the UI)."""
        registered, described = self.base / "scenes", self.base / "products" / "description"
        keys = {p.stem for p in registered.iterdir() if p.suffix == ".json"} if registered.exists() else set()
        return sorted(keys | ({p.name for p in described.iterdir()} if described.exists() else set()))

    def keep_import(self, scene: str, source: Path) -> str:
        """Copy a world file into the store; return its sha256."""
        target = self.base / "imports" / check_scene_key(scene) / f"world{source.suffix.lower()}"
        staged = self._staging_folder() / source.name
        try:
            shutil.copy2(source, staged)
            self._move_file(staged, target)
        finally:
            shutil.rmtree(staged.parent, ignore_errors=True)
        return sha256_of(source)

    def imported_file(self, origin: SceneOrigin) -> Path:
        """A local copy of the world file of an imported scene; raises `ProductError` if it is gone or changed."""
        name = f"world{Path(origin.file_name).suffix.lower()}"
        local = self._local(self.base / "imports" / origin.scene, [name]) / name
        if not local.exists() or sha256_of(local) != origin.file_sha256:
            raise ProductError(
                f"the world file of scene {origin.scene!r} ({local}) is gone or differs from what was imported: "
                f"run `flymirage import {origin.file_name} --scene {origin.scene}` again"
            )
        return local

    # Products -------------------------------------------------------------------------------------------------------

    def assets(self) -> list[str]:
        """Names of all products that any scene has."""
        products = self.base / "products"
        return sorted(p.name for p in products.iterdir()) if products.exists() else []

    def scenes_with(self, asset: str) -> set[str]:
        """Keys of scenes that have a product ``asset``: one listing, however many there are.

        On an object store a scene counts from the first file of its product on, not from the last.
        """
        folder = self.base / "products" / asset
        if not folder.exists():
            return set()
        if not self.is_local:
            return {p.name for p in folder.iterdir()}
        with os.scandir(str(folder)) as entries:
            return {e.name for e in entries if os.path.exists(f"{e.path}/product.json")}  # noqa: PTH110 - 10,000 times

    def scenes_with_all(self, assets: Sequence[str]) -> list[str]:
        """Keys, sorted, of scenes that have all of ``assets``; the last one is made from the others.

        A listing for each asset; of an object store also a look whether the last product's pointer is there.
        """
        scenes = sorted(set.intersection(*(self.scenes_with(asset) for asset in assets)))
        if self.is_local:
            return scenes
        with ThreadPoolExecutor(READERS) as readers:
            pointers = readers.map(lambda scene: (self._product(assets[-1], scene) / "product.json").exists(), scenes)
            return [scene for scene, there in zip(scenes, pointers, strict=True) if there]

    def current(self, asset: str, scene: str) -> ProductRecord | None:
        """The record of the product that is current, or None if there is none yet."""
        path = self._product(asset, scene) / "product.json"
        try:
            text = path.read_text()
        except FileNotFoundError:
            return None
        return parse_record(text, str(path))

    def folder(self, asset: str, scene: str) -> Path:
        """A local folder with the current product's files; raises `ProductError` if it is missing or torn."""
        record = self.current(asset, scene)
        if record is None:
            raise ProductError(f"scene {scene!r} has no product {asset!r} yet: materialise it first")
        problem = self._what_is_torn(record)
        if problem:
            raise ProductError(f"{problem}: run `flymirage make {scene}`, which makes {asset!r} again")
        return self._local(self._product(asset, scene) / record.digest, list(record.files))

    def preview(self, record: ProductRecord) -> bytes | None:
        """The picture kept beside a product, if there is one."""
        path = self._product(record.asset, record.scene) / record.digest / PREVIEW_NAME
        return path.read_bytes() if path.exists() else None

    def is_whole(self, record: ProductRecord) -> bool:
        """True if every file of the record is there with its size."""
        return not self._what_is_torn(record)

    def remembered(self, asset: str, scene: str, input_hash: str) -> ProductRecord | None:
        """The record of an earlier product with this input hash whose files are still there, or None."""
        path = self._product(asset, scene) / f"made/{input_hash}.json"
        try:
            record = parse_record(path.read_text(), str(path))
        except (FileNotFoundError, ProductError):
            return None
        return record if self.is_whole(record) else None

    def reinstate(self, record: ProductRecord) -> None:
        """Make an earlier product, whose files are still there, the current one again."""
        self._put_text(self._product(record.asset, record.scene) / "product.json", _as_text(record))

    def stage(self, product: Product) -> Staged:
        """Write ``product`` to a private folder and hash it. Nobody sees it until `publish`."""
        folder = self._staging_folder() / "product"
        product.save(folder)
        fault_point("staged")
        files = {
            path.relative_to(folder).as_posix(): FileEntry(size=path.stat().st_size, sha256=sha256_of(path))
            for path in sorted(folder.rglob("*"))
            if path.is_file()
        }
        listing = "".join(f"{name}\0{entry.sha256}\n" for name, entry in files.items())
        return Staged(folder, files, hashlib.sha256(listing.encode()).hexdigest()[:32])

    def publish(self, staged: Staged, record: ProductRecord, preview: bytes | None = None) -> None:
        """Make a staged product the current one: its files first, the pointer last."""
        if preview is not None:
            (staged.folder / PREVIEW_NAME).write_bytes(preview)
        target = self._product(record.asset, record.scene)
        if self.is_local:
            _move_folder(staged, Path(str(target / record.digest)))
        else:
            names = [*staged.files, PREVIEW_NAME] if preview is not None else list(staged.files)
            for name in names:
                _upload(staged.folder / name, target / record.digest / name)
        fault_point("files committed")
        self._put_text(target / "made" / f"{record.input_hash}.json", _as_text(record))
        self._put_text(target / "product.json", _as_text(record))
        fault_point("pointer committed")
        shutil.rmtree(staged.folder.parent, ignore_errors=True)

    @contextmanager
    def scratch(self) -> Iterator[Path]:
        """A private folder, on the store's own disk if it has one, that is gone afterwards."""
        folder = self._staging_folder()
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    # Notes of the machine room --------------------------------------------------------------------------------------

    def write_note(self, name: str, text: str) -> None:
        """Keep a small text under ``name`` (a relative path), whole or not at all."""
        self._put_text(self.base / name, text)

    def read_note(self, name: str) -> str | None:
        """What `write_note` kept, or None."""
        try:
            return (self.base / name).read_text()
        except FileNotFoundError:
            return None

    def remove_note(self, name: str) -> None:
        """Forget what `write_note` kept."""
        (self.base / name).unlink(missing_ok=True)

    # What services answered ------------------------------------------------------------------------------------------

    def write_service_file(self, name: str, data: bytes) -> None:
        """Keep ``data`` under ``services/<name>``: whole or not at all, and durable when this returns."""
        self._put_bytes(self.base / "services" / name, data)

    def read_service_file(self, name: str) -> bytes | None:
        """What `write_service_file` kept, or None."""
        try:
            return bytes((self.base / "services" / name).read_bytes())
        except FileNotFoundError:
            return None

    def remove_service_file(self, name: str) -> None:
        """Forget what was kept under this name, if anything."""
        (self.base / "services" / name).unlink(missing_ok=True)

    # Within ---------------------------------------------------------------------------------------------------------

    def _what_is_torn(self, record: ProductRecord) -> str:
        folder = self._product(record.asset, record.scene) / record.digest
        sizes = self._sizes(folder, record.files)
        for name, entry in record.files.items():
            if (size := sizes.get(name, 0)) != entry.size:
                return f"{folder / name} is missing or torn (expected {entry.size} bytes, found {size})"
        return ""

    def _sizes(self, folder: UPath, names: Iterable[str]) -> dict[str, int]:
        """Bytes of those files that are there: on an object store one listing tells of all of them."""
        if not self.is_local:
            found = folder.fs.find(folder.path, detail=True)
            return {name.partition(f"/{folder.name}/")[2]: about["size"] for name, about in found.items()}
        sizes = {}
        for name in names:
            with contextlib.suppress(FileNotFoundError):
                sizes[name] = os.stat(f"{folder}/{name}").st_size  # noqa: PTH116 - a sweep asks for 100,000 files
        return sizes

    def _product(self, asset: str, scene: str) -> UPath:
        if scene != ALL_SCENES:
            check_scene_key(scene)
        return self.base / f"products/{asset}/{scene}"

    def _staging_folder(self) -> Path:
        if not self.is_local:
            return Path(tempfile.mkdtemp(prefix="flymirage-"))
        root = Path(str(self.base)) / "staging"
        root.mkdir(parents=True, exist_ok=True)
        for old in root.iterdir():
            if time.time() - old.stat().st_mtime > STALE_STAGING_SECONDS and not is_used(old.name):
                shutil.rmtree(old, ignore_errors=True)
        folder = root / f"{uuid.uuid4().hex}.{socket.gethostname()}.{this_process()}"
        folder.mkdir()
        return folder

    def _local(self, folder: UPath, names: list[str]) -> Path:
        """``folder`` itself on a disk; else a cached copy (content-addressed, so never stale)."""
        if self.is_local:
            return Path(str(folder))
        cache = Path(tempfile.gettempdir()) / "flymirage-cache" / hashlib.sha256(str(folder).encode()).hexdigest()[:32]
        for name in names:
            path = cache / name
            if not path.exists():
                path.parent.mkdir(parents=True, exist_ok=True)
                part = path.with_name(f"{path.name}.{uuid.uuid4().hex}")
                part.write_bytes((folder / name).read_bytes())
                part.replace(path)
        return cache

    def _put_text(self, path: UPath, text: str) -> None:
        self._put_bytes(path, text.encode())

    def _put_bytes(self, path: UPath, data: bytes) -> None:
        if not self.is_local:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
            return
        local = Path(str(path))
        local.parent.mkdir(parents=True, exist_ok=True)
        part = local.with_name(f"{local.name}.{uuid.uuid4().hex}")
        with part.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        part.replace(local)
        _sync_folder(local.parent)

    def _move_file(self, source: Path, target: UPath) -> None:
        if self.is_local:
            local = Path(str(target))
            local.parent.mkdir(parents=True, exist_ok=True)
            source.replace(local)
        else:
            _upload(source, target)


ALL_SCENES = "_all"
"""Stands in a scene's place for products over all scenes; no scene can have this key."""


def open_store(base: str) -> Store:
    """The store at ``base``; raises `InputError` if that cannot be written to."""
    store = Store(base)
    if store.is_local:
        try:
            Path(str(store.base)).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(
                f"the store {base!r} cannot be made ({error.strerror}): set FLYMIRAGE_STORE to a writable folder"
            ) from error
    return store


def _as_text(record: ProductRecord) -> str:
    return record.model_dump_json(indent=2) + "\n"


def sha256_of(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def is_used(staging: str) -> bool:
    """True if a process of this machine still writes to the folder of this name, however old the clock makes it."""
    host, _, process = staging.partition(".")[2].rpartition(".")
    return host == socket.gethostname() and is_alive(process)


def _move_folder(staged: Staged, target: Path) -> None:
    """Move a complete folder into place, unless the same bytes are there: somebody may be reading them just now."""
    for path in staged.folder.rglob("*"):
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        staged.folder.rename(target)
    except OSError:
        if not target.is_dir():
            raise
        if _holds(target, staged.files):
            return
        target.rename(staged.folder.parent / "replaced")  # a torn copy
        staged.folder.rename(target)
    _sync_folder(target.parent)


def _holds(folder: Path, files: Mapping[str, FileEntry]) -> bool:
    return all((folder / name).is_file() and sha256_of(folder / name) == entry.sha256 for name, entry in files.items())


def _upload(source: Path, target: UPath) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    with source.open("rb") as reader, target.open("wb") as writer:
        shutil.copyfileobj(reader, writer)


def _sync_folder(folder: Path) -> None:
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
