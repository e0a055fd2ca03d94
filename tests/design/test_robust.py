"""95 % of the robots that a file may mean reach the speed of the robust gait within the limits."""

from dataclasses import replace

import numpy as np
import pytest

import rr_opt as rr
from rr_opt.design.robust import robust_gait
from rr_opt.design.sines import refine_sine
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem, Spreads
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.steady_cycle import peak_torque, steady_cycle
from rr_opt.outcome import InputError
from rr_opt.verify.speeds import drawn

ROBOT = Robot(
    Platform(0.3049, 0.002099, 0.2396, 0.04239, 0.0584, 0.01778 * 0.03**2),
    Platform(0.4795, 0.003077, 0.1534, -0.0257, 0.02246, 0.01119 * 0.03**2),
    0.03,
)
SPREADS = Spreads(kappa="20 %", I="5 %")
PROBLEM = Problem(
    ROBOT,
    Limits(1.303, 6.16, 0.1254, 0.01),
    GaitBounds(Interval(0.05, 1.13), Interval(0.531, 2.38), Interval(0.207, 0.765)),
    robust=SPREADS,
)


@pytest.fixture(scope="module")
def found():
    return rr.maximize_speed(PROBLEM)


def simulated(gait, count, seed):
    """Signed speed and peak torque of robots drawn here, by integration."""
    rng = np.random.default_rng(seed)

    def platform(part):
        I, kappa = np.exp([0.05, 0.2] * rng.standard_normal(2))
        return replace(part, I=I * part.I, kappa=kappa * part.kappa)

    robots = [
        replace(ROBOT, platform1=platform(ROBOT.platform1), platform2=platform(ROBOT.platform2))
        for _ in range(count)
    ]
    cycles = [steady_cycle(robot, gait, steps=128) for robot in robots]
    return np.array([(one.speed, peak_torque(one)) for one in cycles]).T


def test_the_share_that_it_says(found):
    """Of 400 robots by integration; three standard deviations of a share are 3.3 %."""
    speed, torque = simulated(found.robust.gait, 400, 7)
    assert 0.917 <= (speed <= found.robust.speed).mean() <= 0.983
    assert (torque <= PROBLEM.limits.torque).mean() >= 0.917
    assert found.status.name == "OPTIMAL"


def test_certainty_costs(found):
    robust = found.robust
    assert abs(robust.speed) < abs(robust.nominal) < abs(found.speed)
    assert robust.kept == pytest.approx(0.5, abs=0.1)


def test_no_gait_next_to_it_is_better(found):
    """None that as many robots keep the limit with takes 95 % of them further."""
    gait, rng = found.robust.gait, np.random.default_rng(3)
    for _ in range(60):
        alpha, T = rng.normal(1.0, 0.03, 2)
        other = SineGait(alpha * gait.amplitude, T * gait.period, gait.offset)
        seen = drawn(ROBOT, other, SPREADS)
        if seen.keeping(PROBLEM.limits.torque) >= 0.95:
            assert abs(seen.reached(0.95)) <= abs(found.robust.speed) * (1 + 2e-3)


def test_a_robot_that_is_known_has_the_nominal_optimum():
    sure = rr.maximize_speed(replace(PROBLEM, robust=Spreads(kappa=1e-6)))
    assert sure.robust.speed == pytest.approx(sure.speed, rel=1e-4)


def test_a_gait_that_is_lost_when_refined_is_no_answer(found, monkeypatch):
    def lost(setting, candidate):
        return replace(refine_sine(setting, candidate), success=False)

    monkeypatch.setattr("rr_opt.design.robust.refine_sine", lost)
    assert robust_gait(found.optimum, SPREADS) is None


def test_what_is_not_known_is_refused():
    with pytest.raises(InputError, match="maximize-speed"):
        rr.turn(PROBLEM, radius=1.0)
