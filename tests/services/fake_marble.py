"""A fake of Marble as strict as its contract: each of its faults can be switched on, each credit counts."""

import base64
import json
import math
import re
import uuid
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import jsonschema
import yaml
from fake_http import FakeService, Reply, Request
from fake_openai import png
from marble_files import Originals

MODELS = {"marble-1.0-draft", "marble-1.0", "marble-1.1", "marble-1.1-plus"}
REFUSED_402 = (
    "Insufficient API credits to start this request. Add credits or enable auto-refill at "
    "https://platform.worldlabs.ai/billing."
)
OPENAPI = Path(__file__).resolve().parents[3] / "shared" / "contracts" / "marble-openapi.yaml"


@dataclass
class Made:
    """A world and its operation."""

    world_id: str
    operation_id: str
    body: dict[str, Any]
    started: float
    credits: int
    polls: int = 0
    failed: bool = False
    downloads: dict[str, int] = field(default_factory=dict)


class FakeMarble(FakeService):
    """Serves the endpoints we use, a signed upload host and a download host, all under one port."""

    def __init__(self, originals: Originals, key: str = "wl-test", balance: float = 100_000.0) -> None:
        super().__init__()
        self.originals, self.key, self.balance = originals, key, balance
        self.worlds: dict[str, Made] = {}  # by operation
        self.uploads: dict[str, bytes | None] = {}
        self.starts: list[float] = []
        self.polls_until_done = 1
        self.seconds_until_done = 0.0
        self.listed_after = 0.0  # seconds after which a new world is in worlds:list
        self.starts_per_minute = 1000
        self.variable_credits = 600
        self.fail_generation = ""
        self.refuse_content = False
        self.null_semantics = False
        self.thin_snapshot = False
        self.wrapped_world = False
        self.no_cost = False
        self.expired_operation = False
        self.expired_urls = 0  # so many first requests of each file are answered 403
        self.cut_downloads = 0  # so many first requests of each file break off half way
        self.signature = "X-Goog-Signature=c0ffee"
        self.violations: list[str] = []
        self.contract = Contract(OPENAPI) if OPENAPI.exists() else None

    # What a test asks -----------------------------------------------------------------------------------------------

    @property
    def charged(self) -> dict[str, int]:
        """Credits charged, by the request key in the tags."""
        sums: dict[str, int] = {}
        for made in self.worlds.values():
            tag = next((t for t in made.body.get("tags", []) if t.startswith("fm-")), "untagged")
            sums[tag] = sums.get(tag, 0) + made.credits
        return sums

    # Serving --------------------------------------------------------------------------------------------------------

    def handle(self, request: Request) -> Reply:
        if request.path.startswith(("/upload/", "/cdn/")):
            if "wlt-api-key" in request.headers or "authorization" in request.headers:
                self.violations.append(f"a key was sent to {request.path}")
                return Reply(400, b"no keys here")
            return self._upload(request) if request.path.startswith("/upload/") else self._download(request)
        given = request.headers.get("wlt-api-key", "")
        if given != self.key:
            return Reply(401, {"detail": f"Invalid API key: {given}", "request_id": "r-1"})
        problem = self.contract.request_problem(request) if self.contract is not None else None
        if problem is not None:
            detail = [{"loc": ["body", *problem[0]], "msg": problem[1], "type": "value_error"}]
            return Reply(422, {"detail": detail})
        reply = self._route(request)
        if self.contract is not None and reply.status == 200:
            self.violations += self.contract.answer_problems(request, reply.body)
        return reply

    def _route(self, request: Request) -> Reply:
        path = request.path.removeprefix("/marble/v1")
        if request.method == "GET" and path == "/credits":
            return Reply(body={"remaining_credits": self.balance})
        if request.method == "POST" and path == "/media-assets:prepare_upload":
            return self._prepare(request.json)
        if request.method == "POST" and path == "/worlds:generate":
            return self._generate(request.json)
        if request.method == "POST" and path == "/worlds:list":
            return self._list(request.json)
        if request.method == "GET" and (match := re.fullmatch(r"/operations/([\w-]+)", path)):
            return self._operation(match[1])
        if request.method == "GET" and (match := re.fullmatch(r"/worlds/([\w-]+)", path)):
            return self._world(match[1])
        return Reply(404, {"detail": "Not Found"})

    def _prepare(self, body: dict[str, Any]) -> Reply:
        asset = uuid.uuid4().hex
        self.uploads[asset] = None
        media = {
            "media_asset_id": asset,
            "file_name": body["file_name"],
            "extension": body.get("extension"),
            "kind": body["kind"],
            "metadata": body.get("metadata"),
            "created_at": _iso(self.clock()),
            "updated_at": None,
        }
        upload = {
            "upload_url": f"{self.url}/upload/{asset}?{self.signature}",
            "upload_method": "PUT",
            "required_headers": {"x-goog-content-length-range": "0,1048576000"},
            "curl_example": "curl ...",
        }
        return Reply(body={"media_asset": media, "upload_info": upload})

    def _upload(self, request: Request) -> Reply:
        if request.headers.get("x-goog-content-length-range") != "0,1048576000" or request.query != self.signature:
            return Reply(403, b"<Error><Code>SignatureDoesNotMatch</Code></Error>")
        self.uploads[request.path.rsplit("/", 1)[1]] = request.body
        return Reply(200)

    def _generate(self, body: dict[str, Any]) -> Reply:
        problem = _generate_problem(body)
        if problem is not None:
            return Reply(422, {"detail": [{"loc": ["body", *problem[0]], "msg": problem[1], "type": "value_error"}]})
        if self.refuse_content:
            return Reply(400, {"detail": "The request violates our content policy.", "request_id": "r-2"})
        now = self.clock()
        self.starts = [t for t in self.starts if t > now - 60]
        if len(self.starts) >= self.starts_per_minute:
            return Reply(429, {"detail": "Rate limit exceeded"}, {"retry-after": "1"})
        credits = 80 + 1500 + self.variable_credits
        if self.balance < credits:
            return Reply(402, {"detail": REFUSED_402})
        self.starts.append(now)
        made = Made(str(uuid.uuid4()), str(uuid.uuid4()), body, now, credits)
        image = body["world_prompt"]["image_prompt"]
        made.failed = bool(self.fail_generation) or (
            image["source"] == "media_asset" and not self.uploads.get(image["media_asset_id"])
        )
        if made.failed:
            made.credits = 0
        self.balance -= made.credits
        self.worlds[made.operation_id] = made
        return Reply(body=self._operation_body(made, done=False, tell_world=False))

    def _operation(self, operation_id: str) -> Reply:
        made = self.worlds.get(operation_id)
        if made is None or self.expired_operation:
            return Reply(404, {"detail": "Operation not found"})
        made.polls += 1
        return Reply(body=self._operation_body(made, done=self._is_done(made)))

    def _is_done(self, made: Made) -> bool:
        return made.polls > self.polls_until_done and self.clock() >= made.started + self.seconds_until_done

    def _operation_body(self, made: Made, done: bool, tell_world: bool = True) -> dict[str, Any]:
        ok = done and not made.failed
        status = "FAILED" if done and made.failed else "SUCCEEDED" if done else "IN_PROGRESS"
        items = [{"name": "pano", "credits": 80}, {"name": "world", "credits": made.credits - 80}]
        cost = {"total_credits": made.credits, "line_items": items} if ok and not self.no_cost else None
        metadata = {"progress": {"status": status, "description": "World generation"}, "world_id": made.world_id}
        return {
            "operation_id": made.operation_id,
            "created_at": _iso(made.started),
            "updated_at": _iso(self.clock()),
            "expires_at": _iso(made.started + 3600),
            "done": done,
            "error": {"code": 13, "message": self.fail_generation or "no image"} if done and made.failed else None,
            "metadata": metadata if tell_world else None,
            "response": self._response(made) if ok else None,
            "cost": cost,
        }

    def _response(self, made: Made) -> dict[str, Any]:
        if self.thin_snapshot:
            return {"id": made.world_id, "world_id": made.world_id, "display_name": "", "world_marble_url": ""}
        return self._world_body(made, whole=True)

    def _world(self, world_id: str) -> Reply:
        made = next((m for m in self.worlds.values() if m.world_id == world_id), None)
        if made is None:
            return Reply(404, {"detail": "World not found"})
        made.polls += 1
        body = self._world_body(made, whole=self._is_done(made) and not made.failed)
        return Reply(body={"world": body} if self.wrapped_world else body)

    def _world_body(self, made: Made, whole: bool) -> dict[str, Any]:
        def url(name: str) -> str:
            return f"{self.url}/cdn/{made.world_id}/{name}?{self.signature}"

        semantics = {
            "metric_scale_factor": self.originals.scale,
            "ground_plane_offset": self.originals.ground,
        }
        assets = {
            "caption": "A small room.",
            "thumbnail_url": url("thumb.webp"),
            "imagery": {"pano_url": url("pano.png")},
            "mesh": {"collider_mesh_url": url("collider.glb"), "hq_mesh_url": None, "full_res_mesh_url": None},
            "splats": {
                "spz_urls": {name: url(f"{name}.spz") for name in ("100k", "500k", "full_res", "150k")},
                "semantics_metadata": None if self.null_semantics else semantics,
            },
        }
        return {
            "world_id": made.world_id,
            "display_name": made.body.get("display_name") or "",
            "tags": made.body.get("tags"),
            "model": made.body.get("model", "marble-1.1"),
            "world_marble_url": f"https://marble.worldlabs.ai/world/{made.world_id}",
            "permission": made.body.get("permission"),
            "world_prompt": None,
            "created_at": _iso(made.started),
            "updated_at": _iso(self.clock()),
            "assets": assets if whole else None,
        }

    def _list(self, body: dict[str, Any]) -> Reply:
        def status(made: Made) -> str:
            if self.clock() < made.started + self.seconds_until_done or made.polls < self.polls_until_done:
                return "RUNNING"
            return "FAILED" if made.failed else "SUCCEEDED"

        tags = set(body.get("tags") or [])
        found = [
            m
            for m in self.worlds.values()
            if self.clock() >= m.started + self.listed_after
            and (not tags or tags & set(m.body.get("tags") or []))
            and (body.get("status") in (None, status(m)))
        ]
        worlds = [self._world_body(m, whole=False) for m in found[: body.get("page_size", 20)]]
        return Reply(body={"worlds": worlds, "next_page_token": None})

    def _download(self, request: Request) -> Reply:
        _, _, world_id, name = request.path.split("/")
        made = next(m for m in self.worlds.values() if m.world_id == world_id)
        made.downloads[name] = made.downloads.get(name, 0) + 1
        if request.query != self.signature or made.downloads[name] <= self.expired_urls:
            return Reply(403, b"<Error><Code>ExpiredToken</Code></Error>")
        data = self.originals.files["full_res.spz" if name.endswith(".spz") else name]
        start = re.fullmatch(r"bytes=(\d+)-", request.headers.get("range", ""))
        offset = int(start[1]) if start else 0
        if offset >= len(data):
            return Reply(416, b"", {"content-range": f"bytes */{len(data)}"})
        rest = data[offset:]
        cut = math.ceil(len(rest) / 2) if made.downloads[name] <= self.expired_urls + self.cut_downloads else None
        ranged = {"content-range": f"bytes {offset}-{len(data) - 1}/{len(data)}"} if start else {}
        return Reply(206 if start else 200, rest, {"etag": '"1"', **ranged}, cut=cut)


