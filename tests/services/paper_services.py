"""All services of profile `paper` on this machine; Marble hands out a world of the offline twin.

The models answer by canned logic from what they are told, in the contract's form; nothing here is a model.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from designs import design
from fake_marble import FakeMarble
from fake_openai import FakeOpenAI
from marble_files import Originals, originals_of

from flymirage_core.scene.writer import OfflineSceneWriter
from flymirage_core.settings import GenerationSettings
from flymirage_core.splats.frames import transformed
from flymirage_core.worldgen.model import OfflineWorldModel

KEYS = {"OPENAI_API_KEY": "sk-canary-1", "DASHSCOPE_API_KEY": "sk-canary-2", "WORLDLABS_API_KEY": "wl-canary-3"}


@dataclass(frozen=True)
class PaperServices:
    """The running fakes."""

    openai: FakeOpenAI
    dashscope: FakeOpenAI
    marble: FakeMarble

    def environment(self, keys: dict[str, str]) -> dict[str, str]:
        """What a user would set; short waits, so that tests are short."""
        fast = '{"starts_per_minute": 100000, "at_once": 4, "tries": 6, "first_wait": 0.05, "longest_wait": 2}'
        services = {
            "WRITER__BASE_URL": self.openai.base_url,
            "WRITER__PACE": fast,
            "PAINTER__BASE_URL": self.openai.base_url,
            "PAINTER__PACE": fast,
            "VLM__BASE_URL": self.dashscope.base_url,
            "VLM__PACE": fast,
            "MARBLE__BASE_URL": self.marble.url,
            "MARBLE__PACE": fast,
            "MARBLE__POLL_SECONDS": "0.1",
            "MARBLE__LOST_START_WAIT": "0.3",
        }
        return {
            "FLYMIRAGE_PROFILE": "paper",
            **{f"FLYMIRAGE_SERVICES__{name}": value for name, value in services.items()},
            **keys,
        }


@contextmanager
def paper_services(originals: Originals, keys: dict[str, str] = KEYS) -> Iterator[PaperServices]:
    with (
        FakeOpenAI(design_or_instruct, keys["OPENAI_API_KEY"]) as openai,
        FakeOpenAI(design_or_instruct, keys["DASHSCOPE_API_KEY"], "dashscope") as dashscope,
        FakeMarble(originals, keys["WORLDLABS_API_KEY"]) as marble,
    ):
        assert isinstance(openai, FakeOpenAI) and isinstance(dashscope, FakeOpenAI) and isinstance(marble, FakeMarble)
        yield PaperServices(openai, dashscope, marble)


def offline_originals(gaussians: int) -> Originals:
    """A world of the embedded world model as Marble would hand it out: its camera is its origin."""
    world = OfflineWorldModel(GenerationSettings(gaussians=gaussians)).build(OfflineSceneWriter().describe("paper"))
    x, y, z = world.centre
    shifted = transformed(world.cloud, [[1, 0, 0], [0, 1, 0], [0, 0, 1]], 1.0, [-x, -y, 0])
    return originals_of(shifted, ground=float(z))


def design_or_instruct(system: str, user: str, pictures: int, schema: dict[str, Any] | None) -> Any:
    """An answer to each of our templates."""
    if "You design places" in system:
        variation = re.search(r"Variation number: (\d+)", user)
        return design(f"Reading room {variation[1] if variation else 0}")
    if "You check flights" in system:
        assert pictures == 2
        good = {"score": 4, "reason": "The target comes nearer from frame 1 to the last."}
        return {"artifacts": good, "visibility": good, "intent": good, "keep": True}
    if "You write instructions" in system:
        assert pictures == 2
        return instructions(user)
    raise AssertionError(f"an unknown question: {system[:60]}")


def instructions(facts: str) -> dict[str, str]:
    """Plain sentences out of the facts, as a model would: some are right, some ambiguous."""
    target = re.search(r"^Target: (.+?);", facts, re.MULTILINE)
    relation = re.search(r"^The target is (.+?)(?: and .+?)? a (.+)\.$", facts, re.MULTILINE)
    name = target[1] if target else "object"
    noun = name.split()[-1]
    relative = f"Go to the {noun} {relation[1]} the {relation[2]}." if relation else ""
    return {"object_centred": f"Find the {noun}.", "relative": relative, "appearance": f"Fly to the {name}."}
