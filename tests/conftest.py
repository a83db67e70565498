"""What all rooms' tests share: where the captured worlds lie, if they do."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("patient", deadline=None)  # machines are slow at times: no test goes by the clock
settings.load_profile("patient")


@pytest.fixture(scope="session")
def captured_worlds() -> Path:
    """The folder of real captured rooms; they carry no licence to be copied, so they lie beside the project."""
    folder = Path(os.environ.get("FLYMIRAGE_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
    if not (folder / "bedroom_sw_lod2.spz").exists():
        pytest.skip(f"no captured worlds in {folder}: set FLYMIRAGE_TEST_DATA")
    return folder
