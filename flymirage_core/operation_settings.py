"""Settings of the machine room: nightly growth, what happens when something fails, who runs the stages."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, SecretStr, field_validator

Count = Annotated[int, Field(ge=1)]
NotNegative = Annotated[float, Field(ge=0)]
Executor = Literal["in_process", "multiprocess", "celery", "ray"]


class Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class GrowthSettings(Section):
    """New scenes night after night. The schedule is off until someone switches it on, here or in the UI."""

    nightly: bool = False
    """Start ``nightly_growth``, ``nightly_report`` and ``stale_sweep`` without a click in the UI."""
    scenes_per_night: Count = 5
    cron: str = "0 2 * * *"
    """When a night's scenes are requested."""
    sweep_cron: str = "30 5 * * *"
    """When the night is reported, and scenes with stale or missing products begin to be requested again."""
    timezone: str = "UTC"
    min_free_gb: NotNegative = 2.0
    """Growth stops before a scene if the store's disk has less than this."""

    @field_validator("cron", "sweep_cron")
    @classmethod
    def _five_fields(cls, value: str) -> str:
        if len(value.split()) != 5:
            raise ValueError("a cron line has five fields: minute hour day month weekday")
        return value


class OperationSettings(Section):
    """Failures, retries, and what is told to whom."""

    step_retries: Annotated[int, Field(ge=0)] = 3
    """How often a stage is tried again after a transient failure (a busy service, a dropped connection)."""
    retry_delay: NotNegative = 20.0
    """Seconds before the first of them; doubles, with jitter."""
    max_run_seconds: Count = 6 * 3600
    """A run of one scene that takes longer is failed by the daemon's run monitoring."""
    webhook_url: SecretStr = SecretStr("")
    """Gets a POST with JSON (event, job, scene, run_id, error) when a run fails; "" tells nobody."""
    automation: bool = False
    """Let the automation sensor start what a changed code version or a new scene key asks for: it may cost money."""
