"""The JSON Schema of experiments accepts what the file accepts, and describes every field."""

from __future__ import annotations

import copy
from typing import Any

import pytest
import yaml

from rr_opt.files.lint import schema
from tests.files.test_schemas import accepts

GOOD = yaml.safe_load("""
robot:
  platform1: {m: 0.4, I: 0.002, c: 0.2, a: 0.02, b: 0.05, kappa: 2.0e-5}
  platform2: {m: 0.3, I: 0.001, c: 0.1, a: -0.01, b: 0.05, kappa: 3.0e-5}
  h: 20 mm
noise: {position: 1 mm, angle: 3 mrad, torque: 0.003}
uncertainty: {m: 1 %, I2: 1.0e-4, h: 0.5 mm, kappa: unknown, psi_zero: 0.01}
recordings:
- {file: a.csv, gait: {amplitude: 0.5, period: 1 s, offset: 0}, use: fit, start: rest}
- {file: b.c3d, gait: out/result.json, use: holdout, servo_log: log.csv}
markers:
  platform1: {A: [40 mm, 0], B: [0.2, 0.1, 0.01]}
  platform2: {C: [-40 mm, 0], D: [-0.2, 0.1]}
  up: -y
servo_counts: {counts: 4096, range: -360 deg, zero: 2048}
""")


def judged(data: object) -> bool:
    found = schema("experiment")
    return accepts(found, data, found)


def test_a_whole_file():
    assert judged(GOOD)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("speed",), 1),
        (("noise",), {"position": 1}),
        (("noise", "angle"), 0),
        (("uncertainty", "kapa"), "unknown"),
        (("recordings",), []),
        (("recordings", 0, "use"), "test"),
        (("recordings", 0, "gait"), {"period": 1, "offset": 0}),
        (("recordings", 0, "gait"), {"amplitude": -1, "period": 1, "offset": 0}),
        (("markers", "up"), "up"),
        (("servo_counts", "counts"), 1),
    ],
)
def test_what_is_wrong_is_refused(path: tuple[Any, ...], value: object):
    data = copy.deepcopy(GOOD)
    inner: Any = data
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    assert not judged(data)


@pytest.mark.parametrize(
    ("place", "good"), [([0, "4 mm"], True), ([0, 0, 0], True), ([0], False), ([0] * 4, False)]
)
def test_the_place_of_a_marker(place: list[object], good: bool):
    found = schema("experiment")
    markers = found["$defs"]["MarkersModel"]["properties"]["platform1"]
    assert accepts(markers["additionalProperties"], place, found) is good


def test_every_field_is_described_and_every_quantity_has_its_unit():
    found = schema("experiment")
    for node in (found, *found["$defs"].values()):
        assert node["description"]
        for field in node["properties"].values():
            assert field["description"]
            types = {one.get("type") for one in field.get("anyOf", [])}
            assert ("x-unit" in field) == ("number" in types)
