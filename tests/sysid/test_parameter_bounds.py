"""A value may be fitted as far from its nominal one as its uncertainty reaches."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import Uncertainty
from rr_opt.sysid.settings import SETTINGS
from tests.sysid.made_up import ROBOT, base_of, experiment, predicted, recorded


def with_a2(given, a2):
    platform2 = replace(given.robot.platform2, a=a2)
    known = {**given.uncertainty, "a2": Uncertainty(2e-3)}
    return replace(given, robot=replace(given.robot, platform2=platform2), uncertainty=known)


@pytest.mark.parametrize("a2", [0.0, 0.001, -0.01, 0.03])
def test_the_centre_of_mass_may_be_on_either_side_of_the_axle(a2):
    given = with_a2(experiment(), a2)
    (one,) = (q for q in RollerRacer(given).parameters if q.name == "a2")
    reach = SETTINGS.effect_prior * given.uncertainty["a2"].sigma
    assert one.low <= a2 - reach
    assert one.high >= a2 + reach


def test_masses_stay_positive():
    for q in RollerRacer(experiment()).parameters:
        if q.name[0] in "mIcb":
            assert 0 < q.low < q.value < q.high


def test_a_centre_of_mass_on_the_axle_can_be_found_behind_it():
    given, true = with_a2(experiment(seconds=20.0), 0.0), -0.004
    made = RollerRacer(with_a2(given, true))
    values = {f"a{i}": one for i, one in ((1, ROBOT.platform1.a), (2, true))}
    values = {q.name: q.value for q in made.parameters} | values
    model = recorded(given, lambda k, start: predicted(made, k, values, (), start), seed=3)
    assert base_of(model).fit.values["a2"] == pytest.approx(true, abs=5e-4)


@pytest.mark.parametrize("kappa", [0.0, 4e-6])
def test_a_value_known_to_a_factor_may_be_anything_usual_if_it_is_0(kappa):
    given = experiment()
    bare = replace(given.robot, platform1=replace(given.robot.platform1, kappa=kappa))
    (one,) = (q for q in RollerRacer(replace(given, robot=bare)).parameters if q.name == "kappa1")
    assert one.low <= kappa < 1e-5 < one.high
    assert one.scale > 0


def test_what_is_known_exactly_is_not_fitted():
    given = experiment()
    exact = replace(given, uncertainty={**given.uncertainty, "m1": Uncertainty(0.0)})
    assert "m1" not in [q.name for q in RollerRacer(exact).parameters]


def test_friction_that_was_left_out_is_found():
    given = experiment(seconds=20.0)
    made = RollerRacer(given)
    values = {q.name: q.value for q in made.parameters}
    bare = replace(given.robot, platform1=replace(given.robot.platform1, kappa=0.0))
    model = recorded(
        replace(given, robot=bare), lambda k, start: predicted(made, k, values, (), start), seed=3
    )
    assert base_of(model).fit.values["kappa1"] == pytest.approx(4e-6, rel=0.1)
