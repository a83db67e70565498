"""The store's promises: nothing half-written is ever read, and a key never leaves its folder."""

import os
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flymirage_core.errors import InputError, ProductError, SceneKeyError
from flymirage_core.scene.keys import check_scene_key
from resources.records import ProductRecord, SceneOrigin
from resources.store import PREVIEW_NAME, Store, open_store


@dataclass(frozen=True)
class Note:
    """A product of two small files."""

    text: str

    def save(self, folder: Path) -> None:
        (folder / "deep").mkdir(parents=True)
        (folder / "note.txt").write_text(self.text)
        (folder / "deep" / "copy.txt").write_text(self.text)

    def summary(self) -> dict[str, str | int | float]:
        return {"letters": len(self.text)}


def commit(store: Store, text: str, asset: str = "notes", scene: str = "flat") -> ProductRecord:
    staged = store.stage(Note(text))
    record = ProductRecord(
        asset=asset,
        scene=scene,
        digest=staged.digest,
        input_hash="in",
        code_version="1",
        flymirage_version="0",
        settings={},
        seed=scene,
        inputs={},
        tools={},
        files=staged.files,
        summary=Note(text).summary(),
        seconds=0.0,
        created_at="2026-01-01T00:00:00+00:00",
    )
    store.publish(staged, record, b"jpeg")
    return record


