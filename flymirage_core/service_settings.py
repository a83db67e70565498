"""Settings of the outside services: where they are, which model, how fast, what they cost, and how much may be spent.

Whatever a vendor has not confirmed (model ids, quirks of a wire, limits) is a setting here. Keys are never settings:
``key_env`` names the environment variable that holds one, and it is read when a call is made. Prices are US dollars.
"""

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Count = Annotated[int, Field(ge=1)]
Vendor = Literal["openai", "gemini", "dashscope", "local"]

VENDORS: dict[str, dict[str, Any]] = {
    "openai": {
        "base_url": "https://api.openai.com/v1",
        "key_env": "OPENAI_API_KEY",
        "model": "gpt-5.4",
        "json_mode": "json_schema",
        "token_limit_field": "max_completion_tokens",
        "system_role": "developer",
        "extra_body": {"reasoning_effort": "low", "store": False},
    },
    "gemini": {
        "base_url": "https://generativelanguage.googleapis.com",
        "key_env": "GEMINI_API_KEY",
        "model": "gemini-3.1-pro-preview",
    },
    "dashscope": {
        "base_url": "https://dashscope-intl.aliyuncs.com/compatible-mode/v1",
        "key_env": "DASHSCOPE_API_KEY",
        "model": "qwen3.5-flash",
        "json_mode": "json_object",
        "token_limit_field": "max_tokens",
        "extra_body": {"enable_thinking": False},
    },
    "local": {"base_url": "http://localhost:8000/v1", "token_limit_field": "max_tokens"},
}
"""What a vendor's name stands for; each field can be set on its own as well."""


class Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class PaceSettings(Section):
    """How fast one service may be asked, by all processes of a store together."""

    starts_per_minute: Count = 60
    at_once: Count = 8
    """Requests in flight."""
    tries: Count = 6
    """How often a request that is answered 429 (or that never left) is sent in all."""
    server_error_tries: Count = 1
    """How often a request that is answered 5xx is sent in all; more than 1 only where such answers are not billed."""
    first_wait: Positive = 1.0
    """Seconds before the second try; doubles, with jitter. Retry-After overrules it."""
    longest_wait: Positive = 120.0
    """Seconds; a service that wants a longer pause ends the attempt instead."""
    breaker_failures: Count = 5
    """So many failures in a row, in any process, and the service counts as down ..."""
    breaker_seconds: Positive = 60.0
    """... for so long; then one request probes it."""


class EndpointSettings(Section):
    """One service under one address."""

    base_url: str
    key_env: str = ""
    """Name of the environment variable that holds the key; "" sends none."""
    model: str
    connect_timeout: Positive = 10.0
    read_timeout: Positive = 120.0
    pace: PaceSettings = PaceSettings()


class LanguageModelSettings(EndpointSettings):
    """A language model that may see pictures: OpenAI, DashScope or any server with their wire, or Gemini."""

    vendor: Vendor = "openai"
    """Fills what is not given: see `VENDORS`."""
    json_mode: Literal["json_schema", "json_object", "none"] = "json_schema"
    token_limit_field: Literal["max_completion_tokens", "max_tokens"] = "max_completion_tokens"
    system_role: Literal["developer", "system"] = "system"
    max_tokens: Count = 12_000
    """Of an answer, with the tokens of its reasoning."""
    temperature: float | None = None
    send_seed: bool = True
    image_detail: Literal["", "low", "high", "auto", "original"] = ""
    extra_body: dict[str, Any] = {}
    """Sent along at the top level of every request."""
    api_version: str = "v1beta"
    """gemini: whether v1 serves preview models is not confirmed."""
    thinking_level: Literal["", "MINIMAL", "LOW", "MEDIUM", "HIGH", "XHIGH"] = "LOW"
    """gemini"""
    tokens_per_image: Count = 3000
    """Assumed for a worst case before a call; what was used comes from the answer."""

    @model_validator(mode="before")
    @classmethod
    def _fill_from_vendor(cls, given: Any) -> Any:
        if isinstance(given, dict) and (preset := VENDORS.get(given.get("vendor", "openai"))) is not None:
            return {**preset, **given}
        return given


class ImageModelSettings(EndpointSettings):
    """OpenAI's images endpoint. There is no seed: the picture itself is kept."""

    base_url: str = "https://api.openai.com/v1"
    key_env: str = "OPENAI_API_KEY"
    model: str = "gpt-image-2"
    read_timeout: Positive = 400.0
    size: str = "1536x1024"
    quality: Literal["low", "medium", "high", "auto"] = "high"
    moderation: Literal["auto", "low"] = "auto"
    worst_output_tokens: Count = 6500
    """Of one picture at this size and quality; $0.195."""
    pace: PaceSettings = PaceSettings(starts_per_minute=10, at_once=2)


