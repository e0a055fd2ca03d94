"""Cost of transport as objective and as limit: one front from two sides, and prices on it."""

from dataclasses import replace

import numpy as np
import pytest

import rr_opt as rr
from benchmarks.optimise.problems import PROBLEMS
from rr_opt.api.optimise import maximize_speed as checked
from rr_opt.design.landscape import mean_positive
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.formatting import number
from rr_opt.model.robot import EffectUse
from rr_opt.motion.steady_cycle import energy, steady_cycle
from rr_opt.outcome import InputError, Status
from rr_opt.verify.fourier import positive_mean

NAMES = ["straight_torque", "paper_torque"]


def limited(problem, **limits):
    return replace(problem, limits=replace(problem.limits, **limits))


def cheapest(problem, **limits):
    return replace(limited(problem, **limits), objective="cost_of_transport")


@pytest.fixture(scope="module", params=NAMES)
def case(request):
    problem = PROBLEMS[request.param]
    floor = 0.6 * abs(maximize_speed(problem).best.speed)
    return problem, floor, maximize_speed(cheapest(problem, speed=floor)).best


def test_the_fastest_gait_at_that_cost_is_the_cheapest_at_that_speed(case):
    problem, floor, cheap = case
    fast = maximize_speed(limited(problem, cost_of_transport=cheap.cost)).best
    assert abs(cheap.speed) == pytest.approx(floor, rel=1e-7)
    assert fast.speed == pytest.approx(cheap.speed, rel=1e-7)
    assert fast.gait.amplitude == pytest.approx(cheap.gait.amplitude, rel=1e-5)
    assert fast.prices["cost_of_transport"] * cheap.prices["speed"] == pytest.approx(-1, rel=1e-4)


def test_the_price_of_the_least_speed_is_the_cost_of_more(case):
    problem, floor, cheap = case
    step = 1e-3 * floor
    less, more = (
        maximize_speed(cheapest(problem, speed=floor + side * step)).best.cost for side in (-1, 1)
    )
    assert cheap.prices["speed"] == pytest.approx(-(more - less) / (2 * step), rel=1e-3)


def test_the_price_of_power_is_the_speed_of_more(case):
    problem, _, _ = case
    optimum = maximize_speed(problem)
    half = energy(optimum.robot, steady_cycle(optimum.robot, optimum.best.gait)).power / 2
    step = 1e-3 * half
    less, here, more = (
        maximize_speed(limited(problem, power=half + side * step)).best for side in (-1, 0, 1)
    )
    slope = (abs(more.speed) - abs(less.speed)) / (2 * step)
    assert here.prices["power"] == pytest.approx(slope, rel=1e-3)


def test_every_check_confirms_the_cheapest_gait(case):
    problem, floor, cheap = case
    answer = checked(cheapest(problem, speed=floor))
    assert answer.status is Status.OPTIMAL, answer.message
    assert answer.cost == cheap.cost
    assert abs(answer.sweep.gap) < 1e-6
    assert answer.sweep.cost == pytest.approx(cheap.cost, rel=1e-8)


def test_the_best_of_a_sweep_is_the_cheapest(case):
    """The climb ends on the least speed, below that of the grid's best."""
    problem, floor, cheap = case
    swept = rr.sweep(cheapest(problem, speed=floor), 1000)
    assert swept.found.best.speed**2 > swept.best.speed**2
    assert 1 / swept.best.merit == pytest.approx(cheap.cost, rel=1e-6)
    assert f"lowest cost of transport, {number(cheap.cost)}" in swept.message


def test_a_dearer_gait_is_refuted(case):
    from rr_opt.verify.sweep import check_optimum

    problem, floor, cheap = case
    gait = replace(cheap.gait, amplitude=1.01 * cheap.gait.amplitude)
    robot = maximize_speed(problem).robot
    steady = steady_cycle(robot, gait)
    cost = energy(robot, steady).cost_of_transport
    ratio = maximize_speed(problem).ratio
    asked = cheapest(problem, speed=floor)
    assert check_optimum(asked, gait, ratio, steady.speed, cost=cost).better is not None


@pytest.mark.parametrize("mean", [mean_positive, positive_mean])
@pytest.mark.parametrize("constant", [-3.0, -0.4, 0.0, 0.7, 3.0])
def test_the_positive_part_is_integrated_exactly(mean, constant):
    def power(t):
        return np.cos(t) * (0.3 * np.sin(t - 0.3) + 0.2 * np.sin(3 * t)) + constant * 0.3

    few, many = (2 * np.pi * np.arange(n) / n for n in (384, 2**20))
    exact = np.maximum(power(many), 0.0).mean()
    assert mean(power(few)[:, None])[0] == pytest.approx(exact, rel=1e-9, abs=1e-12)


def test_a_speed_out_of_reach_is_infeasible_and_the_nearest_is_said():
    problem = limited(PROBLEMS["straight_torque"], torque=1.0)
    most = abs(maximize_speed(problem).best.speed)
    optimum = maximize_speed(limited(problem, speed=1.1 * most))
    assert optimum.status is Status.INFEASIBLE
    assert "Limit `speed`" in optimum.message
    said = float(optimum.message.split("keep the other limits has ")[1].split(" m/s")[0])
    assert said == pytest.approx(most, rel=3e-5)
    assert said < most


def test_limits_that_clash_are_named_together():
    problem = PROBLEMS["straight_torque"]
    most = abs(maximize_speed(problem).best.speed)
    optimum = maximize_speed(limited(problem, speed=1.1 * most))
    assert optimum.status is Status.INFEASIBLE
    assert "Limits `torque` (0.02 N m) and `speed`" in optimum.message


def test_energy_of_other_shapes_and_of_play_is_refused():
    problem = cheapest(PROBLEMS["straight_torque"])
    with pytest.raises(InputError, match="Only sines"):
        rr.maximize_speed(replace(problem, gait=replace(problem.gait, shape="free")))
    play = replace(problem.robot, physics=(EffectUse("servo_backlash", {"width": 0.01}),))
    with pytest.raises(InputError, match="servo_backlash"):
        rr.maximize_speed(replace(problem, robot=play))
