"""An infeasible turn names the closest feasible one, which can be asked for, and what limits it."""

import math
import re
from dataclasses import replace

import pytest

from benchmarks.random.problems import draw
from benchmarks.random.problems import turning as turning_at_random
from benchmarks.turn.problems import REFERENCE, SHORT, round_, turning
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.design.turn import Target, fastest_turn
from rr_opt.model.problem import Interval
from rr_opt.outcome import Status


def refused(problem):
    optimum = maximize_speed(problem)
    assert optimum.status is Status.INFEASIBLE
    assert optimum.best is None
    return optimum.message


def test_too_tight():
    message = refused(turning(SHORT, round_(0.2)))
    assert "radius of 0.2 m to the left" in message
    assert "limit `singularity`" in message
    nearest = float(re.search(r"one is a radius of ([\d.]+) m to the left", message)[1])
    assert maximize_speed(turning(SHORT, round_(nearest))).status is Status.OPTIMAL


def test_offsets_of_one_sign_turn_to_one_side():
    gait = replace(REFERENCE.gait, offset=Interval(0.1, 1.0))
    message = refused(turning(REFERENCE, round_(1.0), gait=gait, inertia_ratio=None))
    assert "to the right" in message
    assert "the offset's lower bound" in message


def test_a_direction_that_stands_in_the_way():
    message = refused(turning(SHORT, round_(0.5), direction="backward"))
    assert "drives forward" in message
    assert "Allow `direction: forward`" in message


def test_too_soon_tells_the_time_that_it_takes():
    message = fastest_turn(SHORT, Target(heading=math.pi / 2, within=0.05)).optimum.message
    needed = float(re.search(r"--within '([\d.]+) s'", message)[1])
    turned = fastest_turn(SHORT, Target(heading=math.pi / 2, within=needed))
    assert turned.optimum.status is Status.OPTIMAL
    assert turned.arc.time == pytest.approx(needed, rel=0.01)


def test_a_gait_that_stands_goes_round_no_circle():
    """The fastest on this circle makes 0.3 um/s, within rounding of turning to either side."""
    posed = turning_at_random(draw("acc0d7813779831d", 32_000))
    message = refused(replace(posed, turn=round_(0.0134114)))
    assert "below 0.001 mm/s a robot counts as stationary" in message
