"""At its neutral value every effect of the catalogue vanishes; at its usual size it does not."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Effect, Parameter
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.motion.dynamics import derive, dynamics_of, steady_effects
from rr_opt.motion.floor_motion import free_joint
from tests.mechanics.cases import REPEATABLE, State, cases, energy, motion, robots, sides
from tests.mechanics.floor import MECHANICAL, on_floor, what_is_seen
from tests.robots import BENCHMARK

STEADY = sorted(steady_effects())
HOLDING = [name for name in MECHANICAL if name != "lateral_slip"]
"""Axles that may slip never hold quite; see test_lateral_slip."""
ACTING = [name for name, effect in CATALOGUE.items() if effect.actuate]
OBSERVED = [name for name, effect in CATALOGUE.items() if effect.observe]
GAIT = SineGait(0.6, 1.0, 0.1)
TIMES = np.linspace(0.0, 3.0, 61)
PLACE = np.array([0.3, -0.2, 0.7])


def neutral(effect: Effect) -> dict[str, float]:
    return {q.name: q.neutral for q in effect.parameters}


def usual(effect: Effect, parameter: Parameter) -> dict[str, float]:
    return neutral(effect) | {parameter.name: parameter.typical}


@pytest.mark.parametrize("name", STEADY)
def test_neutral_effect_changes_no_steady_cycle(name):
    use = EffectUse(name, neutral(CATALOGUE[name]))

    @REPEATABLE
    @given(cases())
    def same(case):
        robot, state = case
        with_it = replace(robot, physics=(use,))
        for quantity in (motion, sides, energy):
            there = quantity(with_it, state, derive((name,)))
            assert there == pytest.approx(quantity(robot, state), rel=1e-10, abs=1e-12)

    same()


@pytest.mark.parametrize(
    ("name", "parameter"), [(name, q) for name in STEADY for q in CATALOGUE[name].parameters]
)
def test_what_a_robot_gives_is_worked_out_alike(name, parameter):
    robot = replace(BENCHMARK, physics=(EffectUse(name, usual(CATALOGUE[name], parameter)),))
    state = State(0.3, 0.4, -2.0, 9.0)
    for quantity in (motion, sides, energy):
        whole = quantity(robot, state, derive((name,)))
        assert quantity(robot, state) == pytest.approx(whole, rel=1e-12)


def test_drag_at_the_wheels_does_not_pay_for_that_of_the_bodies():
    robot = replace(BENCHMARK, physics=(EffectUse("quadratic_drag", {"coefficient_total": 0.3}),))
    whole = derive(("quadratic_drag",)).motion.n_instructions()
    assert dynamics_of(robot).motion.n_instructions() < 0.9 * whole


@pytest.mark.parametrize("name", HOLDING)
def test_neutral_effect_changes_nothing_on_the_floor(name):
    use = EffectUse(name, neutral(CATALOGUE[name]))

    @settings(REPEATABLE, max_examples=8)
    @given(cases())
    def same(case):
        robot, state = case
        there = on_floor(replace(robot, physics=(use,)), state, PLACE)
        here = on_floor(robot, state, PLACE)
        assert np.hstack(there) == pytest.approx(np.hstack(here), rel=1e-8, abs=1e-8)

    same()


@pytest.mark.parametrize("name", ACTING)
@pytest.mark.parametrize("rest", [True, False], ids=["from rest", "running"])
def test_neutral_effect_changes_no_angle(name, rest):
    command = commanded(GAIT, rest)
    made = CATALOGUE[name].actuate(command, neutral(CATALOGUE[name]), free_joint(BENCHMARK))
    np.testing.assert_allclose(made.at(TIMES), command.at(TIMES), rtol=1e-12, atol=1e-12)
    assert made.smooth


@pytest.mark.parametrize("name", OBSERVED)
def test_neutral_effect_is_not_seen(name):
    seen = what_is_seen((name,), PLACE, 0.4, neutral(CATALOGUE[name]))
    np.testing.assert_allclose(seen, [*PLACE, 0.4], atol=1e-15)


ONE_BY_ONE = [
    (name, parameter)
    for name in MECHANICAL
    if name != "floor_patch"  # its place is nothing without its strength; see test_floor_patch
    for parameter in CATALOGUE[name].parameters
    # Felt by slow wheels alone, and by those that slide: test_onset_of_dry_friction and
    # test_lateral_slip.
    if parameter.name not in ("onset", "mu_ratio")
]


@pytest.mark.parametrize(
    ("name", "parameter"), ONE_BY_ONE, ids=lambda part: getattr(part, "name", part)
)
def test_each_parameter_at_its_usual_size_is_felt(name, parameter):
    effect = CATALOGUE[name]
    state = State(v=0.2, phi=0.5, dphi=2.0, ddphi=5.0)

    @settings(REPEATABLE, max_examples=8)
    @given(robots())
    def felt(robot):
        plain, other = (
            on_floor(replace(robot, physics=(EffectUse(name, values),)), state, PLACE, (0.02, 0.01))
            for values in (neutral(effect), usual(effect, parameter))
        )
        assert np.hstack(plain) != pytest.approx(np.hstack(other), rel=1e-6)

    felt()


@pytest.mark.parametrize("name", ACTING)
def test_servo_at_its_usual_size_is_seen(name):
    effect = CATALOGUE[name]
    parameter = effect.parameters[0]
    command = commanded(GAIT, False)
    made = effect.actuate(command, {parameter.name: parameter.typical}, free_joint(BENCHMARK))
    assert np.ptp(made.at(TIMES)[0] - command.at(TIMES)[0]) > 1e-3 or name == "servo_offset"
    assert np.abs(made.at(TIMES)[0] - command.at(TIMES)[0]).max() > 1e-3
