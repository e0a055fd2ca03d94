"""CasADi as in its own example docs/examples/python/sysid.py: multiple shooting, Gauss-Newton.

All states are unknowns, the steps of all samples one map, the Hessian is J'J and IPOPT solves. Two
things are in its favour: the misfit is of the states themselves, so that J'J is diagonal but for
nothing, and the solver is kept for other starts. Like there, functions are compiled where a
compiler is found; `openmp` is left out, as the maps of the released wheels run serially anyway.
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from benchmarks.fit.case import RATE, TRUE, Array, Case, commanded
from benchmarks.fit.equations import rates
from benchmarks.fit.ways import PATIENCE

_SMOOTH = 10
"""Samples to either side of which the first guess of v is a slope."""


def fit(case: Case, start: Array) -> Array:
    """The six parameters, from a start."""
    found = _solver(case)(x0=np.concatenate([start / TRUE, _states(case).ravel("F")]), lbg=0, ubg=0)
    return np.asarray(found["x"])[: TRUE.size, 0] * TRUE


def _one_sample() -> ca.Function:
    state, drive, p = ca.MX.sym("state", 4), ca.MX.sym("drive", 9), ca.MX.sym("p", TRUE.size)
    begin, middle, end = ca.vertsplit(drive, 3)

    def slope(at: ca.MX, told: ca.MX) -> ca.MX:
        given = (ca.vertsplit(at), ca.vertsplit(told), ca.vertsplit(p))
        return ca.vertcat(*rates(given[0], given[1], given[2], ca.sin, ca.cos))

    h = 1 / RATE
    k1 = slope(state, begin)
    k2 = slope(state + h / 2 * k1, middle)
    k3 = slope(state + h / 2 * k2, middle)
    k4 = slope(state + h * k3, end)
    after = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return ca.Function("one_sample", [state, drive, p], [after]).expand()


@lru_cache(maxsize=1)
def _solver(case: Case) -> ca.Function:
    samples, runs = case.t.size, len(case.gaits)
    params, X = ca.MX.sym("params", TRUE.size), ca.MX.sym("X", 4, samples * runs)
    step = _one_sample().map(samples - 1)
    given = ca.repmat(params * TRUE, 1, samples - 1)
    gaps, misfits = [], []
    for run in range(runs):
        own = X[:, run * samples : (run + 1) * samples]
        after = step(own[:, :-1], _drive(case, run), given)
        gaps.append(ca.vec(after - own[:, 1:]))
        sigma = np.array(case.sigma[:3])
        misfits.append(ca.vec((case.values[run, :, :3].T - own[:3, :]) / sigma[:, None]))
    e, V = ca.vertcat(*misfits), ca.veccat(params, X)
    nlp = {"x": V, "f": 0.5 * ca.dot(e, e), "g": ca.vertcat(*gaps)}
    J = ca.jacobian(e, V)
    sigma = ca.MX.sym("sigma")
    jit = {"jit": ca.Importer.has_plugin("shell"), "compiler": "shell"}
    hessian = ca.Function(
        "nlp_hess_l",
        {"x": V, "lam_f": sigma, "hess_gamma_x_x": sigma * ca.triu(ca.mtimes(J.T, J))},
        ["x", "p", "lam_f", "lam_g"],
        ["hess_gamma_x_x"],
        jit,
    )
    quiet = {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False}
    # One far start was seen to take a quarter of an hour.
    most = {"ipopt.max_cpu_time": PATIENCE}
    return ca.nlpsol("solver", "ipopt", nlp, {"hess_lag": hessian, **jit, **quiet, **most})


def _drive(case: Case, run: int) -> Array:
    """phi, dphi and ddphi of each step: its beginning, its middle, its end (9, steps)."""
    begins = case.t[:-1]
    return np.vstack([commanded(case.gaits[run], begins + part / RATE) for part in (0, 0.5, 1)])


def _states(case: Case) -> Array:
    """First guesses (4, samples * runs), from what was recorded."""
    out = []
    for run in case.values:
        slopes = np.gradient(run[:, :2], axis=0) * RATE
        kernel = np.ones(2 * _SMOOTH + 1)
        weight = np.convolve(np.ones(len(run)), kernel, "same")
        dx, dy = (np.convolve(column, kernel, "same") / weight for column in slopes.T)
        out.append(np.vstack([run[:, :3].T, dx * np.cos(run[:, 2]) + dy * np.sin(run[:, 2])]))
    return np.hstack(out)
