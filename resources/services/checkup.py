"""Are the services ready? Keys, models, balance and clock by calls that cost nothing, and what a scene will cost."""

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from email.utils import parsedate_to_datetime
from typing import Literal

import httpx

from flymirage_core.errors import FlyMirageError, KeyRefusedError, ServiceError
from flymirage_core.service_settings import EndpointSettings, LanguageModelSettings, PriceSettings
from flymirage_core.settings import Settings
from resources.services.account import Account
from resources.services.endpoint import Endpoint
from resources.services.language_models import ServiceModel
from resources.services.marble import MarbleWorldModel
from resources.services.paid import price_of
from resources.services.painter import ServicePainter
from resources.store import Store
from resources.tools import is_service

Severity = Literal["ok", "warning", "problem"]
PAPER_USD = 2.0
"""What a scene cost the paper's authors, about (section IV)."""
CLOCK_SKEW = 60.0
"""Seconds by which this machine's clock may be wrong: signed addresses are good for minutes."""


@dataclass(frozen=True)
class Check:
    """One thing that was looked at, in plain words."""

    severity: Severity
    sentence: str


@dataclass(frozen=True)
class CostLine:
    """What one step of a scene costs in US dollars: at least, usually, at most."""

    item: str
    arithmetic: str
    low: float
    usual: float
    high: float


def check_services(settings: Settings, store: Store) -> Iterator[Check]:
    """One check after the other for each service that the settings use; only free calls are made."""
    services = settings.services
    account = Account(store, "_doctor", "_doctor", services)
    ports = ("scene_writer", "image_painter", "world_model", "frame_judge", "prompter")
    used = [port for port in ports if is_service(settings, port)]
    if not used:
        yield Check("ok", "profile offline: no service is used; FLYMIRAGE_PROFILE=paper uses all of them")
        return
    if "scene_writer" in used:
        yield from _check_model("writer", ServiceModel("writer", services.writer, account).endpoint, services.writer)
    if "image_painter" in used:
        yield from _check_model("images", ServicePainter(services.painter, account).endpoint, services.painter)
    if "world_model" in used:
        yield from _check_marble(settings, account)
    if {"frame_judge", "prompter"} & set(used):
        yield from _check_model("vlm", ServiceModel("vlm", services.vlm, account).endpoint, services.vlm)
    yield from _check_prices(settings, used)
    yield from _check_budget(account)


def _check_model(service: str, endpoint: Endpoint, settings: EndpointSettings) -> Iterator[Check]:
    path = f"/models/{settings.model}"
    if isinstance(settings, LanguageModelSettings) and settings.vendor == "gemini":
        path = f"/{settings.api_version}{path}"
    try:
        response = endpoint.get_once(path)
    except KeyRefusedError as error:
        missing = bool(settings.key_env) and not os.environ.get(settings.key_env)
        if not missing and "404" in str(error):
            yield Check("warning", f"{service}: the key is taken, but {settings.model} is not listed: {error}")
        else:
            yield Check("problem", str(error))
        return
    except FlyMirageError as error:
        yield Check("problem", str(error))
        return
    yield Check(
        "ok", f"{service}: {settings.model} at {settings.base_url} takes the key in {settings.key_env or 'none'}"
    )
    yield from _check_clock(service, response)


def _check_marble(settings: Settings, account: Account) -> Iterator[Check]:
    marble = settings.services.marble
    api = MarbleWorldModel(marble, settings.cleaning, account).api
    try:
        response = api.endpoint.get_once("/marble/v1/credits")
        credits = float(response.json()["remaining_credits"])
    except (FlyMirageError, ValueError, KeyError) as error:
        yield Check("problem", str(error))
        return
    worlds = int(credits // marble.worst_credits)
    usd = credits / settings.services.prices.marble_credits_per_usd
    yield Check(
        "ok" if worlds else "problem",
        f"marble: {credits:.0f} credits (${usd:.2f}), enough for {worlds} worlds of {marble.model} at their worst "
        f"({marble.worst_credits} credits)",
    )
    yield from _check_clock("marble", response)


def _check_clock(service: str, response: httpx.Response) -> Iterator[Check]:
    """The server's clock beside ours; no server that is right says nothing."""
    stamp = response.headers.get("date")
    if stamp is None:
        return
    skew = time.time() - parsedate_to_datetime(stamp).timestamp()
    if abs(skew) > CLOCK_SKEW:
        yield Check(
            "warning", f"this machine's clock is {skew:+.0f} s from {service}'s: signed addresses may be refused"
        )


def _check_prices(settings: Settings, used: list[str]) -> Iterator[Check]:
    services = settings.services
    models = {"scene_writer": services.writer.model, "image_painter": services.painter.model}
    models |= {"frame_judge": services.vlm.model, "prompter": services.vlm.model}
    for model in sorted({models[port] for port in used if port in models}):
        try:
            price_of(services.prices, model)
        except ServiceError as error:
            yield Check("problem", str(error))


def _check_budget(account: Account) -> Iterator[Check]:
    ledger, budget = account.ledger, account.settings.budget
    night, month = ledger.spent(since=ledger.night_start()).usd, ledger.spent(since=ledger.month_start()).usd
    yield Check(
        "ok" if night < budget.night_usd and month < budget.month_usd else "problem",
        f"budget: ${night:.2f} of ${budget.night_usd:.2f} spent this night, ${month:.2f} of ${budget.month_usd:.2f} "
        f"this month; at most ${budget.scene_usd:.2f} a scene",
    )


def scene_cost(settings: Settings) -> list[CostLine]:
    """One scene's bill by the settings' models and prices; tokens are typical counts, not measured ones."""
    services, prices = settings.services, settings.services.prices
    flights = settings.tasks.sets * settings.tasks.targets_per_set
    lines: list[CostLine] = []
    if is_service(settings, "scene_writer"):
        lines.append(_tokens("description", prices, services.writer.model, 1, 2400, 3500))
    if is_service(settings, "image_painter"):
        written = {"low": 160, "medium": 1400, "high": 5500, "auto": 5500}[services.painter.quality]
        lines.append(_tokens("image", prices, services.painter.model, 1, 200, written))
    if is_service(settings, "world_model"):
        rate = prices.marble_credits_per_usd
        low, usual, high = (credits / rate for credits in (1580, 2280, services.marble.worst_credits))
        arithmetic = f"(80 + 1500 + 0...1500) credits / {rate:.0f}"
        lines.append(CostLine(f"world ({services.marble.model})", arithmetic, low, usual, high))
    if is_service(settings, "frame_judge"):
        lines.append(_tokens("verdicts", prices, services.vlm.model, flights, 3200, 150))
    if is_service(settings, "prompter"):
        lines.append(_tokens("prompts", prices, services.vlm.model, flights, 4200, 120))
    sums = [sum(getattr(line, name) for line in lines) for name in ("low", "usual", "high")]
    return [*lines, CostLine("all", f"the paper: about ${PAPER_USD:.0f}", *sums)]


def _tokens(item: str, prices: PriceSettings, model: str, calls: int, read: int, written: int) -> CostLine:
    price = prices.of(model)
    if price is None:
        return CostLine(f"{item} ({model})", "no price is known", 0.0, 0.0, 0.0)
    usd = calls * (read * price.input + written * price.output) / 1e6
    times = f"{calls} x " if calls > 1 else ""
    arithmetic = f"{times}({read} x ${price.input:g} + {written} x ${price.output:g}) / 1M"
    return CostLine(f"{item} ({model})", arithmetic, usd, usd, usd)
