"""One settings object for everything, validated at start. Defaults are the paper's, with symbol and section.

Every field can be set by an environment variable (``FLYMIRAGE_TASKS__SETS=20``) or in ``flymirage.toml`` beside the
working directory. Lengths in metres, angles in radians except fields ending in ``_deg``. A stage's section is part of
its code version: changing it makes exactly that stage, and what follows from it, stale.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_settings import BaseSettings, PydanticBaseSettingsSource, SettingsConfigDict, TomlConfigSettingsSource

from flymirage_core.annotation.settings import AnnotationSettings as AnnotationSettings
from flymirage_core.language.settings import VerdictSettings as VerdictSettings
from flymirage_core.operation_settings import Executor, GrowthSettings, OperationSettings
from flymirage_core.service_settings import ServicesSettings

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Count = Annotated[int, Field(ge=1)]


class Section(BaseModel):
    """A stage's part of the settings: frozen, and unknown names are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class GenerationSettings(Section):
    """The embedded world model."""

    gaussians: Count = 600_000
    """About how many Gaussians a generated world has."""
    fitting_views: NotNegative = 1.0
    """For each thousand Gaussians, small traced pictures that they are fitted to; 0: none."""

    @property
    def views(self) -> int:
        """Pictures that a world is fitted to."""
        return round(self.fitting_views * self.gaussians / 1000)


class CleaningSettings(Section):
    """What is taken out of a world before use."""

    min_opacity: Positive = 1 / 255
    max_scale: Positive = 3.0
    """Gaussians with a larger standard deviation are haze or sky painted near."""
    max_distance: Positive = 60.0
    """From c; captured rooms have outliers hundreds of metres away."""


class OccupancySettings(Section):
    """Voxels from splats; names and defaults follow the field's voxelisers."""

    resolution: Positive = 0.1
    opacity_threshold: Positive = 0.1
    min_component_voxels: Count = 8
    """Smaller islands of occupied voxels are floaters."""


class ViewSettings(Section):
    """The pictures that annotation sees, and the paper's inward orbit (section III-B)."""

    width: Count = 320
    height: Count = 240
    horizontal_fov_deg: Positive = 90.0
    orbit_radius: Positive = 0.1
    """r_orb"""
    orbit_elevations_deg: tuple[float, ...] = (-35.0, -10.0, 15.0)
    """theta: the elevations of the viewing sphere that are swept."""
    orbit_yaws: Count = 12
    """psi: steps of the complete yaw sweep at each elevation."""


class TargetSettings(Section):
    """Algorithm 1, distance-aware target selection (section III-B)."""

    max_targets: Count = 5
    """N_t"""
    min_azimuth_deg: Positive = 35.0
    """theta_th"""
    near_distance: Positive = 3.0
    """d_th1: boxes are trusted within it; also d_prune."""
    far_distance: Positive = 4.0
    """d_th2: boxes beyond it need a closer look."""

    @model_validator(mode="after")
    def _ordered(self) -> "TargetSettings":
        if self.near_distance >= self.far_distance:
            raise ValueError("near_distance (d_th1) must be less than far_distance (d_th2)")
        return self


class ExplorationSettings(Section):
    """Camera paths to the targets, with a four-view rig (section III-B)."""

    clearance: Positive = 0.25
    """Obstacles are inflated by this for the A* search."""
    rig_spacing: Positive = 0.5
    """Distance along the path between two rigs."""
    stand_off: Positive = 1.0
    """The path ends this far before the target's box at the latest."""


class TaskSettings(Section):
    """Task sets (section III-C)."""

    sets: Count = 20
    """N_s; with N_o = 5, about 100 flights a scene, as the paper has."""
    targets_per_set: Count = 5
    """N_o"""
    min_distance: Positive = 2.0
    max_distance: Positive = 10.0
    """Of the way round obstacles; ``min_distance`` is asked of the straight line too."""
    sight_radius: Positive = 0.1
    """Radius of the cylinder round the ray of the visibility check."""
    safety_radius: Positive = 0.35
    """No occupied point may lie this close to a target point."""
    stand_off: Positive = 0.8
    """Least distance of the target point from the object's box, towards where the drone comes from."""
    stand_off_per_size: Positive = 0.8
    """Wanted distance for each metre of the object's longest side: the camera then sees all of it."""
    passage_radius: Positive = 0.3
    """Starts and target points are joined by ways that are free for a ball of this radius: the planner's inflation."""


class PlannerSettings(Section):
    """EGO-Planner and the limits of its flights (norms, not per axis)."""

    mode: Literal["one_shot", "receding"] = "one_shot"
    """Plan each flight at once with the whole map, or on the way with what has been seen of it so far."""
    sensing_range: Positive = 5.0
    """receding: what lies within it has been seen."""
    horizon: Positive = 7.5
    """receding: length of the way that is planned ahead."""
    replan_period: Positive = 1.0
    """receding: seconds between two plans if nothing new gets in the way."""
    max_speed: Positive = 1.5
    max_acceleration: Positive = 2.0
    max_jerk: Positive = 8.0
    max_yaw_rate: Positive = 0.8
    max_yaw_acceleration: Positive = 1.5
    inflation: Positive = 0.3
    min_inflation: Positive = 0.2
    """The last attempt before a task is rejected uses this; the flight's row says so."""
    state_rate: Positive = 30.0
    """Hz at which flight states are recorded."""


