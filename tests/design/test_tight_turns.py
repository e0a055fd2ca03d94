"""Turns that are as tight as a robot can, on robots drawn at random: answered, without an error."""

from dataclasses import replace

import rr_opt as rr
from benchmarks.random.problems import draw, turning
from rr_opt.design.decisions import decisions
from rr_opt.design.infeasible import nearest_turn
from rr_opt.model.problem import Interval, Turn
from rr_opt.outcome import Status

SEED = "8ceb4a66975d720f"


def test_models_that_overflow_end_a_climb():
    asked = Turn(curvature=Interval(100.0, 100.0))
    tight = replace(turning(draw(SEED, 23_000)), turn=asked)
    assert nearest_turn(tight, decisions(tight)).speed


def test_a_gait_in_the_corner_of_the_bounds_is_not_left():
    found = rr.turn(turning(draw(SEED, 18_000)), radius=-0.441384)
    assert abs(found.speed) > 0.1064


def test_a_circle_that_is_known_to_a_millionth_of_what_is_left_of_the_speed():
    """There 1e-8 of the radius is worth 1e-4 of the speed."""
    found = rr.turn(turning(draw("e241d9f31a242ca6", 58_000)), radius=0.0633991)
    assert found.status is Status.OPTIMAL, found.message
    assert found.sweep.gained < 1e-6