class Contract:
    """The vendor's own OpenAPI file: requests and answers are checked by its schemas."""

    def __init__(self, path: Path) -> None:
        self.document = yaml.safe_load(path.read_text())
        self._validators: dict[str, jsonschema.Draft202012Validator] = {}

    def request_problem(self, request: Request) -> tuple[list[Any], str] | None:
        """(where, what) of a body that the vendor's schema refuses."""
        content = self._operation(request).get("requestBody", {}).get("content", {}).get("application/json")
        if content is None:
            return None
        error = next(iter(self._errors(content["schema"], request.json)), None)
        return None if error is None else (list(error.absolute_path), error.message[:120])

    def answer_problems(self, request: Request, body: Any) -> list[str]:
        schema = self._operation(request)["responses"]["200"]["content"]["application/json"]["schema"]
        if isinstance(body, dict) and set(body) == {"world"}:
            body = body["world"]  # the old quickstart's form
        return [f"{request.path}: {e.json_path}: {e.message[:200]}" for e in self._errors(schema, body)]

    def _operation(self, request: Request) -> dict[str, Any]:
        for template, methods in self.document["paths"].items():
            pattern = re.sub(r"\\\{\w+\\\}", r"[\\w-]+", re.escape(template))
            if re.fullmatch(pattern, request.path) and request.method.lower() in methods:
                operation: dict[str, Any] = methods[request.method.lower()]
                return operation
        raise AssertionError(f"{request.method} {request.path} is not in the vendor's file")

    def _errors(self, schema: dict[str, Any], value: Any) -> list[Any]:
        name = json.dumps(schema, sort_keys=True)
        if name not in self._validators:
            whole = {**schema, "components": self.document["components"]}
            self._validators[name] = jsonschema.Draft202012Validator(whole)
        return list(self._validators[name].iter_errors(json.loads(json.dumps(value))))


