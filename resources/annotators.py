"""Which annotator the settings choose: the embedded one, with the 2D detector that is there, or Boxer."""

from flymirage_core.annotation.annotator import Annotator
from flymirage_core.annotation.embedded import EmbeddedAnnotator
from flymirage_core.annotation.settings import AnnotationSettings
from flymirage_core.annotation.yolox import YoloxDetector
from flymirage_core.errors import InputError
from flymirage_core.settings import Settings
from resources.boxer import BoxerAnnotator
from resources.models import YOLOX_NANO, path_of


def choose_annotator(settings: Settings) -> Annotator:
    """Raises `InputError` if what the settings ask for is not there."""
    if settings.tools.annotator == "boxer":
        return BoxerAnnotator(settings.annotation)
    return EmbeddedAnnotator(settings.annotation, choose_detector(settings.annotation))


def choose_detector(settings: AnnotationSettings) -> YoloxDetector | None:
    """The 2D detector, or None: "auto" takes it if its weights have been fetched."""
    weights = path_of(YOLOX_NANO, settings)
    if settings.detector == "none" or (settings.detector == "auto" and not weights.exists()):
        return None
    if not weights.exists():
        raise InputError(
            f"setting annotation.detector is {settings.detector!r}, but {weights} is missing; run `flymirage models "
            f"fetch {settings.detector}`, or set it to auto or none"
        )
    return YoloxDetector(weights)
