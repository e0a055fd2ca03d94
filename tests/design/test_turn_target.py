"""A target that contradicts itself is refused with what to write; a good one has one side."""

import math
from dataclasses import replace

import pytest

from benchmarks.turn.problems import SHORT
from rr_opt.design.turn import Target, checked, posed
from rr_opt.model.problem import Interval
from rr_opt.outcome import InputError


@pytest.mark.parametrize(
    ("target", "said"),
    [
        (Target(), "Read none of"),
        (Target(heading=1.0), "Read none of"),
        (Target(radius=1.0, length=1.0, heading=1.0), "--radius and --length"),
        (Target(length=1.0), "without --heading"),
        (Target(radius=1.0, whole=True), "--cycles whole without --heading"),
        (Target(radius=0.0), "--radius: Read 0"),
        (Target(radius=2e3), "as good as straight"),
        (Target(heading=1.0, radius=-1.0), "Expected one side"),
    ],
)
def test_refused(target, said):
    with pytest.raises(InputError, match=said):
        checked(target)


@pytest.mark.parametrize(
    ("target", "name", "low", "high"),
    [
        (Target(radius=-2.0), "curvature", -0.5, -0.5),
        (Target(heading=-1.0, radius=-2.0), "curvature", -0.5, -0.5),
        (Target(heading=-1.0, radius=2.0), "curvature", -0.5, -0.5),
        (Target(heading=1.0, within=4.0), "yaw_rate", 0.25, math.inf),
        (Target(heading=-1.0, within=4.0), "yaw_rate", -math.inf, -0.25),
        (Target(heading=-1.0, length=4.0), "curvature", -math.inf, -0.25),
    ],
)
def test_what_is_asked(target, name, low, high):
    assert getattr(checked(target).turn, name) == Interval(low, high)


def test_a_fixed_offset_is_opened_and_a_pair_is_kept():
    fixed = replace(SHORT, gait=replace(SHORT.gait, offset=Interval(0.0, 0.0)))
    problem, opened = posed(fixed, Target(radius=1.0))
    assert opened
    reach = problem.gait.offset.high + problem.gait.amplitude.low
    one, two = SHORT.robot.platform1, SHORT.robot.platform2
    assert one.c * math.cos(reach) + two.c == pytest.approx(SHORT.limits.singularity)
    pair = replace(SHORT, gait=replace(SHORT.gait, offset=Interval(0.1, 0.2)))
    assert posed(pair, Target(radius=1.0))[0].gait == pair.gait
