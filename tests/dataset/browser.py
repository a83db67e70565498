"""A headless Chromium that opens a page and tells what it logged and asked for, over its debugging protocol."""

import base64
import json
import re
import shutil
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from websockets.sync.client import ClientConnection, connect

CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
PATIENCE = 60.0
"""Seconds."""
FLAGS = ("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run")


@dataclass
class Visit:
    """What happened while a page was open."""

    errors: list[str] = field(default_factory=list)  # console errors and uncaught exceptions
    requests: list[str] = field(default_factory=list)  # URLs, of frames too
    answer: Any = None  # of the expression that was asked
    shown: bool = False  # was there a picture that showed what it should?


def visit(
    url: str,
    seconds: float,
    expression: str = "document.title",
    shows: Callable[[bytes], bool] | None = None,
    size: tuple[int, int] = (1240, 1000),
) -> Visit:
    """Open ``url``, wait, evaluate ``expression`` in it; take pictures (PNG) until one ``shows`` what it should."""
    assert CHROMIUM is not None
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        arguments = [CHROMIUM, *FLAGS, f"--user-data-dir={profile}", "--remote-debugging-port=0", "about:blank"]
        browser = subprocess.Popen(arguments, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        try:
            assert browser.stderr is not None
            found = next(m for line in browser.stderr if (m := re.search(r"listening on ws://([\d.]+:\d+)/", line)))
            with urllib.request.urlopen(f"http://{found[1]}/json/list") as answer:
                page = next(p for p in json.load(answer) if p["type"] == "page")
            with connect(page["webSocketDebuggerUrl"], max_size=None) as socket:
                session = _Session(socket)
                seen = session.visit(url, seconds, expression, size)
                if shows is not None:
                    session.look_until(shows)
                return seen
        finally:
            browser.terminate()
            browser.wait(10)


class _Session:
    def __init__(self, socket: ClientConnection) -> None:
        self._socket, self._number, self.seen = socket, 0, Visit()

    def visit(self, url: str, seconds: float, expression: str, size: tuple[int, int]) -> Visit:
        for domain in ("Log", "Runtime", "Network", "Page"):
            self._ask(f"{domain}.enable")
        metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
        self._ask("Emulation.setDeviceMetricsOverride", **metrics)
        self._ask("Page.navigate", url=url)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._listen(0.2)
        result = self._ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        self.seen.answer = result["result"].get("value")
        return self.seen

    def look_until(self, shows: Callable[[bytes], bool]) -> None:
        """A busy machine draws late: what comes within `PATIENCE` is in time."""
        end = time.monotonic() + PATIENCE
        while not self.seen.shown and time.monotonic() < end:
            self._listen(0.5)
            self.seen.shown = shows(base64.b64decode(self._ask("Page.captureScreenshot")["data"]))

    def _ask(self, method: str, **parameters: Any) -> Any:
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self._socket.recv(timeout=60))
            if message.get("id") == self._number:
                assert "error" not in message, message
                return message["result"]
            self._note(message)

    def _listen(self, seconds: float) -> None:
        try:
            self._note(json.loads(self._socket.recv(timeout=seconds)))
        except TimeoutError:
            return

    def _note(self, message: dict[str, Any]) -> None:
        body = message.get("params", {})
        match message.get("method"):
            case "Log.entryAdded" if body["entry"]["level"] == "error":
                self.seen.errors.append(body["entry"]["text"])
            case "Runtime.exceptionThrown":
                self.seen.errors.append(str(body["exceptionDetails"].get("exception", {}).get("description", body)))
            case "Runtime.consoleAPICalled" if body["type"] in ("error", "assert"):
                self.seen.errors.append(" ".join(str(a.get("value", a)) for a in body["args"]))
            case "Network.requestWillBeSent":
                self.seen.requests.append(body["request"]["url"])
