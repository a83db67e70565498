"""What the pipeline asks of an image model and of a world model, whoever answers."""

from typing import Protocol

from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import SceneDescription
from flymirage_core.splats.world import World


class ImagePainter(Protocol):
    """Paints one picture of a described scene."""

    @property
    def name(self) -> str: ...

    def paint(self, description: SceneDescription) -> ScenePicture: ...


class WorldModel(Protocol):
    """Builds a metric, z-up Gaussian world from a description and its picture (paper section III-A)."""

    @property
    def name(self) -> str: ...

    def build(self, description: SceneDescription, picture: ScenePicture) -> World: ...
