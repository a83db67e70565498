"""Small file operations that every product's `save` shares."""

import os
import shutil
from pathlib import Path


def link_tree(source: Path, target: Path) -> None:
    """Make ``target`` hold the files of ``source``, by hard link where the file system can, else by copy."""
    shutil.copytree(source, target, copy_function=link_or_copy, dirs_exist_ok=True)


def link_or_copy(source: str | Path, target: str | Path) -> None:
    """Make ``target`` the file ``source``, by hard link where the file system can, else by copy."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copy2(source, target)
