"""The steady speed is that of the expansion of docs/model.md, up to the amplitude to the fourth."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.reversal import expanded_speed, roots, with_centre
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.steady_cycle import steady_cycle

AMPLITUDES = (0.2, 0.1, 0.05)


def drawn(seed):
    draw = np.random.default_rng(seed).uniform
    platforms = [
        Platform(
            m=draw(0.2, 1.0),
            I=draw(1e-3, 6e-3),
            c=draw(0.05, 0.3),
            a=draw(-0.02, 0.08),
            b=draw(0.02, 0.1),
            kappa=draw(1e-5, 1e-4),
        )
        for _ in range(2)
    ]
    return Robot(*platforms, h=0.02)


@pytest.mark.parametrize("seed", range(6))
def test_the_difference_is_of_the_second_order_relative(seed):
    robot = drawn(seed)
    errors = []
    for amplitude in AMPLITUDES:
        gait = SineGait(amplitude, 1.0)
        errors.append(abs(steady_cycle(robot, gait).speed - expanded_speed(robot, gait)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([4, 4], abs=0.1)


def test_the_direction_reverses_where_the_expansion_says():
    robot = drawn(1)
    robot = replace(robot, platform2=replace(robot.platform2, I=1e-3))
    for place in roots(robot):
        before, after = (
            steady_cycle(with_centre(robot, place + step), SineGait(0.02, 1.0)).speed
            for step in (-1e-3, 1e-3)
        )
        assert before * after < 0
