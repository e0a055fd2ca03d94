"""A fastest gait has its robot's effects in it, and says which the optimiser does not know."""

from dataclasses import replace

import numpy as np
import pytest

import rr_opt as rr
from rr_lab.effects import rig_with
from rr_lab.planar.drive import drive
from rr_lab.run import Conditions
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.model.robot import EffectUse
from rr_opt.motion.steady_cycle import cycle_of
from rr_opt.routing.plan import RoutePlan
from tests.robots import BENCHMARK

EFFECTS = {
    "servo_lag": {"tau": 0.06},
    "servo_backlash": {"width": 0.03},
    "lateral_slip": {"creep_compliance": 0.02},
}


@pytest.fixture(params=EFFECTS, scope="module")
def found(request):
    robot = replace(BENCHMARK, physics=(EffectUse(request.param, EFFECTS[request.param]),))
    gait = GaitBounds(period=Interval(0.5, 2.0), offset=Interval(0.0, 0.0))
    return rr.maximize_speed(Problem(robot, gait=gait))


def test_the_laboratory_reaches_the_speed(found):
    gait, periods = found.gait, 20
    running = Conditions(gait.period, "running", rate=64 / gait.period, periods=periods)
    motion = drive(rig_with(found.robot), gait, running)
    reached = cycle_of(gait.period, *motion.one[:65].T).speed
    assert reached == pytest.approx(found.speed, rel=0.01)


def test_checks_that_lack_an_effect_do_not_confirm_the_answer(found):
    (name,) = (use.name for use in found.robot.physics)
    known = name == "servo_lag"
    assert ("every check confirms it." in found.message) == known
    assert (f"does not model {name}" in found.message) == (not known)
    assert bool(found.warnings) == (not known)
    assert found.record()["driven"]["beyond_optimiser"] == ([] if known else [name])
    assert any(name in check.sentence for check in found.checks)


def test_its_file_is_driven_alike(found, tmp_path):
    found.save(tmp_path, figures=False)
    simulated = rr.simulate(tmp_path / "result.json", seconds=5, start="steady")
    if found.robot.physics[0].name != "lateral_slip":  # which a simulation leaves out
        assert simulated.measured.speed == pytest.approx(found.speed, rel=2e-3)
    assert np.isfinite(simulated.measured.peak_torque)


LIMIT = 2.0
"""rad/s, below the limit of the servo without effects."""


@pytest.fixture
def limited():
    values = {"servo_rate_limit": {"rate_limit": LIMIT}, "servo_lag": {"tau": 0.1}}
    uses = tuple(EffectUse(*use) for use in values.items())
    gait = GaitBounds(Interval(0.1, 1.0), Interval(0.5, 2.0), Interval(0.0, 0.0))
    return Problem(replace(BENCHMARK, physics=uses), gait=gait)


def assert_posed(result):
    """The servo's rate limit is one of the gaits, and only its lag is ignored."""
    assert result.problem.limits.rate == LIMIT
    (warning,) = result.warnings
    assert warning.startswith("servo_lag is ignored")
    assert "servo_rate_limit" not in warning


def test_a_sweep_keeps_the_servos_rate_limit(limited):
    swept = rr.sweep(limited, 60)
    assert_posed(swept)
    assert swept.best.gait.peak_rate == pytest.approx(LIMIT)


def test_a_turn_chart_keeps_it(limited, monkeypatch):
    monkeypatch.setattr("rr_opt.api.turn._TESTED", (6, 4, 11))
    chart = rr.turn_chart(limited)
    assert_posed(chart)
    rate = 2 * np.pi * chart.seen.amplitude[:, None] / chart.seen.period
    assert 0 < rate[chart.seen.keeps.any(axis=2)].max() <= LIMIT * (1 + 1e-6)


def test_a_route_is_planned_with_it(limited, monkeypatch):
    def none(route, *_, **__):
        return RoutePlan(rr.Status.INFEASIBLE, "None.", route, route.problem, "forward")

    monkeypatch.setattr("rr_opt.api.route.plan_route", none)
    found = rr.route(rr.Route(limited, (rr.Straight(1),)))
    assert found.plan.problem.limits.rate == LIMIT
    assert all("servo_rate_limit" not in warning for warning in found.warnings)
