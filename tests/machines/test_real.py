"""Friction of a pendulum against a fit that shares nothing with the diagnosis: of one made here,
and of the public recordings where RR_OPT_REAL names their folder."""

import os
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from scipy.signal import savgol_filter

import rr_opt as rr
from rr_opt.results.machine_diagnosis import ExplainedMachine
from tests.machines.swings import write

REAL = os.environ.get("RR_OPT_REAL", "")
real = pytest.mark.skipif(not REAL, reason="RR_OPT_REAL names no folder of public recordings")


def integrals(t, q, u, window=0.1):
    """J, ml, b, Fc and an offset: J change(w) + the integral of each torque over short windows."""
    even = np.arange(t[0], t[-1], np.median(np.diff(t)))
    q, u = np.interp(even, t, q), np.interp(even, t, u)
    step = even[1] - even[0]
    length = 2 * (round(0.06 / step) // 2) + 1
    w = np.asarray(savgol_filter(q, length, 3, deriv=1, delta=step), float)
    columns = [np.zeros_like(w), 9.81 * np.sin(q), w, np.tanh(w / 0.05), np.ones_like(w)]
    every = round(window / step)

    def over(y):
        total = np.concatenate([[0], np.cumsum((y[1:] + y[:-1]) / 2 * step)])
        return total[every:] - total[:-every]

    A = np.column_stack([over(y) for y in columns])
    A[:, 0] = w[every:] - w[:-every]
    low = [0, 0, 0, 0, -np.inf]
    return lsq_linear(A, over(u), (low, np.inf)).x


def test_a_twin(tmp_path):
    folder = write(tmp_path, dry=0.03)
    t, q, u = np.loadtxt(folder / "run0.csv", delimiter=",", skiprows=1).T
    J, ml, _, dry, _ = integrals(t, np.radians(q), u)
    assert (J, ml, dry) == pytest.approx((0.05, 0.1, 0.03), rel=0.2)


@real
def test_the_pendulum(tmp_path):
    folder = Path(REAL) / "pendulum"
    file = folder / "ddp.csv"
    t, q, _, u = np.loadtxt(file, delimiter=",", skiprows=1).T
    *_, dry, _ = integrals(t, q, u)
    (tmp_path / "experiment.yaml").write_text(
        "machine: pendulum\nparameters: {J: 0.06, ml: 0.1, b: 0.05}\n"
        "columns: {t: time, q: position, u: torque}\nrecordings:\n"
        f"  - {{file: {file}}}\n  - {{file: {folder / 'direct_collocation.csv'}, use: holdout}}\n"
    )
    found = rr.diagnose(tmp_path)
    named = {one.name: one for one in found.effects}
    assert named["coulomb_friction"].parameters["torque"].value == pytest.approx(dry, rel=0.3)
    assert isinstance(found, ExplainedMachine)
    errors = found.errors(held_out=True)["q"]
    assert errors["after"] < errors["parameters"] < errors["before"]
