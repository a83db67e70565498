"""The formats that a data set can be exported in, by name."""

from collections.abc import Callable

from flymirage_core.dataset.export_folder import ExportFormat
from flymirage_core.dataset.flymirage_release import ReleaseFormat
from flymirage_core.dataset.lerobot import DepthExport, LeRobotFormat
from flymirage_core.dataset.rlds import RldsFormat
from flymirage_core.dataset.transforms import TransformsFormat
from flymirage_core.dataset.vlnce import VlnceFormat

FORMATS: dict[str, Callable[[DepthExport], ExportFormat]] = {
    "lerobot": LeRobotFormat,
    "flymirage": lambda _: ReleaseFormat(),
    "vlnce": lambda _: VlnceFormat(),
    "rlds": lambda _: RldsFormat(),
    "transforms": lambda _: TransformsFormat(),
}
"""Makes a format; how depth is kept is a choice in LeRobot alone."""
DESCRIPTIONS = {
    "lerobot": "LeRobot v3.0: video, depth, state, action, instructions.",
    "flymirage": "The official release's folders: a folder a flight, CSV and JPEG, lossless depth beside the JPEG.",
    "vlnce": "VLN-CE episodes for evaluation: an episode an instruction.",
    "rlds": "RLDS: TFRecord files that tensorflow_datasets loads, written without TensorFlow.",
    "transforms": "A transforms.json a scene, with pictures and depth, for those who train splats.",
}
