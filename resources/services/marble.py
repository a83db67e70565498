"""`MarbleWorldModel`: worlds by World Labs' Marble, none of them paid for twice.

Marble knows no idempotency key. So each start has a deterministic key in its tags and a journal that is durable before
the start is sent; a lost answer is looked for by that tag, and by the balance, before anything is sent again.
"""

import base64
import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from filelock import FileLock, Timeout

from flymirage_core.asking import load_template
from flymirage_core.errors import (
    BadAnswerError,
    LostStartError,
    QuotaError,
    ServiceError,
    TransientServiceError,
)
from flymirage_core.rendering.picture import ScenePicture
from flymirage_core.scene.description import SceneDescription
from flymirage_core.scene.keys import rng
from flymirage_core.service_settings import MarbleSettings
from flymirage_core.settings import CleaningSettings
from flymirage_core.splats.world import World
from resources.faults import fault_point
from resources.services.account import Account
from resources.services.downloads import Downloader, StaleUrlError
from resources.services.endpoint import Unanswered
from resources.services.ledger import Call, Usage
from resources.services.marble_api import SERVICE, AmbiguousError, MarbleApi, MarbleWorld, NotFoundError
from resources.services.marble_journal import Journal, Journals, KeptFile
from resources.services.marble_world import world_from_originals

SEEDS = 2**32
FRESH_URLS = 3
"""How often a world is asked for fresh addresses of its files."""


@dataclass(frozen=True)
class Start:
    """What a world is asked for; the same start has the same key."""

    scene: str
    text: str
    picture: ScenePicture
    model: str
    seed: int
    attempt: int

    @property
    def key(self) -> str:
        """At most 32 characters, as tags may have."""
        pixels = hashlib.sha256(repr(self.picture.rgb.shape).encode() + self.picture.rgb.tobytes()).hexdigest()
        content = "\0".join([self.scene, pixels, self.text, self.model, str(self.seed), str(self.attempt)])
        return "fm-" + base64.b32encode(hashlib.sha256(content.encode()).digest()).decode()[:26].lower()


