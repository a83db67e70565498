"""Keys and answers of the fake services."""

from typing import Any

FAST = {"starts_per_minute": 10_000, "at_once": 8, "tries": 4, "first_wait": 0.01, "longest_wait": 5.0}
CANARY = "canary-4f1c9a7e55d2"
"""Part of every key in these tests; it may appear nowhere."""
KEYS = {
    "OPENAI_API_KEY": f"sk-{CANARY}-openai",
    "GEMINI_API_KEY": f"AIza-{CANARY}-gemini",
    "DASHSCOPE_API_KEY": f"sk-{CANARY}-dashscope",
    "WORLDLABS_API_KEY": f"wl-{CANARY}-marble",
}


class Script:
    """What a fake model answers: the next of a list; the last one for ever."""

    def __init__(self) -> None:
        self.answers: list[Any] = []
        self.seen: list[tuple[str, str, int]] = []

    def __call__(self, system: str, user: str, pictures: int, schema: dict[str, Any] | None) -> Any:
        self.seen.append((system, user, pictures))
        return self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]
