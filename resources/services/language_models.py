"""`ServiceModel`: a language model behind HTTP that answers with validated structures.

Two wires: Chat Completions (OpenAI, DashScope, vLLM, Ollama, llama.cpp...) and Gemini's generateContent.
"""

import json
import re
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import httpx
from pydantic import BaseModel, ValidationError

from flymirage_core.asking import Question, strict_schema
from flymirage_core.errors import BadAnswerError, ModerationError, ServiceError
from flymirage_core.service_settings import LanguageModelSettings
from resources.services.account import Account
from resources.services.chat_wire import ChatWire
from resources.services.endpoint import Endpoint
from resources.services.gemini_wire import GeminiWire
from resources.services.ledger import Usage
from resources.services.paid import PaidQuestion, ask_paid, price_of

A = TypeVar("A", bound=BaseModel)
CHARACTERS_PER_TOKEN = 3.0
"""A low guess, so that the worst case before a call is not too small."""


@dataclass(frozen=True)
class Exchange:
    """An answer that could not be used, and what the model is told about it."""

    answer: str
    complaint: str


class Wire(Protocol):
    """How a question becomes a request, and an answer text."""

    def path(self) -> str: ...

    def headers(self, key: str) -> dict[str, str]: ...

    def body(self, question: Question, schema: dict[str, Any], exchange: Any) -> dict[str, Any]: ...

    def text(self, answer: Any) -> str: ...

    def tokens(self, answer: Any) -> tuple[int, int, int]: ...

    def explain(self, response: httpx.Response) -> ServiceError: ...


class ServiceModel:
    """Implements `flymirage_core.asking.LanguageModel`."""

    def __init__(self, service: str, settings: LanguageModelSettings, account: Account) -> None:
        self.settings, self.account = settings, account
        self.wire: Wire = GeminiWire(settings) if settings.vendor == "gemini" else ChatWire(settings)
        pace = account.pace(service, settings.pace)
        self.endpoint = Endpoint(service, settings, self.wire.headers, self.wire.explain, pace)

    @property
    def name(self) -> str:
        return self.settings.model

    def answer(self, question: Question, kind: type[A]) -> A:
        """Ask; if the answer does not validate, ask once more with the error; then give up."""
        schema = strict_schema(kind)
        first = self._request(question, schema, None)
        text = self._say(first)
        try:
            return kind.model_validate_json(unfenced(text))
        except ValidationError as error:
            complaint = complaint_about(error)
        second = self._request(question, schema, Exchange(text, complaint))
        try:
            return kind.model_validate_json(unfenced(self._say(second)))
        except ValidationError as error:
            for request in (first, second):
                self.account.forget_answer(request.key(self.endpoint))
            raise BadAnswerError(
                f"{self.name} answered the question {question.name!r} twice with something that is no valid "
                f"{kind.__name__}: {complaint_about(error)}; run the command again, or use another model"
            ) from None

    def _request(self, question: Question, schema: dict[str, Any], exchange: Exchange | None) -> PaidQuestion:
        price = price_of(self.account.settings.prices, self.settings.model)
        characters = len(question.system) + len(question.user) + len(json.dumps(schema))
        characters += 0 if exchange is None else len(exchange.answer) + len(exchange.complaint)
        worst_in = characters / CHARACTERS_PER_TOKEN + len(question.images) * self.settings.tokens_per_image
        worst = (worst_in * price.input + self.settings.max_tokens * price.output) / 1e6
        return PaidQuestion(self.wire.path(), self.wire.body(question, schema, exchange), worst, self._usage)

    def _say(self, request: PaidQuestion) -> str:
        answer = ask_paid(self.account, self.endpoint, request)
        try:
            return self.wire.text(answer)
        except BadAnswerError:
            self.account.forget_answer(request.key(self.endpoint))
            raise
        except ModerationError:
            raise
        except (KeyError, IndexError, TypeError, AttributeError):
            self.account.forget_answer(request.key(self.endpoint))
            raise BadAnswerError(
                f"{self.endpoint.name} answered without the fields of its wire (it has {sorted(answer)[:6]}): "
                f"is {self.settings.base_url} a {self.settings.vendor} server?"
            ) from None

    def _usage(self, answer: Any) -> Usage:
        price = price_of(self.account.settings.prices, self.settings.model)
        read, cached, written = self.wire.tokens(answer)
        cached_price = price.input if price.cached_input is None else price.cached_input
        usd = ((read - cached) * price.input + cached * cached_price + written * price.output) / 1e6
        return Usage(usd=usd, input_tokens=read, cached_tokens=cached, output_tokens=written)


def complaint_about(error: ValidationError) -> str:
    """The first things that are wrong, for the model to read and for people."""
    problems = [f"{'.'.join(map(str, e['loc'])) or 'the answer'}: {e['msg']}" for e in error.errors()[:4]]
    return "; ".join(problems)


def unfenced(text: str) -> str:
    """The JSON in a Markdown fence, if a model put it into one."""
    fenced = re.fullmatch(r"\s*```(?:json)?\s*(.*?)\s*```\s*", text, re.DOTALL)
    return fenced.group(1) if fenced else text
