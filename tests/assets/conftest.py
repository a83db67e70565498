"""Projects to run, as a user would run them, each command in a process of its own."""

from pathlib import Path

import pytest
from projects import Project


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
