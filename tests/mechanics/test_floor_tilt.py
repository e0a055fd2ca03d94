"""On a sloping floor the robot gains what its masses lose in height: all weigh G, downhill.

A robot that keeps its shape, straight and without friction, glides at G times the slope ahead.
"""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest
from hypothesis import given, settings

from rr_opt.model.robot import EffectUse
from tests.mechanics.cases import REPEATABLE, State, cases, energy, numbers, robots
from tests.mechanics.floor import on_floor

G = 9.80665
slopes = numbers(-0.02, 0.02)


@settings(REPEATABLE, max_examples=10)
@given(robots(), slopes, slopes, numbers(-7.0, 7.0), numbers(-0.5, 0.5))
def test_straight_robot_glides(robot, tilt_x, tilt_y, psi, v):
    free = (replace(p, kappa=0.0) for p in (robot.platform1, robot.platform2))
    use = EffectUse("floor_tilt", {"tilt_x": tilt_x, "tilt_y": tilt_y})
    glider = replace(robot, **dict(zip(("platform1", "platform2"), free, strict=True)))
    there = np.array([0.0, 0.0, psi])
    found = on_floor(replace(glider, physics=(use,)), State(v, 0.0, 0.0, 0.0), there)
    expected = G * (tilt_x * cos(psi) + tilt_y * sin(psi))
    assert found.speeds[0] == pytest.approx(expected, abs=1e-9)


@settings(REPEATABLE, max_examples=10)
@given(cases(), slopes, slopes, numbers(-7.0, 7.0))
def test_power_of_the_weight(case, tilt_x, tilt_y, psi):
    robot, state = case
    use = EffectUse("floor_tilt", {"tilt_x": tilt_x, "tilt_y": tilt_y})
    there = np.array([0.0, 0.0, psi])
    level, sloping = (
        on_floor(replace(robot, physics=physics), state, there) for physics in ((), (use,))
    )
    slower, faster = (
        on_floor(robot, state._replace(v=state.v + step), there).pose for step in (-0.5, 0.5)
    )
    masses = ((robot.platform1, 0.0, 1.0), (robot.platform2, state.phi, -1.0))

    def gain(pose: np.ndarray, dphi: float) -> float:
        """Power of the weight, W, at the rates of the pose."""
        total = 0.0
        for part, turn, ahead in masses:
            angle, rate = psi + turn, pose[2] + (dphi if turn or ahead < 0 else 0.0)
            reach = ahead * part.joint_to_centre
            V = pose[:2] + reach * rate * np.array([-sin(angle), cos(angle)])
            total += part.m * G * float(np.dot(V, (tilt_x, tilt_y)))
        return total

    # The weight's share of vdot takes the kinetic energy's slope in v, and the servo the rest.
    by_v = gain(faster - slower, 0.0)
    inertia = kinetic_slope(robot, state)
    assert (sloping.speeds[0] - level.speeds[0]) * inertia == pytest.approx(
        by_v, rel=1e-5, abs=1e-8
    )


def kinetic_slope(robot, state) -> float:
    """The second derivative of the kinetic energy by v, kg."""
    low, here, high = (energy(robot, state._replace(v=state.v + d))[0] for d in (-1.0, 0.0, 1.0))
    return low - 2 * here + high
