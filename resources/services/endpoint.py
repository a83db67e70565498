"""One service under one address: sending requests with its key, and what its failures mean, in one clear sentence.

Rules for a POST that costs money: it is sent again only if it certainly cost nothing - answered 429, or the connection
was never made - or, where the settings say that such answers are not billed, a 5xx. A lost answer is never a reason.
"""

import logging
import os
import re
import ssl
import time
from collections.abc import Callable, Mapping
from email.utils import parsedate_to_datetime
from functools import cache
from typing import Any

import httpx
import tenacity

from flymirage_core.errors import KeyRefusedError, ServiceError, TransientServiceError
from flymirage_core.service_settings import EndpointSettings
from resources.services.pace import Pace

Headers = Callable[[str], Mapping[str, str]]  # key -> headers
Explain = Callable[[httpx.Response], ServiceError]  # a refusal -> what it means

NEVER_SENT = (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout)


def _without_query(record: logging.LogRecord) -> bool:
    """Takes the query off the addresses that httpx logs: signatures are secrets."""
    if isinstance(record.args, tuple):
        record.args = tuple(a.copy_with(query=None) if isinstance(a, httpx.URL) else a for a in record.args)
    return True


logging.getLogger("httpx").addFilter(_without_query)


class Unanswered(Exception):  # noqa: N818 - it is no error yet: the asker decides what it means
    """A request was sent and its answer lost: nobody here knows whether it was accepted."""


class _NotNow(Exception):  # noqa: N818
    """The request certainly cost nothing and may be sent again after ``wait`` seconds (None: as the settings say)."""

    def __init__(self, error: ServiceError, wait: float | None) -> None:
        super().__init__(str(error))
        self.error, self.wait = error, wait


