"""What was named decides what is lit, and an answer says so where the stages' tests disagree."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer.stages.stages import located
from rr_opt.sysid.diagnosis import Diagnosis, Estimate, Finding, Mismatch, Stage
from tests.sysid.stages.world import recorded

CHANNELS = (
    "measurement",
    "actuation",
    "constraint_axle1",
    "constraint_axle2",
    "rolling",
    "yaw",
    "floor",
)
CATALOGUE = recorded({}, seed=0, seconds=2.0).catalogue


def marked(*lit: str) -> tuple[Stage, ...]:
    return tuple(
        Stage(
            f"the {channel}",
            channel,
            2.0 if channel == "constraint_axle2" else 1.0,
            1e-9 if channel in lit else 0.4,
            2.5,
            channel in lit,
            f"In {channel}.",
        )
        for channel in CHANNELS
    )


def said(verdict: str, *findings: Finding) -> Diagnosis:
    return Diagnosis(
        *(verdict, "", Mismatch(2.0, 0.0), "none", "", (), findings, {}, (), (), None, ()),
        *((), (), (), 2.0, 1.0, {}, {}),
    )  # type: ignore[arg-type]


def named(name: str, **values: tuple[float, float, float]) -> Finding:
    return Finding(name, 1.0, {key: Estimate(*v, "") for key, v in values.items()}, 1.0)


def lit(found: Diagnosis) -> list[str]:
    return [stage.channel for stage in found.stages if stage.guilty]


def test_a_name_that_agrees_keeps_the_lamp_and_the_words():
    found = located(
        said("missing_physics", named("coulomb_friction")), marked("rolling"), CATALOGUE
    )
    assert (found.channel, lit(found)) == ("rolling", ["rolling"])
    assert found.where == "The rolling: In rolling."


def test_a_name_that_disagrees_gets_the_lamp_and_the_answer_says_so():
    found = located(said("missing_physics", named("floor_tilt")), marked("rolling"), CATALOGUE)
    assert (found.channel, lit(found)) == ("floor", ["floor"])
    assert "point elsewhere: at 'the rolling'" in found.where


def test_of_two_names_both_are_lit_and_the_stronger_is_the_channel():
    names = named("coulomb_friction"), named("clock_offset")
    found = located(said("missing_physics", *names), marked("measurement"), CATALOGUE)
    assert found.channel == "rolling"
    assert lit(found) == ["measurement", "rolling"]
    assert "elsewhere" not in found.where


@pytest.mark.parametrize(
    ("finding", "channel"),
    [
        (
            named("axle_misalignment", toe1=(1e-4, -1e-4, 3e-4), toe2=(0.01, 0.009, 0.011)),
            "constraint_axle2",
        ),
        (
            named("axle_misalignment", toe1=(0.01, 0.009, 0.011), toe2=(0.0, -1e-3, 1e-3)),
            "constraint_axle1",
        ),
        (named("lateral_slip", mu=(0.05, 0.049, 0.051)), "constraint_axle2"),
        (named("left_right_drag", asymmetry1=(0.4, 0.3, 0.5)), "yaw"),
        (named("com_offset", d1=(0.01, 0.009, 0.011)), "mass"),
    ],
)
def test_an_effect_is_put_where_it_acts(finding, channel):
    found = located(said("missing_physics", finding), marked(), CATALOGUE)
    assert found.channel == channel
    assert lit(found) == [channel]
    assert "see no fault" in found.where


@pytest.mark.parametrize("verdict", ["consistent", "parameters"])
def test_nothing_is_lit_where_nothing_is_missing(verdict):
    found = located(said(verdict), marked("floor"), CATALOGUE)
    assert (found.channel, lit(found)) == ("none", [])
    assert "'the floor' sees 2.50 sigma" in found.where
    assert located(said(verdict), marked(), CATALOGUE).where == ""


def test_without_a_name_the_first_fault_is_the_channel():
    found = located(said("unexplained"), marked("actuation"), CATALOGUE)
    assert (found.channel, lit(found)) == ("actuation", ["actuation"])
    none = located(said("unexplained"), marked(), CATALOGUE)
    assert (none.channel, lit(none)) == ("none", [])
    assert none.where == "No stage on its own has a fault that counts."


def test_without_tests_the_name_still_has_a_channel():
    found = located(said("missing_physics", named("servo_lag")), (), CATALOGUE)
    assert (found.channel, found.where) == ("actuation", "")
    assert replace(found, channel="none") == said("missing_physics", named("servo_lag"))
