"""A fake outside service: a real HTTP server on this machine, with faults that a test can switch on."""

import json
import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import urlsplit


@dataclass(frozen=True)
class Request:
    method: str
    path: str
    query: str
    headers: dict[str, str]  # names in lower case
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


@dataclass(frozen=True)
class Reply:
    """An answer; ``drop`` closes the connection instead, ``cut`` closes it after so many bytes of the body."""

    status: int = 200
    body: Any = None  # bytes, or something for JSON
    headers: dict[str, str] = field(default_factory=dict)
    drop: bool = False
    cut: int | None = None
    delay: float = 0.0


@dataclass
class Fault:
    """The next ``times`` requests whose path matches get ``reply``; with ``after``, they are carried out first."""

    path: str
    reply: Reply
    times: int = 1
    after: bool = False


class FakeService:
    """Serves `handle` on a free port of 127.0.0.1; a context manager."""

    def __init__(self) -> None:
        self.requests: list[Request] = []
        self.faults: list[Fault] = []
        self.lock = threading.RLock()
        self.clock_skew = 0.0  # of the Date header, seconds
        self.clock: Callable[[], float] = time.time
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}"
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()

    def __enter__(self) -> "FakeService":
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()

    def handle(self, request: Request) -> Reply:
        raise AssertionError("a fake answers something")

    def fail(self, path: str, reply: Reply, times: int = 1, after: bool = False) -> None:
        """Switch a fault on."""
        with self.lock:
            self.faults.append(Fault(path, reply, times, after))

    def asked(self, path: str) -> list[Request]:
        """The requests so far whose path matches."""
        with self.lock:
            return [r for r in self.requests if re.search(path, r.path)]

    def answer(self, request: Request) -> Reply:
        with self.lock:
            self.requests.append(request)
            fault = next((f for f in self.faults if f.times > 0 and re.search(f.path, request.path)), None)
            if fault is not None:
                fault.times -= 1
                if not fault.after:
                    return fault.reply
            reply = self.handle(request)
            return reply if fault is None else fault.reply

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        service = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def _serve(self) -> None:
                split = urlsplit(self.path)
                body = self.rfile.read(int(self.headers.get("content-length") or 0))
                headers = {k.lower(): v for k, v in self.headers.items()}
                reply = service.answer(Request(self.command, split.path, split.query, headers, body))
                time.sleep(reply.delay)
                if reply.drop:
                    self.close_connection = True
                    self.connection.close()
                    return
                is_bytes = isinstance(reply.body, bytes)
                data = reply.body if is_bytes else b"" if reply.body is None else json.dumps(reply.body).encode()
                self.send_response(reply.status)
                names = {k.lower() for k in reply.headers}
                if "content-type" not in names:
                    self.send_header("content-type", "application/octet-stream" if is_bytes else "application/json")
                for name, value in reply.headers.items():
                    self.send_header(name, value)
                self.send_header("content-length", str(len(data)))
                self.end_headers()
                self.wfile.write(data[: reply.cut])
                if reply.cut is not None:
                    self.close_connection = True

            def handle_one_request(self) -> None:
                try:
                    super().handle_one_request()
                except (ConnectionError, ValueError, OSError):  # the client is gone (tests kill it)
                    self.close_connection = True

            do_GET = do_POST = do_PUT = do_DELETE = do_HEAD = _serve  # noqa: N815

            def date_time_string(self, timestamp: float | None = None) -> str:
                return super().date_time_string((timestamp or time.time()) + service.clock_skew)

            def log_message(self, *_: object) -> None:
                return

        return Handler