class Endpoint:
    """Sends requests to one service. Holds no key: it is read from the environment for each request."""

    def __init__(self, name: str, settings: EndpointSettings, headers: Headers, explain: Explain, pace: Pace) -> None:
        self.name, self.settings, self.headers, self.explain, self.pace = name, settings, headers, explain, pace

    def key(self) -> str:
        """The key; raises `KeyRefusedError` if there is none."""
        if not self.settings.key_env:
            return ""
        key = os.environ.get(self.settings.key_env, "").strip()
        if not key:
            raise KeyRefusedError(
                f"{self.name} needs a key and the environment variable {self.settings.key_env} is not set: "
                f"`export {self.settings.key_env}=...`, or use FLYMIRAGE_PROFILE=offline, which needs none"
            )
        return key

    def post_paid(self, path: str, body: Any) -> httpx.Response:
        """Send a request that costs money, at the service's pace; the answer is a success.

        Raises `Unanswered` if it may have been accepted, `ServiceError`s that say what was refused.
        """
        pace = self.settings.pace
        waits = tenacity.wait_exponential_jitter(pace.first_wait, pace.longest_wait, jitter=pace.first_wait)

        def wait(state: tenacity.RetryCallState) -> float:
            error = state.outcome.exception() if state.outcome is not None else None
            asked = error.wait if isinstance(error, _NotNow) else None
            if asked is None:
                return float(waits(state))
            self.pace.hold(asked)
            return 0.0  # the pace makes everybody wait, us too

        retrying = tenacity.Retrying(
            retry=tenacity.retry_if_exception_type(_NotNow),
            stop=tenacity.stop_after_attempt(pace.tries),
            wait=wait,
            sleep=self.pace.sleep,
            reraise=True,
        )
        tries = {"server errors": 0}
        try:
            return retrying(self._send_paid, path, body, tries)
        except _NotNow as error:
            raise error.error from None

    def get(self, path: str) -> httpx.Response:
        """Ask for something that costs nothing; tried again after network and server errors."""
        return self._free("GET", path, None)

    def get_once(self, path: str) -> httpx.Response:
        """As `get`, but the first failure counts: for looking how things are."""
        key = self.key()
        try:
            response = self._request("GET", path, None, key)
        except httpx.HTTPError as error:
            raise self._unreachable(error) from None
        if response.status_code >= 300:
            raise self._refusal(response, key)
        return response

    def post_free(self, path: str, body: Any) -> httpx.Response:
        """A POST that costs nothing and changes nothing that matters."""
        return self._free("POST", path, body)

    def _send_paid(self, path: str, body: Any, tries: dict[str, int]) -> httpx.Response:
        key = self.key()
        with self.pace.turn():
            try:
                response = self._request("POST", path, body, key)
            except NEVER_SENT as error:
                self.pace.failed()
                raise _NotNow(self._unreachable(error), None) from None
            except httpx.HTTPError as error:
                self.pace.failed()
                raise Unanswered(f"the answer of {self.name} was lost ({type(error).__name__})") from None
        if response.status_code < 300:
            self.pace.succeeded()
            return response
        refusal = self._refusal(response, key)
        if response.status_code == 429:
            if not isinstance(refusal, TransientServiceError):
                raise refusal
            raise self._wait_or_give_up(refusal)
        if response.status_code >= 500:
            self.pace.failed()
            tries["server errors"] += 1
            if tries["server errors"] < self.settings.pace.server_error_tries:
                raise _NotNow(refusal, refusal.retry_after if isinstance(refusal, TransientServiceError) else None)
        raise refusal

    def _wait_or_give_up(self, refusal: TransientServiceError) -> Exception:
        wait = refusal.retry_after
        return refusal if wait is not None and wait > self.settings.pace.longest_wait else _NotNow(refusal, wait)

    def _free(self, method: str, path: str, body: Any) -> httpx.Response:
        pace = self.settings.pace
        error: ServiceError
        for attempt in range(pace.tries):
            wait: float | None = None
            try:
                response = self._request(method, path, body, self.key())
            except httpx.HTTPError as failure:
                error = self._unreachable(failure)
            else:
                if response.status_code < 300:
                    return response
                error = self._refusal(response, self.key())
                if not isinstance(error, TransientServiceError):
                    raise error
                wait = error.retry_after
            if attempt + 1 < pace.tries:
                self.pace.sleep(min(wait or pace.first_wait * 2**attempt, pace.longest_wait))
        raise error

    def _request(self, method: str, path: str, body: Any, key: str) -> httpx.Response:
        timeout = httpx.Timeout(self.settings.read_timeout, connect=self.settings.connect_timeout)
        with httpx.Client(timeout=timeout, verify=certificates()) as client:
            url = self.settings.base_url.rstrip("/") + path
            return client.request(method, url, json=body, headers=dict(self.headers(key)))

    def _refusal(self, response: httpx.Response, key: str) -> ServiceError:
        """What a refusal means; a service that repeats the key in its words is not repeated."""
        error = self.explain(response)
        if key and key in str(error):
            error.args = (str(error).replace(key, "[key]"),)
        return error

    def _unreachable(self, error: httpx.HTTPError) -> TransientServiceError:
        where = self.settings.base_url
        return TransientServiceError(
            f"{self.name} at {where} cannot be reached ({type(error).__name__}): try again later"
        )


@cache
def certificates() -> ssl.SSLContext:
    """Which servers are trusted; reading them takes longer than many a request."""
    return httpx.create_ssl_context()


def retry_after(response: httpx.Response) -> float | None:
    """Seconds that the answer's headers ask to wait: ``retry-after-ms``, ``retry-after`` in seconds or as a date."""
    if (milliseconds := response.headers.get("retry-after-ms")) is not None and _is_number(milliseconds):
        return float(milliseconds) / 1000
    text = response.headers.get("retry-after", "")
    if _is_number(text):
        return float(text)
    try:
        return max(0.0, parsedate_to_datetime(text).timestamp() - time.time())
    except ValueError:
        return None


def said(text: Any) -> str:
    """A service's own words, fit for an error: short, one line, without URLs' queries and anything like a key."""
    line = " ".join(str(text).split())
    line = re.sub(r"(https?://[^\s?\"']+)\?[^\s\"']*", r"\1", line)
    line = re.sub(r"(?i)\b(sk|key|bearer|wlt|aiza)[-_ ]?[A-Za-z0-9_\-]{6,}", "[key]", line)
    return line if len(line) <= 300 else line[:297] + "..."


def _is_number(text: str) -> bool:
    return re.fullmatch(r"\d+(\.\d+)?", text.strip()) is not None
