"""Settings of the annotators: our embedded one, and the user's own checkout of Boxer."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(gt=0, le=1)]
Count = Annotated[int, Field(ge=1)]


class Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class BoxerSettings(Section):
    """How facebookresearch/boxer is run: a program of its own, CC-BY-NC-4.0, that the user installs."""

    home: str = ""
    """Folder of the checkout; must be given if ``tools.annotator`` is "boxer"."""
    python: str = "python3"
    """Interpreter of Boxer's own environment (Python 3.12 with torch)."""
    checkpoint: str = ""
    """BoxerNet's weights; "" = where scripts/download_ckpts.sh puts them."""
    labels: tuple[str, ...] = ()
    """What to look for; none = Boxer's own list of 1,220 nouns."""
    threshold_2d: Share = 0.25
    """Least score of the 2D detector."""
    threshold_3d: Share = 0.5
    """Least confidence of BoxerNet in one view."""
    min_score: Share = 0.55
    """Detections with less (mean of both scores) do not enter the fusion."""
    timeout: Positive = 7200.0
    """Seconds for one pass over a scene; without a GPU a picture takes tens of seconds."""


class AnnotationSettings(Section):
    """Boxes from posed RGB-D; the distance limit of the second pass is d_th1 of `TargetSettings`."""

    voxel: Positive = 0.03
    """Edge of the voxels in which pixels of all views are averaged."""
    fusion_iou: Share = 0.3
    """Detections of a per-view detector that overlap by this are one object."""
    min_detections: Count = 4
    """An object of a per-view detector must be seen in this many views."""
    detector: Literal["auto", "none", "yolox-nano"] = "auto"
    """The embedded annotator's 2D detector; "auto" takes YOLOX-Nano if `flymirage models fetch yolox-nano` has run."""
    models: Path = Path("~/.cache/flymirage/models")
    """Where fetched weights are."""
    boxer: BoxerSettings = BoxerSettings()
