"""A candidate is told with the values of the effects that it adds, not with those of the robot."""

from types import SimpleNamespace
from typing import Any

from rr_opt.sysid.verdict import tried


def test_values_of_effects_that_the_robot_has_are_not_the_candidates():
    values = {"m1": 0.5, "coulomb_friction.force1": 0.02, "servo_lag.tau": 0.03}
    fit = SimpleNamespace(values=values, excess=0.1)
    candidates = {
        effects: SimpleNamespace(effects=effects, choices=effects, elpd=0.0, fit=fit)
        for effects in ((), ("servo_lag",))
    }
    selection: Any = SimpleNamespace(tried=candidates)
    told = {one.effects: one.values for one in tried(selection, None)}
    assert told == {(): {}, ("servo_lag",): {"servo_lag.tau": 0.03}}
