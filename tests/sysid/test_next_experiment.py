"""The next recording is one the robot can make, and tells something."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer import next_experiment as module
from rr_opt.machines.racer.next_experiment import _plans, next_experiment
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid.candidates import fitted
from rr_opt.sysid.model import Choice
from tests.sysid.made_up import GAITS, ROBOT, base_of, with_effect

FRICTION = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}
DRAG = {"quadratic_drag.coefficient_total": 0.2}


@pytest.fixture(scope="module")
def case():
    model = with_effect(FRICTION, ("coulomb_friction",))
    base = base_of(model).fit
    coulomb = fitted(model, [Choice("coulomb_friction")], base, [FRICTION]).fit
    return model, coulomb, fitted(model, [Choice("quadratic_drag")], base, [DRAG]).fit


def test_every_gait_is_within_the_servo_and_away_from_the_singular_posture(case):
    c1, c2 = ROBOT.platform1.c, ROBOT.platform2.c
    plans = _plans(case[0])
    assert len(plans) > 10
    for plan in plans:
        t = np.linspace(0, plan.gait.period, 400)
        assert np.abs(plan.gait.angle(t)).max() <= ROBOT.servo.angle_limit
        assert np.abs(plan.gait.rate(t)).max() <= ROBOT.servo.rate_limit
        assert (c1 * np.cos(plan.gait.angle(t)) + c2).min() > 0.2 * (c1 + c2)


def test_it_tells_the_answer_from_its_rival(case):
    model, coulomb, drag = case
    told = next_experiment(model, coulomb, ("quadratic_drag", drag))
    assert told is not None
    assert told.between == ("coulomb_friction", "quadratic_drag")
    assert told.separation > 0.3
    said = f"a model with quadratic drag would miss this recording by {told.separation:.1f} sigma"
    assert f"If the cause is Coulomb friction, {said}" in told.sentence
    assert "psi = " in told.sentence
    assert told.sentence.endswith("Add it to experiment.yaml and diagnose again.")
    # A rival that predicts the same leaves nothing to tell: a value is narrowed down instead.
    same = next_experiment(model, coulomb, ("its double", coulomb))
    assert same is not None
    assert same.between[1] != "its double"


def test_without_a_rival_it_narrows_down_a_value(case):
    model, coulomb, _ = case
    told = next_experiment(model, coulomb, None)
    assert told is not None
    assert told.between[1] in coulomb.problem.names
    narrower = float(told.sentence.rpartition("a factor of ")[2].partition(". ")[0])
    assert narrower > 1.2


def test_a_recording_that_narrows_no_value_is_not_recommended(case, monkeypatch):
    model, coulomb, _ = case
    monkeypatch.setattr("rr_opt.machines.racer.next_experiment._NARROWER", 1e3)
    assert next_experiment(model, coulomb, None) is None


def test_no_gait_that_the_servo_can_do_is_no_plan(case):
    model, *fits = case
    slow = replace(ROBOT, servo=replace(ROBOT.servo, rate_limit=0.1))
    still = RollerRacer(replace(model.experiment, robot=slow))
    assert next_experiment(still, fits[0], ("quadratic_drag", fits[1])) is None
    assert next_experiment(still, fits[0], None) is None


def test_the_rivals_initial_states_suit_it(monkeypatch):
    tilt = {"floor_tilt.tilt_x": 0.004, "floor_tilt.tilt_y": 0.004}
    model = with_effect(tilt, ("floor_tilt",), gaits=GAITS[:2])
    base = base_of(model).fit
    best = fitted(model, [Choice("floor_tilt")], base, [tilt]).fit

    def separation(steps: int) -> float:
        monkeypatch.setattr(module, "_STATE_STEPS", steps)
        told = next_experiment(model, best, ("other parameters", base))
        assert told is not None
        return told.separation

    assert separation(3) == pytest.approx(separation(20), rel=0.02)
    assert separation(0) > 1.2 * separation(20)
