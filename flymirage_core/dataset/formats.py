"""The formats that a data set can be exported in, by name."""

from collections.abc import Callable

from flymirage_core.dataset.export_folder import ExportFormat
from flymirage_core.dataset.lerobot import DepthExport, LeRobotFormat


def lerobot(depth: DepthExport) -> ExportFormat:
    """The data set as a LeRobot v3.0 folder: video, depth, state, action, instructions."""
    return LeRobotFormat(depth)


FORMATS: dict[str, Callable[[DepthExport], ExportFormat]] = {"lerobot": lerobot}
