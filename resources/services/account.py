"""For whom calls are made: one scene's one product in one store, with its ledger, its pace and its paid answers."""

import hashlib
import json
from dataclasses import asdict, dataclass
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from flymirage_core.service_settings import PaceSettings, ServicesSettings
from resources.services.database import Database
from resources.services.ledger import Ledger
from resources.services.pace import Pace
from resources.store import Store


@dataclass(frozen=True)
class Account:
    """Everything that a service's adapter needs to know of the place where it is used."""

    store: Store
    scene: str
    asset: str
    settings: ServicesSettings
    reroll: int = 0
    """How many times this scene's description was refused by a service."""

    @cached_property
    def database(self) -> Database:
        return Database(state_folder(self.store, self.settings))

    @cached_property
    def ledger(self) -> Ledger:
        return Ledger(self.database, self.settings.budget)

    def usage_since(self, made_at: str) -> dict[str, float]:
        """What this product cost since the one before it was made (ISO 8601; "" = ever), and its scene in all."""
        since = datetime.fromisoformat(made_at).timestamp() if made_at else 0.0
        product = self.ledger.spent(self.scene, self.asset, since)
        numbers = {name: float(value) for name, value in asdict(product).items()}
        return {**numbers, "scene_usd": self.ledger.spent(self.scene).usd}

    def pace(self, service: str, settings: PaceSettings) -> Pace:
        return Pace(self.database, service, settings)

    def paid_answer(self, key: str) -> Any | None:
        """The answer to a request that was paid for before, or None."""
        data = self.store.read_service_file(f"{self.scene}/answers/{key}.json")
        return None if data is None else json.loads(data)

    def keep_answer(self, key: str, answer: Any) -> None:
        """Keep a paid answer before anything is done with it: a crash after this costs nothing."""
        self.store.write_service_file(f"{self.scene}/answers/{key}.json", json.dumps(answer).encode())

    def forget_answer(self, key: str) -> None:
        """An answer that turned out to be of no use must not be read again."""
        self.store.remove_service_file(f"{self.scene}/answers/{key}.json")


def state_folder(store: Store, settings: ServicesSettings) -> Path:
    """Where the shared database is: always a local disk, for SQLite needs its locks."""
    if settings.state:
        return Path(settings.state)
    return Path(str(store.base)) / "services" if store.is_local else Path(".flymirage/services")


def request_key(service: str, body: Any) -> str:
    """Names a request by its content: the same question of the same service is the same request."""
    text = json.dumps([service, body], sort_keys=True)
    return f"{service}-{hashlib.sha256(text.encode()).hexdigest()[:32]}"
