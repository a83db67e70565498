"""A small generative grammar: ``<rule>`` is replaced by one of its alternatives, ``{slot}`` by a fact, ``[is|are]`` by
the form that agrees with the sentence's subject, and ``a(n)`` by the article of what follows."""

import json
import re
from collections.abc import Mapping
from functools import cache
from importlib import resources

import numpy as np

from flymirage_core.scene.inflection import article, capitalised

RULE = re.compile(r"<(\w+)>")
FORM = re.compile(r"\[([^|\]]*)\|([^\]]*)\]")
TWICE = re.compile(r"\b(\w+?)s? \1s?\b", re.IGNORECASE)
REDRAWS = 8
ARTICLE = re.compile(r"\b[Aa]\(n\) (\S+)")


def sentence(rule: str, slots: Mapping[str, str], many: bool, generator: np.random.Generator) -> str:
    """One sentence of a rule, with ``slots`` filled in; ``many``: the subject is plural.

    A frame that would say a word twice in a row ("on the tv stand stand two...") is drawn again.
    """
    for _ in range(REDRAWS):
        text = frame(rule, generator).format_map(slots)
        text = FORM.sub(lambda m: m[2] if many else m[1], text)
        text = ARTICLE.sub(lambda m: f"{article(m[1])} {m[1]}", text)
        text = re.sub(r"\s+", " ", text).strip()
        if not TWICE.search(text):
            break
    return capitalised(text)


def frame(rule: str, generator: np.random.Generator) -> str:
    """A rule with all inner rules replaced: a sentence whose slots are still open."""
    text = f"<{rule}>"
    while found := RULE.search(text):
        choices = rules()[found[1]]
        text = text[: found.start()] + choices[int(generator.integers(len(choices)))] + text[found.end() :]
    return text


@cache
def rules() -> dict[str, list[str]]:
    """Rule -> alternatives."""
    found: dict[str, list[str]] = json.loads(
        resources.files("flymirage_core.scene").joinpath("grammar.json").read_text()
    )
    return found
