"""A dragged cable holds axle 2 back with its force, whichever way it moves."""

from dataclasses import replace

import numpy as np
import pytest

from rr_lab.case import ENGINES, record
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG

FREE = replace(
    LONG, platform1=replace(LONG.platform1, kappa=0.0), platform2=replace(LONG.platform2, kappa=0.0)
)
STILL = SineGait(0.0, 1.0)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("tilt", [0.01, -0.01])
def test_a_straight_robot_rolls_down_a_slope_more_slowly(engine, tilt):
    """By the force over the mass, as long as it moves much faster than the friction sets in."""
    force = 0.02
    mass = LONG.platform1.m + LONG.platform2.m
    slope = EffectUse("floor_tilt", {"tilt_x": tilt, "tilt_y": 0.0})
    cable = EffectUse("dragged_cable", {"force": force})
    speeds = []
    for uses in ([slope], [slope, cable]):
        seen = record(FREE, STILL, 2.0, "rest", uses, engine=engine)
        x, t = seen.values["x"], seen.t
        speeds.append((np.diff(x) / np.diff(t))[[100, -1]])
    gained = [late - early for early, late in speeds]
    held_back = (gained[0] - gained[1]) / (t[-2] - t[100])
    assert held_back == pytest.approx(np.sign(tilt) * force / mass, rel=0.01)
