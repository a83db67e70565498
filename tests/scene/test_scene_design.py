"""The schema that an LLM and the offline writer fill: what it refuses, and how it looks to a strict model."""

import json

import pytest
from pydantic import ValidationError

from flymirage_core.asking import strict_schema
from flymirage_core.scene.design import SceneDesign
from flymirage_core.scene.writer import OfflineSceneWriter

ONE = OfflineSceneWriter().describe("scene-0001")
FIELDS = {name: getattr(ONE, name) for name in SceneDesign.model_fields}
ZONE = ONE.zones[0]
THING = ONE.objects[0]


def nodes(schema):
    yield schema
    for child in [*schema.get("properties", {}).values(), *([schema["items"]] if "items" in schema else [])]:
        yield from nodes(child)


def test_a_model_must_fill_every_field_and_no_other():
    for node in nodes(strict_schema(SceneDesign)):
        if node.get("type") == "object":
            assert node["required"] == list(node["properties"])
            assert node["additionalProperties"] is False


def test_the_schema_uses_only_what_strict_structured_output_takes():
    allowed = {"type", "description", "properties", "required", "additionalProperties", "items", "enum", "minItems"}
    allowed |= {"maxItems", "minimum", "maximum"}
    for node in nodes(strict_schema(SceneDesign)):
        assert set(node) <= allowed
        assert "type" in node
    assert "$ref" not in json.dumps(strict_schema(SceneDesign))


def test_every_field_that_is_not_plain_tells_a_model_what_it_is():
    top = strict_schema(SceneDesign)["properties"]
    for group in (top["objects"]["items"], top["zones"]["items"]):
        assert all("description" in field for field in group["properties"].values())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"zones": ()}, "at least one zone"),
        ({"zones": (ZONE, ZONE)}, "every zone needs its own name"),
        ({"zones": (ZONE.model_copy(update={"connects_to": ("attic",)}),)}, "connects to 'attic'"),
        ({"zones": (ZONE.model_copy(update={"dimensions": (4.0, 0.0, 3.0)}),)}, "expected metres above 0"),
        ({"dimensions": (-1.0, 4.0, 3.0)}, "dimensions .* of the scene"),
        ({"objects": (THING.model_copy(update={"zone": "attic"}),)}, "is in zone 'attic'"),
        ({"objects": (THING.model_copy(update={"relative_to": "dragon"}),)}, "name a listed noun exactly"),
        ({"objects": (THING.model_copy(update={"placement": "facing", "relative_to": ""}),)}, "must say of what"),
        ({"objects": (THING.model_copy(update={"count": 60, "relative_to": ""}),) * 5}, "at most 250"),
    ],
)
def test_a_design_that_does_not_fit_together_is_refused_with_one_sentence(change, message):
    with pytest.raises(ValidationError, match=message):
        SceneDesign(**{**FIELDS, **change})


def test_unknown_fields_are_refused():
    with pytest.raises(ValidationError, match="weather"):
        SceneDesign(**FIELDS, weather="fog")
