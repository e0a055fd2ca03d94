"""At its neutral value every effect of the catalogue vanishes; at its usual size it does not."""

from dataclasses import replace

import pytest
from hypothesis import given

from rr_opt.physics.effects import CATALOGUE
from rr_opt.robot.parameters import EffectUse
from tests.physics.cases import REPEATABLE, State, cases, energy, motion, robots, sides


@pytest.mark.parametrize("effect", CATALOGUE.values(), ids=lambda effect: effect.name)
def test_neutral_effect_changes_nothing(effect):
    use = EffectUse(effect.name, {p.name: p.neutral for p in effect.parameters})

    @REPEATABLE
    @given(cases())
    def same(case):
        robot, state = case
        neutral = replace(robot, physics=(use,))
        for quantity in (motion, sides, energy):
            there = quantity(neutral, state)
            assert there == pytest.approx(quantity(robot, state), rel=1e-10, abs=1e-12)

    same()


@pytest.mark.parametrize("name", CATALOGUE)
def test_each_parameter_at_its_usual_size_is_felt(name):
    effect = CATALOGUE[name]
    state = State(v=0.2, phi=0.5, dphi=2.0, ddphi=5.0)

    @REPEATABLE
    @given(robots())
    def felt(robot):
        for p in effect.parameters:
            values = {q.name: q.neutral for q in effect.parameters} | {p.name: p.typical}
            with_it = replace(robot, physics=(EffectUse(name, values),))
            assert motion(with_it, state).vdot != pytest.approx(motion(robot, state).vdot, rel=1e-6)

    felt()