class MarbleWorldModel:
    """Implements `flymirage_core.worldgen.ports.WorldModel`."""

    def __init__(
        self,
        settings: MarbleSettings,
        cleaning: CleaningSettings,
        account: Account,
        sleep: Callable[[float], None] = time.sleep,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self.settings, self.cleaning, self.account = settings, cleaning, account
        self.sleep, self.clock = sleep, clock
        self.template = load_template("flymirage_core.scene", "world_prompt")
        self.api = MarbleApi(settings, account.pace(SERVICE, settings.pace))
        self.journals = Journals(account.store, account.scene)

    @property
    def name(self) -> str:
        return f"{self.settings.model} (prompt {self.template.fingerprint()})"

    def build(self, description: SceneDescription, picture: ScenePicture) -> World:
        """The world of a description and its picture; one that was paid for before costs nothing.

        Raises `ServiceError`s; `LostStartError` if a start was sent, its answer lost, and no trace of it found.
        """
        failures: list[str] = []
        for attempt in range(self.settings.attempts):
            start = self._start_of(description, picture, attempt)
            journal = self._brought(start)
            if journal.state == "kept":
                return self._world(journal)
            failures.append(journal.failure)
        raise ServiceError(
            f"marble could not make the world of scene {description.scene!r} in {len(failures)} attempts, each with "
            f"another seed; the last time: {failures[-1]}; give the scene another description or key"
        )

    def _start_of(self, description: SceneDescription, picture: ScenePicture, attempt: int) -> Start:
        text = self.template.text({"world_prompt": description.world_prompt or description.prose})
        if self.settings.text_limit:
            text = text[: self.settings.text_limit]
        seed = int(rng(description.scene, "marble", attempt).integers(SEEDS))
        return Start(description.scene, text, picture, self.settings.model, seed, attempt)

    def _brought(self, start: Start) -> Journal:
        """The start's journal, carried on to `kept` or `failed`. One process at a time works on a start."""
        locks = self.account.database.folder / "locks"
        locks.mkdir(parents=True, exist_ok=True)
        try:
            with FileLock(locks / f"{start.key}.lock", timeout=self.settings.poll_budget):
                journal = self.journals.load(start.key) or self._submit(start)
                if journal.state == "submitting":
                    journal = self._find_or_resubmit(start, journal)
                if journal.state == "submitting":
                    raise TransientServiceError(
                        f"marble's answer to the start of scene {start.scene!r} was lost again: run the command again, "
                        "it looks for the world first"
                    )
                if journal.state == "running":
                    journal = self._wait(journal)
                if journal.state == "made":
                    journal = self._keep(journal)
                self._settle(journal)
                return journal
        except Timeout:
            raise TransientServiceError(
                f"another process has been making the world of scene {start.scene!r} for "
                f"{self.settings.poll_budget:.0f} s: run the command again"
            ) from None

    # Starting -------------------------------------------------------------------------------------------------------

    def _submit(self, start: Start) -> Journal:
        """Send the start. The journal is durable before; a start that was certainly refused leaves none."""
        balance = self._book(start)
        try:
            body = self._body(start, self.api.upload(_png(start.picture), start.key))
        except ServiceError:
            self.account.ledger.release(start.key)
            raise
        journal = Journal(key=start.key, state="submitting", started_at=self.clock(), balance_before=balance)
        self.journals.save(journal)
        fault_point("marble submitting")
        try:
            operation = self.api.generate(body)
        except (Unanswered, AmbiguousError):
            return journal  # it may have been accepted: look for it
        except ServiceError:
            self.journals.forget(start.key)
            self.account.ledger.release(start.key)
            raise
        fault_point("marble accepted")
        return self.journals.save(
            journal.with_(state="running", operation_id=operation.operation_id, world_id=operation.world_id)
        )

    def _book(self, start: Start) -> float:
        """Book the worst case and see that the balance covers it, beside other worlds in the making; the balance."""
        settings, ledger = self.settings, self.account.ledger
        prices = self.account.settings.prices
        worst = settings.worst_credits / prices.marble_credits_per_usd
        ledger.book(Call(start.key, start.scene, self.account.asset, SERVICE, start.model, worst, prices.marble_as_of))
        try:
            balance = self.api.credits()
            needed = settings.worst_credits * ledger.unsettled(SERVICE)
            if balance < needed:
                raise QuotaError(
                    f"marble's balance is {balance:.0f} credits; worlds in the making and this one may cost "
                    f"{needed}: nothing was started; buy credits, then run again"
                )
        except ServiceError:
            ledger.release(start.key)
            raise
        return balance

    def _body(self, start: Start, image: dict[str, str]) -> dict[str, Any]:
        prompt: dict[str, Any] = {
            "type": "image",
            "image_prompt": image,
            "text_prompt": start.text,
            "disable_recaption": self.settings.disable_recaption,
        }
        pano = {"omit": None, "auto": "auto", "true": True, "false": False}[self.settings.is_pano]
        if pano is not None:
            prompt["is_pano"] = pano
        return {
            "world_prompt": prompt,
            "model": start.model,
            "display_name": f"flymirage {start.scene}"[:64],
            "seed": start.seed,
            "tags": ["flymirage", start.key],
            "permission": {"public": False, "allow_id_access": False, "allowed_readers": [], "allowed_writers": []},
        }

    # A start whose answer was lost ----------------------------------------------------------------------------------

    def _find_or_resubmit(self, start: Start, journal: Journal) -> Journal:
        """Look for the world by its tag, several times; found nowhere, ask a person, or start it again if told to."""
        for look in range(self.settings.lost_start_looks):
            if look:
                self.sleep(self.settings.lost_start_wait)
            world_id = self._listed(start.key)
            if world_id:
                return self.journals.save(journal.with_(state="running", world_id=world_id, adopted=True))
        fallen = journal.balance_before - self.api.credits()
        if self.settings.resubmit_after_lost_start == "ask":
            raise LostStartError(
                f"the start of the world of scene {start.scene!r} was sent and its answer lost; "
                f"{self.settings.lost_start_looks} looks for the tag {start.key} found no world, and the balance has "
                f"fallen by {fallen:.0f} credits since: look at Marble's site; if there is no world, run again with "
                "FLYMIRAGE_SERVICES__MARBLE__RESUBMIT_AFTER_LOST_START=auto"
            )
        self.journals.forget(start.key)
        return self._submit(start)

    def _listed(self, key: str) -> str:
        """The world with this tag, whatever its state; "" if there is none."""
        for status in self.settings.list_statuses:
            worlds = self.api.worlds_tagged(key, status)
            if worlds:
                return worlds[0]
        return ""

    # Waiting --------------------------------------------------------------------------------------------------------

    def _wait(self, journal: Journal) -> Journal:
        """Poll until the world is made or has failed; what is learnt on the way is written down."""
        deadline = self.clock() + self.settings.poll_budget
        while True:
            before = journal
            journal = self._polled(journal)
            if journal != before:
                self.journals.save(journal)
                fault_point(f"marble {journal.state}")
            if journal.state != "running":
                return journal
            if self.clock() > deadline:
                raise TransientServiceError(
                    f"marble is still making the world of scene {self.account.scene!r} after "
                    f"{self.settings.poll_budget:.0f} s: run the command again to carry on waiting",
                    retry_after=self.settings.poll_seconds,
                )
            self.sleep(self.settings.poll_seconds)

    def _polled(self, journal: Journal) -> Journal:
        """One look: by operation while that is known, else by world; an operation may expire."""
        if journal.operation_id:
            try:
                operation = self.api.operation(journal.operation_id)
            except NotFoundError:
                return journal.with_(operation_id="", world_id=journal.world_id or self._listed(journal.key))
            journal = journal.with_(world_id=operation.world_id or journal.world_id)
            if operation.done and operation.error is not None:
                return journal.with_(state="failed", failure=operation.error.message or "no reason given")
            if operation.done:
                credits = operation.cost.total_credits if operation.cost is not None else None
                return journal.with_(state="made", credits=credits)
            return journal
        if not journal.world_id:
            world_id = self._listed(journal.key)
            if not world_id and self.api.worlds_tagged(journal.key, "FAILED"):
                return journal.with_(state="failed", failure="it is listed as failed")
            return journal.with_(world_id=world_id)
        if self.api.world(journal.world_id).spz_urls:
            return journal.with_(state="made")
        if self.api.worlds_tagged(journal.key, "FAILED"):
            return journal.with_(state="failed", failure="it is listed as failed")
        return journal

    # Bringing it home -----------------------------------------------------------------------------------------------

    def _keep(self, journal: Journal) -> Journal:
        """Bring the originals into the store. Addresses are never written down; stale ones are asked for anew."""
        folder = self.account.database.folder / "downloads" / journal.key
        world = self._finished(journal)
        files = {name: self._download(journal, name, folder / name) for name in self._urls(world)}
        fault_point("marble downloaded")
        for name, data in files.items():
            self.journals.keep_file(journal.key, name, data)
        kept = tuple(KeptFile(name=n, size=len(d), sha256=hashlib.sha256(d).hexdigest()) for n, d in files.items())
        assets, credits = world.assets, journal.credits
        splats = assets.splats if assets is not None else None
        journal = self.journals.save(
            journal.with_(
                state="kept",
                files=kept,
                caption=(assets.caption if assets is not None else None) or "",
                semantics=splats.semantics_metadata if splats is not None else None,
                resolution=self._resolution(world),
                credits=self._by_balance(journal) if credits is None else credits,
            )
        )
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()
        return journal

    def _download(self, journal: Journal, name: str, path: Path) -> bytes:
        """One original; what an earlier run brought of it is not brought again."""
        settings, reason = self.settings, ""
        downloader = Downloader(
            settings.download_timeout, settings.download_tries, settings.pace.first_wait, sleep=self.sleep
        )
        for _ in range(FRESH_URLS):
            if path.exists():  # it has this name only when it is whole
                return path.read_bytes()
            try:
                downloader.fetch(self._urls(self._finished(journal))[name], path)
            except StaleUrlError as stale:
                reason = str(stale)
        if path.exists():
            return path.read_bytes()
        raise TransientServiceError(f"marble's addresses of {name} stay refused ({reason}): try again later")

    def _finished(self, journal: Journal) -> MarbleWorld:
        """The world with its addresses; some answers come before the files do."""
        for _ in range(FRESH_URLS):
            world = self.api.world(journal.world_id)
            if world.spz_urls:
                return world
            self.sleep(self.settings.poll_seconds)
        raise BadAnswerError(f"marble says that world {journal.world_id} is made, but names no splat file of it")

    def _resolution(self, world: MarbleWorld) -> str:
        return next((n for n in self.settings.splats if n in world.spz_urls), next(iter(world.spz_urls)))

    def _urls(self, world: MarbleWorld) -> dict[str, str]:
        urls = {"world.spz": world.spz_urls[self._resolution(world)]}
        assets = world.assets
        if assets is not None and assets.mesh is not None and assets.mesh.collider_mesh_url:
            urls["collider.glb"] = assets.mesh.collider_mesh_url
        if assets is not None and assets.imagery is not None and assets.imagery.pano_url:
            urls["panorama.png"] = assets.imagery.pano_url
        return urls

    def _by_balance(self, journal: Journal) -> int | None:
        """What a world cost whose operation is gone: the fall of the balance, if no other world was booked since."""
        if self.account.ledger.others_since(SERVICE, journal.key, journal.started_at):
            return None
        fallen = round(journal.balance_before - self.api.credits())
        return fallen if 0 < fallen <= self.settings.worst_credits else None

    def _settle(self, journal: Journal) -> None:
        credits = self.settings.failed_credits if journal.state == "failed" else journal.credits
        if credits is not None:
            usd = credits / self.account.settings.prices.marble_credits_per_usd
            self.account.ledger.settle(journal.key, Usage(usd=usd, credits=credits))

    def _world(self, journal: Journal) -> World:
        """The world of the kept originals; raises `ServiceError` if those were damaged since."""
        originals: dict[str, bytes] = {}
        for file in journal.files:
            data = self.journals.file(journal.key, file.name)
            if data is None or hashlib.sha256(data).hexdigest() != file.sha256:
                self.journals.save(journal.with_(state="made", files=()))
                raise TransientServiceError(
                    f"the original {file.name} of scene {self.account.scene!r} is missing or damaged in the store: run "
                    "the command again, it is brought again from Marble at no cost"
                )
            originals[file.name] = data
        with self.account.store.scratch() as scratch:
            path = Path(scratch) / "world.spz"
            path.write_bytes(originals["world.spz"])
            world = world_from_originals(
                path, journal.semantics, originals.get("collider.glb"), originals.get("panorama.png"), self.cleaning
            )
        told = {
            "source": f"{self.settings.model} ({journal.resolution})",
            "marble_world": journal.world_id,
            "caption": journal.caption,
            "adopted": int(journal.adopted),
        }
        return World(world.cloud, world.centre, {**world.notes, **told}, world.collider, world.panorama)


def _png(picture: ScenePicture) -> bytes:
    ok, data = cv2.imencode(".png", np.ascontiguousarray(picture.rgb[:, :, ::-1]))
    if not ok:
        raise ServiceError("the scene's picture cannot be encoded as PNG; materialise `image` again")
    return bytes(data)
