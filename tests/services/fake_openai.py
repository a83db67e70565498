"""A fake of Chat Completions (OpenAI, and DashScope's stricter dialect) and of OpenAI's images endpoint.

As strict as the contract: schema rules, unknown parameters of image models, the word "json", thinking switched off.
"""

import base64
import hmac
import json
import math
import re
import struct
import zlib
from collections.abc import Callable
from typing import Any, Literal

import jsonschema
from fake_http import FakeService, Reply, Request

Answerer = Callable[[str, str, int, dict[str, Any] | None], Any]
"""(system text, user text, number of pictures, schema) -> what goes into the message: an object, or text as it is."""

RATE = {
    "x-ratelimit-limit-requests": "500",
    "x-ratelimit-remaining-requests": "499",
    "x-ratelimit-reset-requests": "20ms",
}
CHAT_FIELDS = {
    "model",
    "messages",
    "response_format",
    "max_tokens",
    "max_completion_tokens",
    "reasoning_effort",
    "seed",
    "store",
    "stream",
    "temperature",
}
IMAGE_FIELDS = {
    "model",
    "prompt",
    "size",
    "quality",
    "output_format",
    "output_compression",
    "n",
    "background",
    "moderation",
    "user",
}


class FakeOpenAI(FakeService):
    """``{url}/v1/chat/completions``, ``/v1/images/generations``, ``/v1/models``."""

    def __init__(
        self, answerer: Answerer, key: str = "sk-test", dialect: Literal["openai", "dashscope"] = "openai"
    ) -> None:
        super().__init__()
        self.answerer, self.key, self.dialect = answerer, key, dialect
        self.models = {"openai": ["gpt-5.4", "gpt-image-2"], "dashscope": ["qwen3.5-flash"]}[dialect]
        self.charged_calls = 0
        self.charged_images = 0
        self.cheap_pictures = True

    @property
    def base_url(self) -> str:
        return f"{self.url}/v1"

    def handle(self, request: Request) -> Reply:
        given = request.headers.get("authorization", "")
        if not hmac.compare_digest(given, f"Bearer {self.key}"):
            shown = given.removeprefix("Bearer ")
            return self.error(401, f"Incorrect API key provided: {shown}.", "invalid_request_error", "invalid_api_key")
        if request.path == "/v1/models" and request.method == "GET":
            return Reply(body={"object": "list", "data": [self._model(m) for m in self.models]})
        if request.path.startswith("/v1/models/") and request.method == "GET":
            name = request.path.removeprefix("/v1/models/")
            return Reply(body=self._model(name)) if name in self.models else self._no_model(name)
        if request.method == "POST" and request.path == "/v1/chat/completions":
            return self._chat(request.json)
        if request.method == "POST" and request.path == "/v1/images/generations":
            return self._image(request.json)
        return self.error(404, f"Unknown request URL: {request.method} {request.path}", "invalid_request_error", None)

    def error(self, status: int, message: str, kind: str, code: str | None, **headers: str) -> Reply:
        body: dict[str, Any] = {"error": {"message": message, "type": kind, "param": None, "code": code}}
        if self.dialect == "dashscope":
            body["request_id"] = "9f4c-fake"
        return Reply(status, body, {"x-request-id": "req_fake", **headers})

    def _no_model(self, name: str) -> Reply:
        return self.error(404, f"The model `{name}` does not exist", "invalid_request_error", "model_not_found")

    @staticmethod
    def _model(name: str) -> dict[str, Any]:
        return {"id": name, "object": "model", "created": 1795000000, "owned_by": "fake"}

    def _bad(self, message: str, code: str | None = None) -> Reply:
        return self.error(400, message, "invalid_request_error", code)

    def _chat(self, body: dict[str, Any]) -> Reply:
        if body.get("model") not in self.models:
            return self._no_model(str(body.get("model")))
        problem = self._chat_problem(body)
        if problem:
            return self._bad(problem, "invalid_parameter_error" if self.dialect == "dashscope" else None)
        system, user, pictures = _texts(body["messages"])
        wanted = body.get("response_format", {})
        schema = wanted["json_schema"]["schema"] if wanted.get("type") == "json_schema" else None
        said = self.answerer(system, user, pictures, schema)
        if isinstance(said, Reply):
            return said
        message = {"role": "assistant", "content": said if isinstance(said, str) else json.dumps(said), "refusal": None}
        if schema is not None and not isinstance(said, str):
            jsonschema.validate(said, schema)  # strict mode never breaks the schema
        self.charged_calls += 1
        return Reply(body=self.completion(body, message), headers={"x-request-id": "req_fake", **RATE})

    def completion(self, body: dict[str, Any], message: dict[str, Any], finish: str = "stop") -> dict[str, Any]:
        read = len(json.dumps(body["messages"])) // 400 + 700
        written = len(message.get("content") or "") // 4 + 1
        return {
            "id": "chatcmpl-fake",
            "object": "chat.completion",
            "created": 1795000000,
            "model": f"{body['model']}-2026-03-05",
            "choices": [{"index": 0, "finish_reason": finish, "message": message, "logprobs": None}],
            "usage": {
                "prompt_tokens": read,
                "completion_tokens": written,
                "total_tokens": read + written,
                "prompt_tokens_details": {"cached_tokens": 0},
                "completion_tokens_details": {"reasoning_tokens": 0},
            },
            "service_tier": "default",
        }

    def _chat_problem(self, body: dict[str, Any]) -> str | None:
        dashscope = self.dialect == "dashscope"
        unknown = set(body) - CHAT_FIELDS - ({"enable_thinking"} if dashscope else set())
        if unknown:
            return f"Unrecognized request argument supplied: {sorted(unknown)[0]}"
        if not dashscope and "max_tokens" in body:
            return "Unsupported parameter: 'max_tokens' is not supported with this model. Use 'max_completion_tokens'."
        if not dashscope and body.get("reasoning_effort") not in (None, "none") and "temperature" in body:
            return "Unsupported parameter: 'temperature' is not supported with this model."
        if dashscope and not body.get("stream") and body.get("enable_thinking") is not False:
            return "parameter.enable_thinking must be set to false for non-streaming calls"
        wanted = body.get("response_format", {"type": "text"})
        if wanted["type"] == "json_object" and "json" not in json.dumps(body["messages"]).lower():
            return (
                "'messages' must contain the word 'json' in some form, to use 'response_format' of type 'json_object'."
            )
        if wanted["type"] == "json_schema":
            if dashscope:
                return "json_schema is not supported by this model"
            named = wanted["json_schema"]
            if not re.fullmatch(r"[A-Za-z0-9_-]{1,64}", named["name"]):
                return "Invalid 'response_format.json_schema.name'"
            return schema_problem(named["schema"]) if named.get("strict") else None
        return None

    def _image(self, body: dict[str, Any]) -> Reply:
        if body.get("model") not in self.models:
            return self._no_model(str(body.get("model")))
        unknown = set(body) - IMAGE_FIELDS
        if unknown:
            return self.error(
                400, f"Unknown parameter: '{sorted(unknown)[0]}'.", "invalid_request_error", "unknown_parameter"
            )
        if len(body["prompt"]) > 32_000:
            return self._bad("prompt is too long")
        width, height = (int(x) for x in body["size"].split("x"))
        if (
            width % 16
            or height % 16
            or not 1 / 3 <= width / height <= 3
            or width * height < 655_360
            or max(width, height) > 3840
        ):
            return self._bad(f"Invalid size {body['size']}")
        self.charged_images += 1
        written = {"low": 158, "medium": 1372, "high": 5500}[body["quality"]]
        read = len(body["prompt"]) // 4
        scale = 8 if self.cheap_pictures else 1
        return Reply(
            body={
                "created": 1795000000,
                "background": "opaque",
                "output_format": "png",
                "quality": body["quality"],
                "size": body["size"],
                "data": [{"b64_json": base64.b64encode(png(width // scale, height // scale, body["prompt"])).decode()}],
                "usage": {
                    "input_tokens": read,
                    "input_tokens_details": {"text_tokens": read, "image_tokens": 0},
                    "output_tokens": written,
                    "output_tokens_details": {"image_tokens": written, "text_tokens": 0},
                    "total_tokens": read + written,
                },
            },
            headers={"x-request-id": "req_fake", **RATE},
        )


def schema_problem(schema: dict[str, Any], where: str = "root") -> str | None:
    """What strict structured output would refuse about a schema."""
    for refused in ("$ref", "default", "minLength", "maxLength", "prefixItems", "allOf", "oneOf"):
        if refused in schema:
            return f"Invalid schema for response_format: {where}: '{refused}' is not permitted."
    if where == "root" and schema.get("type") != "object":
        return "Invalid schema for response_format: schema must be a JSON Schema of 'type: \"object\"'."
    if schema.get("type") == "object":
        if schema.get("additionalProperties") is not False:
            return f"Invalid schema: {where}: 'additionalProperties' is required to be supplied and to be false."
        if set(schema.get("required", [])) != set(schema["properties"]):
            return (
                f"Invalid schema: {where}: 'required' is required to be supplied and to be an array including every key"
            )
        for name, field in schema["properties"].items():
            if problem := schema_problem(field, f"{where}.{name}"):
                return problem
    if "items" in schema:
        return schema_problem(schema["items"], f"{where}[]")
    return None


def _texts(messages: list[dict[str, Any]]) -> tuple[str, str, int]:
    """System text, user text, number of pictures; pictures must be JPEG or PNG data URLs."""
    system, user, pictures = [], [], 0
    for message in messages:
        content = message["content"]
        parts = [{"type": "text", "text": content}] if isinstance(content, str) else content
        for part in parts:
            if part["type"] == "image_url":
                head, data = part["image_url"]["url"].split(",", 1)
                assert head in ("data:image/jpeg;base64", "data:image/png;base64"), head
                assert base64.b64decode(data, validate=True)[:2] in (b"\xff\xd8", b"\x89P")
                pictures += 1
            elif message["role"] in ("system", "developer"):
                system.append(part["text"])
            else:
                user.append(part["text"])
    return "\n".join(system), "\n".join(user), pictures


def png(width: int, height: int, text: str) -> bytes:
    """A real PNG: stripes whose colours come from the text."""
    seed = zlib.crc32(text.encode())
    rows = bytearray()
    for y in range(height):
        colour = bytes(int(127 + 120 * math.sin(seed % 97 + y * (k + 2) / 9)) for k in range(3))
        rows += b"\0" + colour * width

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b"")
    )
