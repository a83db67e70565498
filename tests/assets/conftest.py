"""A small project to run: the whole pipeline in seconds, as a user would run it, in a process of its own."""

import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from resources.store import Store

SMALL: Mapping[str, str] = {
    "FLYMIRAGE_GENERATION__GAUSSIANS": "80000",
    "FLYMIRAGE_VIEWS__WIDTH": "160",
    "FLYMIRAGE_VIEWS__HEIGHT": "120",
    "FLYMIRAGE_VIEWS__ORBIT_YAWS": "8",
    "FLYMIRAGE_EXPLORATION__RIG_SPACING": "1.2",
    "FLYMIRAGE_TASKS__SETS": "1",
    "FLYMIRAGE_TASKS__TARGETS_PER_SET": "3",
    "FLYMIRAGE_FRAMES__WIDTH": "96",
    "FLYMIRAGE_FRAMES__HEIGHT": "72",
    "FLYMIRAGE_FRAMES__RATE": "5",
}


@dataclass(frozen=True)
class Project:
    """A folder in which someone uses FlyMirage with small settings."""

    folder: Path

    @property
    def store(self) -> Store:
        return Store(str(self.folder / ".flymirage" / "store"))

    def flymirage(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        """Type a command; the outcome with all it printed."""
        env = {k: v for k, v in os.environ.items() if k != "DAGSTER_HOME" and not k.startswith("FLYMIRAGE_")}
        return subprocess.run(
            [sys.executable, "-m", "flymirage_assets.cli", *arguments],
            cwd=self.folder,
            env={**env, **SMALL, "COLUMNS": "200", **environment},
            capture_output=True,
            text=True,
            timeout=280,
            check=False,
        )

    def digests(self, scene: str) -> dict[str, str]:
        """Content hash of every product of a scene."""
        folder = self.folder / ".flymirage" / "store" / "products"
        records = {p.name: self.store.current(p.name, scene) for p in sorted(folder.iterdir())}
        return {name: record.digest for name, record in records.items() if record is not None}


@pytest.fixture(scope="session")
def grown(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A project with one scene, grown without disturbance."""
    project = Project(tmp_path_factory.mktemp("grown"))
    outcome = project.flymirage("grow", "--scenes", "1")
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    return project


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """An empty project."""
    return Project(tmp_path)
