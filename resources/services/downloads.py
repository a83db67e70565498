"""Downloads that carry on where they were cut: by HTTP ranges, checked by size. No key is ever sent along."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import httpx

from flymirage_core.errors import TransientServiceError
from resources.services.endpoint import certificates


class StaleUrlError(Exception):
    """The address does not answer any more; a fresh one is needed."""


@dataclass(frozen=True)
class Downloader:
    """How patient downloads are."""

    timeout: float
    tries: int
    pause: float = 1.0
    sleep: Callable[[float], None] = time.sleep

    def fetch(self, url: str, path: Path) -> Path:
        """Bring ``url`` to ``path``, starting from what is already in ``path.part``.

        Raises `StaleUrlError` if the address is refused, `TransientServiceError` if it cannot be brought whole.
        """
        part = path.with_name(path.name + ".part")
        path.parent.mkdir(parents=True, exist_ok=True)
        for attempt in range(self.tries):
            if attempt:
                self.sleep(min(self.pause * 2**attempt, 30.0))
            try:
                if self._carry_on(url, part):
                    part.replace(path)
                    return path
            except httpx.HTTPError:
                continue
        size = part.stat().st_size if part.exists() else 0
        raise TransientServiceError(
            f"the download of {path.name} from {urlsplit(url).netloc} broke off {self.tries} times ({size} bytes are "
            "kept): run the command again to carry on"
        )

    def _carry_on(self, url: str, part: Path) -> bool:
        """Append what is missing; True once the file has the size that the server announced."""
        have = part.stat().st_size if part.exists() else 0
        headers = {"Accept-Encoding": "identity", **({"Range": f"bytes={have}-"} if have else {})}
        with (
            httpx.Client(timeout=self.timeout, follow_redirects=True, verify=certificates()) as client,
            client.stream("GET", url, headers=headers) as response,
        ):
            if response.status_code in (401, 403, 404, 410):
                raise StaleUrlError(f"{urlsplit(url).netloc} answered {response.status_code}")
            if response.status_code == 416:  # what we have is no part of this file
                part.unlink()
                return False
            response.raise_for_status()
            resumed = response.status_code == 206
            total = _announced(response, have if resumed else 0)
            with part.open("ab" if resumed else "wb") as file:
                for chunk in response.iter_raw():
                    file.write(chunk)
        size = part.stat().st_size
        if total is not None and size > total:
            part.unlink()  # another file under the same address
            return False
        return total is None or size == total


def _announced(response: httpx.Response, offset: int) -> int | None:
    """Size of the whole file, if the server says it."""
    _, _, total = response.headers.get("content-range", "").partition("/")
    if total.isdigit():
        return int(total)
    length = response.headers.get("content-length", "")
    return offset + int(length) if length.isdigit() else None
