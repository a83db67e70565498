"""What every product can do. The classes themselves live in the rooms that make them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol, runtime_checkable


@runtime_checkable
class Product(Protocol):
    """A typed value that is kept on disk.

    `save` writes whole files into an empty folder, ``load`` (a static method of the class) reads them back, `summary`
    gives the numbers a person wants to see beside it.
    """

    def save(self, folder: Path) -> None: ...

    def summary(self) -> Mapping[str, str | int | float]: ...
