"""A value is reported in the unit of the bench, with as many digits as its interval allows."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.machines.pendulum import PENDULUM
from rr_opt.results.diagnosis_tables import (
    headline,
    interval_text,
    share_text,
    tie_text,
    value_text,
)
from rr_opt.results.machine_diagnosis import ExplainedMachine
from rr_opt.sysid.diagnosis import Estimate, Finding, Tie


@pytest.mark.parametrize(
    ("estimate", "text"),
    [
        (Estimate(0.01523, 0.0141, 0.0163, "N"), "15.2 mN [14.1, 16.3]"),
        (Estimate(1.234567, 1.2, 1.3, "N"), "1.235 N [1.200, 1.300]"),
        (Estimate(0.20551, 0.2054, 0.2057, "m"), "205.51 mm [205.40, 205.70]"),
        (Estimate(2.1e-5, 1.8e-5, 2.4e-5, "N m s"), "21.0 µN m s [18.0, 24.0]"),
        (Estimate(0.04, 0.03, 0.05, "rad"), "40 mrad [30, 50]"),
        (Estimate(0.2, 0.19, 0.21, "dimensionless"), "0.200 [0.190, 0.210]"),
        (Estimate(0.2, 0.1, math.inf, "m"), "200 mm [100, ∞]"),
    ],
)
def test_values(estimate, text):
    assert value_text(estimate) == text


def test_an_interval_alone():
    assert interval_text(Estimate(0.0152, 0.0141, 0.0163, "N")) == "14.1 to 16.3 mN"


def test_headlines_say_the_verdict(every):
    said = {verdict: headline(one.found) for verdict, one in every.items()}
    assert said["missing_physics"] == "The model leaves out Coulomb friction"
    assert "wheel friction of platform 1 differs from nominal" in said["parameters"]
    assert "explains the recordings" in said["consistent"]
    assert said["unexplained"] == "Physics is missing, but no effect could be named"


@pytest.mark.parametrize(
    ("verdict", "answer", "rival", "text"),
    [
        ("missing_physics", "servo_lag", "floor_patch floor_tilt",
         "servo lag from floor patch and floor tilt"),
        ("missing_physics", "servo_lag floor_tilt", "floor_tilt",
         "servo lag and floor tilt from floor tilt alone"),
        ("parameters", "I1", "m1 c1", "a wrong I1 from a wrong m1 or c1"),
    ],
)  # fmt: skip
def test_a_tie_says_what_stands_against_what(every, verdict, answer, rival, text):
    tie = Tie(tuple(answer.split()), tuple(rival.split()))
    assert tie_text(tie, every[verdict].found) == text


def test_the_headline_of_another_machine_has_one_article(wrong_values):
    wrong = replace(wrong_values.found.findings[0], name="J")
    made: Any = SimpleNamespace(
        found=replace(wrong_values.found, findings=(wrong,)),
        experiment=SimpleNamespace(machine=PENDULUM),
    )
    assert ExplainedMachine.headline.fget(made) == (  # pyright: ignore
        "The model is right, but the moment of inertia about the axis differs from nominal"
    )


def test_a_file_of_unestablished_effects_says_so(every):
    (text,) = every["unexplained"]._tables().values()
    assert text.splitlines()[1].endswith("any effects among them are not established.")
    (text,) = every["missing_physics"]._tables().values()
    assert text.splitlines()[1].startswith("# From trial by rr-opt")


@pytest.mark.parametrize("verdict", ["consistent", "parameters", "missing_physics", "unexplained"])
def test_the_terminal_gets_the_verdict_first(every, verdict):
    text = every[verdict].summary()
    assert text.startswith("verdict")
    assert verdict in text.splitlines()[0]
    assert "8.10 before, 1.00 after" in text


def test_the_terminal_tells_what_remains(missing, unexplained):
    def row(one):
        return next(line for line in one.summary().splitlines() if line.startswith("remainder"))

    assert row(missing).split() == ["remainder", "none"]
    # Of the noise alone 1, and 7.90 beyond it.
    assert "large: misfit 7.96 σ, 97 % of the initial misfit beyond the noise" in row(unexplained)
    assert "depends on the speed" in unexplained.summary()
    assert any(line.startswith("indistinguishable") for line in missing.summary().splitlines())


def test_the_next_recording_is_asked_for_as_in_the_summary(missing, consistent):
    plan = missing.found.next_experiment
    assert any(line.startswith("record next") for line in missing.summary().splitlines())
    settled = replace(consistent, found=replace(consistent.found, next_experiment=plan))
    assert plan.sentence not in settled.summary()


@pytest.mark.parametrize(
    ("removes", "told"), [(1.0, "100 %"), (0.006, "1 %"), (0.004, "less than 0.5 %")]
)
def test_what_is_named_explains_something(removes, told):
    assert share_text(Finding("quadratic_drag", 0.7, {}, removes)) == told
