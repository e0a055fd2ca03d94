"""Play with a gear that gives is the joint between springs that it meets at both stops."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.effects import CATALOGUE
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait
from rr_opt.motion.floor_motion import free_joint
from tests.rr_lab.reduced import LONG

PLAY = CATALOGUE["servo_backlash"]
GAIT, WIDTH, SETTLED = SineGait(0.6, 1.0, 0.1), 0.06, 12.0


def made(t, friction, compliance):
    values = {"width": WIDTH, "joint_friction": friction, "compliance": compliance}
    return PLAY.actuate(commanded(GAIT, False), values, free_joint(LONG)).at(t)[0]


def sprung(t, friction, compliance):
    """The same, integrated with the springs, critically damped."""
    joint, command = free_joint(LONG), commanded(GAIT, False)
    mobility = float(joint.swing(0.1, 0.0, 0.0, joint.p)[2])
    damping = 2.0 / np.sqrt(compliance * mobility)

    def rates(now, y):
        phi, dphi, z = y
        servo, rate, _ = command.at(np.array([now]))[:, 0]
        lead = phi - servo
        past = lead - np.clip(lead, -WIDTH / 2, WIDTH / 2)
        torque = 0.0
        if past:
            push = past / compliance + damping * (dphi - rate)
            torque = -push if push * past > 0 else 0.0
        ddphi, zdot, mobility = (float(part) for part in joint.swing(phi, dphi, z, joint.p))
        return [dphi, ddphi + mobility * (torque - friction * np.tanh(dphi / 1e-3)), zdot]

    begun = [*command.at(np.zeros(1))[:2, 0], 0.0]
    path = solve_ivp(rates, (0, t[-1]), begun, t_eval=t, method="LSODA", rtol=1e-7, max_step=2e-3)
    return path.y[0]


@pytest.mark.parametrize("friction", [0.0, 0.02])
def test_against_springs(friction):
    t = np.linspace(SETTLED, SETTLED + GAIT.period, 401)
    compliance = 0.05
    exact = sprung(np.append(0.0, t), friction, compliance)[1:]
    off = made(t, friction, compliance) - exact
    rigid = made(t, friction, 0.0) - exact
    assert np.sqrt(np.mean(off**2)) < 0.45 * np.sqrt(np.mean(rigid**2))


def test_a_stiff_gear_is_rigid():
    t = np.linspace(SETTLED, SETTLED + GAIT.period, 401)
    assert made(t, 0.02, 1e-6) == pytest.approx(made(t, 0.02, 0.0), abs=1e-5)
