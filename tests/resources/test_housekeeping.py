"""Housekeeping: old versions go, current ones stay, and the way back is known while its files are there."""

import pytest
from test_store import Note, commit, store  # noqa: F401 - the fixture

from flymirage_core.errors import InputError
from resources import records
from resources.housekeeping import collect_garbage, remove_scene
from resources.records import SceneOrigin, parse_origin
from resources.store import Store


def test_garbage_is_what_is_old_and_not_current(store: Store) -> None:  # noqa: F811
    commit(store, "one")
    commit(store, "two")
    assert collect_garbage(store, 3600, removing=True).folders == 0
    assert collect_garbage(store, -60, removing=False).folders >= 1
    assert collect_garbage(store, -60, removing=True).bytes > 0
    assert collect_garbage(store, -60, removing=True).folders == 0
    assert (store.folder("notes", "flat") / "note.txt").read_text() == "two"


def test_an_earlier_product_is_remembered_until_it_is_collected(store: Store) -> None:  # noqa: F811
    first = commit(store, "one")
    later = commit(store, "two").model_copy(update={"input_hash": "other"})
    store.publish(store.stage(Note("two")), later)
    store.publish(store.stage(Note("one")), first)
    store.reinstate(later)
    remembered = store.remembered("notes", "flat", "in")
    assert remembered is not None and remembered.digest == first.digest
    collect_garbage(store, -60, removing=True)
    assert store.remembered("notes", "flat", "in") is None


def test_a_removed_scene_is_unknown_and_others_stay(store: Store) -> None:  # noqa: F811
    for scene in ("flat", "house"):
        store.register(SceneOrigin(scene=scene, kind="generated"))
        commit(store, scene, scene=scene)
    remove_scene(store, "flat")
    assert store.scenes() == ["house"] and store.current("notes", "flat") is None
    assert store.is_whole(commit(store, "house", scene="house"))
    with pytest.raises(InputError, match="'flat' is not known"):
        remove_scene(store, "flat")


def test_a_scene_can_be_claimed_once(store: Store) -> None:  # noqa: F811
    assert store.claim(SceneOrigin(scene="flat", kind="generated", title="first"))
    assert not store.claim(SceneOrigin(scene="flat", kind="generated", title="second"))
    origin = store.origin("flat")
    assert origin is not None and origin.title == "first"


def test_documents_of_an_older_schema_are_upgraded_when_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(records, "SCHEMA_VERSION", 3)
    monkeypatch.setitem(records.UPGRADES, 1, lambda old: {**old, "title": old["name"]})
    monkeypatch.setitem(records.UPGRADES, 2, lambda old: {**old, "title": old["title"].upper()})
    text = '{"schema_version": 1, "scene": "flat", "kind": "generated", "name": "a flat"}'
    origin = parse_origin(text, "flat.json")
    assert origin.title == "A FLAT" and origin.schema_version == 3
