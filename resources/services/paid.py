"""One paid question and its answer: read from what was paid before, or booked, sent once, kept, settled."""

import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import httpx

from flymirage_core.errors import BadAnswerError, ServiceError, TransientServiceError
from flymirage_core.service_settings import PriceSettings, TokenPrice
from resources.faults import fault_point
from resources.services.account import Account, request_key
from resources.services.endpoint import Endpoint, Unanswered
from resources.services.ledger import Call, Usage


@dataclass(frozen=True)
class PaidQuestion:
    """A request with what it may cost, and how to read from its answer what it did cost."""

    path: str
    body: Any
    worst_usd: float
    usage: Callable[[Any], Usage]

    def key(self, endpoint: Endpoint) -> str:
        """Names the request by its content; the address is no part of it, so a moved server costs nothing."""
        return request_key(endpoint.name, [endpoint.settings.model, self.path, self.body])


def ask_paid(account: Account, endpoint: Endpoint, question: PaidQuestion) -> Any:
    """The parsed JSON of the answer; an answer that was paid for before is not paid for again.

    Raises `TransientServiceError` if the answer was lost: the call then stays booked at its worst.
    """
    key = question.key(endpoint)
    kept = account.paid_answer(key)
    if kept is not None:
        account.ledger.settle(kept["call"], question.usage(kept["answer"]))
        return kept["answer"]
    price = price_of(account.settings.prices, endpoint.settings.model)
    call_id = f"{key}#{uuid.uuid4().hex[:8]}"
    account.ledger.book(
        Call(
            call_id,
            account.scene,
            account.asset,
            endpoint.name,
            endpoint.settings.model,
            question.worst_usd,
            price.as_of,
        )
    )
    fault_point("call booked")
    try:
        response = endpoint.post_paid(question.path, question.body)
    except Unanswered as lost:
        raise TransientServiceError(
            f"{lost}; it may have been charged, so the ledger counts it at its worst (${question.worst_usd:.3f}): "
            "run the command again to ask anew"
        ) from None
    except ServiceError:
        account.ledger.release(call_id)
        raise
    answer = json_of(endpoint.name, response)
    account.keep_answer(key, {"call": call_id, "answer": answer})
    fault_point("answer kept")
    account.ledger.settle(call_id, question.usage(answer))
    return answer


def price_of(prices: PriceSettings, model: str) -> TokenPrice:
    """The price of a model; raises `ServiceError` for one that has none: the caps could not hold."""
    price = prices.of(model)
    if price is None:
        raise ServiceError(
            f"model {model!r} has no price, so no cap could hold: add it to services.prices.tokens "
            f'(FLYMIRAGE_SERVICES__PRICES__TOKENS=\'{{"{model}": {{"input": 0, "output": 0, "as_of": "2026-11"}}}}\' '
            "for a model of your own)"
        )
    return price


def json_of(service: str, response: httpx.Response) -> Any:
    """The answer's JSON object; raises `BadAnswerError` if it is none."""
    try:
        answer = response.json()
    except ValueError:
        answer = None
    if not isinstance(answer, dict):
        kind = response.headers.get("content-type", "no type")
        raise BadAnswerError(
            f"{service} answered with something that is no JSON object ({len(response.content)} bytes of {kind}): "
            "is the base URL right?"
        )
    return answer
