"""The next recording is one the robot can make, and tells as much as it promises."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer import next_experiment as next_experiment_module
from rr_opt.machines.racer import next_experiment as plans
from rr_opt.machines.racer.next_experiment import (
    Contest,
    Plan,
    allowed,
    as_rival,
    gaits,
    imagined,
    next_experiment,
)
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.gait import SineGait
from rr_opt.sysid.candidate import Chosen
from rr_opt.sysid.least_squares import Problem, doubt, solve
from rr_opt.sysid.model import Piece
from tests.sysid.made_up import ROBOT, base_of, explained, with_effect


@pytest.fixture(scope="module")
def case():
    values = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}
    model = with_effect(values, ("coulomb_friction",))
    base = base_of(model)
    found = [explained(model, base, Chosen(n)) for n in ("coulomb_friction", "quadratic_drag")]
    return model, *found


def test_every_gait_is_within_the_servo_and_away_from_the_singular_posture():
    c1, c2 = ROBOT.platform1.c, ROBOT.platform2.c
    found = gaits(ROBOT)
    assert found
    for gait in found:
        t = np.linspace(0, gait.period, 400)
        assert np.abs(gait.angle(t)).max() <= ROBOT.servo.angle_limit
        assert np.abs(gait.rate(t)).max() <= ROBOT.servo.rate_limit
        assert (c1 * np.cos(gait.angle(t)) + c2).min() > 0.2 * (c1 + c2)
    assert not allowed(ROBOT, SineGait(1.9, 2.0))


def test_the_plan_tells_what_it_promises_when_it_is_made_and_all_is_fitted_again(case, monkeypatch):
    model, coulomb, drag = case
    # What was known beforehand counts as it does now, whatever the new recording says.
    present = doubt(drag.whole.cost, drag.whole.count)
    monkeypatch.setattr("rr_opt.sysid.least_squares.doubt", lambda *_: present)
    told = next_experiment(model, coulomb, drag)
    assert told is not None
    gait = SineGait(told.amplitude, told.period, told.offset)
    assert allowed(ROBOT, gait)
    begin = "rest" if told.start == "rest" else "running"
    plan = Plan(gait, told.seconds, begin, told.heading)
    made = imagined(model, [plan], 100.0, coulomb.whole.values, coulomb.whole.effects)
    runs = (*model.experiment.runs, *made.model.experiment.runs)
    both = RollerRacer(replace(model.experiment, runs=runs))
    ((piece, start),) = made.starts.items()
    new = Piece(len(runs) - 1, 0, piece.last)
    pieces = (*drag.whole.starts, new)
    problem = Problem(both, pieces, drag.whole.effects, drag.whole.quantities)
    starts = {**drag.whole.starts, new: start}
    again = solve(problem, drag.whole.values, starts)
    values = made.model.runs[0].values.size
    more = math.sqrt(max(again.cost - drag.whole.cost, 0.0) / values)
    assert more == pytest.approx(told.separation, rel=0.25)


def test_the_winner_tells_more_than_what_was_recorded_already_does(case):
    model, coulomb, drag = case
    contest = Contest(model, coulomb, as_rival(drag), math.inf)
    told = next_experiment(model, coulomb, drag)
    assert told is not None
    old = [
        Plan(SineGait(g.amplitude, g.period, g.offset), 30.0, run.start, 0.0)
        for run in model.experiment.runs
        for g in [run.gait]
    ]
    assert told.separation > max(contest.promises(old))
    assert "coulomb friction and quadratic drag" in told.sentence


def test_without_a_rival_it_narrows_down_a_value(case):
    model, coulomb, _ = case
    told = next_experiment(model, coulomb)
    assert told is not None
    assert "would tell most about" in told.sentence
    then, now = (float(told.sentence.split(word)[1].split()[0].rstrip(".")) for word in
                 ("be known to ", "instead of "))  # fmt: skip
    assert then < now


def test_no_gait_that_the_servo_can_do_is_no_plan(case, monkeypatch):
    model, *_ = case
    slow = replace(ROBOT, servo=replace(ROBOT.servo, rate_limit=0.1))
    assert not gaits(slow)
    monkeypatch.setattr(next_experiment_module, "gaits", lambda robot: gaits(slow))
    assert next_experiment(*case) is None
    assert next_experiment(model, case[1]) is None


def test_a_plan_that_leaves_the_numbers_takes_no_other_with_it(case, monkeypatch):
    model, best, rival = case
    contest = Contest(model, best, as_rival(rival), room=10.0)
    every = [Plan(gait, 10.0, "rest", 0.0) for gait in gaits(model.experiment.robot)[:3]]
    alone = contest.promises(every[:2])
    driven = plans._driven

    def lost(*arguments):
        empty, predicted = driven(*arguments)
        return empty, [*predicted[:-1], *(np.full_like(one, np.nan) for one in predicted[-1:])]

    monkeypatch.setattr(plans, "_driven", lost)
    assert contest.promises(every) == pytest.approx([*alone, 0.0])
