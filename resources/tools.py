"""Who does what: one tool for each port of the core, chosen by the settings' profile. Offline twins are the default."""

from dataclasses import dataclass

from flymirage_core.annotation.annotator import Annotator
from flymirage_core.language.judge import FrameJudge, MeasuredJudge
from flymirage_core.language.prompter import OfflinePrompter, Prompter
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.gsplat_backend import GsplatRasterizer, why_unusable
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.scene.writer import OfflineSceneWriter, SceneWriter
from flymirage_core.settings import Settings
from flymirage_core.worldgen.model import OfflinePainter, OfflineWorldModel
from flymirage_core.worldgen.ports import ImagePainter, WorldModel
from resources.annotators import choose_annotator


@dataclass(frozen=True)
class Tools:
    """One tool for each port."""

    scene_writer: SceneWriter
    image_painter: ImagePainter
    world_model: WorldModel
    rasterizer: Rasterizer
    annotator: Annotator
    frame_judge: FrameJudge
    prompter: Prompter


def choose_tools(settings: Settings) -> Tools:
    """The tools of ``settings.profile``; ``offline`` needs no network, no key and no GPU, but uses a GPU if it can."""
    rasterizer = choose_rasterizer(settings)
    return Tools(
        scene_writer=OfflineSceneWriter(),
        image_painter=OfflinePainter(rasterizer, settings.generation),
        world_model=OfflineWorldModel(settings.generation),
        rasterizer=rasterizer,
        annotator=choose_annotator(settings),
        frame_judge=MeasuredJudge(settings.verdict, settings.planner),
        prompter=OfflinePrompter(),
    )


def choose_rasterizer(settings: Settings) -> Rasterizer:
    """The back end that ``settings.renderer`` names; raises `InputError` if it is gsplat's and that cannot be used."""
    wants_gsplat = settings.renderer == "gsplat" or (settings.renderer == "auto" and not why_unusable())
    return GsplatRasterizer() if wants_gsplat else CpuRasterizer(settings.threads)
