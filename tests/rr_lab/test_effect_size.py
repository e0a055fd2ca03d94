"""Strength is set to the visibility that is asked for, whatever tells it."""

import math
from dataclasses import replace

import pytest

from rr_lab.case import record
from rr_lab.effect_size import EffectSize, scaled_to, scaled_use
from rr_lab.random_case import random_case
from rr_opt.model.experiment import Noise
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import fitted


def case_with(name, **values):
    case = random_case(2, "null", seconds=6.0)
    return replace(case, effects=(EffectUse(name, values),))


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
def test_meets_the_target(power):
    case = case_with("servo_offset", offset=0.01)

    def visibility(tried):
        return 1000 * tried.effects[0].values["offset"] ** power

    found, reached = scaled_to(case, 7.0, visibility)
    assert reached == pytest.approx(7.0, rel=0.11)
    assert visibility(found) == reached


def test_stops_at_what_is_believable():
    found, reached = scaled_to(case_with("servo_lag", tau=0.1), 50.0, lambda _: 2.0)
    assert found.effects[0].values["tau"] <= 0.3
    assert reached == 2.0


@pytest.mark.parametrize(
    ("name", "values", "twice"),
    [
        ("floor_patch", {"multiplier": 3.0, "x": 1.0}, {"multiplier": 5.0, "x": 1.0}),
        ("lateral_slip", {"mu": 0.1}, {"mu": 0.05}),
        ("com_offset", {"d1": -2e-3}, {"d1": -4e-3}),
        ("tether", {"stiffness": 0.1, "slack": 0.2}, {"stiffness": 0.2, "slack": 0.2}),
    ],
)
def test_twice_as_strong(name, values, twice):
    assert scaled_use(EffectUse(name, values), 2.0).values == pytest.approx(twice)


def test_own_gauge_agrees_with_the_reduced_model():
    """Which has its own nominal motion, and fits the initial state in its own way."""
    case = replace(case_with("coulomb_friction", force1=1e-3, force2=1e-3), noise=Noise(1e-3, 3e-3))
    plan = case.plans[0]
    seen = record(
        case.robot, plan.gait, plan.seconds, plan.start, case.effects, periods=plan.periods
    )
    # phi is its command, and thus a fourth channel without deviation.
    expected = fitted(case.nominal, plan.gait, seen).rms * math.sqrt(3 / 4)
    assert expected > 0.5
    assert EffectSize.of(case, 1)(case) == pytest.approx(expected, rel=0.06)


def test_own_gauge_sees_no_initial_state():
    case = case_with("servo_lag", tau=0.1)
    moved = replace(case.plans[0], pose=(1.0, -2.0, 3.0))
    gauge = EffectSize.of(replace(case, plans=(moved,)), 1)
    assert gauge(replace(case, effects=())) < 1e-6
