"""Keys and signatures appear nowhere, after every kind of failure: errors, files, the ledger, journals, logs."""

import logging
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from designs import design
from fake_gemini import FakeGemini
from fake_http import Reply
from fake_marble import FakeMarble
from fake_openai import FakeOpenAI
from marble_files import originals_of
from scripted import CANARY, FAST, KEYS, Script
from splat_worlds import box

from flymirage_core.asking import Question
from flymirage_core.errors import FlyMirageError
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import Provenance, SceneDescription
from flymirage_core.scene.design import SceneDesign
from flymirage_core.settings import CleaningSettings, Settings
from resources.services.language_models import ServiceModel
from resources.services.marble import MarbleWorldModel
from resources.services.painter import ServicePainter

SIGNATURE = "c0ffee"
DESCRIPTION = SceneDescription(
    **design(), scene="s1", category="c", subcategory="s", provenance=Provenance(kind="generated", writer="test")
)
ECHOES = (
    Reply(401, {"detail": f"Invalid key {KEYS['WORLDLABS_API_KEY']}", "error": {"message": KEYS["OPENAI_API_KEY"]}}),
    Reply(400, {"detail": f"bad: {KEYS['WORLDLABS_API_KEY']}", "error": {"message": f"x {KEYS['OPENAI_API_KEY']}"}}),
    Reply(500, {"detail": KEYS["WORLDLABS_API_KEY"], "error": {"message": KEYS["OPENAI_API_KEY"]}}),
    Reply(
        429, {"detail": KEYS["WORLDLABS_API_KEY"], "error": {"message": KEYS["OPENAI_API_KEY"]}}, {"retry-after": "9"}
    ),
    Reply(402, {"detail": KEYS["WORLDLABS_API_KEY"], "error": {"message": KEYS["OPENAI_API_KEY"]}}),
    Reply(404, {"detail": f"https://x.example/a?sig={SIGNATURE}", "error": {"message": KEYS["OPENAI_API_KEY"]}}),
    Reply(200, f"<html>{KEYS['OPENAI_API_KEY']}{KEYS['WORLDLABS_API_KEY']}</html>".encode()),
    Reply(drop=True),
)


@pytest.fixture
def marble() -> Iterator[FakeMarble]:
    with FakeMarble(originals_of(box([-2, -2, 0], [2, 2, 2.6], step=0.4)), KEYS["WORLDLABS_API_KEY"]) as fake:
        yield fake


@pytest.fixture
def said(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> Iterator[Callable[[Callable[[], Any]], None]]:
    """Collects what failures say, and at the end looks through everything that was written."""
    texts: list[str] = []
    caplog.set_level(logging.DEBUG)

    def run(call: Callable[[], Any]) -> None:
        try:
            call()
        except FlyMirageError as error:
            texts.append("".join(traceback.format_exception(error)))

    yield run
    written = [path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()]
    everything = b"\n".join([*(t.encode() for t in texts), caplog.text.encode(), *written])
    for secret in (CANARY, SIGNATURE):
        assert secret.encode() not in everything


@pytest.mark.parametrize("echo", ECHOES, ids=lambda r: f"{r.status}{' dropped' if r.drop else ''}")
def test_a_service_that_repeats_the_key_is_not_repeated(
    said, echo: Reply, openai: FakeOpenAI, gemini: FakeGemini, script: Script, account_of
) -> None:
    for fake in (openai, gemini):
        fake.fail(".", echo, times=20)
    pace = {"pace": {**FAST, "tries": 2}}
    writers = ({"base_url": openai.base_url, **pace}, {"vendor": "gemini", "base_url": gemini.url, **pace})
    for writer in writers:
        account = account_of(writer=writer, painter={"base_url": openai.base_url, **pace})
        model = ServiceModel("writer", account.settings.writer, account)
        said(lambda model=model: model.answer(Question("scene_design", "s", "u"), SceneDesign))
        said(lambda account=account: ServicePainter(account.settings.painter, account).paint(DESCRIPTION))


@pytest.mark.parametrize("where", ["credits", "prepare_upload", "worlds:generate", "operations", "/worlds/", "/cdn/"])
@pytest.mark.parametrize("echo", [ECHOES[i] for i in (0, 2, 5, 7)], ids=lambda r: f"{r.status}")
def test_wherever_marble_fails_keys_and_signatures_stay_secret(said, where, echo, marble, account_of) -> None:
    settings = {"base_url": marble.url, "pace": {**FAST, "tries": 2}, "poll_seconds": 0.01, "poll_budget": 0.2}
    settings |= {"lost_start_wait": 0.01, "download_tries": 2}
    account = account_of("world", marble=settings)
    marble.fail(where, echo, times=50)
    model = MarbleWorldModel(account.settings.marble, CleaningSettings(), account)
    said(lambda: model.build(DESCRIPTION, ScenePicture(np.zeros((16, 24, 3), np.uint8), "test")))
    assert marble.violations == []


def test_a_world_that_arrived_leaves_no_address_behind(said, marble, account_of, monkeypatch) -> None:
    account = account_of("world", marble={"base_url": marble.url, "pace": FAST, "poll_seconds": 0.01})
    model = MarbleWorldModel(account.settings.marble, CleaningSettings(), account)
    model.build(DESCRIPTION, ScenePicture(np.zeros((16, 24, 3), np.uint8), "test"))
    (key,) = marble.charged
    journal = account.store.read_service_file(f"s1/marble/{key}.json")
    assert journal is not None and b"http" not in journal
    monkeypatch.delenv("WORLDLABS_API_KEY")
    said(model.api.credits)


def test_settings_hold_the_names_of_keys_and_never_keys() -> None:
    dumped = Settings(profile="paper").model_dump_json()
    assert "OPENAI_API_KEY" in dumped and CANARY not in dumped
