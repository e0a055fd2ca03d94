"""What docs/calibration.md and the shipped robot file say is what results/calibration holds."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from rr_opt.files.problem_file import read_problem

ROOT = Path(__file__).parents[3]
DOCS = " ".join((ROOT / "docs" / "calibration.md").read_text(encoding="utf-8").split())
FOUND = json.loads((ROOT / "results" / "calibration" / "calibration.json").read_text("utf-8"))
BY_NAME = {(one["unknown"], one["column"]): one for one in FOUND["intervals"]}
SCALE = {"a1": 1e3, "a2": 1e3, "b": 1e3, "k": 1.0, "amplitude": 1.0}
ROW = {"amplitude": "Table 2's amplitude"}


def numbers(text: str) -> list[float]:
    return [float(found) for found in re.findall(r"-?\d+(?:\.\d+)?", text)]


@pytest.mark.parametrize("name", SCALE)
def test_the_table_of_unknowns(name: str):
    found = BY_NAME[name, "mean"]
    line = re.search(rf"\| {ROW.get(name, f'`{name}`')} \|([^|]*)\|([^|]*)\|([^|]*)\|", DOCS)
    assert line
    box = next(one["box"] for one in FOUND["unknowns"] if one["name"] == name)
    for told, ends in ((line[1], box), (line[2], found["posterior"])):
        assert numbers(told)[:2] == pytest.approx([SCALE[name] * end for end in ends], rel=0.06)
    if "both sides" in line[3]:
        assert found["profile_student"] == pytest.approx(box)
    else:
        ends = [SCALE[name] * end for end in found["profile_student"]]
        assert numbers(line[3])[:2] == pytest.approx(ends, rel=0.06)


def test_the_models():
    model = {(one["model"], one["column"]): one for one in FOUND["models"]}
    for first, second in (("mean", "20.0 to 10.2"), ("other", "29.3 to 17.2")):
        told = [model[name, first]["deviance"] for name in ("viscous", "viscous+dry")]
        assert second in DOCS
        assert numbers(second) == pytest.approx(told, abs=0.06)
    left = [
        model[name, column]["left_out_deviance"]
        for column in ("mean", "other")
        for name in ("viscous+dry", "viscous")
    ]
    told = re.search(r"deviance of (\d+) instead of (\d+), and of (\d+) instead of (\d+)", DOCS)
    assert told
    assert [int(number) for number in told.groups()] == pytest.approx(left, abs=0.6)
    made = [model["viscous", column]["made"]["as_bad"] for column in ("mean", "other")]
    assert f"itself, {made[0]} fit it as badly" in DOCS
    assert f"it is {made[1]} of 200" in DOCS


def test_the_coverage():
    kept = FOUND["coverage"]
    for kind, told in (
        ("posterior", r"contained the truth in (\d+) to (\d+) %"),
        ("profile_student", r"the profile's in (\d+) to (\d+) %"),
        ("profile_normal", r"by the normal distribution in (\d+) to (\d+) %"),
    ):
        found = re.search(told, DOCS)
        assert found, kind
        ends = [100 * min(kept[kind]), 100 * max(kept[kind])]
        assert [int(number) for number in found.groups()] == pytest.approx(ends, abs=0.6)


def test_every_shipped_value_lies_inside():
    robot = read_problem(None).robot
    shipped = {"a1": robot.platform1.a, "a2": robot.platform2.a, "b": robot.platform1.b,
               "k": robot.k1}  # fmt: skip
    for (name, _), found in BY_NAME.items():
        if name in shipped:
            for kind in ("posterior", "profile_student"):
                low, high = found[kind]
                assert low - 1e-9 <= shipped[name] <= high + 1e-9, (name, kind)


def test_the_shipped_file_states_the_intervals():
    told = read_problem(None).robot.provenance
    for key, name in (("platform2.a", "a2"), ("platform1.kappa", "k"), ("platform2.kappa", "k")):
        ends = [BY_NAME[name, column]["posterior"] for column in ("mean", "other")]
        widest = [min(low for low, _ in ends), max(high for _, high in ends)]
        sentence = told[key].rsplit(";", 1)[1]
        found = re.search(r"leave (-?[\d.]+) to ([\d.]+)", sentence)
        assert found, sentence
        read = [float(number) / SCALE[name] for number in found.groups()]
        assert read == pytest.approx(widest, rel=0.06)
