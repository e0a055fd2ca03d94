"""The equations that other tools are given to fit are this project's motion, derived apart."""

import numpy as np
import pytest

from benchmarks.fit import ours
from benchmarks.fit.case import BEGINS, GAITS, SIGMA, TRUE, Case, case, clean
from benchmarks.fit.equations import PARAMETERS
from benchmarks.fit.referee import predicted
from rr_opt.machines.racer.parameters import values_of
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.motion.floor_motion import floor_motion
from rr_opt.sysid.model import Request
from tests.sysid.made_up import whole


def of_model(run, p):
    """What the model of the diagnosis predicts of a recording, (n, 4)."""
    model = RollerRacer(ours._experiment(case(), TRUE))
    given = model.nominal | dict(zip(PARAMETERS, p.tolist(), strict=True))
    segment = whole(model, run)
    path = model.simulator.drive_path(segment, given, ())
    own = floor_motion()
    values = values_of(given, own.parameters)
    # The state holds z = v - g dphi: with z = 0, v is what dphi alone makes.
    x, y, psi, v = BEGINS[run]
    still = float(own.speeds([x, y, psi, 0.0], path.at[:2, 0], values)[0])
    start = np.array([x, y, psi, v - still])
    return model.predicted(Request(segment, given, start), ())


@pytest.mark.parametrize("run", range(len(GAITS)))
def test_the_recordings_are_what_the_model_predicts(run):
    apart = np.abs(of_model(run, TRUE) - clean()[run]) / SIGMA
    assert apart.max() < 1e-2


def test_another_robot_moves_otherwise():
    for k in range(TRUE.size):
        p = TRUE.copy()
        p[k] *= 1.1
        assert (np.abs(of_model(0, p) - clean()[0]) / SIGMA).max() > 1.0


def test_the_judge_predicts_them_too():
    few = case()
    few = Case(few.t[:301], few.values[:, :301])
    path = predicted(few, TRUE[:, None], np.array(BEGINS).T[:, :, None])[..., 0]
    seen = clean()[:, :301, :3].transpose(1, 2, 0)
    assert (np.abs(path - seen) / SIGMA[None, :3, None]).max() < 1e-3
