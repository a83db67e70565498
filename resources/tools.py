"""Who does what: one tool for each port of the core, chosen by the settings' profile. Offline twins are the default."""

from dataclasses import dataclass

from flymirage_core.annotation.annotator import Annotator
from flymirage_core.language.judge import FrameJudge, MeasuredJudge
from flymirage_core.language.prompter import OfflinePrompter, Prompter
from flymirage_core.language.vlm_judge import VlmJudge
from flymirage_core.language.vlm_prompter import VlmPrompter
from flymirage_core.rendering.cpu import CpuRasterizer
from flymirage_core.rendering.gsplat_backend import GsplatRasterizer, why_unusable
from flymirage_core.rendering.rasterizer import Rasterizer
from flymirage_core.scene.llm_writer import ModelSceneWriter
from flymirage_core.scene.taxonomy import taxonomy_named
from flymirage_core.scene.writer import OfflineSceneWriter, SceneWriter
from flymirage_core.settings import Settings
from flymirage_core.worldgen.model import OfflinePainter, OfflineWorldModel
from flymirage_core.worldgen.ports import ImagePainter, WorldModel
from resources.annotators import choose_annotator
from resources.services.account import Account
from resources.services.language_models import ServiceModel
from resources.services.marble import MarbleWorldModel
from resources.services.painter import ServicePainter
from resources.store import Store

SERVICE_PORTS = ("scene_writer", "image_painter", "world_model", "frame_judge", "prompter")
"""Ports that an outside service may fill."""


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


def choose_tools(settings: Settings, account: Account | None = None) -> Tools:
    """The tools of ``settings.profile``; ``offline`` needs no network, no key and no GPU, but uses a GPU if it can.

    Services book what they cost on ``account``; without one, tools are there to be asked for their names.
    """
    account = account or Account(Store(settings.store), "_names", "_names", settings.services)
    rasterizer = choose_rasterizer(settings)
    return Tools(
        scene_writer=_scene_writer(settings, account),
        image_painter=_image_painter(settings, account, rasterizer),
        world_model=_world_model(settings, account),
        rasterizer=rasterizer,
        annotator=choose_annotator(settings),
        frame_judge=_frame_judge(settings, account),
        prompter=_prompter(settings, account),
    )


def is_service(settings: Settings, port: str) -> bool:
    """Whether an outside service fills a port: as `ToolSettings` says, else as the profile does."""
    chosen = getattr(settings.tools, port, "") or ("service" if settings.profile == "paper" else "offline")
    return bool(chosen == "service") and port in SERVICE_PORTS


def _scene_writer(settings: Settings, account: Account) -> SceneWriter:
    if not is_service(settings, "scene_writer"):
        return OfflineSceneWriter(taxonomy_named(settings.taxonomy))
    model = ServiceModel("writer", settings.services.writer, account)
    return ModelSceneWriter(model, settings.services.rerolls, account.reroll, taxonomy_named(settings.taxonomy))


def _image_painter(settings: Settings, account: Account, rasterizer: Rasterizer) -> ImagePainter:
    if not is_service(settings, "image_painter"):
        return OfflinePainter(rasterizer, settings.generation)
    return ServicePainter(settings.services.painter, account)


def _world_model(settings: Settings, account: Account) -> WorldModel:
    if not is_service(settings, "world_model"):
        return OfflineWorldModel(settings.generation)
    return MarbleWorldModel(settings.services.marble, settings.cleaning, account)


def _frame_judge(settings: Settings, account: Account) -> FrameJudge:
    measured = MeasuredJudge(settings.verdict, settings.planner)
    if not is_service(settings, "frame_judge"):
        return measured
    vlm = settings.services.vlm
    return VlmJudge(measured, ServiceModel("vlm", vlm, account), settings.verdict.frame_step, vlm.pace.at_once)


def _prompter(settings: Settings, account: Account) -> Prompter:
    if not is_service(settings, "prompter"):
        return OfflinePrompter()
    vlm = settings.services.vlm
    return VlmPrompter(ServiceModel("vlm", vlm, account), settings.verdict.frame_step, vlm.pace.at_once)


def choose_rasterizer(settings: Settings) -> Rasterizer:
    """The back end that ``settings.renderer`` names; raises `InputError` if it is gsplat's and that cannot be used."""
    wants_gsplat = settings.renderer == "gsplat" or (settings.renderer == "auto" and not why_unusable())
    return GsplatRasterizer() if wants_gsplat else CpuRasterizer(settings.threads)
