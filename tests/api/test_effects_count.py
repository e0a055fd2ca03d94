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
