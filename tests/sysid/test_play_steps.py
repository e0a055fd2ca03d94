"""A servo with play is predicted as exactly with the usual steps as with an eighth of them."""

import numpy as np
import pytest

from rr_opt.effects import CATALOGUE, servo_backlash
from rr_opt.machines.racer import drive as racer_steps
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait
from rr_opt.motion.floor_motion import free_joint
from tests.sysid.made_up import NOISE, ROBOT, experiment, predicted

SIGMA = np.array([NOISE.position, NOISE.position, NOISE.angle, NOISE.angle])
MIDDLE, FAST = SineGait(0.65, 0.8, -0.15), SineGait(0.9, 0.6, 0.1)
WIDTH, FRICTION, COMPLIANCE = (
    f"servo_backlash.{name}" for name in ("width", "joint_friction", "compliance")
)
CASES = {
    "compliant": (MIDDLE, {WIDTH: 0.05, FRICTION: 0.1, COMPLIANCE: 0.03}),
    "rate limit": (MIDDLE, {WIDTH: 0.05, "servo_rate_limit.rate_limit": 0.85 * MIDDLE.peak_rate}),
    "fast, rigid": (FAST, {WIDTH: 0.05, FRICTION: 0.1}),
}


@pytest.mark.parametrize("start", ["running", "rest"])
@pytest.mark.parametrize("case", CASES)
def test_as_with_an_eighth_of_the_steps(case, start, monkeypatch):
    gait, values = CASES[case]
    effects = tuple(name for name in CATALOGUE if any(q.startswith(f"{name}.") for q in values))
    begin = np.array([0.0, 0.0, 0.3, 0.1 if start == "running" else 0.0])
    paths = []
    for finer in (1, 8):
        if finer > 1:
            monkeypatch.setattr(servo_backlash, "_STEPS", finer * servo_backlash._STEPS)
            monkeypatch.setattr(racer_steps, "_LONGEST", racer_steps._SHARP / finer)
            monkeypatch.setattr(racer_steps, "_SHARP", racer_steps._SHARP / finer)
        model = RollerRacer(experiment(((gait, start),), seconds=20.0, rate=100.0))
        paths.append(predicted(model, 0, values, effects, begin))
    assert np.abs((paths[0] - paths[1]) / SIGMA).max() < 1


@pytest.mark.parametrize("rest", [False, True])
@pytest.mark.parametrize("compliance", [0.03, 0.1, 0.3])
def test_a_gear_that_gives_does_not_throw_the_joint(compliance, rest):
    play, t = CATALOGUE["servo_backlash"], np.linspace(0.0, 20.0, 40001)
    for gait in (MIDDLE, FAST):
        values = {"width": 0.05, "joint_friction": 0.1, "compliance": compliance}
        angle, rate, _ = play.actuate(commanded(gait, rest), values, free_joint(ROBOT)).at(t)
        assert np.abs(rate).max() < 1.6 * gait.peak_rate
        # The rate is that of the angle.
        inside = np.abs(np.diff(rate)) < 0.05 * gait.peak_rate
        off = np.diff(angle) / np.diff(t) - (rate[1:] + rate[:-1]) / 2
        assert np.abs(off[inside]).max() < 0.05 * gait.peak_rate


@pytest.mark.parametrize("rest", [False, True])
def test_a_joint_that_is_held_jumps_with_the_command(rest):
    gait, limit = MIDDLE, {"rate_limit": 0.85 * MIDDLE.peak_rate}
    command = CATALOGUE["servo_rate_limit"].actuate(commanded(gait, rest), limit)
    values = {"width": 0.02, "joint_friction": 5.0}
    drive = CATALOGUE["servo_backlash"].actuate(command, values, free_joint(ROBOT))
    jumps = command.jumps_within(5.1, 5.1 + gait.period)
    assert jumps.size == 4
    assert np.isin(jumps, drive.jumps_within(5.0, 6.2)).all()
    beside = (jumps[:, None] + [-2e-3, -1e-7, 1e-7, 2e-3]).ravel()
    np.testing.assert_allclose(drive.at(beside)[1], command.at(beside)[1], atol=1e-3)
