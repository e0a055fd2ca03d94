"""The JSON Schemas accept what the files accept, refuse unknown keys and describe every field."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from rr_opt.files.lint import schema
from rr_opt.files.source import SHIPPED
from rr_opt.outcome import InputError

PROBLEMS = Path(__file__).parents[2] / "problems"
TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "number": (int, float),
    "integer": int,
    "boolean": bool,
    "null": type(None),
}


def accepts(node: dict[str, Any], value: Any, root: dict[str, Any]) -> bool:
    """Validation with the part of JSON Schema that these schemas use."""
    if "$ref" in node:
        name = node["$ref"].removeprefix("#/$defs/")
        node = {**root["$defs"][name], **{k: v for k, v in node.items() if k != "$ref"}}
    checks = [
        "type" not in node or isinstance(value, TYPES[node["type"]]),
        "const" not in node or value == node["const"],
        "enum" not in node or value in node["enum"],
        "anyOf" not in node or any(accepts(one, value, root) for one in node["anyOf"]),
        "oneOf" not in node or sum(accepts(one, value, root) for one in node["oneOf"]) == 1,
    ]
    checks += [accepts(one, value, root) for one in node.get("allOf", [])]
    if "if" in node and accepts(node["if"], value, root):
        checks.append(accepts(node["then"], value, root))
    if isinstance(value, dict):
        properties = node.get("properties", {})
        checks += [key in value for key in node.get("required", [])]
        checks += [accepts(properties[k], v, root) for k, v in value.items() if k in properties]
        if node.get("additionalProperties") is False:
            checks.append(set(value) <= set(properties))
    if isinstance(value, list):
        checks += [accepts(node["items"], item, root) for item in value if "items" in node]
        checks.append(node.get("minItems", 0) <= len(value) <= node.get("maxItems", len(value)))
    if isinstance(value, int | float):
        checks += [
            value > node.get("exclusiveMinimum", -1e300),
            value >= node.get("minimum", -1e300),
            value <= node.get("maximum", 1e300),
            value < node.get("exclusiveMaximum", 1e300),
            value % node.get("multipleOf", 1) == 0 or "multipleOf" not in node,
        ]
    return all(checks)


def judged(kind: str, data: object) -> bool:
    found = schema(kind)
    return accepts(found, data, found)


def load(path: Path) -> Any:
    return yaml.safe_load(path.read_text())


def test_shipped_and_example_files_satisfy_it():
    assert judged("robot", load(SHIPPED / "robot.yaml"))
    for folder in (SHIPPED, PROBLEMS / "turning", PROBLEMS / "loads"):
        assert judged("problem", load(folder / "problem.yaml"))


@pytest.mark.parametrize(
    "change",
    [
        {"speed": 1},
        {"h": 0},
        {"h": None},
        {"platform1": {}},
        {"physics": [{"name": "nothing"}]},
        {"physics": [{"name": "coulomb_friction", "F9": 1}]},
        {"servo": {"angle_limit": 4}},
    ],
)
def test_wrong_robots_do_not(change: dict[str, Any]):
    assert not judged("robot", {**load(SHIPPED / "robot.yaml"), **change})


def test_kappa_or_k():
    robot = load(SHIPPED / "robot.yaml")
    robot["platform1"]["k"] = 0.1
    assert not judged("robot", robot)
    del robot["platform1"]["kappa"]
    assert judged("robot", robot)


def test_effects_by_name_and_alias():
    robot = load(SHIPPED / "robot.yaml")
    robot["physics"] = [{"name": "coulomb_friction", "F1": "20 mN", "force2": 0.02}]
    assert judged("robot", robot)


@pytest.mark.parametrize("value", [0.2, "20 %", [0.1, 0.2], {"bounds": [0.1, 0.2]}])
def test_an_inertia_ratio_in_every_form(value: object):
    assert judged("problem", {"inertia_ratio": value})


@pytest.mark.parametrize(
    ("gait", "good"),
    [
        ({"shape": "fourier", "harmonics": 3}, True),
        ({"shape": "free", "intervals": 96}, True),
        ({"shape": "free"}, True),
        ({"harmonics": 3}, False),
        ({"shape": "free", "harmonics": 3}, False),
        ({"shape": "fourier", "harmonics": 0}, False),
        ({"shape": "free", "intervals": 97}, False),
        ({"shape": "square"}, False),
    ],
)
def test_shapes_with_what_belongs_to_them(gait: dict[str, object], good: bool):
    assert judged("problem", {"gait": gait}) is good


@pytest.mark.parametrize("kind", ["robot", "problem"])
def test_every_field_is_described_and_every_quantity_has_its_unit(kind: str):
    found = schema(kind)
    assert found["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    for node in (found, *found["$defs"].values()):
        assert node["description"]
        for field in node["properties"].values():
            assert field["description"]
            types = {one.get("type") for one in field.get("anyOf", [])}
            assert ("x-unit" in field) == ("number" in types)


def test_another_kind():
    with pytest.raises(InputError, match=r"Read the kind of file 'robots'.*Did you mean `robot`\?"):
        schema("robots")