class MarbleSettings(EndpointSettings):
    """World Labs' Marble."""

    base_url: str = "https://api.worldlabs.ai"
    key_env: str = "WORLDLABS_API_KEY"
    key_header: str = "WLT-Api-Key"
    model: str = "marble-1.1-plus"
    pace: PaceSettings = PaceSettings(starts_per_minute=3, at_once=2)
    picture: Literal["upload", "inline"] = "upload"
    """How the picture travels: as a media asset, or as base64 in the paid request."""
    is_pano: Literal["omit", "auto", "true", "false"] = "omit"
    """Whether the vendor wants a boolean or a string is not confirmed; a 3:2 picture needs neither."""
    disable_recaption: bool = True
    text_limit: int = Field(default=0, ge=0)
    """Characters of the text prompt; 0 = no limit is known."""
    poll_seconds: Positive = 12.0
    poll_budget: Positive = 1800.0
    """Seconds after which a run gives up waiting; the next one carries on."""
    splats: tuple[str, ...] = ("full_res", "500k", "150k", "100k")
    """Which resolution is taken, best first."""
    list_statuses: tuple[str, ...] = ("", "PENDING", "RUNNING", "SUCCEEDED")
    """Filters with which lost worlds are looked for; "" = none."""
    lost_start_wait: NotNegative = 120.0
    """Seconds between two looks for a world whose start was not answered."""
    lost_start_looks: Count = 3
    resubmit_after_lost_start: Literal["ask", "auto"] = "ask"
    """What follows if it is nowhere: fail and let a person look, or pay for another."""
    attempts: Count = 2
    """How often a world is started in all, if its generation fails; each time with another seed."""
    failed_credits: int = Field(default=0, ge=0)
    """What a failed generation costs: by the documents nothing, but that is not confirmed."""
    worst_credits: Count = 3080
    """Of one world: 80 for the panorama, 1500 for the world, up to 1500 for its size."""
    download_timeout: Positive = 120.0
    download_tries: Count = 6


class TokenPrice(Section):
    """US dollars for a million tokens."""

    input: NotNegative
    output: NotNegative
    cached_input: NotNegative | None = None
    image_input: NotNegative | None = None
    as_of: str


LIST_PRICES = {
    "gpt-5.4": TokenPrice(input=2.5, cached_input=0.25, output=15.0, as_of="2026-10"),
    "gpt-5.4-mini": TokenPrice(input=0.75, output=4.5, as_of="2026-10"),
    "gpt-5.4-nano": TokenPrice(input=0.2, output=1.25, as_of="2026-10"),
    "gemini-3.1-pro-preview": TokenPrice(input=2.0, output=12.0, as_of="2026-10"),
    "gemini-3.1-flash-lite": TokenPrice(input=0.25, output=1.5, as_of="2026-10"),
    "qwen3.5-flash": TokenPrice(input=0.1, output=0.4, as_of="2026-11"),
    "gpt-image-2": TokenPrice(input=5.0, image_input=8.0, output=30.0, as_of="2026-10"),
}
"""List prices as known on 21 November 2026."""


class PriceSettings(Section):
    """What calls cost. A model without a price is refused: the caps could not hold."""

    tokens: dict[str, TokenPrice] = {}
    """By model id; extends and overrules `LIST_PRICES`. A model of your own costs 0: say so."""
    marble_credits_per_usd: Positive = 1250.0
    marble_as_of: str = "2026-11"

    def of(self, model: str) -> TokenPrice | None:
        return self.tokens.get(model) or LIST_PRICES.get(model)


class BudgetSettings(Section):
    """Caps in US dollars. A call whose worst case would break one is not made."""

    scene_usd: Positive = 5.0
    night_usd: Positive = 100.0
    """From noon to noon, UTC."""
    month_usd: Positive = 1500.0
    """Calendar month, UTC."""


class ServicesSettings(Section):
    """The outside services of profile ``paper``."""

    writer: LanguageModelSettings = LanguageModelSettings(**VENDORS["openai"])
    painter: ImageModelSettings = ImageModelSettings()
    marble: MarbleSettings = MarbleSettings()
    vlm: LanguageModelSettings = LanguageModelSettings(
        **VENDORS["dashscope"], vendor="dashscope", max_tokens=1500, temperature=0.1
    )
    prices: PriceSettings = PriceSettings()
    budget: BudgetSettings = BudgetSettings()
    rerolls: int = Field(default=3, ge=0)
    """How often a scene whose content was refused gets another description."""
    state: str = ""
    """A folder on a local disk for the ledger and the pace, shared by all processes of a store; "" = in the store if
    that is a local folder, else ``.flymirage/services``."""

    @model_validator(mode="before")
    @classmethod
    def _keep_vlm_defaults(cls, given: Any) -> Any:
        """A partly given VLM keeps DashScope's values for the rest, unless it names another vendor."""
        if isinstance(given, dict) and isinstance(vlm := given.get("vlm"), dict) and "vendor" not in vlm:
            given = {**given, "vlm": {"vendor": "dashscope", "max_tokens": 1500, "temperature": 0.1, **vlm}}
        return given

    @model_validator(mode="after")
    def _models_named(self) -> Self:
        for name in ("writer", "painter", "vlm"):
            if not getattr(self, name).model:
                raise ValueError(f"services.{name}.model is empty; name the model that the server offers")
        return self
