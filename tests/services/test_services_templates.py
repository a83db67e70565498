"""The requests' texts: each is pinned, so that a change is seen, is meant, and shows in provenance."""

import hashlib
import json

import pytest
from fake_openai import schema_problem

from flymirage_core.asking import Template, load_template, strict_schema
from flymirage_core.language.vlm_judge import VlmVerdict
from flymirage_core.language.vlm_prompter import Instructions
from flymirage_core.scene.design import SceneDesign

TEMPLATES = {
    ("flymirage_core.scene", "scene_design"): (1, "7d52c2728587"),
    ("flymirage_core.scene", "image_prompt"): (1, "d06c6479793c"),
    ("flymirage_core.scene", "world_prompt"): (1, "de2cb59efbba"),
    ("flymirage_core.language", "verdict"): (1, "7425bac99073"),
    ("flymirage_core.language", "instructions"): (1, "e02442473e82"),
    ("flymirage_core.language", "object_centred"): (1, "db6601b5f13b"),
    ("flymirage_core.language", "relative"): (1, "68f71e55ad2d"),
    ("flymirage_core.language", "appearance"): (1, "4c9bc38bc531"),
}
"""(version, first digits of the text's sha256): whoever changes a text raises its version and pins it anew."""


@pytest.mark.parametrize(("package", "name"), TEMPLATES)
def test_each_text_is_pinned(package: str, name: str) -> None:
    template = load_template(package, name)
    text = "\0".join(f"{part}:{template.parts[part]}" for part in sorted(template.parts))
    assert (template.version, hashlib.sha256(text.encode()).hexdigest()[:12]) == TEMPLATES[package, name]


SCHEMAS = {SceneDesign: "a9f42307f4fd", VlmVerdict: "fb9109af701b", Instructions: "847f1cf5a84e"}


@pytest.mark.parametrize("answer", SCHEMAS)
def test_each_answers_schema_is_pinned(answer) -> None:
    text = json.dumps(strict_schema(answer), sort_keys=True)
    assert hashlib.sha256(text.encode()).hexdigest()[:12] == SCHEMAS[answer]


@pytest.mark.parametrize("answer", SCHEMAS)
def test_each_answers_schema_is_one_that_strict_output_takes(answer) -> None:
    assert schema_problem(strict_schema(answer)) is None


def test_provenance_changes_with_the_text_and_with_the_schema() -> None:
    one = Template("t", 1, {"user": "Name a colour."})
    assert one.fingerprint() != Template("t", 1, {"user": "Name a colour!"}).fingerprint()
    assert one.fingerprint(VlmVerdict) != one.fingerprint(Instructions) != one.fingerprint()


def test_a_value_that_is_missing_is_an_error_and_not_a_hole() -> None:
    with pytest.raises(KeyError, match="category"):
        load_template("flymirage_core.scene", "scene_design").question({"subcategory": "x", "variation": "1"})
