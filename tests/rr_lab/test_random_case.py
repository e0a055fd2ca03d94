"""A random case is plausible, the same for the same seed, and says what is hidden in it."""

import json
from dataclasses import replace

import numpy as np
import pytest

from rr_lab import random_case as module
from rr_lab.case import play, stream
from rr_lab.effects import EVERY, effect_named
from rr_lab.files import answer, seal_of, sealed_text
from rr_lab.random_case import GAUGED, draw_effect, random_case
from rr_lab.run import Motion
from rr_opt.outcome import InputError


def unseen(case):
    """A gauge that costs nothing, by which every strength is right."""
    return 10.0


def drawn(seed, kind, **options):
    return random_case(seed, kind, seconds=2.0, size=unseen, target=10.0, **options)


@pytest.mark.parametrize("seed", range(20))
def test_plausible(seed):
    case = drawn(seed, "null")
    robot = case.nominal
    assert 0.13 <= robot.platform1.c <= 0.24
    assert 0.048 <= robot.platform2.c <= 0.127
    assert 0.0085 <= robot.k1 <= 0.101
    assert len(case.plans) in (7, 8)
    assert [plan.use for plan in case.plans].count("holdout") == 2
    assert {plan.start for plan in case.plans} == {"rest", "running"}
    offsets = [plan.gait.offset for plan in case.plans]
    assert 0.0 in offsets
    assert any(offsets)
    assert max(abs(offset) for offset in offsets) <= 0.36
    assert all(0.65 * 2.0 <= plan.seconds <= 2.0 for plan in case.plans)
    headings = [plan.pose[2] for plan in case.plans]
    assert np.ptp(headings) > 1.0


def test_the_same_seed_gives_the_same():
    one, again = (drawn(5, "pair") for _ in range(2))
    assert one == again
    assert drawn(6, "pair") != one
    first, second = (
        play(replace(each, plans=each.plans[:1]), step=1e-3).runs[0].recording
        for each in (one, again)
    )
    np.testing.assert_array_equal(first.values["x"], second.values["x"])


@pytest.mark.parametrize(
    ("kind", "verdict", "count"),
    [
        ("null", "consistent", 0),
        ("single", "missing_physics", 1),
        ("pair", "missing_physics", 2),
        ("outside", "unexplained", 1),
    ],
)
def test_kinds(kind, verdict, count):
    case = drawn(3, kind)
    told = answer(case)
    assert told["verdict"] == verdict
    assert len(told["effects"]) == count
    assert case.robot == case.nominal


@pytest.mark.parametrize(
    "effect", [each for each in EVERY if each.named], ids=lambda each: each.key
)
def test_answer_has_name_realisation_and_values(effect):
    told = answer(drawn(4, f"single:{effect.key}"))["effects"][0]
    assert told["name"] == effect.name
    assert told.get("realisation", "") == effect.realisation
    assert told["parameters"] or effect.realisation in ("medium_density", "delay")
    assert tuple(told.get("same_as", ())) == effect.same_as
    for key, given in told["parameters"].items():
        assert given["unit"] == effect_named(effect.name).accepted[key].unit
        assert np.isfinite(given["value"])
    for key, given in told.get("plant", {}).items():
        assert given["unit"] == effect.accepted[key].unit


@pytest.mark.parametrize("seed", range(8))
def test_wrong_values_are_told_and_wrong(seed):
    case = drawn(seed, "parameters")
    told = {each["name"]: each["parameters"] for each in answer(case)["effects"]}
    assert set(told) == set(case.changed)
    for name in told:
        true, believed = (
            getattr(robot.platform1 if name[-1] == "1" else robot.platform2, name[:-1])
            for robot in (case.robot, case.nominal)
        )
        assert told[name][name]["value"] == pytest.approx(true)
        known = case.uncertainty[name]
        if known.factor is None:
            assert abs(true - believed) >= 3.99 * known.sigma
        else:
            assert 1.49 < max(true / believed, believed / true) < known.factor


def test_engines_are_given_the_same_case_and_tell_themselves():
    one, other = (drawn(5, "single:floor_tilt", engine=engine) for engine in ("mujoco", "planar"))
    assert replace(other, engine="mujoco") == one
    assert [answer(case)["engine"] for case in (one, other)] == ["mujoco", "planar"]
    assert json.loads(sealed_text(other))["engine"] == "planar"


def test_spread_moves_the_values_within_their_uncertainty():
    case = drawn(1, "null", spread=1.0)
    assert answer(case)["verdict"] == "consistent"
    assert case.robot != case.nominal
    off = (case.robot.platform1.I - case.nominal.platform1.I) / case.uncertainty["I1"].sigma
    assert 0 < abs(off) <= 2.5


@pytest.mark.parametrize("kind", ["doubles", "single:gremlins", "null:servo_lag", "random:tether"])
def test_unknown_kinds_are_refused(kind):
    with pytest.raises(InputError, match="laboratory"):
        drawn(1, kind)


def test_a_seal_gives_nothing_away():
    case = drawn(7, "single")
    one, other = sealed_text(case), sealed_text(case)
    assert seal_of(one) != seal_of(other)
    assert seal_of(one) == seal_of(one)


@pytest.mark.parametrize("key", ["floor_patch/disc", "floor_patch/edge", "tether"])
def test_places_are_on_runs_that_set_the_strength(key, monkeypatch):
    case, driven = drawn(3, "null"), []

    def still(_, plan, *args):
        driven.append(plan)
        return Motion(*np.zeros((3, 10, 3)))

    monkeypatch.setattr(module, "motion_of", still)
    for seed in range(20):
        draw_effect(stream(seed), effect_named(key), case)
    assert set(driven) == set(case.plans[:GAUGED])
