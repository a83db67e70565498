"""Marble's HTTP interface: its endpoints, typed as far as we read them and lenient beyond (contract, section 1)."""

import base64
from typing import Any, TypeVar

import httpx
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from flymirage_core.errors import (
    BadAnswerError,
    KeyRefusedError,
    ModerationError,
    QuotaError,
    ServiceError,
    TransientServiceError,
)
from flymirage_core.service_settings import MarbleSettings
from resources.services.endpoint import Endpoint, certificates, retry_after, said
from resources.services.pace import Pace
from resources.services.paid import json_of

A = TypeVar("A", bound=BaseModel)
SERVICE = "marble"
ROOT = "/marble/v1"


class AmbiguousError(TransientServiceError):
    """A server error: whether a start was accepted is not known."""


class NotFoundError(ServiceError):
    """No such operation or world (any more)."""


class Answer(BaseModel):
    model_config = ConfigDict(extra="ignore")


class Cost(Answer):
    total_credits: int


class OperationError(Answer):
    code: int | None = None
    message: str | None = None


class Operation(Answer):
    """A long-running operation; ``response`` may be a thin snapshot, so only its id is read."""

    operation_id: str
    done: bool = False
    error: OperationError | None = None
    metadata: dict[str, Any] | None = None
    response: dict[str, Any] | None = None
    cost: Cost | None = None

    @property
    def world_id(self) -> str:
        """Of the world in the making, "" as long as it is not told."""
        places = (self.response or {}, self.metadata or {})
        names = (place.get(name) for place in places for name in ("world_id", "id"))
        return next((str(name) for name in names if name), "")


class Semantics(Answer):
    metric_scale_factor: float | None = None
    ground_plane_offset: float | None = None


class Splats(Answer):
    spz_urls: dict[str, str] | None = None
    semantics_metadata: Semantics | None = None


class Mesh(Answer):
    collider_mesh_url: str | None = None


class Imagery(Answer):
    pano_url: str | None = None


class Assets(Answer):
    caption: str | None = None
    splats: Splats | None = None
    mesh: Mesh | None = None
    imagery: Imagery | None = None


class MarbleWorld(Answer):
    world_id: str = Field(default="")
    id: str = Field(default="")  # older answers
    display_name: str = ""
    model: str | None = None
    tags: list[str] | None = None
    assets: Assets | None = None

    @property
    def spz_urls(self) -> dict[str, str]:
        splats = self.assets.splats if self.assets is not None else None
        return (splats.spz_urls if splats is not None else None) or {}


class MarbleApi:
    """One call for each endpoint. Only `generate` costs money, and it is the only one that is never tried again."""

    def __init__(self, settings: MarbleSettings, pace: Pace) -> None:
        self.settings = settings

        def headers(key: str) -> dict[str, str]:
            return {settings.key_header: key}

        self.endpoint = Endpoint(SERVICE, settings, headers, self._explain, pace)

    def credits(self) -> float:
        """Remaining credits."""
        return float(json_of(SERVICE, self.endpoint.get(f"{ROOT}/credits"))["remaining_credits"])

    def upload(self, png: bytes, name: str) -> dict[str, str]:
        """Send a picture; the reference to it for `generate`."""
        if self.settings.picture == "inline":
            return {"source": "data_base64", "data_base64": base64.b64encode(png).decode(), "extension": "png"}
        wanted = {"file_name": f"{name[:58]}.png", "extension": "png", "kind": "image"}
        answer = json_of(SERVICE, self.endpoint.post_free(f"{ROOT}/media-assets:prepare_upload", wanted))
        info = answer["upload_info"]
        headers = {"Content-Type": "image/png", **(info.get("required_headers") or {})}
        try:  # to a storage host: our key does not go there
            put = httpx.request(
                info.get("upload_method", "PUT"),
                info["upload_url"],
                content=png,
                headers=headers,
                timeout=self.settings.read_timeout,
                verify=certificates(),
            )
        except httpx.HTTPError as error:
            raise TransientServiceError(f"marble's upload failed ({type(error).__name__}): try again later") from None
        if put.status_code >= 300:
            raise TransientServiceError(f"marble's upload was answered {put.status_code}: {said(put.text)}; try again")
        return {"source": "media_asset", "media_asset_id": str(answer["media_asset"]["media_asset_id"])}

    def generate(self, body: dict[str, Any]) -> Operation:
        """Start a world. Raises `Unanswered` or `AmbiguousError` if it may have been accepted; any other
        `ServiceError` means that it was not."""
        response = self.endpoint.post_paid(f"{ROOT}/worlds:generate", body)
        try:
            return Operation.model_validate(json_of(SERVICE, response))
        except (ValidationError, BadAnswerError):
            raise AmbiguousError(
                f"marble accepted a start with an answer that cannot be read: {response.status_code}"
            ) from None

    def operation(self, operation_id: str) -> Operation:
        """Raises `NotFoundError` for one that has expired."""
        return _parsed(Operation, self.endpoint.get(f"{ROOT}/operations/{operation_id}"))

    def world(self, world_id: str) -> MarbleWorld:
        answer = json_of(SERVICE, self.endpoint.get(f"{ROOT}/worlds/{world_id}"))
        return _validated(MarbleWorld, answer.get("world", answer))

    def worlds_tagged(self, tag: str, status: str) -> list[str]:
        """Ids of the worlds with a tag; ``status`` "" for those of any."""
        body: dict[str, Any] = {"tags": [tag], "page_size": 20, **({"status": status} if status else {})}
        answer = json_of(SERVICE, self.endpoint.post_free(f"{ROOT}/worlds:list", body))
        worlds = [_validated(MarbleWorld, world) for world in answer.get("worlds", [])]
        return [w.world_id or w.id for w in worlds if tag in (w.tags or [])]

    def _explain(self, response: httpx.Response) -> ServiceError:
        """What an error answer means (contract, section 1.7)."""
        status, words = response.status_code, f"marble answered {response.status_code}: {said(_detail(response))}"
        if status == 401:
            return KeyRefusedError(f"{words}; check the key in {self.settings.key_env}")
        if status == 402:
            return QuotaError(f"{words}; buy credits, then run again")
        if status == 404:
            return NotFoundError(words)
        if status == 403:
            return KeyRefusedError(f"{words}; the world may have been made with another key")
        if status == 429:
            return TransientServiceError(f"{words}; try again later", retry_after(response) or 20.0)
        if status in (408, 409):
            return TransientServiceError(f"{words}; try again later", retry_after(response))
        if status >= 500:
            return AmbiguousError(f"{words}; try again later", retry_after(response))
        if status == 400 and any(word in words.lower() for word in ("polic", "moderat", "safety", "inappropriate")):
            return ModerationError(words)
        return ServiceError(words)


def _detail(response: httpx.Response) -> str:
    try:
        body = response.json()
    except ValueError:
        return response.text[:200]
    detail = body.get("detail", body) if isinstance(body, dict) else body
    if isinstance(detail, list):
        return "; ".join(
            f"{'.'.join(map(str, d.get('loc', [])))}: {d.get('msg')}" for d in detail if isinstance(d, dict)
        )
    return str(detail)


def _parsed(kind: type[A], response: httpx.Response) -> A:
    return _validated(kind, json_of(SERVICE, response))


def _validated(kind: type[A], value: Any) -> A:
    try:
        return kind.model_validate(value)
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(map(str, first["loc"]))
        raise BadAnswerError(f"marble's {kind.__name__} cannot be read: {field}: {first['msg']}") from None
