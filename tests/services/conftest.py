"""An account of one scene in an empty store, with services that answer at once and keys in the environment."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fake_gemini import FakeGemini
from fake_openai import FakeOpenAI
from scripted import KEYS, Script

from flymirage_core.service_settings import ServicesSettings
from resources.services.account import Account
from resources.store import Store


@pytest.fixture(autouse=True)
def keys(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in KEYS.items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def script() -> Script:
    return Script()


@pytest.fixture
def openai(script: Script) -> Iterator[FakeOpenAI]:
    with FakeOpenAI(script, KEYS["OPENAI_API_KEY"]) as fake:
        yield fake


@pytest.fixture
def dashscope(script: Script) -> Iterator[FakeOpenAI]:
    with FakeOpenAI(script, KEYS["DASHSCOPE_API_KEY"], "dashscope") as fake:
        yield fake


@pytest.fixture
def gemini(script: Script) -> Iterator[FakeGemini]:
    with FakeGemini(script, KEYS["GEMINI_API_KEY"]) as fake:
        yield fake


@pytest.fixture
def account_of(tmp_path: Path) -> Callable[..., Account]:
    """account_of(asset="description", reroll=0, **services settings)."""

    def build(asset: str = "description", reroll: int = 0, scene: str = "s1", **settings: Any) -> Account:
        return Account(Store(str(tmp_path / "store")), scene, asset, ServicesSettings(**settings), reroll)

    return build
