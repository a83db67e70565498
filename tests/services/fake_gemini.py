"""A fake of Gemini's generateContent: accepts camelCase and snake_case, as the proto-JSON server does."""

import json
import re
from collections.abc import Callable
from typing import Any

from fake_http import FakeService, Reply, Request

THINKING = {"MINIMAL", "LOW", "MEDIUM", "HIGH", "XHIGH"}
CONFIG_FIELDS = {
    "responseMimeType",
    "responseJsonSchema",
    "responseSchema",
    "maxOutputTokens",
    "seed",
    "candidateCount",
    "temperature",
    "thinkingConfig",
}


class FakeGemini(FakeService):
    """``{url}/{v1|v1beta}/models/{model}:generateContent`` and ``GET .../models/{model}``."""

    def __init__(self, answerer: Callable[[str, str, int, dict[str, Any] | None], Any], key: str = "AIza-test") -> None:
        super().__init__()
        self.answerer, self.key = answerer, key
        self.models = ["gemini-3.1-pro-preview", "gemini-3.1-flash-lite"]
        self.charged_calls = 0

    def handle(self, request: Request) -> Reply:
        if request.headers.get("x-goog-api-key") != self.key:
            shown = request.headers.get("x-goog-api-key", "")
            reason = {"@type": "type.googleapis.com/google.rpc.ErrorInfo", "reason": "API_KEY_INVALID"}
            return self.error(400, f"API key not valid: {shown}", "INVALID_ARGUMENT", [reason])
        match = re.fullmatch(r"/v1(?:beta)?/models/([^/:]+)(:generateContent)?", request.path)
        if match is None or match[1] not in self.models:
            return self.error(404, f"{request.path} is not found for API version v1beta", "NOT_FOUND")
        if match[2] is None:
            return Reply(body={"name": f"models/{match[1]}", "version": "001", "displayName": match[1]})
        return self._generate(match[1], _camel(request.json))

    def error(self, status: int, message: str, name: str, details: list[Any] | None = None) -> Reply:
        error = {"code": status, "message": message, "status": name, **({"details": details} if details else {})}
        return Reply(status, {"error": error})

    def out_of_breath(self, seconds: float) -> Reply:
        """RESOURCE_EXHAUSTED with RetryInfo."""
        info = {"@type": "type.googleapis.com/google.rpc.RetryInfo", "retryDelay": f"{seconds:g}s"}
        return self.error(429, "You exceeded your current quota", "RESOURCE_EXHAUSTED", [info])

    def _generate(self, model: str, body: dict[str, Any]) -> Reply:
        config = body.get("generationConfig", {})
        unknown = set(config) - CONFIG_FIELDS
        if unknown:
            return self.error(400, f'Unknown name "{sorted(unknown)[0]}" at generation_config', "INVALID_ARGUMENT")
        if "responseSchema" in config and "responseJsonSchema" in config:
            return self.error(400, "responseSchema and responseJsonSchema are exclusive", "INVALID_ARGUMENT")
        if (level := config.get("thinkingConfig", {}).get("thinkingLevel")) not in {None, *THINKING}:
            return self.error(400, f"Invalid value {level} for thinking_level", "INVALID_ARGUMENT")
        parts = [part for content in body["contents"] for part in content["parts"]]
        texts = [p["text"] for p in parts if "text" in p]
        pictures = sum("inlineData" in p for p in parts)
        system = "".join(p["text"] for p in body.get("systemInstruction", {}).get("parts", []))
        schema = config.get("responseJsonSchema")
        said = self.answerer(system, "\n".join(texts), pictures, schema)
        if isinstance(said, Reply):
            return said
        self.charged_calls += 1
        return Reply(body=self.candidates(model, said if isinstance(said, str) else json.dumps(said)))

    def candidates(self, model: str, text: str, finish: str = "STOP") -> dict[str, Any]:
        content = {"role": "model", "parts": [{"text": text, "thoughtSignature": "c2ln"}]}
        return {
            "candidates": [{"content": content, "finishReason": finish, "index": 0, "safetyRatings": []}],
            "usageMetadata": {
                "promptTokenCount": 900,
                "candidatesTokenCount": len(text) // 4,
                "thoughtsTokenCount": 300,
                "totalTokenCount": 1200 + len(text) // 4,
                "promptTokensDetails": [{"modality": "TEXT", "tokenCount": 900}],
            },
            "modelVersion": model,
            "responseId": "fake",
        }

    def blocked(self, reason: str = "SAFETY") -> dict[str, Any]:
        """The prompt itself is blocked: 200 without candidates."""
        usage = {"promptTokenCount": 900, "totalTokenCount": 900}
        return {
            "promptFeedback": {"blockReason": reason},
            "usageMetadata": usage,
            "modelVersion": "gemini-3.1-pro-preview",
        }


def _camel(value: Any, is_schema: bool = False) -> Any:
    """Keys in camelCase, except inside of schemas."""
    if isinstance(value, dict) and not is_schema:
        renamed = {re.sub(r"_([a-z])", lambda m: m[1].upper(), k): v for k, v in value.items()}
        return {k: _camel(v, k in ("responseJsonSchema", "responseSchema")) for k, v in renamed.items()}
    if isinstance(value, list) and not is_schema:
        return [_camel(v) for v in value]
    return value
