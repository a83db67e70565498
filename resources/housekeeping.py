"""Keeping a store small and clean: old versions of products, left-overs of killed writers, scenes nobody wants."""

import shutil
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from upath import UPath

from flymirage_core.errors import InputError, ProductError
from flymirage_core.scene.keys import check_scene_key
from resources.records import parse_record
from resources.store import ALL_SCENES, Store, is_used


@dataclass(frozen=True)
class Freed:
    """What was removed, or would be."""

    folders: int
    bytes: int


def collect_garbage(store: Store, older_than: float, removing: bool) -> Freed:
    """Remove versions of products that are not current and were made more than ``older_than`` seconds ago.

    Left-overs in ``staging/`` and, for object stores, local copies go by the same age. With ``removing`` False they
    are only counted. What goes away has to be computed again if somebody changes a setting back.
    """
    deadline = time.time() - older_than
    doomed: list[UPath] = []
    for asset in store.assets():
        for product in _folders(store.base / "products" / asset):
            doomed += _old_versions(store, asset, product, deadline)
    if store.is_local:
        doomed += [f for f in _folders(store.base / "staging") if _age_of(f) < deadline and not is_used(f.name)]
    else:
        cache = UPath(tempfile.gettempdir()) / "flymirage-cache"
        doomed += [f for f in _folders(cache) if _age_of(f) < deadline]
    size = sum(_size(folder) for folder in doomed)
    if removing:
        for folder in doomed:
            _remove(folder)
    return Freed(len(doomed), size)


def check_known(store: Store, scene: str) -> None:
    """Raises `SceneKeyError` for what can be no scene's key, `InputError` for a scene that nobody knows."""
    if not store.knows(scene):
        raise InputError(f"scene {scene!r} is not known: `flymirage status` lists the scenes")


def remove_scene(store: Store, scene: str) -> Freed:
    """Remove everything of a scene: products, what services answered, its world file, its registration.

    Pointers go first, so nobody reads a product that is half gone; the registration goes last, so that a removal that
    was interrupted can be repeated. Raises `InputError` for a scene that nobody knows.
    """
    check_known(store, scene)
    folders = [store.base / "products" / asset / scene for asset in store.assets()]
    folders += [store.base / "imports" / scene, store.base / "services" / scene]
    folders = [folder for folder in folders if folder.exists()]
    freed = Freed(len(folders), sum(_size(folder) for folder in folders))
    for folder in folders:
        (folder / "product.json").unlink(missing_ok=True)
    for folder in sorted(folders, key=lambda f: f.parent.name == "description"):  # it makes the scene known: last
        _remove(folder)
    (store.base / "scenes" / f"{scene}.json").unlink(missing_ok=True)
    store.remove_note("growth/tally.json")  # counted anew at the next growth
    return freed


def _old_versions(store: Store, asset: str, product: UPath, deadline: float) -> list[UPath]:
    if product.name != ALL_SCENES:
        check_scene_key(product.name)
    names = [entry.name for entry in product.iterdir()]
    if "product.json" in names and len(set(names) - {"product.json", "made"}) == 1:
        return []  # as nearly all are: no record has to be read
    try:
        current = store.current(asset, product.name)
    except ProductError:
        return []  # nobody knows which version it meant
    versions = [f for f in _folders(product) if f.name != "made" and (current is None or f.name != current.digest)]
    old = [f for f in versions if _age_of(f) < deadline]
    gone = {f.name for f in old}
    for path in (product / "made").iterdir() if old and (product / "made").exists() else ():
        if parse_record(path.read_text(), str(path)).digest in gone and current is not None:
            old.append(path)
    return old


def _folders(folder: UPath) -> list[UPath]:
    return [f for f in folder.iterdir() if f.is_dir()] if folder.exists() else []


def _files(folder: UPath) -> list[UPath]:
    return [folder] if folder.is_file() else [f for f in folder.rglob("*") if f.is_file()]


def _age_of(folder: UPath) -> float:
    """Seconds since the epoch: when the last file in it was written."""
    if isinstance(folder, Path):
        return folder.stat().st_mtime
    return max((file.fs.modified(file.path).timestamp() for file in _files(folder)), default=0.0)


def _size(folder: UPath) -> int:
    return sum(file.stat().st_size for file in _files(folder))


def _remove(folder: UPath) -> None:
    if folder.is_file():
        folder.unlink()
    elif isinstance(folder, Path):
        shutil.rmtree(folder)
    else:
        folder.fs.rm(folder.path, recursive=True)
