"""The library returns the checked answer that the command writes."""

import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import rr_opt as rr
from rr_opt.cli.main import app

PROBLEM = """
gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
limits: {angle: 2.6, rate: 25 rpm, torque: 1.37}
"""


def command(*arguments):
    return json.loads(CliRunner().invoke(app, [*map(str, arguments), "--json"]).stdout)


def numbers(record, path=""):
    """The record's numbers by their path; and the record without them."""
    if isinstance(record, dict | list):
        pairs = record.items() if isinstance(record, dict) else enumerate(record)
        parts = {key: numbers(one, f"{path}/{key}") for key, one in pairs}
        found = {at: value for own, _ in parts.values() for at, value in own.items()}
        return found, {key: rest for key, (_, rest) in parts.items()}
    return ({path: record}, None) if isinstance(record, float) else ({}, record)


def assert_same(one, other):
    """Equal but for rounding: code that was compiled in the meantime rounds differently, which
    moves the deviations from a circle by as much as their integration is off."""
    (values, words), (others, as_well) = numbers(one), numbers(other)
    assert words == as_well
    assert values == {
        at: pytest.approx(value, rel=1e-9, abs=1e-8 if "circle_check" in at else 1e-12)
        for at, value in others.items()
    }


@pytest.fixture
def problem(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.yaml").write_text(PROBLEM)
    return rr.load("mine.yaml")


def test_maximize_speed(problem, tmp_path):
    best = rr.maximize_speed(problem)
    assert [check.passed for check in best.checks] == [True] * 5
    assert best.limits["rate"].active
    assert best.limits["rate"].shadow_price > 0
    files = best.save("saved")
    assert {file.name for file in files} > {"result.json", "report.html", "speed-map.svg"}
    saved = json.loads((tmp_path / "saved" / "result.json").read_text())
    assert saved == best.record()
    assert_same(saved, command("maximize-speed", "mine.yaml", "--no-figures"))
    assert saved["speed"] == best.speed
    assert best.plot()["path"].count("<svg") == 1
    assert "<svg" in best.plot()._repr_html_()
    assert str(best).startswith("mine: The fastest gait found drives")


def test_a_check_that_fails_is_no_optimum(problem):
    best = rr.maximize_speed(problem)
    spoiled = replace(best, replay=replace(best.replay, error=0.01))
    assert spoiled.status is rr.Status.NOT_CONVERGED
    assert spoiled.message.startswith("The optimum was not confirmed.")


def test_turn(problem):
    turned = rr.turn("mine.yaml", radius=0.8)
    record = command("turn", "mine.yaml", "--radius", 0.8, "--no-figures")
    assert_same(turned.record(), record)
    assert turned.radius == pytest.approx(0.8)


def test_sweep(problem):
    swept = rr.sweep("mine.yaml", 100)
    assert_same(swept.record(), command("sweep", "mine.yaml", "--points", 100))


def test_simulate_circle_and_export_a_result(problem, tmp_path):
    best = rr.maximize_speed(problem)
    best.save("saved", figures=False)
    result = "saved/result.json"
    motion = rr.simulate(best, seconds=2)
    record = command("simulate", result, "--seconds", 2, "--out", "moved")
    assert motion.record() == {**record, "files": []}
    assert motion.record() == rr.simulate(best.robot, best.gait, "2 s").record() | {
        "status": "optimal"
    }
    circle = rr.circle(best).record()
    assert rr.circle(result).record()["speed"] == pytest.approx(circle["speed"])
    assert circle["radius"] is None
    assert circle["speed"] == pytest.approx(command("circle", result)["speed"])
    points = rr.export(best, format="servo")
    reported = command("export", result, "--format", "servo", "--out", "points.csv")
    assert points.record() == {**reported, "file": None}
    assert points.text == (tmp_path / "points.csv").read_text()


def test_study(problem, tmp_path):
    (tmp_path / "study.yaml").write_text(
        "problem: mine.yaml\nvary: {limits.rate: [20 rpm, 25 rpm]}"
    )
    solved = rr.study("study.yaml", workers=1)
    reported = command("study", "study.yaml", "--workers", "1", "--no-figures")
    seconds = {"seconds", "solver_seconds"}
    for mine, its in zip(solved.record()["cases"], reported["cases"], strict=True):
        assert {k: v for k, v in mine.items() if k not in seconds} == {
            k: v for k, v in its.items() if k not in seconds
        }
    assert np.all(np.diff(solved.speed) > 0)


def test_a_problem_made_in_python_is_the_one_in_the_file(problem):
    made = rr.Problem(
        rr.prototype(),
        rr.Limits(angle=2.6, rate="25 rpm", torque=1.37),
        rr.GaitBounds(amplitude=(0.1, 1.0), period="1 s", offset=0.0),
    )
    assert made == problem
    one, other = rr.maximize_speed(made), rr.maximize_speed(problem)
    assert one.speed == other.speed
    assert (one.name, other.name) == ("prototype", "mine")
    # Its fingerprint is of its values: equal for equal ones.
    again = replace(made)
    assert rr.maximize_speed(again).sha256 == one.sha256 != other.sha256
