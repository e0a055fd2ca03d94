"""With an effect more a fit never ends above that without it."""

from dataclasses import replace

import pytest

from rr_opt.sysid import candidate as module
from rr_opt.sysid import selection as rounds
from rr_opt.sysid.candidate import Chosen, explain
from rr_opt.sysid.selection import _Whole
from tests.sysid.made_up import base_of, with_effect


@pytest.mark.parametrize("astray", [False, True])
def test_a_fit_that_went_astray_is_made_again(monkeypatch, astray):
    values = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}
    model = with_effect(values, ("coulomb_friction",), seconds=5.0)
    base, one = base_of(model), Chosen("coulomb_friction")
    fit = explain(model, [one], base.windows, base.windows)
    joined = rounds.joined
    ways = []

    def far(model, fit):
        ways.append("whole")
        whole = joined(model, fit)
        return replace(whole, cost=10 * base.whole.cost) if astray else whole

    def solve(*args, **options):
        ways.append("again")
        return rounds_solve(*args, **options)

    rounds_solve = rounds.solve
    monkeypatch.setattr(rounds, "joined", far)
    monkeypatch.setattr(rounds, "solve", solve)
    found = _Whole(model, base, one, fit)()
    assert ways == (["whole", "again"] if astray else ["whole"])
    assert found.whole.cost < 1.05 * found.whole.count
    assert found.chosen == (one,)


def test_windows_that_went_astray_are_fitted_again(monkeypatch):
    values = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}
    model = with_effect(values, ("coulomb_friction",), seconds=5.0)
    base, dry = base_of(model), Chosen("coulomb_friction")
    less = explain(model, [dry], base.windows, base.windows)
    way, first = module._from_best, []

    def astray(problem, start, *rest):
        fit = way(problem, start, *rest)
        first.append(start)
        return replace(fit, cost=10 * less.cost) if len(first) == 1 else fit

    monkeypatch.setattr(module, "_from_best", astray)
    both = explain(model, [dry, Chosen("floor_tilt")], base.windows, less)
    assert first[-1] is less
    assert both.cost <= less.cost