class QuadrotorSettings(Section):
    """The drone that every flight is checked for; defaults are those of a small research quadrotor.

    Mass, inertia and arm are those published for the AscTec Hummingbird; drag is of the size that Faessler et al. (RA-L
    2018) identified; thrust and lag are on the weak side, so that other drones can fly what this one can.
    """

    mass: Positive = 0.5
    """kg"""
    inertia: tuple[Positive, Positive, Positive] = (3.65e-3, 3.68e-3, 7.03e-3)
    """kg m^2 about the body's x, y, z."""
    arm: Positive = 0.17
    """From the centre of mass to each rotor; they stand in an X."""
    torque_per_thrust: Positive = 0.0244
    """Metres: drag torque of a rotor about its axis for each newton of its thrust."""
    drag: tuple[NotNegative, NotNegative, NotNegative] = (0.5, 0.4, 0.1)
    """1/s: linear drag per mass along the body's x, y, z."""
    thrust_to_weight: Annotated[float, Field(gt=1)] = 2.0
    """Most thrust of all rotors together, as a multiple of the weight."""
    idle_share: NotNegative = 0.05
    """Least thrust of a rotor, as a share of its most: rotors do not stop in flight."""
    rotor_lag: Positive = 0.03
    """Seconds: time constant of a rotor's thrust."""
    max_position_rms: Positive = 0.05
    """A flight that the simulated drone strays from by more than this is rejected ..."""
    max_attitude_rms_deg: Positive = 3.0
    """... and so is one whose attitude it misses by more than this."""

    @property
    def rotor_limits(self) -> tuple[float, float]:
        """Least and most thrust of one rotor, newtons."""
        most = self.thrust_to_weight * self.mass * 9.81 / 4
        return self.idle_share * most, most


class FrameSettings(Section):
    """The drone's camera and its video."""

    width: Count = 640
    height: Count = 480
    horizontal_fov_deg: Annotated[float, Field(gt=0, lt=180)] = 80.0
    """An FPV lens sees 110 to 130; the camera stays a pinhole without distortion."""
    rate: Positive = 10.0
    """Hz; must divide the planner's state_rate. 30 is video as people know it, at three times the size."""
    instances: bool = False
    """Write a third, lossless file for each flight: which object each pixel shows."""
    surround: bool = False
    """Film to the left, the back and the right too, with cameras like the first: the paper's four-view rig."""
    pitch_deg: float = 0.0
    """Downward tilt of the camera on the body."""

    @model_validator(mode="after")
    def _even(self) -> "FrameSettings":
        if self.width % 2 or self.height % 2:
            raise ValueError(f"frames are {self.width} x {self.height} pixels: H.264 needs an even width and height")
        return self


class ToolSettings(Section):
    """Who fills each port; "" leaves it to the profile."""

    scene_writer: Literal["", "offline", "service"] = ""
    image_painter: Literal["", "offline", "service"] = ""
    world_model: Literal["", "offline", "service"] = ""
    frame_judge: Literal["", "offline", "service"] = ""
    prompter: Literal["", "offline", "service"] = ""
    annotator: Literal["embedded", "boxer"] = "embedded"
    """"boxer" is a checkout of the user's own, for non-commercial use only; see ``annotation.boxer``."""


class Settings(BaseSettings):
    """All settings of a FlyMirage project."""

    model_config = SettingsConfigDict(
        env_prefix="FLYMIRAGE_", env_nested_delimiter="__", toml_file="flymirage.toml", frozen=True, extra="forbid"
    )

    profile: Literal["offline", "paper"] = "offline"
    """"offline" asks nobody; "paper" asks the paper's services: LLM, image model, Marble, VLM."""
    tools: ToolSettings = ToolSettings()
    store: str = ".flymirage/store"
    """A local path or any fsspec URL."""
    renderer: Literal["auto", "cpu", "gsplat"] = "auto"
    """Who renders: "gsplat" needs a CUDA card and the ``[gpu]`` extra; "auto" takes it where both are there."""
    threads: int = Field(default=0, ge=0)
    """Rendering threads of the CPU renderer; 0 = all cores."""
    taxonomy: str = "paper"
    """Kinds of places: "paper" (its six categories), "site" (the project page's newer six), or a JSON file of yours."""
    executor: Executor = "in_process"
    """Who runs the stages of a run: this process, a process each, or the workers of a Celery or Ray cluster."""
    growth: GrowthSettings = GrowthSettings()
    operation: OperationSettings = OperationSettings()

    generation: GenerationSettings = GenerationSettings()
    cleaning: CleaningSettings = CleaningSettings()
    occupancy: OccupancySettings = OccupancySettings()
    views: ViewSettings = ViewSettings()
    targets: TargetSettings = TargetSettings()
    exploration: ExplorationSettings = ExplorationSettings()
    annotation: AnnotationSettings = AnnotationSettings()
    tasks: TaskSettings = TaskSettings()
    planner: PlannerSettings = PlannerSettings()
    quadrotor: QuadrotorSettings = QuadrotorSettings()
    frames: FrameSettings = FrameSettings()
    verdict: VerdictSettings = VerdictSettings()
    services: ServicesSettings = ServicesSettings()

    @model_validator(mode="after")
    def _frames_are_states(self) -> "Settings":
        if (self.planner.state_rate / self.frames.rate) % 1 > 1e-9:
            raise ValueError(
                f"frames.rate ({self.frames.rate:g} Hz) must divide planner.state_rate ({self.planner.state_rate:g} Hz)"
            )
        return self

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        return init_settings, env_settings, TomlConfigSettingsSource(settings_cls)
