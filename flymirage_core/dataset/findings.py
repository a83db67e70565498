"""`Finding`: one thing that is wrong with an export, and where; and how a check that meets a torn file goes on."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import av
import pyarrow as pa

from flymirage_core.errors import FlyMirageError

QUATERNION_TOLERANCE = 1e-4
"""By which a float32 quaternion's norm may differ from 1."""
READING_ERRORS = (
    FlyMirageError,
    OSError,
    ValueError,
    KeyError,
    TypeError,
    IndexError,
    pa.ArrowException,
    av.FFmpegError,
)
"""What reading a damaged file can raise."""


@dataclass(frozen=True)
class Finding:
    """``file`` within the export, ``row`` in words ("row 3, episode 1, frame 4"; "" if it is the whole file)."""

    check: str
    file: str
    row: str
    message: str

    @property
    def sentence(self) -> str:
        return " ".join(part for part in (f"{self.file}:", self.row and f"{self.row}:", self.message) if part)


def guarded(name: str, folder: Path, check: Callable[[Path], Iterator[Finding]]) -> Iterator[Finding]:
    """The findings of a check; if it cannot read on, that is a finding too, and other checks still run."""
    try:
        yield from check(folder)
    except READING_ERRORS as error:
        yield Finding(name, _named_file(folder, error), "", f"cannot be read: {type(error).__name__}: {error}")


def _named_file(folder: Path, error: BaseException) -> str:
    """The export's file that an error speaks of, as far as it says."""
    name = getattr(error, "filename", None)
    return str(Path(name).relative_to(folder)) if name and Path(name).is_relative_to(folder) else str(folder.name)
