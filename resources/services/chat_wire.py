"""The Chat Completions wire: OpenAI, DashScope's compatible mode, vLLM, Ollama, llama.cpp."""

import base64
import json
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

UNPAID = ("insufficient_quota", "Arrearage", "billing_hard_limit_reached", "AccessDenied.Unpurchased")
MODERATED = (
    "moderation_blocked",
    "content_policy_violation",
    "data_inspection_failed",
    "DataInspectionFailed",
    "content_filter",
)


class ChatWire:
    """Requests and answers of ``/chat/completions``."""

    def __init__(self, settings: LanguageModelSettings) -> None:
        self.settings = settings

    def path(self) -> str:
        return "/chat/completions"

    def headers(self, key: str) -> dict[str, str]:
        return {"Authorization": f"Bearer {key}"} if key else {}

    def body(self, question: Question, schema: dict[str, Any], exchange: Any) -> dict[str, Any]:
        settings = self.settings
        body: dict[str, Any] = {
            "model": settings.model,
            "messages": self._messages(question, schema, exchange),
            settings.token_limit_field: settings.max_tokens,
            "stream": False,
            **settings.extra_body,
        }
        if settings.temperature is not None:
            body["temperature"] = settings.temperature
        if settings.send_seed:
            body["seed"] = question.seed
        if settings.json_mode == "json_schema":
            wanted = {"name": question.name, "strict": True, "schema": schema}
            body["response_format"] = {"type": "json_schema", "json_schema": wanted}
        elif settings.json_mode == "json_object":
            body["response_format"] = {"type": "json_object"}
        return body

    def text(self, answer: Any) -> str:
        """The answer's text; raises `ModerationError` for a refusal, `BadAnswerError` for a cut-off one."""
        choice = answer["choices"][0]
        message, reason = choice["message"], choice.get("finish_reason")
        if message.get("refusal"):
            raise ModerationError(f"{self.settings.model} refused to answer: {said(message['refusal'])}")
        if reason == "content_filter":
            raise ModerationError(f"{self.settings.model}'s answer was stopped by its content filter")
        if reason == "length":
            raise BadAnswerError(
                f"{self.settings.model}'s answer was cut off at {self.settings.max_tokens} tokens: raise max_tokens"
            )
        return str(message["content"])

    def tokens(self, answer: Any) -> tuple[int, int, int]:
        """(read, cached of them, written)."""
        usage = answer.get("usage") or {}
        cached = (usage.get("prompt_tokens_details") or {}).get("cached_tokens") or 0
        return int(usage.get("prompt_tokens", 0)), int(cached), int(usage.get("completion_tokens", 0))

    def explain(self, response: httpx.Response) -> ServiceError:
        return explain_openai(self.settings.model, self.settings.key_env, response)

    def _messages(self, question: Question, schema: dict[str, Any], exchange: Any) -> list[dict[str, Any]]:
        system = question.system
        if self.settings.json_mode != "json_schema":
            system += f"\n\nAnswer with one JSON object of this JSON schema and nothing else:\n{json.dumps(schema)}"
        content: list[dict[str, Any]] = [self._picture(image) for image in question.images]
        content.append({"type": "text", "text": question.user})
        messages: list[dict[str, Any]] = [
            {"role": self.settings.system_role, "content": system},
            {"role": "user", "content": content if question.images else question.user},
        ]
        if exchange is not None:
            messages += [
                {"role": "assistant", "content": exchange.answer},
                {
                    "role": "user",
                    "content": f"That JSON cannot be used: {exchange.complaint}. Answer again, corrected.",
                },
            ]
        return messages

    def _picture(self, jpeg: bytes) -> dict[str, Any]:
        url: dict[str, Any] = {"url": f"data:image/jpeg;base64,{base64.b64encode(jpeg).decode()}"}
        if self.settings.image_detail:
            url["detail"] = self.settings.image_detail
        return {"type": "image_url", "image_url": url}


def explain_openai(model: str, key_env: str, response: httpx.Response) -> ServiceError:
    """What an error answer of OpenAI's form means, by status and code (contract, section 2.4)."""
    code, message = _error(response)
    status = response.status_code
    words = f"{model} answered {status} ({code or 'no code'}): {said(message)}"
    if code in UNPAID or status == 402:
        return QuotaError(f"{words}; the account has no credit left: top it up, then run again")
    if code in MODERATED:
        return ModerationError(words)
    if status in (401, 403):
        return KeyRefusedError(f"{words}; check the key in {key_env} and what it may use")
    if status == 404:
        return KeyRefusedError(f"{words}; check the model's id and the base URL in the settings")
    if status in (408, 409, 429) or status >= 500:
        return TransientServiceError(f"{words}; try again later", retry_after(response))
    return ServiceError(words)


def _error(response: httpx.Response) -> tuple[str, str]:
    """(code or type, message); both may be empty."""
    try:
        error = response.json().get("error") or {}
    except (ValueError, AttributeError):
        return "", response.text[:200]
    if not isinstance(error, dict):
        return "", str(error)
    if error.get("type") in UNPAID:
        return str(error["type"]), str(error.get("message", ""))
    return str(error.get("code") or error.get("type") or ""), str(error.get("message", ""))
