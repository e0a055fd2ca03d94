"""A joint with play: how it moves while the servo lets it go, and what nobody can know of that."""

import numpy as np

from rr_opt.machines.racer.racer import RollerRacer
from tests.sysid.made_up import experiment

PLAY = {"servo_backlash.width": 0.05, "servo_backlash.joint_friction": 0.0}


def test_the_angle_counts_once_the_joint_has_stopped_bouncing():
    x = experiment(seconds=8.0)
    for run, data in zip(x.runs, RollerRacer(x).runs, strict=True):
        bounces = (data.t >= 0) & (data.t < run.gait.period / 2) & (run.start == "rest")
        np.testing.assert_array_equal(np.isnan(data.values[:, 3]), bounces)


def test_a_joint_that_is_free_moves_as_the_robot_that_is_fitted():
    model = RollerRacer(experiment(seconds=8.0))
    drives = model.simulator.drives
    t = np.linspace(0.0, 2.0, 201)
    nominal = model.simulator.given(PLAY | {"servo_backlash.compliance": 0.0})
    braked = {**nominal, "kappa1": 3 * nominal["kappa1"]}
    loose = [drives.of(1, given, ("servo_backlash",)).at(t)[0] for given in (nominal, braked)]
    assert np.abs(loose[1] - loose[0]).max() > 1e-4
    stiff = [drives.of(1, given, ()) for given in (nominal, braked)]
    assert stiff[0] is stiff[1]
