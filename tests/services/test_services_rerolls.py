"""A scene whose content a service refuses gets another description, a bounded number of times."""

from pathlib import Path

import numpy as np
import pytest
from fake_http import Reply
from marble_files import originals_of
from paper_services import paper_services
from scripted import KEYS
from splat_worlds import box

from flymirage_assets.stage import ProductAsset, upstream_digests
from flymirage_core.errors import ModerationError
from flymirage_core.scene.description import SceneDescription
from flymirage_core.settings import Settings
from resources.records import SceneOrigin
from resources.rerolls import RerolledError, roll_again
from resources.store import Store

REFUSED = Reply(400, {"error": {"message": "Your request was rejected.", "type": "x", "code": "moderation_blocked"}})


def blank(*_: object, **__: object) -> np.ndarray:
    return np.zeros((8, 8, 3), np.uint8)


def make(store: Store, settings: Settings, name: str) -> None:
    """Materialise `description` or `image`, as Dagster would."""
    if name == "description":
        describe = lambda stage: stage.tools.scene_writer.describe(stage.scene)  # noqa: E731
        asset = ProductAsset(name, describe, blank, "1", (), ("scene_writer",), settings)
        inputs, upstream = {}, ()
    else:
        paint = lambda stage, description: stage.tools.image_painter.paint(description)  # noqa: E731
        asset = ProductAsset(name, paint, blank, "1", (), ("image_painter",), settings)
        inputs = {"description": SceneDescription.load(store.folder("description", "s1"))}
        upstream = ("description",)
    commit = asset.materialise(store, "s1", inputs, upstream_digests(store, "s1", upstream), lambda _: None)
    if commit.staged is not None:
        store.publish(commit.staged, commit.record, commit.preview)


def test_a_refused_picture_changes_the_description_and_then_succeeds(tmp_path: Path) -> None:
    with paper_services(originals_of(box([-2, -2, 0], [2, 2, 2.6], step=0.4)), KEYS) as services:
        url = services.openai.base_url
        settings = Settings(profile="paper", services={"writer": {"base_url": url}, "painter": {"base_url": url}})
        store = Store(str(tmp_path))
        store.register(SceneOrigin(scene="s1", kind="generated"))
        services.openai.fail("images", REFUSED)
        make(store, settings, "description")
        first = store.current("description", "s1")
        with pytest.raises(RerolledError, match=r"another description with a new seed \(1 of 3\)"):
            make(store, settings, "image")
        make(store, settings, "description")
        make(store, settings, "image")
        second = SceneDescription.load(store.folder("description", "s1"))
        assert first is not None and store.current("description", "s1") != first
        assert "design 2 after 1 refused" in second.provenance.writer
        assert services.openai.charged_images == 1


def test_it_ends_after_so_many(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    for _ in range(2):
        assert isinstance(roll_again(store, "s1", ModerationError("no"), 2), RerolledError)
    last = roll_again(store, "s1", ModerationError("no"), 2)
    assert not isinstance(last, RerolledError) and "description 3 of scene 's1'" in str(last)


def test_an_imported_world_is_never_described_anew(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    store.register(SceneOrigin(scene="flat", kind="imported", file_name="flat.spz", file_sha256="0"))
    assert str(roll_again(store, "flat", ModerationError("no"), 3)) == "no"
