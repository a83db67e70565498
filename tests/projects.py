"""A folder in which someone uses FlyMirage from the command line, with settings that make a whole scene in seconds."""

import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

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
    """``program`` is the module of the command line: the real one, or `stand_in`, whose stages only hash."""

    folder: Path
    environment: Mapping[str, str] = field(default_factory=lambda: SMALL)
    program: str = "flymirage_assets.cli"

    @property
    def store(self) -> Store:
        return Store(str(self.folder / ".flymirage" / "store"))

    def flymirage(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        """Type a command; the outcome with all it printed."""
        env = {k: v for k, v in os.environ.items() if k != "DAGSTER_HOME" and not k.startswith("FLYMIRAGE_")}
        tests = Path(__file__).parent
        env |= {"PYTHONPATH": os.pathsep.join([str(tests), str(tests.parent)]), "COLUMNS": "200"}
        return subprocess.run(
            [sys.executable, "-m", self.program, *arguments],
            cwd=self.folder,
            env={**env, **self.environment, **environment},
            capture_output=True,
            text=True,
            timeout=280,
            check=False,
        )

    def digests(self, scene: str) -> dict[str, str]:
        """Content hash of every product of a scene."""
        records = {asset: self.store.current(asset, scene) for asset in self.store.assets()}
        return {asset: record.digest for asset, record in records.items() if record is not None}
