"""A gait's record gives back the same gait, and a wrong record is told what is wrong with it."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from rr_opt.files.record import gait_from, gait_record
from rr_opt.files.yaml_text import FileData
from rr_opt.model.gait import Gait, SineGait
from tests.motion.gaits import EVERY, FOURIER, FREE


def read(record: object) -> tuple[Gait | None, list[str]]:
    """Through the text of a result, as a user's file comes."""
    data = json.loads(json.dumps({"gait": record}))
    gait, issues = gait_from(FileData("result.json", data, {}).section("gait"))
    return gait, [str(issue) for issue in issues]


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_round_trip(gait: Gait):
    assert read(gait_record(gait)) == (gait, [])


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_every_shape_tells_its_size(gait: Gait):
    record = gait_record(gait)
    assert record["shape"] == gait.shape
    for name in ("amplitude", "period", "offset"):
        assert record[name] == getattr(gait, name)


def test_a_record_without_a_shape_is_a_sine():
    assert read({"amplitude": 0.5, "period": "1.2 s", "offset": 0}) == (SineGait(0.5, 1.2, 0.0), [])


@pytest.mark.parametrize("gait", [FOURIER, FREE], ids=lambda gait: gait.shape)
def test_what_follows_from_the_rest_may_be_left_out(gait: Gait):
    record = gait_record(gait)
    del record["amplitude"]
    if gait.shape == "free":
        del record["offset"]
    assert read(record) == (gait, [])


FOUR, WITHOUT = gait_record(FOURIER), {"shape": "free", "period": 1, "angle0": 0, "rate0": 0}
WRONG: list[tuple[dict[str, Any], str]] = [
    ({"shape": "square"}, "gait.shape: Read the word 'square'. Expected one of: sine, fourier"),
    ({"shape": 3}, "gait.shape: Read 3. Expected one of: sine, fourier, free."),
    ({"amplitude": 1, "period": 1}, "gait.offset: This key is missing. Add it."),
    (
        {"amplitude": -1, "period": 1, "offset": 0},
        "amplitude: Read -1. Expected a number in rad at",
    ),
    ({"amplitude": 1, "period": "x", "offset": 0}, "period: Read the text 'x'."),
    ({**FOUR, "phase": 1}, "gait.phase: Read the key 'phase'."),
    ({**FOUR, "sines": []}, "gait.sines: Read a list of 0. Expected a list of at least 1"),
    ({**FOUR, "sines": 0.5}, "gait.sines: Read 0.5. Expected a list of at least 1 numbers in rad."),
    ({**FOUR, "sines": [0.1, "1 s", 0]}, "gait.sines: Number 2 of the list: Read '1 s'"),
    ({**FOUR, "sines": [0.5]}, "gait.cosines: Read 3 cosines and 1 sines. Expected as many"),
    ({**FOUR, "amplitude": 0.1}, "gait.amplitude: Read 0.1 rad. Expected 0.7"),
    ({**FOUR, "sines": [0, 0, 0], "cosines": [0, 0, 0]}, "does not move the servo"),
    ({**WITHOUT, "accelerations": [1, 1]}, "the rate is 1 rad/s from where it began. Expected"),
    ({**WITHOUT, "rate0": 2, "accelerations": [1, -1]}, "the angle is 2.25 rad from where"),
    ({**gait_record(FREE), "offset": 2}, "gait.offset: Read 2 rad. Expected"),
]


@pytest.mark.parametrize(("record", "message"), WRONG, ids=[text for _, text in WRONG])
def test_wrong(record: dict[str, Any], message: str):
    gait, issues = read(record)
    assert gait is None
    assert any(message in issue for issue in issues), issues
    assert all(issue.startswith("result.json: gait.") for issue in issues)


@pytest.mark.parametrize("value", [math.nan, math.inf, None, True, {}, [[1]]])
@pytest.mark.parametrize("shape", EVERY)
def test_any_value_is_refused_in_words(shape: str, value: object):
    for key in gait_record(EVERY[shape]):
        gait, issues = gait_from(
            FileData("f", {"gait": {**gait_record(EVERY[shape]), key: value}}, {}).section("gait")
        )
        assert gait is None, key
        assert [issue.path for issue in issues if issue.path.startswith(f"gait.{key}")], key
