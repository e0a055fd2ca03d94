"""What no name fits is told as a function of what it depends on, and nothing is told of noise."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.machines.racer.residual import residue
from rr_opt.mechanics.kinematics import robot_values, with_wheel_forces
from rr_opt.model.experiment import Start
from rr_opt.model.gait import SineGait
from rr_opt.motion.dynamics import assembled
from rr_opt.motion.floor_motion import solved
from tests.sysid.made_up import GAITS, ROBOT, base_of, experiment, recorded, with_effect

FORCE, SPEED = 0.006, 0.05
MANY: tuple[tuple[SineGait, Start], ...] = (
    *GAITS,
    (SineGait(0.25, 1.0, 0.1), "running"),
    (SineGait(0.9, 2.0), "running"),
)


def _falling(u):
    """Dry friction that falls to a third as the speed grows."""
    return -FORCE * (1 + 2 * ca.exp(-((u / SPEED) ** 2))) / 3 * ca.tanh(u / 0.002)


def plant(law):
    """predict(run, start) by scipy, of a robot with law(wheel, u) at its wheels."""
    given = experiment(MANY, seconds=20.0)
    plain = assembled(())
    mechanism = with_wheel_forces(plain.mechanism, law)
    motion = solved(replace(plain, mechanism=mechanism))
    p = np.array(robot_values(ROBOT))

    def predict(k, start):
        run = given.runs[k]

        def drive(t):
            return [float(run.gait.angle(t)), float(run.gait.rate(t))]

        def rates(t, x):
            return np.array(motion.rates(x, drive(t), p)).ravel()

        t = run.recording.t
        out = solve_ivp(rates, (t[0], t[-1]), start[:4], t_eval=t, max_step=0.02)
        return np.column_stack([out.y[:3].T, run.gait.angle(t)])

    return recorded(given, predict, seed=2)


@pytest.fixture(scope="module")
def sticky():
    model = plant(lambda wheel, u: _falling(u))
    return model, base_of(model)


@pytest.fixture(scope="module")
def falling(sticky):
    return residue(*sticky)


def test_nothing_is_told_beside_a_force_over_speed_that_does_by_itself(sticky):
    (only,) = residue(*sticky, by_speed=True)
    assert (only.kind, only.variable) == ("rolling force", "speed")


def test_friction_that_falls_with_speed_is_found_and_said(falling):
    first = falling[0]
    assert (first.kind, first.variable) == ("rolling force", "speed")
    assert "resists motion" in first.sentence
    assert "falls with speed" in first.sentence
    assert first.share > 0.7


def test_its_curve_is_that_of_the_force_but_for_what_viscous_friction_can_imitate(falling):
    first = falling[0]
    true = FORCE * (1 + 2 * np.exp(-((first.at / SPEED) ** 2))) / 3
    # The viscous part is free: a line through 0 may lie between the two.
    off = true - first.mean
    line = first.at * (first.at @ off) / (first.at @ first.at)
    assert np.sqrt(np.mean((off - line) ** 2)) < 0.3 * true.mean()
    assert first.mean[0] > 1.3 * first.mean[-1]


def test_of_noise_alone_nothing_is_told():
    model = with_effect({}, ())
    assert residue(model, base_of(model)) == ()
