"""A rolling force given at five speeds is that force at those speeds, and against the motion."""

import casadi as ca
import numpy as np
import pytest

from rr_opt.effects.rolling_force_curve import EFFECT, KNOTS
from rr_opt.mechanics.kinematics import mechanism

SPEED, FORCES = 0.4, (0.02, 0.012, 0.009, 0.011, 0.03)


def _force(u):
    """Of the first wheel at a rolling speed, straight ahead: the last force that was added."""
    robot = mechanism()
    values = {"speed": ca.SX(SPEED)} | {f"force{k}": ca.SX(f) for k, f in enumerate(FORCES)}
    assert EFFECT.enter is not None
    added = EFFECT.enter(robot, values).forces[len(robot.forces) :][0].vector[0]
    names = [*robot.parameters.values()]
    at = ca.Function("force", [robot.speeds, robot.phi, ca.vertcat(*names)], [added])
    return float(at([u, 0, 0, 0], 0.0, np.ones(len(names))))


@pytest.mark.parametrize(("part", "force"), list(zip(KNOTS, FORCES, strict=True))[1:])
@pytest.mark.parametrize("way", [1, -1])
def test_at_a_knot_it_is_the_force_of_the_knot(part, force, way):
    # The corner is rounded, which is worth some per cent of the change of slope.
    assert way * _force(way * part * SPEED) == pytest.approx(-force, abs=6e-4)


def test_beyond_the_last_knot_it_stays_and_near_rest_it_is_the_first():
    assert _force(5 * SPEED) == pytest.approx(-FORCES[-1], rel=0.01)
    assert _force(0.008) == pytest.approx(-np.interp(0.02, KNOTS, FORCES), rel=0.06)
    assert _force(0.0) == 0.0


def test_between_knots_it_is_straight():
    part = 0.75
    assert _force(part * SPEED) == pytest.approx(-np.interp(part, KNOTS, FORCES), rel=0.01)
