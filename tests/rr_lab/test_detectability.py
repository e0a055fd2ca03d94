"""What other values of the parameters explain is invisible after a re-fit, and what they do not is
visible."""

from dataclasses import replace

import numpy as np
import pytest

from rr_lab.effect_size import Detectability, EffectSize, moved_robot
from rr_lab.random_case import bare_case
from rr_opt.model.parameters import with_parameters
from rr_opt.model.robot import EffectUse


@pytest.fixture(scope="module")
def case():
    """Three short runs of a robot drawn at random, two of them to fit."""
    drawn = bare_case(3, 4.0)
    uses = ("fit", "fit", "holdout")
    plans = tuple(
        replace(plan, use=use, periods=1, start="running")
        for plan, use in zip(drawn.plans[:3], uses, strict=True)
    )
    return replace(drawn, plans=plans)


@pytest.fixture(scope="module")
def refit(case):
    return Detectability.of(case)


def test_nothing_leaves_nothing(case, refit):
    assert refit.remains(case) < 1e-6


def test_values_within_what_is_known_leave_nothing(case, refit):
    moved = np.linspace(-0.4, 0.4, len(case.uncertainty))
    other = replace(case, robot=moved_robot(case, moved))
    seen = EffectSize.of(case)(other)
    assert seen > 0.2
    assert refit.remains(other) < 0.02 * seen


def test_a_value_far_outside_is_not_explained_away(case, refit):
    other = replace(case, robot=with_parameters(case.robot, {"c1": 1.3 * case.robot.platform1.c}))
    assert refit.remains(other) > 1


def test_an_effect_of_another_kind_stays(case, refit):
    tilted = replace(case, effects=(EffectUse("floor_tilt", {"tilt_x": 5e-3, "tilt_y": 0.0}),))
    assert refit.remains(tilted) > 0.3 * EffectSize.of(case)(tilted)


@pytest.mark.parametrize(
    "use",
    [
        EffectUse("floor_tilt", {"tilt_x": 5e-3, "tilt_y": 0.0}),
        EffectUse("servo_backlash", {"width": 0.05}),
        EffectUse("lateral_slip", {"creep_compliance": 0.6}),
    ],
    ids=lambda use: use.name,
)
def test_the_step_drops_out(case, refit, use, monkeypatch):
    """What is left is the same with a fifth of the step, and a tenth for the derivatives."""
    hidden = replace(case, effects=(use,))
    coarse = refit.remains(hidden)
    assert coarse > 0.5
    for name in ("STEP", "DIRECTIONS"):
        monkeypatch.setattr(f"rr_lab.effect_size.{name}", 1e-3)
    assert Detectability.of(case).remains(hidden) == pytest.approx(coarse, rel=0.03)


def test_the_finer_step_of_parts_that_strike_drops_out(case):
    """A pin as good as tight leaves nothing, though the planar engine drives it with finer steps
    than the nominal robot."""
    planar = replace(case, engine="planar")
    hidden = replace(planar, effects=(EffectUse("loose_pin", {"clearance": 1e-9}),))
    assert Detectability.of(planar).remains(hidden) < 3e-3


def test_a_friction_of_which_nothing_is_known_may_move_by_its_factor(case):
    name = list(case.uncertainty).index("kappa1")
    robot = moved_robot(case, np.eye(len(case.uncertainty))[name])
    assert robot.platform1.kappa == pytest.approx(5 * case.nominal.platform1.kappa)
    assert replace(robot, platform1=case.nominal.platform1) == case.nominal
