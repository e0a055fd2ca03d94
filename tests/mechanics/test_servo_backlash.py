"""With play the joint swings free between two stops, as multipliers say, and as MuJoCo finds it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from rr_lab.case import record
from rr_opt import prototype
from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer.drive import joint_of
from rr_opt.machines.racer.parameters import parameters_of
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.motion.floor_motion import free_joint
from tests.mechanics import multipliers
from tests.mechanics.cases import REPEATABLE, State, cases
from tests.mechanics.floor import on_floor
from tests.rr_lab.reduced import LONG, SHORT

PLAY = CATALOGUE["servo_backlash"]


@settings(REPEATABLE, max_examples=15)
@given(cases())
def test_free_joint_needs_no_torque(case):
    robot, (v, phi, dphi, _) = case
    q = np.array([0.0, 0.0, 0.0, phi])
    qd = multipliers.rates(robot, q, v, dphi)
    qdd, _ = multipliers.solve(robot, q, qd, math.nan, multipliers.Beyond(loose=True))
    joint = free_joint(robot)
    z = v - _g(robot, phi) * dphi
    found = float(joint.swing(phi, dphi, z, joint.p)[0])
    assert found == pytest.approx(qdd[3], rel=1e-6, abs=1e-6)


def _g(robot, phi: float) -> float:
    """dv/d(dphi) of a blow: how vdot changes with ddphi."""
    low, high = (
        on_floor(robot, State(0.0, phi, 0.0, bend), np.zeros(3)).speeds[0] for bend in (0.0, 1.0)
    )
    return high - low


@pytest.mark.parametrize("robot", [LONG, SHORT], ids=["long", "short"])
@pytest.mark.parametrize("width", [0.005, 0.06])
@pytest.mark.parametrize(
    "gait", [SineGait(0.6, 1.0, 0.1), SineGait(0.9, 2.5, -0.2)], ids=["fast", "slow"]
)
def test_against_the_laboratory(robot, width, gait):
    seen = record(robot, gait, 5.0, "running", [EffectUse("servo_backlash", {"width": width})])
    made = PLAY.actuate(commanded(gait, False), {"width": width}, free_joint(robot)).at(seen.t)[0]
    off = made - seen.values["phi"]
    # A tenth of what a capture system tells of an angle; the widest play is 60 mrad.
    assert np.sqrt(np.mean(off**2)) < 3e-4
    assert np.abs(off).max() < 3e-3


def test_against_the_laboratory_with_friction():
    built, values = prototype(), {"width": 0.02, "joint_friction": 0.05}
    robot = replace(built, platform2=replace(built.platform2, I=0.00554))
    gait = SineGait(0.15, 0.3, 0.0)
    seen = record(robot, gait, 5.0, "running", [EffectUse("servo_backlash", values)])
    made = PLAY.actuate(commanded(gait, False), values, free_joint(robot)).at(seen.t)[0]
    assert np.sqrt(np.mean((made - seen.values["phi"])[seen.t > 2] ** 2)) < 3e-4


def test_stops_hold_and_the_swing_grows_by_half_the_play():
    gait, width = SineGait(0.6, 1.0, 0.1), 0.04
    t = np.linspace(0.0, 9.0, 4001)
    for rest in (True, False):
        made = PLAY.actuate(commanded(gait, rest), {"width": width}, free_joint(LONG)).at(t)
        ahead = made[0] - gait.angle(t)
        assert np.abs(ahead).max() <= width / 2 + 1e-6
        settled = made[0, t > 2]
        assert np.ptp(settled) / 2 == pytest.approx(0.6 + width / 2, abs=2e-4)
        slope = np.gradient(made[0], t)
        assert np.median(np.abs(slope - made[1])) < 1e-2


def test_from_rest_the_joint_waits_for_the_stop():
    gait, width = SineGait(0.6, 1.0, 0.1), 0.04
    made = PLAY.actuate(commanded(gait, True), {"width": width}, free_joint(LONG))
    until = width / 2 / gait.peak_rate
    waiting = made.at(np.linspace(-1.0, 0.9 * until, 20))[0]
    np.testing.assert_allclose(waiting, gait.offset, atol=1e-3)


def test_a_robot_that_hardly_loses_speed_is_not_extrapolated_beyond_it():
    inertias = {"m1": 0.503, "I1": 0.00233, "m2": 0.0964, "I2": 0.00305}
    friction = {"kappa1": 2.1e-6, "kappa2": 2.5e-6}
    joint = joint_of(parameters_of(prototype()) | inertias | friction)
    t, values = np.arange(0, 3, 0.01), {"width": 0.207, "joint_friction": 0.028}
    for amplitude in np.linspace(0.44, 0.48, 9):
        gait = SineGait(amplitude, 0.77, -0.0703)
        swing = PLAY.actuate(commanded(gait, False), values, joint).at(t)[0]
        assert np.abs(swing).max() < amplitude + 0.0703 + 0.207
