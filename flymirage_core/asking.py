"""Asking a language model: the port, the question, and the versioned templates that questions are made of.

A template is a text file beside the room that asks: a first line ``version N``, then ``[system]`` and ``[user]``
parts with ``$name`` where a value goes. Its hash, with the answer's schema, goes into the provenance of what comes out.
"""

import hashlib
import json
import re
import string
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from typing import Any, Protocol, TypeVar

from pydantic import BaseModel

A = TypeVar("A", bound=BaseModel)


@dataclass(frozen=True)
class Question:
    """What a model is shown and told; the answer is JSON of the schema that the asker names."""

    name: str  # of the template, [A-Za-z0-9_-]
    system: str
    user: str
    images: tuple[bytes, ...] = ()  # JPEG files, shown before the text
    seed: int = 0


class LanguageModel(Protocol):
    """Answers questions with validated structures."""

    @property
    def name(self) -> str: ...

    def answer(self, question: Question, kind: type[A]) -> A:
        """Raises `BadAnswerError` if the answer is not a ``kind`` after one repair call; `ModerationError` if it was
        refused; other `ServiceError`s."""
        ...


@dataclass(frozen=True)
class Template:
    """A request's text."""

    name: str
    version: int
    parts: Mapping[str, str]  # "system", "user"

    def question(self, values: Mapping[str, str], images: tuple[bytes, ...] = (), seed: int = 0) -> Question:
        """The template filled in; raises `KeyError` for a value that is not given."""
        filled = {name: string.Template(text).substitute(values) for name, text in self.parts.items()}
        return Question(self.name, filled.get("system", ""), filled["user"], images, seed)

    def text(self, values: Mapping[str, str]) -> str:
        """The user part alone, filled in: for models that take plain words."""
        return string.Template(self.parts["user"]).substitute(values)

    def fingerprint(self, kind: type[BaseModel] | None = None) -> str:
        """Eight hex digits of the text and the answer's schema."""
        schema = "" if kind is None else json.dumps(strict_schema(kind), sort_keys=True)
        content = json.dumps([self.name, self.version, dict(self.parts), schema], sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()[:8]


def load_template(package: str, name: str) -> Template:
    """Read ``templates/<name>.txt`` of a package; raises `ValueError` if it is not of the form above."""
    text = resources.files(package).joinpath("templates", f"{name}.txt").read_text(encoding="utf-8")
    head = re.match(r"version (\d+)\n", text)
    pieces = re.split(r"^\[(system|user)\]\n", text, flags=re.MULTILINE)
    parts = {key: body.strip() for key, body in zip(pieces[1::2], pieces[2::2], strict=True)}
    if head is None or "user" not in parts:
        raise ValueError(f"template {name} of {package}: expected a line `version N`, then [system] and [user] parts")
    return Template(name, int(head.group(1)), parts)


def strict_schema(kind: type[BaseModel]) -> dict[str, Any]:
    """The JSON schema of ``kind`` as strict structured output takes it.

    No references, defaults or tuple types; every field required, no others.
    """
    schema = kind.model_json_schema()
    return _strict(schema, schema.pop("$defs", {}))


_NOT_STRICT = ("default", "title", "minLength", "maxLength", "prefixItems")


def _strict(node: dict[str, Any], definitions: dict[str, Any]) -> dict[str, Any]:
    if "$ref" in node:
        node = definitions[node["$ref"].rsplit("/", 1)[1]] | {k: v for k, v in node.items() if k != "$ref"}
    result = {k: v for k, v in node.items() if k not in _NOT_STRICT}
    if "prefixItems" in node:
        result["items"] = node["prefixItems"][0]  # our tuples hold one type
    if "items" in result:
        result["items"] = _strict(result["items"], definitions)
    if "anyOf" in result:
        result["anyOf"] = [_strict(option, definitions) for option in result["anyOf"]]
    if "properties" in node:
        result["properties"] = {name: _strict(field, definitions) for name, field in node["properties"].items()}
        result |= {"required": list(result["properties"]), "additionalProperties": False}
    return result