@pytest.fixture(params=["disk", "memory"])
def store(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Store:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # where local copies lie, other people's too
    return open_store(str(tmp_path) if request.param == "disk" else f"memory://{tmp_path.name}")


def test_a_committed_product_is_read_back(store: Store) -> None:
    commit(store, "hello")
    folder = store.folder("notes", "flat")
    assert (folder / "note.txt").read_text() == "hello"
    assert (folder / "deep" / "copy.txt").read_text() == "hello"


def test_the_last_commit_is_current_and_the_old_bytes_stay_whole(store: Store) -> None:
    first = commit(store, "one")
    second = commit(store, "two")
    current = store.current("notes", "flat")
    assert current is not None and current.digest == second.digest != first.digest
    assert (store.folder("notes", "flat") / "note.txt").read_text() == "two"


def test_the_same_content_has_the_same_digest_and_can_be_committed_twice(store: Store) -> None:
    assert commit(store, "same").digest == commit(store, "same").digest
    assert (store.folder("notes", "flat") / "note.txt").read_text() == "same"


def test_a_product_that_somebody_reads_stays_where_it_is_when_it_is_committed_again(tmp_path: Path) -> None:
    store = open_store(str(tmp_path))
    commit(store, "same")
    folder = store.folder("notes", "flat")
    before = folder.stat().st_ino
    commit(store, "same")
    assert folder.stat().st_ino == before
    (folder / "note.txt").write_text("SAME")  # other bytes of the same length
    commit(store, "same")
    assert (folder / "note.txt").read_text() == "same"


def test_the_preview_is_beside_the_product_but_not_in_its_hash(store: Store) -> None:
    record = commit(store, "hello")
    assert PREVIEW_NAME not in record.files
    assert store.preview(record) == b"jpeg"


def test_a_missing_product_says_what_to_do(store: Store) -> None:
    assert store.current("notes", "flat") is None
    with pytest.raises(ProductError, match="no product 'notes' yet: materialise it first"):
        store.folder("notes", "flat")


def test_a_torn_file_is_refused_and_a_new_commit_mends_it(tmp_path: Path) -> None:
    store = open_store(str(tmp_path))
    record = commit(store, "hello")
    torn = store.folder("notes", "flat") / "note.txt"
    torn.unlink()  # the file may be linked elsewhere: never write into it
    torn.write_text("hel")
    assert not store.is_whole(record)
    with pytest.raises(ProductError, match=r"note\.txt is missing or torn \(expected 5 bytes, found 3\)"):
        store.folder("notes", "flat")
    commit(store, "hello")
    assert (store.folder("notes", "flat") / "note.txt").read_text() == "hello"


def test_a_record_of_an_unknown_version_is_refused_with_one_sentence(tmp_path: Path) -> None:
    store = open_store(str(tmp_path))
    commit(store, "hello")
    pointer = tmp_path / "products" / "notes" / "flat" / "product.json"
    pointer.write_text(pointer.read_text().replace('"schema_version": 1', '"schema_version": 99'))
    with pytest.raises(ProductError, match=r"has schema version 99, this FlyMirage reads up to version 1"):
        store.current("notes", "flat")


def test_a_torn_pointer_is_refused_with_one_sentence(tmp_path: Path) -> None:
    store = open_store(str(tmp_path))
    commit(store, "hello")
    pointer = tmp_path / "products" / "notes" / "flat" / "product.json"
    pointer.write_text(pointer.read_text()[:40])
    with pytest.raises(ProductError, match=r"product\.json cannot be read"):
        store.current("notes", "flat")


@pytest.mark.parametrize("key", ["../../etc", "", "A", "a/b", "a..b/..", "x" * 65, "a\n", "é", "-a", "a b", "a,b"])
def test_a_key_that_could_leave_its_folder_is_refused(key: str, tmp_path: Path) -> None:
    store = open_store(str(tmp_path))
    for use in (
        lambda: store.current("notes", key),
        lambda: store.origin(key),
        lambda: store.keep_import(key, Path(__file__)),
        lambda: check_scene_key(key),
    ):
        with pytest.raises(SceneKeyError, match="is not allowed"):
            use()


@given(st.text(max_size=70))
def test_every_accepted_key_is_a_plain_folder_name(key: str) -> None:
    try:
        accepted = check_scene_key(key)
    except SceneKeyError:
        return
    assert Path(accepted).name == accepted and accepted not in (".", "..") and accepted == accepted.lower()


def test_scenes_are_listed_and_their_origin_is_read_back(store: Store) -> None:
    for key in ("b", "a"):
        store.register(SceneOrigin(scene=key, kind="generated", title=key.upper()))
    assert store.scenes() == ["a", "b"]
    origin = store.origin("a")
    assert origin is not None and origin.title == "A"
    assert store.origin("nobody") is None


def test_a_scene_has_all_products_once_the_pointer_of_the_last_one_is_there(store: Store) -> None:
    for asset, scene in (("world", "a"), ("prompts", "a"), ("world", "b")):
        commit(store, "text", asset, scene)
    begun = store.base / "products/prompts/b/0123"
    begun.mkdir(parents=True)
    (begun / "note.txt").write_text("text")  # its writer was killed here
    assert store.scenes_with_all(("world", "prompts")) == ["a"]
    assert store.knows("a") is False  # neither registered nor described


def test_a_scene_that_was_only_typed_in_the_ui_is_listed_too(store: Store) -> None:
    commit(store, "hello", asset="description", scene="typed")
    assert store.scenes() == ["typed"]


def test_an_imported_file_that_changed_is_refused(tmp_path: Path) -> None:
    store = open_store(str(tmp_path / "store"))
    world = tmp_path / "World.SPZ"
    world.write_bytes(b"splats")
    sha256 = store.keep_import("flat", world)
    origin = SceneOrigin(scene="flat", kind="imported", file_name=world.name, file_sha256=sha256)
    assert store.imported_file(origin).read_bytes() == b"splats"
    store.imported_file(origin).write_bytes(b"others")
    with pytest.raises(ProductError, match="is gone or differs from what was imported"):
        store.imported_file(origin)


def test_a_store_that_cannot_be_made_says_which_setting_to_change(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="set FLYMIRAGE_STORE"):
        open_store(str(tmp_path / "file" / "store"))


def test_a_clock_that_jumps_takes_no_folder_from_a_writer_that_is_at_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = open_store(str(tmp_path))
    left = tmp_path / "staging" / "0123.elsewhere.7-7-gone"
    left.mkdir(parents=True)
    now = time.time()
    with store.scratch() as at_work:
        monkeypatch.setattr(time, "time", lambda: now + 10 * 86_400)
        commit(store, "ten days later")
        assert at_work.exists() and not left.exists()


@pytest.mark.parametrize("instant", ["staged:1", "files committed:1", "pointer committed:1"])
@pytest.mark.parametrize("before", [None, "old"])
def test_a_writer_killed_at_any_instant_leaves_the_old_product_or_the_new_one(
    tmp_path: Path, instant: str, before: str | None
) -> None:
    store = open_store(str(tmp_path))
    if before is not None:
        commit(store, before)
    script = f"from test_store import *; commit(open_store({str(tmp_path)!r}), 'new')"
    env = {**os.environ, "FLYMIRAGE_FAULT": instant, "PYTHONPATH": str(Path(__file__).parent)}
    died = subprocess.run([sys.executable, "-c", script], env=env, check=False)
    assert died.returncode == -signal.SIGKILL
    expected = "new" if instant.startswith("pointer") else before
    if expected is None:
        assert store.current("notes", "flat") is None
    else:
        assert (store.folder("notes", "flat") / "note.txt").read_text() == expected
    commit(store, "new")
    assert (store.folder("notes", "flat") / "deep" / "copy.txt").read_text() == "new"