def _generate_problem(body: dict[str, Any]) -> tuple[list[str], str] | None:
    """What the vendor refuses and its schema does not say everywhere (used where the file is absent, too)."""
    prompt = body.get("world_prompt")
    if not isinstance(prompt, dict) or prompt.get("type") not in ("text", "image", "multi-image", "video"):
        return ["world_prompt", "type"], "Field required"
    picture = prompt.get("image_prompt", {})
    if picture.get("source") == "data_base64" and base64.b64decode(picture["data_base64"])[:4] != b"\x89PNG":
        return ["world_prompt", "image_prompt"], "not an image"
    if body.get("model", "marble-1.1") not in MODELS:
        return ["model"], "Input should be a known model"
    if len(body.get("display_name") or "") > 64:
        return ["display_name"], "String should have at most 64 characters"
    tags = body.get("tags") or []
    if len(tags) > 10 or any(len(tag) > 32 for tag in tags):
        return ["tags"], "at most 10 tags of at most 32 characters"
    if not 0 <= (body.get("seed") or 0) <= 4294967295:
        return ["seed"], "Input should be between 0 and 4294967295"
    return None


def _iso(seconds: float) -> str:
    return (datetime(1970, 1, 1, tzinfo=UTC) + timedelta(seconds=seconds)).isoformat().replace("+00:00", "Z")


def panorama() -> bytes:
    """A small PNG, twice as wide as high."""
    return png(128, 64, "panorama")
