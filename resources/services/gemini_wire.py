"""Gemini's generateContent wire."""

import base64
import re
from typing import Any

import httpx

from flymirage_core.asking import Question
from flymirage_core.errors import (
    BadAnswerError,
    KeyRefusedError,
    ModerationError,
    QuotaError,
    ServiceError,
    TransientServiceError,
)
from flymirage_core.service_settings import LanguageModelSettings
from resources.services.endpoint import retry_after, said

BLOCKED = {"SAFETY", "RECITATION", "PROHIBITED_CONTENT", "BLOCKLIST", "SPII", "IMAGE_SAFETY"}


class GeminiWire:
    """Requests and answers of ``models/{model}:generateContent``."""

    def __init__(self, settings: LanguageModelSettings) -> None:
        self.settings = settings

    def path(self) -> str:
        return f"/{self.settings.api_version}/models/{self.settings.model}:generateContent"

    def headers(self, key: str) -> dict[str, str]:
        return {"x-goog-api-key": key} if key else {}

    def body(self, question: Question, schema: dict[str, Any], exchange: Any) -> dict[str, Any]:
        settings = self.settings
        config: dict[str, Any] = {
            "responseMimeType": "application/json",
            "responseJsonSchema": schema,
            "maxOutputTokens": settings.max_tokens,
            "candidateCount": 1,
        }
        if settings.send_seed:
            config["seed"] = question.seed
        if settings.temperature is not None:
            config["temperature"] = settings.temperature
        if settings.thinking_level:
            config["thinkingConfig"] = {"thinkingLevel": settings.thinking_level}
        parts: list[dict[str, Any]] = [
            {"inlineData": {"mimeType": "image/jpeg", "data": base64.b64encode(jpeg).decode()}}
            for jpeg in question.images
        ]
        contents = [{"role": "user", "parts": [*parts, {"text": question.user}]}]
        if exchange is not None:
            complaint = f"That JSON cannot be used: {exchange.complaint}. Answer again, corrected."
            contents += [
                {"role": "model", "parts": [{"text": exchange.answer}]},
                {"role": "user", "parts": [{"text": complaint}]},
            ]
        return {
            "systemInstruction": {"parts": [{"text": question.system}]},
            "contents": contents,
            "generationConfig": config,
            **settings.extra_body,
        }

    def text(self, answer: Any) -> str:
        """The answer's text; raises `ModerationError` if prompt or answer was blocked, `BadAnswerError` if cut off."""
        model = self.settings.model
        candidates = answer.get("candidates") or []
        if not candidates:
            reason = (answer.get("promptFeedback") or {}).get("blockReason", "no reason given")
            raise ModerationError(f"{model} blocked the request ({reason})")
        reason = candidates[0].get("finishReason", "STOP")
        if reason in BLOCKED:
            raise ModerationError(f"{model}'s answer was blocked ({reason})")
        if reason == "MAX_TOKENS":
            raise BadAnswerError(f"{model}'s answer was cut off at {self.settings.max_tokens} tokens: raise max_tokens")
        if reason != "STOP":
            raise BadAnswerError(f"{model} stopped answering ({reason})")
        parts = candidates[0]["content"]["parts"]
        return "".join(part["text"] for part in parts if "text" in part and not part.get("thought"))

    def tokens(self, answer: Any) -> tuple[int, int, int]:
        """(read, cached of them, written); thoughts are billed as written."""
        usage = answer.get("usageMetadata") or {}
        written = int(usage.get("candidatesTokenCount", 0)) + int(usage.get("thoughtsTokenCount", 0))
        return int(usage.get("promptTokenCount", 0)), int(usage.get("cachedContentTokenCount", 0)), written

    def explain(self, response: httpx.Response) -> ServiceError:
        """What an error answer means, by its status and details (contract, section 3)."""
        error = _error(response)
        status, details = response.status_code, error.get("details") or []
        words = f"{self.settings.model} answered {status} ({error.get('status', '')}): {said(error.get('message', ''))}"
        reasons = {str(d.get("reason", "")) for d in details if isinstance(d, dict)}
        if status in (401, 403) or "API_KEY_INVALID" in reasons:
            return KeyRefusedError(f"{words}; check the key in {self.settings.key_env} and what it may use")
        if status == 404:
            return KeyRefusedError(f"{words}; check the model's id and services' api_version")
        if status == 429 and "PerDay" in str(details):
            return QuotaError(f"{words}; the day's quota is used up")
        if status in (408, 429) or status >= 500:
            return TransientServiceError(f"{words}; try again later", retry_after(response) or _retry_info(details))
        return ServiceError(words)


def _error(response: httpx.Response) -> dict[str, Any]:
    try:
        error = response.json().get("error")
    except (ValueError, AttributeError):
        error = None
    return error if isinstance(error, dict) else {"message": response.text[:200]}


def _retry_info(details: list[Any]) -> float | None:
    """Seconds of a google.rpc.RetryInfo, if there is one."""
    for detail in details:
        delay = (
            re.fullmatch(r"(\d+(?:\.\d+)?)s", str(detail.get("retryDelay", ""))) if isinstance(detail, dict) else None
        )
        if delay:
            return float(delay.group(1))
    return None
