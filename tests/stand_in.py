"""The machine room without the science: every stage makes a small file out of (scene, its settings, its inputs).

Names, inputs, settings sections, tools and versions are the real ones; so are the store, Dagster and the command line.
``python -m stand_in grow --scenes 3`` is the command line over it.
"""

import hashlib
import json
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flymirage_assets import stage as staging
from flymirage_assets.checks import EXPECTED

BYTES = 20_000


@dataclass(frozen=True)
class StandIn:
    """A product whose bytes say everything that it was made from."""

    text: str
    asset: str

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "product.json").write_text(json.dumps({"text": self.text, "asset": self.asset}))
        (folder / "data.bin").write_bytes(hashlib.sha256(self.text.encode()).digest() * (BYTES // 32))

    @staticmethod
    def load(folder: Path) -> "StandIn":
        return StandIn(**json.loads((folder / "product.json").read_text()))

    def summary(self) -> dict[str, str | int | float]:
        expected = EXPECTED.get(self.asset)
        about = {"title": "Stand-in", "category": "home", "subcategory": "kitchen"}
        return {"letters": len(self.text), **about, **({expected.number: 10_000} if expected else {})}


def stand_in(**declared: Any) -> Callable[[Callable[..., Any]], Any]:
    """`product_asset`, but the stage's function only hashes what it is given."""
    sections = declared.get("sections", [])

    def draw(stage: staging.Stage, product: StandIn, **inputs: StandIn) -> np.ndarray:
        return np.full((48, 64, 3), len(product.text) % 255, np.uint8)

    def decorate(function: Callable[..., Any]) -> Any:
        inputs = [name for name in function.__annotations__ if name not in ("stage", "return")]

        def compute(stage: staging.Stage, **upstream: StandIn) -> StandIn:
            time.sleep(float(os.environ.get("STAND_IN_SECONDS", "0")))
            chosen = {name: getattr(stage.settings, name).model_dump(mode="json") for name in sections}
            if function.__name__ == "trajectories":  # a setting that changes no byte: to see the cut-off
                chosen["planner"].pop("horizon")
            made_from = [function.__name__, stage.scene, chosen, {name: u.text for name, u in upstream.items()}]
            return StandIn(
                hashlib.sha256(json.dumps(made_from, sort_keys=True).encode()).hexdigest(), function.__name__
            )

        compute.__name__, compute.__doc__ = function.__name__, function.__doc__
        compute.__annotations__ = {"stage": staging.Stage, **dict.fromkeys(inputs, StandIn), "return": StandIn}
        return real_product_asset(**{**declared, "draw": draw})(compute)

    return decorate


real_product_asset = staging.product_asset
staging.product_asset = stand_in

if __name__ == "__main__":
    import sys

    sys.modules["stand_in"] = sys.modules["__main__"]
    from flymirage_assets.cli import main

    main()
